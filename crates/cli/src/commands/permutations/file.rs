//! The file of `--permutations`.
//!
//! ```toml
//! [[program]]
//! files = ["uber.vert", "uber.frag"]   # relative to this file
//! name = "uber"                        # without it, the stem of the first file
//! defines = { MAX_LIGHTS = 4 }         # in every variant
//! pragmas = true                       # the lines `#pragma multi_compile` and `shader_feature` of the sources
//! keywords = ["multi_compile _ FOG_LINEAR FOG_EXP", "shader_feature NORMAL_MAP"]
//! variants = ["SKINNED=1,BONES=4", ""] # lists of defines
//! skip = ["FOG_EXP !NORMAL_MAP"]       # variants that are left out
//! only = []                            # if there are any, the variants that are left
//! [program.values]
//! LIGHTS = [0, 1, 2, 4]
//! SHADOWS = [false, true]              # not defined; defined as 1
//!
//! [[scene]]
//! file = "room.toml"                   # each draw's program, without what the scene does not need
//! dynamic = ["time"]
//! ```
//!
//! *In:* the text. *Out:* [`Permutations`], or all that is wrong, at its place. *Holds:* unknown keys are errors; a condition with
//! a name that no variant has, too.

use crate::batch::Batch;
use crate::files;
use crate::variants::axes::{Axis, variants};
use crate::variants::{Variant, stated};
use glisten_front::diagnostic::Diagnostic;
use glisten_front::source::{SourceMap, Span};
use glisten_scene::tables::{CONFIGURATION, Reader};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use toml::de::DeTable;

/// The keys of the tables.
const KEYS: &[&str] = &["program", "scene"];
const PROGRAM_KEYS: &[&str] =
    &["files", "name", "defines", "pragmas", "keywords", "variants", "skip", "only", "values"];
const SCENE_KEYS: &[&str] = &["file", "dynamic"];

/// A scene whose draws are variants of their programs.
#[derive(Debug)]
pub(super) struct SceneTable {
    /// The scene file.
    pub(super) file: String,
    /// The uniforms that change from frame to frame, added to those of the scene.
    pub(super) dynamic: Vec<String>,
}

/// A program with its variants.
#[derive(Debug)]
pub(crate) struct PermutedProgram {
    /// The name, unique in the file.
    pub(crate) name: String,
    /// The files of its stages.
    pub(crate) files: Vec<String>,
    /// Its variants, at least one.
    pub(crate) variants: Vec<Variant>,
    /// The macros that differ between variants.
    pub(super) names: BTreeSet<String>,
}

/// All that a file asks for.
#[derive(Debug)]
pub(super) struct Permutations {
    /// The programs.
    pub(super) programs: Vec<PermutedProgram>,
    /// The scenes.
    pub(super) scenes: Vec<SceneTable>,
}

/// Reads a file.
///
/// # Errors
/// It cannot be read, or its content is wrong: the diagnostics.
pub(super) fn read(path: &Path) -> Result<Permutations, Batch> {
    let name = path.display().to_string();
    let mut sources = SourceMap::default();
    let bytes = files::read(&name, path).map_err(|error| {
        let diagnostics = vec![error.diagnostic(&mut sources, &name)];
        Batch { sources: std::mem::take(&mut sources), diagnostics }
    })?;
    let text: Arc<str> = String::from_utf8_lossy(&bytes).into();
    let base = sources.add(name, Arc::clone(&text)).map_or(0, |id| sources.file(id).base());
    let mut file = File { reader: Reader::new(&CONFIGURATION, base, Arc::clone(&text)), folder: folder_of(path) };
    let found = file.permutations(&text);
    if file.reader.diagnostics.is_empty() {
        return Ok(found);
    }
    Err(Batch { sources, diagnostics: file.reader.diagnostics.into_iter().collect() })
}

fn folder_of(path: &Path) -> &Path {
    path.parent().unwrap_or(Path::new(""))
}

/// A file that is read.
struct File<'p> {
    reader: Reader,
    folder: &'p Path,
}

