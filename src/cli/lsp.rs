//! `glisten lsp`: the language server, over standard input and output.
//!
//! *In:* messages of an editor. *Out:* its answers ([`crate::lsp`]). *Holds:* nothing but messages is written to standard output.

use super::args::{BindingArgs, LevelArgs, SourceArgs};
use super::baseline::{Baseline, BaselineArgs};
use super::console::Console;
use super::examples::Examples;
use super::exit::{Exit, Outcome};
use super::lsp_channel;
use super::lsp_project::Files;
use crate::lsp;
use clap::Args;
use std::path::PathBuf;

/// Examples of its use.
pub(super) const EXAMPLES: Examples = &[
    ("glisten lsp", "what an editor starts: docs/editors.md"),
    ("glisten lsp -I include --engine minecraft", "with a search path and an engine, where glisten.toml has none"),
];

/// Serve an editor: the language server protocol over standard input and output
#[derive(Args, Debug)]
#[command(mut_arg("diagnostics", |argument| argument.hide(true)))]
pub(super) struct LspArgs {
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
pub(super) fn run(args: &LspArgs, console: &Console) -> Outcome {
    let baseline = Baseline::new(&BaselineArgs::of(args.baseline.clone()))?;
    let mut project = Files::new(console, &args.sources, &args.levels, &args.bindings, baseline)?;
    let (connection, channel) = lsp_channel::connect();
    let is_shut_down = lsp::serve(&mut project, connection);
    channel.finish();
    // "The server should exit with ... 1 if there was no shutdown before" (LSP 3.17, exit).
    Ok(if is_shut_down { Exit::Ok } else { Exit::Content })
}
