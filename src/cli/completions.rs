//! `glisten completions`: a script that completes glisten's commands, flags and their values in a shell.

use super::Cli;
use super::console::Console;
use super::examples::Examples;
use super::exit::{Exit, Outcome};
use clap::{Args, CommandFactory};
use clap_complete::Shell;

/// Examples of its use.
pub(super) const EXAMPLES: Examples = &[
    ("glisten completions bash > ~/.local/share/bash-completion/completions/glisten", ""),
    ("glisten completions zsh > ~/.zfunc/_glisten", ""),
    ("glisten completions fish > ~/.config/fish/completions/glisten.fish", ""),
];

/// Write a completion script for a shell to standard output
#[derive(Args, Debug)]
pub(super) struct CompletionsArgs {
    /// The shell
    #[arg(value_enum)]
    shell: Shell,
}

/// Runs the command.
pub(super) fn run(args: &CompletionsArgs, console: &Console) -> Outcome {
    let mut program = Cli::command();
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut program, "glisten", &mut script);
    console.output_bytes(&script)?;
    Ok(Exit::Ok)
}
