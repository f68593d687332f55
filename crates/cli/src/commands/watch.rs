//! `glisten watch`: runs a command again when a file that it may read changes.
//!
//! *In:* a command with its arguments. *Out:* what the command prints and writes, each time. *Holds:* the folders of all files
//! and folders among the arguments are watched, with everything below them, and so is each file elsewhere that the last run read or
//! looked for. What the command writes to its `-o`, the file that its output is redirected to, and hidden files that it does not read,
//! start nothing. Changes that follow each other closely are one. Ctrl-C ends it.

use crate::commands::examples::Examples;
use crate::console::Console;
use crate::exit::{Exit, Failure, Outcome};
use crate::files;
use crate::seen;
use crate::unfinished;
use clap::{Args, CommandFactory};
use notify::{Event, EventKind, RecursiveMode, Watcher};
use std::any::TypeId;
use std::collections::BTreeSet;
use std::ffi::OsString;
use std::path::{Component, Path, PathBuf};
use std::process::Command;
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant, SystemTime};
use tempfile::NamedTempFile;

/// Examples of its use.
pub(crate) const EXAMPLES: Examples = &[
    ("glisten watch lint shaders", "the findings again after each change"),
    ("glisten watch render scene.toml -o picture.png", "the picture again after each change"),
];

/// Run a command again whenever its files change
#[derive(Args, Debug)]
pub(crate) struct WatchArgs {
    /// The command with its arguments, such as `lint shaders`
    #[arg(required = true, trailing_var_arg = true, allow_hyphen_values = true, value_name = "COMMAND")]
    command: Vec<OsString>,
}

/// Changes that are closer together than this are one: editors write files in several steps.
const TOGETHER: Duration = Duration::from_millis(60);
/// The beginning of the name of the file in which a run tells what it reads.
const LIST: &str = ".glisten-watch-";
/// The flags that name an output.
const OUTPUTS: [&str; 7] = ["-o", "--output", "--difference", "--evidence", "--depfile", "--manifest", "--cache"];

/// Runs the command.
pub(crate) fn run(args: &WatchArgs, console: &Console) -> Outcome {
    let (name, rest) = args.command.split_first().ok_or_else(|| Failure::usage("no command is given"))?;
    refuse_unknown(&name.to_string_lossy())?;
    let program = std::env::current_exe()
        .map_err(|error| Failure::new(Exit::Machine, format!("the program does not find itself: {error}")))?;
    let list = unfinished_list()?;
    let run = || {
        let mut command = Command::new(&program);
        command.args(&args.command).args(files::sandbox()).env(seen::LIST, list.path());
        command.status().map_err(|error| Failure::new(Exit::Machine, format!("the command does not start: {error}")))
    };
    let named = std::iter::once("glisten".into()).chain(args.command.iter().cloned());
    match crate::Cli::command().try_get_matches_from(named) {
        Ok(matches) => refuse_missing(&matches)?,
        // No change of a file mends wrong arguments; the command tells what is wrong with them.
        Err(_) => return Ok(run()?.code().and_then(|code| u8::try_from(code).ok()).map_or(Exit::Usage, Exit::of_code)),
    }
    let mut watched = watched(rest);
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
        // What is there from the run before is of no use any more.
        let _ = list.as_file().set_len(0);
        let start = SystemTime::now();
        let status = run()?;
        let fresh = watched.look_at(&seen::told(list.path()).unwrap_or_default(), &mut watcher);
        let ended = if status.success() { "OK" } else { "Errors" };
        console.remark(&format!("{ended}. Watching {} (Ctrl-C to stop)", watched.shown()));
        // What was not watched during the run may have changed since it was read.
        let late = fresh.into_iter().find(|file| is_newer(file, start));
        let Some(changed) = late.or_else(|| next_change(&changes, &watched)) else { return Ok(Exit::Machine) };
        console.remark(&format!("{} changed", changed.display()));
    }
}

/// The file that each run tells the names of the files that it reads.
fn unfinished_list() -> Result<NamedTempFile, Failure> {
    let folder = std::env::temp_dir();
    unfinished::sweep(&folder, LIST);
    let made = unfinished::create(tempfile::Builder::new().prefix(LIST), &folder);
    made.map_err(|error| Failure::usage(format!("cannot write to `{}`: {error}", folder.display())))
}

fn is_newer(file: &Path, time: SystemTime) -> bool {
    file.metadata().and_then(|found| found.modified()).is_ok_and(|changed| changed > time)
}

fn cannot_watch(error: &notify::Error) -> Failure {
    if let notify::ErrorKind::Io(reason) = &error.kind
        && reason.kind() == std::io::ErrorKind::PermissionDenied
    {
        let paths: Vec<String> = error.paths.iter().map(|path| format!("`{}`", path.display())).collect();
        return Failure::usage(format!("cannot read {}: {reason}", paths.join(", ")));
    }
    Failure::new(Exit::Machine, format!("the system does not tell of changes: {error}"))
}

/// Commands that end when they are told to, and not after their work.
const ENDLESS: [&str; 3] = ["watch", "play", "lsp"];

