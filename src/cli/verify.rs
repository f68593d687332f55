//! `glisten verify`: draws a scene on the GPU and with the CPU reference, and judges each pixel.

use super::console::Console;
use super::exit::{Exit, Outcome};
use super::files;
use super::pictures::Target;
use super::progress::Progress;
use super::scenes::{DrawError, SceneArgs};
use crate::scene::Scene;
use clap::{Args, ValueEnum};
use glisten_front::diagnostic::codes::scenes::BOUND_EXPLAINED;
use glisten_front::diagnostic::{Diagnostic, write};
use glisten_front::source::SourceMap;
use glisten_gpu::{Gpu, Via};
use glisten_reference::domain::faults::{Faults, KNOWN};
use glisten_reference::{Contribution, LineRule, Precision, RenderOptions};
use glisten_scene::compare::{self, Contributed, Judge, Picture, Verdict, flip};
use serde::Serialize;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;

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
    format: Format,
    /// Judge by this absolute difference per channel instead of the derived envelope
    #[arg(long, value_name = "X", value_parser = parse_tolerance)]
    tolerance: Option<f64>,
    /// Accept any number of pixels that the reference cannot decide
    #[arg(long)]
    allow_undecided: bool,
    /// Excuse no pixel because of known faults of the driver
    #[arg(long)]
    no_known_faults: bool,
    /// Let the GPU draw with programs of which nothing is left but what the picture needs, and judge it by the original
    #[arg(long)]
    specialize: bool,
    /// Write a picture of |difference| / bound: gray up to the bound, red beyond
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

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
enum Format {
    /// Figures for people
    #[default]
    Human,
    /// One JSON object
    Json,
}

fn parse_tolerance(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(tolerance) if tolerance >= 0.0 => Ok(tolerance),
        _ => Err(format!("`{text}` is no tolerance")),
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
    /// What the target lacks, with a way out.
    reason: String,
}

impl Skip {
    fn new(via: Via, diagnostics: &[Diagnostic]) -> Self {
        let reasons: Vec<&str> = diagnostics.iter().map(|diagnostic| diagnostic.message.as_str()).collect();
        Self { via: via.name(), reason: reasons.join("; ") }
    }
}

/// All comparisons, with their pictures.
#[derive(Default)]
struct Compared {
    runs: Vec<Run>,
    pictures: Vec<Picture>,
    skipped: Vec<Skip>,
    /// For each pixel, the largest difference relative to its bound.
    shares: Vec<f64>,
    /// The origin of the worst pixel's bound.
    note: Option<Diagnostic>,
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
    holds: bool,
}

