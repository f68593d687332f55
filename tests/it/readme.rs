//! The README and the pages in `docs` are correct: commands, flags, links, and the outputs shown.

use crate::support::root;
use std::collections::BTreeSet;
use std::fs;
use std::process::Command;

/// Subcommands whose output depends on the driver and on the time: their outputs are compared with all numbers masked.
static MEASURED: &[&str] = &["verify", "report"];

fn pages() -> Vec<(String, String)> {
    let mut names = vec!["README.md".to_owned()];
    for entry in fs::read_dir(root().join("docs")).expect("the folder is there") {
        let name = entry.expect("an entry").file_name().to_string_lossy().into_owned();
        if name.ends_with(".md") {
            names.push(format!("docs/{name}"));
        }
    }
    names.sort();
    names
        .into_iter()
        .map(|name| (fs::read_to_string(root().join(&name)).expect("readable"), name))
        .map(|(text, name)| (name, text))
        .collect()
}

/// The contents of fenced blocks of a language.
fn blocks<'a>(text: &'a str, language: &str) -> Vec<Vec<&'a str>> {
    let mut blocks = Vec::new();
    let mut current: Option<Vec<&str>> = None;
    for line in text.lines() {
        match &mut current {
            Some(block) if line.starts_with("```") => {
                blocks.push(std::mem::take(block));
                current = None;
            }
            Some(block) => block.push(line),
            None if line == format!("```{language}") => current = Some(Vec::new()),
            None => {}
        }
    }
    blocks
}

/// `$ command` lines with the lines that follow each.
fn commands<'a>(block: &[&'a str]) -> Vec<(&'a str, Vec<&'a str>)> {
    let mut commands: Vec<(&str, Vec<&str>)> = Vec::new();
    for line in block {
        match (line.strip_prefix("$ "), commands.last_mut()) {
            (Some(command), _) => commands.push((command, Vec::new())),
            (None, Some((_, output))) => output.push(line),
            (None, None) => panic!("a block that does not start with a command: {line}"),
        }
    }
    commands
}

fn glisten(arguments: &[&str]) -> (String, i32) {
    let output = Command::new(env!("CARGO_BIN_EXE_glisten"))
        .args(arguments)
        .current_dir(root())
        .output()
        .expect("the program runs");
    let text = String::from_utf8_lossy(&output.stderr).into_owned() + &String::from_utf8_lossy(&output.stdout);
    (text, output.status.code().expect("it ends by itself"))
}

/// The text without trailing white space, and without blank lines at its ends.
fn normal(text: &str) -> String {
    text.lines().map(str::trim_end).collect::<Vec<_>>().join("\n").trim().to_owned()
}

/// Whether an output is the one shown, in which each line `...` matches any lines.
fn is_as_shown(output: &str, shown: &str) -> bool {
    let (output, shown) = (normal(output), format!("\n{}\n", normal(shown)));
    let output = format!("\n{output}\n");
    let parts: Vec<String> = shown.split("\n...\n").map(|part| format!("\n{}\n", part.trim_matches('\n'))).collect();
    let [first, between @ .., last] = parts.as_slice() else {
        return output == shown;
    };
    let Some(mut rest) = output.strip_prefix(first.as_str()).or((first == "\n\n").then_some(&output)) else {
        return false;
    };
    for part in between.iter().filter(|part| *part != "\n\n") {
        match rest.split_once(part.trim_end_matches('\n')) {
            Some((_, after)) => rest = after,
            None => return false,
        }
    }
    last == "\n\n" || rest.ends_with(last.as_str()) || format!("\n{rest}").ends_with(last.as_str())
}

#[test]
fn elided_outputs_are_compared() {
    assert!(is_as_shown("a\nb\nc\n", "a\n...\nc"));
    assert!(is_as_shown("a\nb\nc\n", "a\n..."));
    assert!(is_as_shown("a\nb\nc\n", "...\nc"));
    assert!(is_as_shown("a\nb\nc\nd\n", "...\nb\n...\nd"));
    assert!(is_as_shown("a\nb\n", "a\nb"));
    assert!(!is_as_shown("a\nb\nc\n", "a\n...\nb"));
    assert!(!is_as_shown("a\nb\nc\n", "b\n..."));
    assert!(!is_as_shown("a\nb\nc\nd\n", "...\nx\n...\nd"));
    assert!(!is_as_shown("a\nb\n", "a"));
}

/// A text in which each number is `#`, without the lines that name the adapter, and with one space for several.
fn masked(text: &str) -> String {
    let lines = text.lines().filter(|line| !line.starts_with("drawn "));
    let words = |line: &str| line.split_whitespace().map(without_numbers).collect::<Vec<_>>().join(" ");
    lines.map(words).collect::<Vec<_>>().join("\n")
}

/// A word with `#` for each number, which may have a sign, a fraction and an exponent.
fn without_numbers(word: &str) -> String {
    let mut out = String::new();
    let mut rest = word;
    while let Some(first) = rest.find(|c: char| c.is_ascii_digit()) {
        out.push_str(rest[..first].trim_end_matches('-'));
        out.push('#');
        rest = rest[first..].trim_start_matches(|c: char| c.is_ascii_digit() || c == '.');
        rest = rest.strip_prefix("e-").unwrap_or(rest).trim_start_matches(|c: char| c.is_ascii_digit());
    }
    out + rest
}

