//! Lines above the text that do something (LSP 3.17, `textDocument/codeLens`): the pictures of the scenes that draw a document, the includer
//! that a header is seen in, and the macros that its conditions ask for.

use super::commands::{CONTEXT, DEFINE, PICTURE};
use super::shown::{asked, contexts, scenes};
use crate::project::Choice;
use crate::state::State;
use crate::uri;
use lsp_types::{CodeLens, Command, Position, Range, Uri};
use serde_json::{Value, json};
use std::path::Path;

/// A document has at most this many pictures.
const MAX_SCENES: usize = 8;

/// Answers the request.
pub(super) fn lenses(state: &mut State<'_>, uri: &Uri) -> Option<Vec<CodeLens>> {
    let path = uri::path(uri);
    state.documents.get(&path)?;
    let mut lenses = Vec::new();
    for scene in scenes(state, &path).into_iter().take(MAX_SCENES) {
        let Some(target) = state.uri(&scene) else { continue };
        lenses.push(lens(0, format!("picture of {}", name(&scene)), PICTURE, vec![json!(target)]));
    }
    lenses.extend(of_context(state, &path));
    let macros = asked(state, &path);
    let text = state.documents.get(&path)?.text.text.clone();
    for (number, line) in text.lines().enumerate() {
        let Some(condition) = condition(line) else { continue };
        for choice in macros.iter().filter(|choice| has_word(condition, &choice.name)) {
            lenses.push(lens(number, told(choice), DEFINE, vec![json!(choice.name), next(choice)]));
        }
    }
    Some(lenses)
}

fn lens(line: usize, title: String, command: &str, arguments: Vec<Value>) -> CodeLens {
    let at = Position { line: line as u32, character: 0 };
    let command = Command { title, command: command.to_owned(), arguments: Some(arguments) };
    CodeLens { range: Range { start: at, end: at }, command: Some(command), data: None }
}

fn name(path: &Path) -> String {
    path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default()
}

/// The expression of a condition.
fn condition(line: &str) -> Option<&str> {
    let directive = line.trim_start().strip_prefix('#')?.trim_start();
    ["ifdef", "ifndef", "if", "elif"]
        .iter()
        .find_map(|word| directive.strip_prefix(word))
        .filter(|rest| !rest.starts_with(|letter: char| letter.is_ascii_alphanumeric() || letter == '_'))
}

fn has_word(text: &str, word: &str) -> bool {
    text.split(|letter: char| !letter.is_ascii_alphanumeric() && letter != '_').any(|other| other == word)
}

/// A macro as it is, and as it becomes.
fn told(choice: &Choice) -> String {
    let words = |value: Option<&str>| match value {
        None => "not defined".to_owned(),
        Some(value) => format!("= {value}"),
    };
    let then = next(choice);
    format!("{} {} (show it {})", choice.name, words(choice.chosen.as_deref()), words(then.as_str()))
}

/// The value of a macro after the one that is chosen.
fn next(choice: &Choice) -> Value {
    let at = choice.values.iter().position(|value| *value == choice.chosen);
    let next = at.map_or(0, |at| at + 1);
    json!(choice.values.get(next).cloned().flatten())
}

fn of_context(state: &mut State<'_>, path: &Path) -> Option<CodeLens> {
    if !state.is_header(path) || state.pieces(path).is_some() {
        return None;
    }
    let all = contexts(state, path);
    if all.len() < 2 {
        return None;
    }
    let shown = state.shown_in(path).and_then(|shown| all.iter().position(|file| *file == shown));
    let (title, next) = match shown {
        Some(at) => (format!("as {} includes it ({} of {})", name(all.get(at)?), at + 1, all.len()), all.get(at + 1)),
        None => (format!("as {} files include it (show it in one)", all.len()), all.first()),
    };
    let next = next.and_then(|path| state.uri(path));
    let own = state.uri(path)?;
    Some(lens(0, title, CONTEXT, vec![json!(own), json!(next)]))
}
