//! Declarations at global scope (§4.2, §4.3, §6.1): what a shader declares, entered as globals, types and functions.
//!
//! * [`variable`]: variables and their initializers; [`interface`]: which types may cross which interface.
//! * [`structure`]: structs. [`block`]: interface blocks. [`function`]: prototypes and definitions.
//! * [`builtin`]: built-in variables, used or redeclared. [`requalify`]: `invariant a;`, `layout(..) in;`.
//! * [`geometry`]: the layouts of a geometry shader, and the input sizes that depend on them.

mod block;
mod builtin;
mod fixed;
mod function;
mod geometry;
mod interface;
mod naming;
mod per_vertex;
mod requalify;
mod structure;
mod variable;
