//! Scene files, with the programs of the library and the engines at hand.
//!
//! *In:* the path of a scene, or of a model (`.obj`, `.gltf`, `.glb`), which gets the scene of [`portrait`]. *Out:* [`Loaded`].

mod models;

#[cfg(feature = "stability")]
use glisten_front::compiler::Kept;
use glisten_front::compiler::SourceSettings;
use glisten_front::source::IncludeResolver;
use glisten_front::{Compiler, Program};
use glisten_library::Embedded;
use glisten_sources::engines;
use glisten_sources::{Search, completing, parse_version};
use std::collections::BTreeSet;
use std::sync::Arc;

pub use glisten_scene::{
    AttributeData, AttributeValues, Blend, BlendFactor, Compare, Cull, DiskFiles, Draw, FileError, FileSource, Filter,
    FixedDraw, Format, Framebuffer, Library, Loaded, MAX_ATTACHMENTS, MAX_PIXELS, MAX_SIDE, MemoryFiles, NoLibrary,
    Portrait, PortraitError, Primitive, Sampling, Scene, State, Texels, Texture, TextureLevel, Wrap, is_model_file,
    portrait,
};

/// Loads the scene at `path`, whose draws may name programs of the library, and engines that complete their sources.
/// A model gets a scene of its own.
pub fn load(path: &str, files: &dyn FileSource, compiler: &Compiler) -> Loaded {
    loaded(path, files, |path, files| glisten_scene::load(path, files, &WithEngines, compiler))
}

/// Loads like [`load`]. Programs whose sources did not change are those that were kept.
#[cfg(feature = "stability")]
pub fn load_kept(path: &str, files: &dyn FileSource, compiler: &Compiler, kept: &mut Kept) -> Loaded {
    loaded(path, files, |path, files| glisten_scene::load_kept(path, files, (&WithEngines, compiler), kept))
}

fn loaded(path: &str, files: &dyn FileSource, load: impl FnOnce(&str, &dyn FileSource) -> Loaded) -> Loaded {
    if is_model_file(path) { models::load(path, files, load) } else { load(path, files) }
}

/// The library, and the engines.
struct WithEngines;

impl Library for WithEngines {
    fn program(&self, name: &str) -> Option<(&'static str, &'static str)> {
        Embedded.program(name)
    }

    fn program_names(&self) -> Vec<&'static str> {
        Embedded.program_names()
    }

    fn shader(&self, file: &str) -> Option<&'static str> {
        Embedded.shader(file)
    }

    fn shader_names(&self) -> Vec<&'static str> {
        Embedded.shader_names()
    }

    fn includes(&self) -> Arc<dyn IncludeResolver + Send + Sync> {
        Library::includes(&Embedded)
    }

    fn values_read(&self, program: &str) -> Option<&BTreeSet<String>> {
        Embedded.values_read(program)
    }

    fn attributes_that_reach(&self, program: &Program, sizes_points: bool) -> Vec<bool> {
        Embedded.attributes_that_reach(program, sizes_points)
    }

    fn engines(&self) -> Vec<&'static str> {
        engines::names().collect()
    }

    fn include_styles(&self) -> Vec<&'static str> {
        engines::STYLES.iter().map(|row| row.name).collect()
    }

    fn checked_version(&self, text: &str) -> Result<String, String> {
        parse_version(text)
    }

    fn completing(&self, compiler: Compiler, settings: &SourceSettings) -> Compiler {
        completing(compiler, settings, Search::EngineFirst)
    }
}