impl File<'_> {
    fn wrong(&mut self, span: Span, message: impl Into<String>, help: Option<String>) {
        stated::wrong(&mut self.reader, span, message, help);
    }

    /// The value, or an error at `span`.
    fn checked<T>(&mut self, span: Span, value: Result<T, String>) -> Option<T> {
        value.map_err(|why| self.wrong(span, why, None)).ok()
    }

    fn permutations(&mut self, text: &str) -> Permutations {
        let (mut programs, mut scenes) = (Vec::<PermutedProgram>::new(), Vec::new());
        let Some(document) = self.reader.document(text) else { return Permutations { programs, scenes } };
        self.reader.check_keys(&document, "the file", KEYS);
        let tables = self.reader.tables_at(&document, "program");
        let scene_tables = self.reader.tables_at(&document, "scene");
        if tables.is_empty() && scene_tables.is_empty() && self.reader.diagnostics.is_empty() {
            let span = self.reader.span(0..text.len().min(1));
            let help = "add `[[program]]` with `files`, or `[[scene]]` with `file`".to_owned();
            self.wrong(span, "there is no `[[program]]` and no `[[scene]]`", Some(help));
        }
        for (table, span) in tables {
            self.reader.check_keys(table, "`[[program]]`", PROGRAM_KEYS);
            let Some(program) = self.program(table, span) else { continue };
            if programs.iter().any(|other| other.name == program.name) {
                let message = format!("two programs are named `{}`; give one of them a `name`", program.name);
                self.wrong(span, message, None);
            }
            programs.push(program);
        }
        for (table, span) in scene_tables {
            self.reader.check_keys(table, "`[[scene]]`", SCENE_KEYS);
            if !table.contains_key("file") && !self.reader.is_misspelled(table, "file") {
                self.wrong(span, "`[[scene]]` has no `file`", None);
            }
            let Some((file, _)) = self.reader.text_at(table, "file") else { continue };
            let file = self.folder.join(file).to_string_lossy().into_owned();
            let dynamic = self.reader.texts_at(table, "dynamic").into_iter().map(|(name, _)| name.to_owned());
            scenes.push(SceneTable { file, dynamic: dynamic.collect() });
        }
        Permutations { programs, scenes }
    }

    /// A program; `None` (reported) if something in it is wrong.
    fn program(&mut self, table: &DeTable<'_>, span: Span) -> Option<PermutedProgram> {
        if !table.contains_key("files") {
            if !self.reader.is_misspelled(table, "files") {
                self.wrong(span, "`[[program]]` has no `files`", Some("add `files = [\"a.vert\", \"a.frag\"]`".into()));
            }
            return None;
        }
        let files = self.reader.texts_at(table, "files");
        let paths: Vec<PathBuf> = files.iter().map(|(name, _)| self.folder.join(name)).collect();
        let Some(first) = paths.first() else {
            self.wrong(span, "the program has no files", None);
            return None;
        };
        let (name, place) = match self.reader.text_at(table, "name") {
            Some((name, place)) => (name.to_owned(), place),
            None => (glisten_sources::stages::stem(first), span),
        };
        if name.is_empty() || name.starts_with('.') || name.contains(['/', '\\', '\0']) {
            self.wrong(place, format!("`{name}` is not a name for a folder"), None);
            return None;
        }
        let fixed: BTreeSet<String> = self
            .reader
            .table_at(table, "defines")
            .map_or_else(BTreeSet::new, |defines| defines.keys().map(|key| key.get_ref().to_string()).collect());
        let axes = self.axes(table, span, &paths)?;
        let names: BTreeSet<String> =
            axes.iter().flat_map(|axis| &axis.choices).flat_map(|choice| choice.keys().cloned()).collect();
        let known = |name: &str| names.contains(name) || fixed.contains(name);
        let skip = stated::conditions(&mut self.reader, table, "skip", &names, &known);
        let only = stated::conditions(&mut self.reader, table, "only", &names, &known);
        let variants = self.checked(span, variants(&axes, &skip?, &only?))?;
        if variants.is_empty() {
            self.wrong(span, format!("the conditions of `{name}` leave no variant"), None);
            return None;
        }
        let files = paths.iter().map(|path| path.to_string_lossy().into_owned()).collect();
        Some(PermutedProgram { name, files, variants, names })
    }

    /// The choices of a program, those of all variants first; `None` (reported) if one is wrong.
    fn axes(&mut self, table: &DeTable<'_>, span: Span, paths: &[PathBuf]) -> Option<Vec<Axis>> {
        let before = self.reader.diagnostics.len();
        let mut axes = Vec::new();
        for (key, node) in self.reader.table_at(table, "defines").into_iter().flatten() {
            let Some(name) = self.reader.macro_name(key) else { continue };
            let value = stated::value(&mut self.reader, node, &name);
            axes.extend(value.map(|value| Axis::of_values(&name, [value])));
        }
        axes.extend(self.keywords(table, span, paths));
        for (key, node) in self.reader.table_at(table, "values").into_iter().flatten() {
            let Some(name) = self.reader.macro_name(key) else { continue };
            if axes.iter().any(|axis: &Axis| axis.choices.iter().any(|choice| choice.contains_key(&name))) {
                let place = self.reader.span(key.span());
                let message = format!("`{name}` has values here, and is also in `defines` or in a line of keywords");
                self.wrong(place, message, Some("remove it from one of the two".to_owned()));
                continue;
            }
            axes.extend(stated::values(&mut self.reader, node, &name).map(|values| Axis::of_values(&name, values)));
        }
        let lists = self.reader.texts_at(table, "variants");
        if let (Some((_, first)), texts) = (lists.first(), lists.iter().map(|(text, _)| (*text).to_owned())) {
            axes.extend(self.checked(*first, Axis::of_lists(&texts.collect::<Vec<_>>())));
        }
        (self.reader.diagnostics.len() == before).then_some(axes)
    }

    /// The axes of lines of keywords: those of the file, then, with `pragmas`, those of the sources.
    fn keywords(&mut self, table: &DeTable<'_>, span: Span, paths: &[PathBuf]) -> Vec<Axis> {
        let own = self.reader.texts_at(table, "keywords").into_iter();
        let mut lines: Vec<(String, Span)> = own.map(|(line, span)| (line.to_owned(), span)).collect();
        let has_pragmas = self.reader.flag(table, "pragmas", false);
        for path in paths.iter().filter(|_| has_pragmas) {
            let read = files::read(&path.to_string_lossy(), path);
            let bytes = match read {
                Ok(bytes) => bytes,
                Err(error) => {
                    self.reader.report(Diagnostic::new(error.code, span, error.message));
                    continue;
                }
            };
            for line in String::from_utf8_lossy(&bytes).lines().filter(|line| is_keyword_pragma(line)) {
                // Both stages may have the line.
                if !lines.iter().any(|(known, _)| known == line.trim()) {
                    lines.push((line.trim().to_owned(), span));
                }
            }
        }
        lines.into_iter().filter_map(|(line, span)| self.checked(span, Axis::of_keywords(&line))).collect()
    }
}

