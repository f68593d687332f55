//! The vertices that a geometry stage emits, as lists of numbers for another runner.
//!
//! *In:* a draw with a geometry stage. *Out:* [`Emission`]: the vertices of all instances as a strict GPU computes them,
//! and the list of points, lines or triangles that they form. *Holds:* each primitive begins with its provoking vertex
//! where the first provokes, and ends with it where the last does; the winding is kept.

use super::assembly::Assembled;
use super::before::{Before, Run};
use super::plan::Plan;
use super::vertices::{Invocation, ShadeOptions, Vertices};
use super::watch::{Study, Watch};
use super::{MAX_INVOCATIONS, never_ends, refuse, unique_vertices};
use crate::RenderOptions;
use crate::domain::F32;
use crate::exec::Form;
use glisten_front::diagnostic::Diagnostic;
use glisten_front::diagnostic::codes::scenes::SCENE_CANNOT_DRAW;
use glisten_front::hir::GlobalId;
use glisten_scene::{Draw, Framebuffer, Primitive};
use std::sync::OnceLock;

/// The numbers of emitted vertices, and their primitives.
#[derive(Debug)]
pub(crate) struct Emission {
    pub(crate) primitive: Primitive,
    /// `gl_Position`
    pub(crate) positions: Vec<[f32; 4]>,
    /// `gl_PointSize`
    pub(crate) sizes: Vec<f32>,
    /// The enabled clip distances, so many for each vertex.
    pub(crate) distances: (usize, Vec<f32>),
    /// The outputs that the fragment stage reads, scalar by scalar, and their values for each vertex.
    pub(crate) floats: (Vec<(GlobalId, u32)>, Vec<f32>),
    pub(crate) ints: (Vec<(GlobalId, u32)>, Vec<u32>),
    /// `gl_PrimitiveID` of the primitive that each vertex provokes.
    pub(crate) ids: Vec<u32>,
    pub(crate) indices: Vec<u32>,
}

/// Runs the stages before the rasterizer.
pub(crate) fn expand(
    draw: &Draw,
    framebuffer: Framebuffer,
    options: &RenderOptions,
) -> Result<Emission, Vec<Diagnostic>> {
    let before = Before::compile(draw, Form::Fast)?;
    let plan = Plan::new(&draw.program);
    let (order, unique) = unique_vertices(draw);
    if unique.len().saturating_mul(draw.instances as usize) > MAX_INVOCATIONS {
        let message = "more vertices and instances than the host runs a geometry stage for";
        return Err(vec![refuse(&SCENE_CANNOT_DRAW, message)]);
    }
    let invocations: Vec<Invocation> =
        (0..draw.instances).flat_map(|instance| unique.iter().map(move |&vertex| (vertex, instance))).collect();
    let endless = OnceLock::new();
    let watch = Watch::<F32> { study: Study::NONE, draw: 0, instance: 0, surface: 0 };
    let RenderOptions { faults, profile, positions, .. } = *options;
    let viewport = [framebuffer.width as f32, framebuffer.height as f32];
    let shaded = ShadeOptions { viewport, faults, profile, positions };
    let run = Run { draw, plan: &plan, options: shaded, endless: &endless, watch: &watch };
    let mut front = before.run(&run, &invocations);
    let mut all = Emission::new(&plan);
    for instance in 0..draw.instances {
        let base = instance * unique.len() as u32;
        let order: Vec<u32> = order.iter().map(|&position| base + position).collect();
        let (vertices, assembled) = before.assembled(&run, &mut front, &order)?;
        all.add(vertices, &assembled, draw.state.provoking_last);
        if let Some(&place) = endless.get() {
            return Err(vec![never_ends(draw, place)]);
        }
    }
    Ok(all)
}

impl Emission {
    fn new(plan: &Plan) -> Self {
        Self {
            primitive: Primitive::Points,
            positions: Vec::new(),
            sizes: Vec::new(),
            distances: (0, Vec::new()),
            floats: (plan.floats.iter().map(|varying| varying.from).collect(), Vec::new()),
            ints: (plan.ints.iter().map(|varying| varying.from).collect(), Vec::new()),
            ids: Vec::new(),
            indices: Vec::new(),
        }
    }

    fn add(&mut self, vertices: &Vertices<F32>, assembled: &[(Assembled, u32)], provoking_last: bool) {
        let base = self.positions.len() as u32;
        self.positions.extend(&vertices.clip32);
        self.sizes.extend(&vertices.size32);
        self.distances.0 = vertices.distance_count;
        self.distances.1.extend(&vertices.distances32);
        self.floats.1.extend(&vertices.floats);
        self.ints.1.extend(&vertices.ints);
        self.ids.resize(self.positions.len(), 0);
        for (assembled, id) in assembled {
            let assembled = assembled.map(|vertex| base + vertex);
            if let Some(place) = self.ids.get_mut(assembled.provoking(provoking_last) as usize) {
                *place = *id;
            }
            match assembled {
                Assembled::Point(vertex) => self.indices.push(vertex),
                Assembled::Line(ends) => {
                    self.primitive = Primitive::Lines;
                    self.indices.extend(ends);
                }
                Assembled::Triangle(mut corners, first) => {
                    self.primitive = Primitive::Triangles;
                    corners.rotate_left(if provoking_last { 0 } else { first });
                    self.indices.extend(corners);
                }
            }
        }
    }
}
