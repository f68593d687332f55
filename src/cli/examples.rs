//! Examples for the help text of each command.
//!
//! *In:* the examples of the commands, in their order. *Out:* the command line with examples. *Holds:* every command has examples, and every
//! example is well-formed; tests check both.

use super::EXAMPLES;
use clap::Command;
use std::ffi::OsString;

/// Examples of a command: a line, and what it does.
pub(super) type Examples = &'static [(&'static str, &'static str)];

/// The command line with the examples of each command after its help.
pub(super) fn with_examples(program: Command) -> Command {
    added(program, |_| true)
}

/// The command line, with the examples of those commands that the arguments name.
pub(super) fn with_examples_of(program: Command, arguments: &[OsString]) -> Command {
    added(program, |name| arguments.iter().any(|argument| argument == name))
}

fn added(program: Command, wanted: impl Fn(&str) -> bool) -> Command {
    let names: Vec<String> = program.get_subcommands().map(|command| command.get_name().to_owned()).collect();
    let rows = names.into_iter().zip(EXAMPLES).filter(|(name, _)| wanted(name));
    rows.fold(program, |program, (name, examples)| {
        program.mut_subcommand(name, |command| command.after_help(text(examples)))
    })
}

fn text(examples: &[(&str, &str)]) -> String {
    let mut text = String::from("Examples:");
    for (line, meaning) in examples {
        text.push_str(&format!("\n  {line}"));
        if !meaning.is_empty() {
            text.push_str(&format!("\n      {meaning}"));
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::{EXAMPLES, with_examples};
    use crate::cli::Cli;
    use clap::CommandFactory;

    #[test]
    fn every_command_has_examples_that_are_well_formed() {
        let program = Cli::command();
        let names: Vec<&str> = program.get_subcommands().map(clap::Command::get_name).collect();
        assert_eq!(names.len(), EXAMPLES.len());
        for (name, examples) in names.into_iter().zip(EXAMPLES) {
            assert!(examples.iter().any(|(line, _)| line.starts_with(&format!("glisten {name}"))), "{name}");
        }
        for (line, _) in EXAMPLES.iter().copied().flatten() {
            let words = line.split(" > ").next().unwrap_or(line).split(' ');
            let parsed = with_examples(Cli::command()).try_get_matches_from(words);
            assert!(parsed.is_ok(), "{line}: {:?}", parsed.err().map(|error| error.to_string()));
        }
    }
}
