//! Snapshots of shaders: tests that notice when code, reflection, diagnostics, what specialization leaves out, or a picture
//! changes. Hosts find all of it in `glisten::snapshot`, and the macros in `glisten`.
//!
//! *In:* a program, a compilation, a scene, a picture. *Out:* a comparison with the snapshot that is stored next to the test.
//! Texts are snapshots of [`insta`]: `cargo insta review` shows and accepts them. Pictures are PNG files next to those, with
//! the same workflow: a picture that no longer fits leaves `NAME.new.png`, `NAME.difference.png` and, with the reason, `NAME.new.json`; `glisten snapshots
//! review` shows them, `glisten snapshots accept` accepts them. `INSTA_UPDATE` means the same to both.
//!
//! ```no_run
//! use glisten_emit::Target;
//! use glisten_front::{Compiler, Options};
//! use glisten_reference::{RenderOptions, render};
//! use glisten_snapshot::{Criterion, assert_emitted, assert_picture, assert_reflection, assert_scene};
//! use glisten_verify::scene::{DiskFiles, load};
//!
//! # fn test() {
//! let loaded = load("shaders/lit.toml", &DiskFiles, &Compiler::new(Options::default()));
//! let scene = loaded.scene.expect("the scene is valid");
//! assert_emitted!("lit", *scene.draws[0].program, Target::Wgsl);
//! assert_reflection!("lit-reflection", *scene.draws[0].program);
//! // The stored picture has to be one that a conforming GPU may draw.
//! assert_scene!("lit", scene);
//! // The picture of a renderer has to look like the stored one.
//! let picture = render(&scene, &RenderOptions::default()).expect("it can be drawn");
//! assert_picture!("lit-picture", picture, Criterion::Flip(0.01));
//! # }
//! ```
//!
//! *Holds:* a picture is compared, never compared by its hash: rounding differs between GPUs. Only files in the folder `snapshots`
//! next to a test are written.

#[cfg(feature = "assert")]
mod criterion;
#[cfg(feature = "page")]
pub mod page;
pub mod pending;
#[cfg(feature = "assert")]
mod pictures;
#[cfg(feature = "assert")]
mod texts;

#[cfg(feature = "assert")]
pub use criterion::{Comparison, Criterion};
#[cfg(feature = "assert")]
pub use insta;
#[cfg(feature = "assert")]
pub use pictures::{Place, check_picture, check_scene};
#[cfg(feature = "assert")]
pub use texts::{account, diagnostics, emitted, reflection};

/// Asserts the code of all stages of a [`Program`](glisten_front::Program) for a target: `assert_emitted!("name", program, target)`.
#[cfg(feature = "assert")]
#[macro_export]
macro_rules! assert_emitted {
    ($name:expr, $program:expr, $target:expr $(,)?) => {
        $crate::insta::assert_snapshot!($name, $crate::emitted(&$program, $target), stringify!($program, $target))
    };
}

/// Asserts the reflection of a [`Program`](glisten_front::Program): `assert_reflection!("name", program)`.
#[cfg(feature = "assert")]
#[macro_export]
macro_rules! assert_reflection {
    ($name:expr, $program:expr $(,)?) => {
        $crate::insta::assert_snapshot!($name, $crate::reflection(&$program), stringify!($program))
    };
}

/// Asserts the diagnostics of a [`Compilation`](glisten_front::Compilation), as people see them: `assert_diagnostics!("name", compilation)`.
#[cfg(feature = "assert")]
#[macro_export]
macro_rules! assert_diagnostics {
    ($name:expr, $compilation:expr $(,)?) => {
        $crate::insta::assert_snapshot!($name, $crate::diagnostics(&$compilation), stringify!($compilation))
    };
}

/// Asserts what specialization leaves out of a scene: `assert_account!("name", scene, sources)`, with the texts of the scene
/// (`Loaded::sources`).
#[cfg(feature = "assert")]
#[macro_export]
macro_rules! assert_account {
    ($name:expr, $scene:expr, $sources:expr $(,)?) => {
        $crate::insta::assert_snapshot!($name, $crate::account(&$scene, &$sources), stringify!($scene))
    };
}

/// Asserts a [`Picture`](glisten_scene::picture::Picture) by a [`Criterion`]: `assert_picture!("name", picture, criterion)`.
#[cfg(feature = "assert")]
#[macro_export]
macro_rules! assert_picture {
    ($name:expr, $picture:expr, $criterion:expr $(,)?) => {
        $crate::check_picture(
            &$crate::Place::new(env!("CARGO_MANIFEST_DIR"), file!(), module_path!(), $name),
            &$picture,
            $criterion,
        )
    };
}

/// Asserts that the stored picture is one that a conforming GPU may draw of a [`Scene`](glisten_verify::scene::Scene), compared by the
/// reference's envelope: `assert_scene!("name", scene)`.
#[cfg(feature = "assert")]
#[macro_export]
macro_rules! assert_scene {
    ($name:expr, $scene:expr $(,)?) => {
        $crate::check_scene(&$crate::Place::new(env!("CARGO_MANIFEST_DIR"), file!(), module_path!(), $name), &$scene)
    };
}
