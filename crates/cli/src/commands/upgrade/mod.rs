//! `glisten upgrade`: rewrites old shaders as 1.50 core, 3.30, 4.50, 4.60, ES 3.00 or for Vulkan.
//!
//! *In:* the files of programs that compile, or folders. *Out:* their new texts, and those of the files that they include, which
//! compile, too, on standard output or in files; with `--scene`, the proof that the picture stays. *Holds:* nothing is written
//! unless all new texts are valid and the picture is the same.

mod programs;
mod prove;

pub(crate) use programs::{ByPlan, checker, plan, plan_of_newer, words};
pub(crate) use prove::NewFiles;

use crate::arguments::args::{BindingArgs, LevelArgs, ProgramArgs, SourceArgs};
use crate::batch::Batch;
use crate::commands::examples::Examples;
use crate::console::Console;
use crate::exit::{Exit, Failure, Outcome};
use crate::files;
use crate::inputs::{self, Input, Inputs};
use crate::session::{Session, Unit};
use clap::{Args, ValueEnum};
use glisten_front::compiler::Source;
use glisten_upgrade::{Dialect, NewFile, NewTree, Plan, Target, TreeProgram, tree, with_version};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Examples of its use.
pub(crate) const EXAMPLES: Examples = &[
    ("glisten upgrade old.frag", "the text as GLSL 1.50 core"),
    ("glisten upgrade a.vert a.frag --to 330 -o new", "a program as GLSL 3.30"),
    ("glisten upgrade a.vert a.frag --in-place --scene a.toml", "if the picture of a scene stays the same"),
];

/// Rewrite old shaders (GLSL 1.10 to 1.40, compatibility, ES 1.00) as 1.50 core, 3.30, 4.50, 4.60, ES 3.00 or for Vulkan
#[derive(Args, Debug)]
pub(crate) struct UpgradeArgs {
    /// The shaders, or folders to search for them; files of one program are rewritten together, so that their stages still fit
    #[arg(required_unless_present = "programs", value_name = "FILE|DIR")]
    files: Vec<PathBuf>,
    /// The language to write
    #[arg(long, value_enum, default_value_t, value_name = "VERSION")]
    to: ToArg,
    /// Write the new files into this folder (default: standard output, for a single file)
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Replace the files
    #[arg(long, conflicts_with = "output")]
    in_place: bool,
    /// A scene of the program, whose picture has to stay the same to the bit on the reference (repeatable)
    #[arg(long = "scene", value_name = "SCENE.toml")]
    scenes: Vec<String>,
    #[command(flatten)]
    programs: ProgramArgs,
    #[command(flatten)]
    sources: SourceArgs,
    #[command(flatten)]
    levels: LevelArgs,
}

/// The language to write, on the command line.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
enum ToArg {
    /// GLSL 1.50, core profile
    #[default]
    #[value(name = "150")]
    Core150,
    /// GLSL 3.30, core profile
    #[value(name = "330")]
    Core330,
    /// GLSL 4.50, core profile
    #[value(name = "450")]
    Core450,
    /// GLSL 4.60, core profile
    #[value(name = "460")]
    Core460,
    /// GLSL ES 3.00
    #[value(name = "300es", alias = "300-es")]
    Es300,
    /// GLSL 4.50 for Vulkan: sets, bindings, locations, a block for the loose uniforms
    #[value(name = "vulkan")]
    Vulkan,
}

impl From<ToArg> for Target {
    fn from(to: ToArg) -> Self {
        match to {
            ToArg::Core150 => Self::Core150,
            ToArg::Core330 => Self::Core330,
            ToArg::Core450 => Self::Core450,
            ToArg::Core460 => Self::Core460,
            ToArg::Es300 => Self::Es300,
            ToArg::Vulkan => Self::Vulkan,
        }
    }
}

/// A file with its new text.
pub(crate) struct Upgraded {
    pub(crate) input: Input,
    pub(crate) text: String,
}

impl Upgraded {
    pub(crate) fn source(&self) -> Source {
        let (name, stage) = (self.input.name.clone(), self.input.stage);
        Source { name, text: self.text.as_str().into(), stage }
    }
}

