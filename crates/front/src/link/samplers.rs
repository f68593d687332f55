//! Assigns bindings to samplers: each element of each sampler variable, also inside structs, gets a texture and a
//! sampler in group 1.
//!
//! Samplers that are read come first, so that the bindings in use have no gaps either.

use super::compatible::same_type;
use super::flatten::parts;
use super::{Linker, SamplerSlot, SlotBinding};
use crate::builtin::constants::{MAX_COMBINED_TEXTURE_IMAGE_UNITS, MAX_TEXTURE_IMAGE_UNITS};
use crate::diagnostic::{Diagnostic, codes, plural};
use crate::hir::{ArraySize, Global, GlobalId, MatrixLayout, Shader, Stage, Storage, Type, TypeId};
use crate::source::Span;

const GROUP: u32 = 1;
/// More sampler elements than any target binds.
const MAX_SLOTS: usize = 1024;

/// A uniform variable that is or contains a sampler.
struct Variable<'a> {
    global: &'a Global,
    globals: Vec<(Stage, GlobalId)>,
    active: bool,
    unit: Option<u32>,
}

/// Assigns bindings to all samplers of a program.
pub(super) fn assign(ctx: &mut Linker<'_>, stages: &[Shader]) -> Vec<SamplerSlot> {
    let mut variables: Vec<Variable<'_>> = Vec::new();
    for shader in stages {
        for (id, global) in shader.globals() {
            if global.storage == Storage::Uniform && global.block.is_none() && ctx.types.contains_sampler(global.ty) {
                merge(ctx, &mut variables, shader.stage, id, global);
            }
        }
    }
    let mut slots = Vec::new();
    for variable in &variables {
        if !cut(ctx, variable, &mut slots) {
            return Vec::new();
        }
    }
    warn_above_minimum(ctx, stages, &slots);
    slots.sort_by_key(|slot| !slot.active);
    let mut binding = 0;
    for slot in &mut slots {
        slot.texture = SlotBinding { group: GROUP, binding };
        if matches!(ctx.types.get(slot.ty), Type::Sampler(kind) if kind.is_filtered()) {
            binding += 1;
        }
        slot.sampler = SlotBinding { group: GROUP, binding };
        binding += 1;
    }
    slots
}

/// Adds the declaration of a stage. `uniforms` checks that the types agree.
fn merge<'a>(ctx: &Linker<'_>, variables: &mut Vec<Variable<'a>>, stage: Stage, id: GlobalId, global: &'a Global) {
    let known = variables
        .iter_mut()
        .find(|known| known.global.name == global.name && same_type(ctx.types, known.global.ty, global.ty));
    match known {
        Some(known) => {
            known.globals.push((stage, id));
            known.active |= global.used;
            known.unit = known.unit.or(global.unit());
        }
        None => {
            let (active, unit) = (global.used, global.unit());
            variables.push(Variable { global, globals: vec![(stage, id)], active, unit });
        }
    }
}

/// Adds one entry per element. Returns false if there are absurdly many.
fn cut(ctx: &mut Linker<'_>, variable: &Variable<'_>, slots: &mut Vec<SamplerSlot>) -> bool {
    let Global { name, ty, span, .. } = variable.global;
    if slots.len() + ctx.types.flat_len(*ty) as usize > MAX_SLOTS {
        let message = format!("`{name}` holds more samplers than any target can bind");
        ctx.report(Diagnostic::new(&codes::link::TOO_MANY_SAMPLERS, *span, message));
        return false;
    }
    let mut unit = variable.unit;
    for part in parts(ctx.types, name, *ty, MatrixLayout::default()) {
        let (sampler, array_size) = match ctx.types.get(part.ty) {
            Type::Array(element, ArraySize::Sized(size)) => (element, Some(size)),
            _ => (part.ty, None),
        };
        if !matches!(ctx.types.get(sampler), Type::Sampler(_)) {
            continue;
        }
        for index in 0..array_size.unwrap_or(1) {
            let name = if array_size.is_some() { format!("{}[{index}]", part.name) } else { part.name.clone() };
            slots.push(slot(variable, name, sampler, array_size, part.flat_offset + index, unit));
            unit = unit.map(|unit| unit.saturating_add(1));
        }
    }
    true
}

fn slot(
    variable: &Variable<'_>,
    name: String,
    ty: TypeId,
    array_size: Option<u32>,
    flat_offset: u32,
    unit: Option<u32>,
) -> SamplerSlot {
    let nowhere = SlotBinding { group: GROUP, binding: 0 };
    SamplerSlot {
        name,
        ty,
        array_size,
        globals: variable.globals.clone(),
        flat_offset,
        texture: nowhere,
        sampler: nowhere,
        texel_count: None,
        unit,
        active: variable.active,
    }
}

fn warn_above_minimum(ctx: &mut Linker<'_>, stages: &[Shader], slots: &[SamplerSlot]) {
    let in_stage = |slot: &SamplerSlot, shader: &Shader| {
        slot.globals.iter().any(|&(stage, id)| stage == shader.stage && shader.global(id).used)
    };
    for shader in stages {
        let used: Vec<_> = slots.iter().filter(|slot| in_stage(slot, shader)).collect();
        let last = used.last().and_then(|slot| slot.globals.iter().find(|(stage, _)| *stage == shader.stage));
        let span = last.map_or(Span::default(), |&(_, id)| shader.global(id).span);
        above(ctx, used.len(), MAX_TEXTURE_IMAGE_UNITS, span, &format!("the {} stage", shader.stage.name()));
    }
    let active = slots.iter().filter(|slot| slot.active).count();
    above(ctx, active, MAX_COMBINED_TEXTURE_IMAGE_UNITS, Span::default(), "the program");
}

fn above(ctx: &mut Linker<'_>, count: usize, minimum: u32, span: Span, whose: &str) {
    if count > minimum as usize {
        let message =
            format!("{whose} reads {}, and an implementation may have only {minimum}", plural(count as u32, "sampler"));
        ctx.report(Diagnostic::new(&codes::link::SAMPLERS_ABOVE_MINIMUM, span, message));
    }
}
