//! `glisten lsp`: the language server, over standard input and output.
//!
//! *In:* messages of an editor. *Out:* its answers ([`glisten_lsp`]). *Holds:* nothing but messages is written to standard output.

mod channel;
mod drawing;
mod files;
mod judged;
mod project;
mod shown;
use crate::arguments::args::{BindingArgs, LevelArgs, SourceArgs};
use crate::baseline::{Baseline, BaselineArgs};
use crate::commands::examples::Examples;
use crate::commands::lsp::project::Files;
use crate::console::Console;
use crate::exit::{Exit, Outcome};
use clap::Args;
use std::path::PathBuf;

/// Examples of its use.
pub(crate) const EXAMPLES: Examples = &[
    ("glisten lsp", "what an editor starts: docs/editors.md"),
    ("glisten lsp -I include --engine minecraft", "with a search path and an engine, where glisten.toml has none"),
];

/// Serve an editor: the language server protocol over standard input and output
#[derive(Args, Debug)]
#[command(mut_arg("diagnostics", |argument| argument.hide(true)))]
pub(crate) struct LspArgs {
    /// Accepted because editors pass it: there is no other channel
    #[arg(long, hide = true)]
    stdio: bool,
    /// Leave out the findings that this file lists, as `glisten lint --baseline` does
    #[arg(long, value_name = "FILE")]
    baseline: Option<PathBuf>,
    #[command(flatten)]
    sources: SourceArgs,
    #[command(flatten)]
    levels: LevelArgs,
    #[command(flatten)]
    bindings: BindingArgs,
}

/// Runs the command.
pub(crate) fn run(args: &LspArgs, console: &Console) -> Outcome {
    let baseline = Baseline::new(&BaselineArgs::of(args.baseline.clone()))?;
    let mut project = Files::new(console, &args.sources, &args.levels, &args.bindings, baseline)?;
    let (connection, channel) = channel::connect();
    let is_shut_down = glisten_lsp::serve(&mut project, connection);
    channel.finish();
    // "The server should exit with ... 1 if there was no shutdown before" (LSP 3.17, exit).
    Ok(if is_shut_down { Exit::Ok } else { Exit::Content })
}
