//! The files that includes name, as links (LSP 3.17, `textDocument/documentLink`).

use crate::state::State;
use crate::uri;
use lsp_types::{DocumentLink, Uri};

/// Answers the request.
pub(super) fn links(state: &mut State<'_>, uri: &Uri) -> Option<Vec<DocumentLink>> {
    let path = uri::path(uri);
    let mut links: Vec<DocumentLink> = Vec::new();
    for analysis in state.analyses_of(&path) {
        for view in analysis.views_of(&path) {
            for include in &view.ast.directives.includes {
                let Some(place) = analysis.named_place(include.span) else { continue };
                let Some(file) = include.file.filter(|_| path.as_os_str() == place.file.as_str()) else { continue };
                let text = state.documents.get(&path)?.text.clone();
                // The quotes are no part of the name.
                let range = text.range(place.start + 1..place.end.saturating_sub(1), state.encoding);
                let target = state.path_of(analysis.sources().file(file).name()).and_then(|path| state.uri(&path));
                if !links.iter().any(|link| link.range == range) {
                    links.push(DocumentLink { range, target, tooltip: None, data: None });
                }
            }
        }
    }
    Some(links)
}
