//! `glisten man`: manual pages of the program and its commands.

use super::Cli;
use super::console::Console;
use super::examples::Examples;
use super::exit::{Exit, Failure, Outcome};
use super::files;
use clap::{Args, Command, CommandFactory};
use std::path::PathBuf;

/// Examples of its use.
pub(super) const EXAMPLES: Examples = &[("glisten man -o ~/.local/share/man/man1", "then: man glisten-lint")];

/// Write manual pages: glisten.1, and one for each command
#[derive(Args, Debug)]
pub(super) struct ManArgs {
    /// The output folder (default: glisten.1 to standard output)
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
}

/// Runs the command.
pub(super) fn run(args: &ManArgs, console: &Console) -> Outcome {
    let mut program = super::examples::with_examples(Cli::command());
    program.build();
    let Some(folder) = &args.output else {
        console.output_bytes(&page(program)?)?;
        return Ok(Exit::Ok);
    };
    files::make_folder(folder)?;
    let commands: Vec<Command> = program.get_subcommands().filter(|it| it.get_name() != "help").cloned().collect();
    let mut n_pages = 1;
    for command in commands {
        let name = format!("glisten-{}", command.get_name());
        // The page is found by `man glisten-lint`, and its synopsis says `glisten lint`.
        let command = command.display_name(name.clone());
        files::write(&folder.join(format!("{name}.1")), &page(command)?)?;
        n_pages += 1;
    }
    files::write(&folder.join("glisten.1"), &page(program)?)?;
    console.remark(&format!("wrote {n_pages} pages to {}", folder.display()));
    Ok(Exit::Ok)
}

fn page(command: Command) -> Result<Vec<u8>, Failure> {
    let mut text = Vec::new();
    let rendered = clap_mangen::Man::new(command).render(&mut text);
    rendered.map_err(|error| Failure::new(Exit::Content, format!("the page cannot be written: {error}")))?;
    Ok(text)
}
