//! `glisten port`: a folder of shaders for OpenGL as one for another host.
//!
//! *In:* a folder, the name of a host. *Out:* a folder with all its files, those of its programs rewritten; what the host needs next to
//! them; the account, as JSON and as a page. *Holds:* a program that cannot be ported stays as it was, with the reason. Files with the
//! same bytes are not written again, so a second run changes nothing.
//!
//! | file | contents |
//! | --- | --- |
//! | `programs` | the programs of the folder, with new texts |
//! | `brought` | the files that come from an older host, at their new places |
//! | `older` | included files of an older host, which become files of the folder |
//! | `extras` | reflection, WGSL, Rust, C, the passes of a pack |
//! | `tree` | all files of the new folder, and how they differ from what is there |
//! | `proof`, `pictures` | the proof of each program; its two pictures |

mod brought;
mod extras;
mod older;
mod pictures;
mod programs;
mod proof;
mod tree;

use crate::arguments::args::{BindingArgs, LevelArgs, ProgramArgs, ResultFormat, SourceArgs};
use crate::commands::examples::Examples;
use crate::console::Console;
use crate::exit::{Exit, Failure, Outcome};
use crate::files;
use crate::inputs;
use crate::opengl;
use crate::overwrite::own_name;
use crate::session::Session;
use clap::Args;
use clap::builder::PossibleValuesParser;
use glisten_port::{Host, Outcome as Result_, Report, find_host, host_names, page};
use glisten_upgrade::with_version;
use programs::Ported;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use tree::NewFolder;

/// The account's files in the new folder.
const ACCOUNT: [&str; 2] = ["port.json", "port.html"];

/// Examples of its use.
pub(crate) const EXAMPLES: Examples = &[
    ("glisten port pack --for minecraft-26.2 -o ported", "a resource pack for Minecraft's Vulkan"),
    ("glisten port shaders --for wgpu -o ported --prove", "an engine's shaders for wgpu, with their pictures compared"),
    ("glisten port pack --for minecraft-26.2 --check", "exit 1 if something is left to port"),
];

/// Port a folder of shaders to another host: Minecraft on Vulkan, Vulkan, wgpu, Bevy, WebGL 2
#[derive(Args, Debug)]
pub(crate) struct PortArgs {
    /// The folder: a resource pack, or the shaders of an engine
    #[arg(value_name = "DIR")]
    pack: PathBuf,
    /// The host that the shaders are for
    #[arg(long = "for", value_name = "HOST", value_parser = PossibleValuesParser::new(host_names()))]
    host: String,
    /// The new folder
    #[arg(short, long, value_name = "DIR", required_unless_present = "check")]
    output: Option<PathBuf>,
    /// Write nothing; name the files that would change, and exit with 1 if there are any. Without `-o`, those that are not for the
    /// host yet
    #[arg(long)]
    check: bool,
    /// Draw each ported program in a scene that is made for it: the original by OpenGL, the new one by Vulkan; only if built with
    /// `--features gl`
    #[arg(long)]
    prove: bool,
    /// The format of the account on standard output
    #[arg(long, value_enum, default_value_t)]
    format: ResultFormat,
    #[command(flatten)]
    programs: ProgramArgs,
    #[command(flatten)]
    sources: SourceArgs,
    #[command(flatten)]
    levels: LevelArgs,
}

impl PortArgs {
    /// Whether the command draws by a driver.
    pub(crate) fn draws_by_a_driver(&self) -> bool {
        self.prove
    }
}

/// Runs the command.
pub(crate) fn run(args: &PortArgs, console: &Console) -> Outcome {
    let Some(host) = find_host(&args.host) else { return Err(Failure::usage(format!("`{}` is no host", args.host))) };
    if !args.pack.is_dir() {
        return Err(Failure::usage(format!("`{}` is no folder", args.pack.display())));
    }
    if args.prove {
        opengl::require_to_compare()?;
    }
    if let Some(output) = &args.output {
        apart(&args.pack, output)?;
    }
    let sources = SourceArgs { engine: args.sources.engine.clone().or(host.engine.clone()), ..args.sources.clone() };
    // A file has one name, whoever includes it.
    let pack = std::path::absolute(&args.pack).unwrap_or_else(|_| args.pack.clone());
    let inputs = inputs::collect(std::slice::from_ref(&pack), &args.programs, &sources, true)?;
    inputs.tell_empty_folders(console);
    inputs.tell_without_stage(console);
    let mut session = Session::new(console, &sources, &BindingArgs::default(), &args.levels, 0)?;
    let mut ported = programs::ported(&mut session, inputs.groups, host, &sources, &pack)?;
    let host = &ported.host.clone();
    if args.prove {
        proof::prove(&mut ported, host, &sources, &args.levels, console)?;
    }
    let mut folder = NewFolder::read(&args.pack)?;
    let report = assembled(args, host, &ported, &mut folder)?;
    finish(args, &report, folder, console)
}

/// Refuses a new folder that is inside of the old one, or around it.
fn apart(pack: &Path, output: &Path) -> Result<(), Failure> {
    let (pack, output) = (own_name(pack), own_name(output));
    if output.starts_with(&pack) || pack.starts_with(&output) {
        let failure = Failure::usage(format!("`{}` is inside of the other folder, or around it", output.display()));
        return Err(failure.help("name another folder"));
    }
    Ok(())
}

