//! Draws a scene in one domain.
//!
//! ```text
//!  Draw ──► vertices    64 vertices at a time, positions in the domain and in f32
//!       ──► emitted     the primitives of a geometry stage, from the vertices that it reads (staged, seen)
//!       ──► assembly    primitives, clipped (clip), their pixels (raster), culled
//!       ──► bins        32x32 pixels each, the primitives that touch them in order; threads take bins
//!       ──► edges       pixels near edges, and which primitives may own them (worlds)
//!       ──► batch       a primitive's pixels as lanes: weights and depth (source, slack), early depth test (store)
//!       ──► fragments   64 lanes at a time: varyings in, the fragment stage, colors out (outputs)
//!       ──► target      late depth test, blending (store), into the rows of the picture (surface)
//! ```
//!
//! *In:* a [`Scene`]. *Out:* a [`Picture`]. *Holds:* the picture does not depend on the number of threads: within a
//! bin everything happens in the order of the primitives.
//!
//! # Performance
//!
//! `cargo bench --bench scaling` prints the cost of a drawing without its shaders. Values that belong to a primitive
//! are computed once for it, and values that belong to fragments in loops over lanes. Coverage, weights and varyings
//! are also compiled for wide vectors (`pulp`), with one call per primitive or batch: for a single fragment, the call
//! costs more than it gains. Varyings are computed only for fragments that passed the depth test, and written where
//! the executor reads them; colors are written directly to the picture. Memory is touched once if possible: new pages
//! cost more than what is drawn on them.

mod adjacency;
mod assembly;
mod batch;
mod before;
mod clip;
mod edges;
mod emitted;
mod expand;
mod explain;
mod fragment_tests;
mod fragments;
mod invoke;
mod jitter;
mod origin;
mod outputs;
mod plan;
mod reach;
mod same_surface;
mod seen;
mod slack;
mod sloped;
mod source;
mod staged;
mod store;
mod surface;
mod target;
mod tilt;
mod vertices;
mod watch;
mod worlds;

use super::RenderOptions;
use super::domain::Domain;
use super::domain::faults::{Fault, MOST_ROUNDS};
#[cfg(any(test, feature = "stability"))]
use super::exec::Form;
use super::exec::{Code, LOOP_BUDGET, Machine, Piece, hashed};
use super::raster::Shape;
use assembly::Prim;
#[cfg(any(test, feature = "stability"))]
pub(super) use assembly::vertices_of;
use before::{Before, Run};
pub(super) use expand::{Emission, expand};
pub(super) use explain::explain;
use fragments::{Shading, draw_bin};
use glisten_front::diagnostic::codes::scenes::SCENE_LOOP_BUDGET;
use glisten_front::diagnostic::{Code as DiagnosticCode, Diagnostic};
use glisten_front::hir::{ExprKind, Shader, Stage};
use glisten_front::source::Span;
use glisten_scene::picture::Picture;
use glisten_scene::{Draw, Scene};
use jitter::Jitter;
#[cfg(any(test, feature = "stability"))]
pub(super) use jitter::jittered;
use outputs::output_plans;
use plan::Plan;
use rayon::prelude::*;
pub(super) use reach::reach;
use smallvec::SmallVec;
use std::sync::atomic::Ordering;
use std::sync::{Mutex, OnceLock};
use surface::{BIN, Surface};
use target::Target;
use vertices::{Invocation, ShadeOptions};
#[cfg(any(test, feature = "stability"))]
pub(super) use watch::Chosen;
#[cfg(any(test, feature = "stability"))]
pub(super) use watch::Followed;
#[cfg(any(test, feature = "stability"))]
pub(super) use watch::MakeObserver;
#[cfg(any(test, feature = "stability"))]
pub(super) use watch::Probe;
pub(super) use watch::{PixelSet, Study};

/// The side of a bin in pixels.
#[cfg(any(test, feature = "stability"))]
pub(super) const BIN_SIDE: usize = BIN as usize;
use watch::Watch;

