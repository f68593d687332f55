//! `glisten lint`: validates each file, then links the programs, and reports everything that is wrong.

use crate::arguments::args::{BindingArgs, DiagnosticFormat, LevelArgs, ProgramArgs, SourceArgs};
use crate::arguments::config::Settings;
use crate::arguments::settings::numbers;
use crate::baseline::{BaselineArgs, is_unreadable};
use crate::baselines::Baselines;
use crate::batch::Batch;
use crate::cache::CacheArgs;
use crate::commands::examples::Examples;
use crate::commands::permutations;
use crate::configurations::{Extent, Listed, explored};
use crate::console::Console;
use crate::exit::{Exit, Failure, Outcome};
use crate::files;
use crate::fix::{FixArgs, Fixer};
use crate::inputs::{self, Group, Inputs};
use crate::not_checked;
use crate::process::guard;
use crate::recall::Recall;
use crate::scene_ranges::SceneRanges;
use crate::session::{Session, Unit, compile_anywhere};
use crate::strings;
use crate::trace;
use crate::witness::{self, Case, Shown};
use clap::Args;
use glisten_cost::{Assumptions, cost};
use glisten_front::compiler::Compiler;
use glisten_front::diagnostic::{Code, Diagnostic};
use glisten_front::link::Program;
use glisten_front::lint::check_some;
use glisten_front::source::{SourceMap, Span};
use glisten_verify::scene::DiskFiles;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Examples of its use.
pub(crate) const EXAMPLES: Examples = &[
    ("glisten lint shaders/", "all shaders of a folder, and the programs that they form"),
    ("glisten lint a.vert a.frag -D MAX_LIGHTS=4 -I include", "one program, with a macro and a folder of includes"),
    ("glisten lint . --deny warnings --format github", "in CI: annotations on the changed lines"),
    ("glisten lint pack/ --engine iris", "sources that an engine completes"),
];

/// Check shaders and the programs that they form
#[derive(Args, Debug)]
#[command(mut_arg("diagnostics", |argument| argument.hide(true)))]
pub(crate) struct LintArgs {
    /// Shaders, folders to search for shaders, or `-` for standard input (default: the current folder)
    #[arg(value_name = "FILE|DIR")]
    files: Vec<PathBuf>,
    #[command(flatten)]
    programs: ProgramArgs,
    #[command(flatten)]
    sources: SourceArgs,
    #[command(flatten)]
    levels: LevelArgs,
    /// The format of findings (`--diagnostics` of other commands)
    #[arg(long, value_enum, conflicts_with = "diagnostics")]
    format: Option<DiagnosticFormat>,
    /// Check each program as each of the macros that its conditions ask for would have it
    #[arg(long, conflicts_with_all = ["fix", "unsafe_fixes"])]
    configurations: bool,
    /// Check the variants of the programs in this file, in the format of `compile --permutations`
    #[arg(long, value_name = "FILE", conflicts_with_all = ["fix", "unsafe_fixes", "files", "configurations"])]
    permutations: Option<PathBuf>,
    /// Check the shaders in the strings of JavaScript, TypeScript, Rust, Python, C and C++, too
    #[arg(long)]
    embedded: bool,
    /// Write a scene for each finding on numerics into this folder, which shows it with the inputs that the finding names
    #[arg(long, value_name = "DIR", conflicts_with_all = ["configurations", "permutations"])]
    witnesses: Option<PathBuf>,
    /// Take what the uniforms and attributes of this scene are as the ranges of inputs of the shaders that it draws
    #[arg(long, value_name = "SCENE", conflicts_with_all = ["configurations", "permutations"])]
    scene: Vec<PathBuf>,
    #[command(flatten)]
    fixes: FixArgs,
    #[command(flatten)]
    baseline: BaselineArgs,
    #[command(flatten)]
    bindings: BindingArgs,
    #[command(flatten)]
    cache: CacheArgs,
    /// The number of threads (0: one per core)
    #[arg(short, long, default_value_t = 0, value_name = "N")]
    jobs: usize,
}

