//! Compiles shaders in build scripts: three lines in `build.rs`, and a Rust module with code, types and layouts.
//!
//! ```ignore
//! // The whole of build.rs, inside of `fn main`.
//! glisten::build::Build::new().folder("shaders").run();
//! ```
//!
//! ```ignore
//! // src/main.rs
//! mod shaders {
//!     include!(concat!(env!("OUT_DIR"), "/shaders.rs"));
//! }
//! let code = shaders::phong::VERTEX_WGSL;
//! ```
//!
//! *In:* programs by pairs of files, by folders or by scenes, and options. *Out:* [`Built`]: a Rust module in which each program is a module
//! with WGSL and SPIR-V, structs of its uniforms in the layout of the buffer, its vertices, and on request descriptors for wgpu.
//!
//! *Holds:* the same inputs give the same bytes, and a file whose bytes are the same is not written again. Cargo is told of
//! every file that was read. All errors of all programs are reported together. *Not done here:* what a program or a struct is
//! in Rust.

mod engine;
mod error;
mod files;
mod fixed;
mod found;
mod programs;
mod rust;
#[cfg(feature = "reference")]
mod scenes;
mod watch;

pub use error::BuildError;

use engine::Engine;
use files::Reads;
use fixed::Fixed;
use found::Compiled;
use glisten_emit::{Conventions, Target};
use glisten_front::compiler::Compilation;
use glisten_front::compiler::{Compiler, Options};
use glisten_front::diagnostic::write::human;
#[cfg(doc)]
use glisten_sources::engines;
use glisten_sources::stages;
use programs::{Given, Named};
use std::collections::BTreeSet;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use watch::Watch;

/// A build of shaders: programs, options, and where the module goes.
#[derive(Clone, Debug)]
pub struct Build {
    programs: Vec<Given>,
    options: Options,
    engine: Engine,
    fixed: Vec<Fixed>,
    conventions: Conventions,
    optimize: bool,
    rust: rust::Choices,
    file: String,
    folder: Option<PathBuf>,
    watch: Watch,
}

/// The result of a build.
#[derive(Clone, Debug)]
pub struct Built {
    /// The path of the Rust module.
    pub module: PathBuf,
    /// The text of the Rust module.
    pub text: String,
    /// The files that were read: sources and includes, in order.
    pub read: Vec<PathBuf>,
    /// Warnings, a line each.
    pub warnings: Vec<String>,
}

impl Default for Build {
    fn default() -> Self {
        Self {
            programs: Vec::new(),
            options: Options::default(),
            engine: Engine::default(),
            fixed: Vec::new(),
            conventions: Conventions::default(),
            optimize: true,
            rust: rust::Choices::default(),
            file: "shaders.rs".into(),
            folder: None,
            watch: Watch::default(),
        }
    }
}

impl Build {
    /// A build of no programs, for WGSL and SPIR-V.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a program of a vertex and a fragment shader, named after the vertex shader's file.
    #[must_use]
    pub fn program(self, vertex: impl AsRef<Path>, fragment: impl AsRef<Path>) -> Self {
        let name = stages::stem(vertex.as_ref());
        self.named_program(name, vertex, fragment)
    }

    /// Adds a program with a name of its own, for files that belong to several programs.
    #[must_use]
    pub fn named_program(
        mut self,
        name: impl Into<String>,
        vertex: impl AsRef<Path>,
        fragment: impl AsRef<Path>,
    ) -> Self {
        let (vertex, fragment) = (vertex.as_ref().to_owned(), fragment.as_ref().to_owned());
        self.programs.push(Given::Pair(Named { name: name.into(), vertex, fragment, member: None }));
        self
    }

    /// Adds all programs of a folder and of the folders below it: a vertex and a fragment shader of the same name each, and
    /// files that contain both. Names tell stages as they do for `glisten lint`: `x.vert`, `x.vsh`, `x.vert.glsl`, `x_vs.glsl`.
    #[must_use]
    pub fn folder(mut self, folder: impl AsRef<Path>) -> Self {
        self.programs.push(Given::Folder(folder.as_ref().to_owned()));
        self
    }

    /// Lets Cargo watch the files of folders that were read, and not the folders. Then an edit of another file in them runs
    /// nothing, and a new program is found when one of the known files changes.
    #[must_use]
    pub fn watch_files(self) -> Self {
        Self { watch: Watch::Files, ..self }
    }

    /// Adds a folder to the search path of `#include`, like `-I`.
    #[must_use]
    pub fn include(mut self, folder: impl AsRef<Path>) -> Self {
        self.engine.folders.push(folder.as_ref().to_owned());
        self
    }

    /// Completes the sources as an engine does, like `--engine`: `minecraft`, `libretro`, `three`, `shadertoy` and so on. The
    /// names are those of [`engines::names`].
    #[must_use]
    pub fn engine(mut self, name: impl Into<String>) -> Self {
        self.engine.name = Some(name.into());
        self
    }

