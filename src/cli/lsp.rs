//! `glisten lsp`: the language server, over standard input and output.
//!
//! *In:* messages of an editor. *Out:* its answers ([`crate::lsp`]). *Holds:* nothing but messages is written to standard output.

use super::args::{BindingArgs, LevelArgs, SourceArgs};
use super::console::Console;
use super::exit::{Exit, Failure, Outcome};
use super::lsp_project::Files;
use crate::lsp;
use clap::Args;

/// Serve an editor: the language server protocol over standard input and output
#[derive(Args, Debug)]
#[command(mut_arg("diagnostics", |argument| argument.hide(true)))]
pub(super) struct LspArgs {
    /// Accepted because editors pass it: there is no other channel
    #[arg(long, hide = true)]
    stdio: bool,
    #[command(flatten)]
    sources: SourceArgs,
    #[command(flatten)]
    levels: LevelArgs,
    #[command(flatten)]
    bindings: BindingArgs,
}

/// Runs the command.
pub(super) fn run(args: &LspArgs, console: &Console) -> Outcome {
    let mut project = Files::new(console, &args.sources, &args.levels, &args.bindings)?;
    match lsp::serve(&mut project) {
        Ok(true) => Ok(Exit::Ok),
        // "The server should exit with ... 1 if there was no shutdown before" (LSP 3.17, exit).
        Ok(false) => Ok(Exit::Content),
        Err(error) => Err(Failure::new(Exit::Usage, format!("the editor's messages cannot be read: {error}"))),
    }
}
