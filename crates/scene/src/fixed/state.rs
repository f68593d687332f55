//! The state that a host sets, with the initial values of OpenGL 2.1 (tables 6.7 to 6.17).
//!
//! *Holds:* positions, directions and planes are in eye space, as OpenGL keeps them.

use super::UNITS;
use glam::DMat4;

/// A light source (OpenGL 2.1 §2.14.1).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightSource {
    /// Ambient intensity.
    pub ambient: [f64; 4],
    /// Diffuse intensity.
    pub diffuse: [f64; 4],
    /// Specular intensity.
    pub specular: [f64; 4],
    /// The position in eye space. With w = 0, the direction towards a light at infinity.
    pub position: [f64; 4],
    /// The direction of the beam in eye space.
    pub spot_direction: [f64; 3],
    /// The exponent of the falloff within the beam.
    pub spot_exponent: f64,
    /// Half the angle of the beam in degrees: 0 to 90, or 180 for a light without a beam.
    pub spot_cutoff: f64,
    /// Constant, linear and quadratic attenuation.
    pub attenuation: [f64; 3],
}

impl LightSource {
    /// The initial state of light `index`: the first is white, the others are black.
    pub fn initial(index: usize) -> Self {
        let color = if index == 0 { [1.0; 4] } else { [0.0, 0.0, 0.0, 1.0] };
        Self {
            ambient: [0.0, 0.0, 0.0, 1.0],
            diffuse: color,
            specular: color,
            position: [0.0, 0.0, 1.0, 0.0],
            spot_direction: [0.0, 0.0, -1.0],
            spot_exponent: 0.0,
            spot_cutoff: 180.0,
            attenuation: [1.0, 0.0, 0.0],
        }
    }
}

/// The material of one side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// The light that it emits.
    pub emission: [f64; 4],
    /// The ambient color.
    pub ambient: [f64; 4],
    /// The diffuse color; its alpha is that of the lit color.
    pub diffuse: [f64; 4],
    /// The specular color.
    pub specular: [f64; 4],
    /// The specular exponent, 0 to 128.
    pub shininess: f64,
}

impl Default for Material {
    fn default() -> Self {
        Self {
            emission: [0.0, 0.0, 0.0, 1.0],
            ambient: [0.2, 0.2, 0.2, 1.0],
            diffuse: [0.8, 0.8, 0.8, 1.0],
            specular: [0.0, 0.0, 0.0, 1.0],
            shininess: 0.0,
        }
    }
}

/// Fog (OpenGL 2.1 §3.10).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fog {
    /// The color.
    pub color: [f64; 4],
    /// The density, of exponential fog.
    pub density: f64,
    /// Where linear fog starts.
    pub start: f64,
    /// Where linear fog is complete.
    pub end: f64,
}

/// The size of points (OpenGL 2.1 §3.3).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointParameters {
    /// The size in pixels, before attenuation.
    pub size: f64,
    /// The smallest size.
    pub size_min: f64,
    /// The largest size.
    pub size_max: f64,
    /// The size below which points fade.
    pub fade_threshold: f64,
    /// Constant, linear and quadratic attenuation by the distance.
    pub attenuation: [f64; 3],
}

/// The state of the fixed-function pipeline that shaders can read (GLSL 1.20 §7.5).
#[derive(Clone, Debug, PartialEq)]
pub struct FixedFunction {
    /// From object space to eye space.
    pub model_view: DMat4,
    /// From eye space to clip space.
    pub projection: DMat4,
    /// Of each texture unit.
    pub texture: [DMat4; UNITS],
    /// The light sources.
    pub lights: [LightSource; UNITS],
    /// The material of front faces.
    pub front: Material,
    /// The material of back faces.
    pub back: Material,
    /// Ambient light that belongs to no light source.
    pub light_model_ambient: [f64; 4],
    /// Fog.
    pub fog: Fog,
    /// The clip planes in eye space.
    pub clip_planes: [[f64; 4]; UNITS],
    /// The size of points.
    pub point: PointParameters,
    /// The environment color of each texture unit.
    pub texture_env_colors: [[f64; 4]; UNITS],
    /// For s, t, r and q: the plane of each unit that `EYE_LINEAR` generates coordinates from.
    pub eye_planes: [[[f64; 4]; UNITS]; 4],
    /// For s, t, r and q: the plane of each unit that `OBJECT_LINEAR` generates coordinates from.
    pub object_planes: [[[f64; 4]; UNITS]; 4],
}

