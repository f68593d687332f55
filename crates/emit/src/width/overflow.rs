//! Constant expressions that the other width cannot hold: `float(65535u)` in f16.
//!
//! *In:* a module in its new width. *Out:* a refusal, if the value of a constant expression is not finite. *Holds:* WGSL rejects such an
//! expression, however it is spelled, and the other targets would draw with an infinity; a literal is refused for the same reason.
//! *Not done here:* a small module for the web (without the feature `native`) lacks naga's evaluator, and leaves such an expression to
//! whoever takes the text.

use super::Refusal;
use naga::proc::{ConstantEvaluator, ConstantEvaluatorError, ExpressionKindTracker, Layouter};
use naga::{Arena, Expression, Function, Handle, Literal, Module, ScalarKind, Span};
use rustc_hash::FxHashMap;

/// The largest f16.
const LARGEST: f64 = 65504.0;

/// Constant expressions of a function, by their values in the module.
type Values = FxHashMap<Handle<Expression>, Handle<Expression>>;

/// Refuses a module in f16 in which a constant expression is not finite.
///
/// # Errors
/// There is such an expression.
pub(super) fn refuse(module: &Module) -> Result<(), Refusal> {
    let mut scratch = module.clone();
    let functions = module.functions.iter().map(|(_, function)| function);
    for function in functions.chain(module.entry_points.iter().map(|entry| &entry.function)) {
        refuse_in(function, &mut scratch)?;
    }
    Ok(())
}

fn refuse_in(function: &Function, scratch: &mut Module) -> Result<(), Refusal> {
    let mut kinds = ExpressionKindTracker::from_arena(&scratch.global_expressions);
    let (mut layouter, mut values) = (Layouter::default(), Values::default());
    for (handle, expression) in function.expressions.iter() {
        let Some(constant) = of_constants(expression, &values) else { continue };
        let beyond = converted(&constant, &scratch.global_expressions);
        let mut evaluator = ConstantEvaluator::for_wgsl_module(scratch, &mut kinds, &mut layouter, false);
        let value = evaluator.try_eval_and_append(constant.clone(), Span::UNDEFINED);
        match value {
            _ if beyond.is_some() => return Err(told(beyond)),
            Ok(value) if is_finite(value, &scratch.global_expressions) => {
                values.insert(handle, value);
            }
            Ok(_) => return Err(told(None)),
            // Integers are not of this width: what overflows among them does so in f32, too.
            Err(ConstantEvaluatorError::Overflow(_) | ConstantEvaluatorError::Literal(_))
                if has_half(&constant, &scratch.global_expressions) =>
            {
                return Err(told(None));
            }
            // What naga does not evaluate is computed by the target.
            Err(_) => {}
        }
    }
    Ok(())
}

fn told(value: Option<f64>) -> Refusal {
    match value {
        Some(value) => format!("{value} is beyond the range of an f16"),
        None => "the value of a constant expression is beyond the range of an f16".to_owned(),
    }
}

/// The expression with constants in the places of its operands; none if there is an operand that is no constant.
fn of_constants(expression: &Expression, values: &Values) -> Option<Expression> {
    use Expression as E;
    let of = |operand: Handle<Expression>| values.get(&operand).copied();
    let maybe = |operand: Option<Handle<Expression>>| match operand {
        Some(operand) => of(operand).map(Some),
        None => Some(None),
    };
    Some(match *expression {
        E::Literal(_) | E::Constant(_) | E::ZeroValue(_) => expression.clone(),
        E::Compose { ty, ref components } => {
            E::Compose { ty, components: components.iter().map(|one| of(*one)).collect::<Option<_>>()? }
        }
        E::Splat { size, value } => E::Splat { size, value: of(value)? },
        E::Swizzle { size, vector, pattern } => E::Swizzle { size, vector: of(vector)?, pattern },
        E::AccessIndex { base, index } => E::AccessIndex { base: of(base)?, index },
        E::Unary { op, expr } => E::Unary { op, expr: of(expr)? },
        E::Binary { op, left, right } => E::Binary { op, left: of(left)?, right: of(right)? },
        E::Select { condition, accept, reject } => {
            E::Select { condition: of(condition)?, accept: of(accept)?, reject: of(reject)? }
        }
        E::Relational { fun, argument } => E::Relational { fun, argument: of(argument)? },
        E::Math { fun, arg, arg1, arg2, arg3 } => {
            E::Math { fun, arg: of(arg)?, arg1: maybe(arg1)?, arg2: maybe(arg2)?, arg3: maybe(arg3)? }
        }
        E::As { expr, kind, convert } => E::As { expr: of(expr)?, kind, convert },
        _ => return None,
    })
}

