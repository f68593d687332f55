//! Rewritings that are mechanical: the same value in exact arithmetic, without the loss.
//!
//! *In:* an expression of a known form, and its text. *Out:* the text to put in its place. *Holds:* only text that is in a file
//! as it is gets rewritten, not what a macro expands to; operands with side effects are left alone, since some
//! rewritings repeat them.

use super::forms;
use super::patterns::{self, Found, Pattern};
use glisten_front::builtin::BuiltinFunction;
use glisten_front::hir::{BinaryOp, ExprId, ExprKind, ScalarValue, Shader, Type, Types, may_act};
use glisten_front::source::{SourceMap, Span};
use glisten_reference::stability::{Cause, CauseKind, ErrorMap, errors_against};
use glisten_scene::Scene;
use glisten_scene::picture::Picture;

/// Loads the scene again with another text for a file; `None` if it does not load.
pub type Reload<'a> = &'a dyn Fn(&str, &str) -> Option<Scene>;

/// A rewriting that was tried.
#[derive(Clone, Debug)]
pub(super) struct Tried {
    /// The text in place of the expression.
    pub(super) text: String,
    /// The errors of the picture with it, against the exact picture of the program as it is.
    pub(super) errors: ErrorMap,
    /// The largest difference that it makes to the exact picture.
    pub(super) change: f64,
}

/// Rewrites a cause, if that is mechanical, and measures the picture with it against the exact one.
pub(super) fn tried(
    (scene, exact): (&Scene, &Picture),
    sources: &SourceMap,
    cause: &Cause,
    reload: Reload<'_>,
) -> Option<Tried> {
    let (types, shader) = scene.draws.iter().find_map(|draw| {
        let shader = draw.program.stage(cause.stage)?;
        shader.expr_at(cause.span).map(|_| (&draw.program.types, shader))
    })?;
    let found = patterns::at(types, shader, cause.span)?;
    let (span, text) = match forms::around(shader, found.expr) {
        Some(form) => (shader.expr(form.whole).span, form.text(&|id| operand(shader, sources, id))?),
        None => (cause.span, rewriting(types, shader, sources, found, cause.kind)?),
    };
    let file = sources.file(sources.file_of(span)?);
    let range = place(sources, span)?;
    let whole = file.text();
    let changed = format!("{}{}{}", whole.get(..range.start)?, text, whole.get(range.end..)?);
    let reloaded = reload(file.name(), &changed)?;
    let mut rewritten = scene.clone();
    for (draw, other) in rewritten.draws.iter_mut().zip(&reloaded.draws) {
        // The interface is the same, and so are the places of all values.
        draw.program = std::sync::Arc::clone(&other.program);
    }
    let against = errors_against(&rewritten, exact).ok()?;
    Some(Tried { text, errors: against.errors, change: against.exact.largest() })
}

/// The bytes of a span in its file; `None` for what a macro expands to.
fn place(sources: &SourceMap, span: Span) -> Option<std::ops::Range<usize>> {
    let file = sources.file(sources.file_of(span)?);
    let (start, end) = (span.start.checked_sub(file.base())? as usize, span.end.checked_sub(file.base())? as usize);
    let is_plain = sources.call_site(span) == span && end <= file.text().len();
    is_plain.then_some(start..end)
}

/// The text that takes the place of an expression.
fn rewriting(types: &Types, shader: &Shader, sources: &SourceMap, found: Found, cause: CauseKind) -> Option<String> {
    let text = |id: ExprId| operand(shader, sources, id);
    let kind = &shader.expr(found.expr).kind;
    match (found.pattern, kind) {
        (Pattern::OneMinusSquare, ExprKind::Binary(BinaryOp::Sub, _, square)) => {
            let x = text(squared(shader, *square)?)?;
            Some(format!("((1.0 - {x}) * (1.0 + {x}))"))
        }
        (Pattern::SquareMinusOne, ExprKind::Binary(BinaryOp::Sub, square, _)) => {
            let x = text(squared(shader, *square)?)?;
            Some(format!("(({x} - 1.0) * ({x} + 1.0))"))
        }
        (Pattern::OneMinusCos, ExprKind::Binary(BinaryOp::Sub, _, cosine)) => {
            let x = text(only_argument(shader, *cosine)?)?;
            Some(format!("(2.0 * sin(0.5 * {x}) * sin(0.5 * {x}))"))
        }
        (Pattern::DifferenceOfSquares, ExprKind::Binary(BinaryOp::Sub, a, b)) => {
            let (x, y) = (text(squared(shader, *a)?)?, text(squared(shader, *b)?)?);
            Some(format!("(({x} - {y}) * ({x} + {y}))"))
        }
        (Pattern::DifferenceOfDots, ExprKind::Binary(BinaryOp::Sub, a, b)) => {
            let (x, y) = (text(squared(shader, *a)?)?, text(squared(shader, *b)?)?);
            Some(format!("dot({x} - {y}, {x} + {y})"))
        }
        (Pattern::DifferenceOfRoots, ExprKind::Binary(BinaryOp::Sub, a, b)) => {
            let (x, y) = (text(only_argument(shader, *a)?)?, text(only_argument(shader, *b)?)?);
            Some(format!("(({x} - {y}) / (sqrt({x}) + sqrt({y})))"))
        }
        // A limit of the argument gives no digits back that have left the range before.
        (_, ExprKind::BuiltinCall(function, _))
            if cause == CauseKind::Underflow && *function != BuiltinFunction::Normalize =>
        {
            None
        }
        (_, ExprKind::BuiltinCall(function, arguments)) => call(types, shader, *function, arguments, &text),
        _ => None,
    }
}

