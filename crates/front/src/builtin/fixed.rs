//! The names of the fixed-function pipeline (GLSL 1.20 §7; 1.50 §7.1.1, §7.2, §7.3, §7.5.1, §7.6) as a table: the
//! attributes, varyings and uniforms of 1.10 to 1.30 and of the compatibility profile.
//!
//! *In:* a name, a language and a stage. *Out:* the storage and the type. *Holds:* each is an ordinary input, output or
//! uniform of the shader that names it, under its own name, so that no later phase knows more of it. A program has its
//! values from its host. Not here: lighting, texture environments and fog, which a host computes.

use super::{Availability, Stages};
use crate::language::{ArraySize, Member, NEVER, Stage, Storage, StructType, TypeId, Types, Version};
use crate::source::Span;

/// The type of such a variable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FixedType {
    /// A scalar, vector or matrix.
    Plain(TypeId),
    /// A struct of [`STRUCTS`].
    Struct(&'static str),
    /// An array of a plain type.
    Array(TypeId, u32),
    /// An array of a struct.
    Structs(&'static str, u32),
}

/// A variable of the fixed-function pipeline.
#[derive(Clone, Copy, Debug)]
pub struct FixedRow {
    /// Its name.
    pub name: &'static str,
    /// `In`, `Out` or `Uniform`.
    pub storage: Storage,
    /// Its type.
    pub ty: FixedType,
    /// The languages and stages that have it.
    pub availability: Availability,
}

/// The texture units, light sources and clip planes that every implementation has (§7.4.1).
const UNITS: u32 = 8;
const FLOAT: FixedType = FixedType::Plain(TypeId::FLOAT);
const VEC3: FixedType = FixedType::Plain(TypeId::VEC3);
const VEC4: FixedType = FixedType::Plain(TypeId::VEC4);
const MAT3: FixedType = FixedType::Plain(TypeId::matrix(3, 3));
const MAT4: FixedType = FixedType::Plain(TypeId::matrix(4, 4));
const VEC4S: FixedType = FixedType::Array(TypeId::VEC4, UNITS);
const MAT4S: FixedType = FixedType::Array(TypeId::matrix(4, 4), UNITS);
const WRITERS: Stages = Stages::VERTEX.union(Stages::GEOMETRY);

const fn row(name: &'static str, storage: Storage, ty: FixedType, stages: Stages) -> FixedRow {
    let availability = Availability { compatibility_only: true, ..Availability::since(110).es(NEVER).stages(stages) };
    FixedRow { name, storage, ty, availability }
}

const fn attribute(name: &'static str, ty: FixedType) -> FixedRow {
    row(name, Storage::In, ty, Stages::VERTEX)
}

const fn written(name: &'static str, ty: FixedType) -> FixedRow {
    row(name, Storage::Out, ty, WRITERS)
}

const fn read(name: &'static str, ty: FixedType) -> FixedRow {
    row(name, Storage::In, ty, Stages::FRAGMENT)
}

const fn state(name: &'static str, ty: FixedType) -> FixedRow {
    row(name, Storage::Uniform, ty, Stages::all())
}

/// The array of texture coordinates, whose size a shader may state or leave to its uses (GLSL 1.20 §7.6).
pub const TEX_COORD: &str = "gl_TexCoord";

/// All variables.
pub static FIXED: &[FixedRow] = &[
    attribute("gl_Color", VEC4),
    attribute("gl_SecondaryColor", VEC4),
    attribute("gl_Normal", VEC3),
    attribute("gl_Vertex", VEC4),
    attribute("gl_MultiTexCoord0", VEC4),
    attribute("gl_MultiTexCoord1", VEC4),
    attribute("gl_MultiTexCoord2", VEC4),
    attribute("gl_MultiTexCoord3", VEC4),
    attribute("gl_MultiTexCoord4", VEC4),
    attribute("gl_MultiTexCoord5", VEC4),
    attribute("gl_MultiTexCoord6", VEC4),
    attribute("gl_MultiTexCoord7", VEC4),
    attribute("gl_FogCoord", FLOAT),
    written("gl_ClipVertex", VEC4),
    written("gl_FrontColor", VEC4),
    written("gl_BackColor", VEC4),
    written("gl_FrontSecondaryColor", VEC4),
    written("gl_BackSecondaryColor", VEC4),
    written(TEX_COORD, VEC4S),
    written("gl_FogFragCoord", FLOAT),
    read("gl_Color", VEC4),
    read("gl_SecondaryColor", VEC4),
    read(TEX_COORD, VEC4S),
    read("gl_FogFragCoord", FLOAT),
    state("gl_ModelViewMatrix", MAT4),
    state("gl_ProjectionMatrix", MAT4),
    state("gl_ModelViewProjectionMatrix", MAT4),
    state("gl_TextureMatrix", MAT4S),
    state("gl_NormalMatrix", MAT3),
    state("gl_ModelViewMatrixInverse", MAT4),
    state("gl_ProjectionMatrixInverse", MAT4),
    state("gl_ModelViewProjectionMatrixInverse", MAT4),
    state("gl_TextureMatrixInverse", MAT4S),
    state("gl_ModelViewMatrixTranspose", MAT4),
    state("gl_ProjectionMatrixTranspose", MAT4),
    state("gl_ModelViewProjectionMatrixTranspose", MAT4),
    state("gl_TextureMatrixTranspose", MAT4S),
    state("gl_ModelViewMatrixInverseTranspose", MAT4),
    state("gl_ProjectionMatrixInverseTranspose", MAT4),
    state("gl_ModelViewProjectionMatrixInverseTranspose", MAT4),
    state("gl_TextureMatrixInverseTranspose", MAT4S),
    state("gl_NormalScale", FLOAT),
    state("gl_ClipPlane", VEC4S),
    state("gl_Point", FixedType::Struct("gl_PointParameters")),
    state("gl_FrontMaterial", FixedType::Struct("gl_MaterialParameters")),
    state("gl_BackMaterial", FixedType::Struct("gl_MaterialParameters")),
    state("gl_LightSource", FixedType::Structs("gl_LightSourceParameters", UNITS)),
    state("gl_LightModel", FixedType::Struct("gl_LightModelParameters")),
    state("gl_FrontLightModelProduct", FixedType::Struct("gl_LightModelProducts")),
    state("gl_BackLightModelProduct", FixedType::Struct("gl_LightModelProducts")),
    state("gl_FrontLightProduct", FixedType::Structs("gl_LightProducts", UNITS)),
    state("gl_BackLightProduct", FixedType::Structs("gl_LightProducts", UNITS)),
    state("gl_TextureEnvColor", VEC4S),
    state("gl_EyePlaneS", VEC4S),
    state("gl_EyePlaneT", VEC4S),
    state("gl_EyePlaneR", VEC4S),
    state("gl_EyePlaneQ", VEC4S),
    state("gl_ObjectPlaneS", VEC4S),
    state("gl_ObjectPlaneT", VEC4S),
    state("gl_ObjectPlaneR", VEC4S),
    state("gl_ObjectPlaneQ", VEC4S),
    state("gl_Fog", FixedType::Struct("gl_FogParameters")),
];

/// The structs of §7.5.1, each with its members.
#[rustfmt::skip]
pub static STRUCTS: &[(&str, &[(&str, TypeId)])] = &[
    ("gl_PointParameters", &[
        ("size", TypeId::FLOAT), ("sizeMin", TypeId::FLOAT), ("sizeMax", TypeId::FLOAT),
        ("fadeThresholdSize", TypeId::FLOAT), ("distanceConstantAttenuation", TypeId::FLOAT),
        ("distanceLinearAttenuation", TypeId::FLOAT), ("distanceQuadraticAttenuation", TypeId::FLOAT),
    ]),
    ("gl_MaterialParameters", &[
        ("emission", TypeId::VEC4), ("ambient", TypeId::VEC4), ("diffuse", TypeId::VEC4), ("specular", TypeId::VEC4),
        ("shininess", TypeId::FLOAT),
    ]),
    ("gl_LightSourceParameters", &[
        ("ambient", TypeId::VEC4), ("diffuse", TypeId::VEC4), ("specular", TypeId::VEC4), ("position", TypeId::VEC4),
        ("halfVector", TypeId::VEC4), ("spotDirection", TypeId::VEC3), ("spotExponent", TypeId::FLOAT),
        ("spotCutoff", TypeId::FLOAT), ("spotCosCutoff", TypeId::FLOAT), ("constantAttenuation", TypeId::FLOAT),
        ("linearAttenuation", TypeId::FLOAT), ("quadraticAttenuation", TypeId::FLOAT),
    ]),
    ("gl_LightModelParameters", &[("ambient", TypeId::VEC4)]),
    ("gl_LightModelProducts", &[("sceneColor", TypeId::VEC4)]),
    ("gl_LightProducts", &[("ambient", TypeId::VEC4), ("diffuse", TypeId::VEC4), ("specular", TypeId::VEC4)]),
    ("gl_FogParameters", &[
        ("color", TypeId::VEC4), ("density", TypeId::FLOAT), ("start", TypeId::FLOAT), ("end", TypeId::FLOAT),
        ("scale", TypeId::FLOAT),
    ]),
];

/// The variable with a name in a language and stage.
pub fn named(name: &str, version: Version, stage: Stage) -> Option<&'static FixedRow> {
    FIXED
        .iter()
        .find(|row| row.name == name && row.availability.stages.has(stage) && row.availability.in_version(version))
}

