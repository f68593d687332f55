//! Texts of GLSL for OpenGL as texts for Vulkan (GL_KHR_vulkan_glsl), by edits: sets, bindings and locations, the loose uniforms as
//! members of blocks, coordinates by the defaults of `glisten compile`. [`to_vulkan`] takes one program, [`tree()`] many that share files.
//!
//! *In:* compilers, and the sources of programs that compile. *Out:* new texts. *Holds:* comments, macros and layout stay. The new texts,
//! read as OpenGL's, compile, too, and have the same interface.
//!
//! | file | contents |
//! | --- | --- |
//! | `dialect` | what a host wants |
//! | `chunks`, `conditions` | a text cut into its declarations; its directives |
//! | `includes`, `files` | what includes name; the texts of a tree, each once |
//! | `facts`, `unseen` | what each declaration is; those that no program sees |
//! | `samplers` | uniforms for samplers in structs |
//! | `numbers`, `layouts` | locations and bindings; the blocks of the loose uniforms |
//! | `definitions`, `place` | where names begin to mean something; where the block goes |
//! | `declarations`, `coordinates` | the edits of declarations; of `gl_Position`, `gl_FragCoord`, `dFdy`, indices |
//! | `style` | indentation, braces, columns of comments |
//! | `text` | the new text of one file |
//! | `tree`, `output` | all of them, in order; the result |
//! | `check` | the new texts, read as OpenGL's |

mod check;
mod chunks;
mod conditions;
mod coordinates;
mod declarations;
mod definitions;
mod dialect;
mod facts;
mod files;
mod includes;
mod layouts;
mod numbers;
mod output;
mod place;
mod qualifiers;
mod samplers;
mod style;
mod text;
mod tree;
mod unseen;

pub(crate) use conditions::Conditions;
pub use coordinates::converts_depth;
pub use dialect::{Dialect, HostBlock, Numbering, plain};
pub use includes::Includes;
pub use output::{NewFile, NewTree, Note, TreeProgram, moved_path, with_version};
pub use tree::tree;

use glisten_front::compiler::{Compilation, Compiler, Source};
use glisten_front::hir::Stage;
use glisten_front::link::Program;

/// A file, and the stage that it is for, if each stage has its own text of it.
type Key = (String, Option<Stage>);

/// A program of a tree, compiled.
#[derive(Clone, Copy)]
struct Compiled<'a> {
    index: usize,
    unit: &'a TreeProgram,
    compilation: &'a Compilation,
    pub program: &'a Program,
}

/// The new texts of the sources of a program, in their order. Files that the sources include are not written, so none may change.
///
/// # Errors
/// The reason why a source cannot be rewritten.
pub fn to_vulkan(compiler: &Compiler, sources: &[Source]) -> Result<Vec<String>, String> {
    let program = TreeProgram { compiler: compiler.clone(), sources: sources.to_vec() };
    let new = tree(&[program], Some(&Dialect::default()));
    if let Some(reason) = new.refused.into_iter().flatten().next() {
        return Err(reason);
    }
    let is_source = |file: &&NewFile| !sources.iter().any(|source| source.name == file.name);
    if let Some(file) = new.files.iter().filter(|file| file.text != file.old).find(is_source) {
        return Err(format!("`{}` changes, too, and is not among the sources", file.name));
    }
    let text = |source: &Source| {
        let fits = |file: &&NewFile| file.name == source.name && file.stage.is_none_or(|stage| stage == source.stage);
        new.files.iter().find(fits).map(|file| file.text.clone())
    };
    sources.iter().map(|source| text(source).ok_or_else(|| format!("`{}` was not read", source.name))).collect()
}
