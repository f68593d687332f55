//! The language server: the protocol's requests, answered from what the compiler knows of whole programs.
//!
//! ```text
//!  messages ──► server ──► state ──────────────► requests ──► answers
//!               order,     documents, programs,  one file
//!               panics     analyses              for each
//! ```
//!
//! *In:* messages of an editor (Language Server Protocol 3.17) over standard input, and a [`Project`], which knows the files. *Out:*
//! answers and diagnostics on standard output. *Holds:* changes are applied in the order of the messages; a request is answered
//! from the texts as they are at its turn; a panic in it is its error, and the next one is answered. What the compiler understands
//! of a broken text is used; where it understands nothing, the text is cut before the break and read again.

mod analysis;
mod builtins;
mod client;
mod constructors;
mod cut;
mod describe;
mod project;
mod requests;
mod server;
mod state;
mod text;
mod uri;

pub use project::{Choice, Compiled, Drawn, Overlay, Piece, ProgramKey, Project, Shown};

use lsp_server::Connection;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Serves an editor until the connection or the editor ends it. Returns whether it asked for the shutdown.
pub fn serve(project: &mut dyn Project, connection: Connection) -> bool {
    let is_shut_down = server::serve(project, &connection);
    project.end();
    drop(connection);
    is_shut_down
}

/// Runs work; a panic in it is an error.
fn guard(work: impl FnOnce()) -> Result<(), String> {
    // What the work changed is made again afterwards.
    catch_unwind(AssertUnwindSafe(work)).map_err(|payload| {
        let text = payload.downcast_ref::<&str>().map(|text| (*text).to_owned());
        text.or_else(|| payload.downcast_ref::<String>().cloned()).unwrap_or_else(|| "a panic".to_owned())
    })
}