/// The member of `gl_PerVertex` with a name that the compatibility profile of a version adds.
pub fn per_vertex(name: &str, version: Version, stage: Stage) -> Option<&'static FixedRow> {
    let stage = if stage == Stage::Geometry { Stage::Vertex } else { stage };
    named(name, version, stage).filter(|row| row.storage == Storage::Out && PER_VERTEX.contains(&row.name))
}

/// Whether a name is one of the fixed-function pipeline, in any language and stage.
pub fn is_fixed(name: &str) -> bool {
    FIXED.iter().any(|row| row.name == name)
}

/// The stages that have a variable with this name in a language.
pub fn stages_with(name: &str, version: Version) -> impl Iterator<Item = Stage> {
    Stage::ALL.into_iter().filter(move |&stage| named(name, version, stage).is_some())
}

/// The struct with a name in a language. It is created at each call.
pub fn structure(types: &mut Types, name: &str, version: Version) -> Option<TypeId> {
    let has = FIXED.first().is_some_and(|row| row.availability.in_version(version));
    let (name, members) = STRUCTS.iter().find(|row| row.0 == name && has)?;
    let member = |&(name, ty): &(&str, TypeId)| Member::plain(name, ty, Span::default());
    let members = members.iter().map(member).collect();
    Some(types.add_struct(StructType { name: (*name).to_owned(), members, is_block: false, span: Span::default() }))
}

