//! `glisten cache`: how much the cache of `compile` and `lint` holds, and how to empty it.
//!
//! *Holds:* only a folder that glisten has marked as a cache is cleaned.

use super::args::ResultFormat;
use super::cache::{CacheArgs, Kind, Store};
use super::console::Console;
use super::examples::Examples;
use super::exit::{Exit, Failure, Outcome};
use clap::{Args, Subcommand};
use serde::Serialize;

/// Examples of its use.
pub(super) const EXAMPLES: Examples = &[
    ("glisten cache stats --cache .glisten-cache", "how much a cache holds"),
    ("glisten cache clean --cache .glisten-cache", "an empty cache"),
];

/// See what the cache of `compile` and `lint` holds, or clean it
#[derive(Args, Debug)]
pub(super) struct CacheCommandArgs {
    #[command(subcommand)]
    action: Action,
}

#[derive(Debug, Subcommand)]
enum Action {
    /// Print how much it holds
    Stats {
        /// The format of the result
        #[arg(long, value_enum, default_value_t)]
        format: ResultFormat,
        #[command(flatten)]
        cache: CacheArgs,
    },
    /// Remove everything, or with --cache-limit, what has not been used for longest
    Clean {
        #[command(flatten)]
        cache: CacheArgs,
    },
}

#[derive(Serialize)]
struct Stats {
    folder: String,
    results: usize,
    outputs: usize,
    bytes: u64,
    limit: u64,
}

/// Runs the command.
pub(super) fn run(args: &CacheCommandArgs, console: &Console) -> Outcome {
    match &args.action {
        Action::Stats { format, cache } => {
            let (folder, store) = opened(cache)?;
            if store.is_there() {
                store.sweep();
            }
            let entries = store.entries();
            let count = |kind| entries.iter().filter(|entry| entry.kind == kind).count();
            let stats = Stats {
                folder,
                results: count(Kind::Result),
                outputs: count(Kind::Bytes),
                bytes: entries.iter().map(|entry| entry.bytes).sum(),
                limit: cache.limit()?,
            };
            console.output(&shown(&stats, *format))?;
        }
        Action::Clean { cache } => {
            let (folder, store) = opened(cache)?;
            if !store.is_there() && !store.entries().is_empty() {
                let message = format!("`{folder}` was not made by glisten: it has no CACHEDIR.TAG");
                return Err(Failure::usage(message).help("remove it by hand if it is a cache"));
            }
            let removed = store.clean(cache.given_limit().unwrap_or(0));
            console.remark(&format!("{removed} entries removed"));
        }
    }
    Ok(Exit::Ok)
}

fn opened(cache: &CacheArgs) -> Result<(String, Store), Failure> {
    let folder = cache.folder().ok_or_else(|| {
        Failure::usage("no cache is named").help("add `--cache DIR`, or set GLISTEN_CACHE in the environment")
    })?;
    Ok((folder.display().to_string(), Store::new(&folder)))
}

fn shown(stats: &Stats, format: ResultFormat) -> String {
    if format == ResultFormat::Json {
        return serde_json::to_string_pretty(stats).expect("texts and numbers are always JSON") + "\n";
    }
    let megabytes = |bytes: u64| format!("{:.1} MiB", bytes as f64 / f64::from(1 << 20));
    let Stats { folder, results, outputs, bytes, limit } = stats;
    format!(
        "folder   {folder}\nresults  {results}\noutputs  {outputs}\nsize     {} of {}\n",
        megabytes(*bytes),
        megabytes(*limit)
    )
}
