//! The interface that users of the library rely on stays: every public declaration in `api.txt` is still there, word by word.
//!
//! *In:* the sources of `glisten`, and of what it re-exports. *Out:* declarations that changed or are missing. New ones are no
//! failure; `UPDATE_API=1 cargo test --test it -- public_declarations` writes the list, which a release does (`integrations/release`).
//!
//! This is a list and not `cargo semver-checks`: that compares with a published version, and there is none; and it takes longer to
//! build than glisten. The list needs nothing but the sources, and shows a change of the interface in the diff that makes it.

use super::architecture::{code_lines, name_of, rust_files, text_of};
use super::support::root;
use std::collections::BTreeSet;
use std::fs;

/// The sources of what `glisten` offers: its own, and those of other crates that it re-exports.
static OFFERED: &[&str] = &[
    "src",
    "crates/front/src/compiler",
    "crates/front/src/diagnostic",
    "crates/front/src/lint",
    "crates/front/src/source",
    "crates/emit/src/target",
    "crates/emit/src/emit/reflection",
    "crates/scene/src/picture",
];

/// Parts of them that no user can name.
static HIDDEN: &[&str] = &["src/cli/", "src/main.rs", "crates/front/src/diagnostic/codes/"];

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

/// The module that offers what a file declares. Files within it may be divided in other ways.
fn module_of(name: &str) -> &str {
    let folder = OFFERED.iter().skip(1).find(|folder| name.starts_with(*folder));
    let own = || name.split('/').nth(1).map_or(name, |module| module.trim_end_matches(".rs"));
    folder.copied().unwrap_or_else(own)
}

fn declarations() -> BTreeSet<String> {
    let files = OFFERED.iter().flat_map(|folder| rust_files(folder));
    let mut all = BTreeSet::new();
    for path in files {
        let name = name_of(&path);
        if HIDDEN.iter().any(|hidden| name.starts_with(hidden)) || name.contains("/tests") {
            continue;
        }
        let mut reader = Reader::default();
        code_lines(&text_of(&path)).for_each(|(_, line)| reader.line(line));
        let module = module_of(&name);
        all.extend(reader.found.into_iter().map(|found| format!("{module}: {found}")));
    }
    all
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
