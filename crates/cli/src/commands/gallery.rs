//! `glisten gallery`: draws every scene of the library onto one page.

use crate::arguments::args::WithContractArgs;
use crate::commands::examples::Examples;
use crate::commands::render::Backend;
use crate::console::Console;
use crate::exit::{Exit, Failure, Outcome};
use crate::files;
use crate::made::made;
use crate::opengl;
use crate::process::journal;
use crate::progress::Progress;
use crate::scenes::{DrawError, MachineArgs, ViaArg};
use clap::Args;
use glisten_front::source::SourceMap;
use glisten_gpu::{Gpu, Via};
use glisten_reference::{LineRule, Precision, RenderOptions};
use glisten_report::gallery::{self, Difference, Drawing, Entry, Tile};
use glisten_scene::picture::Picture;
use glisten_verify::specialize::specialize_scene_by;
use glisten_verify::verify::as_compiled;
use rayon::prelude::*;
use std::path::PathBuf;

/// The number of columns of the contact sheet.
const COLUMNS: u32 = 7;
/// The width of a picture on the contact sheet, in pixels, and the gap between two.
const SIDE: u32 = 156;
const GAP: u32 = 4;
/// The largest size of a picture, in pixels.
const MAX_SIZE: i64 = 2048;

/// Examples of its use.
pub(crate) const EXAMPLES: Examples = &[("glisten gallery -o out", "a page with the pictures of the library's scenes")];

/// Draw every scene of the library onto a page
#[derive(Args, Debug)]
pub(crate) struct GalleryArgs {
    /// The folder for index.html, a picture of each scene, and gallery.png with all pictures
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// The backend
    #[arg(long, value_enum, default_value_t)]
    backend: Backend,
    /// The form of the code that the GPU runs
    #[arg(long, value_enum, default_value_t)]
    via: ViaArg,
    /// Draw with programs of which nothing is left but what each picture needs
    #[arg(long)]
    specialize: bool,
    #[command(flatten)]
    contract: WithContractArgs,
    /// The width of the pictures in pixels; the page shows them at half of 640, for sharp screens
    #[arg(long, value_name = "PIXELS", default_value_t = 640, value_parser = clap::value_parser!(u32).range(8..=MAX_SIZE))]
    size: u32,
    #[command(flatten)]
    machine: MachineArgs,
}

impl GalleryArgs {
    /// Whether a driver draws.
    pub(crate) fn draws_by_a_driver(&self) -> bool {
        self.backend.is_a_driver()
    }
}

/// A backend that is ready to draw.
enum GalleryBackend {
    Gpu(Box<Gpu>, Via),
    Cpu,
    OpenGl,
}

/// Runs the command.
pub(crate) fn run(args: &GalleryArgs, console: &Console) -> Outcome {
    args.backend.require()?;
    let entries = gallery::entries().map_err(internal)?;
    let backend = match args.backend {
        Backend::Gpu => GalleryBackend::Gpu(Box::new(args.machine.gpu().map_err(failure)?), args.via.into()),
        Backend::Cpu => GalleryBackend::Cpu,
        Backend::Gl => GalleryBackend::OpenGl,
    };
    files::make_folder(&args.output)?;
    let progress = Progress::new(console, entries.len());
    let mut drawings = Vec::with_capacity(entries.len());
    for entry in &entries {
        progress.say(entry.name);
        drawings.push(backend.drawing(args, &entries, entry)?);
        progress.step();
    }
    drop(progress);
    let page = gallery::page(&entries, &drawings, &backend.name(), &made()).map_err(internal)?;
    let pictures = entries.iter().zip(&drawings).flat_map(|(entry, drawing)| {
        let difference = drawing.difference.as_ref().map(|difference| (entry.difference_name(), &difference.tile));
        std::iter::once((entry.file_name(), &drawing.tile)).chain(difference)
    });
    let pictures: Vec<(String, &Tile)> = pictures.collect();
    // Packing takes long, and each picture is for itself.
    let packed: Vec<Result<Vec<u8>, String>> = pictures.par_iter().map(|(_, tile)| tile.png()).collect();
    for ((name, _), bytes) in pictures.iter().zip(packed) {
        files::write(&args.output.join(name), &bytes.map_err(internal)?)?;
    }
    let tiles: Vec<&Tile> = drawings.iter().map(|drawing| &drawing.tile).collect();
    let sheet = gallery::contact_sheet(&tiles, COLUMNS, SIDE, GAP).png().map_err(internal)?;
    files::write(&args.output.join(gallery::SHEET), &sheet)?;
    // Last, so that a page always refers to pictures that exist.
    let path = args.output.join(gallery::PAGE);
    files::write(&path, page.as_bytes())?;
    console.remark(&format!("wrote {}", path.display()));
    Ok(Exit::Ok)
}

impl GalleryBackend {
    /// The parts of an entry on the page: its picture, and its difference to another's.
    fn drawing(&self, args: &GalleryArgs, entries: &[Entry], entry: &Entry) -> Result<Drawing, Failure> {
        let picture = self.draw(args, entry)?;
        let other = entry.compared_with().and_then(|name| entries.iter().find(|known| known.name == name));
        let difference = match other {
            Some(other) => Difference::new(&picture, &self.draw(args, other)?),
            None => None,
        };
        Ok(Drawing { tile: Tile::new(&picture, entry.scene().framebuffer.encode), difference })
    }

    fn draw(&self, args: &GalleryArgs, entry: &Entry) -> Result<Picture, Failure> {
        let scene = entry.supersampled(args.size);
        let scene = match args.contract.contract() {
            _ if !args.specialize => scene,
            contract => specialize_scene_by(contract, &scene, &SourceMap::default(), &[]).scene,
        };
        let _work = matches!(self, Self::Gpu(..)).then(|| journal::at_work(&journal::drawing(entry.name)));
        let picture = match self {
            Self::Gpu(gpu, via) => as_compiled(&scene)
                .map_err(DrawError::from)
                .and_then(|scene| gpu.render(&scene, *via).map(|rendered| rendered.picture).map_err(DrawError::from)),
            Self::Cpu => {
                let options =
                    RenderOptions { precision: Precision::F64, lines: LineRule::OpenGl, ..RenderOptions::default() };
                args.machine.within_time(move || Ok(glisten_reference::render(&scene, &options)?))
            }
            Self::OpenGl => opengl::draw(&args.machine, entry.name, scene),
        };
        picture.map_err(failure)
    }

    fn name(&self) -> String {
        match self {
            Self::Gpu(gpu, via) => format!(
                "{} from emitted {}",
                gpu.adapter().name,
                match via {
                    Via::Spirv => "SPIR-V",
                    Via::Wgsl => "WGSL",
                }
            ),
            Self::Cpu => "glisten's CPU reference in 64-bit floating point".to_owned(),
            Self::OpenGl => "OpenGL from the sources themselves".to_owned(),
        }
    }
}

/// A failure as one sentence: the library's own shaders have no diagnostics to show.
fn failure(error: DrawError) -> Failure {
    match error {
        DrawError::Failure(failure) => failure,
        DrawError::Diagnostics(diagnostics) => {
            internal(diagnostics.into_iter().next().map_or_else(String::new, |first| first.message))
        }
    }
}

fn internal(message: String) -> Failure {
    let failure = Failure::new(Exit::Content, format!("internal error: {message}"));
    failure.help("this is a fault of glisten; please report it")
}