/// The subcommands that a page names: in `$ glisten ...` lines, and in the first column of tables.
fn named_commands(page: &str, existing: &BTreeSet<String>) -> BTreeSet<String> {
    let cells = page.lines().filter_map(|line| line.strip_prefix("| `")).filter_map(|line| line.split(" | ").next());
    let shown = page.lines().filter_map(|line| line.strip_prefix("$ "));
    let words = cells.chain(shown).flat_map(|text| text.split(|c: char| !(c.is_ascii_lowercase() || c == '-')));
    words.filter(|word| existing.contains(*word)).map(str::to_owned).collect()
}

fn existing_commands() -> BTreeSet<String> {
    let (help, _) = glisten(&["--help"]);
    let listed = help.lines().skip_while(|line| !line.starts_with("Commands:")).skip(1);
    let rows = listed.take_while(|line| !line.is_empty()).filter_map(|line| line.strip_prefix("  "));
    let names = rows.filter(|row| !row.starts_with(' ')).filter_map(|row| row.split_whitespace().next());
    names.map(str::to_owned).collect()
}

/// The README, followed from top to bottom: every command runs, and prints what the page shows.
#[test]
fn the_tour_of_the_readme_prints_what_it_shows() {
    let readme = fs::read_to_string(root().join("README.md")).expect("readable");
    // A scene that exists is not written again.
    let _ = fs::remove_dir_all(root().join("target/readme"));
    let mut compared = 0;
    for (command, shown) in blocks(&readme, "console").iter().flat_map(|block| commands(block)) {
        let arguments: Vec<&str> = command.split_whitespace().collect();
        let (program, arguments) = arguments.split_first().expect("a command");
        assert_eq!(*program, "glisten", "a console block of the README runs glisten alone: {command}");
        let (output, code) = glisten(arguments);
        let subcommand = *arguments.first().expect("a subcommand");
        let shown = shown.join("\n");
        assert!(code == 0 || !shown.is_empty(), "$ {command}\n--- fails with exit code {code}\n{output}");
        if shown.is_empty() {
            continue;
        }
        compared += 1;
        let same = match MEASURED.contains(&subcommand) {
            true => is_as_shown(&masked(&output), &masked(&shown)),
            false => is_as_shown(&output, &shown),
        };
        assert!(same, "$ {command}\n--- prints\n{output}\n--- the README shows\n{shown}");
    }
    assert!(compared >= 5, "only {compared} outputs of the README were compared");
}

#[test]
fn the_readme_shows_the_wgsl_that_is_written() {
    let readme = fs::read_to_string(root().join("README.md")).expect("readable");
    let [sample] = blocks(&readme, "wgsl").try_into().expect("one block of WGSL");
    let fragment = root().join("fixtures/programs/phong.frag").display().to_string();
    let (written, code) = glisten(&["compile", &fragment, "--target", "wgsl", "-o", "-", "-q"]);
    assert_eq!(code, 0, "{written}");
    assert!(written.contains(&sample.join("\n")), "the README's WGSL is not a part of\n{written}");
}

#[test]
fn every_command_is_in_the_readme_and_is_short_there() {
    let readme = fs::read_to_string(root().join("README.md")).expect("readable");
    let existing = existing_commands();
    assert_eq!(named_commands(&readme, &existing), existing, "the README and the commands that exist");
    assert!(readme.lines().count() <= 250, "the README has {} lines", readme.lines().count());
}

#[test]
fn every_page_is_in_the_index() {
    let index = fs::read_to_string(root().join("docs/README.md")).expect("readable");
    let name = |page: &str| page.strip_prefix("docs/").map(str::to_owned);
    let missing: Vec<String> = pages()
        .iter()
        .filter_map(|(page, _)| name(page))
        .filter(|page| page != "README.md" && !index.contains(&format!("({page})")))
        .collect();
    assert!(missing.is_empty(), "docs/README.md does not list {missing:?}");
}

#[test]
fn links_lead_to_files_that_are_there() {
    let mut broken = Vec::new();
    for (name, text) in pages() {
        let folder = root().join(&name).parent().expect("a page is in a folder").to_owned();
        for target in text.split("](").skip(1).filter_map(|rest| rest.split(')').next()) {
            let file = target.split('#').next().unwrap_or_default();
            if !file.is_empty() && !file.contains("://") && !folder.join(file).exists() {
                broken.push(format!("{name}: {target}"));
            }
        }
    }
    assert!(broken.is_empty(), "{broken:#?}");
}

/// Whether a line is of a table about another repository, `owner/name`, whose paths are its own.
fn is_of_another_repository(line: &str) -> bool {
    line.strip_prefix("| ").and_then(|rest| rest.split(' ').next()).is_some_and(|first| first.contains('/'))
}

#[test]
fn paths_in_the_docs_are_there() {
    let mut missing = Vec::new();
    for (name, text) in pages().into_iter().filter(|(name, _)| !name.ends_with("CHANGELOG.md")) {
        let is_own = |line: &&str| !name.ends_with("repositories.md") || !is_of_another_repository(line);
        let text: String = text.split_inclusive('\n').filter(is_own).collect();
        for word in text.split('`').skip(1).step_by(2) {
            let is_path = ["src/", "tests/", "fixtures/", "examples/"].iter().any(|start| word.starts_with(start));
            let is_plain = !word.contains(['<', '*', ' ', '{']) && !word.contains("name");
            if is_path && is_plain && !root().join(word).exists() {
                missing.push(format!("{name}: {word}"));
            }
        }
    }
    assert!(missing.is_empty(), "{missing:#?}");
}
