//! `glisten upgrade`: rewrites old shaders as 1.50 core, 3.30, 4.50, 4.60 or ES 3.00.
//!
//! *In:* the files of programs that compile. *Out:* their new texts, which compile, too, on standard output or in files; with
//! `--scene`, the proof that the picture stays. *Holds:* nothing is written unless all new texts are valid and the picture is
//! the same.

use super::args::{BindingArgs, LevelArgs, ProgramArgs, SourceArgs};
use super::batch::Batch;
use super::console::Console;
use super::engine::Engines;
use super::exit::{Exit, Failure, Outcome};
use super::files;
use super::inputs::{self, Input};
use super::session::{Session, Unit};
use crate::engines;
use crate::scene::{self, DiskFiles, Scene};
use crate::upgrade::{Plan, Refused, Target, Text, completed, plan_of, rewrite, to_vulkan};
use clap::{Args, ValueEnum};
use glisten_front::Stage;
use glisten_front::compiler::{Compiler, Preparation, Prepared, Source};
use glisten_front::source::version_line;
use glisten_reference::{Precision, RenderOptions};
use glisten_scene::{FileError, FileSource};
use std::collections::BTreeMap;
use std::fs;
use std::path::PathBuf;
use std::sync::Arc;

/// Rewrite old shaders (GLSL 1.10 to 1.40, compatibility, ES 1.00) as 1.50 core, 3.30, 4.50, 4.60 or ES 3.00
#[derive(Args, Debug)]
pub(super) struct UpgradeArgs {
    /// The shaders; files of one program are rewritten together, so that their stages still fit
    #[arg(required_unless_present = "programs", value_name = "FILE")]
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
struct Upgraded {
    input: Input,
    text: String,
}

impl Upgraded {
    fn source(&self) -> Source {
        let (name, stage) = (self.input.name.clone(), self.input.stage);
        Source { name, text: self.text.as_str().into(), stage }
    }
}

/// Runs the command.
pub(super) fn run(args: &UpgradeArgs, console: &Console) -> Outcome {
    let inputs = inputs::collect(&args.files, &args.programs, &args.sources, false)?;
    let n_files: usize = inputs.groups.iter().map(|group| group.inputs.len()).sum();
    if n_files > 1 && args.output.is_none() && !args.in_place {
        let failure = Failure::usage("cannot write several files to standard output");
        return Err(failure.help("add `-o DIR` or `--in-place`"));
    }
    let has_parts = inputs.groups.iter().flat_map(|group| &group.inputs).find(|input| input.part.is_some());
    if let Some(input) = has_parts.filter(|_| args.output.is_none() || !args.scenes.is_empty()) {
        let failure = Failure::usage(format!("`{}` contains several stages, each of which becomes a file", input.name));
        return Err(failure.help("add `-o DIR`, without `--scene`"));
    }
    let mut session = Session::new(console, &args.sources, &BindingArgs::default(), &args.levels, 0)?;
    let units = session.compile(inputs.groups);
    let batches: Vec<&Batch> = units.iter().flat_map(|unit| unit.unread.iter().chain([&unit.batch])).collect();
    let exit = units.iter().map(Unit::exit).max().unwrap_or_default();
    if exit > Exit::Ok {
        return session.tell(&batches, false);
    }
    let mut written = Vec::new();
    for unit in &units {
        let plan = Arc::new(plan(unit, session.compiler(), args.to.into())?);
        plan.notes.iter().for_each(|note| console.remark(&format!("note: {note}")));
        let texts = rewritten(unit, &plan);
        let compiler = checker(args, session.compiler(), &plan)?;
        let exit = check(&compiler, &mut session, &texts)?;
        if exit > Exit::Ok {
            return Ok(exit);
        }
        for scene in &args.scenes {
            prove(scene, &texts, &plan, session.compiler(), &compiler, console)?;
        }
        written.extend(if args.to == ToArg::Vulkan { for_vulkan(&compiler, texts)? } else { texts });
    }
    write(args, console, &written)
}

/// The text of an input, as it was compiled. The stages of one file have one name, and their order.
fn text_of<'s>(unit: &'s Unit, input: &Input) -> &'s str {
    let before = unit.group.inputs.iter().take_while(|other| other.stage != input.stage);
    let index = before.filter(|other| other.name == input.name).count();
    let mut files = unit.batch.sources.files().filter(|(_, file)| file.name() == input.name);
    files.nth(index).map_or("", |(_, file)| file.text())
}

