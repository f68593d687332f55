//! `glisten specialize`: writes scenes with programs of which nothing is left but what their pictures need.
//!
//! *Holds:* the names of all outputs are known before anything is written; equal residuals are written once.

mod suggest;
mod time;

use self::time::Clock;
use crate::arguments::args::{ContractArgs, ConventionArgs, LevelArgs, ResultFormat, SourceArgs};
use crate::commands::examples::Examples;
use crate::console::Console;
use crate::exit::{Exit, Failure, Outcome};
use crate::files;
use crate::outputs::target_words;
use crate::progress::Progress;
use crate::scenes::{DrawError, MachineArgs, Read, SceneArgs};
use clap::Args;
use glisten_emit::{self as emit, Conventions, Target};
use glisten_front::hir::Stage;
use glisten_front::link::Program;
use glisten_reference::Precision;
use glisten_report::account::{PAGE, SceneOnPage, page};
use glisten_scene::dynamic::is_known;
use glisten_scene::{Scene, ShaderFiles, write};
use glisten_sources::stages::extension;
use glisten_specialize::optimize;
use glisten_verify::specialize::{
    Account, PictureError, Pictures, SpecializedScene, Times, account, files_of, pictures, specialize_scene_by,
};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// Examples of its use.
pub(crate) const EXAMPLES: Examples = &[
    ("glisten specialize scene.toml -o out", "programs of which nothing is left but what the scene needs"),
    ("glisten specialize scene.toml --check", "whether anything could be left out"),
    ("glisten specialize scenes/*.toml --suggest", "which uniforms are worth fixing"),
];

/// Leave out of the programs of scenes what their pictures do not need
#[derive(Args, Debug)]
pub(crate) struct SpecializeArgs {
    /// Scene files
    #[arg(value_name = "SCENE.toml", required = true)]
    scenes: Vec<String>,
    /// The output folder
    #[arg(short, long, value_name = "DIR", required_unless_present_any = ["check", "suggest"])]
    output: Option<PathBuf>,
    /// A uniform or sampler that changes from frame to frame, added to those of the scenes (repeatable)
    #[arg(long, value_name = "NAME")]
    dynamic: Vec<String>,
    /// Write nothing, and tell whether anything can be left out
    #[arg(long)]
    check: bool,
    /// Draw each scene and its residual in turns on the GPU, and keep the original where the residual is slower
    #[arg(long, conflicts_with_all = ["check", "suggest"])]
    time: bool,
    /// Write nothing, and rank the uniforms by what fixing them saves in all scenes together
    #[arg(long, conflicts_with = "check")]
    suggest: bool,
    /// The format of --suggest
    #[arg(long, value_enum, default_value_t, requires = "suggest")]
    format: ResultFormat,
    #[command(flatten)]
    contract: ContractArgs,
    /// The target to write (repeatable; default: wgsl and spirv)
    #[arg(long = "target", value_name = "TARGET", value_parser = target_words())]
    targets: Vec<Target>,
    #[command(flatten)]
    machine: MachineArgs,
    #[command(flatten)]
    sources: SourceArgs,
    #[command(flatten)]
    conventions: ConventionArgs,
    #[command(flatten)]
    levels: LevelArgs,
}

/// A specialized scene on its way to its files.
struct Done<'a> {
    /// The scene file's stem.
    name: String,
    /// The original.
    read: Read<'a>,
    specialized: SpecializedScene,
    /// For each draw the files of the original's shaders and the stem of the residual.
    names: Vec<[String; 3]>,
    /// The times of original and residual.
    times: Option<Times>,
}

/// The stem of the file that names each scene's programs.
const PROGRAMS: &str = "programs";

/// The residuals of all scenes, by their stems.
#[derive(Default)]
struct Residuals {
    /// The stems of the JSON files that are no reflection.
    reserved: BTreeSet<String>,
    by_stem: BTreeMap<String, Vec<(Stage, String)>>,
    programs: BTreeMap<String, std::sync::Arc<Program>>,
}

impl Residuals {
    /// No residual yet. The accounts of these scene files have names that no reflection may have.
    fn of(scenes: &[String]) -> Self {
        let accounts = scenes.iter().map(|name| format!("{}.account", stem(name)));
        Self { reserved: accounts.chain([PROGRAMS.to_owned()]).collect(), ..Self::default() }
    }

