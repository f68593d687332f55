//! The interface that users of the library rely on stays: every public declaration in `api.txt` is still there, word by word, and
//! `docs/api.md` says of each type who uses it.
//!
//! *In:* `src/lib.rs`, and the sources of what it re-exports. *Out:* declarations that changed or are missing. New ones are no
//! failure; `UPDATE_API=1 cargo test --test it -- public_declarations` writes the list, which a release does (`integrations/release`).
//!
//! This is a list and not `cargo semver-checks`: that compares with a published version, and there is none; and it takes longer to
//! build than glisten. The list needs nothing but the sources, and shows a change of the interface in the diff that makes it.

use super::architecture::{name_of, rust_files, source_folders, text_of};
use super::support::root;
use std::collections::BTreeSet;
use std::fs;
use std::path::PathBuf;

/// Types that the library may have.
const MOST_TYPES: usize = 60;

/// A name that `glisten` re-exports.
struct Offered {
    /// The name below `glisten`: `emit::Target`.
    shown: String,
    /// The folder of the sources that may declare it.
    folder: String,
    /// The name that is declared there.
    name: String,
}

impl Offered {
    fn is_type(&self) -> bool {
        self.name.starts_with(char::is_uppercase)
    }
}

/// All names that `src/lib.rs` re-exports, but for the command line, which no host names.
fn offered() -> Vec<Offered> {
    let text = text_of(&root().join("src/lib.rs"));
    let lines = text.lines().map(str::trim).filter(|line| !line.starts_with("//") && !line.starts_with('#'));
    let text = lines.collect::<Vec<_>>().join(" ");
    let (mut found, mut modules) = (Vec::new(), Vec::new());
    let mut rest = text.as_str();
    while let Some(at) = rest.find(['}', 'p']) {
        rest = &rest[at..];
        if let Some(after) = rest.strip_prefix("pub mod ") {
            let (name, after) = after.split_once(" {").expect("a module has a body");
            modules.push(name.to_owned());
            rest = after;
        } else if let Some(after) = rest.strip_prefix("pub use ") {
            let (tree, after) = after.split_once(';').expect("a declaration ends");
            found.extend(leaves(tree).into_iter().map(|path| as_offered(&modules, &path)));
            rest = after;
        } else {
            if rest.starts_with('}') {
                modules.pop();
            }
            rest = &rest[1..];
        }
    }
    found.retain(|one| one.shown != "cli");
    found
}

/// The paths of a tree of uses, whose braces are not nested.
fn leaves(tree: &str) -> Vec<String> {
    let Some((head, list)) = tree.split_once('{') else { return vec![tree.trim().to_owned()] };
    let names = list.trim_end_matches('}').split(',').map(str::trim).filter(|name| !name.is_empty());
    names.map(|name| format!("{head}{name}")).collect()
}

fn as_offered(modules: &[String], path: &str) -> Offered {
    let (path, alias) = path.split_once(" as ").map_or((path, None), |(path, alias)| (path, Some(alias)));
    let parts: Vec<&str> = path.split("::").collect();
    let (name, place) = parts.split_last().expect("a path has a name");
    let crate_name = place.first().map_or("", |first| first.trim_start_matches("glisten_"));
    let source = match crate_name {
        "library" => "shader_lib/src".to_owned(),
        other => format!("crates/{other}/src"),
    };
    let folder = place.iter().skip(1).fold(source, |folder, part| format!("{folder}/{part}"));
    let shown = modules.iter().map(String::as_str).chain([alias.unwrap_or(name)]).collect::<Vec<_>>().join("::");
    Offered { shown, folder, name: (*name).to_owned() }
}

/// A declaration that is being read.
#[derive(Default)]
struct Reader {
    /// The `impl`, `trait`, `enum` or `struct` that contains the line, and its indentation.
    owner: Option<(usize, String)>,
    /// Whether each line of the owner is public: those of traits and enumerations.
    all: bool,
    /// The beginning of a declaration that goes on in the next line.
    open: Option<String>,
    found: Vec<String>,
}

impl Reader {
    fn line(&mut self, line: &str) {
        let (indent, text) = (line.len() - line.trim_start().len(), line.trim());
        if let Some(open) = self.open.take() {
            return self.declaration(indent, &format!("{open} {text}"));
        }
        if self.owner.as_ref().is_some_and(|(outer, _)| indent <= *outer && text.starts_with('}')) {
            self.owner = None;
            return;
        }
        let is_inside = self.owner.is_some();
        let is_member = is_inside && self.all && self.owner.as_ref().is_some_and(|(outer, _)| indent == outer + 4);
        if text.starts_with("pub ") || (is_member && text.starts_with(char::is_alphabetic)) {
            self.declaration(indent, text);
        } else if !is_inside && text.starts_with("impl") && text.ends_with('{') {
            (self.owner, self.all) = (Some((indent, head(text).to_owned())), false);
        }
    }

    /// A declaration ends where its parentheses are closed and its body, its value or the next one begins.
    fn declaration(&mut self, indent: usize, text: &str) {
        let count = |letters: &[char]| text.matches(letters).count();
        let is_use = text.starts_with("pub use");
        let is_closed = count(&['(', '[']) == count(&[')', ']']) && (!is_use || text.ends_with(';'));
        if !is_closed || !text.ends_with([';', '{', '}', ',']) {
            self.open = Some(text.to_owned());
            return;
        }
        let owner = self.owner.as_ref().map(|(_, owner)| format!("{owner}: ")).unwrap_or_default();
        let shown = if is_use { text.trim_end_matches(';') } else { head(text) };
        self.found.push(format!("{owner}{}", shown.split_whitespace().collect::<Vec<_>>().join(" ")));
        let opens = ["pub struct", "pub enum", "pub trait"].iter().any(|word| text.starts_with(word));
        if opens && text.ends_with('{') && self.owner.is_none() {
            (self.owner, self.all) = (Some((indent, head(text).to_owned())), !text.starts_with("pub struct"));
        }
    }
}