/// The number of the version of a stage.
fn version_of(unit: &Unit, stage: Stage) -> u16 {
    unit.program.as_ref().and_then(|program| program.stage(stage)).map_or(110, |shader| shader.version.number)
}

/// The plan of a program.
fn plan(unit: &Unit, compiler: &Compiler, target: Target) -> Result<Plan, Failure> {
    let source = |input: &Input| {
        let (name, text) = (input.name.clone(), text_of(unit, input).into());
        Source { name, text, stage: input.stage }
    };
    let sources: Vec<Source> = unit.group.inputs.iter().map(source).collect();
    let versions: Vec<(&Source, u16)> = sources.iter().map(|source| (source, version_of(unit, source.stage))).collect();
    plan_of(compiler, &versions, target).map_err(|refused| {
        let failure = Failure::new(Exit::Content, refused.to_string());
        match refused {
            Refused::Newer { version: 300, .. } => failure.help("add `--to 300es`"),
            Refused::Newer { version, .. } if version <= 330 => failure.help("add `--to 330`"),
            Refused::Newer { version, .. } if version <= 450 => failure.help("add `--to 450`"),
            Refused::NoCounterpart(_) => {
                failure.help("write it in the terms of GLSL 1.50 first; for `gl_ClipVertex`, that is `gl_ClipDistance`")
            }
            _ => failure,
        }
    })
}

fn rewritten(unit: &Unit, plan: &Plan) -> Vec<Upgraded> {
    let upgraded = |input: &Input| {
        let text = text_of(unit, input);
        let version = version_of(unit, input.stage);
        let text = rewrite(&Text { text, stage: input.stage, is_shader: true, version }, plan);
        let text = if input.part.is_some() { alone(input, &text) } else { text };
        Upgraded { input: input.clone(), text }
    };
    unit.group.inputs.iter().map(upgraded).collect()
}

/// The new text of a stage of a file that contains several, as a file of its own: with the macros that select the stage, and
/// without the gaps that the others leave.
fn alone(input: &Input, text: &str) -> String {
    let file = files::read_source(&input.name, input.path.as_deref()).ok();
    let part = input.part.as_ref().zip(file);
    let defines = part.map(|(part, file)| part.defines(&file, input.stage)).unwrap_or_default();
    let version = version_line(text).map_or("", |line| text.get(line).unwrap_or(""));
    let mut alone = String::new();
    for line in text.lines() {
        if line.trim().is_empty() && (alone.is_empty() || alone.ends_with("\n\n")) {
            continue;
        }
        alone.push_str(line.trim_end());
        alone.push('\n');
        if line == version {
            defines.iter().for_each(|(name, value)| alone.push_str(&format!("#define {name} {value}\n")));
        }
    }
    alone
}

/// A compiler that upgrades what the new texts include and what engines put before them.
fn checker(args: &UpgradeArgs, compiler: &Compiler, plan: &Arc<Plan>) -> Result<Compiler, Failure> {
    let preparation = Upgrading { engines: Engines::new(&args.sources)?, plan: Arc::clone(plan) };
    Ok(compiler.clone().with_preparation(preparation))
}

/// Compiles the new texts and reports what is wrong with them.
fn check(compiler: &Compiler, session: &mut Session<'_>, texts: &[Upgraded]) -> Result<Exit, Failure> {
    let compilation = compiler.compile(&texts.iter().map(Upgraded::source).collect::<Vec<_>>());
    let mut batch = Batch { sources: compilation.sources, diagnostics: Vec::new() };
    session.add(&mut batch, compilation.diagnostics.into_iter().filter(glisten_front::Diagnostic::is_error));
    if batch.diagnostics.is_empty() {
        return Ok(Exit::Ok);
    }
    session.tell(&[&batch], false)?;
    let names: Vec<&str> = texts.iter().map(|upgraded| upgraded.input.name.as_str()).collect();
    let message = format!("the new text of `{}` is not valid, and nothing was written", names.join("`, `"));
    Err(Failure::new(Exit::Content, message)
        .help("the errors above are at lines of the new text; change the old one there"))
}

