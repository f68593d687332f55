//! The requests, with a file for each kind.
//!
//! *In:* the state and the parameters. *Out:* the answer, as the protocol has it. *Holds:* a request that has no answer is answered by
//! null; only a rename that would change a meaning is refused.

pub(super) mod actions;
mod calls;
pub(super) mod commands;
mod completion;
mod definition;
pub(super) mod diagnostics;
mod directives;
mod folding;
mod formatting;
mod hints;
mod hover;
mod lenses;
mod links;
mod overloads;
mod rename;
mod scene;
mod selection;
mod shown;
mod signature;
mod symbols;
mod tokens;
mod unread;

use super::state::State;
use super::text::Encoding;
use lsp_server::ErrorCode;
use lsp_types::request as r;
use lsp_types::request::Request;
use serde_json::{Value, json};

/// Why a request has no answer.
pub(super) struct Failure {
    /// The number in the protocol.
    pub(super) code: i32,
    /// A sentence.
    pub(super) message: String,
}

impl Failure {
    /// A fault of the server.
    pub(super) fn internal(message: &str) -> Self {
        Self { code: ErrorCode::InternalError as i32, message: message.to_owned() }
    }

    /// A request that is refused.
    fn refused(message: impl Into<String>) -> Self {
        Self { code: ErrorCode::RequestFailed as i32, message: message.into() }
    }
}