impl LintArgs {
    /// Whether each program is checked once and as it is on the disk, so that what was found may be kept.
    fn is_plain(&self) -> bool {
        let is_once = !self.configurations && self.permutations.is_none();
        is_once && !self.fixes.any() && self.witnesses.is_none()
    }

    /// The cache of findings, if there is one.
    fn recall(&self, session: &Session<'_>, scenes: &SceneRanges) -> Result<Option<Recall>, Failure> {
        if !self.is_plain() {
            return Ok(None);
        }
        let options = format!("{:?} {scenes:?}", self.levels.levels()?);
        let (engines, sources) = (session.engines(), &self.sources);
        Recall::of_findings(&self.cache, engines, sources, &self.bindings, &options).map(Some)
    }
}

/// Runs the command.
pub(crate) fn run(args: &LintArgs, console: &Console) -> Outcome {
    let mut session = Session::new(console, &args.sources, &args.bindings, &args.levels, args.jobs)?;
    session.set_format(args.format.unwrap_or(args.levels.diagnostics));
    session.offer_fixes();
    let mut listed = Listed::new();
    let mut inputs = match &args.permutations {
        None => {
            let named = inputs::named_or_here(&args.files, &args.programs);
            let (hosts, named) = if args.embedded { strings::split(named) } else { (Vec::new(), named) };
            let mut inputs = inputs::collect(&named, &args.programs, &args.sources, true)?;
            if args.embedded {
                strings::add(&mut inputs, &hosts, &named)?;
            }
            inputs
        }
        Some(file) => {
            let programs = match permutations::programs(file) {
                Ok(programs) => programs,
                Err(batch) => return session.tell(&[&batch], true),
            };
            let mut inputs = Inputs::default();
            for program in programs {
                let group = inputs::program(&program.files, &args.programs, &args.sources)?;
                inputs.groups.push(Group { name: program.name.clone(), ..group });
                listed.insert(program.name, program.variants);
            }
            inputs
        }
    };
    inputs.mark_guesses();
    inputs.tell_empty_folders(console);
    inputs.tell_lone_programs(console);
    let mut baselines = Baselines::given(&args.baseline)?;
    let groups = std::mem::take(&mut inputs.groups);
    let scenes = SceneRanges::read(&args.scene, session.compiler())?;
    let recall = args.recall(&session, &scenes)?;
    let (mut units, shown) = checked(&mut session, groups.clone(), &inputs, &scenes, recall.as_ref());
    if let Some(recall) = &recall {
        recall.close(console);
    }
    if let Some(folder) = &args.witnesses {
        write_all(folder, &shown, console)?;
    }
    if args.configurations || args.permutations.is_some() {
        let (all, extent) = explored(&mut session, units, &listed, &inputs.found, lints);
        units = all;
        if session.is_human() {
            console.remark(&told(&extent));
        }
    }
    baselines.complete(&args.baseline, &mut session, &units)?;
    if args.baseline.updates() {
        baselines.update(&mut session, &units, console)?;
        let unread = units.iter().flat_map(|unit| &unit.unread);
        let unreadable: Vec<&Batch> = unread.filter(|batch| is_unreadable(batch)).collect();
        return if unreadable.is_empty() { Ok(Exit::Ok) } else { session.tell(&unreadable, true) };
    }
    baselines.apply(&mut units, Some(console).filter(|_| session.is_human()));
    if !args.fixes.any() {
        return session.tell_units(&units, true);
    }
    if groups.iter().flat_map(|group| &group.inputs).any(|input| input.path.is_none()) {
        let message = "fixes change files, and standard input is none";
        return Err(Failure::usage(message).help("name the file; `--format json` has the fixes of standard input"));
    }
    let mut fixer = Fixer::new(args.fixes);
    while fixer.advance(&units) {
        (units, _) = checked(&mut session, groups.clone(), &inputs, &scenes, None);
        baselines.apply(&mut units, None);
    }
    let (exit, has_old_texts) = fixer.finish(session.is_human(), console)?;
    if has_old_texts {
        (units, _) = checked(&mut session, groups, &inputs, &scenes, None);
        baselines.apply(&mut units, None);
    }
    // Standard output has the diff, and findings for people are apart from it; a document for programs takes its place there.
    Ok(session.tell_units(&units, !(args.fixes.prints() && session.is_human()))?.max(exit))
}