/// The texts by the rules of Vulkan.
fn for_vulkan(compiler: &Compiler, texts: Vec<Upgraded>) -> Result<Vec<Upgraded>, Failure> {
    let sources: Vec<Source> = texts.iter().map(Upgraded::source).collect();
    let new = to_vulkan(compiler, &sources).map_err(|reason| {
        let names: Vec<&str> = texts.iter().map(|upgraded| upgraded.input.name.as_str()).collect();
        Failure::new(Exit::Content, format!("`{}` cannot be rewritten for Vulkan: {reason}", names.join("`, `")))
            .help("`glisten compile --target glsl --glsl-version vulkan` writes new texts for any program")
    })?;
    Ok(texts.into_iter().zip(new).map(|(old, text)| Upgraded { text, ..old }).collect())
}

/// Draws a scene with the old and with the new texts.
fn prove(
    path: &str,
    texts: &[Upgraded],
    plan: &Plan,
    old: &Compiler,
    new: &Compiler,
    console: &Console,
) -> Result<(), Failure> {
    let before = load(path, &DiskFiles, old)?;
    let files: BTreeMap<PathBuf, &str> = texts
        .iter()
        .filter_map(|upgraded| Some((fs::canonicalize(upgraded.input.path.as_ref()?).ok()?, upgraded.text.as_str())))
        .collect();
    let after = load(path, &NewFiles { scene: path, files, plan }, new)?;
    let options = RenderOptions { precision: Precision::F32, mark_edges: false, ..RenderOptions::default() };
    let failed = |_| Failure::new(Exit::Content, format!("`{path}` cannot be drawn"));
    let before = glisten_reference::render(&before, &options).map_err(failed)?;
    let after = glisten_reference::render(&after, &options).map_err(failed)?;
    match before.bit_unequal(&after) {
        0 => {
            console.remark(&format!("{path}: the picture is the same to the bit"));
            Ok(())
        }
        n => Err(Failure::new(
            Exit::Content,
            format!("{path}: {n} values of the picture change, and nothing was written"),
        )),
    }
}

fn load(path: &str, files: &dyn FileSource, compiler: &Compiler) -> Result<Scene, Failure> {
    let loaded = scene::load(path, files, compiler);
    loaded.scene.ok_or_else(|| {
        let first = loaded.diagnostics.iter().find(|found| found.is_error());
        let why = first.map_or(String::new(), |error| format!(": {}", error.message));
        let exit = if loaded.io_error { Exit::Usage } else { Exit::Content };
        Failure::new(exit, format!("the scene `{path}` does not load{why}"))
    })
}

fn write(args: &UpgradeArgs, console: &Console, texts: &[Upgraded]) -> Outcome {
    if let Some(folder) = &args.output {
        fs::create_dir_all(folder)
            .map_err(|error| Failure::usage(format!("cannot create `{}`: {error}", folder.display())))?;
    }
    for upgraded in texts {
        let path = match (&args.output, &upgraded.input.path) {
            (Some(folder), _) => folder.join(upgraded.input.file_name()),
            (None, Some(path)) if args.in_place => path.clone(),
            _ => {
                console.output(&upgraded.text)?;
                continue;
            }
        };
        files::write(&path, upgraded.text.as_bytes())?;
        console.remark(&format!("wrote {}", path.display()));
    }
    Ok(Exit::Ok)
}

/// The files of the disk, with the new texts in place of the old ones, and new names in the scene.
struct NewFiles<'a> {
    scene: &'a str,
    files: BTreeMap<PathBuf, &'a str>,
    plan: &'a Plan,
}

impl FileSource for NewFiles<'_> {
    fn read(&self, path: &str) -> Result<Vec<u8>, FileError> {
        if let Some(text) = fs::canonicalize(path).ok().and_then(|path| self.files.get(&path)) {
            return Ok(text.as_bytes().to_vec());
        }
        let bytes = DiskFiles.read(path)?;
        if path != self.scene {
            return Ok(bytes);
        }
        let text = String::from_utf8_lossy(&bytes).into_owned();
        let mut new = String::new();
        let mut at = 0;
        for (start, word) in engines::code::words(&text) {
            let Some(name) = self.plan.renamed(word).filter(|_| word.starts_with("gl_")) else { continue };
            new.push_str(text.get(at..start).unwrap_or(""));
            new.push_str(name);
            at = start + word.len();
        }
        new.push_str(text.get(at..).unwrap_or(""));
        Ok(new.into_bytes())
    }
}

/// Completes sources as their engines do, and upgrades what they add.
struct Upgrading {
    engines: Engines,
    plan: Arc<Plan>,
}

impl Preparation for Upgrading {
    fn prepare(&self, source: &Source) -> Prepared {
        completed(self.engines.prepare(source), Arc::new(self.engines.includes()), &self.plan, source.stage)
    }
}