/// Runs the command.
pub(crate) fn run(args: &UpgradeArgs, console: &Console) -> Outcome {
    let scans = args.output.is_some() || args.in_place;
    let inputs = inputs::collect(&args.files, &args.programs, &args.sources, scans)?;
    inputs.tell_empty_folders(console);
    inputs.tell_without_stage(console);
    let n_files: usize = inputs.groups.iter().map(|group| group.inputs.len()).sum();
    if n_files > 1 && args.output.is_none() && !args.in_place {
        let failure = Failure::usage("cannot write several files to standard output");
        return Err(failure.help("add `-o DIR` or `--in-place`"));
    }
    if args.in_place && inputs.groups.iter().flat_map(|group| &group.inputs).any(|input| input.path.is_none()) {
        let failure = Failure::usage("standard input has no place to be rewritten in");
        return Err(failure.help("leave `--in-place` out"));
    }
    let has_parts = inputs.groups.iter().flat_map(|group| &group.inputs).find(|input| input.part.is_some());
    if let Some(input) = has_parts.filter(|_| args.output.is_none() || !args.scenes.is_empty()) {
        let failure = Failure::usage(format!("`{}` contains several stages, each of which becomes a file", input.name));
        return Err(failure.help("add `-o DIR`, without `--scene`"));
    }
    let places = Places::new(args, &inputs);
    let mut session = Session::new(console, &args.sources, &BindingArgs::default(), &args.levels, 0)?;
    let units = session.compile(inputs.groups);
    let batches: Vec<&Batch> = units.iter().flat_map(Unit::batches).collect();
    let exit = units.iter().map(Unit::exit).max().unwrap_or_default();
    if exit > Exit::Ok {
        return session.tell(&batches, false);
    }
    session.tell(&[], false)?;
    let words = words(&units);
    let (mut texts, mut trees) = (Vec::new(), Vec::new());
    for unit in &units {
        let plan =
            plan(unit, session.compiler(), args.to.into(), &words).map_err(|refused| programs::failure(&refused))?;
        let compiler = |plan: &Arc<Plan>| checker(&args.sources, session.compiler(), plan);
        let new = ByPlan::new(unit, plan, &Upgraded::source, &compiler)?;
        new.plan.notes.iter().for_each(|note| console.remark(&format!("note: {note}")));
        let exit = programs::check(&new, &mut session)?;
        if exit > Exit::Ok {
            return Ok(exit);
        }
        for scene in &args.scenes {
            prove::prove(scene, &new.texts, &new.plan, session.compiler(), &new.compiler, console)?;
        }
        trees.push(TreeProgram { compiler: new.compiler, sources: new.sources });
        texts.extend(new.texts);
    }
    let dialect = (args.to == ToArg::Vulkan).then(Dialect::default);
    let new = tree(&trees, dialect.as_ref());
    for note in &new.notes {
        console.remark(&format!("note: {}:{}: {}", note.file, note.line, note.text));
    }
    refusal(&units, &new, args.to)?;
    let changed = changed(&units, &new);
    write(args, console, &texts, &new, &changed, &places)
}

/// The failure of the first program that is left out.
fn refusal(units: &[Unit], new: &NewTree, to: ToArg) -> Result<(), Failure> {
    let refused = units.iter().zip(&new.refused).find_map(|(unit, reason)| Some((unit, reason.as_ref()?)));
    let Some((unit, reason)) = refused else { return Ok(()) };
    let names: Vec<&str> = unit.group.inputs.iter().map(|input| input.name.as_str()).collect();
    let goal = if to == ToArg::Vulkan { " for Vulkan" } else { "" };
    let failure = Failure::new(Exit::Content, format!("`{}` cannot be rewritten{goal}: {reason}", names.join("`, `")));
    Err(if to == ToArg::Vulkan {
        failure.help("`glisten compile --target glsl --glsl-version vulkan` writes new texts for any program")
    } else {
        failure
    })
}

/// The included files whose texts change.
fn changed<'t>(units: &[Unit], new: &'t NewTree) -> Vec<&'t NewFile> {
    let is_same = |file: &NewFile| {
        let mut files = units.iter().flat_map(|unit| unit.batch.sources.files());
        files.any(|(_, old)| old.name() == file.name && **old.text() == *file.text)
    };
    new.files.iter().filter(|file| !file.is_source && (file.stage.is_some() || !is_same(file))).collect()
}

