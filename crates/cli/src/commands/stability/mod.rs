//! `glisten stability`: tells where f32 arithmetic harms the pictures of scenes, why, and what to write instead.

mod library;
mod page;

use crate::arguments::args::{LevelArgs, SourceArgs};
use crate::arguments::config;
use crate::commands::examples::Examples;
use crate::console::Console;
use crate::exit::{Exit, Failure, Outcome};
use crate::files;
use crate::inputs;
use crate::overwrite;
use crate::pictures::Target;
use crate::progress::Progress;
use crate::scenes::{MachineArgs, Read, SceneArgs};
use clap::{Args, ValueEnum};
use glisten_front::diagnostic::{self, Diagnostic};
use glisten_front::hir::Stage;
use glisten_scene::picture::Transfer;
use glisten_scene::{Scene, ShaderFiles, write};
use glisten_stability::settings::Settings;
use glisten_stability::stiff::{self, Worst};
use glisten_stability::sweep::{self, Drawn, Parameter, Sweep, SweepPoint};
use glisten_stability::{BOUND, Examination, ExamineOptions, Findings, Stability, find, heat, with_exact};
use glisten_verify::verify::of_attachment;
use library::LibraryArgs;
use serde::Serialize;
use std::cell::Cell;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Examples of its use.
pub(crate) const EXAMPLES: Examples = &[
    ("glisten stability scene.toml", "where f32 arithmetic harms the picture, and why"),
    ("glisten stability scene.toml --sweep material.shininess=1..10000:32", "with 32 values of a uniform"),
    ("glisten stability scene.toml --stiff --worst worst.toml", "with the worst inputs that can be found"),
    ("glisten stability scenes/ --format github", "in CI: annotations on the lines of all scenes"),
];

/// Find out where f32 arithmetic harms the picture of a scene, and why
#[derive(Args, Debug)]
pub(crate) struct StabilityArgs {
    /// Scene files, or folders to search for them
    #[arg(value_name = "SCENE.toml|DIR", required_unless_present = "library")]
    scenes: Vec<String>,
    /// Examine the library instead: its functions, and the standard programs by the values of its scenes; all, or those of a
    /// module, or one
    #[arg(long, value_name = "NAME", num_args = 0..=1, require_equals = true, conflicts_with_all = ["scenes", "sweeps", "stiff", "worst", "heat", "exact"])]
    library: Option<Option<String>>,
    /// The number of calls of each function of the library; calls with extreme values are added, at most a quarter as many
    #[arg(long, value_name = "N", default_value_t = 2048, value_parser = clap::value_parser!(u32).range(16..=65_536), requires = "library", conflicts_with = "scenes")]
    cases: u32,
    /// Draw with values of a uniform from LOW to HIGH, and examine the worst (repeatable: all combinations, also with the sweeps of other
    /// uniforms that the scene states)
    #[arg(long = "sweep", value_name = "NAME=LOW..HIGH[:N]", value_parser = sweep::parse)]
    sweeps: Vec<Sweep>,
    /// Search for the worst inputs: stiff and extreme values of uniforms and attributes, within `[stability.range]` where the
    /// scene states it
    #[arg(long, conflicts_with = "sweeps")]
    stiff: bool,
    /// Write the scene with the worst inputs that --stiff or --sweep found, with its shaders next to it
    #[arg(long, value_name = "FILE.toml")]
    worst: Option<PathBuf>,
    /// The largest error of the picture that is accepted (default: that of the scene, or 1/1024)
    #[arg(long, value_name = "X", value_parser = parse_bound, allow_negative_numbers = true)]
    bound: Option<f64>,
    /// Accept errors of this share of a pixel's largest channel, too (for colors far above 1, of which f32 has fewer digits;
    /// default: that of the scene, or none)
    #[arg(long, value_name = "X", value_parser = parse_bound)]
    bound_relative: Option<f64>,
    /// Report causes whose harm is below the bound, too
    #[arg(long)]
    all: bool,
    /// Recompute the worst pixels in 192 bits, and tell the error of f64 itself
    #[arg(long)]
    exact: bool,
    /// Write a map of the errors over the picture
    #[arg(long, value_name = "FILE.png")]
    heat: Option<PathBuf>,
    /// Write a page, stability.html, and stability.json to this folder
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// The format of the result
    #[arg(long, value_enum, default_value_t)]
    format: StabilityFormat,
    #[command(flatten)]
    machine: MachineArgs,
    #[command(flatten)]
    sources: SourceArgs,
    #[command(flatten)]
    levels: LevelArgs,
}

