//! `glisten trace`: tells what each fragment of a pixel, or a vertex, computed: every expression with its value.

use crate::arguments::args::ResultFormat;
use crate::commands::examples::Examples;
use crate::console::Console;
use crate::exit::{Failure, Outcome};
use crate::progress::Progress;
use crate::scenes::{DrawError, SceneArgs};
use clap::{ArgGroup, Args};
use glisten_reference::trace::{Place, trace};
use glisten_verify::trace::{Shown, lines, told};

/// Examples of its use.
pub(crate) const EXAMPLES: Examples = &[
    ("glisten trace scene.toml --pixel 120,80", "what each fragment of the pixel computed, line by line"),
    ("glisten trace scene.toml --vertex 3 --format json", "a vertex, for scripts"),
];

/// Tell what each fragment of a pixel, or a vertex, computed: every expression with its value
#[derive(Args, Debug)]
#[command(group(ArgGroup::new("place").required(true).args(["pixel", "vertex"])))]
pub(crate) struct TraceArgs {
    /// Follow the fragments of this pixel: column from the left, row from the top
    #[arg(long, value_name = "X,Y", value_parser = parse_pixel)]
    pixel: Option<[u32; 2]>,
    /// Follow this vertex
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    vertex: Option<u32>,
    /// The draw of the vertex
    #[arg(long, value_name = "N", default_value_t = 0, requires = "vertex", conflicts_with = "pixel")]
    draw: usize,
    /// The instance of the vertex
    #[arg(long, value_name = "N", default_value_t = 0, requires = "vertex", conflicts_with = "pixel")]
    instance: u32,
    /// Show variables that are only read, the insides of the library's functions, and what a conforming GPU may have of each
    /// value
    #[arg(long)]
    all: bool,
    /// The format of the result
    #[arg(long, value_enum, default_value_t)]
    format: ResultFormat,
    #[command(flatten)]
    scene: SceneArgs,
}

fn parse_pixel(text: &str) -> Result<[u32; 2], String> {
    let parsed = text.split_once(',').and_then(|(x, y)| Some([x.trim().parse().ok()?, y.trim().parse().ok()?]));
    parsed.ok_or_else(|| format!("`{text}` is not a column and a row, such as `120,80`"))
}

/// Runs the command.
pub(crate) fn run(args: &TraceArgs, console: &Console) -> Outcome {
    let place = match (args.pixel, args.vertex) {
        (Some(pixel), _) => Place::Pixel(pixel),
        (None, Some(vertex)) => Place::Vertex { draw: args.draw, vertex, instance: args.instance },
        (None, None) => return Err(Failure::usage("`--pixel` or `--vertex` says what to follow")),
    };
    let read = match args.scene.read(console)? {
        Ok(read) => read,
        Err(exit) => return Ok(exit),
    };
    let progress = Progress::new(console, 1).unless(args.format == ResultFormat::Json);
    progress.say("following");
    let scene = read.scene.clone();
    let followed = args.scene.within_time(move || trace(&scene, place).map_err(DrawError::from));
    drop(progress);
    let followed = match followed {
        Ok(followed) => followed,
        Err(error) => return read.failed(error),
    };
    let told = told(&args.scene.scene, &read.scene, read.sources(), place, &followed);
    match args.format {
        ResultFormat::Human => console.output(&lines(&told, Shown { all: args.all }))?,
        ResultFormat::Json => {
            let json = serde_json::to_string_pretty(&told).expect("names and numbers are always JSON");
            console.output(&(json + "\n"))?;
        }
    }
    read.finish(Vec::new())
}
