//! `glisten explain`: prints the page of a diagnostic from the registry of codes.

use crate::arguments::args::nearest_code;
use crate::commands::examples::Examples;
use crate::console::Console;
use crate::exit::{Exit, Failure, Outcome};
use clap::Args;
use glisten_front::diagnostic::{Code, Example, codes};
use glisten_front::hir::Stage;
use glisten_front::language::{EDITIONS, Edition, runs};

/// Examples of its use.
pub(crate) const EXAMPLES: Examples =
    &[("glisten explain E0301", "a code, with an example"), ("glisten explain --list", "all codes")];

/// Show what a diagnostic means, with a bad and a good example
#[derive(Args, Debug)]
pub(crate) struct ExplainArgs {
    /// A code or its name: `E0301`, `undeclared-identifier`
    #[arg(required_unless_present = "list")]
    code: Option<String>,
    /// List all codes, with a sentence for each
    #[arg(long, conflicts_with = "code")]
    list: bool,
}

/// Runs the command.
pub(crate) fn run(args: &ExplainArgs, console: &Console) -> Outcome {
    let text = match &args.code {
        Some(key) => page(codes::find(key.trim()).ok_or_else(|| unknown(key))?),
        None => list(),
    };
    console.output(&text)?;
    Ok(Exit::Ok)
}

fn unknown(key: &str) -> Failure {
    let failure = Failure::usage(format!("there is no code `{key}`"));
    let key = key.trim().to_ascii_uppercase();
    let by_letters = || codes::all().map(|code| code.id).min_by_key(|id| strsim::damerau_levenshtein(&key, id));
    match nearest_code(&key.to_ascii_lowercase()).or_else(by_letters) {
        Some(near) => failure.help(format!("did you mean `{near}`? `glisten explain --list` names all codes")),
        None => failure.help("`glisten explain --list` names all codes"),
    }
}

/// A line for each code: the code, its severity, its name, the first sentence of its page. Those of one phase are together, errors
/// first, and then in the order of their numbers.
fn list() -> String {
    let width = codes::all().map(|code| code.name.len()).max().unwrap_or_default();
    let line = |code: &Code| {
        format!("{:6} {:8} {:width$}  {}\n", code.id, code.severity.to_string(), code.name, first_sentence(code.page))
    };
    let mut all: Vec<&Code> = codes::all().collect();
    all.sort_by_key(|code| (code.lint.is_some(), code.id.get(1..3), code.id));
    all.into_iter().map(line).collect()
}

/// The text up to the first period that a new sentence follows.
fn first_sentence(page: &str) -> &str {
    let begins = |rest: &str| rest.starts_with(|first: char| first.is_uppercase() || first == '`');
    let end = page.match_indices(". ").find(|(at, _)| page.get(at + 2..).is_some_and(begins));
    end.and_then(|(at, _)| page.get(..=at)).unwrap_or(page)
}

/// The printed page: heading, meaning, section, examples.
pub(crate) fn page(code: &Code) -> String {
    let mut text = format!("{} {} ({})\n\n{}\n", code.id, code.name, code.severity, wrap(code.page));
    if !code.section.is_empty() {
        text.push_str(&format!("\nSpecification: {}\n", code.section));
    }
    text.push_str(&versions(code));
    text.push_str(&rule(code));
    text.push_str(&example("Bad", code.bad));
    text.push_str(&example("Good", code.good));
    text
}

/// The group, the level and the fixes of a lint rule, with the reason of its level.
fn rule(code: &Code) -> String {
    let Some(lint) = code.lint else { return String::new() };
    let (group, level, fixes) = (lint.group.name(), lint.level.name(), lint.fixable.name());
    format!("\nGroup: {group}; level: {level}; fixes: {fixes}\n{}\n", wrap(lint.rationale))
}

/// The versions in which a rule of the language is in force, and the sections of those that number them otherwise.
fn versions(code: &Code) -> String {
    if !code.is_of_language() {
        return String::new();
    }
    let mut text = format!("Versions: {}\n", code.versions().map(span).collect::<Vec<_>>().join(", "));
    let cited = code.section.split_once('§').map_or("", |(_, rest)| rest);
    let others: Vec<String> = runs(code.section)
        .into_iter()
        .filter(|(_, _, places)| places.trim_start_matches('§') != cited)
        .filter_map(|(first, last, places)| {
            let within = |edition: &&Edition| first <= **edition && **edition <= last && code.is_in_force(**edition);
            let mut known = EDITIONS.iter().filter(within);
            let first = *known.next()?;
            Some(format!("{} {places}", span((first, *known.next_back().unwrap_or(&first)))))
        })
        .collect();
    if !others.is_empty() {
        text.push_str(&format!("In other versions: {}\n", others.join("; ")));
    }
    text
}

/// `GLSL 1.10 to 4.60`
fn span((first, last): (Edition, Edition)) -> String {
    if first == last {
        return first.name();
    }
    format!("{} to {}.{:02}", first.name(), last.number / 100, last.number % 100)
}

fn example(title: &str, example: Example) -> String {
    let parts: Vec<(&str, &str)> = match example {
        Example::Vertex(text) => vec![("a vertex shader", text)],
        Example::Fragment(text) => vec![("a fragment shader", text)],
        Example::Geometry(text) => vec![("a geometry shader", text)],
        Example::Program(vertex, fragment) => vec![("a vertex shader", vertex), ("its fragment shader", fragment)],
        Example::Shaders(shaders) => shaders
            .iter()
            .map(|&(stage, text)| match stage {
                Stage::Vertex => ("a vertex shader", text),
                Stage::Geometry => ("a geometry shader", text),
                Stage::Fragment => ("a fragment shader", text),
            })
            .collect(),
        Example::Text(text) => vec![("", text)],
        Example::None => vec![],
    };
    parts
        .into_iter()
        .map(|(what, text)| {
            let head = if what.is_empty() { title.to_owned() } else { format!("{title}, {what}") };
            let lines: String = text.trim_matches('\n').lines().map(|line| format!("    {line}\n")).collect();
            format!("\n{head}:\n\n{lines}")
        })
        .collect()
}

/// Wraps paragraphs to lines of at most 80 characters.
fn wrap(text: &str) -> String {
    const WIDTH: usize = 80;
    let mut lines = vec![String::new()];
    for word in text.split_whitespace() {
        let last = lines.last_mut().expect("there is a line from the start on");
        if !last.is_empty() && last.chars().count() + 1 + word.chars().count() > WIDTH {
            lines.push(word.to_owned());
        } else {
            if !last.is_empty() {
                last.push(' ');
            }
            last.push_str(word);
        }
    }
    lines.join("\n")
}