    /// Reads a file before each source, like `--prelude`.
    #[must_use]
    pub fn prelude(mut self, file: impl AsRef<Path>) -> Self {
        self.engine.preludes.push(file.as_ref().to_owned());
        self
    }

    /// The version of sources without a `#version` line, like `--assume-version`: `330`, `150 core`, `300 es`.
    #[must_use]
    pub fn assume_version(mut self, version: impl Into<String>) -> Self {
        self.engine.version = Some(version.into());
        self
    }

    /// Defines a macro before the first line of each shader, like `-D NAME=VALUE`.
    #[must_use]
    pub fn define(mut self, name: impl Into<String>, value: impl Into<String>) -> Self {
        self.options.defines.push((name.into(), value.into()));
        self
    }

    /// Binds an attribute to a location, like `glBindAttribLocation`.
    #[must_use]
    pub fn bind_attribute(mut self, name: impl Into<String>, location: u32) -> Self {
        self.options.attribute_locations.push((name.into(), location));
        self
    }

    /// Binds an output to a color number, like `glBindFragDataLocation`.
    #[must_use]
    pub fn bind_output(mut self, name: impl Into<String>, number: u32) -> Self {
        self.options.frag_data_locations.push((name.into(), number));
        self
    }

    /// Replaces the conventions of the host: the range of clip-space z, the window's origin, points.
    #[must_use]
    pub fn conventions(self, conventions: Conventions) -> Self {
        Self { conventions, ..self }
    }

    /// Keeps what reaches no output, like `-O0`.
    #[must_use]
    pub fn keep_everything(self) -> Self {
        Self { optimize: false, ..self }
    }

    /// Leaves SPIR-V out of the module.
    #[must_use]
    pub fn without_spirv(mut self) -> Self {
        self.rust.targets.retain(|target| *target != Target::Spirv);
        self
    }

    /// Adds the code of another target: `VERTEX_MSL` and so on.
    #[must_use]
    pub fn target(mut self, target: Target) -> Self {
        if !self.rust.targets.contains(&target) {
            self.rust.targets.push(target);
        }
        self
    }

    /// Fixes a uniform in every program that has it, and leaves out what that makes needless: a count of lights, a
    /// switch. The name is that of the reflection (`lights`, `light[1].power`, `Block.member`). The numbers are those of
    /// its components, of all elements and by columns; they become its type, a `bool` by whether they are not 0.
    #[must_use]
    pub fn fix(mut self, uniform: impl Into<String>, numbers: impl Into<Vec<f64>>) -> Self {
        self.fixed.push(Fixed { name: uniform.into(), numbers: numbers.into() });
        self
    }

    /// Adds the programs of a scene's draws, each of which is named like the scene, with a number if there are several.
    #[cfg(feature = "reference")]
    #[must_use]
    pub fn scene(mut self, scene: impl AsRef<Path>) -> Self {
        self.programs.push(Given::Scene { path: scene.as_ref().to_owned(), specialized: false });
        self
    }

    /// Adds the programs of a scene's draws without what its picture does not need, like `glisten specialize`. Only
    /// what the scene calls `dynamic` stays an input.
    #[cfg(feature = "reference")]
    #[must_use]
    pub fn specialized_scene(mut self, scene: impl AsRef<Path>) -> Self {
        self.programs.push(Given::Scene { path: scene.as_ref().to_owned(), specialized: true });
        self
    }

    /// Derives `bytemuck::Pod` and `bytemuck::Zeroable` for structs. The crate needs `bytemuck` with its feature `derive`.
    #[must_use]
    pub fn bytemuck(mut self) -> Self {
        self.rust.bytemuck = true;
        self
    }

    /// Lets setters take vectors and matrices of `glam`.
    #[must_use]
    pub fn glam(mut self) -> Self {
        self.rust.glam = true;
        self
    }

    /// Adds descriptors and constructors for `wgpu` 30: vertex buffer layouts, bind groups, pipelines.
    #[must_use]
    pub fn wgpu(mut self) -> Self {
        self.rust.wgpu = true;
        self
    }

    /// Steps an attribute by instance: it becomes a field of `Instance` instead of `Vertex`.
    #[must_use]
    pub fn instanced(mut self, attribute: impl Into<String>) -> Self {
        self.rust.instanced.push(attribute.into());
        self
    }

    /// The name of the module's file in its folder; `shaders.rs` by default.
    #[must_use]
    pub fn output(self, file: impl Into<String>) -> Self {
        Self { file: file.into(), ..self }
    }

    /// The folder of the module's file, instead of `OUT_DIR`.
    #[must_use]
    pub fn output_folder(self, folder: impl AsRef<Path>) -> Self {
        Self { folder: Some(folder.as_ref().to_owned()), ..self }
    }

