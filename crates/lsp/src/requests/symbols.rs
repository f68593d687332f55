//! The outline of a document, and names in the workspace (LSP 3.17, `textDocument/documentSymbol`, `workspace/symbol`).

use crate::analysis::Analysis;
use crate::describe;
use crate::project::ProgramKey;
use crate::state::State;
use crate::uri;
use glisten_front::analysis::Denoted;
use glisten_front::hir::Storage;
use glisten_front::index::{Occurrence, Role, SymbolKind as Named, View};
use glisten_front::source::{FileId, Span};
use glisten_front::syntax::ast::{DeclarationKind, MemberDecl, StructSpec, TypeBase, TypeSpec};
use lsp_types::{
    DocumentSymbol, DocumentSymbolResponse, Location, SymbolInformation, SymbolKind, Uri, WorkspaceSymbolResponse,
};
use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};

/// A workspace has at most this many symbols in an answer.
const MAX_SYMBOLS: usize = 400;
/// A workspace's search compiles at most this many programs.
const MAX_PROGRAMS: usize = 400;

/// The outline of a document.
pub(super) fn document(state: &mut State<'_>, uri: &Uri) -> Option<DocumentSymbolResponse> {
    let path = uri::path(uri);
    if state.pieces(&path).is_some() {
        // The host language has its own.
        return None;
    }
    let mut symbols = outline(state, &path);
    symbols.sort_by_key(|symbol| (symbol.range.start, std::cmp::Reverse(symbol.range.end)));
    if state.client.trees {
        return Some(DocumentSymbolResponse::Nested(symbols));
    }
    let mut flat = Vec::new();
    for symbol in symbols {
        flatten(uri, None, symbol, &mut flat);
    }
    Some(DocumentSymbolResponse::Flat(flat))
}

fn flatten(uri: &Uri, container: Option<String>, symbol: DocumentSymbol, flat: &mut Vec<SymbolInformation>) {
    let name = symbol.name.clone();
    let location = Location { uri: uri.clone(), range: symbol.range };
    #[expect(deprecated, reason = "the type has the field")]
    flat.push(SymbolInformation {
        name: symbol.name,
        kind: symbol.kind,
        tags: None,
        deprecated: None,
        location,
        container_name: container,
    });
    for child in symbol.children.unwrap_or_default() {
        flatten(uri, Some(name.clone()), child, flat);
    }
}

/// Makes symbols of one file.
struct Maker<'a, 'p> {
    state: &'a State<'p>,
    analysis: &'a Analysis,
    files: Vec<FileId>,
}

fn outline(state: &mut State<'_>, path: &Path) -> Vec<DocumentSymbol> {
    let analyses = state.analyses_of(path);
    let Some(analysis) = analyses.first() else { return Vec::new() };
    let mut symbols: Vec<DocumentSymbol> = Vec::new();
    let mut known: HashSet<lsp_types::Range> = HashSet::new();
    let maker = Maker { state, analysis, files: analysis.files(path).collect() };
    for (number, view) in analysis.compiled.inspection.views() {
        symbols.extend(maker.of_view(number, view).into_iter().filter(|symbol| known.insert(symbol.selection_range)));
    }
    symbols
}

impl Maker<'_, '_> {
    fn range(&self, span: Span) -> Option<lsp_types::Range> {
        let (file, range) = self.analysis.place(span)?;
        self.files.contains(&file).then(|| self.analysis.text(file).range(range, self.state.encoding))
    }

    fn symbol(
        &self,
        name: &str,
        kind: SymbolKind,
        whole: Span,
        own: Span,
        detail: Option<String>,
    ) -> Option<DocumentSymbol> {
        let selection_range = self.range(own)?;
        let whole =
            self.range(whole).filter(|whole| whole.start <= selection_range.start && selection_range.end <= whole.end);
        #[expect(deprecated, reason = "the type has the field")]
        Some(DocumentSymbol {
            name: if name.is_empty() { "(no name)".to_owned() } else { name.to_owned() },
            detail,
            kind,
            tags: None,
            deprecated: None,
            range: whole.unwrap_or(selection_range),
            selection_range,
            children: None,
        })
    }

