//! An editor, as it describes itself in `initialize`.
//!
//! *In:* the parameters of the request. *Out:* the encoding of positions, the folders, and what the editor can do. *Holds:* each
//! value is read by itself, so that one that is not as the protocol has it hides no other.

use super::text::Encoding;
use super::uri;
use lsp_types::Uri;
use serde_json::Value;
use std::path::PathBuf;

/// The abilities of the editor.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Client {
    /// It asks for diagnostics.
    pub(crate) pulls: bool,
    /// It can be told to ask again.
    pub(crate) refreshes: bool,
    /// It grays out text that is marked as unnecessary.
    pub(crate) grays: bool,
    /// It shows places that belong to a diagnostic.
    pub(crate) relates: bool,
    /// It watches files for the server.
    pub(crate) watches: bool,
    /// It has edits of documents with their versions.
    pub(crate) versions: bool,
    /// It can be told to ask for lenses again.
    pub(crate) refreshes_lenses: bool,
    /// It can be told to ask for hints again.
    pub(crate) refreshes_hints: bool,
    /// It can be told to ask for colors again.
    pub(crate) refreshes_tokens: bool,
    /// It shows documents for the server.
    pub(crate) shows: bool,
    /// It is Visual Studio Code, which shows pictures itself.
    pub(crate) is_code: bool,
    /// It shows trees of symbols.
    pub(crate) trees: bool,
}

impl Client {
    /// The editor that sends these parameters.
    pub(crate) fn new(parameters: &Value) -> Self {
        let at = |path: &str| parameters.pointer(&format!("/capabilities/{path}")).filter(|value| !value.is_null());
        let is = |path: &str| at(path).and_then(Value::as_bool).unwrap_or(false);
        let name = parameters.pointer("/clientInfo/name").and_then(Value::as_str);
        Self {
            pulls: at("textDocument/diagnostic").is_some(),
            // The protocol has the plural; editors that are made with lsp-types send the other.
            refreshes: ["diagnostics", "diagnostic"].iter().any(|name| is(&format!("workspace/{name}/refreshSupport"))),
            grays: at("textDocument/publishDiagnostics/tagSupport").is_some(),
            relates: is("textDocument/publishDiagnostics/relatedInformation"),
            watches: is("workspace/didChangeWatchedFiles/dynamicRegistration"),
            versions: is("workspace/workspaceEdit/documentChanges"),
            refreshes_lenses: is("workspace/codeLens/refreshSupport"),
            refreshes_hints: is("workspace/inlayHint/refreshSupport"),
            refreshes_tokens: is("workspace/semanticTokens/refreshSupport"),
            shows: is("window/showDocument/support"),
            is_code: name.is_some_and(|name| name.starts_with("Visual Studio Code")),
            trees: is("textDocument/documentSymbol/hierarchicalDocumentSymbolSupport"),
        }
    }
}

/// The first encoding of positions that the editor offers and the server has.
pub(crate) fn encoding(parameters: &Value) -> Encoding {
    let offered = parameters.pointer("/capabilities/general/positionEncodings").and_then(Value::as_array);
    offered.into_iter().flatten().filter_map(Value::as_str).find_map(Encoding::named).unwrap_or_default()
}

/// The folders of the workspace. Editors of before there were several have a root alone.
pub(crate) fn folders(parameters: &Value) -> Vec<PathBuf> {
    let path = |uri: &Value| uri.as_str()?.parse().ok().map(|uri: Uri| uri::path(&uri));
    let listed = parameters.get("workspaceFolders").and_then(Value::as_array);
    let folders: Vec<PathBuf> = listed.into_iter().flatten().filter_map(|folder| path(folder.get("uri")?)).collect();
    if folders.is_empty() { parameters.get("rootUri").and_then(path).into_iter().collect() } else { folders }
}

#[cfg(test)]
mod tests {
    use super::{Client, encoding, folders};
    use crate::text::Encoding;
    use serde_json::json;
    use std::path::Path;

    #[test]
    fn one_value_that_cannot_be_read_hides_no_other() {
        let parameters = json!({
            "clientInfo": { "name": 7 },
            "rootUri": "file:///root",
            "workspaceFolders": [{ "uri": "not a uri at all: %%" }, { "name": "none" }, { "uri": "file:///a%20b" }],
            "capabilities": {
                "general": { "positionEncodings": [3, "utf-9", "utf-32", "utf-8"] },
                "window": { "showDocument": "yes" },
                "workspace": { "workspaceEdit": { "documentChanges": true }, "codeLens": [] },
                "textDocument": { "diagnostic": {}, "publishDiagnostics": { "tagSupport": null, "relatedInformation": true } }
            }
        });
        let client = Client::new(&parameters);
        assert!(client.versions && client.pulls && client.relates);
        assert!(!client.shows && !client.is_code && !client.grays && !client.refreshes_lenses);
        assert_eq!(encoding(&parameters), Encoding::Utf32);
        assert_eq!(folders(&parameters), [Path::new("/a b")]);
    }

    #[test]
    fn an_editor_that_says_nothing_is_served() {
        for parameters in [json!(null), json!({}), json!([1]), json!({ "capabilities": null, "rootUri": null })] {
            assert!(!Client::new(&parameters).pulls);
            assert_eq!(encoding(&parameters), Encoding::default());
            assert!(folders(&parameters).is_empty());
        }
        assert_eq!(folders(&json!({ "rootUri": "file:///a" })), [Path::new("/a")]);
    }
}