    /// Builds, tells Cargo which files were read, prints warnings, and writes the module to `OUT_DIR`. Errors are told to Cargo,
    /// as `glisten lint` prints them, and end its build after the script. It is the last line of a build script.
    #[expect(clippy::print_stdout, reason = "Cargo reads what a build script prints")]
    pub fn run(self) {
        let (read, word, lines) = match self.build() {
            Ok(built) => (built.read, "warning", built.warnings),
            Err(error) => (error.read().to_vec(), "error", error.to_string().lines().map(str::to_owned).collect()),
        };
        for file in self.watch.paths(&read) {
            println!("cargo::rerun-if-changed={}", file.display());
        }
        for line in lines {
            println!("cargo::{word}={line}");
        }
    }

    /// Builds and writes the module, and tells nobody.
    ///
    /// # Errors
    /// [`BuildError`]: all errors of all programs, or that a file cannot be read or written.
    pub fn build(&self) -> Result<Built, BuildError> {
        let folder = match &self.folder {
            Some(folder) => folder.clone(),
            None => std::env::var_os("OUT_DIR").map(PathBuf::from).ok_or(BuildError::NoFolder)?,
        };
        let built = self.text()?;
        let module = folder.join(&self.file);
        files::write(&module, &built.text)?;
        Ok(Built { module, ..built })
    }

    /// Builds the text of the module without writing it.
    ///
    /// # Errors
    /// Those of [`Build::build`].
    pub fn text(&self) -> Result<Built, BuildError> {
        let reads = Reads::default();
        let completed = self.engine.completed(&reads)?;
        let compiler =
            Compiler::new(self.options.clone()).with_includes(completed.includes()).with_preparation(completed);
        let found = programs::compile(&self.programs, &compiler, &reads)?;
        fixed::check(&self.fixed, &found)?;
        let (mut modules, mut errors) = (Vec::new(), found.errors);
        for Compiled { name, program, sources } in found.programs {
            let program = fixed::without_known(&self.fixed, program, &sources)?;
            let program = if self.optimize { glisten_specialize::optimize(&program) } else { program };
            match rust::module(&name, &program, &sources, &self.conventions, &self.rust) {
                Ok(module) => modules.push(module),
                Err(found) => errors.push_str(&human(&sources, &found, false)),
            }
        }
        if !errors.is_empty() {
            return Err(BuildError::Shaders { text: errors, read: reads.files() });
        }
        let text = joined(&modules);
        Ok(Built { module: PathBuf::new(), text, read: reads.files(), warnings: found.warnings })
    }
}

/// The file of all modules.
fn joined(modules: &[String]) -> String {
    let mut text = rust::opening();
    for module in modules {
        // Writing to a string cannot fail.
        let _ = write!(text, "\n{module}");
    }
    text
}

/// The module for wgpu of programs that are compiled already, as WGSL. The names of their files are relative to `root`.
///
/// # Errors
/// What WGSL cannot represent, as `glisten compile` prints it.
pub fn wgpu_module(programs: &[(String, Compilation)], root: &Path) -> Result<String, String> {
    let targets = vec![Target::Wgsl];
    let choices = rust::Choices { targets, wgpu: true, root: Some(root.to_owned()), ..rust::Choices::default() };
    module_of(programs, &choices)
}

/// The structs of the uniforms and of the vertices of programs that are compiled already, as Rust without code of shaders.
///
/// # Errors
/// Those of programs, as `glisten compile` prints them.
pub fn rust_structs(programs: &[(String, Compilation)]) -> Result<String, String> {
    module_of(programs, &rust::Choices { targets: Vec::new(), ..rust::Choices::default() })
}

/// The structs of the uniforms of a program that is compiled already, as a header of C; `None` if it has errors.
pub fn c_structs(name: &str, compilation: &Compilation) -> Option<String> {
    let program = compilation.program.as_ref()?;
    Some(rust::header(name, program, &compilation.sources, &Conventions::default()))
}

/// The file with a module for each program.
fn module_of(programs: &[(String, Compilation)], choices: &rust::Choices) -> Result<String, String> {
    let (mut modules, mut errors) = (Vec::new(), String::new());
    for (name, Compilation { program, sources, .. }) in programs {
        let Some(program) = program else { continue };
        match rust::module(name, program, sources, &Conventions::default(), choices) {
            Ok(module) => modules.push(module),
            Err(found) => errors.push_str(&human(sources, &found, false)),
        }
    }
    if errors.is_empty() { Ok(joined(&modules)) } else { Err(errors) }
}

/// Names of which each may be given once.
fn repeated<'n>(names: impl Iterator<Item = &'n str>) -> Option<&'n str> {
    let mut seen = BTreeSet::new();
    names.into_iter().find(|name| !seen.insert(*name))
}
