//! `glisten verify`: draws a scene on the GPU and with the CPU reference, and judges each pixel.

mod folder;
mod timed;
mod told;

use crate::arguments::args::WithContractArgs;
use crate::arguments::profile::ProfileChoice;
use crate::commands::examples::Examples;
use crate::commands::verify::timed::{TimedGpu, TimedReference};
use crate::console::Console;
use crate::exit::{Exit, Failure, Outcome};
use crate::files;
use crate::inputs;
use crate::optimize::OptimizeArgs;
use crate::overwrite;
use crate::pictures::Target;
use crate::progress::Progress;
use crate::scenes::{DrawError, Read, SceneArgs};
use crate::with::WithArgs;
use clap::{Args, ValueEnum};
use glisten_front::diagnostic::write;
use glisten_front::source::SourceMap;
use glisten_gpu::{AdapterFacts, Foreign, Via};
use glisten_scene::compare::{Criterion, Verdict, flip};
use glisten_scene::picture::{Picture, Transfer};
use glisten_verify::scene::Scene;
use glisten_verify::verify::{self, Conclusion, Demands, Options, Runner, UndefinedAt, Verification, Weakness, verify};
use rayon::prelude::*;
use serde::Serialize;
use std::path::PathBuf;
use std::sync::Arc;

/// Examples of its use.
pub(crate) const EXAMPLES: Examples = &[
    ("glisten verify scene.toml", "the GPU's picture against the reference"),
    ("glisten verify scene.toml --difference off.png", "with a picture of the differences"),
    ("glisten verify scene.toml --evidence seen.png", "with a picture of how much was judged"),
    ("glisten verify scene.toml --with fragment=a.spv", "the code of another translator"),
];

/// Draw a scene, or all scenes of a folder, on the GPU and the CPU, and compare the pictures
#[derive(Args, Debug)]
pub(crate) struct VerifyArgs {
    /// The form of the code that the GPU runs (default: both; with --with, those of the modules)
    #[arg(long, value_enum)]
    via: Option<ViaChoice>,
    #[command(flatten)]
    with: WithArgs,
    /// The format of the figures; of a folder, `junit` and `github` are for continuous integration
    #[arg(long, value_enum, default_value_t)]
    format: VerifyFormat,
    /// Judge by this absolute difference per channel instead of the derived envelope
    #[arg(long, value_name = "X", value_parser = parse_tolerance, allow_negative_numbers = true)]
    tolerance: Option<f64>,
    /// Count pixels that the reference cannot decide as judged
    #[arg(long)]
    allow_undecided: bool,
    /// Accept a picture of which too little can be judged, such as one in which no pixel is covered
    #[arg(long)]
    allow_inconclusive: bool,
    /// The devices whose freedom the envelope allows
    #[arg(long, value_enum, default_value_t, conflicts_with = "tolerance")]
    profile: ProfileChoice,
    /// The share of the covered pixels that must be judged, at an edge, or excused; with less, the picture is inconclusive
    #[arg(long, value_name = "X", default_value_t = 0.95, value_parser = parse_share)]
    evidence_share: f64,
    /// The largest width of the envelope of a judged pixel (default: 1/255 of the range of the picture's values)
    #[arg(long, value_name = "X", value_parser = parse_width)]
    width: Option<f64>,
    /// Fail for pixels far outside of what a population of simulated GPUs draws (the default)
    #[arg(long, overrides_with = "no_likely")]
    likely: bool,
    /// Judge by the envelope alone, without simulated GPUs
    #[arg(long)]
    no_likely: bool,
    /// By how many of its widths the hull of what simulated GPUs drew is widened, where envelopes are too wide to judge by
    #[arg(long, value_name = "X", default_value_t = 4.0, value_parser = parse_margin, conflicts_with = "no_likely")]
    likely_margin: f64,
    /// On llvmpipe, judge by what is known of its arithmetic where nothing else judges: noise of `fract(sin(x) * 43758.5)`
    #[arg(long)]
    as_device: bool,
    /// Judge every pixel, however long that takes. Otherwise blocks of pixels stand for a picture whose loops take long
    #[arg(long)]
    whole: bool,
    /// Excuse no pixel because of known faults of the driver
    #[arg(long)]
    no_known_faults: bool,
    /// Let the GPU draw with programs of which nothing is left but what the picture needs, and judge it by the original
    #[arg(long)]
    specialize: bool,
    #[command(flatten)]
    contract: WithContractArgs,
    /// Write a picture of |difference| / bound on black: blue up to the bound, yellow to red beyond
    #[arg(long, value_name = "FILE")]
    difference: Option<PathBuf>,
    /// Write a picture of what was judged: green, blue at edges, yellow where the envelope is wide, red where it is unlimited
    #[arg(long, value_name = "FILE")]
    evidence: Option<PathBuf>,
    #[command(flatten)]
    scene: SceneArgs,
    #[command(flatten)]
    optimize: OptimizeArgs,
}

