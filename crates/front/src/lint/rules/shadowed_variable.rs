//! `shadowed-variable`: a local with the name of a global, a parameter, or a local of an outer block, which it hides.

use super::super::{Findings, Place, Subject};
use crate::hir::{ExprKind, LocalId, Stmt, StmtKind, VarRef};
use crate::source::Span;
use rustc_hash::FxHashMap;

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    for place in &subject.places {
        let mut scopes = Scopes { place, open: FxHashMap::default(), found: Vec::new() };
        (0..place.function.param_count).map(LocalId::new).for_each(|param| {
            scopes.open(param);
        });
        scopes.walk(place.body);
        let globals = globals(place);
        for (local, hidden) in scopes.found {
            let local = place.function.local(local);
            if subject.texts.text(local.span).is_none() || local.name.is_empty() {
                continue;
            }
            let (what, span) = match hidden {
                Some(hidden) if hidden.index() < place.function.param_count => {
                    ("a parameter", place.function.local(hidden).span)
                }
                Some(hidden) => ("a variable of an outer block", place.function.local(hidden).span),
                None => match globals.get(local.name.as_str()).copied() {
                    Some(span) => ("a global", span),
                    None => continue,
                },
            };
            // Parts that are included into a function are written without each other.
            let file = |span| subject.texts.sources().file_of(span);
            if file(span) != file(local.span) {
                continue;
            }
            let finding = findings.at(local.span, format!("`{}` hides {what} of the same name", local.name));
            findings.push(finding.label(span, "hidden"));
        }
    }
}

/// The declarations of the globals that a function names: only what it names can be mistaken for a local.
fn globals<'a>(place: &Place<'a>) -> FxHashMap<&'a str, Span> {
    let named = place.exprs.iter().filter_map(|expr| match place.kind(*expr) {
        ExprKind::Var(VarRef::Global(id)) => Some(place.shader.global(*id)),
        _ => None,
    });
    let plain = named.filter(|global| global.builtin.is_none() && global.block.is_none() && global.span.is_known());
    plain.map(|global| (global.name.as_str(), global.span)).collect()
}

/// The locals of a function that are open, by their names.
struct Scopes<'p, 'a> {
    place: &'p Place<'a>,
    open: FxHashMap<&'a str, Vec<LocalId>>,
    /// Each local with the one that it hides, if it is one.
    found: Vec<(LocalId, Option<LocalId>)>,
}

impl Scopes<'_, '_> {
    fn open(&mut self, id: LocalId) -> Option<LocalId> {
        let same = self.open.entry(&self.place.function.local(id).name).or_default();
        let hidden = same.last().copied();
        same.push(id);
        hidden
    }

    /// Goes through the statements of a scope. The parser limits the nesting.
    fn walk(&mut self, body: &[Stmt]) {
        let mut own = Vec::new();
        for statement in body {
            if let StmtKind::Local(id, _) = statement.kind {
                let hidden = self.open(id);
                self.found.push((id, hidden));
                own.push(id);
            }
            for inner in statement.kind.bodies() {
                self.walk(inner);
            }
        }
        for id in own {
            self.open.get_mut(self.place.function.local(id).name.as_str()).and_then(Vec::pop);
        }
    }
}
