//! `glisten render`: draws a scene to a picture on the GPU, with the CPU reference or by OpenGL.

use crate::arguments::args::WithContractArgs;
use crate::commands::examples::Examples;
use crate::console::Console;
use crate::exit::{Failure, Outcome};
use crate::files;
use crate::opengl;
use crate::optimize::OptimizeArgs;
use crate::pictures::Target;
use crate::process::journal;
use crate::progress::Progress;
use crate::scenes::{DrawError, SceneArgs, ViaArg};
use crate::with::WithArgs;
use clap::{Args, ValueEnum};
use glisten_front::diagnostic::codes::scenes::NAN_IN_PNG;
use glisten_gpu::Via;
use glisten_reference::{LineRule, Precision, RenderOptions};
use glisten_scene::picture::Picture;
use glisten_verify::scene::Scene;
use glisten_verify::verify::{OnGpu, Runner};
use std::path::PathBuf;

/// Examples of its use.
pub(crate) const EXAMPLES: Examples = &[
    ("glisten render scene.toml -o picture.png", "on the GPU"),
    ("glisten render scene.toml -o picture.npy --backend cpu", "by the reference in f64"),
];

/// Draw a scene
#[derive(Args, Debug)]
pub(crate) struct RenderArgs {
    /// The picture: .npy (float32), .png (8 bits) or .exr (float32); `%d` in the name counts attachments
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,
    /// The backend
    #[arg(long, value_enum, default_value_t)]
    backend: Backend,
    /// The precision of the CPU reference (default: f64)
    #[arg(long, value_enum)]
    precision: Option<PrecisionArg>,
    /// The form of the code that the GPU runs (default: spirv; with --with, that of the module)
    #[arg(long, value_enum)]
    via: Option<ViaArg>,
    #[command(flatten)]
    with: WithArgs,
    /// Draw with programs of which nothing is left but what the picture needs
    #[arg(long)]
    specialize: bool,
    #[command(flatten)]
    contract: WithContractArgs,
    #[command(flatten)]
    scene: SceneArgs,
    #[command(flatten)]
    optimize: OptimizeArgs,
}

/// The backend that draws a scene.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum Backend {
    /// Vulkan through wgpu
    #[default]
    Gpu,
    /// The CPU reference
    Cpu,
    /// OpenGL through EGL, from the original sources; only if built with `--features gl`
    Gl,
}

impl RenderArgs {
    /// Whether a driver draws.
    pub(crate) fn draws_by_a_driver(&self) -> bool {
        self.backend.is_a_driver()
    }

    /// Says which options have no effect. A script may give them for each backend in turn.
    fn tell_idle(&self, console: &Console) {
        if self.precision.is_some() && self.backend != Backend::Cpu {
            console.remark("note: `--precision` has no effect here: it is for `--backend cpu`");
        }
        if self.via.is_some() && self.backend != Backend::Gpu {
            console.remark("note: `--via` has no effect here: it is for `--backend gpu`");
        }
    }
}

impl Backend {
    /// Whether it hands code to a driver.
    pub(crate) fn is_a_driver(self) -> bool {
        self != Self::Cpu
    }

    /// Reports an error if the backend is not built in.
    pub(crate) fn require(self) -> Result<(), Failure> {
        match self {
            Self::Gpu | Self::Cpu => Ok(()),
            Self::Gl => opengl::require(),
        }
    }
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
enum PrecisionArg {
    /// Double precision
    #[default]
    F64,
    /// Single precision, with one rounding per operation
    F32,
}

/// Runs the command.
pub(crate) fn run(args: &RenderArgs, console: &Console) -> Outcome {
    args.backend.require()?;
    args.tell_idle(console);
    let target = Target::parse(&args.output)?;
    let read = match args.scene.read(console)? {
        Ok(read) => read,
        Err(exit) => return Ok(exit),
    };
    target.check(read.scene.framebuffer.format)?;
    files::check_writable(&args.output)?;
    let progress = Progress::new(console, 1);
    progress.say("drawing");
    let scene = if args.specialize { read.specialized(args.contract.contract()) } else { read.scene.clone() };
    let Drawing { picture, drawn_by } = match draw(args, scene) {
        Ok(drawing) => drawing,
        Err(error) => return read.failed(error),
    };
    drop(progress);
    if let Some(adapter) = drawn_by {
        console.remark(&format!("drawn by {adapter}{}", read.host_part()));
    }
    let (files, nans) = target.encode(&picture, read.scene.framebuffer.encode)?;
    for (path, bytes) in files {
        files::write(&path, &bytes)?;
    }
    let is_empty = !read.scene.draws.is_empty() && !picture.covered.contains(&true);
    let mut found = Vec::new();
    if is_empty {
        found.push(read.nothing_covered());
    }
    if nans > 0 {
        let message = format!("{nans} numbers are NaN, and are 0 in the PNG");
        found.push(read.at_draw(&NAN_IN_PNG, message).help("a `.npy` or a `.exr` keeps them"));
    }
    read.finish(found)
}

/// A picture, and the adapter and driver that drew it, if it was a GPU.
struct Drawing {
    picture: Picture,
    drawn_by: Option<String>,
}

impl From<Picture> for Drawing {
    fn from(picture: Picture) -> Self {
        Self { picture, drawn_by: None }
    }
}

fn draw(args: &RenderArgs, scene: Scene) -> Result<Drawing, DrawError> {
    let via = args.with.vias(&[args.via.unwrap_or_default().into()], args.via.is_some())?;
    let via = via.first().copied().unwrap_or(Via::Spirv);
    let foreign = args.with.read(&scene, &[via])?;
    if !foreign.is_empty() && args.backend != Backend::Gpu {
        return Err(Failure::usage("--with replaces what the GPU runs, and --backend asks for another one").into());
    }
    match args.backend {
        Backend::Gpu => {
            let gpu = args.scene.gpu()?;
            let drawn_by = Some(gpu.adapter().to_string());
            let work = journal::drawing(&args.scene.scene);
            let whole = args.optimize.leaves_whole();
            let picture = args.scene.within_time(move || {
                let _work = journal::at_work(&work);
                Ok(OnGpu::new(&gpu, via).with(&foreign).whole(whole).draw(&scene)?.picture)
            })?;
            Ok(Drawing { picture, drawn_by })
        }
        Backend::Cpu => {
            let precision = match args.precision.unwrap_or_default() {
                PrecisionArg::F64 => Precision::F64,
                PrecisionArg::F32 => Precision::F32,
            };
            let options =
                RenderOptions { precision, lines: LineRule::OpenGl, mark_edges: false, ..RenderOptions::default() };
            Ok(args.scene.within_time(move || Ok(glisten_reference::render(&scene, &options)?))?.into())
        }
        Backend::Gl => Ok(opengl::draw(&args.scene.machine, &args.scene.scene, scene)?.into()),
    }
}
