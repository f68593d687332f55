//! What is known of a stage's globals before it runs.
//!
//! *In:* a [`Known`], the interface, for the fragment stage what the vertex stage leaves. *Out:* facts for each global.

use super::facts::{Fact, Facts, Range, What};
use super::known::{Input, Known, KnownTexture};
use glisten_front::builtin::BuiltinVariable;
use glisten_front::hir::{Global, GlobalId, Interpolation, ScalarValue, Shader, Stage, Storage};
use glisten_front::link::Program;

/// Facts of each global of a stage. `ends` are the facts of the vertex stage's globals at its end.
pub(super) fn inputs(program: &Program, shader: &Shader, known: &Known, ends: Option<&[Facts]>) -> Vec<Vec<Fact>> {
    let types = &program.types;
    let mut facts: Vec<Vec<Fact>> =
        shader.globals.iter().map(|global| vec![Fact::ANY; types.flat_len(global.ty) as usize]).collect();
    for (id, global) in shader.globals() {
        let Some(cell) = facts.get_mut(id.index()) else { continue };
        if global.storage == Storage::Const
            && let Some(value) = &global.value
        {
            fill(cell, 0, value.scalars.iter().map(|scalar| Fact::literal(*scalar)));
        }
        if let Some(builtin) = global.builtin
            && global.storage == Storage::In
        {
            fill(cell, 0, built_in(builtin, known).into_iter());
        }
    }
    uniforms(program, shader.stage, known, &mut facts);
    match (shader.stage, ends) {
        (Stage::Vertex, _) => attributes(program, known, &mut facts),
        (Stage::Fragment, Some(ends)) => {
            varyings(program, ends, known.state.interpolation_reach, &mut facts);
            let depth = depth(program, ends).filter(|_| known.state.framebuffer.is_some());
            if let (Some(depth), Some(cell)) = (depth, frag_coord(shader).and_then(|id| facts.get_mut(id.index()))) {
                fill(cell, 2, depth.into_iter());
            }
        }
        (Stage::Fragment | Stage::Geometry, _) => {}
    }
    facts
}

fn fill(cell: &mut [Fact], start: usize, facts: impl Iterator<Item = Fact>) {
    cell.iter_mut().skip(start).zip(facts).for_each(|(slot, fact)| *slot = fact);
}

fn below(limit: Option<u32>) -> Vec<Fact> {
    match limit {
        Some(1) => vec![Fact::bound(ScalarValue::Int(0))],
        Some(limit) => vec![Fact::int(0, i64::from(limit) - 1)],
        None => Vec::new(),
    }
}

fn built_in(builtin: BuiltinVariable, known: &Known) -> Vec<Fact> {
    let state = &known.state;
    match builtin {
        BuiltinVariable::FrontFacing => {
            state.front_facing.map(|front| Fact::bound(ScalarValue::Bool(front))).into_iter().collect()
        }
        BuiltinVariable::VertexId => below(state.vertices),
        BuiltinVariable::InstanceId => below(state.instances),
        BuiltinVariable::FragCoord => match state.framebuffer {
            Some(size) => size
                .iter()
                .map(|pixels| {
                    let range = Range::between(0.0, f64::from(*pixels) + 1.0);
                    Fact::in_range(Range { negative_zero: false, ..range })
                })
                .collect(),
            None => Vec::new(),
        },
        _ => Vec::new(),
    }
}

fn uniforms(program: &Program, stage: Stage, known: &Known, facts: &mut [Vec<Fact>]) {
    let global_in = |globals: &[(Stage, GlobalId)]| globals.iter().find(|(of, _)| *of == stage).map(|(_, id)| *id);
    for leaf in &program.interface.uniforms {
        let Some(values) = known.uniforms.get(&leaf.name) else { continue };
        let root = program.interface.roots.get(leaf.root.0 as usize);
        let Some(global) = root.and_then(|root| global_in(&root.globals)) else { continue };
        if let Some(cell) = facts.get_mut(global.index()) {
            fill(cell, leaf.flat_offset as usize, values.iter().map(|value| Fact::bound(*value)));
        }
    }
    // A sampler's value is the number of its slot, so that it is known what a parameter stands for.
    for (slot, sampler) in program.interface.samplers.iter().enumerate() {
        let Some(global) = global_in(&sampler.globals) else { continue };
        if let Some(cell) = facts.get_mut(global.index()) {
            let fact = Fact::bound(ScalarValue::Int(slot as i32));
            fill(cell, sampler.flat_offset as usize, std::iter::once(fact));
        }
    }
}

/// The known texture of each sampler slot.
pub(super) fn textures(program: &Program, known: &Known) -> Vec<Option<KnownTexture>> {
    program.interface.samplers.iter().map(|slot| known.textures.get(&slot.name).cloned()).collect()
}

fn attributes(program: &Program, known: &Known, facts: &mut [Vec<Fact>]) {
    for attribute in &program.interface.attributes {
        let Some(values) = known.attributes.get(&attribute.name) else { continue };
        if let Some(cell) = facts.get_mut(attribute.global.index()) {
            fill(cell, 0, values.iter().map(|value| outside(*value)));
        }
    }
}

