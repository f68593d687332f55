//! Removes uncertain declarations from the interface of a shader with errors.
//!
//! *In:* a syntax tree, its analyzed shader, and the errors so far. *Out:* whether the shader has errors. If so,
//! globals that an error may have changed are no longer part of the shader's interface.
//!
//! A declaration is uncertain if an error is in it, or between it and its neighbor; if it uses a name that an
//! uncertain declaration declares; or if its type is poisoned or sized by use. An error in the body of a function
//! makes no declaration uncertain. An error of the preprocessor makes all of them uncertain.
//!
//! *Holds:* the remaining declarations were read as they are written. Others may be missing, because the parser
//! skipped them, so their absence means nothing.

use crate::diagnostic::codes::preprocess::ILLEGAL_CHARACTER;
use crate::diagnostic::{Area, Diagnostic, Diagnostics};
use crate::hir::{ArraySize, Global, Shader, Storage, Type, TypeId, Types};
use crate::source::{SourceMap, Span};

use crate::syntax::ast::{Ast, Declaration, DeclarationKind, Ident, TypeBase};
use crate::syntax::names::Names;
use rustc_hash::FxHashSet;

/// Removes all uncertain globals from the interface of `shader`. Returns whether errors concern the shader: those
/// from number `first_error`, and earlier ones in files that it includes.
pub fn keep_understood(
    ast: &Ast,
    shader: &mut Shader,
    types: &Types,
    sources: &SourceMap,
    diagnostics: &Diagnostics,
    first_error: usize,
) -> bool {
    let text = Text::new(ast, sources);
    let errors = diagnostics.iter().enumerate().filter(|(_, diagnostic)| diagnostic.is_error());
    let errors: Vec<&Diagnostic> =
        errors.filter(|(index, error)| *index >= first_error || text.holds(error)).map(|(_, error)| error).collect();
    if errors.is_empty() {
        return false;
    }
    let doubt = text.doubt(&errors);
    for global in shader.globals.iter_mut().filter(|global| doubt.covers(global, types, sources)) {
        global.storage = Storage::Private;
    }
    true
}

/// The global declarations of a shader with their positions.
struct Text<'a> {
    sources: &'a SourceMap,
    declarations: Vec<(Span, &'a Declaration)>,
    names: &'a Names,
}

/// The declarations whose meaning may differ from the author's intention.
enum Suspicion {
    Everything,
    /// The spans of these declarations, and all names that they use.
    Some(Vec<Span>, FxHashSet<String>),
}

impl<'a> Text<'a> {
    fn new(ast: &'a Ast, sources: &'a SourceMap) -> Self {
        let place = |declaration: &'a Declaration| (sources.call_site(declaration.span), declaration);
        Self { sources, declarations: ast.declarations.iter().map(place).collect(), names: &ast.names }
    }

    /// Whether an error is in a declaration of the shader.
    fn holds(&self, error: &Diagnostic) -> bool {
        let at = self.sources.call_site(error.primary.span);
        at.is_known() && self.declarations.iter().any(|(span, _)| is_in(at, *span))
    }

    fn doubt(&self, errors: &[&Diagnostic]) -> Suspicion {
        let mut doubted = vec![false; self.declarations.len()];
        for error in errors {
            let at = self.sources.call_site(error.primary.span);
            let is_of_line = error.code.area() == Area::Preprocess && *error.code != ILLEGAL_CHARACTER;
            if !at.is_known() || error.code.area() == Area::General || is_of_line {
                return Suspicion::Everything;
            }
            if self.is_in_body(at) {
                continue;
            }
            let labels = error.secondary.iter().map(|label| self.sources.call_site(label.span));
            for span in std::iter::once(at).chain(labels.filter(|span| span.is_known() && !self.is_in_body(*span))) {
                self.touch(span, &mut doubted);
            }
        }
        self.spread(&doubted)
    }

    fn is_in_body(&self, at: Span) -> bool {
        self.declarations
            .iter()
            .any(|(span, declaration)| matches!(declaration.kind, DeclarationKind::Function(..)) && is_in(at, *span))
    }