/// The text in place of a call.
fn call(
    types: &Types,
    shader: &Shader,
    function: BuiltinFunction,
    arguments: &[ExprId],
    text: &dyn Fn(ExprId) -> Option<String>,
) -> Option<String> {
    let first = arguments.first()?;
    let x = text(*first)?;
    // It is limited already.
    let limits = matches!(
        shader.expr(*first).kind,
        ExprKind::BuiltinCall(BuiltinFunction::Max | BuiltinFunction::Min | BuiltinFunction::Clamp, _)
    );
    if limits && function != BuiltinFunction::Normalize {
        return None;
    }
    let ty = types.get(shader.expr(*first).ty);
    Some(match (function, ty) {
        (BuiltinFunction::Normalize, Type::Vector(_, 3)) => {
            format!("normalize({x} / max(max(abs({x}).x, abs({x}).y), abs({x}).z))")
        }
        (BuiltinFunction::Normalize, Type::Vector(_, 2)) => format!("normalize({x} / max(abs({x}).x, abs({x}).y))"),
        (BuiltinFunction::Acos | BuiltinFunction::Asin, _) => {
            let name = if function == BuiltinFunction::Acos { "acos" } else { "asin" };
            format!("{name}(clamp({x}, -1.0, 1.0))")
        }
        (BuiltinFunction::Sqrt, _) => format!("sqrt(max({x}, 0.0))"),
        (BuiltinFunction::Pow, Type::Scalar(_)) => {
            let exponent = *arguments.get(1)?;
            match whole(shader, exponent) {
                Some(count) => format!("({})", vec![x.as_str(); count].join(" * ")),
                None => format!("pow(max({x}, 0.0), {})", text(exponent)?),
            }
        }
        (BuiltinFunction::Exp, Type::Scalar(_)) => format!("exp(min({x}, 80.0))"),
        _ => return None,
    })
}

/// A constant exponent that products do for.
fn whole(shader: &Shader, exponent: ExprId) -> Option<usize> {
    let ExprKind::Literal(ScalarValue::Float(value)) = shader.expr(exponent).kind else { return None };
    [2.0, 3.0, 4.0].contains(&value).then_some(value as usize)
}

/// The text of an operand, in parentheses unless it is a name or a call; `None` if it has side effects or is no plain text.
fn operand(shader: &Shader, sources: &SourceMap, id: ExprId) -> Option<String> {
    let mut has_effects = false;
    shader.visit_expr(id, &mut |inner| {
        let kind = &shader.expr(inner).kind;
        has_effects |= may_act(kind) || matches!(kind, ExprKind::Comma(..));
    });
    let span = shader.expr(id).span;
    place(sources, span)?;
    let text = sources.snippet(span);
    let is_simple = text.chars().all(|character| character.is_alphanumeric() || "_.".contains(character));
    let text = if is_simple { text.to_owned() } else { format!("({text})") };
    (!has_effects && !text.is_empty() && !text.contains("//")).then_some(text)
}

/// The operand of a square: see [`patterns`].
fn squared(shader: &Shader, id: ExprId) -> Option<ExprId> {
    match &shader.expr(id).kind {
        ExprKind::Binary(BinaryOp::Mul, a, _) => Some(*a),
        ExprKind::BuiltinCall(BuiltinFunction::Pow | BuiltinFunction::Dot, list) => list.first().copied(),
        ExprKind::Convert(inner) => squared(shader, *inner),
        _ => None,
    }
}

fn only_argument(shader: &Shader, id: ExprId) -> Option<ExprId> {
    match &shader.expr(id).kind {
        ExprKind::BuiltinCall(_, list) => list.first().copied(),
        _ => None,
    }
}
