//! Expressions by their components: constructors, comparisons and matrices written out, and numbers in other digits.
//!
//! *In:* an expression. *Out:* another with the same bits. *Holds:* an operand that is written twice has no effects and is short. *Not done
//! here:* sums of products, such as `dot`, whose order the language leaves open.

use super::tree::{Expr, Use};
use super::types::{FLOAT, Ty};
use glisten_front::hir::Scalar;

/// An operand that is written several times is at most so long.
const MOST_LETTERS: usize = 100;

const LETTERS: [&str; 4] = ["x", "y", "z", "w"];

/// Writes an expression out by its components, if it is one that can be.
pub(super) fn by_components(expr: &mut Expr) {
    let is_short = expr.operands.iter().all(|one| !one.has_effects() && one.text().len() <= MOST_LETTERS);
    let made = written_out(expr, is_short);
    if let Some((pattern, order)) = made {
        let operands: Option<Vec<Expr>> = order.iter().map(|index| expr.operands.get(*index).cloned()).collect();
        if let Some(operands) = operands {
            *expr = Expr::new(expr.ty.clone(), &pattern, operands);
        }
    }
}

/// A pattern, and which operands are in its places.
type Written = (String, Vec<usize>);

fn written_out(expr: &Expr, is_short: bool) -> Option<Written> {
    let types: Vec<&Ty> = expr.operands.iter().map(|one| &one.ty).collect();
    if let (Some(operator), [Ty::Vector(_, 2..), right]) = (expr.operator(), types.as_slice())
        && types.first() == Some(right)
    {
        return match operator {
            "==" => Some(("all(equal(@, @))".to_owned(), vec![0, 1])),
            "!=" => Some(("any(notEqual(@, @))".to_owned(), vec![0, 1])),
            _ => None,
        };
    }
    let name = called(expr)?;
    if !is_short {
        return None;
    }
    match (name, types.as_slice()) {
        (_, [operand]) if name == expr.ty.name() => constructor(&expr.ty, operand),
        ("any", [Ty::Vector(_, size)]) => Some(joined(*size, " || ")),
        ("all", [Ty::Vector(_, size)]) => Some(joined(*size, " && ")),
        ("not", [Ty::Vector(_, size)]) => {
            let parts: Vec<String> = letters(*size).map(|letter| format!("!(@).{letter}")).collect();
            Some((format!("bvec{size}({})", parts.join(", ")), vec![0; usize::from(*size)]))
        }
        ("outerProduct", [_, Ty::Vector(_, columns)]) => {
            let parts: Vec<String> = letters(*columns).map(|letter| format!("(@) * (@).{letter}")).collect();
            Some((format!("{}({})", expr.ty.name(), parts.join(", ")), [0, 1].repeat(usize::from(*columns))))
        }
        ("matrixCompMult", [Ty::Matrix(columns, _), _]) => {
            let parts: Vec<String> = (0..*columns).map(|column| format!("(@)[{column}] * (@)[{column}]")).collect();
            Some((format!("{}({})", expr.ty.name(), parts.join(", ")), [0, 1].repeat(usize::from(*columns))))
        }
        ("transpose", [Ty::Matrix(columns, rows)]) => {
            let mut parts = Vec::new();
            for letter in letters(*rows) {
                parts.extend((0..*columns).map(|column| format!("(@)[{column}].{letter}")));
            }
            Some((format!("{}({})", expr.ty.name(), parts.join(", ")), vec![0; parts.len()]))
        }
        (_, [Ty::Vector(_, size), _]) => {
            let operator = match name {
                "lessThan" => "<",
                "lessThanEqual" => "<=",
                "greaterThan" => ">",
                "greaterThanEqual" => ">=",
                "equal" => "==",
                "notEqual" => "!=",
                _ => return None,
            };
            let parts: Vec<String> =
                letters(*size).map(|letter| format!("(@).{letter} {operator} (@).{letter}")).collect();
            Some((format!("bvec{size}({})", parts.join(", ")), [0, 1].repeat(usize::from(*size))))
        }
        _ => None,
    }
}

fn letters(size: u8) -> impl Iterator<Item = &'static str> {
    LETTERS.into_iter().take(usize::from(size))
}

fn joined(size: u8, operator: &str) -> Written {
    let parts: Vec<String> = letters(size).map(|letter| format!("(@).{letter}")).collect();
    (format!("({})", parts.join(operator)), vec![0; usize::from(size)])
}

