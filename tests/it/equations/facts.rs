//! The facts of a draw: the values of its uniforms, and its vertices.

use glam::{DMat3, DMat4, DVec3, DVec4};
use glisten_front::hir::ScalarValue;
use glisten_verify::scene::{AttributeValues, Draw};

/// A vertex, as the library's vertex shaders see it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Vertex {
    /// Clip space.
    pub(super) clip: DVec4,
    /// World space.
    pub(super) place: DVec3,
    /// A unit vector in world space.
    pub(super) normal: DVec3,
    /// The texture coordinates or the color, whichever there is.
    pub(super) attribute: DVec3,
}

impl Vertex {
    /// The place in a picture of this size, in pixels from the lower left.
    pub(super) fn window(&self, width: f64, height: f64) -> (f64, f64) {
        let (x, y) = (self.clip.x / self.clip.w, self.clip.y / self.clip.w);
        (0.5 * (x + 1.0) * width, 0.5 * (y + 1.0) * height)
    }
}

/// The numbers of a uniform; `None` if the program has none of that name.
pub(super) fn uniform(draw: &Draw, name: &str) -> Option<Vec<f64>> {
    let leaf = draw.program.interface.uniforms.iter().find(|leaf| leaf.name == name)?;
    let start = leaf.flat_offset as usize;
    let length = draw.program.types.flat_len(leaf.ty) as usize;
    let values = draw.uniforms[leaf.root.0 as usize][start..start + length].iter();
    Some(values.map(number).collect())
}

fn number(value: &ScalarValue) -> f64 {
    match value {
        ScalarValue::Float(value) => f64::from(*value),
        ScalarValue::Int(value) => f64::from(*value),
        ScalarValue::Uint(value) => f64::from(*value),
        ScalarValue::Bool(value) => f64::from(u8::from(*value)),
    }
}

pub(super) fn vector(draw: &Draw, name: &str) -> Option<DVec3> {
    uniform(draw, name).filter(|numbers| numbers.len() == 3).map(|numbers| DVec3::from_slice(&numbers))
}

pub(super) fn matrix(draw: &Draw, name: &str) -> Option<DMat4> {
    uniform(draw, name).and_then(|numbers| Some(DMat4::from_cols_array(&numbers.try_into().ok()?)))
}

/// The rows of an attribute, filled with zeros.
fn rows(draw: &Draw, name: &str) -> Option<Vec<DVec3>> {
    let index = draw.program.interface.attributes.iter().position(|attribute| attribute.name == name)?;
    let data = draw.attributes[index].as_ref()?;
    let AttributeValues::Float(values) = &data.values else { return None };
    let row = |row: &[f32]| DVec3::from_array(std::array::from_fn(|i| row.get(i).copied().map_or(0.0, f64::from)));
    Some(values.chunks(data.size as usize).map(row).collect())
}

/// The vertices of a draw.
pub(super) fn vertices(draw: &Draw) -> Vec<Vertex> {
    let places = rows(draw, "position").or_else(|| rows(draw, "pv")).expect("positions");
    let normals = rows(draw, "normal").unwrap_or_else(|| vec![DVec3::Z; places.len()]);
    let attributes = rows(draw, "cv").or_else(|| rows(draw, "texcoord"));
    let attributes = attributes.unwrap_or_else(|| vec![DVec3::ZERO; places.len()]);
    let clip = matrix(draw, "model_view_projection").or_else(|| matrix(draw, "mc")).expect("a matrix");
    let model = matrix(draw, "model").unwrap_or(DMat4::IDENTITY);
    let turn =
        uniform(draw, "model_normal").and_then(|numbers| Some(DMat3::from_cols_array(&numbers.try_into().ok()?)));
    let turn = turn.unwrap_or(DMat3::IDENTITY);
    let all = places.into_iter().zip(normals).zip(attributes);
    all.map(|((place, normal), attribute)| Vertex {
        clip: clip * place.extend(1.0),
        place: (model * place.extend(1.0)).truncate(),
        normal: (turn * normal).normalize_or_zero(),
        attribute,
    })
    .collect()
}