fn outside(input: Input) -> Fact {
    match input {
        Input::Value(value) => Fact::bound(value),
        Input::Between(low, high) => Fact::in_range(Range::between(f64::from(low), f64::from(high))),
        Input::Unsigned(low, high) => unsigned(low, high),
        Input::Open => Fact::ANY,
    }
}

/// A range without -0.
pub(super) fn unsigned(low: f32, high: f32) -> Fact {
    Fact::in_range(Range { negative_zero: false, ..Range::between(f64::from(low), f64::from(high)) })
}

/// Facts of varyings. One that is the same at all vertices is known, since equal values are interpolated to that very value. Others are in the
/// range of the values at the vertices, extended by `reach`; without it nothing is said of them.
fn varyings(program: &Program, ends: &[Facts], reach: Option<f64>, facts: &mut [Vec<Fact>]) {
    for varying in &program.interface.varyings {
        let (Some(from), Some(to)) = (varying.from, varying.to) else { continue };
        for scalar in 0..program.types.flat_len(varying.ty) {
            let end = ends.get(from.global.index()).and_then(|facts| facts.get((from.flat_offset + scalar) as usize));
            let slot =
                facts.get_mut(to.global.index()).and_then(|cell| cell.get_mut((to.flat_offset + scalar) as usize));
            if let (Some(end), Some(slot)) = (end, slot) {
                *slot = interpolated(*end, varying.interpolation, reach);
            }
        }
    }
}

fn frag_coord(shader: &Shader) -> Option<GlobalId> {
    let is_own = |global: &Global| global.builtin == Some(BuiltinVariable::FragCoord);
    shader.globals().find(|(_, global)| is_own(global)).map(|(id, _)| id)
}

/// Facts of `gl_FragCoord.zw` where all vertices have one z and one w (OpenGL 3.2 §2.12, GLSL 1.50 §7.2). 1 / w is 1 where w is; other
/// quotients are rounded, and so is depth, on some machines to the 24 bits of a depth buffer.
fn depth(program: &Program, ends: &[Facts]) -> Option<[Fact; 2]> {
    let is_position =
        |global: &Global| global.builtin == Some(BuiltinVariable::Position) && global.storage == Storage::Out;
    let (position, _) = program.stage(Stage::Vertex)?.globals().find(|(_, global)| is_position(global))?;
    let number = |component: usize| match ends.get(position.index())?.get(component)?.what {
        What::Value(ScalarValue::Float(value)) => Some(f64::from(value)),
        _ => None,
    };
    let w = number(3).filter(|w| (1e-6..1e6).contains(w))?;
    let z = number(2).map(|z| z / w).filter(|z| (-1.0..=1.0).contains(z));
    let depth = z.map_or(Fact::ANY, |z| near(z.mul_add(0.5, 0.5), 1.0, 1.0));
    let reciprocal = if w.to_bits() == 1.0_f64.to_bits() {
        Fact::bound(ScalarValue::Float(1.0))
    } else {
        near(w.recip(), w.recip(), f64::INFINITY)
    };
    Some([depth, reciprocal])
}

/// A range around a number that is rounded, neither below 0 nor above a limit.
fn near(value: f64, size: f64, most: f64) -> Fact {
    const ROUNDING: f64 = 1e-4;
    let range = Range::between((value - size * ROUNDING).max(0.0), (value + size * ROUNDING).min(most));
    Fact::in_range(Range { negative_zero: false, ..range })
}

fn interpolated(fact: Fact, interpolation: Interpolation, reach: Option<f64>) -> Fact {
    match fact.what {
        // 0 of either sign is told from the other by no rasterizer.
        What::Value(ScalarValue::Float(value)) if !value.is_finite() || (value == 0.0 && value.is_sign_negative()) => {
            Fact::ANY
        }
        What::Value(value) => Fact::bound(value),
        _ if interpolation == Interpolation::Flat => Fact { constant: false, ..fact },
        What::Float(range) => reach.map_or(Fact::ANY, |reach| Fact::in_range(extended(range, reach))),
        What::Int(..) | What::Uint(..) | What::Any => Fact::ANY,
    }
}

/// The range of interpolated values. Interpolation itself rounds: of a sum of three products and a division by a sum, each in
/// f32, some 16 ULP of the largest of them would do.
fn extended(range: Range, reach: f64) -> Range {
    const ROUNDING: f64 = 1e-4;
    if !range.is_finite() || !(0.0..=1.0).contains(&reach) {
        return Range::ANY;
    }
    let slack = (range.high - range.low) * reach + range.magnitude() * ROUNDING + 1e-30;
    let (low, high) = (range.low - slack, range.high + slack);
    // A quotient by w may overflow or vanish on the way.
    if low.abs().max(high.abs()) > 1e30 { Range::ANY } else { Range::between(low, high) }
}