/// The format of the result.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
enum StabilityFormat {
    /// A table, and excerpts with carets
    #[default]
    #[value(alias = "table")]
    Human,
    /// JSON
    Json,
    /// SARIF 2.1.0
    Sarif,
    /// Workflow commands of GitHub Actions
    Github,
}

fn parse_bound(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(bound) if bound > 0.0 && bound.is_finite() => Ok(bound),
        _ => Err(format!("`{text}` is not a positive number")),
    }
}

/// The result for a scene.
#[derive(Serialize)]
struct SceneResult {
    scene: String,
    #[serde(flatten)]
    findings: Findings,
    /// The accepted error.
    bound: f64,
    /// The accepted share of a pixel's largest channel.
    #[serde(skip_serializing_if = "Option::is_none")]
    bound_relative: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    sweep: Option<SweepResult>,
    #[serde(skip_serializing_if = "Option::is_none")]
    stiff: Option<Worst>,
    /// The scene that was examined: the worst one.
    #[serde(skip)]
    examined_scene: Scene,
}

#[derive(Serialize)]
struct SweepResult {
    points: Vec<SweepPoint>,
    /// The number of combinations; fewer points were drawn if the time was up.
    combinations: usize,
    /// The point that was examined.
    worst: SweepPoint,
}

/// A scene that was examined, with its texts.
struct Done<'a> {
    read: Read<'a>,
    result: SceneResult,
    examined: Examination,
}

/// Runs the command.
pub(crate) fn run(args: &StabilityArgs, console: &Console) -> Outcome {
    if let Some(only) = &args.library {
        let is_json = match args.format {
            StabilityFormat::Human => false,
            StabilityFormat::Json => true,
            StabilityFormat::Sarif | StabilityFormat::Github => {
                return Err(Failure::usage("--library has the formats human and json"));
            }
        };
        return library::run(
            &LibraryArgs { only: only.as_deref(), cases: args.cases as usize, is_json, output: args.output.as_deref() },
            console,
        );
    }
    overwrite::refuse_equal(args.heat.iter().chain(&args.worst).map(PathBuf::as_path))?;
    let scenes = inputs::scene_files(&args.scenes)?;
    let mut done = Vec::new();
    let mut exit = Exit::Ok;
    for name in &scenes {
        let scene = SceneArgs::of(name, &args.machine, &args.sources, &args.levels);
        let read = match scene.read(console)? {
            Ok(read) => read,
            Err(worse) => {
                exit = exit.max(worse);
                continue;
            }
        };
        match examined(args, name, &read, console)? {
            Ok((_, examined))
                if !examined.exact.covered.contains(&true) && !examined.single.covered.contains(&true) =>
            {
                let nothing = vec![read.nothing_covered()];
                exit = exit.max(read.finish(nothing)?).max(Exit::Content);
            }
            Ok((result, examined)) => done.push(Done { read, result, examined }),
            Err(found) => exit = exit.max(read.finish(found)?).max(Exit::Content),
        }
    }
    if let Some(path) = &args.heat {
        write_heat(path, &done)?;
    }
    if let Some(path) = &args.worst {
        write_worst(path, &done)?;
    }
    if let Some(folder) = &args.output {
        page::write(folder, args, &done, console)?;
    }
    tell(args, &done, console)?;
    let is_unstable = |done: &Done<'_>| done.examined.verdict != Stability::Stable;
    Ok(if done.iter().any(is_unstable) { exit.max(Exit::Content) } else { exit })
}

