//! Shared by `render`, `verify` and `report`: reading a scene with its shaders, and running work with a time limit.

use crate::arguments::args::{BindingArgs, LevelArgs, SourceArgs};
use crate::batch::Batch;
use crate::console::Console;
use crate::exit::{Exit, Failure};
use crate::files::{self, SceneFiles};
use crate::process::guard;
use crate::process::journal::{self, Note};
use crate::process::memory;
use crate::process::watchdog::{self, Watchdog};
use crate::session::Session;
use crate::threads::STACK_BYTES;
use clap::{Args, ValueEnum};
use glisten_front::diagnostic::codes::scenes::NOTHING_COVERED;
use glisten_front::diagnostic::{Code, Diagnostic};
use glisten_front::source::{SourceMap, Span};
use glisten_gpu::{Error, Gpu, Via};
use glisten_scene::{FileError, FileSource};
use glisten_sources::stages;
use glisten_verify::scene::{self, Scene};
use glisten_verify::specialize::{Contract, specialize_scene_by};
use std::cell::Cell;
use std::path::Path;
use std::sync::mpsc::{self, RecvTimeoutError};
use std::time::Duration;

/// The scene, and how to read its shaders.
#[derive(Args, Clone, Debug)]
pub(crate) struct SceneArgs {
    /// A scene file, or a model (.obj, .gltf, .glb), which gets a camera and lights; `verify` also takes a folder of scenes
    #[arg(value_name = "SCENE.toml")]
    pub(crate) scene: String,
    #[command(flatten)]
    pub(crate) machine: MachineArgs,
    #[command(flatten)]
    sources: SourceArgs,
    #[command(flatten)]
    levels: LevelArgs,
}

/// The time limit for a picture, in seconds, if nobody says another one.
const SECONDS: f64 = 60.0;
/// The time limit for a scene that is drawn many times.
const MANY_SECONDS: f64 = 600.0;

/// The GPU, and the time limit for a scene.
#[derive(Args, Clone, Debug)]
pub(crate) struct MachineArgs {
    /// Give up after this many seconds: 60 by default, and 600 where a command measures or draws a scene many times
    #[arg(long, value_name = "SECONDS", value_parser = parse_seconds, allow_negative_numbers = true)]
    timeout: Option<f64>,
    /// The GPU to use, by a part of its name, or `software` (default: `GLISTEN_ADAPTER` of the environment, or the
    /// first that opens, discrete and integrated GPUs before software adapters; on a machine without a GPU that is the
    /// first software adapter)
    #[arg(long, value_name = "NAME")]
    adapter: Option<String>,
}

/// The form of the emitted code that the GPU runs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum ViaArg {
    /// SPIR-V, passed to the driver unchanged
    #[default]
    Spirv,
    /// WGSL, parsed by wgpu
    Wgsl,
}

impl From<ViaArg> for Via {
    fn from(via: ViaArg) -> Self {
        match via {
            ViaArg::Spirv => Self::Spirv,
            ViaArg::Wgsl => Self::Wgsl,
        }
    }
}

fn parse_seconds(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(seconds) if seconds > 0.0 && seconds <= 1e6 => Ok(seconds),
        _ => Err(format!("`{text}` is not a number of seconds")),
    }
}

/// A scene that was read, with the texts that its diagnostics refer to.
pub(crate) struct Read<'a> {
    /// The scene.
    pub(crate) scene: Scene,
    session: Session<'a>,
    batch: Batch,
}

impl Read<'_> {
    /// The scene without what its picture does not need.
    pub(crate) fn specialized(&self, contract: Contract) -> Scene {
        specialize_scene_by(contract, &self.scene, self.sources(), &[]).scene
    }

    /// The scene at `path` with another text for one of its files.
    pub(crate) fn reloaded(&self, path: &str, file: &str, text: &str) -> Option<Scene> {
        let files = Changed { file, text, was_read: Cell::new(false) };
        let loaded = guard::guarded(|| scene::load(path, &files, self.session.compiler()));
        // The text of an include comes from elsewhere.
        loaded.ok()?.scene.filter(|_| files.was_read.get())
    }

    /// The texts of the scene and its shaders.
    pub(crate) fn sources(&self) -> &SourceMap {
        &self.batch.sources
    }

    /// Reports a failure to draw the scene.
    pub(crate) fn failed(self, error: DrawError) -> Result<Exit, Failure> {
        match error {
            DrawError::Failure(failure) => self.finish(Vec::new()).and(Err(failure)),
            DrawError::Diagnostics(diagnostics) => Ok(self.finish(diagnostics)?.max(Exit::Content)),
        }
    }

    /// Reports what drawing found. Returns the exit code.
    pub(crate) fn finish(mut self, found: Vec<Diagnostic>) -> Result<Exit, Failure> {
        if found.is_empty() {
            return Ok(Exit::Ok);
        }
        self.session.add(&mut self.batch, found);
        self.session.tell(&[&self.batch], false)
    }

    /// The note after the name of the GPU that drew the scene.
    pub(crate) fn host_part(&self) -> &'static str {
        if glisten_reference::has_geometry_stage(&self.scene) {
            "; the geometry stage ran on the host, and the GPU drew what it emitted"
        } else {
            ""
        }
    }

    /// The warning that nothing was drawn: no pixel is covered.
    pub(crate) fn nothing_covered(&self) -> Diagnostic {
        self.at_draw(&NOTHING_COVERED, "nothing is covered: no fragment reached a pixel").help(
            "look for triangles without area, a mesh outside the view, culled faces, a depth test that never passes, \
             or a `discard` that always runs",
        )
    }

    /// A diagnostic about the picture, at the first draw of the scene.
    pub(crate) fn at_draw(&self, code: &'static Code, message: impl Into<String>) -> Diagnostic {
        let scene = self.sources().files().next().map(|(id, _)| self.sources().file(id));
        let span = scene.map_or_else(Span::default, |scene| {
            let at = scene.text().find("[[draw").map_or(0..0, |at| at..at + "[[draw".len());
            Span::new(scene.base() + at.start as u32, scene.base() + at.end as u32)
        });
        Diagnostic::new(code, span, message)
    }
}

