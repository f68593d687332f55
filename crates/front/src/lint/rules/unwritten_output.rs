//! `unwritten-output`: a color that a fragment shader declares and never writes, or of which it never writes a component. Red alone, or red
//! and green, may be all that the framebuffer has.

use super::super::{Findings, Subject, parts};
use crate::builtin::BuiltinVariable;
use crate::hir::{Global, GlobalId, Shader, Stage, Storage, VarRef, written_by};
use crate::link::usage::first_use;
use rustc_hash::FxHashMap;

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    let Some(fragment) = subject.program.stage(Stage::Fragment) else { return };
    let written = written(subject, fragment);
    for (id, output) in fragment.globals().filter(|(_, global)| is_color(global)) {
        if !output.written {
            if output.builtin.is_none() {
                let message = format!("the fragment output `{}` is never written", output.name);
                findings.push(findings.at(output.span, message).here("its color is undefined"));
            }
            continue;
        }
        let whole = parts::of_type(&subject.program.types, output.ty);
        let written = written.get(&id).copied().unwrap_or(parts::ALL);
        // Those of a buffer with one or two channels.
        let is_short = [0b1, 0b11].contains(&written);
        let missing = whole.filter(|_| !is_short).map_or(0, |whole| whole & !written);
        if let Some(span) = first_use(fragment, id).filter(|_| missing != 0) {
            let names = parts::named(missing, "rgba");
            let message = format!("`{}.{names}` is never written", output.name);
            findings.push(findings.at(span, message).here(format!("the other components leave `{names}` undefined")));
        }
    }
}

/// Whether a global is a color: an output, or the one color of before GLSL 1.30.
fn is_color(global: &Global) -> bool {
    global.storage == Storage::Out && global.builtin.is_none_or(|builtin| builtin == BuiltinVariable::FragColor)
}

/// The components of the globals that a shader writes on any path.
fn written(subject: &Subject<'_>, shader: &Shader) -> FxHashMap<GlobalId, u8> {
    let mut written: FxHashMap<GlobalId, u8> = FxHashMap::default();
    let places = subject.places.iter().filter(|place| std::ptr::eq(place.shader, shader));
    for &expr in places.flat_map(|place| &place.exprs) {
        written_by(shader, expr, &mut |target| {
            if let Some((VarRef::Global(id), components)) = parts::of_place(shader, target) {
                *written.entry(id).or_default() |= components;
            }
        });
    }
    written
}
