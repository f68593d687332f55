//! Other words for the same: expressions and statements that the language defines by others.
//!
//! *In:* an expression or a statement. *Out:* another with the same value: without parentheses that precedence makes needless, by another
//! operator, with the components of a swizzle under their other names, a macro written out. *Holds:* what has effects is evaluated as often
//! as before, and in the same order.

use super::tree::{Expr, Role, Stmt, StmtPart, Use};
use super::types::{BOOL, Ty};
use super::writer::Macro;
use glisten_front::hir::Scalar;

/// How tightly an operator binds (GLSL 1.50 §5.1); `None` for what is no operator of two operands.
fn precedence(operator: &str) -> Option<u8> {
    Some(match operator {
        "*" | "/" | "%" => 10,
        "+" | "-" => 9,
        "<<" | ">>" => 8,
        "<" | ">" | "<=" | ">=" => 7,
        "==" | "!=" => 6,
        "&" => 5,
        "^" => 4,
        "|" => 3,
        "&&" => 2,
        "^^" => 1,
        "||" => 0,
        _ => return None,
    })
}

/// Leaves out parentheses around the operands of an expression.
pub(super) fn bare(expr: &mut Expr) {
    let own = expr.operator().and_then(precedence);
    let is_call = expr.operator().is_none()
        && expr.texts().first().is_some_and(|text| text.ends_with('(') && text.len() > 1)
        && expr.texts().iter().skip(1).all(|text| text == ", " || text == ")");
    for (index, operand) in expr.operands.iter_mut().enumerate() {
        let inner = operand.operator().and_then(precedence);
        let is_free = match (own, inner) {
            (Some(own), Some(inner)) => inner > own || inner == own && index == 0,
            (None, Some(_)) => is_call,
            _ => false,
        };
        if is_free && operand.usage == Use::Value {
            operand.bared();
        }
    }
}

/// Leaves out the parentheses around what a statement assigns.
pub(super) fn bare_statement(statement: &mut Stmt) {
    if matches!(statement.role, Role::Assignment(_) | Role::Declaration)
        && let Some(StmtPart::Expr(value)) = statement.parts.last_mut()
        && value.operator().and_then(precedence).is_some()
    {
        value.bared();
    }
}

/// An expression by other operators.
pub(super) fn respelled(expr: &mut Expr) {
    if let [first, second] = expr.texts()
        && first.is_empty()
        && second.starts_with('.')
        && expr.usage != Use::Fixed
    {
        let letters = second.get(1..).unwrap_or_default().chars().map(|letter| match letter {
            'r' | 's' | 'x' => Some("x"),
            'g' | 't' | 'y' => Some("y"),
            'b' | 'p' | 'z' => Some("z"),
            'a' | 'q' | 'w' => Some("w"),
            _ => None,
        });
        let is_vector = expr.operands.iter().all(|operand| matches!(operand.ty, Ty::Vector(..)));
        if let Some(plain) = letters.collect::<Option<String>>().filter(|_| is_vector) {
            let pattern = format!("@.{plain}");
            *expr = Expr::new(expr.ty.clone(), &pattern, std::mem::take(&mut expr.operands));
            return;
        }
    }
    let Some(operator) = expr.operator().map(str::to_owned) else { return };
    let [left, right] = expr.operands.as_slice() else { return };
    let (is_pure, ty) = (!left.has_effects() && !right.has_effects(), expr.ty.clone());
    let is_truth = left.ty == BOOL && right.ty == BOOL;
    let same = |scalar: Scalar| left.ty.is_vector_of(scalar) && left.ty == right.ty;
    let pattern = match operator.as_str() {
        "&&" => "(@ ? @ : false)",
        "||" => "(@ ? true : @)",
        "^^" => "(@ != @)",
        "-" if same(Scalar::Float) => "(@ + (- @))",
        "<" | ">" | "<=" | ">=" | "+" | "==" | "!=" | "&" | "|" | "^" if is_pure && left.ty == right.ty => "",
        _ => return,
    };
    let operands = std::mem::take(&mut expr.operands);
    *expr = match pattern {
        "" => {
            let turned = match operator.as_str() {
                "<" => ">",
                ">" => "<",
                "<=" => ">=",
                ">=" => "<=",
                other => other,
            };
            Expr::new(ty, &format!("(@ {turned} @)"), operands.into_iter().rev().collect())
        }
        _ if pattern.contains("false") && !is_truth => Expr::new(ty, &format!("(@ {operator} @)"), operands),
        _ => Expr::new(ty, pattern, operands),
    };
}

/// A statement by others: `a += b` as `a = a + b`, `a++` as `a += 1`.
pub(super) fn respelled_statement(statement: Stmt) -> Stmt {
    let (texts, parts) = (statement.texts(), statement.parts.as_slice());
    if let ([_, operator, _], [StmtPart::Expr(place), StmtPart::Expr(value)]) = (texts, parts)
        && let Some(operator) =
            operator.trim().strip_suffix('=').filter(|operator| precedence(operator).is_some() && !value.has_effects())
    {
        let parts = vec![place.clone(), place.clone(), value.clone()];
        return Stmt::new(&format!("@ = @ {operator} (@);"), parts, Vec::new());
    }
    if let ([first, last], [StmtPart::Expr(place)]) = (texts, parts) {
        let operator = match (first.as_str(), last.as_str()) {
            ("++", ";") | ("", "++;") => "+=",
            ("--", ";") | ("", "--;") => "-=",
            _ => return statement,
        };
        let one = match place.ty.scalar() {
            Some(Scalar::Float) => "1.0",
            Some(Scalar::Uint) => "1u",
            _ => "1",
        };
        return Stmt::new(&format!("@ {operator} {one};"), vec![place.clone()], Vec::new());
    }
    statement
}

/// A macro written out, if its arguments have no effects.
pub(super) fn expanded(expr: &mut Expr, macros: &[Macro]) {
    let head = expr.texts().first().cloned().unwrap_or_default();
    let Some(one) = macros.iter().find(|one| head == format!("{}(", one.name)) else { return };
    let operands: Option<Vec<Expr>> = one.order.iter().map(|index| expr.operands.get(*index).cloned()).collect();
    if let Some(operands) = operands {
        *expr = Expr::new(expr.ty.clone(), one.pattern, operands);
    }
}

/// The branch of a condition that is taken, as a block.
pub(super) fn taken(statement: Stmt) -> Stmt {
    let Role::Conditional(is_first) = statement.role else { return statement };
    let mut bodies = statement.parts.into_iter().filter_map(|part| match part {
        StmtPart::Body(body) => Some(body),
        StmtPart::Expr(_) => None,
    });
    let (first, second) = (bodies.next().unwrap_or_default(), bodies.next().unwrap_or_default());
    Stmt::new("{$}", Vec::new(), vec![if is_first { first } else { second }])
}