    /// The stem of a residual: that of its program, with a number where another file has it.
    fn stem(&mut self, program: &std::sync::Arc<Program>, texts: &[(Stage, String)]) -> String {
        let mut number = 1;
        loop {
            let stem = if number == 1 { program.name.clone() } else { format!("{}_{number}", program.name) };
            match self.by_stem.get(&stem) {
                None if self.reserved.contains(&stem) => number += 1,
                Some(known) if known.as_slice() == texts => return stem,
                Some(_) => number += 1,
                None => {
                    self.by_stem.insert(stem.clone(), texts.to_vec());
                    self.programs.insert(stem.clone(), std::sync::Arc::clone(program));
                    return stem;
                }
            }
        }
    }
}

/// Runs the command.
pub(crate) fn run(args: &SpecializeArgs, console: &Console) -> Outcome {
    refuse_equal_names(&args.scenes)?;
    let clock = if args.time { Some(Clock::new(&args.machine)?) } else { None };
    let (mut reads, mut exit) = (Vec::new(), Exit::Ok);
    for name in &args.scenes {
        let _watchdog = args.machine.watchdog(console);
        match SceneArgs::of(name, &args.machine, &args.sources, &args.levels).read(console)? {
            Ok(read) => reads.push((name, read)),
            Err(worse) => exit = exit.max(worse),
        }
    }
    // A scene that was not read may have the name.
    if exit == Exit::Ok {
        let scenes: Vec<&Scene> = reads.iter().map(|(_, read)| &read.scene).collect();
        check_dynamic(&args.dynamic, &scenes)?;
    }
    if args.suggest {
        let scenes = reads.into_iter().map(|(name, read)| (stem(name), read.scene)).collect();
        let answer = suggest::run(scenes, &args.dynamic, &args.machine, (args.format, console));
        return answer.map(|answer| answer.max(exit));
    }
    let progress = Progress::new(console, reads.len());
    let mut residuals = Residuals::of(&args.scenes);
    let mut done = Vec::new();
    for (name, read) in reads {
        progress.say(name);
        let _watchdog = args.machine.watchdog(console);
        done.push(specialized(args, name, read, (clock.as_ref(), &mut residuals))?);
        progress.step();
    }
    drop(progress);
    if args.check {
        return checked(&done, console).map(|answer| answer.max(exit));
    }
    if done.is_empty() {
        return Ok(exit);
    }
    let folder = args.output.clone().unwrap_or_default();
    files::make_folder(&folder)?;
    let conventions = args.conventions.conventions(false);
    for (stem, texts) in &residuals.by_stem {
        write_residual(args, &folder, stem, texts, &residuals, (&conventions, console))?;
    }
    let mut programs: BTreeMap<String, Vec<String>> = BTreeMap::new();
    let mut drawn = Vec::new();
    for index in 0..done.len() {
        let Some(one) = done.get(index) else { break };
        let _watchdog = args.machine.watchdog(console);
        match write_scene(args, &folder, one, console) {
            Ok(pair) => drawn.push(pair),
            Err(error) => return done.swap_remove(index).read.failed(error),
        }
        programs.insert(one.name.clone(), one.names.iter().map(|[_, _, stem]| stem.clone()).collect());
    }
    let json = serde_json::to_string_pretty(&programs).expect("names are always JSON") + "\n";
    files::write(&folder.join(format!("{PROGRAMS}.json")), json.as_bytes())?;
    let watchdog = args.machine.watchdog(console);
    write_page(&folder, &done, &drawn)?;
    drop(watchdog);
    console.remark(&format!("wrote {}", folder.display()));
    Ok(exit)
}

/// Two scenes of one name would write the same file.
fn refuse_equal_names(scenes: &[String]) -> Result<(), Failure> {
    let mut seen = BTreeSet::new();
    for scene in scenes {
        let stem = stem(scene);
        if !seen.insert(stem.clone()) {
            let message = format!("two scenes are named `{stem}`, and would both write `{stem}.toml`");
            return Err(Failure::usage(message).help("specialize them into different folders"));
        }
    }
    Ok(())
}

fn stem(path: &str) -> String {
    Path::new(path).file_stem().map_or_else(|| path.to_owned(), |stem| stem.to_string_lossy().into_owned())
}