/// A result, or the diagnostics of its failure.
type Examined = Result<(SceneResult, Examination), Vec<Diagnostic>>;

fn examined(args: &StabilityArgs, name: &str, read: &Read<'_>, console: &Console) -> Result<Examined, Failure> {
    let sources = read.sources();
    let Some((_, file)) = sources.files().next() else { return Ok(Err(Vec::new())) };
    let settings = match Settings::read(file.text(), file.base()) {
        Ok(settings) => settings,
        Err(diagnostic) => return Ok(Err(vec![*diagnostic])),
    };
    let of_project = || config::stability_bound(Path::new(name));
    let bound = args.bound.or(settings.bound).or_else(of_project).unwrap_or(BOUND);
    let relative = args.bound_relative.or(settings.bound_relative);
    for stated in [&settings.sweeps, &settings.ranges] {
        if let Err(diagnostic) = sweep::parameters(&read.scene, stated) {
            return Ok(Err(vec![*diagnostic]));
        }
    }
    let sweeps = sweep::joined(&read.scene, &args.sweeps, &settings.sweeps);
    let progress = Progress::new(console, 0).unless(args.format == StabilityFormat::Json);
    progress.say(name);
    let (started, limit) = (Instant::now(), args.machine.time_limit());
    let watchdog = args.machine.watchdog(console);
    let stopped = Cell::new(false);
    let stop = || {
        stopped.set(true);
        false
    };
    let (scene, sweep, stiff) = if args.stiff {
        let found = stiff::search(&read.scene, &settings.ranges, &mut |done, most| {
            progress.reach(done, most);
            watchdog.again();
            // The other half is for the experiments.
            started.elapsed() < limit / 2 || stop()
        });
        match found {
            Ok(worst) => (worst.scene.clone(), None, Some(worst)),
            Err(found) => return Ok(Err(found)),
        }
    } else {
        // The other half is for the experiments.
        let mut goes_on = || {
            watchdog.again();
            started.elapsed() < limit / 2 || stop()
        };
        // A name of the command line is wrong usage, and one of the scene is wrong content.
        let sweeps = (sweeps.as_slice(), !args.sweeps.is_empty());
        match swept(sweeps, &read.scene, relative.unwrap_or(0.0), &progress, &mut goes_on)? {
            Ok((scene, sweep)) => (scene, sweep, None),
            Err(found) => return Ok(Err(found)),
        }
    };
    let mut step = |done: usize, of: usize| {
        progress.reach(done, of);
        watchdog.again();
        started.elapsed() < limit || stop()
    };
    watchdog.again();
    let mut options = ExamineOptions {
        bound,
        bound_relative: relative.unwrap_or(0.0),
        all: args.all,
        figures: args.output.is_some(),
        progress: &mut step,
    };
    let reload = |file: &str, text: &str| read.reloaded(name, file, text);
    let found = find(&scene, sources, &mut options, Some(&reload));
    if let Some(sweep) = sweep.as_ref().filter(|sweep| sweep.points.len() < sweep.combinations) {
        let (drawn, of) = (sweep.points.len(), sweep.combinations);
        console.remark(&format!("{name}: the sweep ended after {drawn} of {of} values (`--timeout` gives more time)"));
    } else if stopped.get() {
        let message = format!("{name}: stopped after {} s, so there may be more to find", limit.as_secs_f64());
        console.remark(&format!("{message} (`--timeout` gives more time)"));
    }
    watchdog.again();
    let found = if args.exact { found.and_then(|found| with_exact(&scene, found, bound)) } else { found };
    Ok(found.map(|(findings, examined)| {
        let result = SceneResult {
            scene: name.to_owned(),
            findings,
            bound,
            bound_relative: relative,
            sweep,
            stiff,
            examined_scene: scene.clone(),
        };
        (result, examined)
    }))
}