/// How many configurations were looked at, for people.
fn told(extent: &Extent) -> String {
    let count = |n: usize, what: &str| format!("{n} {what}{}", if n == 1 { "" } else { "s" });
    let Extent { programs, configurations, compiled, branches, unreached } = *extent;
    let branches = match unreached {
        0 => format!("all of {} reached", count(branches, "branch").replace("branchs", "branches")),
        _ => format!("{} of {branches} branches reached", branches - unreached),
    };
    let programs = count(programs, "program");
    format!("{} of {programs}, {compiled} of them different; {branches}", count(configurations, "configuration"))
}

/// Writes the scenes that show findings.
fn write_all(folder: &Path, shown: &[Shown], console: &Console) -> Result<(), Failure> {
    if shown.is_empty() {
        return Ok(());
    }
    files::make_folder(folder)?;
    for Shown { name, scene, made: (extension, text) } in shown {
        // A search of folders also finds those of an earlier run.
        files::replace(&folder.join(format!("{name}.{extension}")), text.as_bytes())?;
        files::replace(&folder.join(format!("{name}.toml")), scene.as_bytes())?;
    }
    let count = if shown.len() == 1 { "a scene".to_owned() } else { format!("{} scenes", shown.len()) };
    console.remark(&format!("{count} in {}: `glisten stability` shows where the numbers are born", folder.display()));
    Ok(())
}

/// Compiles the groups, and adds the findings of the rules, those on numerics with what shows them. What a cache knows is taken from it.
fn checked(
    session: &mut Session<'_>,
    groups: Vec<Group>,
    inputs: &Inputs,
    scenes: &SceneRanges,
    recall: Option<&Recall>,
) -> (Vec<Unit>, Vec<Shown>) {
    let mut units = match recall {
        Some(recall) => recalled(session, groups, recall),
        None => session.compile(groups),
    };
    let (found, shown) = found(session, &units, &[], scenes, recall);
    for (unit, found) in units.iter_mut().zip(found) {
        session.add(&mut unit.batch, found);
    }
    certain(session, &mut units);
    not_checked::settle(session, &mut units, inputs);
    (units, shown)
}

/// Compiles the groups, or takes what was found from a cache. What the strings of a file lack depends on more than the file.
fn recalled(session: &mut Session<'_>, groups: Vec<Group>, recall: &Recall) -> Vec<Unit> {
    let engines = session.engines().clone();
    session.compile_by(groups, |compiler, group| {
        if group.inputs.iter().any(strings::is_in_string) {
            return compile_anywhere(compiler, &engines, group);
        }
        recall.compile_by(group, "", |group| {
            let compiled = compile_anywhere(compiler, &engines, group);
            compiled.0.batch.sources.files().for_each(|(_, file)| trace::settings_of(file.name()));
            compiled
        })
    })
}

/// Drops the findings of units that depend on what their strings leave open.
fn certain(session: &Session<'_>, units: &mut [Unit]) {
    for unit in units {
        let Some(input) = unit.group.inputs.first().filter(|input| strings::is_in_string(input)) else { continue };
        let Ok(text) = files::read_source(&input.name, input.path.as_deref()) else { continue };
        let again = |group| Some(compile_anywhere(session.compiler(), session.engines(), group).0.batch);
        strings::keep_certain(&unit.group, &text, &mut unit.batch, again);
    }
}

/// The findings of the rules in units that these compilers have compiled.
fn lints(session: &mut Session<'_>, units: &[Unit], compilers: &[Compiler]) -> Vec<Vec<Diagnostic>> {
    found(session, units, compilers, &SceneRanges::default(), None).0
}

/// By how much less inputs are tried for one of many configurations.
const HASTE: u64 = 4;

