//! The switches of the fixed-function pipeline, from which its two stages are written.
//!
//! *Holds:* the numbers of the state are not here: the texts read them from the uniforms of GLSL 1.20 §7.5.

use super::UNITS;
use super::combine::Combine;

/// The language of the texts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum GlslDialect {
    /// `#version 120`: `varying`, `texture2D`, `gl_FragColor`.
    #[default]
    V120,
    /// `#version 150 compatibility`: `texture` and a declared output.
    V150,
}

/// The scaling of normals after their transformation (OpenGL 2.1 §2.11.3).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum NormalScaling {
    /// Nothing.
    #[default]
    None,
    /// `GL_RESCALE_NORMAL`: they are multiplied by `gl_NormalScale`.
    Rescale,
    /// `GL_NORMALIZE`
    Normalize,
}

impl NormalScaling {
    /// The names in scene files.
    pub const NAMES: &[(&str, Self)] =
        &[("none", Self::None), ("rescale", Self::Rescale), ("normalize", Self::Normalize)];
}

/// Which colors of the material are the vertex's (`glColorMaterial`, OpenGL 2.1 §2.14.3).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(missing_docs, reason = "the names say it")]
pub enum ColorMaterial {
    Emission,
    Ambient,
    Diffuse,
    Specular,
    AmbientAndDiffuse,
}

impl ColorMaterial {
    /// The names in scene files.
    pub const NAMES: &[(&str, Option<Self>)] = &[
        ("none", None),
        ("emission", Some(Self::Emission)),
        ("ambient", Some(Self::Ambient)),
        ("diffuse", Some(Self::Diffuse)),
        ("specular", Some(Self::Specular)),
        ("ambient_and_diffuse", Some(Self::AmbientAndDiffuse)),
    ];
}

/// How fog grows (OpenGL 2.1 §3.10).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(missing_docs, reason = "the names say it")]
pub enum FogMode {
    Linear,
    Exp,
    Exp2,
}

impl FogMode {
    /// The names in scene files.
    pub const NAMES: &[(&str, Option<Self>)] =
        &[("none", None), ("linear", Some(Self::Linear)), ("exp", Some(Self::Exp)), ("exp2", Some(Self::Exp2))];
}

/// The number that fog grows with (`GL_FOG_COORD_SRC`).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FogSource {
    /// The distance along the view direction.
    #[default]
    Depth,
    /// `gl_FogCoord`
    Coordinate,
}

impl FogSource {
    /// The names in scene files.
    pub const NAMES: &[(&str, Self)] = &[("depth", Self::Depth), ("coordinate", Self::Coordinate)];
}

/// How a texture changes a color (OpenGL 2.1 §3.8.13).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[expect(missing_docs, reason = "the names say it")]
pub enum EnvironmentMode {
    #[default]
    Modulate,
    Replace,
    Decal,
    Blend,
    Add,
    /// By [`TextureUnit::combine`].
    Combine,
}

impl EnvironmentMode {
    /// The names in scene files.
    pub const NAMES: &[(&str, Self)] = &[
        ("modulate", Self::Modulate),
        ("replace", Self::Replace),
        ("decal", Self::Decal),
        ("blend", Self::Blend),
        ("add", Self::Add),
        ("combine", Self::Combine),
    ];
}

/// The kind of texture that a unit samples.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[expect(missing_docs, reason = "the names say it")]
pub enum TextureTarget {
    D1,
    #[default]
    D2,
    D3,
    Cube,
}

impl TextureTarget {
    /// The names in scene files.
    pub const NAMES: &[(&str, Self)] = &[("1d", Self::D1), ("2d", Self::D2), ("3d", Self::D3), ("cube", Self::Cube)];
}

/// How texture coordinates are generated (OpenGL 2.1 §2.11.4).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(missing_docs, reason = "the names say it")]
pub enum TexGen {
    ObjectLinear,
    EyeLinear,
    SphereMap,
    ReflectionMap,
    NormalMap,
}

impl TexGen {
    /// The names in scene files.
    pub const NAMES: &[(&str, Option<Self>)] = &[
        ("none", None),
        ("object_linear", Some(Self::ObjectLinear)),
        ("eye_linear", Some(Self::EyeLinear)),
        ("sphere_map", Some(Self::SphereMap)),
        ("reflection_map", Some(Self::ReflectionMap)),
        ("normal_map", Some(Self::NormalMap)),
    ];
}

/// An enabled texture unit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TextureUnit {
    /// The kind of its texture.
    pub target: TextureTarget,
    /// Its effect on the color.
    pub mode: EnvironmentMode,
    /// The functions of [`EnvironmentMode::Combine`].
    pub combine: Combine,
    /// How its coordinates are generated; `None`: they are the vertex's.
    pub generate: Option<TexGen>,
}

impl TextureUnit {
    /// The other units whose textures its environment reads.
    pub fn others(&self) -> impl Iterator<Item = u8> {
        self.combine.units().filter(|_| self.mode == EnvironmentMode::Combine)
    }
}

/// The switches. The default is OpenGL's initial state: no lighting, no textures, no fog.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Pipeline {
    /// The language of the texts.
    pub dialect: GlslDialect,
    /// `GL_LIGHTING`
    pub lighting: bool,
    /// Which of `gl_LightSource` are enabled.
    pub lights: [bool; UNITS],
    /// `GL_LIGHT_MODEL_LOCAL_VIEWER`: highlights are those of a viewer at the origin of eye space.
    pub local_viewer: bool,
    /// `GL_LIGHT_MODEL_TWO_SIDE`: back faces are lit with the reversed normal and the back material.
    pub two_side: bool,
    /// `GL_SEPARATE_SPECULAR_COLOR`: highlights are added after the textures.
    pub separate_specular: bool,
    /// `glColorMaterial`, of both sides, if it is enabled.
    pub color_material: Option<ColorMaterial>,
    /// The scaling of normals.
    pub normals: NormalScaling,
    /// The texture units.
    pub units: [Option<TextureUnit>; UNITS],
    /// `GL_COLOR_SUM`: the secondary color is added after the textures. Lighting with a separate specular color does
    /// so, too.
    pub color_sum: bool,
    /// Fog.
    pub fog: Option<FogMode>,
    /// The number that fog grows with.
    pub fog_source: FogSource,
    /// The size of points depends on their distance (OpenGL 2.1 §3.3).
    pub point_attenuation: bool,
    /// Whether `gl_ClipVertex` is written.
    pub clip: bool,
    /// The size with which the other stage declares `gl_TexCoord`, if it does.
    pub texture_coordinates: Option<u32>,
}

impl Pipeline {
    /// Whether the secondary color is added.
    pub fn sums_colors(&self) -> bool {
        self.color_sum || self.lighting && self.separate_specular
    }

    /// The enabled units with their numbers.
    pub(super) fn enabled_units(&self) -> impl Iterator<Item = (usize, TextureUnit)> {
        self.units.iter().enumerate().filter_map(|(index, unit)| Some((index, (*unit)?)))
    }

    /// The line with the version.
    pub(super) fn version(&self) -> &'static str {
        match self.dialect {
            GlslDialect::V120 => "#version 120\n",
            GlslDialect::V150 => "#version 150 compatibility\n",
        }
    }

    /// The declaration of `gl_TexCoord` with the size of the other stage.
    pub(super) fn texture_coordinate_declaration(&self, storage: &str) -> String {
        let storage = if self.dialect == GlslDialect::V120 { "varying" } else { storage };
        self.texture_coordinates.map_or_else(String::new, |size| format!("{storage} vec4 gl_TexCoord[{size}];\n"))
    }
}
