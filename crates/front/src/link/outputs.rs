//! Assigns color numbers to fragment outputs (OpenGL 3.2 §3.9.2, GLSL 1.50 §7.2).
//!
//! *In:* the fragment stage. *Out:* its color outputs with numbers, assigned as [`declared`](super::declared)
//! describes. An array takes one number per element. `gl_FragColor` and `gl_FragData` have number 0.

use super::declared::{Clash, Rules, Variable};
use super::{Linker, Output};
use crate::builtin::BuiltinVariable;
use crate::builtin::constants::MAX_DRAW_BUFFERS;
use crate::diagnostic::{Diagnostic, codes};
use crate::hir::{ArraySize, Global, Shader, Stage, Storage, Type, TypeId, Types};

/// The number of sources in dual-source blending.
const INDICES: usize = 2;

fn numbers(types: &Types, ty: TypeId) -> u32 {
    match types.get(ty) {
        Type::Array(_, ArraySize::Sized(size)) => size,
        _ => 1,
    }
}

/// Assigns numbers to all color outputs of the fragment stage.
pub(super) fn assign(ctx: &mut Linker<'_>, fragment: &Shader) -> Vec<Output> {
    let rules = Rules {
        limit: MAX_DRAW_BUFFERS,
        rows: INDICES,
        words: ("color", "number"),
        too_many: &codes::link::TOO_MANY_OUTPUTS,
        help: None,
        bindings: ctx.bindings.frag_data_locations,
    };
    let outputs = fragment.globals().filter(|(_, global)| global.storage == Storage::Out && is_color(global));
    let mut variables: Vec<Variable<'_>> = outputs
        .map(|(id, global)| Variable {
            id,
            global,
            count: numbers(ctx.types, global.ty),
            row: global.index.unwrap_or(0),
            active: global.written,
            location: if global.builtin.is_some() { Some(0) } else { rules.fixed(ctx, global) },
        })
        .collect();
    rules.place(ctx, &mut variables, &mut |ctx, clash| overlap(ctx, fragment, clash));
    let mut placed: Vec<Output> = variables.into_iter().filter_map(output).collect();
    placed.sort_by_key(|output| (output.location, output.index));
    placed
}

fn output(variable: Variable<'_>) -> Option<Output> {
    Some(Output {
        name: variable.global.name.clone(),
        ty: variable.global.ty,
        global: variable.id,
        location: variable.location?,
        index: variable.row,
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

/// Reports two outputs with one number. [`check_exclusive`] reports the deprecated ones.
fn overlap(ctx: &mut Linker<'_>, fragment: &Shader, clash: &Clash) {
    let (other, global) = (fragment.global(clash.variables.0), fragment.global(clash.variables.1));
    if !fragment.mixes_outputs && (other.builtin.is_some() || global.builtin.is_some()) {
        return;
    }
    let message = format!("`{}` and `{}` are both color {}", other.name, global.name, clash.shared);
    let help = "give one of them another location, or another `index` for dual-source blending";
    let diagnostic = Diagnostic::new(&codes::link::OUTPUT_OVERLAP, global.span, message);
    ctx.report(diagnostic.label(other.span, "the other one").help(help));
}

/// Checks that `gl_FragColor`, `gl_FragData` and declared outputs exclude each other (§7.2) across the shaders of the
/// stage. The analysis checks each shader.
pub(super) fn check_exclusive(ctx: &mut Linker<'_>, fragment: &Shader) {
    if fragment.stage != Stage::Fragment || fragment.mixes_outputs {
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
