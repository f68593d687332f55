//! Assigns color numbers to fragment outputs (OpenGL 3.2 §3.9.2, GLSL 1.50 §7.2).
//!
//! `layout(location)` takes precedence over a binding by name, and that over automatic assignment, which takes the
//! lowest free number. An array takes one number per element. `gl_FragColor` and `gl_FragData` have number 0. Outputs
//! that nothing writes come last and are omitted if they do not fit.

use super::attributes::plural;
use super::{Context, Output};
use crate::builtin::BuiltinVariable;
use crate::builtin::constants::MAX_DRAW_BUFFERS;
use crate::diagnostic::{Diagnostic, codes};
use crate::hir::{ArraySize, Global, GlobalId, Shader, Stage, Storage, Type, TypeId, Types};

struct Candidate<'a> {
    id: GlobalId,
    global: &'a Global,
    numbers: u32,
    index: u32,
    location: Option<u32>,
}

fn numbers(types: &Types, ty: TypeId) -> u32 {
    match types.get(ty) {
        Type::Array(_, ArraySize::Sized(size)) => size,
        _ => 1,
    }
}

/// Assigns numbers to all color outputs of the fragment stage.
pub(super) fn assign(ctx: &mut Context<'_>, fragment: &Shader) -> Vec<Output> {
    let outputs = fragment.globals().filter(|(_, global)| global.storage == Storage::Out && is_color(global));
    let mut candidates: Vec<Candidate<'_>> = outputs
        .map(|(id, global)| Candidate {
            id,
            global,
            numbers: numbers(ctx.types, global.ty),
            index: global.index.unwrap_or(0),
            location: fixed_location(ctx, global),
        })
        .collect();
    let mut taken: [[Option<GlobalId>; MAX_DRAW_BUFFERS as usize]; 2] = Default::default();
    for candidate in &candidates {
        if let Some(location) = candidate.location {
            place_fixed(ctx, fragment, &mut taken, candidate, location);
        }
    }
    for written in [true, false] {
        for candidate in candidates.iter_mut().filter(|candidate| candidate.global.written == written) {
            if candidate.location.is_none() {
                candidate.location = place_free(&mut taken, candidate);
                if candidate.location.is_none() && written {
                    too_many(ctx, candidate);
                }
            }
        }
    }
    let mut placed: Vec<Output> = candidates.into_iter().filter_map(output).collect();
    placed.sort_by_key(|output| (output.location, output.index));
    placed
}

fn output(candidate: Candidate<'_>) -> Option<Output> {
    Some(Output {
        name: candidate.global.name.clone(),
        ty: candidate.global.ty,
        global: candidate.id,
        location: candidate.location?,
        index: candidate.index,
    })
}

/// Whether an output is a color: all are except `gl_FragDepth`, and the deprecated ones if they are not written.
fn is_color(global: &Global) -> bool {
    match global.builtin {
        None => true,
        Some(BuiltinVariable::FragColor | BuiltinVariable::FragData) => global.written,
        Some(_) => false,
    }
}

fn fixed_location(ctx: &mut Context<'_>, global: &Global) -> Option<u32> {
    if global.builtin.is_some() {
        return Some(0);
    }
    let bound = ctx.bindings.frag_data_locations.iter().rev().find(|(name, _)| *name == global.name);
    let bound = bound.map(|&(_, location)| location);
    if let (Some(declared), Some(bound)) = (global.location, bound)
        && declared != bound
    {
        let message =
            format!("`{}` is bound to color {bound}, and its declaration says {declared}, which wins", global.name);
        ctx.report(Diagnostic::new(&codes::link::BINDING_IGNORED, global.span, message));
    }
    global.location.or(bound)
}

type Taken = [[Option<GlobalId>; MAX_DRAW_BUFFERS as usize]; 2];

fn slots(taken: &mut Taken, index: u32, location: u32, numbers: u32) -> Option<&mut [Option<GlobalId>]> {
    let end = location.checked_add(numbers)?;
    taken.get_mut(index as usize)?.get_mut(location as usize..end as usize)
}

