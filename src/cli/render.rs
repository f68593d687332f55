//! `glisten render`: draws a scene to a picture on the GPU, with the CPU reference or by OpenGL.

use super::args::WithContractArgs;
use super::console::Console;
use super::examples::Examples;
use super::exit::{Failure, Outcome};
use super::files;
use super::journal;
use super::opengl;
use super::pictures::Target;
use super::progress::Progress;
use super::scenes::{DrawError, SceneArgs, ViaArg};
use super::with::WithArgs;
use crate::scene::Scene;
use clap::{Args, ValueEnum};
use glisten_gpu::Via;
use glisten_reference::{LineRule, Precision, RenderOptions};
use glisten_scene::picture::Picture;
use std::path::PathBuf;

/// Examples of its use.
pub(super) const EXAMPLES: Examples = &[
    ("glisten render scene.toml -o picture.png", "on the GPU"),
    ("glisten render scene.toml -o picture.npy --backend cpu", "by the reference in f64"),
];

/// Draw a scene
#[derive(Args, Debug)]
pub(super) struct RenderArgs {
    /// The picture: .npy (float32), .png (8 bits) or .exr (float32); `%d` in the name counts attachments
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,
    /// The backend
    #[arg(long, value_enum, default_value_t)]
    backend: Backend,
    /// The precision of the CPU reference
    #[arg(long, value_enum, default_value_t)]
    precision: PrecisionArg,
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
}

/// The backend that draws a scene.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(super) enum Backend {
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
    pub(super) fn draws_by_a_driver(&self) -> bool {
        self.backend.is_a_driver()
    }
}

impl Backend {
    /// Whether it hands code to a driver.
    pub(super) fn is_a_driver(self) -> bool {
        self != Self::Cpu
    }

    /// Reports an error if the backend is not built in.
    pub(super) fn require(self) -> Result<(), Failure> {
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
pub(super) fn run(args: &RenderArgs, console: &Console) -> Outcome {
    args.backend.require()?;
    let target = Target::parse(&args.output)?;
    let read = match args.scene.begin(console)? {
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
    if let Some(adapter) = drawn_by.filter(|_| read.is_human()) {
        console.remark(&format!("drawn by {adapter}{}", read.host_part()));
    }
    let (files, nans) = target.encode(&picture, read.scene.framebuffer.encode)?;
    if nans > 0 {
        console.remark(&format!("warning: {nans} numbers are NaN and are 0 in the PNG"));
    }
    for (path, bytes) in files {
        files::write(&path, &bytes)?;
    }
    let is_empty = !read.scene.draws.is_empty() && !picture.covered.contains(&true);
    let found = if is_empty { vec![read.nothing_covered()] } else { Vec::new() };
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
    let foreign = args.with.read(&scene)?;
    if !foreign.is_empty() && args.backend != Backend::Gpu {
        return Err(Failure::usage("--with replaces what the GPU runs, and --backend asks for another one").into());
    }
    match args.backend {
        Backend::Gpu => {
            let gpu = args.scene.gpu()?;
            let drawn_by = Some(gpu.adapter().to_string());
            let work = journal::drawing(&args.scene.scene);
            let picture = args.scene.within_time(move || {
                let _work = journal::at_work(&work);
                let scene = glisten_reference::expand(&scene)?;
                let prepared = gpu.prepare_foreign(&scene, via, &foreign, &glisten_specialize::optimize)?;
                Ok(gpu.draw(&prepared)?.picture)
            })?;
            Ok(Drawing { picture, drawn_by })
        }
        Backend::Cpu => {
            let precision = match args.precision {
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
