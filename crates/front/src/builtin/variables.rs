//! The built-in variables (GLSL 1.50 §7.1, §7.2, §7.5) as a table, with one [`Row`] for each variable and direction.
//!
//! *In:* a name, a language and a stage. *Out:* the variable's identity, storage and type. *Not done here:* the sizes
//! of `gl_ClipDistance` and `gl_in`, which follow from redeclarations, uses or the input primitive.

use super::{Availability, BuiltinVariable, Stages, constants, fixed};
use crate::language::{
    ArraySize, Extensions, Member, NEVER, Scalar, Since, Stage, Storage, StructType, TypeId, Types, Version,
};
use crate::source::Span;

/// The type of a built-in variable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VariableType {
    /// A scalar or vector.
    Plain(TypeId),
    /// `float[]`, unsized until the shader sizes it (`gl_ClipDistance`).
    UnsizedFloats,
    /// `vec4[n]` (`gl_FragData`).
    Vec4s(u32),
    /// `int[n]` (`gl_SampleMaskIn`).
    Ints(u32),
    /// The struct of `in gl_PerVertex { .. } gl_in[]`, in an unsized array.
    PerVertexArray,
    /// `struct gl_DepthRangeParameters { float near, far, diff; }`
    DepthRange,
}

/// The properties that a redeclaration may change.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Redeclaration {
    /// None. `invariant` is still allowed if the variable is an output or a fragment input.
    No,
    /// The size.
    Size,
    /// The layout qualifiers.
    Layout,
    /// A hint about the depth that is written.
    Depth,
}

/// A built-in variable in one direction.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    /// The identity of the variable.
    pub variable: BuiltinVariable,
    /// Its name in GLSL.
    pub name: &'static str,
    /// `In`, `Out` or `Uniform`.
    pub storage: Storage,
    /// Its type.
    pub ty: VariableType,
    /// The languages and stages in which it exists.
    pub availability: Availability,
    /// The properties that a redeclaration may change.
    pub redeclaration: Redeclaration,
    /// Whether it is a member of `gl_PerVertex`, which ARB_separate_shader_objects and 1.50 let a shader redeclare.
    pub per_vertex: bool,
    /// Whether the specification calls it deprecated.
    pub deprecated: bool,
    /// The section of GLSL 1.50.
    pub section: &'static str,
}

impl Row {
    const fn new(variable: BuiltinVariable, name: &'static str, storage: Storage, ty: VariableType) -> Self {
        Self {
            variable,
            name,
            storage,
            ty,
            availability: Availability::since(110),
            redeclaration: Redeclaration::No,
            per_vertex: false,
            deprecated: false,
            section: "§7.1",
        }
    }

    const fn at(self, since: u16, stages: Stages) -> Self {
        Self { availability: Availability::since(since).stages(stages), ..self }
    }

    const fn per_vertex(self) -> Self {
        Self { per_vertex: true, ..self }
    }

    const fn redeclared(self, redeclaration: Redeclaration) -> Self {
        Self { redeclaration, ..self }
    }

    const fn fragment(self, since: u16) -> Self {
        Self { section: "§7.2", ..self }.at(since, Stages::FRAGMENT)
    }

    /// The names of 1.10 that the core of 4.20 and ES 3.00 lack.
    const fn deprecated(self) -> Self {
        Self { deprecated: true, availability: self.availability.until(Since::new(420, 300)), ..self }
    }

    const fn es(self, es: u16) -> Self {
        Self { availability: self.availability.es(es), ..self }
    }

    const fn or(self, extensions: Extensions) -> Self {
        Self { availability: self.availability.or(extensions), ..self }
    }

