//! `glisten completions`: a script that completes glisten's commands, flags and their values in a shell.

use super::console::Console;
use super::exit::{Exit, Outcome};
use clap::{Args, Command};
use clap_complete::Shell;

#[derive(Args, Debug)]
pub(super) struct CompletionsArgs {
    /// The shell
    #[arg(value_enum)]
    shell: Shell,
}

/// Runs the command; `program` is the whole command line.
pub(super) fn run(args: &CompletionsArgs, mut program: Command, console: &Console) -> Outcome {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut program, "glisten", &mut script);
    console.output_bytes(&script)?;
    Ok(Exit::Ok)
}