/// The format of the result.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
enum VerifyFormat {
    /// Text for people
    #[default]
    #[value(alias = "table")]
    Human,
    /// JSON; of a folder, an array
    Json,
    /// Annotations of GitHub's Actions, for scenes that do not hold
    Github,
    /// JUnit's XML: a test for each scene
    Junit,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
enum ViaChoice {
    /// SPIR-V, passed to the driver unchanged
    Spirv,
    /// WGSL, parsed by wgpu
    Wgsl,
    /// Both, one after the other
    #[default]
    Both,
}

fn parse_tolerance(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(tolerance) if tolerance >= 0.0 => Ok(tolerance),
        _ => Err(format!("`{text}` is not a tolerance")),
    }
}

fn parse_width(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(width) if width >= 0.0 => Ok(width),
        _ => Err(format!("`{text}` is not a width")),
    }
}

fn parse_margin(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(margin) if margin >= 0.0 && margin.is_finite() => Ok(margin),
        _ => Err(format!("`{text}` is not a margin: a number of widths, 0 or more")),
    }
}

fn parse_share(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(share) if (0.0..=1.0).contains(&share) => Ok(share),
        _ => Err(format!("`{text}` is not a share from 0 to 1")),
    }
}

/// The comparison for one form of the code.
#[derive(Clone, Debug, Serialize)]
struct Run {
    /// `spirv`, `wgsl`, or `both` for the worse of the two.
    via: &'static str,
    #[serde(flatten)]
    verdict: Verdict,
    /// Mean FLIP error, 0 to 1.
    flip: f64,
    /// The number of pixels that differ, bit by bit, from the reference rounded to f32.
    bit_unequal: u64,
    /// The GPU time in ms.
    gpu_ms: f64,
    /// The wall time of the reference in ms.
    cpu_ms: f64,
}

/// A form that cannot represent the program.
#[derive(Clone, Debug, Serialize)]
struct Skip {
    via: &'static str,
    /// The reason: what the target lacks, with a way out.
    reason: String,
}

impl Skip {
    fn new(skip: &verify::Skip) -> Self {
        let reasons: Vec<&str> = skip.diagnostics.iter().map(|diagnostic| diagnostic.message.as_str()).collect();
        Self { via: skip.runner, reason: reasons.join("; ") }
    }
}

impl Run {
    /// All runs of a verification. What costs much is done once for equal pictures.
    fn all(verification: &Verification) -> Vec<Self> {
        let pictures: Vec<&Picture> = verification.runs.iter().map(|run| &run.picture).collect();
        let flip = |(place, picture): (usize, &&Picture)| {
            let is_known = pictures.iter().take(place).any(|earlier| earlier.has_bits_of(picture));
            // A mean over what is judged: the rest has no difference.
            (!is_known).then(|| {
                let mean = flip(&verification.reference, &verification.judged(picture));
                (mean / verification.share.max(f64::MIN_POSITIVE)).min(1.0)
            })
        };
        let flips: Vec<Option<f64>> = pictures.par_iter().enumerate().map(flip).collect();
        let of = |run: &verify::Run| {
            let first = pictures.iter().position(|picture| picture.has_bits_of(&run.picture));
            first.and_then(|first| flips.get(first).copied().flatten()).unwrap_or(f64::NAN)
        };
        verification.runs.iter().map(|run| Self::new(run, of(run), verification)).collect()
    }

    fn new(run: &verify::Run, flip: f64, verification: &Verification) -> Self {
        let reference = &verification.reference;
        Self {
            via: run.runner,
            verdict: run.verdict.clone(),
            flip,
            bit_unequal: verification.judged(&run.picture).bit_unequal(reference),
            gpu_ms: run.milliseconds,
            cpu_ms: verification.reference_milliseconds,
        }
    }
}