/// `vec2(x)` as `vec2(x, x)`, a matrix from a number or from another matrix by its elements (GLSL 1.50 §5.4.2).
fn constructor(ty: &Ty, operand: &Ty) -> Option<Written> {
    match (ty, operand) {
        (Ty::Vector(scalar, size @ 2..), Ty::Vector(other, 1)) if scalar == other => {
            let places = vec!["@"; usize::from(*size)].join(", ");
            Some((format!("{}({places})", ty.name()), vec![0; usize::from(*size)]))
        }
        (Ty::Matrix(columns, rows), _) => {
            let mut parts = Vec::new();
            for column in 0..*columns {
                for (row, letter) in (0..*rows).zip(LETTERS) {
                    let identity = if column == row { "1.0" } else { "0.0" };
                    parts.push(match operand {
                        Ty::Matrix(own_columns, own_rows) if column < *own_columns && row < *own_rows => {
                            format!("(@)[{column}].{letter}")
                        }
                        Ty::Matrix(..) => identity.to_owned(),
                        operand if *operand == FLOAT && column == row => "@".to_owned(),
                        operand if *operand == FLOAT => "0.0".to_owned(),
                        _ => return None,
                    });
                }
            }
            let pattern = format!("{}({})", ty.name(), parts.join(", "));
            let count = pattern.matches('@').count();
            Some((pattern, vec![0; count]))
        }
        _ => None,
    }
}

/// The function or the type that an expression calls.
fn called(expr: &Expr) -> Option<&str> {
    let (first, rest) = expr.texts().split_first()?;
    let (last, between) = rest.split_last()?;
    let is_call = last == ")" && between.iter().all(|text| text == ", ");
    first.strip_suffix('(').filter(|name| is_call && !name.is_empty())
}

/// A literal number in other digits: in another base, or with an exponent.
pub(super) fn in_other_digits(expr: &mut Expr) {
    if expr.usage != Use::Literal {
        return;
    }
    let text = expr.text();
    let (sign, digits) = match text.strip_prefix("(-").and_then(|rest| rest.strip_suffix(')')) {
        Some(rest) => ("-", rest),
        None => ("", text.as_str()),
    };
    let other = match expr.ty {
        Ty::Vector(Scalar::Float, 1) => digits.parse::<f32>().ok().map(|value| format!("{value:e}")),
        Ty::Vector(Scalar::Int | Scalar::Uint, 1) => whole(digits),
        _ => None,
    };
    let Some(other) = other else { return };
    let text = if sign.is_empty() { other } else { format!("(-{other})") };
    *expr = Expr::leaf(expr.ty.clone(), text).used(Use::Literal);
}

/// A whole number in another base, with its suffix.
fn whole(digits: &str) -> Option<String> {
    let plain = digits.trim_end_matches(['u', 'U']);
    let suffix = digits.get(plain.len()..).unwrap_or_default();
    if let Some(hex) = plain.strip_prefix("0x") {
        return u32::from_str_radix(hex, 16).ok().map(|value| format!("{value}{suffix}"));
    }
    if let Some(octal) = plain.strip_prefix('0').filter(|rest| !rest.is_empty()) {
        return u32::from_str_radix(octal, 8).ok().map(|value| format!("{value}{suffix}"));
    }
    let value: u32 = plain.parse().ok()?;
    Some(if value.is_multiple_of(2) { format!("0x{value:X}{suffix}") } else { format!("0{value:o}{suffix}") })
}

#[cfg(test)]
mod tests {
    use super::{by_components, in_other_digits};
    use crate::generate::tree::{Expr, Use};
    use crate::generate::types::{FLOAT, INT, Ty};
    use glisten_front::hir::Scalar;

    #[test]
    fn components_are_written_out() {
        let pair = Ty::Vector(Scalar::Float, 2);
        let mut expr = Expr::new(
            Ty::Vector(Scalar::Bool, 2),
            "lessThan(@, @)",
            vec![Expr::leaf(pair.clone(), "a"), Expr::leaf(pair, "b")],
        );
        by_components(&mut expr);
        assert_eq!(expr.text(), "bvec2((a).x < (b).x, (a).y < (b).y)");
        let mut matrix = Expr::new(Ty::Matrix(2, 2), "mat2(@)", vec![Expr::leaf(FLOAT, "s")]);
        by_components(&mut matrix);
        assert_eq!(matrix.text(), "mat2(s, 0.0, 0.0, s)");
    }

    #[test]
    fn numbers_have_other_digits() {
        for (text, ty, other) in
            [("017", INT, "15"), ("(-7)", INT, "(-07)"), ("100", INT, "0x64"), (".75", FLOAT, "7.5e-1")]
        {
            let mut expr = Expr::leaf(ty, text).used(Use::Literal);
            in_other_digits(&mut expr);
            assert_eq!(expr.text(), other);
        }
    }
}