/// The number of vertices that are shaded before their primitives are drawn. Instances beyond that are drawn in
/// several passes.
const MAX_INVOCATIONS: usize = 1 << 20;

/// Draws a scene in a domain.
pub(super) fn render<D: Domain>(scene: &Scene, options: &RenderOptions) -> Result<Picture, Vec<Diagnostic>> {
    render_studied::<D>(scene, options, Study::NONE)
}

/// Draws a scene, and shows observers what is computed.
#[cfg(any(test, feature = "stability"))]
pub(super) fn render_watched<D: Domain>(
    scene: &Scene,
    options: &RenderOptions,
    observers: Option<&MakeObserver<D>>,
) -> Result<Picture, Vec<Diagnostic>> {
    let form = if observers.is_some() { Form::Unfused } else { Form::Fast };
    render_studied(scene, options, Study { observers, form, ..Study::NONE })
}

/// Draws a scene for a study.
pub(super) fn render_studied<D: Domain>(
    scene: &Scene,
    options: &RenderOptions,
    study: Study<'_, D>,
) -> Result<Picture, Vec<Diagnostic>> {
    let sample = options.sample.drawn([scene.framebuffer.width, scene.framebuffer.height]);
    let study = Study { pixels: study.pixels.or(sample.as_ref()), ..study };
    let mut surface = Surface::new::<D>(scene.framebuffer);
    let mut target = Target::<D>::new(&mut surface);
    let surfaces = if D::HAS_INTERVALS { same_surface::surfaces(scene) } else { Vec::new() };
    for (number, draw) in scene.draws.iter().enumerate() {
        let watch = Watch { study, draw: number, instance: 0, surface: surfaces.get(number).copied().unwrap_or(0) };
        draw_all(scene, draw, options, watch, &mut |shading, code, endless, watch| {
            draw_prims(shading, code, &mut target, endless, watch);
        })?;
    }
    let marks = target.into_marks();
    Ok(surface.picture::<D>(marks))
}

/// The action on the primitives of an instance.
type Paint<'p, D> = dyn FnMut(&Shading<'_, D>, &Code, &OnceLock<Span>, &Watch<'_, D>) + 'p;

fn draw_all<D: Domain>(
    scene: &Scene,
    draw: &Draw,
    options: &RenderOptions,
    mut watch: Watch<'_, D>,
    paint: &mut Paint<'_, D>,
) -> Result<(), Vec<Diagnostic>> {
    let before = Before::compile(draw, watch.study.form)?;
    let fragment_code = Code::compile_as(&draw.program, Stage::Fragment, watch.study.form)?;
    before.show_common(draw, &watch);
    watch.common(&fragment_code, draw, Piece::SameForFragments);
    let mut plan = Plan::new(&draw.program);
    // Those that fail are followed, too.
    plan.early_depth &= watch.study.followed.is_none();
    let outputs = output_plans(draw, scene.framebuffer.attachments);
    let viewport = [scene.framebuffer.width as f32, scene.framebuffer.height as f32];
    let (order, unique) = unique_vertices(draw);
    let group = (MAX_INVOCATIONS / unique.len().max(1)).max(1) as u32;
    let endless = OnceLock::new();
    let mut first = 0;
    while first < draw.instances && !unique.is_empty() {
        let instances = first..draw.instances.min(first + group);
        let invocations: Vec<Invocation> =
            instances.clone().flat_map(|instance| unique.iter().map(move |&vertex| (vertex, instance))).collect();
        watch.instance = first;
        let RenderOptions { faults, profile, positions, .. } = *options;
        let shaded = ShadeOptions { viewport, faults, profile, positions };
        let run = Run { draw, plan: &plan, options: shaded, endless: &endless, watch: &watch };
        let mut front = before.run(&run, &invocations);
        for local in 0..instances.len() as u32 {
            if endless.get().is_some() {
                break;
            }
            watch.instance = first + local;
            watch.enter();
            let base = local * unique.len() as u32;
            let order: Vec<u32> = order.iter().map(|&position| base + position).collect();
            let run = Run { draw, plan: &plan, options: shaded, endless: &endless, watch: &watch };
            let (vertices, prims) = before.primitives(&run, &mut front, &order, options.lines)?;
            let shading = Shading {
                draw,
                plan: &plan,
                vertices,
                prims: &prims,
                framebuffer: scene.framebuffer,
                outputs: &outputs,
                mark_edges: options.mark_edges,
                profile,
                probe: watch.study.probe,
                pixels: watch.study.pixels,
                followed: watch.study.followed,
                jitter: watch.study.jitter.map(|seed| Jitter::new(seed, &vertices.floats, vertices.float_count)),
                exact_inputs: watch.study.exact_inputs,
                surface: if watch.surface == 0 { 0 } else { hashed((watch.surface, watch.instance)) | 1 },
            };
            if endless.get().is_none() {
                paint(&shading, &fragment_code, &endless, &watch);
            }
        }
        if endless.get().is_some() {
            break;
        }
        first = instances.end;
    }
    match endless.get() {
        Some(&place) => Err(vec![never_ends(draw, place)]),
        None => Ok(()),
    }
}

