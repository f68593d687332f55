//! `glisten completions`: a script that completes glisten's commands, flags and their values in a shell.

use crate::Cli;
use crate::commands::examples::Examples;
use crate::console::Console;
use crate::exit::{Exit, Outcome};
use clap::{Args, CommandFactory};
use clap_complete::Shell;

/// Examples of its use.
pub(crate) const EXAMPLES: Examples = &[
    ("glisten completions bash > ~/.local/share/bash-completion/completions/glisten", ""),
    ("glisten completions zsh > ~/.zfunc/_glisten", ""),
    ("glisten completions fish > ~/.config/fish/completions/glisten.fish", ""),
];

/// Write a completion script for a shell to standard output
#[derive(Args, Debug)]
pub(crate) struct CompletionsArgs {
    /// The shell
    #[arg(value_enum)]
    shell: Shell,
}

/// Runs the command.
pub(crate) fn run(args: &CompletionsArgs, console: &Console) -> Outcome {
    let mut program = Cli::command();
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut program, "glisten", &mut script);
    console.output_bytes(&script)?;
    Ok(Exit::Ok)
}
