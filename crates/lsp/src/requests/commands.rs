//! Commands (LSP 3.17, `workspace/executeCommand`): the configuration that is shown, the includer that a header is seen in, translations.
//!
//! *In:* a command with its arguments. *Out:* its result; the messages that bring the editor up to date are left in the state. *Holds:* what a
//! command changes holds for the session, and is in no file.

use super::Failure;
use super::shown::{self, contexts};
use crate::state::State;
use crate::uri;
use lsp_types::request::Request as _;
use lsp_types::{ExecuteCommandParams, Uri, request as r};
use serde_json::{Value, json};
use std::path::PathBuf;
use std::str::FromStr;

/// Draws a scene: `[scene]`, its URI; `[scene, false]` lets the editor not show it. The result has the picture's URI.
pub(crate) const PICTURE: &str = "glisten.picture";
/// Defines a macro from outside: `[name, value]`; null for a macro that is not defined.
pub(super) const DEFINE: &str = "glisten.define";
/// The macros that the conditions of a document ask for: `[document]`.
const CONFIGURATIONS: &str = "glisten.configurations";
/// Shows a header in an includer: `[header, includer]`; null for all of them.
pub(super) const CONTEXT: &str = "glisten.context";
/// The includers of a header: `[header]`.
const CONTEXTS: &str = "glisten.contexts";
/// A program in a language: `[document, language]`.
const TRANSLATION: &str = "glisten.translation";
/// The scenes that draw a document's program: `[document]`.
const SCENES: &str = "glisten.scenes";

/// Carries out a command with its arguments.
type Run = fn(&mut State<'_>, &[Value]) -> Result<Value, Failure>;

static COMMANDS: &[(&str, Run)] = &[
    (DEFINE, define),
    (CONFIGURATIONS, configurations),
    (CONTEXT, context),
    (CONTEXTS, |state, arguments| Ok(json!(includers(state, arguments)?))),
    (TRANSLATION, translation),
    (SCENES, |state, arguments| {
        let path = document(arguments, 0)?;
        let scenes = shown::scenes(state, &path);
        Ok(json!(scenes.iter().filter_map(|scene| state.uri(scene)).collect::<Vec<Uri>>()))
    }),
];

/// The names of the commands.
pub(super) fn names() -> Vec<&'static str> {
    std::iter::once(PICTURE).chain(COMMANDS.iter().map(|(name, _)| *name)).collect()
}

/// Answers the request. A picture is drawn by the server's loop, which need not wait for it.
pub(super) fn execute(state: &mut State<'_>, params: &ExecuteCommandParams) -> Result<Option<Value>, Failure> {
    let Some((_, run)) = COMMANDS.iter().find(|(name, _)| *name == params.command) else {
        return Err(Failure::refused(format!("there is no command `{}`", params.command)));
    };
    run(state, &params.arguments).map(Some)
}

/// The scene that a request draws, if it is one that does, and whether the editor shows it.
pub(crate) fn scene_of(method: &str, params: &Value) -> Option<Result<(PathBuf, bool), Failure>> {
    if method != r::ExecuteCommand::METHOD || params.get("command").and_then(Value::as_str) != Some(PICTURE) {
        return None;
    }
    let arguments = params.get("arguments").and_then(Value::as_array).map_or(&[][..], Vec::as_slice);
    let is_shown = arguments.get(1) != Some(&Value::Bool(false));
    Some(document(arguments, 0).map(|scene| (scene, is_shown)))
}

fn document(arguments: &[Value], index: usize) -> Result<PathBuf, Failure> {
    let text = arguments.get(index).and_then(Value::as_str);
    let uri = text.and_then(|text| Uri::from_str(text).ok());
    uri.map(|uri| uri::path(&uri))
        .ok_or_else(|| Failure::refused(format!("argument {} is the URI of a file", index + 1)))
}

/// Asks the editor for what it shows.
fn refresh(state: &mut State<'_>) {
    let refreshed = [
        (state.client.refreshes, r::WorkspaceDiagnosticRefresh::METHOD),
        (state.client.refreshes_lenses, r::CodeLensRefresh::METHOD),
        (state.client.refreshes_hints, r::InlayHintRefreshRequest::METHOD),
        (state.client.refreshes_tokens, r::SemanticTokensRefresh::METHOD),
    ];
    let asked = refreshed.into_iter().filter(|(is_able, _)| *is_able);
    state.outbox.extend(asked.map(|(_, method)| (method, Value::Null)));
    state.is_changed = true;
}

fn define(state: &mut State<'_>, arguments: &[Value]) -> Result<Value, Failure> {
    if let Some(name) = arguments.first() {
        let Some(name) = name.as_str() else { return Err(Failure::refused("argument 1 is the name of a macro")) };
        let value = match arguments.get(1) {
            None | Some(Value::Null) => None,
            Some(Value::String(value)) => Some(value.clone()),
            Some(value @ (Value::Number(_) | Value::Bool(_))) => Some(value.to_string()),
            Some(_) => return Err(Failure::refused("argument 2 is the value of a macro, or null")),
        };
        state.project.choose(name, value).map_err(Failure::refused)?;
        state.reload();
        refresh(state);
    }
    let chosen = state.project.chosen().into_iter();
    Ok(chosen.map(|(name, value)| (name, Value::String(value))).collect::<serde_json::Map<_, _>>().into())
}

fn configurations(state: &mut State<'_>, arguments: &[Value]) -> Result<Value, Failure> {
    let path = document(arguments, 0)?;
    let macros = shown::asked(state, &path).into_iter();
    let told = macros.map(|choice| json!({ "name": choice.name, "values": choice.values, "chosen": choice.chosen }));
    Ok(told.collect())
}

fn includers(state: &mut State<'_>, arguments: &[Value]) -> Result<Vec<Uri>, Failure> {
    let path = document(arguments, 0)?;
    let found = contexts(state, &path);
    Ok(found.iter().filter_map(|path| state.uri(path)).collect())
}

fn context(state: &mut State<'_>, arguments: &[Value]) -> Result<Value, Failure> {
    let header = document(arguments, 0)?;
    match arguments.get(1) {
        None | Some(Value::Null) => state.show_in(&header, None),
        Some(_) => {
            let includer = document(arguments, 1)?;
            if !contexts(state, &header).contains(&includer) {
                return Err(Failure::refused(format!("`{}` does not include it", includer.display())));
            }
            state.show_in(&header, Some(includer));
        }
    }
    refresh(state);
    Ok(json!(includers(state, arguments)?))
}

fn translation(state: &mut State<'_>, arguments: &[Value]) -> Result<Value, Failure> {
    let path = document(arguments, 0)?;
    let target = arguments.get(1).and_then(Value::as_str).unwrap_or("wgsl");
    let mut told = Vec::new();
    for analysis in state.analyses_of(&path) {
        let is_sound = analysis.compiled.findings.iter().all(|finding| !finding.is_error());
        let Some(program) = analysis.good.as_ref().filter(|_| is_sound) else { continue };
        for (stage, text) in state.project.translation(program, target).map_err(Failure::refused)? {
            told.push(json!({ "program": analysis.key.name, "stage": stage, "text": text }));
        }
    }
    if told.is_empty() {
        return Err(Failure::refused("the program has errors"));
    }
    Ok(Value::Array(told))
}