fn refuse(code: &'static DiagnosticCode, message: &str) -> Diagnostic {
    Diagnostic::new(code, Span::default(), message)
}

/// The error for a loop, or for a call that leads to more calls than any machine could make.
fn never_ends(draw: &Draw, place: Span) -> Diagnostic {
    let is_call =
        |shader: &Shader| shader.exprs.iter().any(|expr| expr.span == place && matches!(expr.kind, ExprKind::Call(..)));
    if draw.program.stages.iter().any(is_call) {
        let told = Diagnostic::new(&SCENE_LOOP_BUDGET, place, "this call does not come to an end");
        return told
            .here("too long with all of the calls that it leads to")
            .help("each function that calls another one twice doubles the work: use a loop, or compute a value once");
    }
    let message = "a loop of the program runs longer than the reference's budget, or does not come to an end";
    let budget =
        format!("left after it ran {LOOP_BUDGET} instructions for 64 invocations together, which is the budget");
    let help = "a loop needs a condition that turns false, a `break` or a `return`; a loop that does end must run fewer rounds here";
    Diagnostic::new(&SCENE_LOOP_BUDGET, place, message).here(budget).help(help)
}

/// The distinct vertices of a draw, and for each position in the draw the index of its vertex.
fn unique_vertices(draw: &Draw) -> (Vec<u32>, Vec<u32>) {
    let Some(indices) = &draw.indices else {
        let all: Vec<u32> = (0..draw.vertex_count).collect();
        return (all.clone(), all);
    };
    let used = indices.get(..draw.vertex_count as usize).unwrap_or(indices);
    let most = used.iter().copied().max().unwrap_or(0) as usize;
    if most < 4 * used.len() {
        // A table of all vertices, with the index of each that is used.
        let mut places = vec![u32::MAX; most + 1];
        for &index in used {
            places[index as usize] = 0;
        }
        let mut unique = Vec::new();
        for (vertex, place) in (0..).zip(&mut places) {
            if *place == 0 {
                *place = unique.len() as u32;
                unique.push(vertex);
            }
        }
        return (used.iter().map(|&index| places[index as usize]).collect(), unique);
    }
    let mut unique = used.to_vec();
    unique.sort_unstable();
    unique.dedup();
    let order = used.iter().map(|index| unique.partition_point(|known| known < index) as u32).collect();
    (order, unique)
}

/// The primitives that touch each bin, in order: a list of lists in two arrays.
struct Bins {
    starts: Vec<u32>,
    prims: Vec<u32>,
}

