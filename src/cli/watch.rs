//! `glisten watch`: runs a command again when a file that it may read changes.
//!
//! *In:* a command with its arguments. *Out:* what the command prints and writes, each time. *Holds:* the folders of all files
//! and folders among the arguments are watched, with everything below them; what the command writes to its `-o`, and hidden
//! files, start nothing. Changes that follow each other closely are one. Ctrl-C ends it.

use super::console::Console;
use super::examples::Examples;
use super::exit::{Exit, Failure, Outcome};
use super::files;
use clap::{Args, CommandFactory};
use notify::{Event, EventKind, RecursiveMode, Watcher};
use std::any::TypeId;
use std::collections::BTreeSet;
use std::ffi::OsString;
use std::path::{Component, Path, PathBuf};
use std::process::Command;
use std::sync::mpsc::{Receiver, channel};
use std::time::Duration;

/// Examples of its use.
pub(super) const EXAMPLES: Examples = &[
    ("glisten watch lint shaders", "the findings again after each change"),
    ("glisten watch render scene.toml -o picture.png", "the picture again after each change"),
];

/// Run a command again whenever its files change
#[derive(Args, Debug)]
pub(super) struct WatchArgs {
    /// The command with its arguments, such as `lint shaders`
    #[arg(required = true, trailing_var_arg = true, allow_hyphen_values = true, value_name = "COMMAND")]
    command: Vec<OsString>,
}

/// Changes that are closer together than this are one: editors write files in several steps.
const TOGETHER: Duration = Duration::from_millis(60);
/// The flags that name an output.
const OUTPUTS: [&str; 7] = ["-o", "--output", "--difference", "--evidence", "--depfile", "--manifest", "--cache"];

/// Runs the command.
pub(super) fn run(args: &WatchArgs, console: &Console) -> Outcome {
    let (name, rest) = args.command.split_first().ok_or_else(|| Failure::usage("no command is given"))?;
    refuse_unknown(&name.to_string_lossy())?;
    let program = std::env::current_exe()
        .map_err(|error| Failure::new(Exit::Machine, format!("the program does not find itself: {error}")))?;
    let run = || {
        let run = Command::new(&program).args(&args.command).args(files::sandbox()).status();
        run.map_err(|error| Failure::new(Exit::Machine, format!("the command does not start: {error}")))
    };
    let named = std::iter::once("glisten".into()).chain(args.command.iter().cloned());
    match super::Cli::command().try_get_matches_from(named) {
        Ok(matches) => refuse_missing(&matches)?,
        // No change of a file mends wrong arguments; the command tells what is wrong with them.
        Err(_) => return Ok(run()?.code().and_then(|code| u8::try_from(code).ok()).map_or(Exit::Usage, Exit::of_code)),
    }
    let watched = watched(rest);
    let (sender, changes) = channel();
    let mut watcher = notify::recommended_watcher(move |event: notify::Result<Event>| {
        // The other end is gone when the program ends.
        let _ = event.map(|event| sender.send(event));
    })
    .map_err(|error| cannot_watch(&error))?;
    for folder in &watched.folders {
        watcher.watch(folder, RecursiveMode::Recursive).map_err(|error| cannot_watch(&error))?;
    }
    loop {
        let status = run()?;
        let list: Vec<String> = watched.folders.iter().map(|folder| format!("`{}`", folder.display())).collect();
        let ended = if status.success() { "OK" } else { "Errors" };
        console.remark(&format!("{ended}. Watching {} (Ctrl-C to stop)", list.join(", ")));
        let Some(changed) = next_change(&changes, &watched) else { return Ok(Exit::Machine) };
        console.remark(&format!("{} changed", changed.display()));
    }
}

fn cannot_watch(error: &notify::Error) -> Failure {
    Failure::new(Exit::Machine, format!("the system does not tell of changes: {error}"))
}

fn refuse_unknown(name: &str) -> Result<(), Failure> {
    let commands = super::Cli::command();
    let known = commands.get_subcommands().map(clap::Command::get_name).filter(|known| *known != "watch");
    let known: Vec<&str> = known.collect();
    if known.contains(&name) {
        return Ok(());
    }
    let near = glisten_front::diagnostic::did_you_mean(name, known.iter().copied());
    let failure = Failure::usage(format!("`{name}` is no command that can be watched"));
    Err(failure.help(near.map_or_else(
        || "write it as without `watch`: `glisten watch lint shaders`".to_owned(),
        |near| format!("did you mean `{near}`?"),
    )))
}

/// The names of arguments that are paths, or texts that name a file.
const INPUTS: [&str; 3] = ["files", "scene", "scenes"];