    fn of_view(&self, number: usize, view: &View) -> Vec<DocumentSymbol> {
        let mut symbols = Vec::new();
        let mut names: HashMap<Span, Denoted> = HashMap::new();
        for note in &view.notes.names {
            names.entry(note.span).or_insert(note.denoted);
        }
        let detail = |name: Span| describe::declaration(self.analysis, number, *names.get(&name)?);
        for definition in &view.ast.directives.definitions {
            let whole = self.analysis.sources().join(definition.span, definition.body);
            let body = self.analysis.sources().snippet(definition.body);
            let detail = Some(body.lines().next().unwrap_or("").to_owned()).filter(|body| !body.is_empty());
            symbols.extend(self.symbol(&definition.name, SymbolKind::CONSTANT, whole, definition.span, detail));
        }
        for declaration in &view.ast.declarations {
            let span = self.analysis.sources().call_site(declaration.span);
            match &declaration.kind {
                DeclarationKind::Function(header, _) | DeclarationKind::Prototype(header) => {
                    let detail = detail(header.name.span);
                    let name = view.ast.name(header.name);
                    symbols.extend(self.symbol(name, SymbolKind::FUNCTION, span, header.name.span, detail));
                }
                DeclarationKind::Variables(variables) => {
                    symbols.extend(self.structure(view, &variables.ty));
                    for declarator in &variables.declarators {
                        let own = declarator.name.span;
                        let kind = kind(view, names.get(&own));
                        let detail = detail(own);
                        let name = view.ast.name(declarator.name);
                        let whole =
                            if variables.declarators.len() == 1 && !matches!(variables.ty.base, TypeBase::Struct(_)) {
                                span
                            } else {
                                own
                            };
                        symbols.extend(self.symbol(name, kind, whole, own, detail));
                    }
                }
                DeclarationKind::Block(block) => {
                    let name = view.ast.name(block.name);
                    let mut symbol = self.symbol(name, SymbolKind::INTERFACE, span, block.name.span, None);
                    if let Some(symbol) = &mut symbol {
                        symbol.children = Some(self.members(view, &block.members));
                    }
                    symbols.extend(symbol);
                }
                DeclarationKind::Broken(fragment) => {
                    symbols.extend(fragment.variables.iter().filter_map(|broken| self.structure(view, &broken.ty)));
                    for name in &fragment.names {
                        let spelled = view.ast.name(*name);
                        let detail = detail(name.span);
                        symbols.extend(self.symbol(spelled, SymbolKind::VARIABLE, span, name.span, detail));
                    }
                }
                DeclarationKind::Error
                | DeclarationKind::Empty
                | DeclarationKind::Precision { .. }
                | DeclarationKind::Requalify { .. } => {}
            }
        }
        symbols
    }

    fn structure(&self, view: &View, spec: &TypeSpec) -> Option<DocumentSymbol> {
        let TypeBase::Struct(StructSpec { name: Some(name), members }) = &spec.base else { return None };
        let mut symbol = self.symbol(view.ast.name(*name), SymbolKind::STRUCT, spec.span, name.span, None)?;
        symbol.children = Some(self.members(view, members));
        Some(symbol)
    }

    fn members(&self, view: &View, rows: &[MemberDecl]) -> Vec<DocumentSymbol> {
        let mut symbols = Vec::new();
        for row in rows {
            let detail = self.analysis.sources().snippet(row.ty.span).to_owned();
            for declarator in &row.declarators {
                let (name, own) = (view.ast.name(declarator.name), declarator.name.span);
                symbols.extend(self.symbol(name, SymbolKind::FIELD, own, own, Some(detail.clone())));
            }
        }
        symbols
    }
}

