//! The cycles between the modules of each crate: computed from the paths in the code, and compared with those that
//! `docs/architecture.md` names.
//!
//! *In:* the sources of all crates. *Out:* for each folder, the groups of modules in it that use each other. *Holds:*
//! `use` trees and paths in the text are resolved through `crate`, `self` and `super`, and through re-exports, to the
//! module that declares what they name. Methods have no path and are not followed. What a folder's `mod.rs` declares
//! belongs to the folder, so that its files may use it.

use super::architecture::{name_of, rust_files, source_folders, text_of};
use super::support::root;
use std::collections::{BTreeMap, BTreeSet};

/// The path of a module below the `src` of its crate, or a path in its text.
type Path = Vec<String>;

/// The text without comments, and with empty strings and characters.
fn code(text: &str) -> String {
    let letters: Vec<char> = text.chars().collect();
    let starts = |at: usize, needle: &str| needle.chars().enumerate().all(|(i, c)| letters.get(at + i) == Some(&c));
    let mut out = String::new();
    let mut at = 0;
    while let Some(&letter) = letters.get(at) {
        if starts(at, "//") {
            while letters.get(at).is_some_and(|&c| c != '\n') {
                at += 1;
            }
        } else if let Some(hashes) = raw_string(&letters[at..]).filter(|_| !out.ends_with(is_of_word)) {
            let end = format!("\"{}", "#".repeat(hashes));
            at += 2 + hashes;
            while at < letters.len() && !starts(at, &end) {
                at += 1;
            }
            at += 1 + hashes;
        } else if letter == '"' {
            at += 1;
            while letters.get(at).is_some_and(|&c| c != '"') {
                at += if letters[at] == '\\' { 2 } else { 1 };
            }
            at += 1;
        } else if letter == '\'' && (letters.get(at + 1) == Some(&'\\') || letters.get(at + 2) == Some(&'\'')) {
            at += 3;
            while letters.get(at - 1).is_some_and(|&c| c != '\'') {
                at += 1;
            }
        } else {
            out.push(letter);
            at += 1;
        }
    }
    out
}

fn is_of_word(letter: char) -> bool {
    letter.is_alphanumeric() || letter == '_'
}

/// The number of `#` of a raw string that begins here.
fn raw_string(letters: &[char]) -> Option<usize> {
    let rest = letters.strip_prefix(&['r'])?;
    let hashes = rest.iter().take_while(|&&letter| letter == '#').count();
    (rest.get(hashes) == Some(&'"')).then_some(hashes)
}

/// The words and signs of a text, `::` as one, without items that are compiled for tests alone.
fn tokens(code: &str) -> Vec<String> {
    let mut tokens: Vec<String> = Vec::new();
    for letter in code.chars() {
        let last = tokens.last_mut().filter(|_| !letter.is_whitespace());
        match last {
            Some(last) if is_of_word(letter) && last.ends_with(is_of_word) => last.push(letter),
            Some(last) if letter == ':' && *last == ":" => last.push(letter),
            // White space ends a word.
            _ if letter.is_whitespace() => tokens.push(String::new()),
            _ => tokens.push(letter.into()),
        }
    }
    tokens.retain(|token| !token.is_empty());
    let attribute = ["#", "[", "cfg", "(", "test", ")", "]"];
    while let Some(start) = tokens.windows(attribute.len()).position(|window| window == attribute) {
        let mut depth = 0;
        let length = tokens[start..].iter().position(|token| {
            depth += i32::from(token == "{") - i32::from(token == "}");
            depth == 0 && (token == ";" || token == "}")
        });
        tokens.drain(start..length.map_or(tokens.len(), |length| start + length + 1));
    }
    tokens
}

