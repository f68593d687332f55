//! The command line, with one file for each subcommand. Only this module prints, reads the environment, or exits.
//!
//! *In:* arguments and files. *Out:* results on standard output and in files; diagnostics on standard error (for
//! `lint` on standard output); an exit code: 0 nothing wrong found, 1 an input has errors or a check did not hold, 2
//! wrong usage or a file that cannot be read or written, 3 the machine lacks something. The highest one that applies
//! is returned.
//!
//! *Holds:* no panics, no half-written files, and the same bytes for the same input with any `-j`.

mod arguments;
mod baseline;
mod baselines;
mod batch;
mod buffers;
mod cache;
mod commands;
mod configurations;
mod console;
mod depfile;
mod digest;
mod exit;
mod files;
mod fix;
mod fullscreen;
#[cfg(feature = "play")]
mod gate;
mod inputs;
mod lone;
mod made;
mod memo;
mod not_checked;
mod opengl;
mod optimize;
mod outputs;
mod overwrite;
mod pictures;
mod pipes;
mod process;
mod progress;
mod recall;
mod scene_ranges;
mod scenes;
mod search;
mod seen;
mod session;
mod strings;
pub mod survey;
mod texels;
mod texts;
mod threads;
mod told;
mod trace;
mod unfinished;
mod variants;
mod with;
mod witness;

use arguments::{responses, sizes};
use clap::{Args, CommandFactory, FromArgMatches, Parser};
use commands::{Command, examples};
use console::{ColorChoice, Console};
use exit::{Exit, Failure, Outcome};
use glisten_front::stack::{BYTES_A_LEVEL, with_stack};
use glisten_scene::confine_to;
use process::guard;
pub use process::memory;
use process::supervisor::Supervised;
use std::ffi::OsString;
use std::io::{self, Write};
use std::path::PathBuf;
use std::process::ExitCode;
use threads::STACK_BYTES;

/// The levels of recursion that a command's stack is for.
const LEVELS: u32 = (STACK_BYTES / BYTES_A_LEVEL) as u32;

/// Check, translate, draw and measure GLSL: versions 1.10 to 4.60, and those of OpenGL ES
#[derive(Debug, Parser)]
#[command(name = "glisten", version, propagate_version = true, max_term_width = 100)]
#[command(after_help = "Exit codes: 0 nothing wrong found; 1 an input is wrong or a check did not hold;\n\
    2 wrong usage, or a file cannot be read or written; 3 the machine lacks something;\n\
    130 Ctrl-C stopped it.")]
struct Cli {
    #[command(flatten)]
    global: GlobalArgs,
    #[command(subcommand)]
    command: Command,
}

#[derive(Args, Debug)]
struct GlobalArgs {
    /// Omit progress and summaries
    #[arg(short, long, global = true)]
    quiet: bool,
    /// When to use colors
    #[arg(long, global = true, value_enum, default_value_t, value_name = "WHEN")]
    color: ColorChoice,
    /// Read only files in this folder, after links are followed: for sources and scenes from strangers
    #[arg(long, global = true, value_name = "DIR")]
    sandbox: Option<PathBuf>,
    /// End when more memory would be needed, such as 512M or 2G (Linux)
    #[arg(long, global = true, value_name = "SIZE", value_parser = sizes::parse)]
    max_memory: Option<u64>,
}

/// Runs the program with these arguments, the first being its own name, in this process.
pub fn run(arguments: impl IntoIterator<Item = OsString>) -> ExitCode {
    match parsed(arguments) {
        Ok((command, console)) => carry_out(&command, &console).into(),
        Err(exit) => exit.into(),
    }
}