/// The kind of what a name denotes.
fn kind(view: &View, denoted: Option<&Denoted>) -> SymbolKind {
    let global = match denoted {
        Some(Denoted::Global(id)) => view.shader.globals.get(id.index()),
        _ => None,
    };
    match global.map(|global| global.storage) {
        Some(Storage::Const) => SymbolKind::CONSTANT,
        Some(Storage::Uniform) => SymbolKind::PROPERTY,
        _ => SymbolKind::VARIABLE,
    }
}

/// The names of the workspace that contain the letters of a query, in their order.
pub(super) fn workspace(state: &mut State<'_>, query: &str) -> Option<WorkspaceSymbolResponse> {
    let mut found: Vec<SymbolInformation> = Vec::new();
    let open: Vec<PathBuf> = state.documents.keys().cloned().collect();
    let mut keys: Vec<ProgramKey> = Vec::new();
    for path in open {
        keys.extend(state.analyses_of(&path).iter().map(|analysis| analysis.key.clone()));
    }
    for folder in state.folders.clone() {
        keys.extend(state.project.programs_with(&folder, &|word| fits(word, query), MAX_PROGRAMS));
    }
    keys.sort();
    keys.dedup();
    for key in keys {
        if found.len() >= MAX_SYMBOLS {
            break;
        }
        let analysis = state.analysis(&key);
        of_program(state, &analysis, query, &mut found);
        // A workspace may have more programs than should be kept.
        state.release(&key);
    }
    found.sort_by(|a, b| (a.name.len(), &a.name).cmp(&(b.name.len(), &b.name)));
    Some(WorkspaceSymbolResponse::Flat(found))
}

/// Adds the names of a program.
fn of_program(state: &State<'_>, analysis: &Analysis, query: &str, found: &mut Vec<SymbolInformation>) {
    let index = analysis.index();
    for (id, symbol) in index.symbols() {
        let is_global = !matches!(symbol.places.first(), Some((_, Denoted::Local(..) | Denoted::Broken(_))));
        let is_own = matches!(symbol.kind, Named::Declared | Named::Macro) && is_global;
        if !is_own || !fits(&symbol.name, query) {
            continue;
        }
        let declared = |found: &&Occurrence| matches!(found.role, Role::Declaration | Role::Definition);
        for occurrence in index.of(id).filter(declared) {
            let is_file = analysis.named_place(occurrence.span).is_some_and(|place| !place.file.starts_with('<'));
            let Some(location) = state.location(analysis, occurrence.span).filter(|_| is_file) else { continue };
            if found.len() < MAX_SYMBOLS && !found.iter().any(|other| other.location == location) {
                #[expect(deprecated, reason = "the type has the field")]
                found.push(SymbolInformation {
                    name: symbol.name.clone(),
                    kind: kind_of(symbol.kind, symbol.places.first().map(|(_, denoted)| *denoted)),
                    tags: None,
                    deprecated: None,
                    location,
                    container_name: Some(analysis.key.name.clone()),
                });
            }
        }
    }
}

fn kind_of(kind: Named, denoted: Option<Denoted>) -> SymbolKind {
    match (kind, denoted) {
        (Named::Macro, _) => SymbolKind::CONSTANT,
        (_, Some(Denoted::Function(_))) => SymbolKind::FUNCTION,
        (_, Some(Denoted::Struct(_))) => SymbolKind::STRUCT,
        (_, Some(Denoted::Block(_))) => SymbolKind::INTERFACE,
        (_, Some(Denoted::Member(..))) => SymbolKind::FIELD,
        _ => SymbolKind::VARIABLE,
    }
}

/// Whether a name has the letters of a query in their order, in any case.
fn fits(name: &str, query: &str) -> bool {
    let mut letters = name.chars().flat_map(char::to_lowercase);
    query.chars().flat_map(char::to_lowercase).all(|wanted| letters.any(|letter| letter == wanted))
}