/// The scene to examine with the points of the sweeps, or the diagnostics of a failure to draw.
type Swept = Result<(Scene, Option<SweepResult>), Vec<Diagnostic>>;

/// The scene with the worst values of the sweeps, or as it is. Ends with what it has if `goes_on` is false before a picture; one
/// is drawn in any case.
fn swept(
    (sweeps, is_asked): (&[Sweep], bool),
    scene: &Scene,
    relative: f64,
    progress: &Progress,
    goes_on: &mut dyn FnMut() -> bool,
) -> Result<Swept, Failure> {
    if sweeps.is_empty() {
        return Ok(Ok((scene.clone(), None)));
    }
    let exit = if is_asked { Exit::Usage } else { Exit::Content };
    // Those of the scene have been found before.
    let found = sweep::parameters(scene, sweeps).map_err(|diagnostic| {
        let failure = Failure::new(exit, diagnostic.message);
        match diagnostic.help {
            Some(help) => failure.help(help),
            None => failure,
        }
    })?;
    let (parameters, values): (Vec<Parameter>, Vec<Vec<f64>>) = found.into_iter().unzip();
    let combinations = sweep::combinations(&values).map_err(Failure::usage)?;
    let step = &mut |done: usize, of: usize| {
        progress.reach(done, of);
        goes_on()
    };
    Ok(sweep::draw(scene, &parameters, &combinations, relative, step).map(|Drawn { points, worst, scene }| {
        (scene, Some(SweepResult { points, combinations: combinations.len(), worst }))
    }))
}

