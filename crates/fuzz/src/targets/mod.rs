//! The targets, by the phase that they check.
//!
//! *In:* bytes. *Out:* a panic where a promise does not hold.

mod emit;
mod files;
mod front;
mod scene;
mod tests;
mod texts;

use crate::Target;
use crate::seeds::Kind;
use glisten_front::Diagnostics;
use glisten_front::diagnostic::codes::general::INTERNAL;

/// All of them.
pub(crate) const ALL: &[Target] = &[
    Target {
        name: "front",
        promise: "a program is accepted or has errors, in its own texts",
        check: front::check,
        begins: Kind::Shaders,
    },
    Target {
        name: "lint",
        promise: "the rules take what is accepted, and their fixes are edits of its texts",
        check: front::lint,
        begins: Kind::Shaders,
    },
    Target {
        name: "emit",
        promise: "each target writes what is accepted, or says what it lacks",
        check: emit::check,
        begins: Kind::Shaders,
    },
    Target {
        name: "print",
        promise: "GLSL that is written is accepted again",
        check: emit::print,
        begins: Kind::Shaders,
    },
    Target {
        name: "optimize",
        promise: "an optimized program is a program with the same interface",
        check: emit::optimize,
        begins: Kind::Shaders,
    },
    Target {
        name: "format",
        promise: "a formatted text has the same tokens, and formatting it again changes nothing",
        check: texts::format,
        begins: Kind::Shaders,
    },
    Target {
        name: "upgrade",
        promise: "a rewritten program is accepted",
        check: texts::upgrade,
        begins: Kind::Shaders,
    },
    Target { name: "scene", promise: "a scene draws or has errors", check: scene::check, begins: Kind::Scenes },
    Target {
        name: "compare",
        promise: "no pixel in f32 is outside of the envelope",
        check: scene::compare,
        begins: Kind::Scenes,
    },
    Target {
        name: "specialize",
        promise: "what is left of a scene draws the same bits in f32",
        check: scene::specialize,
        begins: Kind::Scenes,
    },
    Target {
        name: "shader_test",
        promise: "a test passes, fails or is skipped",
        check: tests::shader_test,
        begins: Kind::ShaderTests,
    },
    Target {
        name: "unit_test",
        promise: "functions under `//! test` pass, fail or are skipped",
        check: tests::unit_test,
        begins: Kind::UnitTests,
    },
    Target { name: "obj", promise: "a model has a scene or is refused", check: files::obj, begins: Kind::Files("obj") },
    Target {
        name: "gltf",
        promise: "a model has a scene or is refused",
        check: files::gltf,
        begins: Kind::Files("gltf"),
    },
    Target { name: "glb", promise: "a model has a scene or is refused", check: files::glb, begins: Kind::Files("glb") },
    Target {
        name: "ies",
        promise: "the profile of a lamp is finite, or refused",
        check: files::ies,
        begins: Kind::Files("ies"),
    },
    Target { name: "image", promise: "a picture is read or refused", check: files::image, begins: Kind::Pictures },
];

/// Errors of glisten itself are findings, whatever the input.
fn no_internal_error(diagnostics: &Diagnostics) {
    no_internal_errors(diagnostics.iter());
}

fn no_internal_errors<'a>(diagnostics: impl IntoIterator<Item = &'a glisten_front::Diagnostic>) {
    for diagnostic in diagnostics {
        assert!(diagnostic.code.id != INTERNAL.id, "an internal error: {}", diagnostic.message);
    }
}
