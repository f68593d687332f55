//! What is known of a stage's globals before it runs.
//!
//! *In:* a [`Known`], the interface, for the fragment stage what the vertex stage leaves. *Out:* facts for each global.

use super::facts::{Fact, Facts, Range, What};
use super::known::{Input, Known, KnownTexture};
use glisten_front::builtin::BuiltinVariable;
use glisten_front::hir::{GlobalId, Interpolation, ScalarValue, Shader, Stage, Storage};
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
        (Stage::Fragment, Some(ends)) => varyings(program, ends, known.state.interpolation_reach, &mut facts),
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
