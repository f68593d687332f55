//! The extension module `glisten._glisten`: what `glisten/__init__.py` is built on.
//!
//! *In:* texts, words and functions of Python. *Out:* bytes and JSON; the Python side makes objects and arrays of them. *Holds:*
//! other threads of Python run while glisten works. An exception in a function that is asked for an include is raised again.

mod failure;
mod input;
mod program;
mod scene;
mod upgrade;

/// The functions and types of the module.
#[pyo3::pymodule(name = "_glisten")]
mod module {
    #[pymodule_export]
    use super::input::Settings;
    #[pymodule_export]
    use super::program::{Program, compile};
    #[pymodule_export]
    use super::scene::{Scene, load};
    #[pymodule_export]
    use super::upgrade::{Upgraded, upgrade};

    #[pymodule_export]
    const VERSION: &str = glisten_binding::VERSION;
}
