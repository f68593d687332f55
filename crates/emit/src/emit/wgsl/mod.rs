//! Writes WGSL as a person would: a tree built from naga's module and from what the source says (names, comments,
//! declarations), printed once.
//!
//! ```text
//!  module ──► effects ──► plan ──► function ──► declarations ──► body_comments ──► scopes ──► print
//!     └─────► names ──────────────────┘ (expressions, loops)
//! ```
//!
//! *In:* a validated module, and the comments of the source. *Out:* its text. *Holds:* for every fixture, naga reads the
//! text as the very module that it came from, before declarations move (`tests`).
//!
//! | file | contents |
//! | --- | --- |
//! | `module` | structs, variables, heads of functions |
//! | `names`, `scopes` | names of the module, names of locals |
//! | `effects`, `order`, `plan` | which values have names, and which are written where they are used |
//! | `function`, `expressions`, `lookups`, `inverse` | statements and expressions |
//! | `loops`, `declarations` | `for`, `while`, `+=`; `let` and `var` at their places |
//! | `notes`, `comments`, `body_comments`, `commented` | comments next to declarations, in WGSL's form, inside of functions, and the statements that they may belong to |
//! | `tree`, `levels`, `print` | the tree and its text |

mod body_comments;
mod commented;
mod comments;
mod declarations;
mod effects;
mod expressions;
mod function;
mod inverse;
mod levels;
mod lookups;
mod loops;
mod module;
mod names;
mod notes;
mod order;
mod plan;
mod print;
mod scopes;
#[cfg(test)]
mod tests;
mod tree;

pub(super) use comments::header;
pub(super) use notes::Notes;

use super::emitted::Origin;

/// How far to go.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Style {
    /// Only what naga reads as the same module.
    #[cfg(test)]
    Same,
    /// Declarations at the first use, and the shortest words, too.
    Full,
}

/// Writes a module. Returns which lines come from which places of the source, too: heads of functions and statements.
///
/// # Errors
/// The message of an internal error: what WGSL does not have.
pub(super) fn write(
    module: &naga::Module,
    info: &naga::valid::ModuleInfo,
    style: Style,
    notes: &Notes<'_>,
) -> Result<(String, Vec<Origin>), String> {
    module::write(module, info, style, notes)
}