/// Reads a tree of `use`, or a path. Returns the index after it.
fn tree(tokens: &[String], mut at: usize, prefix: &[String], paths: &mut Vec<Path>) -> usize {
    let token = |at: usize| tokens.get(at).map_or("", String::as_str);
    if token(at) == "{" {
        at += 1;
        while !matches!(token(at), "}" | "") {
            at = if token(at) == "," { at + 1 } else { tree(tokens, at, prefix, paths) };
        }
        return at + 1;
    }
    let path: Path = prefix.iter().cloned().chain(tokens.get(at).cloned()).collect();
    if token(at + 1) == "::" && token(at + 2) != "<" {
        return tree(tokens, at + 2, &path, paths);
    }
    paths.push(path);
    at + 1
}

/// All paths that begin at a module, and all `use`s.
fn paths(tokens: &[String]) -> Vec<Path> {
    let mut paths = Vec::new();
    let mut at = 0;
    while let Some(token) = tokens.get(at) {
        let next = tokens.get(at + 1).map_or("", String::as_str);
        let is_inside = at.checked_sub(1).and_then(|before| tokens.get(before)).is_some_and(|before| before == "::");
        at = match token.as_str() {
            "crate" | "super" | "self" if next == "::" && !is_inside => tree(tokens, at, &[], &mut paths),
            "use" if next != "<" => tree(tokens, at + 1, &[], &mut paths),
            _ => at + 1,
        };
    }
    paths
}

/// The modules of a crate with the paths in their texts.
struct Modules(BTreeMap<Path, Vec<Path>>);

impl Modules {
    fn of(folder: &str) -> Self {
        let mut modules = BTreeMap::<Path, Vec<Path>>::new();
        for file in rust_files(folder) {
            let name = name_of(&file);
            if name.contains("/tests/") || name.ends_with("/tests.rs") {
                continue;
            }
            let within = name.trim_start_matches(folder).trim_start_matches('/').trim_end_matches(".rs");
            let mut module: Path = within.split('/').map(str::to_owned).collect();
            if module.last().is_some_and(|last| matches!(last.as_str(), "mod" | "lib" | "main")) {
                module.pop();
            }
            modules.entry(module).or_default().extend(paths(&tokens(&code(&text_of(&file)))));
        }
        Self(modules)
    }

    /// The module that declares what a path names, seen from the module `here`.
    fn resolve(&self, here: &[String], path: &[String], depth: usize) -> Option<Path> {
        let (mut module, mut rest) = (here.to_vec(), path);
        match path.first()?.as_str() {
            "crate" => (module, rest) = (Vec::new(), &path[1..]),
            "self" => rest = &path[1..],
            "super" => {
                while let Some(after) = rest.strip_prefix(&["super".to_owned()]) {
                    (rest, _) = (after, module.pop()?);
                }
            }
            _ if self.child(&module, path).is_none() => return None,
            _ => {}
        }
        while let Some(child) = self.child(&module, rest) {
            (module, rest) = (child, &rest[1..]);
        }
        // A name that the module itself imports or re-exports is declared elsewhere.
        let import = self.0[&module].iter().find(|import| import.len() > 1 && import.last() == rest.first());
        let further = import.filter(|_| depth < 8).and_then(|import| self.resolve(&module, import, depth + 1));
        Some(further.unwrap_or(module))
    }

    fn child(&self, module: &[String], path: &[String]) -> Option<Path> {
        let child: Path = module.iter().chain(path.first()).cloned().collect();
        (child.len() > module.len() && self.0.contains_key(&child)).then_some(child)
    }

    /// The arrows between the modules of each folder.
    fn arrows(&self) -> BTreeMap<Path, BTreeSet<(String, String)>> {
        let mut arrows = BTreeMap::<Path, BTreeSet<(String, String)>>::new();
        for (from, paths) in &self.0 {
            for to in paths.iter().filter_map(|path| self.resolve(from, path, 0)) {
                let shared = from.iter().zip(&to).take_while(|(a, b)| a == b).count();
                if let (Some(a), Some(b)) = (from.get(shared), to.get(shared)) {
                    arrows.entry(from[..shared].to_vec()).or_default().insert((a.clone(), b.clone()));
                }
            }
        }
        arrows
    }
}

