//! `index.json`: which files each variant has.
//!
//! *In:* programs, their variants, the outputs of each. *Out:* JSON, and the files to write. *Holds:* a file is named after its
//! bytes, so equal outputs are one file, and a variant's files do not depend on what other variants there are.

use crate::digest::Content;
use crate::inputs::Group;
use crate::outputs::{Output, OutputPlan};
use crate::variants::Variant;
use serde::Serialize;
use std::collections::BTreeMap;

/// How many digits of a digest are in the name of a file.
pub(super) const DIGITS: usize = 20;

/// The files of a run by their paths below the output folder.
pub(super) type Files = BTreeMap<String, Content>;

/// The index of a run.
#[derive(Debug, Serialize)]
pub(super) struct Index {
    glisten: &'static str,
    programs: Vec<IndexedProgram>,
    #[serde(skip)]
    files: Files,
}

#[derive(Debug, Serialize)]
struct IndexedProgram {
    name: String,
    /// The distinct ones.
    shaders: Vec<Shader>,
    variants: Vec<IndexedVariant>,
}

/// The files of a program's stages by target, and its reflection.
#[derive(Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize)]
struct Shader {
    stages: BTreeMap<&'static str, BTreeMap<&'static str, String>>,
    reflection: String,
}

#[derive(Debug, Serialize)]
struct IndexedVariant {
    defines: Variant,
    #[serde(skip_serializing_if = "Option::is_none")]
    draw: Option<usize>,
    shader: usize,
}

/// A variant for the index: its macros, the number of its draw in a scene, its outputs.
pub(super) struct Entry<'a> {
    pub(super) defines: Variant,
    pub(super) draw: Option<usize>,
    pub(super) group: &'a Group,
    pub(super) outputs: &'a [Output],
}

impl Index {
    /// An empty index.
    pub(super) fn new() -> Self {
        Self { glisten: env!("CARGO_PKG_VERSION"), programs: Vec::new(), files: BTreeMap::new() }
    }

    /// Adds a program. Returns the number of its distinct shaders.
    pub(super) fn add<'a>(
        &mut self,
        name: &str,
        plan: &OutputPlan,
        entries: impl IntoIterator<Item = Entry<'a>>,
    ) -> usize {
        let mut numbers: BTreeMap<Shader, usize> = BTreeMap::new();
        let (mut shaders, mut variants) = (Vec::new(), Vec::new());
        for Entry { defines, draw, group, outputs } in entries {
            let shader = self.shader(name, plan, group, outputs);
            let next = numbers.len();
            let number = *numbers.entry(shader.clone()).or_insert(next);
            if number == next {
                shaders.push(shader);
            }
            variants.push(IndexedVariant { defines, draw, shader: number });
        }
        let count = shaders.len();
        self.programs.push(IndexedProgram { name: name.to_owned(), shaders, variants });
        count
    }

    fn shader(&mut self, program: &str, plan: &OutputPlan, group: &Group, outputs: &[Output]) -> Shader {
        let mut shader = Shader::default();
        let kinds = plan.kinds(group);
        for (name, content) in outputs {
            let digits = content.digest().to_string();
            let digits = digits.get(..DIGITS).unwrap_or_default();
            let path = match kinds.get(name) {
                Some((stages, target)) => {
                    let path = match stages.as_slice() {
                        [stage] => {
                            let end = glisten_sources::stages::extension(*stage);
                            format!("{program}/{digits}.{end}.{}", target.extension())
                        }
                        _ => format!("{program}/{digits}.{}", target.extension()),
                    };
                    for stage in stages {
                        shader.stages.entry(stage.name()).or_default().insert(target.word(), path.clone());
                    }
                    path
                }
                None => {
                    shader.reflection = format!("{program}/{digits}.json");
                    shader.reflection.clone()
                }
            };
            self.files.entry(path).or_insert_with(|| content.clone());
        }
        shader
    }

    /// The files to write, by their paths below the output folder.
    pub(super) fn files(&self) -> &Files {
        &self.files
    }

    /// The text of the index.
    pub(super) fn json(&self) -> String {
        serde_json::to_string_pretty(self).expect("texts and numbers are always JSON") + "\n"
    }
}

/// The name of the index.
pub(super) const INDEX: &str = "index.json";
