//! The words of documentation and comments: a part of `docs/glossary.md` that can be tested.
//!
//! *In:* the Markdown files, and the comments of all Rust and GLSL files. *Out:* every phrase that has a better one. Code in
//! the text (between backquotes, or in fenced blocks) does not count.

use super::architecture::{name_of, rust_files, text_of};
use super::support::root;
use std::fs;
use std::path::PathBuf;

/// American spellings for British stems. A stem matches at the beginning of a word.
static SPELLINGS: &[(&str, &str)] = &[
    ("colour", "color"),
    ("grey", "gray"),
    ("neighbour", "neighbor"),
    ("behaviour", "behavior"),
    ("favour", "favor"),
    ("honour", "honor"),
    ("centre", "center"),
    ("analyse", "analyze"),
    ("analysing", "analyzing"),
    ("rasteris", "rasteriz"),
    ("normalis", "normaliz"),
    ("optimis", "optimiz"),
    ("initialis", "initializ"),
    ("recognis", "recogniz"),
    ("serialis", "serializ"),
    ("specialis", "specializ"),
    ("labelled", "labeled"),
    ("modelled", "modeled"),
    ("modelling", "modeling"),
    ("travell", "travel"),
    ("cancelled", "canceled"),
    ("artefact", "artifact"),
    ("whilst", "while"),
];

/// Phrases that mean something else to a native speaker, or that have a standard term.
static PHRASES: &[(&str, &str)] = &[
    ("likewise", "repeat what it is"),
    ("beside", "next to, besides"),
    ("anew", "again"),
    ("comes of", "results from"),
    ("came of", "resulted from"),
    ("becomes of", "happens to"),
    ("slip", "internal error"),
    ("stands at", "is at"),
    ("stands in", "is in"),
    ("stands there", "is there"),
    ("stands behind", "follows"),
    ("stands nowhere", "is not in"),
    ("behind one another", "in sequence"),
    ("hangs on", "depends on"),
    ("in the making", "in progress"),
    ("tells of", "describes"),
    ("whereof", "of which"),
];

/// How the documentation of an item must not begin: it begins with what the item is or does.
static OPENERS: &[&str] =
    &["What ", "Which.", "Likewise", "The same as", "The same of", "The same with", "The same for", "The same in"];

/// Files in progress, and the glossary, which names the phrases to avoid.
static EXCEPT: &[&str] = &[
    "crates/specialize/",
    "docs/glossary.md",
    "docs/specialize.md",
    "crates/verify/src/specialize/",
    "tests/it/specialize/",
    "tests/it/words.rs",
];

/// Names of types and functions for which the glossary has other terms, each with that term.
static NAMES: &[(&str, &str)] = &[
    ("Near", "a value with its bounds, or an interval"),
    ("Ends", "bounds"),
    ("Odd", "special"),
    ("Few", "block"),
    ("At", "a lookup, a position"),
    ("Doubt", "undecided, or a warning"),
    ("Judge", "criterion"),
    ("judge", "compare, or validate"),
    ("Painter", "backend"),
    ("beside", "second"),
    ("choices", "interval"),
    ("sure", "is_decided"),
    ("admits", "excuses"),
    ("admitting", "excusing"),
    ("with_range", "with_interval"),
];

/// Files in progress.
static NAMED_LATER: &[&str] = &["crates/specialize/", "crates/verify/src/specialize/", "tests/it/specialize/"];

/// A comment or a paragraph: the number of its first line, and the text without code.
struct Passage {
    line: usize,
    text: String,
    /// Whether it documents an item or a module.
    documents: bool,
}

/// The text with everything between backquotes replaced by one letter.
fn without_code(text: &str) -> String {
    text.split('`').enumerate().map(|(index, part)| if index % 2 == 0 { part } else { "x" }).collect()
}

/// The passages of a text, given what each line contributes: whether it documents, and its words.
fn passages<'a>(lines: impl Iterator<Item = Option<(bool, &'a str)>>) -> Vec<Passage> {
    let mut passages: Vec<Passage> = Vec::new();
    let mut open = false;
    for (index, line) in lines.enumerate() {
        match line.filter(|(_, text)| !text.trim().is_empty()) {
            Some((_, text)) if open => {
                if let Some(passage) = passages.last_mut() {
                    passage.text.extend([" ", text.trim()]);
                }
            }
            Some((documents, text)) => {
                passages.push(Passage { line: index + 1, text: text.trim().to_owned(), documents });
            }
            None => {}
        }
        // A blank line within a documentation comment ends a passage, but what follows does not begin the comment.
        open = line.is_some_and(|(_, text)| !text.trim().is_empty());
    }
    for passage in &mut passages {
        passage.text = without_code(&passage.text);
    }
    passages
}

/// The comments of Rust or GLSL. Only the first passage of a documentation comment `documents`.
fn comments(text: &str) -> Vec<Passage> {
    let mut inside = false;
    let mut fenced = false;
    passages(text.lines().map(move |line| {
        let Some(comment) = line.trim_start().strip_prefix("//") else {
            (inside, fenced) = (false, false);
            return line
                .split_once(" // ")
                .filter(|(code, _)| code.matches('"').count() % 2 == 0)
                .map(|(_, text)| (false, text));
        };
        let documentation = comment.strip_prefix(['/', '!']);
        let words = documentation.unwrap_or(comment);
        let fence = words.trim_start().starts_with("```");
        fenced ^= fence;
        let first = documentation.is_some() && !inside;
        inside = documentation.is_some();
        (!fenced && !fence).then_some((first, words))
    }))
}