fn place_fixed(ctx: &mut Context<'_>, fragment: &Shader, taken: &mut Taken, candidate: &Candidate<'_>, location: u32) {
    let Candidate { id, global, numbers, index, .. } = *candidate;
    let Some(slots) = slots(taken, index, location, numbers) else {
        let message = format!(
            "`{}` takes {} from number {location} on, and there are only {MAX_DRAW_BUFFERS}",
            global.name,
            plural(numbers, "color")
        );
        ctx.report(Diagnostic::new(&codes::link::TOO_MANY_OUTPUTS, global.span, message));
        return;
    };
    let holder = slots.iter().find_map(|&holder| holder);
    slots.fill(Some(id));
    let both_builtin = |other: &Global| other.builtin.is_some() || global.builtin.is_some();
    if let Some(other) = holder.map(|holder| fragment.global(holder)).filter(|other| !both_builtin(other)) {
        let message = format!("`{}` and `{}` are both color {location}", other.name, global.name);
        let help = "give one of them another location, or another `index` for dual-source blending";
        let diagnostic = Diagnostic::new(&codes::link::OUTPUT_OVERLAP, global.span, message);
        ctx.report(diagnostic.label(other.span, "the other one").help(help));
    }
}

fn place_free(taken: &mut Taken, candidate: &Candidate<'_>) -> Option<u32> {
    let last = MAX_DRAW_BUFFERS.checked_sub(candidate.numbers)?;
    let location = (0..=last).find(|&location| {
        slots(taken, candidate.index, location, candidate.numbers)
            .is_some_and(|slots| slots.iter().all(Option::is_none))
    })?;
    slots(taken, candidate.index, location, candidate.numbers)?.fill(Some(candidate.id));
    Some(location)
}

fn too_many(ctx: &mut Context<'_>, candidate: &Candidate<'_>) {
    let message = format!(
        "no room for `{}`, which takes {} of the {MAX_DRAW_BUFFERS}",
        candidate.global.name,
        plural(candidate.numbers, "color")
    );
    ctx.report(Diagnostic::new(&codes::link::TOO_MANY_OUTPUTS, candidate.global.span, message));
}

/// Checks that `gl_FragColor`, `gl_FragData` and declared outputs exclude each other (§7.2) across the shaders of the
/// stage. The analysis checks each shader.
pub(super) fn check_exclusive(ctx: &mut Context<'_>, fragment: &Shader) {
    if fragment.stage != Stage::Fragment {
        return;
    }
    let written = |builtin: Option<BuiltinVariable>| {
        fragment
            .globals
            .iter()
            .find(|global| global.storage == Storage::Out && global.written && global.builtin == builtin)
    };
    let builtins = [BuiltinVariable::FragColor, BuiltinVariable::FragData];
    let user = written(None);
    let [color, data] = builtins.map(|builtin| written(Some(builtin)));
    let conflicts = [(color, data), (color, user), (data, user)];
    for (first, second) in conflicts.into_iter().filter_map(|(first, second)| first.zip(second)) {
        let span = [second.span, first.span].into_iter().find(|span| span.is_known()).unwrap_or_default();
        let span = first_write(fragment, first).unwrap_or(span);
        let message = format!("the shader writes both `{}` and `{}`", first.name, second.name);
        let other = first_write(fragment, second).unwrap_or(second.span);
        let mut diagnostic = Diagnostic::new(&codes::link::OUTPUT_CONFLICT, span, message);
        if other.is_known() {
            diagnostic = diagnostic.label(other, format!("`{}` is written here", second.name));
        }
        ctx.report(diagnostic.help("declare every output with `out` and drop the deprecated names"));
    }
}

/// The position of the first assignment to a global.
fn first_write(shader: &Shader, global: &Global) -> Option<crate::source::Span> {
    let (id, _) = shader.globals().find(|(_, other)| std::ptr::eq(*other, global))?;
    super::usage::first_write(shader, id)
}