/// The findings of the rules in each unit, and what costs more than the project allows, in parallel. Rules that the levels of all
/// its files turn off are not run. A unit without a compiler of its own has that of the session. What is found is kept in the cache,
/// if there is one.
fn found(
    session: &mut Session<'_>,
    units: &[Unit],
    compilers: &[Compiler],
    scenes: &SceneRanges,
    recall: Option<&Recall>,
) -> (Vec<Vec<Diagnostic>>, Vec<Shown>) {
    let mut settings_of = |unit: &Unit| -> Vec<Arc<Settings>> {
        let files = unit.batch.sources.files().map(|(_, file)| file.name());
        if unit.kept.is_some() { Vec::new() } else { files.map(|name| session.settings_of(name)).collect() }
    };
    let settings: Vec<Vec<Arc<Settings>>> = units.iter().map(&mut settings_of).collect();
    let compiler = session.compiler();
    let found = |(number, (unit, settings)): (usize, (&Unit, Vec<Arc<Settings>>))| {
        let wanted = |code: &Code| settings.iter().any(|settings| settings.levels.may_report(code));
        let check = |program: &Program| {
            let sources = &unit.batch.sources;
            let mut found = check_some(program, sources, wanted);
            found.extend(over_budget(program, sources, &settings));
            // What is stated takes precedence over scenes.
            let mut ranges = settings.first().map_or_else(Vec::new, |settings| settings.ranges.clone());
            let paths = unit.group.inputs.iter().filter_map(|input| input.path.as_deref());
            ranges.extend(paths.flat_map(|path| scenes.of(path)));
            let own = compilers.get(number);
            let case = Case {
                group: &unit.group,
                program,
                sources,
                ranges: &ranges,
                compiler: own.unwrap_or(compiler),
                files: &DiskFiles,
                haste: if own.is_some() { HASTE } else { 1 },
            };
            witness::settle(&case, wanted, found)
        };
        if let Some(kept) = &unit.kept {
            return (kept.notes.clone(), Vec::new());
        }
        let (found, trace) = trace::recorded(|| unit.program.as_ref().map(|program| guard::guarded(|| check(program))));
        if let Some(recall) = recall.filter(|_| !matches!(found, Some(Err(_)))) {
            let notes = found.as_ref().and_then(|found| found.as_ref().ok()).map_or(&[][..], |(notes, _)| notes);
            recall.keep_found(unit, &trace, notes);
        }
        found.map_or_else(Default::default, |found| {
            let first = unit.batch.sources.files().next().map_or(0, |(_, file)| file.base());
            found.unwrap_or_else(|panic| (vec![guard::diagnostic(&panic, Span::new(first, first))], Vec::new()))
        })
    };
    let all: Vec<(Vec<Diagnostic>, Vec<Shown>)> =
        session.threads().map(units.iter().zip(settings).enumerate().collect(), found);
    let (found, shown): (Vec<_>, Vec<_>) = all.into_iter().unzip();
    (found, shown.into_iter().flatten().collect())
}

/// The costs of the stages of a program beyond the budgets of their files.
fn over_budget(program: &Program, sources: &SourceMap, settings: &[Arc<Settings>]) -> Vec<Diagnostic> {
    let mut found = Vec::new();
    if settings.iter().all(|settings| settings.budgets.is_empty()) {
        return found;
    }
    for shader in &program.stages {
        let Some(file) = shader.origin.file.map(|file| sources.file(file).name()) else { continue };
        let mut budgets = settings.iter().filter_map(|settings| Some((settings, settings.budgets.of(file)?)));
        let Some((settings, budget)) = budgets.next() else { continue };
        let mut assumptions = Assumptions::default();
        assumptions.iterations = budget.iterations.unwrap_or(assumptions.iterations);
        assumptions.ranges = numbers(&settings.ranges);
        let cost = cost(program, sources, &assumptions);
        for stage in cost.stages.iter().filter(|stage| stage.stage == shader.stage.name()) {
            found.extend(budget.check(&cost, stage));
        }
    }
    found
}