impl Default for FixedFunction {
    fn default() -> Self {
        let planes = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0; 4], [0.0; 4]].map(|plane| [plane; UNITS]);
        Self {
            model_view: DMat4::IDENTITY,
            projection: DMat4::IDENTITY,
            texture: [DMat4::IDENTITY; UNITS],
            lights: std::array::from_fn(LightSource::initial),
            front: Material::default(),
            back: Material::default(),
            light_model_ambient: [0.2, 0.2, 0.2, 1.0],
            fog: Fog { color: [0.0; 4], density: 1.0, start: 0.0, end: 1.0 },
            clip_planes: [[0.0; 4]; UNITS],
            // The largest size is up to an implementation, which must have 1.
            point: PointParameters {
                size: 1.0,
                size_min: 0.0,
                size_max: 1.0,
                fade_threshold: 1.0,
                attenuation: [1.0, 0.0, 0.0],
            },
            texture_env_colors: [[0.0; 4]; UNITS],
            eye_planes: planes,
            object_planes: planes,
        }
    }
}

/// A visitor, which is shown the name of a uniform, the index in its array, a member, and its numbers.
type Each<'a> = dyn FnMut(&'static str, usize, &'static str, &mut [f64]) + 'a;

impl FixedFunction {
    /// The same state as OpenGL stores it: rounded to f32.
    #[must_use]
    pub fn rounded(&self) -> Self {
        let mut rounded = self.clone();
        rounded.visit(&mut |_, _, _, values| {
            for value in values {
                *value = f64::from(*value as f32);
            }
        });
        rounded
    }

    /// Visits all values: the name of the uniform, the index in its array, the member, the numbers. Matrices are
    /// column by column.
    pub(super) fn visit(&mut self, each: &mut Each<'_>) {
        each("gl_ModelViewMatrix", 0, "", self.model_view.as_mut());
        each("gl_ProjectionMatrix", 0, "", self.projection.as_mut());
        for (index, matrix) in self.texture.iter_mut().enumerate() {
            each("gl_TextureMatrix", index, "", matrix.as_mut());
        }
        for (index, light) in self.lights.iter_mut().enumerate() {
            light.visit(index, each);
        }
        self.front.visit("gl_FrontMaterial", each);
        self.back.visit("gl_BackMaterial", each);
        each("gl_LightModel", 0, "ambient", &mut self.light_model_ambient);
        let fog = &mut self.fog;
        each("gl_Fog", 0, "color", &mut fog.color);
        for (member, value) in [("density", &mut fog.density), ("start", &mut fog.start), ("end", &mut fog.end)] {
            each("gl_Fog", 0, member, std::slice::from_mut(value));
        }
        self.point.visit(each);
        const EYE: [&str; 4] = ["gl_EyePlaneS", "gl_EyePlaneT", "gl_EyePlaneR", "gl_EyePlaneQ"];
        const OBJECT: [&str; 4] = ["gl_ObjectPlaneS", "gl_ObjectPlaneT", "gl_ObjectPlaneR", "gl_ObjectPlaneQ"];
        let named = [("gl_ClipPlane", &mut self.clip_planes), ("gl_TextureEnvColor", &mut self.texture_env_colors)];
        let generated =
            EYE.into_iter().zip(&mut self.eye_planes).chain(OBJECT.into_iter().zip(&mut self.object_planes));
        for (name, planes) in named.into_iter().chain(generated) {
            for (index, plane) in planes.iter_mut().enumerate() {
                each(name, index, "", plane);
            }
        }
    }
}

impl LightSource {
    fn visit(&mut self, index: usize, each: &mut Each<'_>) {
        let name = "gl_LightSource";
        each(name, index, "ambient", &mut self.ambient);
        each(name, index, "diffuse", &mut self.diffuse);
        each(name, index, "specular", &mut self.specular);
        each(name, index, "position", &mut self.position);
        each(name, index, "spotDirection", &mut self.spot_direction);
        each(name, index, "spotExponent", std::slice::from_mut(&mut self.spot_exponent));
        each(name, index, "spotCutoff", std::slice::from_mut(&mut self.spot_cutoff));
        let members = ["constantAttenuation", "linearAttenuation", "quadraticAttenuation"];
        for (member, value) in members.into_iter().zip(&mut self.attenuation) {
            each(name, index, member, std::slice::from_mut(value));
        }
    }
}

impl Material {
    fn visit(&mut self, name: &'static str, each: &mut Each<'_>) {
        each(name, 0, "emission", &mut self.emission);
        each(name, 0, "ambient", &mut self.ambient);
        each(name, 0, "diffuse", &mut self.diffuse);
        each(name, 0, "specular", &mut self.specular);
        each(name, 0, "shininess", std::slice::from_mut(&mut self.shininess));
    }
}

impl PointParameters {
    fn visit(&mut self, each: &mut Each<'_>) {
        let sizes = [
            ("size", &mut self.size),
            ("sizeMin", &mut self.size_min),
            ("sizeMax", &mut self.size_max),
            ("fadeThresholdSize", &mut self.fade_threshold),
        ];
        let members = ["distanceConstantAttenuation", "distanceLinearAttenuation", "distanceQuadraticAttenuation"];
        for (member, value) in sizes.into_iter().chain(members.into_iter().zip(&mut self.attenuation)) {
            each("gl_Point", 0, member, std::slice::from_mut(value));
        }
    }
}