/// The paragraphs of Markdown, outside of fenced blocks.
fn paragraphs(text: &str) -> Vec<Passage> {
    let mut fenced = false;
    passages(text.lines().map(move |line| {
        let fence = line.trim_start().starts_with("```");
        fenced ^= fence;
        (!fenced && !fence).then_some((false, line))
    }))
}

/// What is wrong with a passage.
fn faults(passage: &Passage) -> Vec<String> {
    let lower = passage.text.to_lowercase();
    let words: Vec<&str> = lower.split(|c: char| !c.is_alphabetic()).filter(|word| !word.is_empty()).collect();
    let spaced = format!(" {} ", words.join(" "));
    let spelled = SPELLINGS.iter().filter(|(stem, _)| spaced.contains(&format!(" {stem}")));
    let phrased = PHRASES.iter().filter(|(phrase, _)| spaced.contains(&format!(" {phrase} ")));
    let opened = OPENERS.iter().filter(|opener| passage.documents && passage.text.starts_with(**opener));
    let mut faults: Vec<String> =
        spelled.chain(phrased).map(|(found, better)| format!("`{found}`: write `{better}`")).collect();
    faults.extend(opened.map(|opener| format!("documentation that opens with `{}`", opener.trim())));
    faults
}

/// All files in a folder with an extension.
fn files(folder: &str, extension: &str) -> Vec<PathBuf> {
    let entries = fs::read_dir(root().join(folder)).into_iter().flatten();
    let paths = entries.map(|entry| entry.expect("a folder entry").path());
    let mut paths: Vec<PathBuf> =
        paths.filter(|path| path.extension().is_some_and(|found| found == extension)).collect();
    paths.sort();
    paths
}

/// Every file with the passages in it.
fn texts() -> Vec<(String, Vec<Passage>)> {
    let mut markdown = files("", "md");
    markdown.extend(files("docs", "md"));
    for entry in fs::read_dir(root().join("crates")).expect("the crates are there") {
        let folder = name_of(&entry.expect("a folder entry").path());
        markdown.extend(files(&folder, "md"));
    }
    let mut code = files("shader_lib", "glsl");
    for folder in ["src", "crates", "tests", "examples", "benches"] {
        code.extend(rust_files(folder));
    }
    let markdown = markdown.into_iter().map(|path| (name_of(&path), paragraphs(&text_of(&path))));
    let code = code.into_iter().map(|path| (name_of(&path), comments(&text_of(&path))));
    markdown.chain(code).collect()
}

#[test]
fn text_uses_the_words_of_the_glossary() {
    let texts = texts();
    assert!(texts.len() > 400, "the texts are not where they are looked for: {}", texts.len());
    let mut wrong = Vec::new();
    for (name, passages) in texts.iter().filter(|(name, _)| !EXCEPT.iter().any(|prefix| name.starts_with(prefix))) {
        for passage in passages {
            wrong.extend(faults(passage).into_iter().map(|fault| format!("{name}:{}: {fault}", passage.line)));
        }
    }
    assert!(wrong.is_empty(), "words that `docs/glossary.md` replaces: {wrong:#?}");
}

#[test]
fn names_are_those_of_the_glossary() {
    let (mut wrong, mut count) = (Vec::new(), 0);
    for path in ["src", "crates", "tests", "examples", "benches"].into_iter().flat_map(rust_files) {
        let name = name_of(&path);
        if NAMED_LATER.iter().any(|prefix| name.starts_with(prefix)) {
            continue;
        }
        for (index, line) in text_of(&path).lines().enumerate() {
            let words: Vec<&str> = line.split(|c: char| !c.is_alphanumeric() && c != '_').collect();
            let declared = words.windows(2).find(|pair| matches!(pair[0], "struct" | "enum" | "trait" | "type" | "fn"));
            let Some(declared) = declared.filter(|_| !line.trim_start().starts_with("//")) else { continue };
            count += 1;
            let better = NAMES.iter().find(|(name, _)| *name == declared[1]);
            wrong.extend(better.map(|(found, term)| format!("{name}:{}: `{found}`: {term}", index + 1)));
        }
    }
    assert!(count > 5000, "only {count} names were seen");
    assert!(wrong.is_empty(), "names for which `docs/glossary.md` has other terms: {wrong:#?}");
}

#[test]
fn exceptions_exist() {
    let gone: Vec<&&str> = EXCEPT.iter().chain(NAMED_LATER).filter(|prefix| !root().join(prefix).exists()).collect();
    assert!(gone.is_empty(), "{gone:?}");
}

#[test]
fn comments_are_split_into_passages() {
    let code = "/// What it is.\n/// More of the grey\n/// area.\n///\n/// What follows is fine.\n\
                /// ```\n/// colour\n/// ```\nfn f() {} // beside `colour`\nlet s = \" // likewise\";\n";
    let found: Vec<String> = comments(code)
        .iter()
        .flat_map(|passage| faults(passage).into_iter().map(|fault| format!("{} {fault}", passage.line)))
        .collect();
    assert_eq!(
        found,
        ["1 `grey`: write `gray`", "1 documentation that opens with `What`", "9 `beside`: write `next to, besides`"]
    );
    let text = "Fine.\n\n```text\ncolour\n```\n\nThe\nbehaviour\n";
    let found: Vec<usize> =
        paragraphs(text).iter().filter(|passage| !faults(passage).is_empty()).map(|p| p.line).collect();
    assert_eq!(found, [7]);
}
