//! `interpolated-normal`: a normal or a direction of length 1 that was interpolated, and so is shorter, in a cosine or a reflection.

use super::super::rate::{Rate, rate};
use super::super::{Findings, Place, Subject};
use crate::builtin::BuiltinFunction as B;
use crate::diagnostic::Applicability;
use crate::hir::written_by;
use crate::hir::{ExprId, ExprKind, GlobalId, Interpolation, Shader, Stage, Storage, Type, VarRef};

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    let program = subject.program;
    let [vertex, .., fragment] = program.stages.as_slice() else { return };
    if (vertex.stage, fragment.stage, program.stages.len()) != (Stage::Vertex, Stage::Fragment, 2) {
        return;
    }
    for varying in &program.interface.varyings {
        let (Some(from), Some(to)) = (varying.from, varying.to) else { continue };
        if varying.interpolation == Interpolation::Flat || !is_unit_in(subject, vertex, from.global) {
            continue;
        }
        // One finding for a varying: the first place.
        let uses = subject.exprs().filter(|(place, _)| place.shader.stage == Stage::Fragment);
        let mut places =
            uses.flat_map(|(place, expr)| angles(place, expr).into_iter().map(move |argument| (place, argument)));
        let found = places.find(|(place, argument)| {
            matches!(place.kind(place.meaning(*argument)), ExprKind::Var(VarRef::Global(global)) if *global == to.global)
        });
        if let Some((place, argument)) = found {
            let name = &place.shader.global(to.global).name;
            let message = format!("`{name}` is shorter than 1 between the vertices, and this takes its length for 1");
            let span = place.expr(argument).span;
            let text = subject.texts.text(span).map(|text| format!("normalize({text})"));
            let fix = text.and_then(|text| subject.texts.replace(Applicability::Unsafe, span, text));
            let mut finding = findings.at(span, message).help("normalize it in the fragment stage, too");
            finding = finding.label(vertex.global(from.global).span, "normalized in the vertex stage");
            findings.push(finding.maybe_fix(fix));
        }
    }
}

/// Whether all that the vertex stage assigns to an output are vectors of length 1 that differ from vertex to vertex.
fn is_unit_in(subject: &Subject<'_>, vertex: &Shader, output: GlobalId) -> bool {
    let global = vertex.global(output);
    if global.storage != Storage::Out || !matches!(subject.program.types.get(global.ty), Type::Vector(_, 3)) {
        return false;
    }
    let (mut all, mut any) = (true, false);
    for (place, expr) in subject.exprs().filter(|(place, _)| place.shader.stage == Stage::Vertex) {
        written_by(vertex, expr, &mut |target| {
            if vertex.root_variable(target) == Some(VarRef::Global(output)) {
                let value = match place.kind(expr) {
                    ExprKind::Assign(None, whole, value) if *whole == target => Some(*value),
                    _ => None,
                };
                let is_whole = matches!(place.kind(target), ExprKind::Var(_));
                let is_unit = value.is_some_and(|value| {
                    matches!(place.kind(value), ExprKind::BuiltinCall(B::Normalize, _))
                        && rate(place, value) == Rate::Invocation
                });
                (any, all) = (true, all && is_whole && is_unit);
            }
        });
    }
    any && all
}

/// The vectors whose lengths an expression takes for 1: both sides of a cosine, the normal of a reflection.
fn angles(place: &Place<'_>, expr: ExprId) -> Vec<ExprId> {
    match place.kind(expr) {
        // With itself, it is a square of the length.
        ExprKind::BuiltinCall(B::Dot, sides) => match sides.as_slice() {
            [a, b] if !place.same(*a, *b) => vec![*a, *b],
            _ => Vec::new(),
        },
        ExprKind::BuiltinCall(B::Reflect | B::Refract, sides) => sides.get(1).into_iter().copied().collect(),
        _ => Vec::new(),
    }
}
