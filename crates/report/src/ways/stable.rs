//! Stable forms of expressions that cancel, for programs that have the plain ones.
//!
//! *In:* a scene and one of its draws. *Out:* the scene with `1 - x * x` as `(1 - x) (1 + x)`, `1 - cos(x)` as twice a squared
//! sine, `x * x - y * y` as a product, a difference of roots as a quotient, and a power of a cosine of two unit vectors by
//! their distance, as the library computes it. *Holds:* the same in exact arithmetic.

use super::edit::{Edited, Open, call, with_draw};
use super::names::Names;
use super::same::Located;
use glisten_front::builtin::BuiltinFunction;
use glisten_front::hir::{
    BinaryOp, ExprId, ExprKind, FunctionId, ScalarValue, Shader, Stage, TypeId, Types, UnaryOp, VarRef, same_form,
};
use glisten_scene::Scene;

/// A local may stand for another one, and so on, but no longer than this.
const LONGEST: usize = 16;

/// An unstable form, with its operands.
enum Form {
    OneMinusSquare(ExprId),
    OneMinusCos(ExprId),
    Squares(ExprId, ExprId),
    Roots(ExprId, ExprId),
    /// A root less a positive number.
    RootMinus(ExprId, ExprId),
    /// A positive number less a root.
    MinusRoot(ExprId, ExprId),
    Cosine(ExprId, ExprId, ExprId),
}

/// `max(dot(a, b), 0)^k` of unit vectors, from half their squared distance where that keeps digits: the logarithm by its
/// series, as `safeLogOneMinus` of the library does.
const COSINE_POWER: &str = "float l = dot(a, b);
    if (!(l > 0.0)) return 0.0;
    vec3 d = a - b;
    float h = 0.5 * dot(d, d);
    float s = h / (2.0 - h);
    float q = s * s;
    float sum = 1.0 + q * (1.0 / 3.0 + q * (1.0 / 5.0 + q * (1.0 / 7.0 + q * (1.0 / 9.0 + q * (1.0 / 11.0 + q / 13.0)))));
    return exp(c * (h < 0.125 ? -2.0 * s * sum : log(min(l, 1.0))));";

/// The scene with stable forms, and how many there are.
pub(super) fn stable(scene: &Scene, index: usize) -> Option<(Scene, usize)> {
    let draw = scene.draws.get(index)?;
    let mut edited = Edited::of(draw)?;
    let types = edited.types.clone();
    let mut count = 0;
    for stage in [Stage::Vertex, Stage::Fragment] {
        let open = if stage == Stage::Vertex { &mut edited.vertex } else { &mut edited.fragment };
        for (id, form) in forms(&open.shader) {
            rewrite(&types, open, id, &form);
            count += 1;
        }
    }
    (count > 0).then_some(())?;
    Some((with_draw(scene, index, edited.draw(draw)?)?, count))
}

fn forms(shader: &Shader) -> Vec<(ExprId, Form)> {
    let names = Names::of(shader);
    let mut found = Vec::new();
    for function in shader.main.map(|main| shader.callees_first(main)).unwrap_or_default() {
        shader.visit_body(shader.function(function).body.as_deref().unwrap_or(&[]), &mut |id| {
            if shader.expr(id).ty != TypeId::FLOAT {
                return;
            }
            let form = match &shader.expr(id).kind {
                ExprKind::Binary(BinaryOp::Sub, a, b) => difference(shader, *a, *b),
                ExprKind::BuiltinCall(BuiltinFunction::Pow, list) => match list.as_slice() {
                    [base, exponent] => {
                        cosine(shader, &names, function, *base).map(|(a, b)| Form::Cosine(a, b, *exponent))
                    }
                    _ => None,
                },
                _ => None,
            };
            found.extend(form.map(|form| (id, form)));
        });
    }
    found
}

fn difference(shader: &Shader, a: ExprId, b: ExprId) -> Option<Form> {
    let one = matches!(shader.expr(a).kind, ExprKind::Literal(ScalarValue::Float(1.0)));
    let argument = |id: ExprId, wanted: BuiltinFunction| match &shader.expr(id).kind {
        ExprKind::BuiltinCall(function, list) if *function == wanted => list.first().copied(),
        _ => None,
    };
    if one {
        let square = square(shader, b).map(Form::OneMinusSquare);
        return square.or_else(|| argument(b, BuiltinFunction::Cos).map(Form::OneMinusCos));
    }
    if let (Some(x), Some(y)) = (square(shader, a), square(shader, b)) {
        return Some(Form::Squares(x, y));
    }
    let root = |id| argument(id, BuiltinFunction::Sqrt);
    // A known root is a number.
    let number = |id: ExprId| match shader.expr(id).kind {
        ExprKind::Literal(ScalarValue::Float(number)) => (number > 0.0 && (number * number).is_finite()).then_some(id),
        _ => None,
    };
    match (root(a), root(b)) {
        (Some(x), Some(y)) => Some(Form::Roots(x, y)),
        (Some(x), None) => Some(Form::RootMinus(x, number(b)?)),
        (None, Some(y)) => Some(Form::MinusRoot(number(a)?, y)),
        (None, None) => None,
    }
}

/// The operand of `x * x`, if it has no effects.
fn square(shader: &Shader, id: ExprId) -> Option<ExprId> {
    let ExprKind::Binary(BinaryOp::Mul, a, b) = shader.expr(id).kind else { return None };
    let mut plain = true;
    shader.visit_expr(a, &mut |part| {
        let kind = &shader.expr(part).kind;
        plain &=
            !matches!(kind, ExprKind::Call(..) | ExprKind::Assign(..) | ExprKind::IncDec(..) | ExprKind::Comma(..));
    });
    (plain && same_form(shader, a, b)).then_some(a)
}