/// The JSON output: the worse of all runs, and each of them.
#[derive(Serialize)]
struct Report<'a> {
    #[serde(flatten)]
    worse: &'a Run,
    runs: &'a [Run],
    /// The forms that `both` skipped because the target cannot represent the program.
    skipped: &'a [Skip],
    /// The number of pixels at which SPIR-V and WGSL drew different bits; null if only one of them ran.
    forms_bit_unequal: Option<u64>,
    verdict: Conclusion,
    holds: bool,
    /// The share of the covered pixels that is judged, at an edge, or excused.
    evidence_share: f64,
    /// The share of the picture that was judged: 1, unless blocks of pixels stand for it.
    share: f64,
    /// Why too little was judged; null unless the verdict is inconclusive for that reason.
    weakness: Option<&'a Weakness>,
    /// The places in the picture that the language leaves undefined.
    undefined: &'a [UndefinedAt],
    /// The seed of the population of simulated GPUs; null if none was drawn.
    population_seed: Option<u64>,
    /// The adapter that drew, and its driver.
    adapter: &'a str,
    driver: &'a str,
}

/// A scene that was drawn and judged.
struct Judged {
    verification: Verification,
    runs: Vec<Run>,
    /// The output of `--format json`.
    report: String,
}

/// Runs the command.
pub(crate) fn run(args: &VerifyArgs, console: &Console) -> Outcome {
    let name = &args.scene.scene;
    let is_folder = std::path::Path::new(name).is_dir();
    if is_folder && (args.difference.is_some() || args.evidence.is_some()) {
        return Err(Failure::usage("--difference and --evidence are pictures of one scene, and this is a folder"));
    }
    overwrite::refuse_equal(args.difference.iter().chain(&args.evidence).map(PathBuf::as_path))?;
    if is_folder || matches!(args.format, VerifyFormat::Github | VerifyFormat::Junit) {
        let scenes = inputs::scene_files(std::slice::from_ref(name))?;
        return folder::run(args, &scenes, console);
    }
    let (exit, judged) = examine(args, &args.scene, console)?;
    if let Some(judged) = judged.filter(|_| args.format == VerifyFormat::Json) {
        console.output(&judged.report)?;
    }
    Ok(exit)
}

/// From this share of a bound on, the bound is 0, and the share is one of the least number instead.
const MOST_SHARE: f64 = 1e290;

/// Draws a scene and judges it. Of one scene, the text for people is printed; a scene that is not drawn is reported.
fn examine(args: &VerifyArgs, of: &SceneArgs, console: &Console) -> Result<(Exit, Option<Judged>), Failure> {
    let is_alone = of.scene == args.scene.scene && args.format == VerifyFormat::Human;
    let read = match of.read(console)? {
        Ok(read) => read,
        Err(exit) => return Ok((exit, None)),
    };
    let wanted = match args.via.unwrap_or_default() {
        ViaChoice::Spirv => vec![Via::Spirv],
        ViaChoice::Wgsl => vec![Via::Wgsl],
        ViaChoice::Both => vec![Via::Spirv, Via::Wgsl],
    };
    let vias = args.with.vias(&wanted, args.via.is_some())?;
    let foreign: Arc<[Foreign]> = args.with.read(&read.scene, &vias)?.into();
    let [difference, evidence] =
        [&args.difference, &args.evidence].map(|file| file.as_deref().map(Target::parse).transpose());
    let (difference, evidence) = (difference?, evidence?);
    let progress = Progress::new(console, vias.len() + 1).unless(args.format == VerifyFormat::Json);
    let drawn = args.specialize.then(|| read.specialized(args.contract.contract()));
    let scenes = (&read.scene, drawn.as_ref());
    let (verification, facts) = match compare((args, of), scenes, read.sources(), (&vias, &foreign), &progress) {
        Ok(compared) => compared,
        Err(error) => return Ok((read.failed(error)?, None)),
    };
    drop(progress);
    if let Some(target) = difference {
        let most = verification.shares.iter().fold(0.0, |most: f64, share| most.max(*share));
        let most = match most {
            most if most < MOST_SHARE => format!("at most {most:.2} of the bound; "),
            most if most.is_finite() => "beyond a bound of 0; ".to_owned(),
            _ => String::new(),
        };
        write_map(console, &target, &verification.difference(), &format!("{most}{}", verify::DIFFERENCE_LEGEND))?;
    }
    if let Some(target) = evidence {
        write_map(console, &target, &verification.evidence(), verify::EVIDENCE_LEGEND)?;
    }
    let runs = Run::all(&verification);
    let skipped: Vec<Skip> = verification.skipped.iter().map(Skip::new).collect();
    let Some(worse) = worst_of(&runs) else { return Ok((Exit::Ok, None)) };
    let forms_bit_unequal = match &verification.runs[..] {
        [spirv, wgsl] => Some(spirv.picture.bit_unequal(&wgsl.picture)),
        _ => None,
    };
    let holds = verification.holds();
    if is_alone {
        let text = human(&verification, &runs, (&skipped, forms_bit_unequal), (&read, console));
        console.remark(&format!("drawn by {facts}{}", read.host_part()));
        console.output(&text)?;
    }
    let report = Report {
        worse: &worse,
        runs: &runs,
        skipped: &skipped,
        forms_bit_unequal,
        verdict: verification.conclusion(),
        holds,
        evidence_share: worse.verdict.share_judged(&verification.demands),
        share: verification.share,
        weakness: verification.weakness.as_ref(),
        undefined: &verification.undefined,
        population_seed: verification.demands.likely.then_some(verify::POPULATION_SEED),
        adapter: &facts.name,
        driver: &facts.driver,
    };
    let report = serde_json::to_string_pretty(&report).expect("figures are always JSON") + "\n";
    let exit = if holds { Exit::Ok } else { Exit::Content };
    Ok((read.finish(Vec::new())?.max(exit), Some(Judged { verification, runs, report })))
}

