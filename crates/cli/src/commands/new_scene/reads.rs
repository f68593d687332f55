//! [`Reads`]: what a program reads.
//!
//! *In:* a linked program. *Out:* its attributes with their roles, the uniforms and samplers that it reads, and the state of the
//! fixed-function pipeline. *Holds:* a member of a struct that no stage reads is left out; what follows from the scene (`gl_Vertex`,
//! `gl_ModelViewMatrix`) is state, not a uniform.

use glisten_front::builtin::{BuiltinFunction, BuiltinVariable};
use glisten_front::hir::{Expr, ExprKind, PrimitiveIn, Scalar, Shader, Stage, Type, TypeId, Types};
use glisten_front::link::{Attribute, Program, SamplerSlot, UniformLeaf, UniformRoot};
use glisten_front::source::SourceMap;
use glisten_scene::roles::{
    AttributeRole, MatrixRole, attribute_role, is_plain_transform, likely_attribute_role, matrix_role,
};
use glisten_scene::{ColorDependence, is_leaf_read};
use std::collections::BTreeMap;

/// An attribute that the vertex stage reads.
pub(super) struct Input<'p> {
    pub(super) name: &'p str,
    pub(super) ty: TypeId,
    pub(super) size: usize,
    pub(super) is_integer: bool,
    /// The first attribute that its name or type gives a role has it.
    pub(super) role: Option<AttributeRole>,
}

/// The state of the fixed-function pipeline that a program reads.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct FixedReads {
    /// `gl_Vertex`, or the pipeline's own vertex stage.
    pub(super) vertex: bool,
    pub(super) normal: bool,
    pub(super) color: bool,
    pub(super) texcoord: bool,
    pub(super) lights: bool,
    pub(super) material: bool,
    pub(super) fog: bool,
}

/// The variables that a program reads.
pub(super) struct Reads<'p> {
    pub(super) program: &'p Program,
    pub(super) inputs: Vec<Input<'p>>,
    /// Uniforms without an initializer.
    pub(super) uniforms: Vec<&'p UniformLeaf>,
    /// Uniforms with an initializer, which keep it.
    pub(super) initialized: Vec<&'p UniformLeaf>,
    pub(super) samplers: Vec<&'p SamplerSlot>,
    pub(super) fixed: FixedReads,
    /// The primitive that the geometry stage takes.
    pub(super) geometry: Option<PrimitiveIn>,
    /// Whether the fragment stage reads `gl_PointCoord`.
    pub(super) point_coord: bool,
    /// Whether the vertex stage writes `gl_PointSize`.
    pub(super) point_size: bool,
    /// The initial values of the parameters that `#pragma parameter` declares (libretro).
    pub(super) parameters: BTreeMap<String, f64>,
    /// Whether texels are fetched by integers, so that a texture has to be as large as the window.
    pub(super) fetches: bool,
    /// The parts of the color that may differ from pixel to pixel.
    pub(super) dependence: ColorDependence,
}

impl<'p> Reads<'p> {
    /// The variables that the program reads; `sources` are its texts.
    pub(super) fn new(program: &'p Program, sources: &SourceMap) -> Self {
        let interface = &program.interface;
        let is_used = |leaf: &&UniformLeaf| leaf.active && !leaf.name.starts_with("gl_") && is_leaf_read(program, leaf);
        let has_initializer =
            |leaf: &&UniformLeaf| interface.roots.get(leaf.root.0 as usize).is_some_and(|root| root.default.is_some());
        let (initialized, uniforms) = interface.uniforms.iter().filter(is_used).partition(has_initializer);
        let builtin = |stage: Stage, wanted: BuiltinVariable| {
            let shader = program.stage(stage);
            shader
                .is_some_and(|shader| shader.globals.iter().any(|global| global.builtin == Some(wanted) && global.used))
        };
        Self {
            program,
            inputs: inputs(program),
            uniforms,
            initialized,
            samplers: interface.samplers.iter().filter(|slot| slot.active).collect(),
            fixed: fixed(program),
            geometry: program.stage(Stage::Geometry).and_then(|shader| shader.geometry.input),
            point_coord: builtin(Stage::Fragment, BuiltinVariable::PointCoord),
            point_size: builtin(Stage::Vertex, BuiltinVariable::PointSize),
            parameters: sources.files().flat_map(|(id, _)| parameters(sources.file(id).text())).collect(),
            fetches: program.stages.iter().any(fetches),
            dependence: ColorDependence::of(program),
        }
    }

