//! `glisten play`: a page on this machine that shows a scene with its sources, findings, translations and pictures, and draws
//! again while they change.
//!
//! ```text
//!  browser ──► http ──► server ──► access   the token, the origin, the folders
//!                         │
//!                         ├──► files        scenes, shaders; saving; what changed on disk
//!                         ├──► pages ──► lanes ──► worker, a process of its own: glisten_play, driver, variants
//!                         └──► page         HTML, with the editor
//! ```
//!
//! *In:* a folder or a scene. *Out:* the page's address on the first line of standard output, then answers; or one file
//! (`export`, `alone`). *Holds:* whatever a program or a driver does, the server lives: workers are killed when a newer job comes, when
//! the time is over, and when they crash. What the page shows is computed from the texts in the page, which count instead of
//! the files; files change only by *Save*.

mod access;
mod alone;
mod criteria;
mod driver;
mod export;
mod files;
mod http;
mod lanes;
mod page;
mod pages;
mod server;
mod variants;
mod worker;

use crate::arguments::args::{LevelArgs, SourceArgs};
use crate::commands::examples::Examples;
use crate::console::Console;
use crate::exit::{Failure, Outcome};
use crate::scenes::MachineArgs;
use clap::Args;
use glisten_sources::stages;
use std::path::{Path, PathBuf};

/// Examples of its use.
pub(crate) const EXAMPLES: Examples = &[
    ("glisten play shaders", "the scenes of a folder, in a browser; the address is printed"),
    ("glisten play scene.toml --open", "one scene, and a browser that shows it"),
    ("glisten play a.frag", "a shader, with a new scene that draws it"),
    ("glisten play --export page.html scene.toml", "a page to hand on"),
    ("glisten play shaders --export page.html --module play.wasm.gz", "a page that computes by itself"),
];

/// Show scenes in a browser, and draw them again while they change
#[derive(Args, Debug)]
#[command(mut_arg("diagnostics", |argument| argument.hide(true)))]
pub(crate) struct PlayArgs {
    /// A folder with scenes, a scene, or a shader, which gets a new scene
    #[arg(value_name = "DIR|SCENE|SHADER", default_value = ".")]
    start: String,
    /// The port of the page's address (0: any that is free)
    #[arg(long, value_name = "N", default_value_t = 0)]
    port: u16,
    /// Open the page in a browser
    #[arg(long)]
    open: bool,
    /// Write one page that shows the scene and needs no server
    #[arg(long, value_name = "FILE.html", conflicts_with_all = ["open", "port"])]
    export: Option<PathBuf>,
    /// With `--export`: the page computes by itself, by this module of `integrations/web/make page`; a folder gives all its scenes
    #[arg(long, value_name = "FILE.wasm", requires = "export")]
    module: Option<PathBuf>,
    /// Answer the jobs of a server
    #[arg(long, hide = true)]
    worker: bool,
    #[command(flatten)]
    machine: MachineArgs,
    #[command(flatten)]
    sources: SourceArgs,
    #[command(flatten)]
    levels: LevelArgs,
}

/// Runs the command.
pub(crate) fn run(args: &PlayArgs, console: &Console) -> Outcome {
    if args.worker {
        return worker::run(args, console);
    }
    if !Path::new(&args.start).exists() {
        return Err(Failure::usage(format!("`{}` does not exist", args.start)));
    }
    let is_shader = stages::by_name(Path::new(&args.start)).is_some();
    if is_shader && args.export.is_some() {
        let failure = Failure::usage(format!("`{}` is a shader, and a page shows a scene", args.start));
        return Err(failure.help(format!("`glisten new-scene {} -o scene.toml` writes one that draws it", args.start)));
    }
    match (&args.export, &args.module) {
        (Some(output), Some(module)) => alone::run(args, output, module, console),
        (Some(output), None) => export::run(args, output, console),
        (None, _) => server::run(args, console),
    }
}
