//! Points as quads, where the target's points are one pixel wide (WGSL): what the reflection tells a host to do.
//!
//! *In:* a draw and a target. *Out:* whether its points are drawn as quads, and the buffer with the viewport's size.
//! *Holds:* each point is an instance of a strip of four vertices. A draw that has instances of its own, or that reads the
//! indices of its vertices, has no such form.

use crate::Error;
use glisten_emit::{Target, viewport_slot};
use glisten_front::builtin::BuiltinVariable;
use glisten_front::hir::Stage;
use glisten_front::link::{Program, SlotBinding};
use glisten_scene::{Draw, Framebuffer, Primitive};
use wgpu_types as wgpu;

/// The number of vertices of an instance.
pub const CORNERS: u32 = 4;

/// Whether the points of a draw are drawn as quads.
pub fn applies(draw: &Draw, target: Target) -> bool {
    needs_quads(draw, target) && may_be_quads(draw)
}

/// Refuses points that WGSL could only draw as quads, in a draw that has no such form.
///
/// # Errors
/// [`Error::Unsupported`] for those.
pub fn refuse(draw: &Draw, target: Target) -> Result<(), Error> {
    if !needs_quads(draw, target) || may_be_quads(draw) {
        return Ok(());
    }
    let lacks = "points of several pixels; as quads, a draw has one instance, no attribute that steps by instance, and no \
                 indices with `gl_VertexID`";
    Err(Error::Unsupported(lacks.to_owned()))
}

/// Whether points of a target that has none of several pixels have a size or coordinates.
fn needs_quads(draw: &Draw, target: Target) -> bool {
    target == Target::Wgsl
        && draw.state.primitive == Primitive::Points
        && (uses(&draw.program, Stage::Fragment, BuiltinVariable::PointCoord)
            || (draw.state.program_point_size && uses(&draw.program, Stage::Vertex, BuiltinVariable::PointSize)))
}

/// Whether each point may be an instance.
fn may_be_quads(draw: &Draw) -> bool {
    let divided = draw.attributes.iter().flatten().any(|data| data.divisor > 0);
    draw.instances == 1
        && !divided
        && !(draw.indices.is_some() && uses(&draw.program, Stage::Vertex, BuiltinVariable::VertexId))
}

fn uses(program: &Program, stage: Stage, builtin: BuiltinVariable) -> bool {
    let shader = program.stage(stage);
    shader.is_some_and(|shader| shader.globals.iter().any(|global| global.used && global.builtin == Some(builtin)))
}

/// The number of points.
pub fn count(draw: &Draw) -> u32 {
    draw.indices.as_ref().map_or(draw.vertex_count, |indices| indices.len() as u32)
}

/// The binding of the buffer with the viewport's size.
pub fn slot(program: &Program) -> SlotBinding {
    viewport_slot(&program.interface)
}

/// The bytes of that buffer.
pub fn viewport(framebuffer: &Framebuffer) -> Vec<u8> {
    let size = [framebuffer.width as f32, framebuffer.height as f32, 0.0, 0.0];
    size.into_iter().flat_map(f32::to_ne_bytes).collect()
}

/// The primitive state: points are never culled.
pub fn primitive_state() -> wgpu::PrimitiveState {
    wgpu::PrimitiveState { topology: wgpu::PrimitiveTopology::TriangleStrip, ..wgpu::PrimitiveState::default() }
}