/// Where new files go.
struct Places {
    /// For each input, its folder below that of all outputs.
    below: Vec<(Input, PathBuf)>,
    /// The folders of the inputs, or those that the command line names.
    roots: Vec<PathBuf>,
}

impl Places {
    fn new(args: &UpgradeArgs, inputs: &Inputs) -> Self {
        let folder_of = inputs.below();
        let of_group = |group: &inputs::Group| {
            let folder = folder_of(group);
            group.inputs.iter().map(move |input| (input.clone(), folder.clone())).collect::<Vec<_>>()
        };
        let below: Vec<(Input, PathBuf)> = inputs.groups.iter().flat_map(of_group).collect();
        let named = args.files.iter().filter(|path| path.is_dir()).cloned();
        let own = below.iter().filter_map(|(input, _)| input.path.as_deref()?.parent().map(Path::to_owned));
        // The folder of a plain file name is this one.
        let roots = named.chain(own).filter_map(|path| std::path::absolute(Path::new(".").join(path)).ok()).collect();
        Self { below, roots }
    }

    /// The place of a source.
    fn of_input(&self, input: &Input) -> PathBuf {
        let folder = self.below.iter().find(|(other, _)| other == input).map(|(_, folder)| folder.clone());
        folder.unwrap_or_default().join(input.file_name())
    }

    /// The place of an included file below the folder of all outputs, if it is in one of the folders.
    fn of_part(&self, file: &NewFile) -> Option<PathBuf> {
        let path = std::path::absolute(file.new_name()).ok()?;
        let relative = self.roots.iter().find_map(|root| path.strip_prefix(root).ok())?;
        Some(relative.to_owned())
    }
}

fn write(
    args: &UpgradeArgs,
    console: &Console,
    texts: &[Upgraded],
    new: &NewTree,
    changed: &[&NewFile],
    places: &Places,
) -> Outcome {
    let is_written = args.output.is_some() || args.in_place;
    let mut written: Vec<(PathBuf, String)> = Vec::new();
    for upgraded in texts {
        let input = &upgraded.input;
        let fits = |file: &&NewFile| {
            file.is_source && file.name == input.name && file.stage.is_none_or(|stage| stage == input.stage)
        };
        let text = new.files.iter().find(fits).map_or(upgraded.text.as_str(), |file| file.text.as_str());
        match (&args.output, &input.path) {
            (Some(folder), _) => written.push((folder.join(places.of_input(input)), text.to_owned())),
            (None, Some(path)) if args.in_place => written.push((path.clone(), text.to_owned())),
            _ => console.output(text)?,
        }
    }
    for file in changed {
        let old = std::fs::read_to_string(&file.name).unwrap_or_default();
        let text = with_version(&old, &file.text);
        let place = match &args.output {
            Some(folder) => places.of_part(file).map(|part| folder.join(part)),
            None => args.in_place.then(|| PathBuf::from(file.new_name())),
        };
        match place {
            Some(path) => written.push((path, text)),
            None if args.to == ToArg::Vulkan => {
                let failure = Failure::usage(format!("`{}` changes, too, and nothing was written", file.name));
                let help = if is_written { "name the folder that has it and its programs" } else { "add `-o DIR`" };
                return Err(failure.help(help));
            }
            None if is_written => {
                let what =
                    "is included, has to change, too, and is in none of the folders; name the folder that has it";
                console.remark(&format!("note: `{}` {what}", file.name));
            }
            None => {}
        }
    }
    written.sort();
    written.dedup();
    if args.in_place {
        // Files that include each other change together or not at all.
        written.iter().try_for_each(|(path, _)| files::check_replaceable(path))?;
    }
    for (path, text) in written {
        if let Some(folder) = path.parent().filter(|folder| !folder.as_os_str().is_empty()) {
            files::make_folder(folder)?;
        }
        let write = if args.in_place { files::replace } else { files::write };
        write(&path, text.as_bytes())?;
        console.remark(&format!("wrote {}", path.display()));
    }
    Ok(Exit::Ok)
}
