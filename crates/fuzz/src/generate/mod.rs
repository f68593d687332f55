//! Valid programs by chance, in every version of the language, with the scenes that draw them.
//!
//! ```text
//!  seed ──► a version ──► interface ──► stages, as trees ──► Program ──► texts and a scene
//!             │                              ▲                  │
//!             └── types, built-in functions ─┘                  ├──► change: what must draw the same
//!                 (glisten's tables)                            └──► shrink: what a fault does not need
//! ```
//!
//! *In:* a seed, and a version if it is to be one. *Out:* a [`Program`]. *Holds:* the same seed gives the same program. It is well-typed, and
//! has nothing that GLSL leaves undefined: no index out of bounds, no integer divided by zero, no variable that is read before it is
//! written, no derivative where invocations may have gone apart. What it contains is told by [`Program::constructs`].
//!
//! | file | contents |
//! | --- | --- |
//! | `language` | what a version has, from glisten's tables |
//! | `interface`, `uniforms`, `samplers` | varyings, uniforms, textures, and their values |
//! | `writer` | what is visible, names, parts of variables |
//! | `expressions`, `operands`, `calls`, `guards` | expressions, and arguments for which functions are defined |
//! | `statements`, `functions`, `stages` | statements, functions, whole stages |
//! | `families` | functions that are alike but for an operator or a type |
//! | `sink` | sums of what is computed, so that it reaches the picture |
//! | `tree`, `types` | what programs are made of |
//! | `change`, `spelled`, `components` | changes that leave the picture as it is |
//! | `shrink` | smaller programs |

mod calls;
mod change;
mod components;
mod expressions;
mod families;
mod functions;
mod guards;
mod interface;
mod language;
mod operands;
mod samplers;
mod shrink;
mod sink;
mod spelled;
mod stages;
mod statements;
mod tree;
mod types;
mod uniforms;
mod writer;

pub use change::{Change, changed};
pub use interface::SIDE;
pub use language::{Language, VERSIONS};
pub use shrink::shrunk;
pub use tree::{Expr, Role, Stmt, StmtPart, Use, Variable, text_of};
pub use types::Ty;

use crate::chance::Chance;
use glisten_front::{Source, Stage};
use std::collections::BTreeSet;

/// A program with its scene.
#[derive(Clone, Debug)]
pub struct Program {
    /// The number that it follows from.
    pub seed: u64,
    /// Its version.
    pub language: &'static Language,
    /// The vertex stage.
    pub vertex: Vec<Stmt>,
    /// The geometry stage; nothing if there is none.
    pub geometry: Vec<Stmt>,
    /// The fragment stage.
    pub fragment: Vec<Stmt>,
    /// The lines of the scene.
    pub scene: Vec<String>,
    /// The constructs in it.
    pub constructs: BTreeSet<&'static str>,
    /// Its macros with parameters.
    macros: Vec<writer::Macro>,
}

impl Program {
    /// The program of a seed, in a version that the seed chooses.
    pub fn new(seed: u64) -> Self {
        let mut chance = Chance::new(seed);
        let all = Language::all();
        let chosen = chance.below(all.len());
        Self::of(seed, all.get(chosen).unwrap_or_else(|| &all[0]))
    }

    /// The program of a seed in a version.
    pub fn of(seed: u64, language: &'static Language) -> Self {
        stages::program(seed, language)
    }

    /// The text of the scene, which names `a.vert`, `a.frag`, and `a.geom` if there is one.
    pub fn scene_text(&self) -> String {
        self.scene.join("\n") + "\n"
    }

    /// The texts of the stages.
    pub fn sources(&self) -> Vec<Source> {
        let all = [
            ("a.vert", &self.vertex, Stage::Vertex),
            ("a.geom", &self.geometry, Stage::Geometry),
            ("a.frag", &self.fragment, Stage::Fragment),
        ];
        let written = all.into_iter().filter(|(_, statements, _)| !statements.is_empty());
        let source = |(name, statements, stage): (&str, &Vec<Stmt>, _)| Source {
            name: name.to_owned(),
            text: text_of(statements).into(),
            stage,
        };
        written.map(source).collect()
    }

    /// The statements of the stages.
    fn stages_mut(&mut self) -> [&mut Vec<Stmt>; 3] {
        [&mut self.vertex, &mut self.geometry, &mut self.fragment]
    }

    /// All in one text, as [`Sections`](crate::Sections) reads it.
    pub fn text(&self) -> String {
        let sources = self.sources();
        let text = |one: &Source| format!("//# {}\n{}", one.stage.name(), one.text);
        format!("{}//# scene\n{}", sources.iter().map(text).collect::<String>(), self.scene_text())
    }
}

#[cfg(test)]
mod tests {
    use super::{Language, Program};
    use std::collections::BTreeSet;

    #[test]
    fn a_seed_is_a_program() {
        assert_eq!(Program::new(5).text(), Program::new(5).text());
        assert_ne!(Program::new(5).text(), Program::new(6).text());
    }

    /// Each construct of 4.50 and ES 3.10 is generated sooner or later.
    #[test]
    fn every_construct_comes_up() {
        let mut seen = BTreeSet::new();
        for language in [Language::of(450, false), Language::of(310, true)].into_iter().flatten() {
            for seed in 0..400 {
                seen.extend(Program::of(seed, language).constructs);
            }
        }
        for construct in [
            "switch",
            "fall through",
            "do",
            "discard",
            "bitfieldInsert",
            "textureLod",
            "textureSize",
            "inverse",
            "imulExtended",
            "array of arrays",
            "noperspective",
            "interface block",
            "macro",
            "overload",
            "swizzle as l-value",
            "nested struct",
            "matrixCompMult",
            "geometry stage",
            "gl_ClipDistance",
            "uniform array of structs",
            "array of uniform blocks",
            "comment",
            "isampler3D",
            "sampler2DMS",
            "overload with a conversion",
            "function that differs in one place",
            "overload that converts less than an earlier one",
            "overloads that differ in an operator",
            "function whose argument selects an operator",
            "difference of a difference",
            "comparison at a bound",
            "assignment of an operation on itself",
            "operation on a neutral number",
        ] {
            assert!(seen.contains(construct), "{construct}");
        }
    }
}