fn refuse_unknown(name: &str) -> Result<(), Failure> {
    let commands = crate::Cli::command();
    let known = commands.get_subcommands().map(clap::Command::get_name).filter(|known| !ENDLESS.contains(known));
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
    let mut commands = crate::Cli::command();
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

/// The folders and files to watch, and the outputs in them.
#[derive(Debug, Default, PartialEq, Eq)]
struct Watched {
    folders: BTreeSet<PathBuf>,
    /// As absolute paths.
    outputs: Vec<PathBuf>,
    /// The files that the last run read or looked for: absolute paths, as named and after links.
    files: BTreeSet<PathBuf>,
    /// The folders of those files that are not below the others.
    elsewhere: BTreeSet<PathBuf>,
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
    Watched { folders, outputs, ..Watched::default() }
}

/// Whether standard output or the messages go to a file.
#[cfg(unix)]
fn is_redirected(path: &Path) -> bool {
    use std::os::fd::AsFd;
    use std::os::unix::fs::MetadataExt;
    let Ok(there) = path.metadata() else { return false };
    let (output, messages) = (std::io::stdout(), std::io::stderr());
    [output.as_fd(), messages.as_fd()].into_iter().any(|stream| {
        let open = stream.try_clone_to_owned().and_then(|owned| std::fs::File::from(owned).metadata());
        open.is_ok_and(|open| open.is_file() && (open.dev(), open.ino()) == (there.dev(), there.ino()))
    })
}

/// Whether standard output or the messages go to a file, which is not known here.
#[cfg(not(unix))]
fn is_redirected(_: &Path) -> bool {
    false
}

/// Waits for a change, and for the changes right behind it. `None` if there will be no more.
fn next_change(changes: &Receiver<Event>, watched: &Watched) -> Option<PathBuf> {
    loop {
        let event = changes.recv().ok()?;
        let Some(changed) = watched.path_of(&event) else { continue };
        let mut paths = vec![changed];
        // What does not count, such as files that somebody reads all the time, does not put it off.
        let mut end = Instant::now() + TOGETHER;
        while let Ok(event) = changes.recv_timeout(end.saturating_duration_since(Instant::now())) {
            if let Some(path) = watched.path_of(&event) {
                paths.push(path);
                end = Instant::now() + TOGETHER;
            }
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
        let is_hidden = |part: Component<'_>| part.as_os_str().to_string_lossy().starts_with('.');
        let is_source = || {
            self.below(&path).is_some_and(|below| !below.components().any(is_hidden))
                && !path.to_string_lossy().ends_with('~')
        };
        !self.is_output(&path) && (self.files.contains(&path) || is_source()) && !is_redirected(&path)
    }

    fn is_output(&self, path: &Path) -> bool {
        self.outputs.iter().any(|output| path.starts_with(output))
    }

    /// The rest of an absolute path below one of the folders.
    fn below(&self, path: &Path) -> Option<PathBuf> {
        let folders = self.folders.iter().filter_map(|folder| std::path::absolute(folder).ok());
        folders.into_iter().find_map(|folder| path.strip_prefix(folder).map(Path::to_owned).ok())
    }

    /// Watches the files that a run has read or looked for, in place of those of the run before. Returns those that were not watched yet.
    /// A run that tells none did not come to its end: the files stay.
    fn look_at(&mut self, read: &BTreeSet<PathBuf>, watcher: &mut impl Watcher) -> Vec<PathBuf> {
        if read.is_empty() {
            return Vec::new();
        }
        let real = read.iter().filter_map(|path| std::fs::canonicalize(path).ok());
        let named = read.iter().filter_map(|path| Some(files::real(path.parent()?).join(path.file_name()?)));
        self.files = named.chain(real).filter(|path| !self.is_output(path)).collect();
        let outside: Vec<PathBuf> = self.files.iter().filter(|path| self.below(path).is_none()).cloned().collect();
        let folders = outside.iter().filter_map(|path| path.parent()).filter(|folder| folder.is_dir());
        let folders: BTreeSet<PathBuf> = folders.map(Path::to_owned).collect();
        // A folder that cannot be watched, such as one of the system, costs only its files.
        for gone in self.elsewhere.difference(&folders) {
            let _ = watcher.unwatch(gone);
        }
        let is_new = |folder: &&PathBuf| !self.elsewhere.contains(*folder);
        let watch = |folder: &&PathBuf| watcher.watch(folder, RecursiveMode::NonRecursive).is_ok();
        let added: BTreeSet<PathBuf> = folders.iter().filter(is_new).filter(watch).cloned().collect();
        let kept = self.elsewhere.intersection(&folders).cloned().collect::<BTreeSet<_>>();
        let in_added = |path: &PathBuf| path.parent().is_some_and(|folder| added.contains(folder));
        let fresh = outside.into_iter().filter(in_added).collect();
        self.elsewhere = kept.union(&added).cloned().collect();
        fresh
    }

    /// The folders and the number of files elsewhere, for people.
    fn shown(&self) -> String {
        let folders: Vec<String> = self.folders.iter().map(|folder| format!("`{}`", folder.display())).collect();
        let is_elsewhere = |path: &&PathBuf| path.parent().is_some_and(|folder| self.elsewhere.contains(folder));
        let there = self.files.iter().filter(is_elsewhere).filter(|path| path.is_file() && !path.is_symlink());
        match there.count() {
            0 => folders.join(", "),
            1 => format!("{} and 1 file elsewhere", folders.join(", ")),
            count => format!("{} and {count} files elsewhere", folders.join(", ")),
        }
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
        assert!(refuse_unknown("lint").is_ok());
        assert!(["watch", "play", "lsp", "lnit"].into_iter().all(|name| refuse_unknown(name).is_err()));
    }
}