    /// Marks the declaration at a span, or the two around it.
    fn touch(&self, at: Span, doubted: &mut [bool]) {
        let file = self.sources.file_of(at);
        let same_file = |span: Span| self.sources.file_of(span) == file;
        let mut before = None;
        let mut after = None;
        for (index, (span, _)) in self.declarations.iter().enumerate().filter(|(_, (span, _))| same_file(*span)) {
            if span.start <= at.start {
                before = Some(index);
            } else if after.is_none() {
                after = Some(index);
            }
        }
        let ends = before.and_then(|index| self.declarations.get(index)).is_some_and(|(span, declaration)| {
            let snippet = self.sources.snippet(*span);
            let is_whole = !matches!(declaration.kind, DeclarationKind::Error | DeclarationKind::Broken(_))
                || snippet.ends_with([';', '}']);
            is_in(at, *span) && is_whole
        });
        for index in before.into_iter().chain(after.filter(|_| !ends)) {
            if let Some(flag) = doubted.get_mut(index) {
                *flag = true;
            }
        }
    }

    /// Marks all declarations that use a name which an uncertain declaration declares.
    fn spread(&self, doubted: &[bool]) -> Suspicion {
        let (mut spans, mut names) = (Vec::new(), FxHashSet::default());
        for ((span, declaration), doubted) in self.declarations.iter().zip(doubted) {
            if matches!(declaration.kind, DeclarationKind::Function(..) | DeclarationKind::Prototype(_)) {
                continue;
            }
            let snippet = self.sources.snippet(*span);
            if *doubted || words(snippet).any(|word| names.contains(word)) {
                spans.push(*span);
                names.extend(
                    declared(&declaration.kind).into_iter().map(|ident| self.names.spelling(ident.symbol).to_owned()),
                );
            }
        }
        Suspicion::Some(spans, names)
    }
}

/// The names that a declaration declares.
fn declared(kind: &DeclarationKind) -> Vec<Ident> {
    match kind {
        DeclarationKind::Variables(variables) => {
            let structure = match &variables.ty.base {
                TypeBase::Struct(structure) => structure.name,
                _ => None,
            };
            variables.declarators.iter().map(|declarator| declarator.name).chain(structure).collect()
        }
        DeclarationKind::Block(block) => vec![block.name],
        DeclarationKind::Requalify { names, .. } => names.clone(),
        DeclarationKind::Broken(fragment) => fragment.names.clone(),
        DeclarationKind::Error
        | DeclarationKind::Empty
        | DeclarationKind::Precision { .. }
        | DeclarationKind::Prototype(_)
        | DeclarationKind::Function(..) => Vec::new(),
    }
}

impl Suspicion {
    fn covers(&self, global: &Global, types: &Types, sources: &SourceMap) -> bool {
        let Self::Some(spans, names) = self else { return true };
        let at = sources.call_site(global.span);
        let block = global.block.as_ref().map(|block| &block.name);
        global.implicitly_sized
            || spans.iter().any(|span| is_in(at, *span))
            || names.contains(&global.name)
            || block.is_some_and(|name| names.contains(name))
            || is_open(types, global.ty, names)
    }
}

/// Whether a type is poisoned, has no size, or contains an uncertain struct.
fn is_open(types: &Types, ty: TypeId, names: &FxHashSet<String>) -> bool {
    match types.get(ty) {
        Type::Error | Type::Array(_, ArraySize::Unsized) => true,
        Type::Array(element, ArraySize::Sized(_)) => is_open(types, element, names),
        Type::Struct(id) => {
            let structure = types.structure(id);
            names.contains(&structure.name)
                || structure.members.iter().any(|member| member.implicitly_sized || is_open(types, member.ty, names))
        }
        Type::Void | Type::Scalar(_) | Type::Vector(..) | Type::Matrix(..) | Type::Sampler(_) => false,
    }
}

fn is_in(at: Span, span: Span) -> bool {
    span.is_known() && span.start <= at.start && at.start < span.end
}

fn words(text: &str) -> impl Iterator<Item = &str> {
    text.split(|c: char| !c.is_ascii_alphanumeric() && c != '_').filter(|word| !word.is_empty())
}
