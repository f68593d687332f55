//! Runs `.shader_test` files, the format of piglit's shader_runner: shaders, data, draws and the expected picture,
//! all in one text file.
//!
//! *In:* the text of a test, and a backend (the GPU or the reference). *Out:* a [`TestResult`]: pass, fail or skip,
//! with the reason.
//!
//! ```text
//! [require]
//! GLSL >= 1.50
//!
//! [vertex shader passthrough]
//!
//! [fragment shader]
//! #version 150
//! uniform vec4 tint;
//! out vec4 color;
//! void main() { color = tint; }
//!
//! [test]
//! uniform vec4 tint 0 1 0 1
//! draw rect -1 -1 2 2
//! probe all rgba 0 1 0 1
//! ```
//!
//! *Holds:* if a test requests something that this runner does not support, the test is skipped with its name, and
//! never passes. A word that shader_runner does not have either fails it.
//! *Not done here:* tessellation and compute shaders, lighting and fog of the fixed-function pipeline, transform feedback.

mod draw;
mod fixed;
mod introspection;
mod known;
mod parameters;
mod parse;
mod probe;
mod program;
mod require;
mod session;
mod textures;
mod uniforms;
mod vertex_data;
mod words;

use crate::scene::Scene;
use glisten_front::compiler::{Compilation, Compiler};
use glisten_scene::picture::Picture;

/// The result of a test.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum TestResult {
    /// All expectations hold.
    Pass,
    /// An expectation does not hold; the text says where and which.
    Fail(String),
    /// The test requests something that is not supported; the text says what.
    Skip(String),
}

impl TestResult {
    /// `pass`, `fail`, `skip`
    pub fn name(&self) -> &'static str {
        match self {
            Self::Pass => "pass",
            Self::Fail(_) => "fail",
            Self::Skip(_) => "skip",
        }
    }

    /// Puts what is likely the cause in front of the reason of a failure.
    fn because(self, cause: Option<String>) -> Self {
        match (self, cause) {
            (Self::Fail(reason), Some(cause)) => Self::Fail(format!("{cause}; {reason}")),
            (result, _) => result,
        }
    }

    /// The reason, if the test did not pass.
    pub fn reason(&self) -> Option<&str> {
        match self {
            Self::Pass => None,
            Self::Fail(reason) | Self::Skip(reason) => Some(reason),
        }
    }
}

/// Draws the scenes of a test. An error fails the test, or skips it if the backend lacks a feature.
pub trait TestBackend {
    /// Draws a scene.
    ///
    /// # Errors
    /// [`TestResult::Fail`] or [`TestResult::Skip`].
    fn draw(&mut self, scene: &Scene) -> Result<Picture, TestResult>;
}

/// Runs the test called `name` with this text.
pub fn run(name: &str, text: &str, compiler: &Compiler, backend: &mut dyn TestBackend) -> TestResult {
    match session::run(name, text, compiler, backend) {
        Ok(()) => TestResult::Pass,
        Err(result) => result,
    }
}

/// The compilation of the shaders of a test; nothing if the test does not run, or if an error is what it expects.
pub fn compilation(name: &str, text: &str, compiler: &Compiler) -> Option<Compilation> {
    let file = parse::parse(text).ok()?;
    let setup = require::check(&file.requirements).ok()?;
    program::compilation(name, &file, &setup, compiler)
}

/// Fails with a line number and a reason.
fn fail<T>(line: u32, reason: impl std::fmt::Display) -> Result<T, TestResult> {
    Err(TestResult::Fail(format!("line {line}: {reason}")))
}

/// Skips with a line number and a reason.
fn skip<T>(line: u32, reason: impl std::fmt::Display) -> Result<T, TestResult> {
    Err(TestResult::Skip(format!("line {line}: {reason}")))
}
