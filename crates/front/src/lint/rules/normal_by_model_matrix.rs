//! `normal-by-model-matrix`: a normal that is transformed by the 3x3 part of a matrix that is none for normals, which is right only
//! without a scale that differs by direction.

use super::super::{Findings, Place, Subject};
use crate::hir::{BinaryOp, ConstructKind, ExprId, ExprKind, ScalarValue, Stage, Storage, Type, VarRef};

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    for (place, expr) in subject.exprs().filter(|(place, _)| place.shader.stage == Stage::Vertex) {
        let ExprKind::Binary(BinaryOp::MatMul, matrix, vector) = place.kind(expr) else { continue };
        let Some(matrix) = model_matrix(subject, place, *matrix, *vector) else { continue };
        if is_normal(place, *vector) {
            let message =
                format!("`{matrix}` transforms a normal, which is wrong where it scales directions differently");
            let finding = findings.at(place.expr(expr).span, message);
            findings.push(finding.help("transform normals by the transposed inverse, which the host computes once"));
        }
    }
}

/// The name of the uniform whose directions are transformed: `mat3(model) * v`, `model * vec4(v, 0.0)`.
fn model_matrix(subject: &Subject<'_>, place: &Place<'_>, matrix: ExprId, vector: ExprId) -> Option<String> {
    let inner = match place.kind(place.meaning(matrix)) {
        ExprKind::Construct(ConstructKind::Resize, parts) if matches!(place.ty(matrix), Type::Matrix(3, 3)) => {
            *parts.first()?
        }
        ExprKind::Var(_) | ExprKind::Member(..)
            if matches!(place.ty(matrix), Type::Matrix(4, 4)) && is_direction(place, vector) =>
        {
            matrix
        }
        _ => return None,
    };
    let name = uniform_name(subject, place, place.meaning(inner))?;
    let lower = name.to_ascii_lowercase();
    let is_model = lower.contains("model") || lower.contains("world");
    (is_model && !["normal", "inv", "transpose", "rot"].iter().any(|word| lower.contains(word))).then_some(name)
}

/// The name of a uniform, or of a member of a uniform block.
fn uniform_name(subject: &Subject<'_>, place: &Place<'_>, id: ExprId) -> Option<String> {
    let (root, member) = match place.kind(id) {
        ExprKind::Member(block, member) => (place.kind(*block), Some(*member)),
        kind => (kind, None),
    };
    let ExprKind::Var(VarRef::Global(global)) = root else { return None };
    let global = place.shader.global(*global);
    if global.storage != Storage::Uniform {
        return None;
    }
    let Some(member) = member else { return Some(global.name.clone()) };
    let types = &subject.program.types;
    let Type::Struct(structure) = types.get(global.ty) else { return None };
    types.structure(structure).members.get(member as usize).map(|member| member.name.clone())
}

/// `vec4(v, 0.0)`
fn is_direction(place: &Place<'_>, vector: ExprId) -> bool {
    match place.kind(place.meaning(vector)) {
        ExprKind::Construct(ConstructKind::Compose, parts) => match parts.as_slice() {
            [_, last] => matches!(place.kind(*last), ExprKind::Literal(ScalarValue::Float(number)) if *number == 0.0),
            _ => false,
        },
        _ => false,
    }
}

/// Whether a vector is made of an attribute with the name of a normal.
fn is_normal(place: &Place<'_>, vector: ExprId) -> bool {
    let mut found = false;
    place.shader.visit_expr(place.meaning(vector), &mut |expr| {
        if let ExprKind::Var(VarRef::Global(global)) = place.kind(expr) {
            let global = place.shader.global(*global);
            found |= global.storage == Storage::In && global.name.to_ascii_lowercase().contains("normal");
        }
    });
    found
}