/// A declaration without its body, its value and its last sign.
fn head(text: &str) -> &str {
    let text = text.split(" = ").next().unwrap_or(text);
    let text = if text.ends_with('}') { text.split(" {").next().unwrap_or(text) } else { text };
    text.trim_end_matches(['{', ';', ',']).trim()
}

/// Whether a declaration, or its owner, has this name: `pub fn name(`, `impl Name: pub fn`, `pub struct Name<T>: pub field`.
fn is_of(declaration: &str, name: &str) -> bool {
    let owner = declaration.split_once(": pub ").map_or(declaration, |(owner, _)| owner);
    let owner = owner.rsplit_once(" for ").map_or(owner, |(_, of)| of);
    let mut words = owner.split(|c: char| !c.is_alphanumeric() && c != '_').filter(|word| !word.is_empty());
    let is_head = |word: &&str| {
        !["pub", "const", "unsafe", "async", "impl", "a", "fn", "struct", "enum", "trait", "type"].contains(word)
    };
    words.find(is_head) == Some(name)
}

/// The declarations of a name in these files.
fn declared(one: &Offered, files: &[PathBuf]) -> Vec<String> {
    let mut all = Vec::new();
    for path in files.iter().filter(|path| !name_of(path).contains("/tests")) {
        let mut reader = Reader::default();
        let text = text_of(path);
        let lines = text.lines().take_while(|line| *line != "mod tests {");
        lines.filter(|line| !line.trim_start().starts_with("//")).for_each(|line| reader.line(line));
        all.extend(reader.found.into_iter().filter(|found| is_of(found, &one.name)));
    }
    all.into_iter().map(|found| format!("{}: {found}", one.shown)).collect()
}

fn declarations() -> BTreeSet<String> {
    let every: Vec<PathBuf> = source_folders().flat_map(|folder| rust_files(&folder)).collect();
    let mut all = BTreeSet::new();
    for one in offered() {
        let mut files = rust_files(&one.folder);
        let file = root().join(format!("{}.rs", one.folder));
        files.extend(file.exists().then_some(file));
        // A crate may re-export it itself.
        let found = Some(declared(&one, &files)).filter(|found| !found.is_empty());
        let found = found.unwrap_or_else(|| declared(&one, &every));
        assert!(!found.is_empty() || one.shown.starts_with("assert_"), "{} is declared nowhere", one.shown);
        all.extend(found);
    }
    all
}

#[test]
fn every_type_has_a_user() {
    let types: BTreeSet<String> = offered().into_iter().filter(Offered::is_type).map(|one| one.shown).collect();
    assert!(types.len() <= MOST_TYPES, "the library has {} types", types.len());
    assert!(types.len() > 40, "only {} types were found", types.len());
    let names: BTreeSet<String> = offered().into_iter().map(|one| one.shown).collect();
    let page = text_of(&root().join("docs/api.md"));
    let rows = page.lines().filter_map(|line| line.strip_prefix("| `"));
    let rows: Vec<(&str, &str)> = rows.filter_map(|row| row.split_once("` | ")).collect();
    let listed: BTreeSet<String> = rows.iter().map(|(name, _)| (*name).to_owned()).collect();
    assert_eq!(listed, types, "docs/api.md and src/lib.rs list other types");
    for (name, rest) in rows {
        let user = rest.split_once(" | ").map_or("", |(_, user)| user).trim_end_matches(" |");
        let last = name.rsplit("::").next().expect("a name");
        if let Some(of) = user.strip_prefix("returned by `").or_else(|| user.strip_prefix("a field of `")) {
            let of = of.trim_end_matches('`');
            assert!(names.contains(of), "{name} comes from {of}, which the library does not have");
            continue;
        }
        let path = match user.split_once("](") {
            Some((_, link)) => format!("docs/{}", link.trim_end_matches(')')),
            None => user.trim_matches('`').to_owned(),
        };
        assert!(text_of(&root().join(&path)).contains(last), "{path} does not use {name}");
    }
}

#[test]
fn public_declarations_stay() {
    let path = root().join("tests/it/api.txt");
    let now = declarations();
    if std::env::var_os("UPDATE_API").is_some() {
        let lines: Vec<&str> = now.iter().map(String::as_str).collect();
        fs::write(&path, lines.join("\n") + "\n").expect("the list can be written");
    }
    let text = text_of(&path);
    let missing: Vec<&str> = text.lines().filter(|line| !now.contains(*line)).collect();
    assert!(now.len() > 400, "only {} declarations were found", now.len());
    assert!(
        missing.is_empty(),
        "public declarations that changed or are gone; if that is meant, say so in the changelog and run \
         `UPDATE_API=1 cargo test --test it -- public_declarations`: {missing:#?}"
    );
}

#[test]
fn declarations_are_read_whole() {
    let mut reader = Reader::default();
    let text = "impl A {\n    pub fn f(\n        x: u32,\n    ) -> B {\n        let y = 1;\n    }\n    fn g() {}\n}\npub enum E {\n    #[x]\n    One,\n    Two { a: u8 },\n}\npub struct S {\n    pub a: u8,\n    b: u8,\n}\npub const N: u32 = 3;\n";
    text.lines().for_each(|line| reader.line(line));
    let expected = [
        "impl A: pub fn f( x: u32, ) -> B",
        "pub enum E",
        "pub enum E: One",
        "pub enum E: Two { a: u8 }",
        "pub struct S",
        "pub struct S: pub a: u8",
        "pub const N: u32",
    ];
    assert_eq!(reader.found, expected);
}