/// The initial values of the structs (OpenGL 2.1, tables 6.9 to 6.12), in the order of the members.
#[rustfmt::skip]
static INITIAL: &[(&str, &[f32])] = &[
    ("gl_PointParameters", &[1.0, 0.0, 1.0, 1.0, 1.0, 0.0, 0.0]),
    ("gl_MaterialParameters", &[
        0.0, 0.0, 0.0, 1.0,  0.2, 0.2, 0.2, 1.0,  0.8, 0.8, 0.8, 1.0,  0.0, 0.0, 0.0, 1.0,  0.0,
    ]),
    ("gl_LightSourceParameters", &[
        0.0, 0.0, 0.0, 1.0,  0.0, 0.0, 0.0, 1.0,  0.0, 0.0, 0.0, 1.0,  0.0, 0.0, 1.0, 0.0,  0.0, 0.0, 1.0, 0.0,
        0.0, 0.0, -1.0,  0.0, 180.0, -1.0, 1.0, 0.0, 0.0,
    ]),
    ("gl_LightModelParameters", &[0.2, 0.2, 0.2, 1.0]),
    ("gl_LightModelProducts", &[0.04, 0.04, 0.04, 1.0]),
    ("gl_LightProducts", &[0.0, 0.0, 0.0, 1.0,  0.0, 0.0, 0.0, 1.0,  0.0, 0.0, 0.0, 1.0]),
    ("gl_FogParameters", &[0.0, 0.0, 0.0, 0.0,  1.0, 0.0, 1.0, 1.0]),
];

/// The components of the first light's diffuse and specular colors, which are 1, and those of their products with the
/// initial material.
static FIRST_LIGHT: &[(&str, std::ops::Range<usize>, f32)] =
    &[("gl_LightSource", 4..12, 1.0), ("gl_FrontLightProduct", 4..7, 0.8), ("gl_BackLightProduct", 4..7, 0.8)];

/// The variables that a shader may declare again: with an interpolation qualifier, or with a size (1.50 §4.3.9.1, §7.6).
static REDECLARABLE: &[&str] = &[
    "gl_BackColor",
    "gl_BackSecondaryColor",
    "gl_Color",
    "gl_FogFragCoord",
    "gl_FrontColor",
    "gl_FrontSecondaryColor",
    "gl_SecondaryColor",
    TEX_COORD,
];

impl FixedRow {
    /// Whether a shader may declare it again.
    pub fn is_redeclarable(&self) -> bool {
        self.storage != Storage::Uniform && REDECLARABLE.contains(&self.name)
    }