    /// The type. The two structs are created at each call.
    pub fn make_type(&self, types: &mut Types, version: Version) -> TypeId {
        match self.ty {
            VariableType::Plain(ty) => ty,
            VariableType::UnsizedFloats => types.array(TypeId::FLOAT, ArraySize::Unsized),
            VariableType::Vec4s(size) => types.array(TypeId::VEC4, ArraySize::Sized(size)),
            VariableType::Ints(size) => types.array(TypeId::INT, ArraySize::Sized(size)),
            VariableType::PerVertexArray => {
                let clip_distance = types.array(TypeId::FLOAT, ArraySize::Unsized);
                let mut members = vec![
                    ("gl_Position", TypeId::VEC4),
                    ("gl_PointSize", TypeId::FLOAT),
                    ("gl_ClipDistance", clip_distance),
                ];
                for name in fixed::PER_VERTEX {
                    if let Some(row) = fixed::named(name, version, Stage::Geometry) {
                        members.push((name, row.make_type(types, &mut |_, _| TypeId::ERROR)));
                    }
                }
                let block = structure(types, "gl_PerVertex", &members, true);
                types.array(block, ArraySize::Unsized)
            }
            VariableType::DepthRange => {
                let members = ["near", "far", "diff"].map(|name| (name, TypeId::FLOAT));
                structure(types, DEPTH_RANGE_STRUCT, &members, false)
            }
        }
    }
}

/// The name of the type of `gl_DepthRange` (§7.5).
pub const DEPTH_RANGE_STRUCT: &str = "gl_DepthRangeParameters";

fn structure(types: &mut Types, name: &str, members: &[(&str, TypeId)], is_block: bool) -> TypeId {
    let members = members.iter().map(|&(name, ty)| Member::plain(name, ty, Span::default())).collect();
    types.add_struct(StructType { name: name.into(), members, is_block, span: Span::default() })
}

const INT: VariableType = VariableType::Plain(TypeId::INT);
const FLOAT: VariableType = VariableType::Plain(TypeId::FLOAT);
const VEC2: VariableType = VariableType::Plain(TypeId::VEC2);
const VEC4: VariableType = VariableType::Plain(TypeId::VEC4);
const BOOL: VariableType = VariableType::Plain(TypeId::vector(Scalar::Bool, 1));
const WRITERS: Stages = Stages::VERTEX.union(Stages::GEOMETRY);
const INSTANCING: Availability = Availability::extension(Extensions::DRAW_INSTANCED).stages(Stages::VERTEX);

use BuiltinVariable as V;
use Storage::{In, Out, Uniform};

/// All variables.
pub static VARIABLES: &[Row] = &[
    Row::new(V::Position, "gl_Position", Out, VEC4).at(110, WRITERS).per_vertex(),
    Row::new(V::PointSize, "gl_PointSize", Out, FLOAT).at(110, WRITERS).per_vertex(),
    Row::new(V::ClipDistance, "gl_ClipDistance", Out, VariableType::UnsizedFloats)
        .at(130, WRITERS)
        .es(NEVER)
        .per_vertex()
        .redeclared(Redeclaration::Size),
    Row::new(V::VertexId, "gl_VertexID", In, INT).at(130, Stages::VERTEX).or(Extensions::GPU_SHADER4),
    Row::new(V::InstanceId, "gl_InstanceID", In, INT).at(140, Stages::VERTEX).es(300).or(Extensions::GPU_SHADER4),
    Row {
        availability: INSTANCING,
        section: "ARB_draw_instanced",
        ..Row::new(V::InstanceId, "gl_InstanceIDARB", In, INT)
    },
    Row::new(V::In, "gl_in", In, VariableType::PerVertexArray)
        .at(150, Stages::GEOMETRY)
        .es(320)
        .redeclared(Redeclaration::Size),
    Row::new(V::PrimitiveIdIn, "gl_PrimitiveIDIn", In, INT).at(150, Stages::GEOMETRY).es(320),
    Row::new(V::InvocationId, "gl_InvocationID", In, INT).at(400, Stages::GEOMETRY).es(320).or(Extensions::GPU_SHADER5),
    Row::new(V::PrimitiveId, "gl_PrimitiveID", Out, INT).at(150, Stages::GEOMETRY).es(320),
    Row::new(V::Layer, "gl_Layer", Out, INT).at(150, Stages::GEOMETRY).es(320),
    Row::new(V::FragCoord, "gl_FragCoord", In, VEC4).fragment(110).redeclared(Redeclaration::Layout),
    Row::new(V::FrontFacing, "gl_FrontFacing", In, BOOL).fragment(110),
    Row::new(V::ClipDistance, "gl_ClipDistance", In, VariableType::UnsizedFloats)
        .fragment(130)
        .es(NEVER)
        .redeclared(Redeclaration::Size),
    Row::new(V::FragColor, "gl_FragColor", Out, VEC4).fragment(110).deprecated(),
    Row::new(V::FragData, "gl_FragData", Out, VariableType::Vec4s(constants::MAX_DRAW_BUFFERS))
        .fragment(110)
        .deprecated(),
    Row::new(V::FragDepth, "gl_FragDepth", Out, FLOAT).fragment(110).es(300).redeclared(Redeclaration::Depth),
    Row {
        availability: Availability::extension(Extensions::FRAG_DEPTH).stages(Stages::FRAGMENT),
        section: "EXT_frag_depth",
        ..Row::new(V::FragDepth, "gl_FragDepthEXT", Out, FLOAT)
    },
    Row::new(V::PointCoord, "gl_PointCoord", In, VEC2).fragment(120).es(100),
    Row::new(V::PrimitiveId, "gl_PrimitiveID", In, INT).fragment(150).es(320).or(Extensions::GPU_SHADER4),
    Row {
        section: "GLSL 4.00 §7.1",
        ..Row::new(V::SampleId, "gl_SampleID", In, INT).fragment(400).es(320).or(Extensions::SAMPLE_SHADING)
    },
    Row {
        section: "GLSL 4.00 §7.1",
        ..Row::new(V::SampleMaskIn, "gl_SampleMaskIn", In, VariableType::Ints(1))
            .fragment(400)
            .es(320)
            .or(Extensions::GPU_SHADER5)
    },
    Row { section: "§7.5", ..Row::new(V::DepthRange, "gl_DepthRange", Uniform, VariableType::DepthRange) },
];