fn tell(args: &StabilityArgs, done: &[Done<'_>], console: &Console) -> Result<(), Failure> {
    let text = match args.format {
        StabilityFormat::Json => json_of(args, done),
        StabilityFormat::Sarif => diagnostic::write::sarif(&findings(done), None),
        StabilityFormat::Github => diagnostic::write::github(&findings(done), None),
        StabilityFormat::Human => done.iter().map(|done| human(done, console)).collect(),
    };
    console.output(&text)
}

fn json_of(args: &StabilityArgs, done: &[Done<'_>]) -> String {
    match done {
        [one] if args.scenes.len() == 1 => json(&one.result),
        _ => json(&done.iter().map(|done| &done.result).collect::<Vec<_>>()),
    }
}

fn json(value: &impl Serialize) -> String {
    // Numbers, strings and lists only: serialization has nothing to reject.
    serde_json::to_string_pretty(value).unwrap_or_default() + "\n"
}

fn findings(done: &[Done<'_>]) -> Vec<diagnostic::write::Finding> {
    let each = done.iter().flat_map(|done| {
        let causes = done.result.findings.causes.iter().map(|cause| &cause.diagnostic);
        diagnostic::write::findings(done.read.sources(), causes)
    });
    each.collect()
}

fn human(done: &Done<'_>, console: &Console) -> String {
    let SceneResult { scene, findings, bound, bound_relative, sweep, stiff, .. } = &done.result;
    let picture = &findings.picture;
    let mut text = format!("{scene}: {}\n", findings.verdict);
    let mut row = |name: &str, value: String| text.push_str(&format!("  {name:18} {value}\n"));
    let besides = bound_relative.map_or_else(String::new, |share| format!(", or {share:.2e} of the color"));
    row(
        "largest error",
        format!("{:.2e} (accepted: {bound:.2e}{besides}), rmse {:.2e}", picture.max_abs, picture.rmse),
    );
    let pixels = done.examined.errors.not_finite();
    row("not finite", format!("{} results, {pixels} pixels", findings.non_finite));
    if let Some(exact) = &findings.exact {
        row("reference", exact.sentence());
    }
    if let Some(worst) = &picture.worst {
        let color = |color: [Option<f64>; 4]| {
            color.map(|value| value.map_or_else(|| "not finite".to_owned(), |value| format!("{value:.6}"))).join(", ")
        };
        row("worst pixel", format!("({}, {}){}", worst.x, worst.y, of_attachment(worst.attachment)));
        row("  f32", color(worst.f32));
        row("  exact", color(worst.exact));
        for (name, values) in &worst.inputs {
            let values: Vec<String> = values
                .iter()
                .map(|value| value.map_or_else(|| "not finite".to_owned(), |value| format!("{value:.6}")))
                .collect();
            row(&format!("  {name}"), values.join(", "));
        }
    }
    if let Some(stiff) = stiff {
        let values: Vec<String> = stiff.changed.iter().map(|it| format!("{} = {}", it.name, it.value)).collect();
        let values = if values.is_empty() { "the scene's own".to_owned() } else { values.join(", ") };
        row("worst inputs", format!("{values} ({} inputs varied, {} pictures drawn)", stiff.inputs, stiff.drawings));
        row("before", format!("{:.2e}", stiff.max_abs_before));
    }
    if let Some(sweep) = sweep {
        let values: Vec<String> = sweep.worst.values.iter().map(|(name, value)| format!("{name} = {value}")).collect();
        let drawn = match sweep.points.len() {
            all if all == sweep.combinations => format!("{all} drawn"),
            some => format!("{some} drawn before the time was up, {} asked for", sweep.combinations),
        };
        row("worst values", format!("{} (of {drawn})", values.join(", ")));
    }
    if !findings.causes.is_empty() {
        text.push_str("\n  harm      kind          bits  place\n");
        for cause in &findings.causes {
            let harm = cause.harm.map_or_else(|| "not fin.".to_owned(), |harm| format!("{harm:.2e}"));
            let place = format!("{}:{}:{}", cause.file, cause.line, cause.column);
            text.push_str(&format!("  {harm:9} {:13} {:4.1}  {place}\n", cause.kind, cause.lost_bits));
        }
        text.push('\n');
        let causes = findings.causes.iter().map(|cause| &cause.diagnostic);
        text.push_str(&diagnostic::write::human(done.read.sources(), causes, console.colors_output()));
    }
    text
}

/// Writes the scene that was examined, with the texts of its shaders.
fn write_worst(path: &Path, done: &[Done<'_>]) -> Result<(), Failure> {
    if let Some(folder) = path.parent().filter(|folder| !folder.as_os_str().is_empty()) {
        files::make_folder(folder)?;
    }
    let [done] = done else { return Err(Failure::usage("--worst takes one scene").help("name a single scene file")) };
    let scene = &done.result.examined_scene;
    let stem = path.file_stem().map_or_else(|| "worst".to_owned(), |stem| stem.to_string_lossy().into_owned());
    let mut shaders = Vec::new();
    for (number, draw) in scene.draws.iter().enumerate() {
        let stem = if number == 0 { stem.clone() } else { format!("{stem}_{number}") };
        let files = ShaderFiles::of(draw, &stem);
        let geometry = files.geometry.iter().map(|file| (Stage::Geometry, file));
        for (stage, file) in
            [(Stage::Vertex, &files.vertex), (Stage::Fragment, &files.fragment)].into_iter().chain(geometry)
        {
            let text = draw.program.stage(stage).and_then(|shader| shader.texts.first());
            let text = text.map_or("", |text| text);
            files::write(&path.with_file_name(file), text.as_bytes())?;
        }
        shaders.push(files);
    }
    files::write(path, write(scene, &shaders).as_bytes())
}

fn write_heat(path: &Path, done: &[Done<'_>]) -> Result<(), Failure> {
    let [done] = done else { return Err(Failure::usage("--heat takes one scene").help("name a single scene file")) };
    let target = Target::parse(path)?;
    let (files, _) = target.encode(&heat(&done.examined, done.result.bound), Transfer::Linear)?;
    for (path, bytes) in files {
        files::write(&path, &bytes)?;
    }
    Ok(())
}