/// Runs the command.
pub(super) fn run(args: &VerifyArgs, console: &Console) -> Outcome {
    let read = match args.scene.read(console)? {
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
    let scene = Arc::new(read.scene.clone());
    let drawn = if args.specialize { Arc::new(read.specialized()) } else { Arc::clone(&scene) };
    let compared = compare(args, (Arc::clone(&scene), drawn), &vias, &progress);
    let compared = compared.and_then(|compared| explained(args, &scene, read.sources(), compared));
    let Compared { runs, pictures, skipped, shares, note } = match compared {
        Ok(compared) => compared,
        Err(error) => return read.failed(error),
    };
    drop(progress);
    if let Some(target) = difference {
        let (files, _) = target.encode(&shown(&read.scene, &shares))?;
        for (path, bytes) in files {
            files::write(&path, &bytes)?;
        }
    }
    let Some(worse) = worst_of(&runs) else { return Ok(Exit::Ok) };
    let forms_bit_unequal = match &pictures[..] {
        [spirv, wgsl] => Some(spirv.bit_unequal(wgsl)),
        _ => None,
    };
    let holds = runs.iter().all(|run| run.verdict.holds(args.allow_undecided));
    let text = match args.format {
        Format::Json => {
            let report = Report { worse: &worse, runs: &runs, skipped: &skipped, forms_bit_unequal, holds };
            serde_json::to_string_pretty(&report).expect("figures are always JSON") + "\n"
        }
        Format::Human => {
            let mut text: String = runs.iter().map(|run| human(run, args.allow_undecided)).collect();
            for skip in &skipped {
                text.push_str(&format!("{}: not run: {}\n", skip.via, skip.reason));
            }
            if let Some(count) = forms_bit_unequal {
                text.push_str(&format!("spirv and wgsl: {count} pixels are not bit-equal\n"));
            }
            if let Some(note) = &note {
                text.push('\n');
                text.push_str(&write::human(read.sources(), [note], console.colors_output()));
            }
            text
        }
    };
    console.output(&text)?;
    Ok(if holds { Exit::Ok } else { Exit::Content })
}

/// Compares what the GPU makes of `drawn` with what the reference makes of `scene`.
fn compare(
    args: &VerifyArgs,
    (scene, drawn): (Arc<Scene>, Arc<Scene>),
    vias: &[Via],
    progress: &Progress,
) -> Result<Compared, DrawError> {
    let gpu = Arc::new(args.scene.gpu()?);
    progress.say("the reference");
    let start = Instant::now();
    let cpu = args.scene.within_time({
        let scene = Arc::clone(&scene);
        move || reference(&scene)
    })?;
    let cpu_ms = start.elapsed().as_secs_f64() * 1e3;
    progress.step();
    let judge = args.tolerance.map_or(Judge::Envelope, Judge::Tolerance);
    let mut faults: Option<Vec<(&'static str, Picture)>> = None;
    let mut compared = Compared::default();
    for via in vias {
        progress.say(via.name());
        let (picture, gpu_ms) = match on_gpu(args, Arc::clone(&gpu), Arc::clone(&drawn), *via) {
            // With `both`, a limitation of one target (for example, WGSL has no point size) does not keep the other
            // from being judged.
            Err(DrawError::Diagnostics(lack)) if *via == Via::Wgsl && !compared.runs.is_empty() => {
                compared.skipped.push(Skip::new(*via, &lack));
                continue;
            }
            other => other?,
        };
        let mut verdict = Verdict::new(&picture, &cpu, judge);
        if judge == Judge::Envelope && verdict.needs_excuse() && !args.no_known_faults {
            let admitted = match faults.take() {
                Some(admitted) => admitted,
                None => args.scene.within_time({
                    let scene = Arc::clone(&scene);
                    move || admitting(&scene)
                })?,
            };
            verdict = Verdict::admitting(&picture, &cpu, judge, &admitted);
            faults = Some(admitted);
        }
        let shares = compare::shares(&picture, &cpu, judge);
        compared.shares.resize(shares.len(), 0.0);
        compared.shares.iter_mut().zip(shares).for_each(|(most, share)| *most = share.max(*most));
        let bit_unequal = picture.bit_unequal(&cpu);
        compared.runs.push(Run { via: via.name(), verdict, flip: flip(&cpu, &picture), bit_unequal, gpu_ms, cpu_ms });
        compared.pictures.push(picture);
        progress.step();
    }
    Ok(compared)
}

/// How many contributions to a bound are reported.
const TOLD: usize = 3;
/// The smallest share of a bound that is reported.
const LEAST_SHARE: f64 = 0.01;

/// Adds, for the worst pixel of each run, the origin of its bound.
fn explained(
    args: &VerifyArgs,
    scene: &Arc<Scene>,
    sources: &SourceMap,
    mut compared: Compared,
) -> Result<Compared, DrawError> {
    let mut known: Vec<([u32; 4], Vec<Contribution>)> = Vec::new();
    let mut largest = -1.0;
    for run in compared.runs.iter_mut().filter(|run| run.verdict.judged_by == "envelope") {
        let max_abs = run.verdict.max_abs;
        let Some(worst) = &mut run.verdict.worst else { continue };
        let place = [worst.x, worst.y, worst.attachment, worst.channel];
        let contributions = match known.iter().find(|(known, _)| *known == place) {
            Some((_, contributions)) => contributions.clone(),
            None => args.scene.within_time({
                let scene = Arc::clone(scene);
                move || {
                    Ok(glisten_reference::explain(
                        &scene,
                        &options(Faults::NONE),
                        [place[0], place[1]],
                        place[2] as usize,
                        place[3] as usize,
                    )?)
                }
            })?,
        };
        known.push((place, contributions.clone()));
        let told: Vec<Contribution> =
            contributions.into_iter().filter(|one| one.share >= LEAST_SHARE).take(TOLD).collect();
        worst.contributions = told.iter().filter_map(|one| contributed(sources, one)).collect();
        if max_abs > largest {
            largest = max_abs;
            compared.note = note(&told, place);
        }
    }
    Ok(compared)
}

fn contributed(sources: &SourceMap, contribution: &Contribution) -> Option<Contributed> {
    let location = sources.location(sources.call_site(contribution.span))?;
    Some(Contributed {
        file: sources.file(location.file).name().to_owned(),
        line: location.line,
        column: location.column,
        end_column: location.end_column,
        operation: contribution.operation,
        share: contribution.share,
    })
}

/// The contributions as an excerpt.
fn note(told: &[Contribution], [x, y, _, channel]: [u32; 4]) -> Option<Diagnostic> {
    let (first, rest) = told.split_first()?;
    let channel = ["red", "green", "blue", "alpha"].get(channel as usize)?;
    let message = format!("what the bound of {channel} at pixel ({x}, {y}) comes from");
    let text = |one: &Contribution| format!("`{}`: {:.0} % of it", one.operation, one.share * 100.0);
    let note = Diagnostic::new(&BOUND_EXPLAINED, first.span, message).here(text(first));
    Some(rest.iter().fold(note, |note, one| note.label(one.span, text(one))))
}

/// The reference with its envelope; lines follow the rule of the target.
fn reference(scene: &Scene) -> Result<Picture, DrawError> {
    drawn(scene, Faults::NONE)
}

fn options(faults: Faults) -> RenderOptions {
    RenderOptions { precision: Precision::Envelope, lines: LineRule::Vulkan, faults, ..RenderOptions::default() }
}

fn drawn(scene: &Scene, faults: Faults) -> Result<Picture, DrawError> {
    Ok(glisten_reference::render(scene, &options(faults))?)
}

/// The reference pictures with each known fault of the driver excused, and with all of them.
fn admitting(scene: &Scene) -> Result<Vec<(&'static str, Picture)>, DrawError> {
    let one = KNOWN.iter().map(|known| (known.name, Faults::only(known.fault)));
    let all = one.chain([("several", Faults::all())]);
    all.map(|(name, faults)| Ok((name, drawn(scene, faults)?))).collect()
}

/// The picture of relative differences: gray up to the bound, red beyond.
fn shown(scene: &Scene, shares: &[f64]) -> Picture {
    let color = |share: &f64| if *share > 1.0 { [1.0, 0.0, 0.0, 1.0] } else { [*share, *share, *share, 1.0] };
    let (width, height) = (scene.framebuffer.width, scene.framebuffer.height);
    Picture {
        width,
        height,
        attachments: vec![shares.iter().map(color).collect()],
        covered: vec![true; shares.len()],
        ranges: None,
        undecided: Vec::new(),
        near_edge: Vec::new(),
    }
}

fn on_gpu(args: &VerifyArgs, gpu: Arc<Gpu>, scene: Arc<Scene>, via: Via) -> Result<(Picture, f64), DrawError> {
    args.scene.within_time(move || {
        let rendered = gpu.render(&scene, via)?;
        Ok((rendered.picture, rendered.milliseconds))
    })
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
    let mark = if verdict.holds(allow_undecided) { "holds" } else { "DOES NOT HOLD" };
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