    /// Whether only the alpha of its color differs, which blending shows.
    pub(super) fn is_shown_by_alpha(&self) -> bool {
        self.dependence.alpha && !self.dependence.color
    }

    /// Whether a vertex stage without a fragment stage passes a variable to the fixed-function pipeline's.
    pub(super) fn passes(&self, name: &str) -> bool {
        let is_written = |shader: &Shader| shader.globals.iter().any(|global| global.written && global.name == name);
        self.program.stage(Stage::Fragment).is_none() && self.program.stage(Stage::Vertex).is_some_and(is_written)
    }

    /// Whether the fixed-function pipeline's vertex stage passes an attribute to a fragment shader alone.
    pub(super) fn is_passed_by_pipeline(&self, attribute: &str) -> bool {
        let varying = match attribute {
            "gl_MultiTexCoord0" => "gl_TexCoord",
            "gl_Color" if !self.fixed.lights => "gl_Color",
            _ => return false,
        };
        let is_read = |shader: &Shader| shader.globals.iter().any(|global| global.used && global.name == varying);
        self.program.stage(Stage::Vertex).is_none() && self.program.stage(Stage::Fragment).is_some_and(is_read)
    }

    /// The attribute with a role.
    pub(super) fn input(&self, role: AttributeRole) -> Option<&Input<'p>> {
        self.inputs.iter().find(|input| input.role == Some(role))
    }

    /// The number of components of the positions; 4 for `gl_Vertex`.
    pub(super) fn position_size(&self) -> Option<usize> {
        let own = self.input(AttributeRole::Position).map(|input| input.size);
        own.or(self.fixed.vertex.then_some(4))
    }

    /// Whether it reads normals.
    pub(super) fn has_normals(&self) -> bool {
        self.fixed.normal || self.input(AttributeRole::Normal).is_some()
    }

    /// Whether it reads texture coordinates.
    pub(super) fn has_texcoords(&self) -> bool {
        self.fixed.texcoord || self.input(AttributeRole::Texcoord).is_some()
    }

    /// Whether it reads colors of vertices.
    pub(super) fn has_colors(&self) -> bool {
        self.fixed.color || self.input(AttributeRole::Color).is_some()
    }

    /// Whether a matrix takes positions to where they are drawn.
    pub(super) fn has_matrices(&self) -> bool {
        let types = &self.program.types;
        let is_matrix = |leaf: &&UniformLeaf| matches!(types.get(leaf.ty), Type::Matrix(4, 4));
        let moves =
            |leaf: &&UniformLeaf| named_role(leaf, types.get(leaf.ty)).is_some() || is_plain_transform(own_name(leaf));
        let of_scene = |root: &UniformRoot| root.active && root.name.starts_with("gl_ModelView");
        let own = self.uniforms.iter().copied().filter(is_matrix).any(|leaf| moves(&leaf));
        own || self.program.interface.roots.iter().any(of_scene) || self.program.stage(Stage::Vertex).is_none()
    }
}

fn fetches(shader: &Shader) -> bool {
    let is_fetch = |expr: &Expr| matches!(expr.kind, ExprKind::BuiltinCall(BuiltinFunction::TexelFetch, _));
    shader.exprs.iter().any(is_fetch)
}

/// The name of a uniform without that of its block or struct.
pub(super) fn own_name(leaf: &UniformLeaf) -> &str {
    leaf.name.rsplit('.').next().unwrap_or(&leaf.name)
}

/// The role of a matrix by its name, with or without that of its block.
pub(super) fn named_role(leaf: &UniformLeaf, ty: Type) -> Option<MatrixRole> {
    matrix_role(&leaf.name, ty).or_else(|| matrix_role(own_name(leaf), ty))
}

