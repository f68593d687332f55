//! Finds draws that draw the same surface again, so that equal depths are known to be equal.
//!
//! *In:* the draws of a scene. *Out:* a number for each: draws with the same number have equal positions, vertex by
//! vertex, primitive by primitive, on every GPU; 0 if no other draw has it.
//!
//! *Holds:* positions are equal if both vertex stages declare `invariant gl_Position` and compute it by the same
//! expressions from the same values (GLSL 1.50 §4.6.1), or if the whole program and its inputs are the same (OpenGL 3.2
//! appendix A.3, rule 4). [`Origin`] is what the depth buffer remembers of a surface.

use crate::exec::{Code, Form, hashed};
use glisten_front::builtin::BuiltinVariable;
use glisten_front::hir::{GlobalId, ScalarValue, Stage};
use glisten_scene::{AttributeData, AttributeValues, Draw, Scene};

/// The fragment whose depth a pixel has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Origin {
    /// The surface; 0 if it is unknown.
    pub(super) surface: u64,
    /// `gl_PrimitiveID`, or [`ANY`](Self::ANY).
    pub(super) primitive: u32,
}

impl Origin {
    /// One of the primitives that may own the pixel.
    pub(super) const ANY: u32 = u32::MAX;
}

/// The number of each draw's surface.
pub(super) fn surfaces(scene: &Scene) -> Vec<u64> {
    let tested = scene.draws.iter().filter(|draw| draw.state.depth_test).count();
    if tested < 2 {
        return vec![0; scene.draws.len()];
    }
    let found: Vec<u64> = scene.draws.iter().map(|draw| surface(draw).unwrap_or(0)).collect();
    let again = |one: &u64| if found.iter().filter(|other| *other == one).count() > 1 { *one } else { 0 };
    found.iter().map(again).collect()
}

fn surface(draw: &Draw) -> Option<u64> {
    if draw.program.stage(Stage::Geometry).is_some() {
        return None;
    }
    let vertex = draw.program.stage(Stage::Vertex)?;
    let (position, global) = vertex.globals().find(|(_, global)| global.builtin == Some(BuiltinVariable::Position))?;
    let code = Code::compile_as(&draw.program, Stage::Vertex, Form::Unfused).ok()?;
    let input = |global: GlobalId, flat: u32| {
        let attributes = draw.program.interface.attributes.iter().zip(&draw.attributes);
        let found = attributes.filter(|(attribute, _)| attribute.global == global).find_map(|(_, data)| data.as_ref());
        let builtin = vertex.globals.get(global.index()).and_then(|global| global.builtin);
        hashed((found.map(data_of), builtin.map(|builtin| format!("{builtin:?}")), flat))
    };
    let wanted = [0, 1, 2, 3].map(|flat| (position, flat));
    let clips = draw.state.clip_distances > 0;
    let invariant = (global.invariant && !clips).then(|| code.expressions(&wanted, &draw.uniforms, input)).flatten();
    let computed = match invariant {
        Some(expressions) => hashed((true, expressions)),
        None => hashed((false, whole_program(draw, &code, input)?)),
    };
    let state = &draw.state;
    let order = (format!("{:?}", state.primitive), state.provoking_last, state.clip_distances);
    Some(hashed((computed, order, draw.vertex_count, &draw.indices, draw.instances)) | 1)
}

/// A hash of both stages and all of their inputs.
fn whole_program(draw: &Draw, vertex: &Code, input: impl Fn(GlobalId, u32) -> u64) -> Option<u64> {
    let fragment = Code::compile_as(&draw.program, Stage::Fragment, Form::Unfused).ok()?;
    let textures: Vec<usize> =
        draw.textures.iter().flatten().map(|texture| std::sync::Arc::as_ptr(texture).addr()).collect();
    let none: &[Vec<ScalarValue>] = &[];
    Some(hashed((vertex.text(&draw.uniforms, input), fragment.text(none, |_, flat| u64::from(flat)), textures)))
}

fn data_of(data: &AttributeData) -> u64 {
    let values = match &data.values {
        AttributeValues::Float(values) => hashed(values.iter().map(|value| value.to_bits()).collect::<Vec<u32>>()),
        AttributeValues::Int(values) => hashed(values),
        AttributeValues::Uint(values) => hashed(values),
    };
    hashed((data.size, data.divisor, values))
}
