//! [`Library`]: the programs that a scene may name without files of its own.
//!
//! *In:* what the package with the texts hands down. *Out:* programs by name, shaders by file name, modules to include.
//! *Holds:* this crate embeds no GLSL.

use glisten_front::compiler::{Compiler, SourceSettings};
use glisten_front::link::Program;
use glisten_front::source::{IncludeForm, IncludeResolver, Included, NoIncludes};
use std::collections::BTreeSet;
use std::sync::Arc;

/// Programs, and the modules that they include.
pub trait Library {
    /// The vertex and the fragment shader's file of a program (`program = "standard"`).
    fn program(&self, name: &str) -> Option<(&'static str, &'static str)>;

    /// The names of all programs.
    fn program_names(&self) -> Vec<&'static str>;

    /// The text of a shader by its file name (`<glisten/programs/phong.frag>`).
    fn shader(&self, file: &str) -> Option<&'static str>;

    /// The file names of all shaders.
    fn shader_names(&self) -> Vec<&'static str>;

    /// Resolves `#include <glisten/...>`.
    fn includes(&self) -> Arc<dyn IncludeResolver + Send + Sync>;

    /// The values of lights and materials that a program of this name reads
    /// ([`scene_values_read`](crate::scene_values_read)); `None` if it is not known. It serves help texts.
    fn values_read(&self, _program: &str) -> Option<&BTreeSet<String>> {
        None
    }

    /// The names of the engines that complete sources.
    fn engines(&self) -> Vec<&'static str> {
        Vec::new()
    }

    /// The names of the styles in which sources name the files that they include.
    fn include_styles(&self) -> Vec<&'static str> {
        Vec::new()
    }

    /// A version as a `#version` line has it.
    ///
    /// # Errors
    /// It is none; the message says why.
    fn checked_version(&self, text: &str) -> Result<String, String> {
        Ok(text.to_owned())
    }

    /// The compiler for sources about which a draw says more.
    fn completing(&self, compiler: Compiler, settings: &SourceSettings) -> Compiler {
        compiler.with_settings(settings).unwrap_or(compiler)
    }

    /// For each attribute of a program whether it can reach a position or an output, or where `sizes_points` the size of a point. By default
    /// each that is read can.
    fn attributes_that_reach(&self, program: &Program, _sizes_points: bool) -> Vec<bool> {
        program.interface.attributes.iter().map(|attribute| attribute.active).collect()
    }
}

/// A library without anything in it.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoLibrary;

impl Library for NoLibrary {
    fn program(&self, _: &str) -> Option<(&'static str, &'static str)> {
        None
    }

    fn program_names(&self) -> Vec<&'static str> {
        Vec::new()
    }

    fn shader(&self, _: &str) -> Option<&'static str> {
        None
    }

    fn shader_names(&self) -> Vec<&'static str> {
        Vec::new()
    }

    fn includes(&self) -> Arc<dyn IncludeResolver + Send + Sync> {
        Arc::new(NoIncludes)
    }
}

/// Includes of a user, and those of the library where the user's have none of that name.
pub(super) struct WithLibrary {
    pub(super) own: Arc<dyn IncludeResolver + Send + Sync>,
    pub(super) library: Arc<dyn IncludeResolver + Send + Sync>,
}

impl IncludeResolver for WithLibrary {
    fn resolve(&self, path: &str, form: IncludeForm, from: &str) -> Result<Included, String> {
        self.own.resolve(path, form, from).or_else(|error| self.library.resolve(path, form, from).map_err(|_| error))
    }
}
