//! Plans the data flow between the stages, once for each draw.
//!
//! *In:* a linked program. *Out:* for each scalar that is passed on, its source and destination; the built-in
//! variables that each stage uses.

use glisten_front::builtin::BuiltinVariable;
use glisten_front::hir::{ExprKind, Global, GlobalId, Interpolation, Scalar, Shader, Stage, Stmt, StmtKind, Storage};
use glisten_front::link::Program;

/// A scalar in a variable's flat layout.
pub(super) type FlatScalar = (GlobalId, u32);

/// A `float` that is passed on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct FloatVarying {
    pub(super) from: FlatScalar,
    pub(super) to: FlatScalar,
    pub(super) interpolation: Interpolation,
}

/// An `int` or `uint` that is passed on, always flat.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct IntVarying {
    pub(super) from: FlatScalar,
    pub(super) to: FlatScalar,
}

/// How a draw's stages are connected to each other and to the fixed-function parts of the pipeline.
#[derive(Clone, Debug)]
pub(super) struct Plan {
    pub(super) floats: Vec<FloatVarying>,
    pub(super) ints: Vec<IntVarying>,
    /// The stage before the rasterizer.
    pub(super) producer: Stage,
    /// Its outputs.
    pub(super) position: Option<GlobalId>,
    pub(super) point_size: Option<GlobalId>,
    pub(super) clip_distance: Option<GlobalId>,
    /// An output of the geometry stage.
    pub(super) written_id: Option<GlobalId>,
    /// An input of the geometry stage.
    pub(super) primitive_id_in: Option<GlobalId>,
    /// `gl_InvocationID` of the geometry stage.
    pub(super) invocation_id: Option<GlobalId>,
    /// Inputs of the vertex stage.
    pub(super) vertex_id: Option<GlobalId>,
    pub(super) instance_id: Option<GlobalId>,
    /// Inputs of the fragment stage.
    pub(super) frag_coord: Option<GlobalId>,
    pub(super) front_facing: Option<GlobalId>,
    pub(super) point_coord: Option<GlobalId>,
    pub(super) primitive_id: Option<GlobalId>,
    /// `gl_SampleMaskIn`. Each pixel has one sample, whose number, `gl_SampleID`, is the 0 that inputs begin with.
    pub(super) sample_mask: Option<GlobalId>,
    /// The output of the fragment stage, if it is written.
    pub(super) frag_depth: Option<GlobalId>,
    /// Whether the fragment stage needs whole quads.
    pub(super) needs_quads: bool,
    /// Whether fragments may be tested against depth before shading.
    pub(super) early_depth: bool,
}

impl Plan {
    /// The plan of a program with a vertex and a fragment stage.
    pub(super) fn new(program: &Program) -> Self {
        let vertex = program.stage(Stage::Vertex);
        let fragment = program.stage(Stage::Fragment);
        let geometry = program.stage(Stage::Geometry);
        let producer = geometry.or(vertex);
        let of_producer = |builtin| producer.and_then(|shader| find(shader, builtin, Storage::Out));
        let of_geometry = |builtin, storage| geometry.and_then(|shader| find(shader, builtin, storage));
        let of_vertex = |builtin| vertex.and_then(|shader| find(shader, builtin, Storage::In));
        let of_fragment = |builtin| fragment.and_then(|shader| find(shader, builtin, Storage::In));
        let frag_depth = fragment
            .and_then(|shader| find(shader, BuiltinVariable::FragDepth, Storage::Out))
            .filter(|&id| fragment.and_then(|shader| shader.globals.get(id.index())).is_some_and(|g| g.written));
        let discards = fragment.is_some_and(discards);
        let mut plan = Self {
            floats: Vec::new(),
            ints: Vec::new(),
            producer: producer.map_or(Stage::Vertex, |shader| shader.stage),
            position: of_producer(BuiltinVariable::Position),
            point_size: of_producer(BuiltinVariable::PointSize),
            clip_distance: of_producer(BuiltinVariable::ClipDistance),
            written_id: of_geometry(BuiltinVariable::PrimitiveId, Storage::Out),
            primitive_id_in: of_geometry(BuiltinVariable::PrimitiveIdIn, Storage::In),
            invocation_id: of_geometry(BuiltinVariable::InvocationId, Storage::In),
            vertex_id: of_vertex(BuiltinVariable::VertexId),
            instance_id: of_vertex(BuiltinVariable::InstanceId),
            frag_coord: of_fragment(BuiltinVariable::FragCoord),
            front_facing: of_fragment(BuiltinVariable::FrontFacing),
            point_coord: of_fragment(BuiltinVariable::PointCoord),
            primitive_id: of_fragment(BuiltinVariable::PrimitiveId),
            sample_mask: of_fragment(BuiltinVariable::SampleMaskIn),
            frag_depth,
            needs_quads: fragment.is_some_and(takes_derivatives),
            early_depth: frag_depth.is_none() && !discards,
        };
        plan.add_varyings(program);
        plan
    }

    fn add_varyings(&mut self, program: &Program) {
        for varying in program.interface.interpolated() {
            let (Some(from), Some(to), true) = (varying.from, varying.to, varying.active) else { continue };
            let is_float = program.types.scalar_of(varying.ty) == Some(Scalar::Float);
            for scalar in 0..program.types.flat_len(varying.ty) {
                let from = (from.global, from.flat_offset + scalar);
                let to = (to.global, to.flat_offset + scalar);
                if is_float {
                    self.floats.push(FloatVarying { from, to, interpolation: varying.interpolation });
                } else {
                    self.ints.push(IntVarying { from, to });
                }
            }
        }
    }
}

fn find(shader: &Shader, builtin: BuiltinVariable, storage: Storage) -> Option<GlobalId> {
    let is_it = |global: &Global| global.builtin == Some(builtin) && global.storage == storage;
    shader.globals().find(|(_, global)| is_it(global)).map(|(id, _)| id)
}

/// Whether the shader takes derivatives anywhere, even if only for a level of detail.
fn takes_derivatives(shader: &Shader) -> bool {
    shader.exprs.iter().any(|expr| match expr.kind {
        ExprKind::BuiltinCall(function, _) => function.implicit_derivatives(),
        _ => false,
    })
}

/// Whether a function that `main` can reach contains a `discard`.
fn discards(shader: &Shader) -> bool {
    let reachable = shader.functions.iter().filter(|function| function.reachable);
    let mut rest: Vec<&Stmt> = reachable.filter_map(|function| function.body.as_ref()).flatten().collect();
    while let Some(stmt) = rest.pop() {
        match &stmt.kind {
            StmtKind::Discard => return true,
            StmtKind::Block(body) | StmtKind::Loop { body, .. } => rest.extend(body),
            StmtKind::If { arms, otherwise } => {
                rest.extend(arms.iter().flat_map(|(_, body)| body));
                rest.extend(otherwise);
            }
            StmtKind::Switch { cases, .. } => rest.extend(cases.iter().flat_map(|case| &case.body)),
            StmtKind::Expr(_) | StmtKind::Local(..) | StmtKind::Break | StmtKind::Continue | StmtKind::Return(_) => {}
        }
    }
    false
}
