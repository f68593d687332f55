//! Runs `.shader_test` files: shaders, data, draws and what the picture must be, in one text file; the format of piglit's
//! shader_runner.
//!
//! *In:* the text of a test, and a painter (the GPU or the reference). *Out:* [`Outcome`]: pass, fail or skip, with the
//! reason.
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
//! *Holds:* what a test asks for and this runner does not know is a skip that names it, never a pass. A text of an older
//! version runs with its version raised to 1.50, and is skipped if it is not valid then.
//! *Not done here:* geometry, tessellation and compute shaders, compatibility state, transform feedback.

mod draw;
mod introspection;
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
use glisten_front::compiler::Compiler;
use glisten_scene::picture::Picture;

/// How a test ended.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// Everything was as the test says.
    Pass,
    /// Something was not; where and what.
    Fail(String),
    /// The test asks for something that is not there; what.
    Skip(String),
}

impl Outcome {
    /// `pass`, `fail`, `skip`
    pub fn name(&self) -> &'static str {
        match self {
            Self::Pass => "pass",
            Self::Fail(_) => "fail",
            Self::Skip(_) => "skip",
        }
    }

    /// Why, if it did not pass.
    pub fn reason(&self) -> Option<&str> {
        match self {
            Self::Pass => None,
            Self::Fail(reason) | Self::Skip(reason) => Some(reason),
        }
    }
}

/// What draws the scenes of a test. An error is a failure of the test, or a skip if the painter lacks a feature.
pub trait Painter {
    /// The picture of a scene.
    ///
    /// # Errors
    /// [`Outcome::Fail`] or [`Outcome::Skip`].
    fn paint(&mut self, scene: &Scene) -> Result<Picture, Outcome>;
}

/// Runs the test called `name`, whose text this is.
pub fn run(name: &str, text: &str, compiler: &Compiler, painter: &mut dyn Painter) -> Outcome {
    match session::run(name, text, compiler, painter) {
        Ok(()) => Outcome::Pass,
        Err(outcome) => outcome,
    }
}

/// Fails with a place and a reason.
fn fail<T>(line: u32, reason: impl std::fmt::Display) -> Result<T, Outcome> {
    Err(Outcome::Fail(format!("line {line}: {reason}")))
}

/// Skips with a place and a reason.
fn skip<T>(line: u32, reason: impl std::fmt::Display) -> Result<T, Outcome> {
    Err(Outcome::Skip(format!("line {line}: {reason}")))
}
