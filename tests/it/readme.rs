//! The README and the pages in `docs` are correct: commands, flags, links, and the outputs shown.

use crate::support::root;
use std::collections::BTreeSet;
use std::fs;
use std::process::Command;

/// Subcommands whose output is the same on every machine; for the others, only the arguments are checked.
static SAME_EVERYWHERE: &[&str] = &["lint", "stability", "explain", "compile", "reflect", "lib"];

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

/// Whether an output is the one shown, in which a line `...` matches any lines.
fn is_as_shown(output: &str, shown: &str) -> bool {
    let (output, shown) = (normal(output), normal(shown));
    match shown.split_once("\n...\n") {
        Some((before, after)) => output.starts_with(before) && output.ends_with(after),
        None => match shown.strip_suffix("\n...") {
            Some(before) => output.starts_with(before),
            None => output == shown,
        },
    }
}

#[test]
fn outputs_in_the_readme_are_what_the_commands_print() {
    let readme = fs::read_to_string(root().join("README.md")).expect("readable");
    let mut seen = BTreeSet::new();
    for (command, shown) in blocks(&readme, "console").iter().flat_map(|block| commands(block)) {
        let arguments: Vec<&str> = command.split_whitespace().collect();
        let (program, arguments) = arguments.split_first().expect("a command");
        if *program != "glisten" {
            continue;
        }
        let subcommand = *arguments.first().expect("a subcommand");
        seen.insert(subcommand.to_owned());
        // `help` has no flags of its own.
        let asked = if subcommand == "help" { arguments.to_vec() } else { vec![subcommand, "--help"] };
        let (help, code) = glisten(&asked);
        assert_eq!(code, 0, "{command}: there is no such subcommand");
        for flag in arguments.iter().filter(|argument| argument.starts_with('-')) {
            assert!(help.contains(flag), "{command}: no {flag} in\n{help}");
        }
        for file in arguments.iter().filter(|argument| argument.starts_with("fixtures/")) {
            assert!(root().join(file).exists(), "{command}: {file} is not there");
        }
        if SAME_EVERYWHERE.contains(&subcommand) {
            let (output, _) = glisten(arguments);
            let shown = shown.join("\n");
            assert!(is_as_shown(&output, &shown), "$ {command}\n--- prints\n{output}\n--- the README shows\n{shown}");
        }
    }
    let (help, _) = glisten(&["--help"]);
    let listed = help
        .lines()
        .skip_while(|line| !line.starts_with("Commands:"))
        .skip(1)
        .take_while(|line| !line.is_empty())
        .filter_map(|line| line.strip_prefix("  ").filter(|rest| !rest.starts_with(' ')));
    let existing: BTreeSet<String> =
        listed.filter_map(|line| line.split_whitespace().next()).map(str::to_owned).collect();
    assert_eq!(seen, existing, "the README's tour and the commands that exist");
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

#[test]
fn paths_in_the_docs_are_there() {
    let mut missing = Vec::new();
    for (name, text) in pages().into_iter().filter(|(name, _)| !name.ends_with("CHANGELOG.md")) {
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
