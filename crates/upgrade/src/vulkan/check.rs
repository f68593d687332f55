//! Checks of new texts: they are read as OpenGL's, without their sets, and their interface is compared with the old one.
//!
//! *In:* a program, and the new texts of its files. *Out:* what is wrong with them.

use super::super::rewrite::{Edit, applied};
use super::super::tokens::tokens;
use super::dialect::{Dialect, Numbering};
use super::output::{NewFile, NewTree, TreeProgram};
use super::{Compiled, coordinates, unseen};
use glisten_front::compiler::{Compiler, Prepared, Source};
use glisten_front::hir::{Stage, Storage};
use glisten_front::link::Program;
use glisten_front::source::{IncludeForm, IncludeResolver, Included};
use glisten_sources::engines::code::is_name;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::sync::Arc;

/// The resolver of a source's includes.
type Resolver = Arc<dyn IncludeResolver + Send + Sync>;
/// Texts by the names of their files.
type Texts = Arc<BTreeMap<String, Arc<str>>>;

/// New texts of included files, by name.
struct Replaced {
    inner: Resolver,
    texts: Texts,
    dialect: Arc<Dialect>,
}

impl IncludeResolver for Replaced {
    fn resolve(&self, path: &str, form: IncludeForm, from: &str) -> Result<Included, String> {
        match self.inner.resolve(path, form, from) {
            // An included file of the host is as the host has it today.
            Ok(found) if found.name.starts_with('<') => Ok(self.dialect.stand_in(path).unwrap_or(found)),
            Ok(found) => match self.texts.get(&found.name) {
                Some(text) => Ok(Included { text: Arc::clone(text), name: found.name }),
                // A new text names the host's file, and an older one is there.
                None => {
                    let lacks = self.dialect.block_of(path).is_some_and(|block| !block.is_in(&found.text));
                    Ok(self.dialect.stand_in(path).filter(|_| lacks).unwrap_or(found))
                }
            },
            Err(error) => self.dialect.stand_in(path).or_else(|| self.new_file(path)).ok_or(error),
        }
    }
}

impl Replaced {
    /// A file that has this name in the new tree alone.
    fn new_file(&self, path: &str) -> Option<Included> {
        let path = path.split_once(':').map_or(path, |(_, path)| path);
        let (name, text) = self.texts.iter().find(|(name, _)| Path::new(name).ends_with(path))?;
        Some(Included { name: name.clone(), text: Arc::clone(text) })
    }
}

/// The texts of the files of a program as a stage reads them, for OpenGL.
fn texts_for(files: &[NewFile], stage: Stage) -> BTreeMap<String, Arc<str>> {
    let of_stage = files.iter().filter(|file| file.stage.is_none_or(|own| own == stage));
    let both = |file: &NewFile| {
        let text: Arc<str> = for_opengl(&file.text, &file.old, stage).into();
        [(file.new_name(), Arc::clone(&text)), (file.name.clone(), text)]
    };
    of_stage.flat_map(both).collect()
}

impl TreeProgram {
    /// The program with the new texts of a tree, as OpenGL reads them: the compiler that finds them, and the sources. It is the program
    /// at `index` of the tree.
    pub fn read_back(&self, index: usize, tree: &NewTree, dialect: &Dialect) -> (Compiler, Vec<Source>) {
        read_back(self, index, &tree.files, dialect)
    }
}

/// The compiler and the sources of a program with new texts, as OpenGL reads them.
fn read_back(unit: &TreeProgram, index: usize, files: &[NewFile], dialect: &Dialect) -> (Compiler, Vec<Source>) {
    let own: Vec<NewFile> = files.iter().filter(|file| file.readers.contains(&index)).cloned().collect();
    let (dialect, own_includes) = (Arc::new(dialect.clone()), unit.compiler.includes());
    let by_stage: Vec<(Stage, Texts)> =
        Stage::ALL.into_iter().map(|stage| (stage, Arc::new(texts_for(&own, stage)))).collect();
    let texts_of = move |stage: Stage| {
        let found = by_stage.iter().find(|(own, _)| *own == stage);
        found.map_or_else(Arc::default, |(_, texts)| Arc::clone(texts))
    };
    let of_stage = texts_of.clone();
    let compiler = unit.compiler.clone().with_change(move |source, mut prepared| {
        let texts = of_stage(source.stage);
        for prelude in &mut prepared.completion.preludes {
            if let Some(text) = texts.get(&*prelude.name) {
                prelude.text = Arc::clone(text);
            }
        }
        prepared.text = None;
        let inner = prepared.includes.clone().unwrap_or_else(|| Arc::clone(&own_includes));
        Prepared { includes: Some(Arc::new(Replaced { inner, texts, dialect: Arc::clone(&dialect) })), ..prepared }
    });
    // Each stage has a block of its own for its uniforms.
    let compiler = compiler.with_stages_apart();
    let new = |source: &Source| {
        let text = texts_of(source.stage).get(&source.name).cloned();
        Source { text: text.unwrap_or_else(|| Arc::clone(&source.text)), ..source.clone() }
    };
    (compiler, unit.sources.iter().map(new).collect())
}

