//! Derives what OpenGL derives from the state (GLSL 1.20 §7.5; OpenGL 2.1 §2.11.3, §2.14.1, §3.10).
//!
//! *In:* a [`FixedFunction`] that was rounded. *Out:* numbers in the order of the uniform's members. *Holds:* the inverse
//! of a matrix that has none is not a number, as with most drivers; the specification leaves it undefined.

use super::state::{FixedFunction, Fog, LightSource, Material};
use glam::{DMat3, DMat4, DVec3};

/// A function of a matrix.
type Form = fn(DMat4) -> DMat4;

/// The forms of a matrix, by the end of the uniform's name.
pub(super) const FORMS: [(&str, Form); 4] = [
    ("InverseTranspose", |matrix| matrix.inverse().transpose()),
    ("Inverse", |matrix| matrix.inverse()),
    ("Transpose", |matrix| matrix.transpose()),
    ("", |matrix| matrix),
];

impl FixedFunction {
    /// `gl_NormalMatrix`: the inverse transpose of the upper left 3x3 of the model-view matrix.
    pub fn normal_matrix(&self) -> DMat3 {
        DMat3::from_mat4(self.model_view).inverse().transpose()
    }

    /// `gl_NormalScale`: the factor of `GL_RESCALE_NORMAL`, one over the length of the third row of the inverse.
    pub fn normal_scale(&self) -> f64 {
        1.0 / self.normal_matrix().z_axis.length()
    }

    /// `sceneColor` of a side: the light that does not depend on a light source.
    pub fn scene_color(&self, material: &Material) -> [f64; 4] {
        let ambient = product(material.ambient, self.light_model_ambient);
        let [r, g, b, _] = std::array::from_fn(|index| {
            material.emission.get(index).unwrap_or(&0.0) + ambient.get(index).unwrap_or(&0.0)
        });
        let [.., alpha] = material.diffuse;
        [r, g, b, alpha]
    }

    /// Ambient, diffuse and specular products of a side for each light.
    pub(super) fn light_products(&self, material: &Material) -> Vec<f64> {
        let of = |light: &LightSource| {
            [
                product(material.ambient, light.ambient),
                product(material.diffuse, light.diffuse),
                product(material.specular, light.specular),
            ]
        };
        self.lights.iter().flat_map(of).flatten().collect()
    }
}

impl LightSource {
    /// `halfVector`: the direction between that to the light and that to a viewer at infinity. Defined for lights at
    /// infinity; for others, by the direction from the origin.
    pub fn half_vector(&self) -> [f64; 4] {
        let [x, y, z, _] = self.position;
        let half = DVec3::new(x, y, z).normalize_or_zero() + DVec3::Z;
        half.normalize_or_zero().extend(0.0).to_array()
    }

    /// `spotCosCutoff`: the cosine of the cutoff, and -1 for a light without a beam.
    pub fn spot_cos_cutoff(&self) -> f64 {
        match self.spot_cutoff {
            180.0 => -1.0,
            90.0 => 0.0,
            degrees => degrees.to_radians().cos(),
        }
    }
}

impl Fog {
    /// `scale`: 1 / (end - start), and 1 if they are equal, as with Mesa.
    pub fn scale(&self) -> f64 {
        if self.end == self.start { 1.0 } else { 1.0 / (self.end - self.start) }
    }
}

fn product(a: [f64; 4], b: [f64; 4]) -> [f64; 4] {
    let mut product = a;
    product.iter_mut().zip(b).for_each(|(one, other)| *one *= other);
    product
}