/// The unit vectors of `max(dot(a, b), 0.0)` or `clamp(dot(a, b), 0.0, 1.0)`, or of `dot(a, b)` itself, whose power is undefined where it
/// is negative.
fn cosine(shader: &Shader, names: &Names, function: FunctionId, base: ExprId) -> Option<(ExprId, ExprId)> {
    let (at, limited) = meant(shader, names, (function, base));
    let ExprKind::BuiltinCall(limit, list) = &shader.expr(limited).kind else { return None };
    let is_zero = |id: &ExprId| matches!(shader.expr(*id).kind, ExprKind::Literal(ScalarValue::Float(0.0)));
    let product = match (limit, list.as_slice()) {
        (BuiltinFunction::Max, [a, b]) if is_zero(b) => *a,
        (BuiltinFunction::Max, [a, b]) if is_zero(a) => *b,
        (BuiltinFunction::Clamp, [x, low, _]) if is_zero(low) => *x,
        (BuiltinFunction::Dot, _) => limited,
        _ => return None,
    };
    let (within, product) = meant(shader, names, (at, product));
    let ExprKind::BuiltinCall(BuiltinFunction::Dot, list) = &shader.expr(product).kind else { return None };
    let [a, b] = list.as_slice() else { return None };
    let here = within == function && [*a, *b].iter().all(|id| names.is_steady(shader, function, *id));
    let units = [*a, *b].iter().all(|id| is_unit(shader, names, (function, *id), LONGEST));
    let vectors = [*a, *b].iter().all(|id| shader.expr(*id).ty == TypeId::VEC3);
    (here && units && vectors).then_some((*a, *b))
}

/// The expression that a local stands for.
fn meant(shader: &Shader, names: &Names, located: Located) -> Located {
    let mut located = located;
    for _ in 0..LONGEST {
        let (function, id) = located;
        let ExprKind::Var(VarRef::Local(local)) = shader.expr(id).kind else { break };
        let Some(next) = names.get(function, local) else { break };
        located = next;
    }
    located
}

/// Whether an expression is a vector of length 1 by its form.
fn is_unit(shader: &Shader, names: &Names, located: Located, depth: usize) -> bool {
    let Some(depth) = depth.checked_sub(1) else { return false };
    let (function, id) = meant(shader, names, located);
    let unit = |id: &ExprId| is_unit(shader, names, (function, *id), depth);
    match &shader.expr(id).kind {
        ExprKind::BuiltinCall(BuiltinFunction::Normalize, _) => true,
        ExprKind::BuiltinCall(BuiltinFunction::Reflect, list) => list.iter().all(unit),
        ExprKind::Unary(UnaryOp::Negate, inner) => unit(inner),
        // A known unit vector is three numbers.
        ExprKind::Construct(_, list) => {
            let square = |id: &ExprId| number(shader, *id).map(|number| number * number);
            let length: Option<f64> = list.iter().map(square).sum();
            list.len() == 3 && length.is_some_and(|length| (length - 1.0).abs() <= ROUNDED_UNIT)
        }
        _ => false,
    }
}

/// How far the squared length of a unit vector may be from 1 by the rounding of its components to f32.
const ROUNDED_UNIT: f64 = 1e-6;

/// The number that an expression is, with its sign.
fn number(shader: &Shader, id: ExprId) -> Option<f64> {
    match &shader.expr(id).kind {
        ExprKind::Literal(ScalarValue::Float(number)) => Some(f64::from(*number)),
        ExprKind::Unary(UnaryOp::Negate, inner) => number(shader, *inner).map(|number| -number),
        _ => None,
    }
}

fn rewrite(types: &Types, open: &mut Open, id: ExprId, form: &Form) {
    const FLOAT: TypeId = TypeId::FLOAT;
    let (wanted, params, body, arguments): (&str, &[TypeId], &str, Vec<ExprId>) = match *form {
        Form::OneMinusSquare(x) => ("one_minus_square", &[FLOAT], "return (1.0 - a) * (1.0 + a);", vec![x]),
        Form::OneMinusCos(x) => {
            ("one_minus_cos", &[FLOAT], "float s = sin(0.5 * a);\n    return 2.0 * s * s;", vec![x])
        }
        Form::Squares(x, y) => ("difference_of_squares", &[FLOAT, FLOAT], "return (a - b) * (a + b);", vec![x, y]),
        Form::Roots(x, y) => {
            let body = "return a == b ? 0.0 : (a - b) / (sqrt(a) + sqrt(b));";
            ("difference_of_roots", &[FLOAT, FLOAT], body, vec![x, y])
        }
        Form::RootMinus(x, y) => {
            let body = "return (a - b * b) / (sqrt(a) + b);";
            ("root_minus_number", &[FLOAT, FLOAT], body, vec![x, y])
        }
        Form::MinusRoot(x, y) => {
            let body = "return (a * a - b) / (a + sqrt(b));";
            ("number_minus_root", &[FLOAT, FLOAT], body, vec![x, y])
        }
        Form::Cosine(a, b, k) => ("cosine_power", &[TypeId::VEC3, TypeId::VEC3, FLOAT], COSINE_POWER, vec![a, b, k]),
    };
    call(types, open, id, (wanted, params, body), arguments);
}