/// Runs the program like [`run`]. What draws by a driver runs in a copy of this process, so that this one can tell what a driver
/// did that crashed. This process must not have another thread.
pub fn run_supervised(arguments: impl IntoIterator<Item = OsString>) -> ExitCode {
    let (command, console) = match parsed(arguments) {
        Ok(parsed) => parsed,
        Err(exit) => return exit.into(),
    };
    let resumes = matches!(command, Command::Test(_) | Command::Port(_));
    if command.draws_by_a_driver() {
        Supervised { resumes }.run(&console, &|| carry_out(&command, &console)).into()
    } else {
        carry_out(&command, &console).into()
    }
}

/// The command of the arguments, or the exit code of wrong ones and of those that ask for help.
fn parsed(arguments: impl IntoIterator<Item = OsString>) -> Result<(Command, Console), Exit> {
    let given: Vec<OsString> = arguments.into_iter().collect();
    let color = ColorChoice::asked_for(&given);
    let arguments = responses::expanded(given).map_err(|failure| end(Err(failure), &Console::new(false, color)))?;
    let arguments = of_help(arguments);
    let color = ColorChoice::asked_for(&arguments);
    let command = examples::with_examples_of(Cli::command(), &arguments).color(color.into());
    let parsed = command.try_get_matches_from(arguments);
    let cli = parsed.and_then(|matches| Cli::from_arg_matches(&matches)).map_err(|error| usage(&error))?;
    let console = Console::new(cli.global.quiet, cli.global.color);
    if let Some(folder) = &cli.global.sandbox {
        confine_to(folder).map_err(|error| {
            let message = format!("`{}` cannot be the sandbox: {error}", folder.display());
            end(Err(Failure::usage(message)), &console)
        })?;
    }
    if let Some(bytes) = cli.global.max_memory {
        memory::limit(bytes).map_err(|failure| end(Err(failure), &console))?;
    }
    Ok((cli.command, console))
}

/// The arguments, where `help` has a flag of all commands in place of a command's name.
fn of_help(arguments: Vec<OsString>) -> Vec<OsString> {
    let flag = match arguments.as_slice() {
        [_, command, flag] if command == "help" => flag.to_str(),
        _ => None,
    };
    let name = arguments.first().cloned();
    match flag {
        Some("--help" | "-h") => name.into_iter().chain(["help".into(), "help".into()]).collect(),
        Some("--version" | "-V") => name.into_iter().chain(["--version".into()]).collect(),
        _ => arguments,
    }
}

/// Runs a command on a large stack, and reports a failure.
fn carry_out(command: &Command, console: &Console) -> Exit {
    guard::silence_panics();
    // A thread with such a stack would take longer: it has to be woken, and its memory is slower to get.
    let outcome = match guard::guarded(|| with_stack(LEVELS, || guard::guarded(|| command.run(console)))) {
        Ok(Ok(outcome)) => outcome,
        Ok(Err(panic)) => {
            let message = format!("internal error: {panic}");
            Err(Failure::new(Exit::Content, message)
                .help("this is a fault of glisten; please report it with the input"))
        }
        // The command itself is guarded: there was no stack for it.
        Err(_) => {
            memory::exhausted();
            let message = format!("the system gives no memory for a stack of {} MiB", STACK_BYTES >> 20);
            Err(Failure::new(Exit::Machine, message))
        }
    };
    console.write_document();
    seen::tell();
    end(outcome, console)
}

/// Reports wrong arguments, or prints the requested help or version.
fn usage(error: &clap::Error) -> Exit {
    let printed = error.print();
    if error.use_stderr() {
        // If it cannot be printed, there is no other place to report it.
        return Exit::Usage;
    }
    let outcome = console::written(printed.and_then(|()| io::stdout().flush())).map(|()| Exit::Ok);
    end(outcome, &Console::new(false, ColorChoice::Auto))
}

fn end(outcome: Outcome, console: &Console) -> Exit {
    outcome.unwrap_or_else(|failure| console.tell(failure))
}

#[cfg(test)]
mod tests {
    use super::Cli;
    use clap::CommandFactory;

    #[test]
    fn arguments_are_well_formed() {
        Cli::command().debug_assert();
    }
}