/// The variable with a name in a language and stage.
pub fn named(name: &str, version: Version, extensions: Extensions, stage: Stage) -> Option<&'static Row> {
    in_stage(version, extensions, stage).find(|row| row.name == name)
}

/// All variables of a language and stage, for lists of candidates.
pub fn in_stage(version: Version, extensions: Extensions, stage: Stage) -> impl Iterator<Item = &'static Row> {
    VARIABLES.iter().filter(move |row| row.availability.holds(version, extensions, stage))
}

/// The stages that have a variable with this name, for the message in a stage that lacks it.
pub fn stages_with(name: &str) -> impl Iterator<Item = Stage> {
    Stage::ALL
        .into_iter()
        .filter(move |&stage| VARIABLES.iter().any(|row| row.name == name && row.availability.stages.has(stage)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::language::Profile;

    const CORE: Version = Version {
        number: 150,
        profile: Profile::Core,
        span: Span { start: 0, end: 0, expansion: crate::source::ExpansionId::NONE },
    };

    #[test]
    fn every_variable_has_a_row_under_its_own_name() {
        for &variable in BuiltinVariable::ALL {
            assert!(VARIABLES.iter().any(|row| row.variable == variable && row.name == variable.name()));
        }
    }

    #[test]
    fn a_name_means_one_thing_in_a_stage() {
        for stage in Stage::ALL {
            let names: Vec<_> = in_stage(CORE, Extensions::all(), stage).map(|row| row.name).collect();
            let mut unique = names.clone();
            unique.sort_unstable();
            unique.dedup();
            assert_eq!(unique.len(), names.len(), "{stage:?}");
        }
    }

    #[test]
    fn stage_and_extension_decide() {
        let find = |name, extensions, stage| named(name, CORE, extensions, stage).map(|row| row.storage);
        assert_eq!(find("gl_PrimitiveID", Extensions::empty(), Stage::Geometry), Some(Out));
        assert_eq!(find("gl_PrimitiveID", Extensions::empty(), Stage::Fragment), Some(In));
        assert_eq!(find("gl_PrimitiveID", Extensions::empty(), Stage::Vertex), None);
        assert_eq!(find("gl_InstanceIDARB", Extensions::empty(), Stage::Vertex), None);
        assert_eq!(find("gl_InstanceIDARB", Extensions::DRAW_INSTANCED, Stage::Vertex), Some(In));
        assert_eq!(stages_with("gl_Layer").collect::<Vec<_>>(), [Stage::Geometry]);
    }
}