/// The text for people, with excerpts.
fn human(
    verification: &Verification,
    runs: &[Run],
    (skipped, forms_bit_unequal): (&[Skip], Option<u64>),
    (read, console): (&Read<'_>, &Console),
) -> String {
    let mut text = told::told(verification, runs, skipped, forms_bit_unequal);
    let notes = [
        verification.note.as_ref().filter(|_| verification.fails()),
        verification.weakness.as_ref().and_then(|w| w.note.as_ref()),
    ];
    for note in notes.into_iter().flatten() {
        text.push('\n');
        text.push_str(&write::human(read.sources(), [note], console.colors_output()));
    }
    text
}

impl VerifyArgs {
    fn demands(&self) -> Demands {
        let Self { evidence_share, allow_undecided, no_likely, .. } = *self;
        Demands { evidence_share, allow_undecided, likely: !no_likely }
    }
}

/// Writes a picture of what a verification found, and tells what its colors mean.
fn write_map(console: &Console, target: &Target, picture: &Picture, legend: &str) -> Result<(), Failure> {
    let (files, _) = target.encode(picture, Transfer::Linear)?;
    for (path, bytes) in files {
        files::write(&path, &bytes)?;
        console.remark(&format!("wrote {}: {legend}", path.display()));
    }
    Ok(())
}

/// Draws a scene in the place of another.
struct Instead<'a> {
    runner: &'a dyn Runner,
    scene: Option<&'a Scene>,
}

impl Runner for Instead<'_> {
    fn name(&self) -> &'static str {
        self.runner.name()
    }

    fn draw(&self, scene: &Scene) -> Result<verify::Drawn, verify::Failure> {
        self.runner.draw(self.scene.unwrap_or(scene))
    }
}

/// Judges what runners make of a scene, or of another one in its place, by the first.
fn compare(
    (args, of): (&VerifyArgs, &SceneArgs),
    (scene, drawn): (&Scene, Option<&Scene>),
    sources: &SourceMap,
    (vias, foreign): (&[Via], &Arc<[Foreign]>),
    progress: &Progress,
) -> Result<(Verification, AdapterFacts), DrawError> {
    let machine = &of.machine;
    let gpu = Arc::new(of.gpu()?);
    let whole = args.optimize.leaves_whole();
    let runner = |via: &Via| TimedGpu::new(&gpu, *via, &of.scene, machine, progress).with(foreign).whole(whole);
    let runners: Vec<TimedGpu<'_>> = vias.iter().map(runner).collect();
    let runners: Vec<Instead<'_>> = runners.iter().map(|runner| Instead { runner, scene: drawn }).collect();
    let runners: Vec<&dyn Runner> = runners.iter().map(|runner| runner as &dyn Runner).collect();
    let options = Options {
        criterion: args.tolerance.map_or(Criterion::Envelope, Criterion::Tolerance),
        excuse_known_faults: !args.no_known_faults,
        demands: args.demands(),
        allow_inconclusive: args.allow_inconclusive,
        width: args.width,
        likely_margin: args.likely_margin,
        most_work: (!args.whole).then_some(verify::MOST_WORK),
        as_device: args.as_device,
        sources: Some(sources),
        profile: args.profile.of(&gpu),
        reference: &TimedReference::new(machine, progress),
        ..Options::default()
    };
    Ok((verify(scene, &runners, &options)?, gpu.adapter().clone()))
}

fn worst_of(runs: &[Run]) -> Option<Run> {
    runs.iter().cloned().reduce(|worse, run| Run {
        via: "both",
        verdict: worse.verdict.worse(&run.verdict),
        flip: worse.flip.max(run.flip),
        bit_unequal: worse.bit_unequal.max(run.bit_unequal),
        gpu_ms: worse.gpu_ms.max(run.gpu_ms),
        cpu_ms: worse.cpu_ms,
    })
}
