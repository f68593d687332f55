//! [`Before`]: the stages before the rasterizer: a vertex stage, with or without a geometry stage after it.
//!
//! *In:* a draw. *Out:* the vertices and primitives of each instance.

use super::assembly::{Assembled, Prim, assemble, primitives};
use super::emitted::{Geometry, MAX_EMITTED};
use super::invoke::Job;
use super::plan::Plan;
use super::refuse;
use super::staged::{Feeds, Staged, stage};
use super::vertices::{Invocation, ShadeOptions, Vertices, shade};
use super::watch::Watch;
use crate::LineRule;
use crate::domain::Domain;
use crate::exec::{Code, Form, Piece};
use glisten_front::diagnostic::Diagnostic;
use glisten_front::diagnostic::codes::scenes::SCENE_CANNOT_DRAW;
use glisten_front::hir::Stage;
use glisten_front::source::Span;
use glisten_scene::Draw;
use std::sync::OnceLock;

/// The compiled stages.
pub(super) struct Before {
    vertex: Code,
    geometry: Option<(Code, Feeds)>,
}

/// The surroundings of a run, for all of its invocations.
#[derive(Clone, Copy)]
pub(super) struct Run<'a, D: Domain> {
    pub(super) draw: &'a Draw,
    pub(super) plan: &'a Plan,
    pub(super) options: ShadeOptions,
    pub(super) endless: &'a OnceLock<Span>,
    pub(super) watch: &'a Watch<'a, D>,
}

/// The vertices of several instances.
pub(super) enum Front<D: Domain> {
    /// Ready for the rasterizer.
    Vertices(Vertices<D>),
    /// Those that a geometry stage reads, and what it emitted for the current instance.
    Staged(Staged<D>, Option<Vertices<D>>),
}

/// Vertices, and the primitives that they form, each with its `gl_PrimitiveID`.
type Primitives<'f, D> = (&'f mut Vertices<D>, Vec<(Assembled, u32)>);

impl<'a, D: Domain> Run<'a, D> {
    fn job(&self, stage: Stage, piece: Piece, code: &'a Code) -> Job<'a, D> {
        let Self { draw, options, endless, watch, .. } = *self;
        Job { stage, piece, code, draw, profile: options.profile, endless, watch }
    }
}

impl Before {
    pub(super) fn compile(draw: &Draw, form: Form) -> Result<Self, Vec<Diagnostic>> {
        let vertex = Code::compile_as(&draw.program, Stage::Vertex, form)?;
        let Some(shader) = draw.program.stage(Stage::Geometry) else { return Ok(Self { vertex, geometry: None }) };
        if let Some(input) = shader.geometry.input
            && !draw.state.primitive.feeds(input)
        {
            let message = "the geometry shader takes other primitives than the draw has";
            return Err(vec![refuse(&SCENE_CANNOT_DRAW, message)]);
        }
        let code = Code::compile_as(&draw.program, Stage::Geometry, form)?;
        let feeds = Feeds::new(&draw.program, &code);
        Ok(Self { vertex, geometry: Some((code, feeds)) })
    }

    /// Shows once what the stages compute for all invocations.
    pub(super) fn show_common<D: Domain>(&self, draw: &Draw, watch: &Watch<'_, D>) {
        watch.common(&self.vertex, draw, Piece::SameForVertices);
        if let Some((code, _)) = &self.geometry {
            watch.common(code, draw, Piece::SameForPrimitives);
        }
    }

    /// Runs the vertex stage.
    pub(super) fn run<D: Domain>(&self, run: &Run<'_, D>, invocations: &[Invocation]) -> Front<D> {
        let Run { draw, plan, options, endless, watch } = *run;
        match &self.geometry {
            None => Front::Vertices(shade::<D>(draw, &self.vertex, plan, invocations, options, endless, watch)),
            Some((_, feeds)) => {
                let job = run.job(Stage::Vertex, Piece::Vertices, &self.vertex);
                Front::Staged(stage(&job, plan, feeds, invocations), None)
            }
        }
    }

    /// The primitives of one instance, after the geometry stage. `order` lists its vertices in the order of the draw.
    pub(super) fn primitives<'f, D: Domain>(
        &self,
        run: &Run<'_, D>,
        front: &'f mut Front<D>,
        order: &[u32],
        lines: LineRule,
    ) -> Result<(&'f Vertices<D>, Vec<Prim>), Vec<Diagnostic>> {
        let (vertices, assembled) = self.assembled(run, front, order)?;
        let prims = primitives(vertices, assembled.into_iter(), &run.draw.state, lines);
        Ok((vertices, prims))
    }

    /// The vertices of one instance, and the primitives that they form, each with its `gl_PrimitiveID`.
    pub(super) fn assembled<'f, D: Domain>(
        &self,
        run: &Run<'_, D>,
        front: &'f mut Front<D>,
        order: &[u32],
    ) -> Result<Primitives<'f, D>, Vec<Diagnostic>> {
        match (front, &self.geometry) {
            (Front::Staged(staged, place), Some((code, feeds))) => {
                let job = run.job(Stage::Geometry, Piece::Primitives, code);
                let geometry = Geometry { job: &job, plan: run.plan, feeds, options: run.options };
                let Some(emitted) = geometry.run(staged, order) else {
                    let message = format!("the geometry shader emits more than {MAX_EMITTED} vertices for an instance");
                    return Err(vec![refuse(&SCENE_CANNOT_DRAW, &message)]);
                };
                Ok((place.insert(emitted.vertices), emitted.primitives))
            }
            (Front::Vertices(vertices) | Front::Staged(_, Some(vertices)), _) => {
                let vertex = |position: u32| order.get(position as usize).copied().unwrap_or(0);
                let assembled = assemble(run.draw.state.primitive, order.len() as u32).into_iter();
                Ok((vertices, assembled.map(|one| one.map(vertex)).zip(0..).collect()))
            }
            // Vertices are staged for a geometry stage alone.
            (Front::Staged(_, None), None) => Err(Vec::new()),
        }
    }
}