impl Bins {
    fn new<D: Domain>(prims: &[Prim], target: &Target<'_, D>) -> Self {
        let mut counts = vec![0_u32; target.bins.len() + 1];
        let mut pairs = Vec::new();
        for (index, prim) in prims.iter().enumerate() {
            touched(&prim.shape, target, |bin| {
                counts[bin + 1] += 1;
                pairs.push((bin as u32, index as u32));
            });
        }
        for bin in 1..counts.len() {
            counts[bin] += counts[bin - 1];
        }
        let mut next = counts.clone();
        let mut list = vec![0; pairs.len()];
        for (bin, prim) in pairs {
            let slot = &mut next[bin as usize];
            list[*slot as usize] = prim;
            *slot += 1;
        }
        Self { starts: counts, prims: list }
    }

    fn of(&self, bin: usize) -> &[u32] {
        let range = self.starts.get(bin).zip(self.starts.get(bin + 1));
        range.and_then(|(&start, &end)| self.prims.get(start as usize..end as usize)).unwrap_or(&[])
    }
}

/// Calls `visit` once for each bin that a shape may touch.
fn touched<D: Domain>(shape: &Shape, target: &Target<'_, D>, mut visit: impl FnMut(usize)) {
    let bin_at = |column: i64, row: i64| (row * target.columns + column) as usize;
    if let Shape::Pixels(pixels) = shape {
        // It follows the pixels, not the rectangle around them: for a diagonal, that is many times as large.
        let mut seen: SmallVec<[usize; 32]> = SmallVec::new();
        for &(x, y) in pixels {
            let (column, row) = (x.div_euclid(BIN), y.div_euclid(BIN));
            let is_inside = (0..target.columns).contains(&column) && (0..target.rows).contains(&row);
            let bin = bin_at(column, row);
            if is_inside && seen.last() != Some(&bin) && !seen.contains(&bin) {
                seen.push(bin);
                visit(bin);
            }
        }
        return;
    }
    let bounds = shape.bounds();
    let reach = |low: i64, high: i64, limit: i64| {
        low.div_euclid(BIN).clamp(0, limit)..(high + BIN - 1).div_euclid(BIN).clamp(0, limit)
    };
    for row in reach(bounds.y0, bounds.y1, target.rows) {
        for column in reach(bounds.x0, bounds.x1, target.columns) {
            let bin = bin_at(column, row);
            if target.bins.get(bin).is_some_and(|bin| shape.may_touch(bin.area)) {
                visit(bin);
            }
        }
    }
}

fn draw_prims<D: Domain>(
    shading: &Shading<'_, D>,
    code: &Code,
    target: &mut Target<'_, D>,
    endless: &OnceLock<Span>,
    watch: &Watch<'_, D>,
) {
    let bins = Bins::new(shading.prims, target);
    let idle: Mutex<Vec<Machine<D>>> = Mutex::new(Vec::new());
    let take = || idle.lock().ok().and_then(|mut idle| idle.pop());
    target.bins.par_iter_mut().enumerate().for_each(|(index, bin)| {
        let list = bins.of(index);
        if list.is_empty() || endless.get().is_some() || !watch.wants(index) {
            return;
        }
        let mut machine = take().unwrap_or_else(|| watch.machine(Stage::Fragment, code, shading.draw, shading.profile));
        if shading.vertices.faults.excuses(Fault::CutLoops) {
            machine.cut_loops(MOST_ROUNDS);
        }
        watch.begin(&mut machine);
        machine.take_executed();
        draw_bin(shading, bin, list, &mut machine);
        watch.end(&mut machine, Piece::Fragments, index);
        if let Some(total) = watch.study.executed {
            total.fetch_add(machine.take_executed(), Ordering::Relaxed);
        }
        if let Some(found) = machine.endless_loop() {
            endless.get_or_init(|| found);
        }
        if let Ok(mut idle) = idle.lock() {
            idle.push(machine);
        }
    });
}
