//! The `glisten` program: hands over to the command line.

use std::process::ExitCode;

fn main() -> ExitCode {
    glisten::cli::run(std::env::args_os())
}