/// Refuses inputs that do not exist: nothing tells when one of them comes into being.
fn refuse_missing(matches: &clap::ArgMatches) -> Result<(), Failure> {
    let Some((name, matches)) = matches.subcommand() else { return Ok(()) };
    let mut commands = super::Cli::command();
    commands.build();
    let Some(arguments) = commands.find_subcommand(name).map(clap::Command::get_positionals) else { return Ok(()) };
    let is_path = |argument: &clap::Arg| {
        argument.get_value_parser().type_id() == TypeId::of::<PathBuf>() || INPUTS.contains(&argument.get_id().as_str())
    };
    let raw = |argument: &clap::Arg| matches.try_get_raw(argument.get_id().as_str()).ok().flatten();
    let mut paths = arguments.filter(|argument| is_path(argument)).filter_map(raw).flatten();
    match paths.find(|path| *path != "-" && !Path::new(path).exists()) {
        Some(path) => {
            let failure = Failure::usage(format!("cannot watch `{}`: it does not exist", path.to_string_lossy()));
            Err(failure.help("name files and folders that are there"))
        }
        None => Ok(()),
    }
}

/// The folders to watch, and the outputs in them.
#[derive(Debug, PartialEq, Eq)]
struct Watched {
    folders: BTreeSet<PathBuf>,
    /// As absolute paths.
    outputs: Vec<PathBuf>,
}

/// The folders of all paths among the arguments; the current one if there is none.
fn watched(arguments: &[OsString]) -> Watched {
    let (mut folders, mut outputs) = (BTreeSet::new(), Vec::new());
    let mut is_output = false;
    for argument in arguments {
        let text = argument.to_string_lossy();
        let assigned = text.split_once('=').filter(|(flag, _)| flag.starts_with("--"));
        if is_output || assigned.is_some_and(|(flag, _)| OUTPUTS.contains(&flag)) {
            let path = assigned.filter(|_| !is_output).map_or(text.as_ref(), |(_, path)| path);
            outputs.extend(std::path::absolute(path));
            is_output = false;
            continue;
        }
        is_output = OUTPUTS.contains(&text.as_ref());
        let path = text.strip_prefix("-I").or(assigned.map(|(_, path)| path)).unwrap_or(&text);
        // A list of files is one argument of `--program`.
        for path in path.split(',').map(Path::new) {
            if path.is_dir() {
                folders.insert(path.to_owned());
            } else if path.is_file() {
                let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
                folders.insert(folder.unwrap_or(Path::new(".")).to_owned());
            }
        }
    }
    if folders.is_empty() {
        folders.insert(".".into());
    }
    Watched { folders, outputs }
}

/// Waits for a change, and for the changes right behind it. `None` if there will be no more.
fn next_change(changes: &Receiver<Event>, watched: &Watched) -> Option<PathBuf> {
    loop {
        let event = changes.recv().ok()?;
        let Some(changed) = watched.path_of(&event) else { continue };
        let mut paths = vec![changed];
        while let Ok(event) = changes.recv_timeout(TOGETHER) {
            paths.extend(event.paths.into_iter().filter(|path| watched.counts(path)));
        }
        // Editors write to a name of their own, which is gone when they have renamed it.
        let there = paths.iter().rev().find(|path| path.is_file()).cloned();
        return there.or(paths.into_iter().next());
    }
}

impl Watched {
    /// The path of an event that may change what the command does.
    fn path_of(&self, event: &Event) -> Option<PathBuf> {
        let is_change = !matches!(event.kind, EventKind::Access(_) | EventKind::Other);
        event.paths.iter().filter(|_| is_change).find(|path| self.counts(path)).cloned()
    }

    fn counts(&self, path: &Path) -> bool {
        let path = std::path::absolute(path).unwrap_or_default();
        let folders = self.folders.iter().filter_map(|folder| std::path::absolute(folder).ok());
        let below = folders.into_iter().find_map(|folder| path.strip_prefix(folder).map(Path::to_owned).ok());
        let is_hidden = |part: Component<'_>| part.as_os_str().to_string_lossy().starts_with('.');
        let is_output = self.outputs.iter().any(|output| path.starts_with(output));
        !is_output
            && below.is_some_and(|below| !below.components().any(is_hidden))
            && !path.to_string_lossy().ends_with('~')
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folders_of_files_are_watched_and_outputs_are_not() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = |name: &str| folder.path().join(name);
        for name in ["a.vert", "a.frag"] {
            std::fs::write(path(name), "").expect("the folder can be written to");
        }
        std::fs::create_dir(path("include")).expect("a folder");
        let arguments: Vec<OsString> = [
            format!("--program={},{}", path("a.vert").display(), path("a.frag").display()),
            format!("-I{}", path("include").display()),
            "-o".into(),
            path("out").display().to_string(),
            "--target".into(),
            "wgsl".into(),
        ]
        .map(OsString::from)
        .into();
        let found = watched(&arguments);
        assert_eq!(found.folders, BTreeSet::from([folder.path().to_owned(), path("include")]));
        assert_eq!(found.outputs, [path("out")]);
        let event = |name: &str| Event::new(EventKind::Any).add_path(path(name));
        assert_eq!(found.path_of(&event("a.vert")), Some(path("a.vert")));
        assert_eq!(found.path_of(&event("out/a.wgsl")), None);
        assert_eq!(found.path_of(&event("a.vert~")), None);
        assert_eq!(watched(&["--all".into()]).folders, BTreeSet::from([".".into()]));
        assert!(refuse_unknown("watch").is_err() && refuse_unknown("lnit").is_err() && refuse_unknown("lint").is_ok());
    }
}