/// Puts everything into the new folder.
fn assembled(args: &PortArgs, host: &Host, ported: &Ported, folder: &mut NewFolder) -> Result<Report, Failure> {
    let mut files = Vec::new();
    // The texts of files with several stages, which become a file for each.
    let mut wholes: BTreeMap<String, String> = BTreeMap::new();
    let moved = ported.older_files.moved();
    for file in &ported.tree.files {
        if let Some(old) = moved.get(&file.name) {
            files.extend(brought::bring(&args.pack, ported, folder, (file, old)));
            continue;
        }
        let whole = ported.whole(&file.name).unwrap_or(&file.name);
        let Some(place) = folder.place(&args.pack, Path::new(whole)) else { continue };
        let new = folder.place(&args.pack, Path::new(&file.new_name())).unwrap_or_else(|| place.clone());
        let old = wholes.get(&place).cloned().or_else(|| folder.text(&place)).unwrap_or_default();
        if *whole != file.name {
            wholes.insert(place.clone(), old.clone());
        }
        let text = with_version(&old, &file.text);
        if old == text && new == place {
            continue;
        }
        let notes = ported.tree.notes.iter().filter(|note| note.file == file.name);
        files.push(glisten_port::FileReport {
            file: place.clone(),
            new: new.clone(),
            done: glisten_port::done(&old, &text),
            notes: notes.map(|note| format!("line {}: {}", note.line, note.text)).collect(),
            texts: (old, text.clone()),
        });
        if *whole != file.name && ported.is_kept(whole) {
            folder.add(&new, text.into_bytes());
        } else {
            folder.replace(&place, &new, text.into_bytes());
        }
    }
    files.extend(brought::move_unread(&args.pack, ported, folder));
    files.extend(brought::blocks(&args.pack, host, ported, folder));
    if host.is_minecraft {
        files.extend(extras::passes(host, folder));
        extras::note_unfilled(folder, &mut files);
    }
    files.sort_by(|a, b| (&a.file, &a.new).cmp(&(&b.file, &b.new)));
    let copied = folder.copied();
    let notes = extras::add(host, ported, folder, &args.pack)?;
    let mut programs = ported.reports(&args.pack, folder);
    for (index, note) in notes {
        programs.get_mut(index).into_iter().for_each(|program| program.notes.push(note.clone()));
    }
    let pack = args
        .pack
        .file_name()
        .map_or_else(|| args.pack.display().to_string(), |name| name.to_string_lossy().into_owned());
    Ok(Report { pack, host: host.name.to_owned(), programs, files, copied })
}

/// Writes the folder and tells the account.
fn finish(args: &PortArgs, report: &Report, mut folder: NewFolder, console: &Console) -> Outcome {
    let account = summarized(report);
    let text = |value: &serde_json::Value| serde_json::to_string_pretty(value).unwrap_or_default() + "\n";
    let json = text(&account);
    let broken = |message: String| Failure::new(Exit::Content, format!("the page cannot be made: {message}"));
    let html = page(report).map_err(broken)?;
    folder.add(ACCOUNT[0], json.clone().into_bytes());
    folder.add(ACCOUNT[1], html.into_bytes());
    let mut differing: Option<Vec<PathBuf>> = None;
    match (&args.output, args.check) {
        (Some(output), true) => {
            differing = Some(folder.differing(output).iter().map(|name| output.join(name)).collect());
        }
        (None, _) => {
            let refused = report.programs.iter().filter(|program| program.result == Result_::Refused);
            let changed = report.files.iter().map(|file| &file.file);
            let names: BTreeSet<&String> = changed.chain(refused.flat_map(|program| &program.files)).collect();
            differing = Some(names.iter().map(|name| args.pack.join(name)).collect());
        }
        (Some(output), false) => {
            let names = folder.differing(output);
            for name in &names {
                let path = output.join(name);
                if let Some(folder) = path.parent() {
                    files::make_folder(folder)?;
                }
                files::write(&path, folder.bytes(name))?;
            }
            console.remark(&format!("wrote {} files into {}", names.len(), output.display()));
        }
    }
    let names: Vec<String> = differing.iter().flatten().map(|path| path.display().to_string()).collect();
    match (args.format, differing.is_some()) {
        (ResultFormat::Json, true) => {
            let mut account = account;
            if let Some(object) = account.as_object_mut() {
                object.insert("differing".to_owned(), serde_json::json!(names));
            }
            console.output(&text(&account))?;
        }
        (ResultFormat::Json, false) => console.output(&json)?,
        (ResultFormat::Human, _) => {
            console.output(&names.iter().map(|name| format!("{name}\n")).collect::<String>())?
        }
    }
    let exit = if names.is_empty() { Exit::Ok } else { Exit::Content };
    for program in report.programs.iter().filter(|program| program.result == Result_::Refused) {
        let because = program.because.as_deref().unwrap_or("");
        // It is what the exit code is about, so `--quiet` does not omit it.
        console.aside(&format!("note: `{}` stays as it was: {because}", program.name));
    }
    console.remark(&report.summary());
    // A check of a new folder asks whether it is as a port would write it now.
    let is_refused = report.count(Result_::Refused) > 0 && !args.check;
    let is_wrong = is_refused || report.proofs("failed") > 0;
    Ok(exit.max(if is_wrong { Exit::Content } else { Exit::Ok }))
}

/// The account with its figures.
fn summarized(report: &Report) -> serde_json::Value {
    let mut value = serde_json::to_value(report).unwrap_or_default();
    let [proved, inconclusive, failed] = ["proved", "inconclusive", "failed"].map(|word| report.proofs(word));
    let summary = serde_json::json!({
        "programs": report.programs.len(),
        "ported": report.count(Result_::Ported),
        "unchanged": report.count(Result_::Unchanged),
        "already": report.count(Result_::Already),
        "refused": report.count(Result_::Refused),
        "files": report.files.len(),
        "copied": report.copied,
        "proved": proved,
        "inconclusive": inconclusive,
        "failed": failed,
    });
    if let Some(object) = value.as_object_mut() {
        object.insert("summary".to_owned(), summary);
    }
    value
}
