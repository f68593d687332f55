//! `glisten completions`: a script that completes glisten's commands, flags and their values in a shell.

use crate::Cli;
use crate::commands::examples::Examples;
use crate::console::Console;
use crate::exit::{Exit, Outcome};
use clap::{Args, Command, CommandFactory};
use clap_complete::Shell;
use std::collections::BTreeSet;

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
    let script = without(&hidden(&program), &String::from_utf8_lossy(&script));
    console.output_bytes(script.as_bytes())?;
    Ok(Exit::Ok)
}

/// The flags that no help names, of all commands.
fn hidden(program: &Command) -> BTreeSet<String> {
    let commands = || program.get_subcommands().chain([program]);
    let flags = |is_hidden: bool| {
        let arguments = commands().flat_map(Command::get_arguments).filter(move |one| one.is_hide_set() == is_hidden);
        arguments.flat_map(|one| {
            let short = one.get_short().map(|short| format!("-{short}"));
            short.into_iter().chain(one.get_long().map(|long| format!("--{long}")))
        })
    };
    let shown: BTreeSet<String> = flags(false).collect();
    flags(true).filter(|flag| !shown.contains(flag)).collect()
}

/// The script without what names these flags: words of the lists of bash, lines for the other shells.
fn without(hidden: &BTreeSet<String>, script: &str) -> String {
    let mut text = String::new();
    for line in script.split_inclusive('\n') {
        match line.split_once("opts=\"") {
            Some((indent, list)) => {
                let words: Vec<&str> = list.split(' ').filter(|word| !hidden.contains(*word)).collect();
                text.push_str(&format!("{indent}opts=\"{}", words.join(" ")));
            }
            None if hidden.iter().any(|flag| offers(line, flag)) => {}
            None => text.push_str(line),
        }
    }
    text
}

/// Whether a line of a script for zsh, PowerShell, Elvish or fish offers a flag.
fn offers(line: &str, flag: &str) -> bool {
    let for_fish = flag
        .strip_prefix("--")
        .map_or_else(|| format!(" -s {} ", flag.trim_start_matches('-')), |long| format!(" -l {long} "));
    let forms = [format!("{flag}["), format!("'{flag}', '{flag}'"), format!("cand {flag} "), for_fish];
    forms.iter().any(|form| line.contains(form.as_str()))
}