    /// The initial value of a uniform, in flat order: the identity for matrices, the tables of OpenGL for structs, 0 for
    /// everything else.
    pub fn initial(&self) -> Vec<f32> {
        let identity = |ty: TypeId| match ty {
            _ if ty == TypeId::matrix(3, 3) => (0..9).map(|index| f32::from(u8::from(index % 4 == 0))).collect(),
            _ if ty == TypeId::matrix(4, 4) => (0..16).map(|index| f32::from(u8::from(index % 5 == 0))).collect(),
            _ if ty == TypeId::VEC4 => vec![0.0; 4],
            // `gl_NormalScale`, of the identity.
            _ => vec![1.0],
        };
        let structure = |name: &str| INITIAL.iter().find(|row| row.0 == name).map_or(Vec::new(), |row| row.1.to_vec());
        let (one, count) = match self.ty {
            FixedType::Plain(ty) => (identity(ty), 1),
            FixedType::Array(ty, count) => (identity(ty), count),
            FixedType::Struct(name) => (structure(name), 1),
            FixedType::Structs(name, count) => (structure(name), count),
        };
        let mut all = one.repeat(count as usize);
        for (_, range, value) in FIRST_LIGHT.iter().filter(|row| row.0 == self.name) {
            all.iter_mut().take(range.end).skip(range.start).for_each(|slot| *slot = *value);
        }
        // Texture coordinates are generated from x and y (table 6.17).
        let generated = self.name.starts_with("gl_EyePlane") || self.name.starts_with("gl_ObjectPlane");
        let first = ["S", "T"].iter().position(|end| generated && self.name.ends_with(end));
        if let Some(first) = first {
            all.iter_mut().skip(first).step_by(4).for_each(|slot| *slot = 1.0);
        }
        all
    }
}

/// The members of `gl_PerVertex` that the compatibility profile adds (§7.1.1).
pub(super) static PER_VERTEX: &[&str] = &[
    "gl_ClipVertex",
    "gl_FrontColor",
    "gl_BackColor",
    "gl_FrontSecondaryColor",
    "gl_BackSecondaryColor",
    TEX_COORD,
    "gl_FogFragCoord",
];

impl FixedRow {
    /// The type, given the structs of the shader by name.
    pub fn make_type(
        &self,
        types: &mut Types,
        structure: &mut dyn FnMut(&mut Types, &'static str) -> TypeId,
    ) -> TypeId {
        match self.ty {
            FixedType::Plain(ty) => ty,
            FixedType::Struct(name) => structure(types, name),
            FixedType::Array(ty, size) => types.array(ty, ArraySize::Sized(size)),
            FixedType::Structs(name, size) => {
                let element = structure(types, name);
                types.array(element, ArraySize::Sized(size))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::language::Profile;

    fn version(number: u16, profile: Profile) -> Version {
        Version { number, profile, span: Span::default() }
    }

    #[test]
    fn old_versions_and_the_compatibility_profile_have_them() {
        let has = |number, profile| named("gl_Vertex", version(number, profile), Stage::Vertex).is_some();
        assert!(has(110, Profile::Core) && has(130, Profile::Core) && !has(140, Profile::Core));
        assert!(has(150, Profile::Compatibility) && has(460, Profile::Compatibility) && !has(330, Profile::Core));
        assert!(!has(100, Profile::Es) && !has(300, Profile::Es));
        assert!(named("gl_Vertex", version(120, Profile::Core), Stage::Fragment).is_none());
    }

    #[test]
    fn a_name_means_one_thing_in_a_stage_and_every_struct_is_there() {
        let mut types = Types::new();
        for stage in Stage::ALL {
            for row in FIXED.iter().filter(|row| row.availability.stages.has(stage)) {
                let same = FIXED.iter().filter(|other| other.name == row.name && other.availability.stages.has(stage));
                assert_eq!(same.count(), 1, "{}", row.name);
            }
        }
        for row in FIXED {
            if let FixedType::Struct(name) | FixedType::Structs(name, _) = row.ty {
                assert!(structure(&mut types, name, version(110, Profile::Core)).is_some(), "{name}");
            }
        }
        assert!(PER_VERTEX.iter().all(|name| is_fixed(name)));
        for row in FIXED.iter().filter(|row| row.storage == Storage::Uniform) {
            let ty = row.make_type(&mut types, &mut |types, name| {
                structure(types, name, version(110, Profile::Core)).unwrap_or(TypeId::ERROR)
            });
            assert_eq!(row.initial().len(), types.flat_len(ty) as usize, "{}", row.name);
        }
    }
}
