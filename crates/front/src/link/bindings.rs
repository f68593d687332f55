//! Checks the locations that a host binds by name (OpenGL 3.2 §2.11.3, §3.9.2).
//!
//! *In:* the stages, and the bindings. *Out:* diagnostics. *Holds:* OpenGL accepts a binding of a name that the program
//! does not have, for it may be linked to another program later, so that is a warning; it refuses names with `gl_` and
//! numbers out of range. A stage that is not there has no names to compare with.

use super::Linker;
use crate::builtin::constants::{MAX_DRAW_BUFFERS, MAX_VERTEX_ATTRIBS};
use crate::diagnostic::codes::link::{BINDING_REFUSED, BINDING_WITHOUT_VARIABLE};
use crate::diagnostic::{Diagnostic, did_you_mean};
use crate::hir::{Global, Shader, Stage, Storage};

/// The word for the numbers of fragment outputs, with which a message about such a binding begins.
pub const COLOR_NUMBER: &str = "color number";

/// A kind of variable whose locations a host binds.
struct Bindable {
    call: &'static str,
    stage: Stage,
    storage: Storage,
    /// The word for the variables.
    noun: &'static str,
    /// The word for their numbers.
    number: &'static str,
    limit: u32,
}

const ATTRIBUTES: Bindable = Bindable {
    call: "glBindAttribLocation",
    stage: Stage::Vertex,
    storage: Storage::In,
    noun: "attribute",
    number: "location",
    limit: MAX_VERTEX_ATTRIBS,
};

const OUTPUTS: Bindable = Bindable {
    call: "glBindFragDataLocation",
    stage: Stage::Fragment,
    storage: Storage::Out,
    noun: "fragment output",
    number: COLOR_NUMBER,
    limit: MAX_DRAW_BUFFERS,
};

/// Checks all bindings of a program.
pub(super) fn check(ctx: &mut Linker<'_>, stages: &[Shader]) {
    let bindings = ctx.bindings;
    for (kind, list) in [(ATTRIBUTES, bindings.attribute_locations), (OUTPUTS, bindings.frag_data_locations)] {
        let Some(shader) = stages.iter().find(|shader| shader.stage == kind.stage) else { continue };
        for (index, (name, number)) in list.iter().enumerate() {
            // Of several bindings of a name, the last one counts.
            if list.iter().skip(index + 1).all(|(later, _)| later != name) {
                check_one(ctx, &kind, (name, *number), shader, stages);
            }
        }
    }
}

fn check_one(ctx: &mut Linker<'_>, kind: &Bindable, (name, number): (&str, u32), shader: &Shader, stages: &[Shader]) {
    let refused = |message: String, error: &str| {
        let help = format!("`{}` gives {error}", kind.call);
        Diagnostic::new(&BINDING_REFUSED, shader.anchor(), message).help(help)
    };
    // Those of the fixed-function pipeline are attributes like any other.
    let is_fixed = |global: &Global| global.is_fixed() && global.storage == kind.storage && global.name == name;
    if name.starts_with("gl_") && !shader.globals.iter().any(is_fixed) {
        ctx.report(refused(format!("`{name}` is built in and cannot be bound"), "GL_INVALID_OPERATION"));
        return;
    }
    let known = |global: &&Global| global.storage == kind.storage && global.builtin.is_none() && global.block.is_none();
    if shader.globals.iter().filter(known).any(|global| global.name == name) {
        return;
    }
    if number >= kind.limit {
        let message = format!("`{name}` is bound to {} {number}, and the last one is {}", kind.number, kind.limit - 1);
        ctx.report(refused(message, "GL_INVALID_VALUE"));
        return;
    }
    let message = format!("a {} is bound to `{name}`, which is no {} of the program", kind.number, kind.noun);
    let mut diagnostic = Diagnostic::new(&BINDING_WITHOUT_VARIABLE, shader.anchor(), message);
    let names = || shader.globals.iter().filter(known).map(|global| global.name.as_str());
    if let Some((other, stage)) = elsewhere(name, stages) {
        diagnostic = diagnostic.label(other.span, format!("{} of the {} stage", role(other.storage), stage.name()));
    } else if let Some(array) =
        name.split_once('[').map(|(array, _)| array).filter(|array| names().any(|name| name == *array))
    {
        diagnostic = diagnostic.help(format!("bind the whole array, `{array}`: its elements follow each other"));
    } else if let Some(near) = did_you_mean(name, names()) {
        diagnostic = diagnostic.help(format!("did you mean `{near}`?"));
    }
    ctx.report(diagnostic);
}

/// A variable of this name that cannot be bound.
fn elsewhere<'a>(name: &str, stages: &'a [Shader]) -> Option<(&'a Global, Stage)> {
    let all = stages.iter().flat_map(|shader| shader.globals.iter().map(move |global| (global, shader.stage)));
    all.into_iter().find(|(global, _)| global.name == name && global.span.is_known())
}

fn role(storage: Storage) -> &'static str {
    match storage {
        Storage::In => "this is an input",
        Storage::Out => "this is an output",
        Storage::Uniform => "this is a uniform",
        Storage::Const | Storage::Private => "this is a variable",
    }
}