/// Compiles the new texts as OpenGL's, and compares the interfaces.
pub(super) fn check(one: &Compiled<'_>, files: &[NewFile], dialect: &Dialect) -> Result<(), String> {
    let (compiler, sources) = read_back(one.unit, one.index, files, dialect);
    let compilation = compiler.compile(&sources);
    if let Some(error) = compilation.diagnostics.iter().find(|found| found.is_error()) {
        return Err(format!("the new text is not valid: {}", error.message));
    }
    let Some(new) = &compilation.program else { return Err("the new text is not valid".to_owned()) };
    let loose = new.interface.roots.iter().find(|root| root.block.is_none());
    if let Some(root) = loose {
        return Err(format!("the uniform `{}` is still outside of blocks", root.name));
    }
    if dialect.numbering != Numbering::None {
        let lacks = new.stages.iter().flat_map(|shader| &shader.globals).find(|global| {
            let crosses = matches!(global.storage, Storage::In | Storage::Out) && global.builtin.is_none();
            crosses && global.block.is_none() && global.location.is_none()
        });
        if let Some(global) = lacks {
            return Err(format!("`{}` has no location", global.name));
        }
    }
    same_uniforms(one.program, new, dialect)
}

/// Every uniform that a stage reads is still there, with its type.
fn same_uniforms(old: &Program, new: &Program, dialect: &Dialect) -> Result<(), String> {
    let name = |name: &str| {
        let root = name.split(['.', '[']).next().unwrap_or("");
        let new = dialect.renamed.get(root).map_or(root, String::as_str);
        format!("{new}{}", name.get(root.len()..).unwrap_or(""))
    };
    let last = |name: &str| name.rsplit('.').next().unwrap_or("").to_owned();
    let there: BTreeSet<(String, String, Option<u32>)> = new
        .interface
        .uniforms
        .iter()
        .map(|leaf| (last(&leaf.name), new.types.name(leaf.ty), leaf.array_size))
        .collect();
    let lost = old
        .interface
        .uniforms
        .iter()
        .filter(|leaf| leaf.active)
        .find(|leaf| !there.contains(&(last(&name(&leaf.name)), old.types.name(leaf.ty), leaf.array_size)));
    lost.map_or(Ok(()), |leaf| Err(format!("the uniform `{}` is lost, or has another type", leaf.name)))
}

/// A text for Vulkan as OpenGL reads it: without sets, and with the names of indices. A new block whose members have conditions would be
/// another one in each stage: it has all of them, or a name for each stage.
fn for_opengl(text: &str, old: &str, stage: Stage) -> String {
    let mut text = without_sets(text);
    for (name, range) in conditional_blocks(&text).into_iter().rev().filter(|(name, _)| !old.contains(name.as_str())) {
        let body = text.get(range.clone()).unwrap_or("").to_owned();
        let lines = || body.lines().filter(|line| !line.trim_start().starts_with('#'));
        let members = lines().filter(|line| line.contains(';'));
        let words: Vec<&str> = members
            .filter_map(|line| {
                let code = line.split(';').next()?;
                let code = code.rsplit_once(") ").map_or(code, |(_, code)| code);
                code.trim().split_once(' ').map(|(_, name)| name.split('[').next().unwrap_or(name).trim())
            })
            .collect();
        let are_distinct = words.iter().collect::<BTreeSet<_>>().len() == words.len();
        let are_plain = lines().filter(|line| line.contains(';')).all(|line| {
            let code = line.rsplit_once(") ").map_or(line, |(_, code)| code);
            unseen::is_plain(code.trim().split([' ', '[']).next().unwrap_or(""))
        });
        if are_distinct && are_plain {
            text.replace_range(range, &lines().map(|line| format!("{line}\n")).collect::<String>());
        } else {
            let word = format!("{name}Of{stage:?}");
            text = text.replace(&format!("uniform {name} {{"), &format!("uniform {word} {{"));
        }
    }
    text
}

/// The blocks with directives between their braces: their names, and the lines between.
fn conditional_blocks(text: &str) -> Vec<(String, std::ops::Range<usize>)> {
    let mut found = Vec::new();
    let mut at = 0;
    while let Some(start) =
        text.get(at..).and_then(|rest| rest.find("uniform ")).map(|start| at + start + "uniform ".len())
    {
        at = start;
        let rest = text.get(start..).unwrap_or("");
        let Some(open) = rest.find(" {\n").filter(|open| *open > 0) else { continue };
        let name = rest.get(..open).unwrap_or("");
        let Some(close) = rest.find("\n};").filter(|close| *close > open) else { continue };
        let range = start + open + 3..start + close + 1;
        let has_directive =
            text.get(range.clone()).is_some_and(|body| body.lines().any(|line| line.trim_start().starts_with('#')));
        if name.chars().all(is_name) && has_directive {
            found.push((name.to_owned(), range));
        }
    }
    found
}

/// A text for Vulkan without sets, and with the names of indices.
fn without_sets(text: &str) -> String {
    let all = tokens(text);
    let mut edits: Vec<Edit> = Vec::new();
    for (index, token) in all.iter().enumerate() {
        let at = |offset: usize| all.get(index + offset).map_or("", |token| token.text);
        if token.text == "set" && at(1) == "=" && at(3) == "," {
            let end = all.get(index + 3).map_or(token.range.end, |comma| comma.range.end);
            edits.push((token.range.start..end, String::new()));
        } else if let Some(old) = coordinates::old_name(token.text) {
            edits.push((token.range.clone(), old.to_owned()));
        }
    }
    applied(text, edits)
}