fn is_keyword_pragma(line: &str) -> bool {
    let rest = line.trim().strip_prefix('#').and_then(|rest| rest.trim_start().strip_prefix("pragma"));
    let rest = rest.map_or("", str::trim_start);
    rest.starts_with("multi_compile") || rest.starts_with("shader_feature")
}

#[cfg(test)]
mod tests {
    use super::read;
    use std::fs;

    #[test]
    fn a_file_is_read_and_mistakes_are_named() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("p.toml");
        fs::write(folder.path().join("a.frag"), "#pragma multi_compile _ FOG\nvoid main() {}\n").expect("written");
        let read = |text: &str| {
            fs::write(&path, text).expect("written");
            read(&path)
        };
        let text = "[[program]]\nfiles = [\"a.frag\"]\npragmas = true\ndefines = { FIXED = 1.0 }\nskip = [\"FOG !LIT\"]\n\
                    [program.values]\nLIT = [false, true]\nN = [1, 2, \"X\"]\n";
        let found = read(text).expect("a good file");
        let program = &found.programs[0];
        assert_eq!((program.name.as_str(), program.variants.len()), ("a", 9));
        assert!(program.variants.iter().all(|variant| variant["FIXED"] == "1.0"));
        for (text, why) in [
            ("", "no `[[program]]`"),
            ("[[program]]\n", "has no `files`"),
            ("[[program]]\nfiles = []\n", "no files"),
            ("[[program]]\nfiles = [\"a.frag\"]\nlist = 1\n", "list"),
            ("[[program]]\nfiles = [\"a.frag\"]\nskip = [\"LITT\"]\nvalues = { LIT = [1] }\n", "did you mean `LIT`"),
            ("[[program]]\nfiles = [\"a.frag\"]\nvalues = { LIT = 1 }\n", "not a list"),
            ("[[program]]\nfiles = [\"a.frag\"]\ndefines = { LIT = 1 }\nvalues = { LIT = [1, 2] }\n", "in `defines`"),
            ("[[program]]\nfiles = [\"a.frag\"]\nvalues = { LIT = [] }\n", "no value"),
            ("[[program]]\nfiles = [\"a.frag\"]\nvalues = { \"1\" = [1] }\n", "not a name"),
            ("[[program]]\nfiles = [\"a.frag\"]\nkeywords = [\"multi A\"]\n", "multi_compile"),
            ("[[program]]\nfiles = [\"a.frag\"]\nname = \"../x\"\n", "not a name"),
            ("[[program]]\nfiles = [\"a.frag\"]\n[[program]]\nfiles = [\"a.frag\"]\n", "two programs"),
            (
                "[[program]]\nfiles = [\"a.frag\"]\nonly = [\"A\"]\nskip = [\"A\"]\nvalues = { A = [1] }\n",
                "leave no variant",
            ),
        ] {
            let failure = format!("{:?}", read(text).expect_err(text).diagnostics);
            assert!(failure.contains(why), "{text}: {failure}");
        }
        // All mistakes of a file are told, each at its place.
        let all =
            read("[[program]]\nfils = [\"a.frag\"]\n[[scene]]\nfile = 1\n").expect_err("two mistakes").diagnostics;
        assert_eq!(all.iter().map(|one| one.primary.span.start).collect::<Vec<_>>(), [13, 48]);
    }
}