/// The files of the disk, but for one that has another text.
struct Changed<'a> {
    file: &'a str,
    text: &'a str,
    was_read: Cell<bool>,
}

impl FileSource for Changed<'_> {
    fn read(&self, path: &str) -> Result<Vec<u8>, FileError> {
        if path == self.file {
            self.was_read.set(true);
            return Ok(self.text.as_bytes().to_vec());
        }
        SceneFiles.read(path)
    }
}

/// Why a scene was not drawn.
pub(crate) enum DrawError {
    /// Errors in its shaders.
    Diagnostics(Vec<Diagnostic>),
    /// Any other failure.
    Failure(Failure),
}

impl From<Failure> for DrawError {
    fn from(failure: Failure) -> Self {
        Self::Failure(failure)
    }
}

impl From<Vec<Diagnostic>> for DrawError {
    fn from(diagnostics: Vec<Diagnostic>) -> Self {
        Self::Diagnostics(diagnostics)
    }
}

impl From<Error> for DrawError {
    fn from(error: Error) -> Self {
        if error.diagnostics().is_empty() {
            Self::Failure(gpu_failure(error))
        } else {
            Self::Diagnostics(error.diagnostics().to_vec())
        }
    }
}

/// The failure for a GPU that is missing or does not draw.
pub(crate) fn gpu_failure(error: Error) -> Failure {
    let exit = if error.is_environment() { Exit::Machine } else { Exit::Content };
    told(exit, &error.to_string())
}

/// A shader in place of a scene is one mistake, not a line of TOML that is none for each of its lines.
///
/// # Errors
/// The name or the text is that of a shader.
fn refuse_shader(path: &str) -> Result<(), Failure> {
    let name = Path::new(path);
    let is_toml = name.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("toml"));
    let has_shader_text = || {
        let bytes = files::read(path, name).unwrap_or_default();
        let text = String::from_utf8_lossy(&bytes);
        text.trim_start_matches('\u{feff}').trim_start().starts_with("#version") || text.contains("void main")
    };
    if is_toml || !name.is_file() || !(stages::by_name(name).is_some() || has_shader_text()) {
        return Ok(());
    }
    let failure = Failure::new(Exit::Content, format!("`{path}` is a shader, not a scene"));
    Err(failure.help(format!("`glisten new-scene {path} -o scene.toml` writes a scene that draws it")))
}

/// A failure from the message of a runner, whose second line is the help text.
pub(crate) fn told(exit: Exit, text: &str) -> Failure {
    match text.split_once("\nhelp: ") {
        Some((message, help)) => Failure::new(exit, message).help(help),
        None => Failure::new(exit, text),
    }
}

/// The GPU with that name, or the first one.
pub(crate) fn open_gpu(name: Option<&str>) -> Result<Gpu, Error> {
    let _work = journal::at_work("listing the adapters");
    let gpu = Gpu::new(name).inspect_err(|error| {
        // wgpu's words; where `--max-memory` is why, that is told.
        if error.to_string().contains("Not enough memory") {
            memory::exhausted();
        }
    })?;
    journal::note(&Note::Driver(gpu.adapter().driver.clone()));
    Ok(gpu)
}

impl SceneArgs {
    /// The arguments for one scene of several.
    pub(crate) fn of(scene: &str, machine: &MachineArgs, sources: &SourceArgs, levels: &LevelArgs) -> Self {
        Self { scene: scene.to_owned(), machine: machine.clone(), sources: sources.clone(), levels: levels.clone() }
    }