/// The integer that a conversion to f16 cannot hold. Of those that would be rounded to the largest number, too, WGSL takes none.
fn converted(expression: &Expression, values: &Arena<Expression>) -> Option<f64> {
    let Expression::As { expr, kind: ScalarKind::Float, convert: Some(2) } = *expression else { return None };
    let mut found = None;
    literals(expr, values, &mut |literal| {
        let value = match literal {
            Literal::I32(value) => f64::from(value),
            Literal::U32(value) => f64::from(value),
            _ => 0.0,
        };
        if value.abs() > LARGEST {
            found = Some(value);
        }
    });
    found
}

fn is_finite(value: Handle<Expression>, values: &Arena<Expression>) -> bool {
    let mut finite = true;
    literals(value, values, &mut |literal| {
        if let Literal::F16(value) = literal {
            finite &= value.is_finite();
        }
    });
    finite
}

/// Whether an operand has floats of this width.
fn has_half(expression: &Expression, values: &Arena<Expression>) -> bool {
    let mut found = false;
    let mut look = |operand: Handle<Expression>| {
        literals(operand, values, &mut |literal| found |= matches!(literal, Literal::F16(_)));
    };
    match *expression {
        Expression::Unary { expr, .. } => look(expr),
        Expression::Binary { left, right, .. } => [left, right].into_iter().for_each(look),
        Expression::Math { arg, arg1, .. } => [Some(arg), arg1].into_iter().flatten().for_each(look),
        _ => {}
    }
    found
}

/// Calls `f` with the numbers that a value is made of.
fn literals(value: Handle<Expression>, values: &Arena<Expression>, f: &mut dyn FnMut(Literal)) {
    match &values[value] {
        Expression::Literal(literal) => f(*literal),
        Expression::Splat { value, .. } => literals(*value, values, f),
        Expression::Compose { components, .. } => components.iter().for_each(|one| literals(*one, values, f)),
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use crate::{Conventions, FloatWidth, Target, emit};
    use glisten_front::{Compiler, Options, Source, Stage};

    /// The message of the refusal in f16, if there is one.
    fn refusal(target: Target, value: &str) -> Option<String> {
        let text = format!(
            "#version 330\nuniform uint u;\nout vec4 color;\nconst uint g = -1u;\nconst float h = 1000.0;\n\
             void main() {{ uint v = g; color = vec4({value}); }}\n"
        );
        let source = Source { name: "a.frag".to_owned(), text: text.into(), stage: Stage::Fragment };
        let program = Compiler::new(Options::default()).compile(&[source]).program.expect("it compiles");
        let conventions = Conventions { floats: FloatWidth::Half, ..Conventions::default() };
        let errors = emit(&program, Stage::Fragment, target, &conventions).err()?;
        assert!(errors.iter().all(|one| one.code.id == "E0802"), "{errors:?}");
        errors.first().map(|one| one.message.clone())
    }

    fn is_beyond(told: Option<&String>) -> bool {
        told.is_some_and(|told| told.contains("beyond the range of an f16"))
    }

    #[test]
    fn constant_expressions_that_overflow_are_refused() {
        for target in [Target::Wgsl, Target::Spirv] {
            for value in ["float(g & 65535u)", "70000.0", "h * 100.0", "vec2(h, 2.0).x * 66.0"] {
                let told = refusal(target, value);
                assert!(is_beyond(told.as_ref()), "{value}: {told:?}");
            }
            for value in ["float(u & 65535u)", "float(g & 65503u)", "h * 60.0", "h / 0.5"] {
                assert_eq!(refusal(target, value), None, "{value}");
            }
        }
        // In WGSL, the name of a constant is in the place of the variable.
        assert!(is_beyond(refusal(Target::Wgsl, "float(v & 65535u) * 0.0625").as_ref()));
    }
}