/// The groups of modules that use each other.
fn groups(arrows: &BTreeSet<(String, String)>) -> BTreeSet<Vec<String>> {
    let mut reach = arrows.clone();
    loop {
        let longer: Vec<(String, String)> = reach
            .iter()
            .flat_map(|(a, b)| {
                arrows.iter().filter(move |(from, _)| from == b).map(move |(_, c)| (a.clone(), c.clone()))
            })
            .filter(|pair| !reach.contains(pair))
            .collect();
        if longer.is_empty() {
            break;
        }
        reach.extend(longer);
    }
    let group = |module: &String| {
        let both = reach.iter().filter(|(a, b)| a == module && reach.contains(&(b.clone(), a.clone())));
        both.map(|(_, b)| b.clone()).collect::<Vec<String>>()
    };
    reach.iter().filter(|(a, b)| a == b).map(|(a, _)| group(a)).collect()
}

/// The rows of the table of cycles in `docs/architecture.md`: the folder and its modules.
fn named() -> BTreeSet<(String, Vec<String>)> {
    let page = text_of(&root().join("docs/architecture.md"));
    let section = page.split("## Cycles").nth(1).and_then(|rest| rest.split("\n## ").next()).unwrap_or("");
    let rows = section.lines().filter_map(|line| line.strip_prefix("| `")).filter_map(|row| {
        let mut cells = row.split('|');
        let folder = cells.next()?.trim().trim_end_matches('`').to_owned();
        let modules = cells.next()?.split(',').map(|module| module.trim().trim_matches('`').to_owned()).collect();
        let reason = cells.next()?.trim();
        assert!(reason.len() > 20, "{folder}: the cycle has no reason");
        Some((folder, modules))
    });
    rows.collect()
}

#[test]
fn modules_form_only_the_cycles_that_are_named() {
    let (mut found, mut count) = (BTreeSet::new(), 0);
    for folder in source_folders() {
        for (module, arrows) in Modules::of(&folder).arrows() {
            count += arrows.len();
            let name = [std::slice::from_ref(&folder), module.as_slice()].concat().join("/");
            found.extend(groups(&arrows).into_iter().map(|group| (name.clone(), group)));
        }
    }
    assert!(count > 600, "only {count} arrows were seen");
    let named = named();
    let new: Vec<_> = found.difference(&named).collect();
    let gone: Vec<_> = named.difference(&found).collect();
    assert!(new.is_empty(), "cycles that docs/architecture.md does not name: {new:#?}");
    assert!(gone.is_empty(), "docs/architecture.md names cycles that do not exist: {gone:#?}");
}

#[test]
fn paths_and_their_cycles_are_found() {
    let text = "use super::{a::{B, c::*}, d}; /// crate::e\n let s = \"crate::f\"; let c = '\"'; fn g<'x>() { self::h::i::<T>() }\n\
                #[cfg(test)]\nmod tests { use crate::j; }\nuse crate::k;\n";
    let found: Vec<String> = paths(&tokens(&code(text))).iter().map(|path| path.join("::")).collect();
    assert_eq!(found, ["super::a::B", "super::a::c::*", "super::d", "self::h::i", "crate::k"]);
    let path = |text: &str| text.split("::").map(str::to_owned).collect::<Path>();
    let module = |name: &str, paths: &[&str]| {
        let name = if name.is_empty() { Vec::new() } else { path(name) };
        (name, paths.iter().map(|text| path(text)).collect::<Vec<Path>>())
    };
    let modules = Modules(BTreeMap::from([
        module("", &["a::Thing"]),
        module("a", &["super::b::Other"]),
        module("b", &["crate::Thing"]),
        module("c", &["super::a"]),
    ]));
    let arrows = modules.arrows();
    assert_eq!(groups(&arrows[&Vec::new()]), BTreeSet::from([vec!["a".to_owned(), "b".to_owned()]]), "{arrows:?}");
}