/// Answers a request.
type Handler = fn(&mut State<'_>, Value) -> Result<Value, Failure>;

/// Reads the parameters, and writes the answer.
fn answer<R: Request>(
    params: Value,
    work: impl FnOnce(R::Params) -> Result<R::Result, Failure>,
) -> Result<Value, Failure> {
    let params = serde_json::from_value(params).map_err(|error| Failure {
        code: ErrorCode::InvalidParams as i32,
        message: format!("the parameters of `{}` cannot be read: {error}", R::METHOD),
    })?;
    serde_json::to_value(work(params)?).map_err(|error| Failure::internal(&error.to_string()))
}

/// The requests by their names.
static HANDLERS: &[(&str, Handler)] = &[
    (r::DocumentDiagnosticRequest::METHOD, |s, p| {
        answer::<r::DocumentDiagnosticRequest>(p, |p| Ok(diagnostics::pull(s, &p)))
    }),
    (r::HoverRequest::METHOD, |s, p| answer::<r::HoverRequest>(p, |p| Ok(hover::hover(s, &p)))),
    (r::Completion::METHOD, |s, p| answer::<r::Completion>(p, |p| Ok(completion::completion(s, &p)))),
    (r::SignatureHelpRequest::METHOD, |s, p| answer::<r::SignatureHelpRequest>(p, |p| Ok(signature::help(s, &p)))),
    (r::GotoDefinition::METHOD, |s, p| {
        answer::<r::GotoDefinition>(p, |p| Ok(definition::definition(s, &p.text_document_position_params)))
    }),
    (r::GotoDeclaration::METHOD, |s, p| {
        answer::<r::GotoDeclaration>(p, |p| Ok(definition::declaration(s, &p.text_document_position_params)))
    }),
    (r::GotoTypeDefinition::METHOD, |s, p| {
        answer::<r::GotoTypeDefinition>(p, |p| Ok(definition::type_definition(s, &p.text_document_position_params)))
    }),
    (r::References::METHOD, |s, p| answer::<r::References>(p, |p| Ok(definition::references(s, &p)))),
    (r::DocumentHighlightRequest::METHOD, |s, p| {
        answer::<r::DocumentHighlightRequest>(p, |p| Ok(definition::highlights(s, &p.text_document_position_params)))
    }),
    (r::PrepareRenameRequest::METHOD, |s, p| answer::<r::PrepareRenameRequest>(p, |p| rename::prepare(s, &p))),
    (r::Rename::METHOD, |s, p| answer::<r::Rename>(p, |p| rename::rename(s, &p))),
    (r::DocumentSymbolRequest::METHOD, |s, p| {
        answer::<r::DocumentSymbolRequest>(p, |p| Ok(symbols::document(s, &p.text_document.uri)))
    }),
    (r::WorkspaceSymbolRequest::METHOD, |s, p| {
        answer::<r::WorkspaceSymbolRequest>(p, |p| Ok(symbols::workspace(s, &p.query)))
    }),
    (r::FoldingRangeRequest::METHOD, |s, p| {
        answer::<r::FoldingRangeRequest>(p, |p| Ok(folding::ranges(s, &p.text_document.uri)))
    }),
    (r::SelectionRangeRequest::METHOD, |s, p| answer::<r::SelectionRangeRequest>(p, |p| Ok(selection::ranges(s, &p)))),
    (r::SemanticTokensFullRequest::METHOD, |s, p| {
        answer::<r::SemanticTokensFullRequest>(p, |p| Ok(tokens::full(s, &p.text_document.uri)))
    }),
    (r::SemanticTokensRangeRequest::METHOD, |s, p| {
        answer::<r::SemanticTokensRangeRequest>(p, |p| Ok(tokens::range(s, &p)))
    }),
    (r::CodeLensRequest::METHOD, |s, p| {
        answer::<r::CodeLensRequest>(p, |p| Ok(lenses::lenses(s, &p.text_document.uri)))
    }),
    (r::ExecuteCommand::METHOD, |s, p| answer::<r::ExecuteCommand>(p, |p| commands::execute(s, &p))),
    (r::InlayHintRequest::METHOD, |s, p| answer::<r::InlayHintRequest>(p, |p| Ok(hints::hints(s, &p)))),
    (r::CodeActionRequest::METHOD, |s, p| answer::<r::CodeActionRequest>(p, |p| Ok(actions::actions(s, &p)))),
    (r::Formatting::METHOD, |s, p| answer::<r::Formatting>(p, |p| Ok(formatting::whole(s, &p.text_document.uri)))),
    (r::RangeFormatting::METHOD, |s, p| answer::<r::RangeFormatting>(p, |p| Ok(formatting::range(s, &p)))),
    (r::CallHierarchyPrepare::METHOD, |s, p| {
        answer::<r::CallHierarchyPrepare>(p, |p| Ok(calls::prepare(s, &p.text_document_position_params)))
    }),
    (r::CallHierarchyIncomingCalls::METHOD, |s, p| {
        answer::<r::CallHierarchyIncomingCalls>(p, |p| Ok(calls::incoming(s, &p.item)))
    }),
    (r::CallHierarchyOutgoingCalls::METHOD, |s, p| {
        answer::<r::CallHierarchyOutgoingCalls>(p, |p| Ok(calls::outgoing(s, &p.item)))
    }),
    (r::DocumentLinkRequest::METHOD, |s, p| {
        answer::<r::DocumentLinkRequest>(p, |p| Ok(links::links(s, &p.text_document.uri)))
    }),
];

/// The handler of a request.
pub(super) fn handler(method: &str) -> Option<Handler> {
    HANDLERS.iter().find(|(name, _)| *name == method).map(|(_, handler)| *handler)
}

/// The abilities of the server (LSP 3.17, `ServerCapabilities`).
pub(super) fn capabilities(encoding: Encoding) -> Value {
    json!({
        "positionEncoding": encoding.kind(),
        "textDocumentSync": { "openClose": true, "change": 2, "save": { "includeText": false } },
        "diagnosticProvider": {
            "identifier": "glisten",
            "interFileDependencies": true,
            "workspaceDiagnostics": false,
        },
        "hoverProvider": true,
        "completionProvider": { "triggerCharacters": [".", "#", "\"", "<", "/", "("], "resolveProvider": false },
        "signatureHelpProvider": { "triggerCharacters": ["(", ","], "retriggerCharacters": [")"] },
        "definitionProvider": true,
        "declarationProvider": true,
        "typeDefinitionProvider": true,
        "referencesProvider": true,
        "documentHighlightProvider": true,
        "renameProvider": { "prepareProvider": true },
        "documentSymbolProvider": true,
        "workspaceSymbolProvider": true,
        "foldingRangeProvider": true,
        "selectionRangeProvider": true,
        "semanticTokensProvider": { "legend": tokens::legend(), "full": true, "range": true },
        "inlayHintProvider": true,
        "codeLensProvider": { "resolveProvider": false },
        "executeCommandProvider": { "commands": commands::names() },
        "codeActionProvider": { "codeActionKinds": ["quickfix", "source.fixAll"] },
        "documentFormattingProvider": true,
        "documentRangeFormattingProvider": true,
        "callHierarchyProvider": true,
        "documentLinkProvider": { "resolveProvider": false },
        "workspace": { "workspaceFolders": { "supported": true, "changeNotifications": true } },
    })
}
