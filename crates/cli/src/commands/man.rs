//! `glisten man`: manual pages of the program and its commands.

use crate::Cli;
use crate::commands::examples::Examples;
use crate::console::Console;
use crate::exit::{Exit, Failure, Outcome};
use crate::files;
use clap::{Args, Command, CommandFactory};
use std::path::PathBuf;

/// Examples of its use.
pub(crate) const EXAMPLES: Examples = &[("glisten man -o ~/.local/share/man/man1", "then: man glisten-lint")];

/// Write manual pages: glisten.1, and one for each command
#[derive(Args, Debug)]
pub(crate) struct ManArgs {
    /// The output folder (default: glisten.1 to standard output)
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
}

/// Runs the command.
pub(crate) fn run(args: &ManArgs, console: &Console) -> Outcome {
    let mut program = crate::commands::examples::with_examples(Cli::command());
    program.build();
    let Some(folder) = &args.output else {
        console.output_bytes(&page(program)?)?;
        return Ok(Exit::Ok);
    };
    files::make_folder(folder)?;
    let mut pages = Vec::new();
    pages_of("glisten", program, &mut pages)?;
    for (name, page) in &pages {
        files::write(&folder.join(format!("{name}.1")), page)?;
    }
    console.remark(&format!("wrote {} pages to {}", pages.len(), folder.display()));
    Ok(Exit::Ok)
}

/// The page of a command, and those of the commands below it. One is found by `man glisten-lint`, and its synopsis says
/// `glisten lint`.
fn pages_of(name: &str, command: Command, pages: &mut Vec<(String, Vec<u8>)>) -> Result<(), Failure> {
    let command = without_help(command).display_name(name.to_owned());
    for inner in command.get_subcommands().filter(|inner| !inner.is_hide_set()) {
        pages_of(&format!("{name}-{}", inner.get_name()), inner.clone(), pages)?;
    }
    pages.push((name.to_owned(), page(command)?));
    Ok(())
}

/// A command whose page does not list `help`, which has no page.
fn without_help(command: Command) -> Command {
    let has_help = command.get_subcommands().any(|inner| inner.get_name() == "help");
    if has_help { command.mut_subcommand("help", |help| help.hide(true)) } else { command }
}

fn page(command: Command) -> Result<Vec<u8>, Failure> {
    let mut text = Vec::new();
    let rendered = clap_mangen::Man::new(command).render(&mut text);
    rendered.map_err(|error| Failure::new(Exit::Content, format!("the page cannot be written: {error}")))?;
    Ok(text)
}