fn specialized<'a>(
    args: &SpecializeArgs,
    name: &str,
    read: Read<'a>,
    (clock, residuals): (Option<&Clock>, &mut Residuals),
) -> Result<Done<'a>, Failure> {
    let contract = args.contract.contract();
    let mut specialized = specialize_scene_by(contract, &read.scene, read.sources(), &args.dynamic);
    let mut times = None;
    if let Some(clock) = clock {
        let (chosen, measured) = clock.choose(&read.scene, read.sources(), specialized, &args.dynamic)?;
        (specialized, times) = (chosen, Some(measured));
    }
    let mut names = Vec::new();
    for (draw, (left, done)) in read.scene.draws.iter().zip(specialized.scene.draws.iter().zip(&specialized.draws)) {
        if let Some(fault) = &done.fault {
            let message =
                format!("internal error: the residual of `{}` does not read back: {fault}", draw.program.name);
            return Err(Failure::new(Exit::Content, message).help("please report it with the scene"));
        }
        let stem = residuals.stem(&left.program, &done.texts);
        let [vertex, fragment] = files_of(&draw.program, read.sources());
        names.push([vertex, fragment, stem]);
    }
    Ok(Done { name: stem(name), read, specialized, names, times })
}

/// A name of `--dynamic` that no program of any scene has is a mistake.
fn check_dynamic(dynamic: &[String], scenes: &[&Scene]) -> Result<(), Failure> {
    let programs = || scenes.iter().flat_map(|scene| &scene.draws).map(|draw| &draw.program);
    let interfaces = || programs().map(|program| &program.interface);
    for name in dynamic {
        let known = programs().any(|program| is_known(program, name));
        if !known {
            let base = name.split(['[', '.']).next().unwrap_or(name);
            let leaves = interfaces().flat_map(|interface| {
                let leaves = interface.uniforms.iter().map(|leaf| leaf.name.as_str());
                leaves.chain(interface.samplers.iter().map(|slot| slot.name.as_str())).collect::<Vec<_>>()
            });
            let leaves: BTreeSet<&str> = leaves.collect();
            let bases: BTreeSet<&str> = leaves.iter().filter_map(|leaf| leaf.split(['[', '.']).next()).collect();
            // Of a member that is not there the nearest member, else the nearest uniform.
            let names = if bases.contains(base) { leaves } else { bases };
            let base = if names.iter().any(|one| one.contains('.')) { name.as_str() } else { base };
            let near = glisten_front::diagnostic::did_you_mean(base, names.iter().copied());
            let failure = Failure::usage(format!("no program has a uniform `{name}` (--dynamic)"));
            return Err(match near {
                Some(near) => failure.help(format!("did you mean `{near}`?")),
                None => failure,
            });
        }
    }
    Ok(())
}

