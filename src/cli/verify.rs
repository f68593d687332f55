//! `glisten verify`: draws a scene on the GPU and with the CPU reference, and judges each pixel.

use super::args::ResultFormat;
use super::args::WithContractArgs;
use super::console::Console;
use super::exit::{Exit, Outcome};
use super::files;
use super::pictures::Target;
use super::profile::ProfileChoice;
use super::progress::Progress;
use super::scenes::{DrawError, SceneArgs};
use super::timed::{TimedGpu, TimedReference};
use crate::scene::Scene;
use crate::verify::{self, Conclusion, Options, Runner, Verification, verify};
use clap::{Args, ValueEnum};
use glisten_front::diagnostic::write;
use glisten_front::source::SourceMap;
use glisten_gpu::{AdapterFacts, Via};
use glisten_scene::compare::{Criterion, Verdict, flip};
use serde::Serialize;
use std::path::PathBuf;
use std::sync::Arc;

/// Draw a scene on the GPU and the CPU, and compare the pictures
#[derive(Args, Debug)]
pub(super) struct VerifyArgs {
    #[command(flatten)]
    scene: SceneArgs,
    /// The form of the code that the GPU runs
    #[arg(long, value_enum, default_value_t)]
    via: ViaChoice,
    /// The format of the figures
    #[arg(long, value_enum, default_value_t)]
    format: ResultFormat,
    /// Judge by this absolute difference per channel instead of the derived envelope
    #[arg(long, value_name = "X", value_parser = parse_tolerance)]
    tolerance: Option<f64>,
    /// Accept any number of pixels that the reference cannot decide
    #[arg(long)]
    allow_undecided: bool,
    /// Accept a picture that shows nothing, such as one in which no pixel is covered
    #[arg(long)]
    allow_inconclusive: bool,
    /// The devices whose freedom the envelope allows
    #[arg(long, value_enum, default_value_t)]
    profile: ProfileChoice,
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
    fn new(run: &verify::Run, verification: &Verification) -> Self {
        let reference = &verification.reference;
        Self {
            via: run.runner,
            verdict: run.verdict.clone(),
            flip: flip(reference, &run.picture),
            bit_unequal: run.picture.bit_unequal(reference),
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
    /// The adapter that drew, and its driver.
    adapter: &'a str,
    driver: &'a str,
}

/// Runs the command.
pub(super) fn run(args: &VerifyArgs, console: &Console) -> Outcome {
    let read = match args.scene.begin(console)? {
        Ok(read) => read,
        Err(exit) => return Ok(exit),
    };
    let vias = match args.via {
        ViaChoice::Spirv => vec![Via::Spirv],
        ViaChoice::Wgsl => vec![Via::Wgsl],
        ViaChoice::Both => vec![Via::Spirv, Via::Wgsl],
    };
    let difference = args.difference.as_deref().map(Target::parse).transpose()?;
    let progress = Progress::new(console, vias.len() + 1);
    let drawn = args.specialize.then(|| read.specialized(args.contract.contract()));
    let scenes = (&read.scene, drawn.as_ref());
    let (verification, facts) = match compare(args, scenes, read.sources(), &vias, &progress) {
        Ok(compared) => compared,
        Err(error) => return read.failed(error),
    };
    drop(progress);
    if let Some(target) = difference {
        let (files, _) = target.encode(&verification.difference(), glisten_scene::picture::Transfer::Linear)?;
        for (path, bytes) in files {
            files::write(&path, &bytes)?;
            let most = verification.shares.iter().fold(0.0, |most: f64, share| most.max(*share));
            let most = if most.is_finite() { format!("at most {most:.2} of the bound; ") } else { String::new() };
            console.remark(&format!("wrote {}: {most}{}", path.display(), verify::DIFFERENCE_LEGEND));
        }
    }
    let runs: Vec<Run> = verification.runs.iter().map(|run| Run::new(run, &verification)).collect();
    let skipped: Vec<Skip> = verification.skipped.iter().map(Skip::new).collect();
    let Some(worse) = worst_of(&runs) else { return Ok(Exit::Ok) };
    let forms_bit_unequal = match &verification.runs[..] {
        [spirv, wgsl] => Some(spirv.picture.bit_unequal(&wgsl.picture)),
        _ => None,
    };
    let holds = verification.holds();
    let text = match args.format {
        ResultFormat::Json => {
            let report = Report {
                worse: &worse,
                runs: &runs,
                skipped: &skipped,
                forms_bit_unequal,
                verdict: verification.conclusion(),
                holds,
                adapter: &facts.name,
                driver: &facts.driver,
            };
            serde_json::to_string_pretty(&report).expect("figures are always JSON") + "\n"
        }
        ResultFormat::Human => {
            let mut text: String = runs.iter().map(|run| human(run, args.allow_undecided)).collect();
            for skip in &skipped {
                text.push_str(&format!("{}: not run: {}\n", skip.via, skip.reason));
            }
            if let Some(count) = forms_bit_unequal {
                text.push_str(&format!("spirv and wgsl: {count} pixels are not bit-equal\n"));
            }
            if let Some(note) = &verification.note {
                text.push('\n');
                text.push_str(&write::human(read.sources(), [note], console.colors_output()));
            }
            text
        }
    };
    if args.format == ResultFormat::Human && read.is_human() {
        console.remark(&format!("drawn by {facts}"));
    }
    console.output(&text)?;
    let exit = if holds { Exit::Ok } else { Exit::Content };
    Ok(read.finish(Vec::new())?.max(exit))
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
    args: &VerifyArgs,
    (scene, drawn): (&Scene, Option<&Scene>),
    sources: &SourceMap,
    vias: &[Via],
    progress: &Progress,
) -> Result<(Verification, AdapterFacts), DrawError> {
    let machine = &args.scene.machine;
    let gpu = Arc::new(args.scene.gpu()?);
    let runners: Vec<TimedGpu<'_>> = vias.iter().map(|via| TimedGpu::new(&gpu, *via, machine, progress)).collect();
    let runners: Vec<Instead<'_>> = runners.iter().map(|runner| Instead { runner, scene: drawn }).collect();
    let runners: Vec<&dyn Runner> = runners.iter().map(|runner| runner as &dyn Runner).collect();
    let options = Options {
        criterion: args.tolerance.map_or(Criterion::Envelope, Criterion::Tolerance),
        excuse_known_faults: !args.no_known_faults,
        allow_undecided: args.allow_undecided,
        allow_inconclusive: args.allow_inconclusive,
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

fn human(run: &Run, allow_undecided: bool) -> String {
    let verdict = &run.verdict;
    let psnr = verdict.psnr.map_or("equal".to_owned(), |psnr| format!("{psnr:.1} dB"));
    let rows = [
        ("covered", format!("{} of {} pixels", verdict.covered, verdict.pixels)),
        ("largest error", format!("{:.3e} ({:.1} ulp)", verdict.max_abs, verdict.max_ulp)),
        ("rmse, psnr", format!("{:.3e}, {psnr}", verdict.rmse)),
        ("flip", format!("{:.3e}", run.flip)),
        ("outside", format!("{} (judged by {})", verdict.outside, verdict.judged_by)),
        ("not bit-equal", format!("{} pixels", run.bit_unequal)),
        ("undecided", verdict.undecided.to_string()),
        ("coverage mismatch", format!("{} ({} at edges)", verdict.coverage_mismatch, verdict.edge_pixels)),
        ("not finite", format!("gpu {}, cpu {}", verdict.non_finite_gpu, verdict.non_finite_cpu)),
        ("time", format!("gpu {:.3} ms, cpu {:.3} ms", run.gpu_ms, run.cpu_ms)),
    ];
    let faults: Vec<String> =
        verdict.known_faults.iter().map(|count| format!("{} ({})", count.pixels, count.fault)).collect();
    let faults = (!faults.is_empty()).then(|| ("known faults", faults.join(", ")));
    let mark = verify::mark(verdict.conclusion(allow_undecided));
    let mut text = format!("{}: {mark}\n", run.via);
    for (name, value) in rows.into_iter().chain(faults) {
        text.push_str(&format!("  {name:18} {value}\n"));
    }
    if let Some(worst) = &verdict.worst
        && verdict.max_abs > 0.0
    {
        let numbers = |color: [f64; 4]| color.map(|value| format!("{value:.7}")).join(", ");
        text.push_str(&format!("  worst pixel        ({}, {})\n", worst.x, worst.y));
        text.push_str(&format!("    gpu   {}\n    cpu   {}\n", numbers(worst.gpu), numbers(worst.cpu)));
        text.push_str(&format!("    bound {}\n", worst.bound.map(|value| format!("{value:.2e}")).join(", ")));
    }
    text
}
