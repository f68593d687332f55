//! [`Runner`]: draws a scene to be compared. [`Reference`]: draws the picture with which it is compared.
//!
//! *In:* a [`Scene`]. *Out:* a [`Picture`], or a [`Failure`].

use super::clock::Clock;
use crate::scene::Scene;
use glisten_front::diagnostic::Diagnostic;
use glisten_reference::{Contribution, LineRule, Precision, RenderOptions, Undefined};
use glisten_scene::compare::Population;
use glisten_scene::picture::Picture;
use std::fmt;
use std::ops::Range;

/// The result of a runner.
#[derive(Clone, Debug)]
pub struct Drawn {
    /// The picture, top row first.
    pub picture: Picture,
    /// The time in milliseconds.
    pub milliseconds: f64,
}

/// The reason why there is no picture.
#[derive(Clone, Debug)]
pub enum Failure {
    /// The programs of the scene cannot be drawn by this runner.
    Diagnostics(Vec<Diagnostic>),
    /// The machine lacks something that the runner needs, for example a driver.
    Machine(String),
    /// The draw was rejected or did not end.
    Refused(String),
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Diagnostics(diagnostics) => {
                let messages: Vec<&str> = diagnostics.iter().map(|found| found.message.as_str()).collect();
                f.write_str(&messages.join("; "))
            }
            Self::Machine(message) | Self::Refused(message) => f.write_str(message),
        }
    }
}

impl std::error::Error for Failure {}

impl From<Vec<Diagnostic>> for Failure {
    fn from(diagnostics: Vec<Diagnostic>) -> Self {
        Self::Diagnostics(diagnostics)
    }
}

/// Draws scenes.
pub trait Runner {
    /// A short name, also for the picture's file after a failure: `spirv`, `wgsl`, `gl`.
    fn name(&self) -> &'static str;

    /// Draws a scene.
    ///
    /// # Errors
    /// There is no picture.
    fn draw(&self, scene: &Scene) -> Result<Drawn, Failure>;
}

/// Draws the pictures with which runners are compared. A host with time limits or threads of its own implements it.
pub trait Reference {
    /// Draws a scene like [`glisten_reference::render`].
    ///
    /// # Errors
    /// There is no picture.
    fn render(&self, scene: &Scene, options: &RenderOptions) -> Result<Picture, Failure>;

    /// Draws a scene with several options.
    ///
    /// # Errors
    /// One of the pictures is missing.
    fn render_all(&self, scene: &Scene, options: &[RenderOptions]) -> Result<Vec<Picture>, Failure> {
        options.iter().map(|options| self.render(scene, options)).collect()
    }

    /// Counts the work of the envelope like [`glisten_reference::envelope_work`].
    ///
    /// # Errors
    /// The scene cannot be drawn.
    fn work(&self, scene: &Scene, options: &RenderOptions) -> Result<u64, Failure> {
        Ok(glisten_reference::envelope_work(scene, options)?)
    }

    /// Adds the pictures of the simulated GPUs with these numbers like [`glisten_reference::populate`].
    ///
    /// # Errors
    /// The scene cannot be drawn.
    fn populate(
        &self,
        mut population: Population,
        scene: &Scene,
        options: &RenderOptions,
        members: Range<u32>,
    ) -> Result<Population, Failure> {
        glisten_reference::populate(&mut population, scene, options, members)?;
        Ok(population)
    }

    /// Draws some pixels of a scene as llvmpipe does, like [`glisten_reference::as_llvmpipe`].
    ///
    /// # Errors
    /// The scene cannot be drawn.
    fn as_llvmpipe(
        &self,
        scene: &Scene,
        options: &RenderOptions,
        number: u32,
        places: &[bool],
    ) -> Result<Picture, Failure> {
        Ok(glisten_reference::as_llvmpipe(scene, options, number, Some(places))?)
    }

    /// Finds what the language leaves undefined like [`glisten_reference::undefined`].
    ///
    /// # Errors
    /// The scene cannot be drawn.
    fn undefined(&self, scene: &Scene, options: &RenderOptions) -> Result<Option<Undefined>, Failure> {
        Ok(glisten_reference::undefined(scene, options)?)
    }

    /// Explains a channel of a pixel like [`glisten_reference::explain`].
    ///
    /// # Errors
    /// The scene cannot be drawn.
    fn explain(&self, scene: &Scene, options: &RenderOptions, at: Channel) -> Result<Vec<Contribution>, Failure>;
}

/// A channel of a pixel of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Channel {
    /// The column from the left and the row from the top.
    pub pixel: [u32; 2],
    /// The color attachment.
    pub attachment: u32,
    /// 0 (red) to 3 (alpha).
    pub channel: u32,
}

impl Channel {
    /// `red`, `green`, `blue`, `alpha`
    pub fn name(self) -> &'static str {
        ["red", "green", "blue", "alpha"].get(self.channel as usize).copied().unwrap_or("a channel")
    }
}

/// The reference on the calling thread.
#[derive(Clone, Copy, Debug, Default)]
pub struct ThisThread;