/// The attributes that the vertex stage reads, without those of the fixed-function pipeline.
fn inputs(program: &Program) -> Vec<Input<'_>> {
    let types = &program.types;
    let own = |attribute: &&Attribute| attribute.active && !attribute.name.starts_with("gl_");
    let mut inputs: Vec<Input<'_>> = Vec::new();
    let of = |attribute: &Attribute| types.get(attribute.ty);
    let attributes: Vec<&Attribute> = program.interface.attributes.iter().filter(own).collect();
    // An unmistakable name comes before one that suggests the role.
    let certain: Vec<_> = attributes.iter().map(|attribute| attribute_role(&attribute.name, of(attribute))).collect();
    let mut taken: Vec<AttributeRole> = Vec::new();
    let mut first = |role: AttributeRole| {
        let is_free = !taken.contains(&role);
        taken.push(role);
        is_free
    };
    let mut roles: Vec<Option<AttributeRole>> =
        certain.into_iter().map(|role| role.filter(|role| first(*role))).collect();
    for (attribute, role) in attributes.iter().zip(&mut roles) {
        if role.is_none() {
            *role = likely_attribute_role(&attribute.name, of(attribute)).filter(|role| first(*role));
        }
    }
    // Without any, the first one with two components or more.
    if !roles.contains(&Some(AttributeRole::Position)) {
        let is_vector = |attribute: &Attribute| matches!(of(attribute), Type::Vector(Scalar::Float, _));
        let free = attributes.iter().zip(&mut roles).find(|(attribute, role)| role.is_none() && is_vector(attribute));
        if let Some((_, role)) = free {
            *role = Some(AttributeRole::Position);
        }
    }
    for (attribute, role) in attributes.into_iter().zip(roles) {
        let is_integer = matches!(scalar_of(types, attribute.ty), Some(Scalar::Int | Scalar::Uint));
        let size = types.flat_len(attribute.ty) as usize;
        inputs.push(Input { name: &attribute.name, ty: attribute.ty, size, is_integer, role });
    }
    inputs
}

fn fixed(program: &Program) -> FixedReads {
    let attribute = |name: &str| program.interface.attributes.iter().any(|known| known.active && known.name == name);
    let state = |words: &[&str]| {
        let is_one = |root: &UniformRoot| root.active && words.iter().any(|word| root.name.starts_with(word));
        program.interface.roots.iter().any(is_one)
    };
    let without_vertex_stage = program.stage(Stage::Vertex).is_none();
    let products = ["gl_FrontLight", "gl_BackLight"];
    FixedReads {
        vertex: without_vertex_stage || attribute("gl_Vertex"),
        normal: without_vertex_stage || attribute("gl_Normal"),
        color: attribute("gl_Color"),
        texcoord: attribute("gl_MultiTexCoord0"),
        lights: without_vertex_stage || state(&["gl_LightSource", "gl_LightModel"]) || state(&products),
        material: without_vertex_stage || state(&["gl_FrontMaterial", "gl_BackMaterial"]) || state(&products),
        fog: state(&["gl_Fog"]),
    }
}

/// The parameters of libretro's shaders: `#pragma parameter NAME "label" initial minimum maximum step`.
fn parameters(text: &str) -> Vec<(String, f64)> {
    let parameter = |line: &str| {
        let rest = line.trim_start().strip_prefix('#')?.trim_start().strip_prefix("pragma")?;
        let rest = rest.trim_start().strip_prefix("parameter")?.trim_start();
        let (name, rest) = rest.split_once(char::is_whitespace)?;
        let numbers = rest.rsplit_once('"').map_or(rest, |(_, after)| after);
        Some((name.to_owned(), numbers.split_whitespace().next()?.parse().ok()?))
    };
    text.lines().filter_map(parameter).collect()
}

/// The type of the numbers of a type, also through arrays.
pub(super) fn scalar_of(types: &Types, mut ty: TypeId) -> Option<Scalar> {
    while let Type::Array(element, _) = types.get(ty) {
        ty = element;
    }
    types.scalar_of(ty)
}