/// Tells what could be left out.
fn checked(done: &[Done<'_>], console: &Console) -> Outcome {
    let mut text = String::new();
    for one in done {
        let count: usize = one.specialized.draws.iter().map(|draw| draw.left_out.len()).sum();
        let line = match count {
            0 if one.specialized.is_shorter_than(&one.read.scene) => {
                format!("{}: parts of expressions can be left out\n", one.name)
            }
            0 => format!("{}: nothing can be left out\n", one.name),
            1 => format!("{}: 1 thing can be left out\n", one.name),
            count => format!("{}: {count} things can be left out\n", one.name),
        };
        text.push_str(&line);
    }
    console.output(&text)?;
    Ok(Exit::Ok)
}

fn write_residual(
    args: &SpecializeArgs,
    folder: &Path,
    stem: &str,
    texts: &[(Stage, String)],
    residuals: &Residuals,
    (conventions, console): (&Conventions, &Console),
) -> Result<(), Failure> {
    let Some(program) = residuals.programs.get(stem) else { return Ok(()) };
    // What `compile` writes for it.
    let program = &optimize(program);
    let mut targets: BTreeSet<Target> = args.targets.iter().copied().collect();
    if targets.is_empty() {
        targets.extend([Target::Wgsl, Target::Spirv]);
    }
    for (stage, text) in texts {
        let name = format!("{stem}.{}", extension(*stage));
        files::write(&folder.join(&name), text.as_bytes())?;
        for target in &targets {
            match emit::emit(program, *stage, *target, conventions) {
                Ok(emitted) => {
                    files::write(&folder.join(format!("{name}.{}", target.extension())), &emitted.into_bytes())?;
                }
                Err(found) => {
                    let message = found.first().map_or_else(String::new, |found| found.message.clone());
                    let message = format!("`{name}` cannot be written as {}: {message}", target.name());
                    // Of the default targets one may lack what the program uses; the scene is written all the same.
                    if !args.targets.is_empty() {
                        return Err(Failure::new(Exit::Content, message));
                    }
                    console.remark(&format!("warning: {message}"));
                }
            }
        }
    }
    let reflection = emit::reflect(program, conventions);
    let json = serde_json::to_string_pretty(&reflection).expect("a reflection is always JSON") + "\n";
    files::write(&folder.join(format!("{stem}.json")), json.as_bytes())
}

/// Writes a scene and its account, which comes back with the pictures.
fn write_scene(
    args: &SpecializeArgs,
    folder: &Path,
    one: &Done<'_>,
    console: &Console,
) -> Result<(Account, Pictures), DrawError> {
    let shaders: Vec<ShaderFiles> = one
        .names
        .iter()
        .zip(&one.specialized.scene.draws)
        .map(|([_, _, stem], draw)| ShaderFiles::of(draw, stem))
        .collect();
    let text = write(&one.specialized.scene, &shaders);
    files::write(&folder.join(format!("{}.toml", one.name)), text.as_bytes())?;
    let (name, scene) = (one.name.clone(), one.read.scene.clone());
    let (specialized, names) = (one.specialized.clone(), one.names.clone());
    let counted = args.machine.within_time(move || {
        let drawn = pictures(&scene, &specialized.scene, Precision::F32)?;
        Ok((account(&name, &scene, &specialized, &names)?, drawn))
    });
    let (mut account, pictures) = counted?;
    account.time = one.times;
    let json = serde_json::to_string_pretty(&account).expect("an account is always JSON") + "\n";
    files::write(&folder.join(format!("{}.account.json", one.name)), json.as_bytes())?;
    if !console.is_quiet() {
        console.output(&table(&account))?;
        if let Some(times) = &account.time {
            console.output(&time::line(&account.scene, times))?;
        }
    }
    Ok((account, pictures))
}

/// Writes the page of all scenes.
fn write_page(folder: &Path, done: &[Done<'_>], drawn: &[(Account, Pictures)]) -> Result<(), Failure> {
    let scenes: Vec<SceneOnPage<'_>> = done
        .iter()
        .zip(drawn)
        .map(|(one, (account, pictures))| SceneOnPage {
            account,
            scene: &one.read.scene,
            sources: one.read.sources(),
            specialized: &one.specialized,
            pictures,
        })
        .collect();
    let page = page(&scenes).map_err(|message| Failure::new(Exit::Content, format!("internal error: {message}")))?;
    files::write(&folder.join(PAGE), page.as_bytes())
}

/// The work before and after, a line a draw.
fn table(account: &Account) -> String {
    let mut text = String::new();
    for draw in &account.draws {
        let (before, after) = (&draw.before, &draw.after);
        text.push_str(&format!(
            "{}: {}: removed {} items; SPIR-V {} -> {} instructions, operations {} -> {}\n",
            account.scene,
            draw.residual,
            draw.left_out.len(),
            before.spirv_instructions,
            after.spirv_instructions,
            before.vertex_operations + before.fragment_operations,
            after.vertex_operations + after.fragment_operations,
        ));
        let of = format!("{}: {}", account.scene, draw.residual);
        match draw.kept {
            Some("program") => {
                text.push_str(&format!("{of}: the program stays as it is, since no residual is as short\n"));
            }
            Some(kept) => {
                text.push_str(&format!("{of}: {kept} stay as they are, since the residual would be longer\n"))
            }
            None => {}
        }
        if let Some(moves) = &draw.move_to_vertex {
            for moved in &moves.moved {
                let place = format!("{}:{}", moved.file, moved.line);
                text.push_str(&format!("{of}: `{}` moved to the vertex stage, from {place}\n", moved.name));
            }
        }
        if let Some(error) = draw.error().filter(|_| account.draws.len() > 1) {
            text.push_str(&error_line(&of, &error));
        }
    }
    if let Some(error) = account.error() {
        text.push_str(&error_line(&account.scene, &error));
    }
    text
}

/// The error that the residual makes.
fn error_line(of: &str, error: &PictureError) -> String {
    let mut line = format!(
        "{of}: max error {:.3e}, RMSE {:.3e}; to the reference {:.3e} -> {:.3e}",
        error.max_abs, error.rmse, error.original.max_abs, error.residual.max_abs,
    );
    for (count, what) in
        [(error.non_finite, "no longer finite, or not before"), (error.coverage_mismatch, "covered by one alone")]
    {
        if count > 0 {
            line.push_str(&format!("; {count} pixels {what}"));
        }
    }
    line.push('\n');
    line
}
