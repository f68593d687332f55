//! Makes the tables of linearly transformed cosines, and measures the lights of `shader_lib/ltc.glsl` by integration.
//!
//! ```sh
//! cargo run --release -p glisten-studies --bin ltc > crates/scene/src/load/ltc.txt   # half a minute
//! cargo run --release -p glisten-studies --bin ltc -- errors
//! ```

#![expect(clippy::print_stdout, clippy::print_stderr, reason = "a program for the terminal")]

mod errors;
mod fit;
mod ggx;

use std::process::ExitCode;

fn main() -> ExitCode {
    match std::env::args().nth(1).as_deref() {
        None => {
            for row in 0..fit::SIZE {
                for column in 0..fit::SIZE {
                    println!("{}", fit::line(&fit::entry(column, row)));
                }
            }
        }
        Some("errors") => match errors::rows(20_000, 24).and_then(|rows| Ok((rows, errors::skies()?))) {
            Ok((rows, skies)) => {
                rows.iter().for_each(|row| println!("{row}"));
                for (roughness, parts) in skies {
                    let parts: Vec<String> = parts.iter().map(|part| format!("{part:.3}")).collect();
                    println!("| {roughness} | {} |", parts.join(" | "));
                }
            }
            Err(message) => {
                eprintln!("{message}");
                return ExitCode::FAILURE;
            }
        },
        Some(other) => {
            eprintln!("unknown argument `{other}`; there is `errors`");
            return ExitCode::from(2);
        }
    }
    ExitCode::SUCCESS
}
