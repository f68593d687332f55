//! Settles what the documents claim of highlights: that a table is faster than a computation and coarser, that colors at
//! vertices lose the highlight, and that interpolation without perspective bends (figure 137).
//!
//! ```sh
//! cargo run --release -p glisten-studies --bin claims            # work and errors: the same on every machine
//! cargo run --release -p glisten-studies --bin claims -- time    # GPU time as ratios, with their intervals
//! ```
//!
//! *Out:* Markdown, which `docs/numerics.md` contains.

#![expect(clippy::print_stdout, clippy::print_stderr, reason = "an example prints")]

mod coarse;
mod fast;
mod lost;
mod scenes;

use std::process::ExitCode;

fn main() -> ExitCode {
    let argument = std::env::args().nth(1);
    let text = match argument.as_deref() {
        None => fast::work().and_then(|fast| Ok([fast, coarse::table()?, lost::tables()?].join("\n\n"))),
        Some("time") => fast::time(),
        Some(other) => Err(format!("`{other}` is not `time`")),
    };
    match text {
        Ok(text) => {
            println!("{text}");
            ExitCode::SUCCESS
        }
        Err(message) => {
            eprintln!("error: {message}");
            ExitCode::FAILURE
        }
    }
}