impl Reference for ThisThread {
    fn render(&self, scene: &Scene, options: &RenderOptions) -> Result<Picture, Failure> {
        Ok(glisten_reference::render(scene, options)?)
    }

    fn explain(&self, scene: &Scene, options: &RenderOptions, at: Channel) -> Result<Vec<Contribution>, Failure> {
        let Channel { pixel, attachment, channel } = at;
        Ok(glisten_reference::explain(scene, options, pixel, attachment as usize, channel as usize)?)
    }
}

/// The reference as a runner. In f32, it is a strict GPU without a driver.
#[derive(Clone, Copy, Debug)]
pub struct Cpu {
    options: RenderOptions,
}

impl Cpu {
    /// The reference in a precision, with Vulkan's rule for lines.
    pub fn new(precision: Precision) -> Self {
        Self { options: RenderOptions { precision, lines: LineRule::Vulkan, ..RenderOptions::default() } }
    }
}

impl Runner for Cpu {
    fn name(&self) -> &'static str {
        match self.options.precision {
            Precision::F32 => "f32",
            Precision::F64 => "f64",
            Precision::Envelope => "envelope",
        }
    }

    fn draw(&self, scene: &Scene) -> Result<Drawn, Failure> {
        let clock = Clock::start();
        let picture = glisten_reference::render(scene, &self.options)?;
        Ok(Drawn { picture, milliseconds: clock.milliseconds() })
    }
}

/// A scene as a device draws it: its geometry stages have run, and its programs are what `compile` writes by default, without
/// what reaches no output.
///
/// # Errors
/// The diagnostics of a geometry stage that cannot run.
#[cfg(feature = "gpu")]
pub fn as_compiled(scene: &Scene) -> Result<Scene, Vec<Diagnostic>> {
    Ok(glisten_reference::expand(scene)?.with_programs(&glisten_specialize::optimize))
}

/// The emitted code on a GPU: what `compile` writes by default, or as `compile -O0` does.
#[cfg(feature = "gpu")]
#[derive(Clone, Copy)]
pub struct OnGpu<'a> {
    gpu: &'a glisten_gpu::Gpu,
    via: glisten_gpu::Via,
    foreign: &'a [glisten_gpu::Foreign],
    /// Whether what reaches no output is emitted as well.
    whole: bool,
}

#[cfg(feature = "gpu")]
impl<'a> OnGpu<'a> {
    /// The runner of one form.
    pub fn new(gpu: &'a glisten_gpu::Gpu, via: glisten_gpu::Via) -> Self {
        Self { gpu, via, foreign: &[], whole: false }
    }

    /// The runner of everything that the sources use, as `compile -O0` writes it.
    #[must_use]
    pub fn whole(self, whole: bool) -> Self {
        Self { whole, ..self }
    }

    /// The runner with modules of other translators in place of the emitted ones. What the emitter then adds has the interface
    /// of the whole program.
    #[must_use]
    pub fn with(self, foreign: &'a [glisten_gpu::Foreign]) -> Self {
        Self { foreign, ..self }
    }

    /// The runners of both forms, SPIR-V first.
    pub fn both(gpu: &'a glisten_gpu::Gpu) -> [Self; 2] {
        [glisten_gpu::Via::Spirv, glisten_gpu::Via::Wgsl].map(|via| Self::new(gpu, via))
    }
}

#[cfg(feature = "gpu")]
impl Runner for OnGpu<'_> {
    fn name(&self) -> &'static str {
        self.via.name()
    }

    fn draw(&self, scene: &Scene) -> Result<Drawn, Failure> {
        let prepared = if self.foreign.is_empty() && !self.whole {
            self.gpu.prepare(&as_compiled(scene)?, self.via)?
        } else {
            let scene = glisten_reference::expand(scene)?;
            self.gpu.prepare_foreign(&scene, self.via, self.foreign, &glisten_specialize::optimize)?
        };
        let glisten_gpu::Rendered { picture, milliseconds } = self.gpu.draw(&prepared)?;
        Ok(Drawn { picture, milliseconds })
    }
}

#[cfg(feature = "gpu")]
impl From<glisten_gpu::Error> for Failure {
    fn from(error: glisten_gpu::Error) -> Self {
        match error {
            glisten_gpu::Error::Emit(diagnostics) => Self::Diagnostics(diagnostics),
            error if error.is_environment() => Self::Machine(error.to_string()),
            error => Self::Refused(error.to_string()),
        }
    }
}

/// The original sources on an OpenGL driver. Use it with [`LineRule::OpenGl`] in
/// [`Options::lines`](super::Options::lines).
#[cfg(feature = "gl")]
pub struct OnOpenGl<'a>(pub &'a glisten_gl::Gl);

#[cfg(feature = "gl")]
impl Runner for OnOpenGl<'_> {
    fn name(&self) -> &'static str {
        "gl"
    }

    fn draw(&self, scene: &Scene) -> Result<Drawn, Failure> {
        let clock = Clock::start();
        let picture = self.0.render(scene).map_err(|error| match error.is_environment() {
            true => Failure::Machine(error.to_string()),
            false => Failure::Refused(error.to_string()),
        })?;
        Ok(Drawn { picture, milliseconds: clock.milliseconds() })
    }
}