    /// The same arguments for another scene.
    pub(crate) fn at(&self, scene: &str) -> Self {
        Self { scene: scene.to_owned(), ..self.clone() }
    }

    /// A session that compiles as the arguments say.
    pub(crate) fn session<'a>(&self, console: &'a Console) -> Result<Session<'a>, Failure> {
        Session::new(console, &self.sources, &BindingArgs::default(), &self.levels, 0)
    }

    /// Reads the scene and reports its diagnostics. Without a scene, returns the exit code.
    pub(crate) fn read<'a>(&self, console: &'a Console) -> Result<Result<Read<'a>, Exit>, Failure> {
        // A model of many triangles takes as long as a picture.
        let _watchdog = self.watchdog(console);
        let mut session = self.session(console)?;
        refuse_shader(&self.scene)?;
        let loaded = guard::guarded(|| scene::load(&self.scene, &SceneFiles, session.compiler()));
        let loaded = loaded.map_err(|panic| {
            Failure::new(Exit::Content, format!("internal error: {panic}")).help("please report it with the scene")
        })?;
        let mut batch = Batch { sources: loaded.sources, diagnostics: Vec::new() };
        session.read_configuration(&self.scene);
        session.add(&mut batch, loaded.diagnostics);
        let exit = session.exit(&batch);
        let scene = loaded.scene.filter(|_| exit == Exit::Ok);
        session.tell(&[&batch], false)?;
        batch.diagnostics.clear();
        Ok(match scene {
            Some(scene) => Ok(Read { scene, session, batch }),
            None => {
                let exit = if loaded.io_error { exit.max(Exit::Usage) } else { exit };
                Err(exit.max(Exit::Content))
            }
        })
    }

    /// See [`MachineArgs::gpu`].
    pub(crate) fn gpu(&self) -> Result<Gpu, DrawError> {
        self.machine.gpu()
    }

    /// See [`MachineArgs::long_limit`].
    pub(crate) fn long_limit(&self) -> Duration {
        self.machine.long_limit()
    }

    /// See [`MachineArgs::watchdog`].
    pub(crate) fn watchdog(&self, console: &Console) -> Watchdog {
        self.machine.watchdog(console)
    }

    /// See [`MachineArgs::within_time`].
    pub(crate) fn within_time<R: Send + 'static>(
        &self,
        work: impl FnOnce() -> Result<R, DrawError> + Send + 'static,
    ) -> Result<R, DrawError> {
        self.machine.within_time(work)
    }
}

impl MachineArgs {
    /// The GPU that the arguments name.
    pub(crate) fn gpu(&self) -> Result<Gpu, DrawError> {
        let gpu = open_gpu(self.adapter.as_deref())?;
        Ok(gpu.with_timeout(self.time_limit()))
    }

    /// The name of the GPU that the arguments name.
    pub(crate) fn adapter(&self) -> Option<&str> {
        self.adapter.as_deref()
    }

    /// The time limit for a scene.
    pub(crate) fn time_limit(&self) -> Duration {
        Duration::from_secs_f64(self.timeout.unwrap_or(SECONDS))
    }

    /// The time limit for a scene that is drawn many times.
    pub(crate) fn long_limit(&self) -> Duration {
        Duration::from_secs_f64(self.timeout.unwrap_or(MANY_SECONDS))
    }

    /// Ends the program when the time limit is reached before the value is dropped: for work that borrows.
    pub(crate) fn watchdog(&self, console: &Console) -> Watchdog {
        Watchdog::new(self.long_limit(), console)
    }

    /// Runs work on a thread of its own and gives up when the time limit is reached.
    pub(crate) fn within_time<R: Send + 'static>(
        &self,
        work: impl FnOnce() -> Result<R, DrawError> + Send + 'static,
    ) -> Result<R, DrawError> {
        let (sender, receiver) = mpsc::channel();
        let job = move || {
            // After the time limit, nothing receives this.
            let _ = sender.send(guard::guarded(work));
        };
        std::thread::Builder::new().stack_size(STACK_BYTES).spawn(job).map_err(|error| {
            memory::exhausted();
            Failure::new(Exit::Machine, format!("the system gives no thread: {error}"))
        })?;
        match receiver.recv_timeout(self.time_limit()) {
            Ok(Ok(result)) => result,
            Ok(Err(panic)) => {
                let failure = Failure::new(Exit::Content, format!("internal error: {panic}"));
                Err(failure.help("this is a fault of glisten; please report it with the scene").into())
            }
            Err(RecvTimeoutError::Timeout) => {
                let (message, help) = watchdog::sentence(self.time_limit());
                Err(Failure::new(Exit::Content, message).help(help).into())
            }
            Err(RecvTimeoutError::Disconnected) => Err(Failure::new(Exit::Content, "internal error").into()),
        }
    }
}
