//! Functions of whole vectors: the executor's kernels give what the formulas of their rules give.

use super::text::{compiled, output, ran};
use crate::domain::rules::ulp;
use crate::domain::{Envelope, EnvelopeFloat, F64, LANES, Number, evaluate};
use glisten_front::builtin::BuiltinFunction;
use glisten_front::builtin::operations::{Class, Composite, Formula};
use glisten_front::hir::{Stage, TypeId};

/// A component of an argument in a lane: all of them are f32 numbers.
fn number(name: &str, lane: usize) -> f64 {
    let at = name.bytes().map(usize::from).sum::<usize>();
    ((lane * 5 + at * 3) % 23) as f64 / 8.0 - 1.25
}

/// A call with vectors of three, by its arguments' types.
fn call(function: BuiltinFunction) -> (Vec<TypeId>, TypeId, String) {
    let signatures = function.operation().prototypes().flat_map(|row| row.signatures(Stage::Fragment));
    let signature = signatures
        .filter(|signature| signature.params().first().is_some_and(|param| param.0 == TypeId::VEC3))
        .last()
        .expect("there is an overload for `vec3`");
    let types: Vec<TypeId> = signature.params().iter().map(|param| param.0).collect();
    let arguments = types.iter().zip(["a", "b", "c"]);
    let arguments: Vec<String> =
        arguments.map(|(ty, name)| if *ty == TypeId::FLOAT { format!("{name}.x") } else { name.to_owned() }).collect();
    (types, signature.ret, format!("{}({})", function.name(), arguments.join(", ")))
}

fn agree(function: BuiltinFunction, formula: &Formula) {
    let (types, ret, call) = call(function);
    let whole = if ret == TypeId::FLOAT { format!("vec4({call})") } else { format!("vec4({call}, 0.0)") };
    let program = compiled(&format!("in vec3 a, b, c; void main() {{ o = {whole}; }}"));
    let exact = output(&program, &ran::<F64>(&program, &[], number));
    let found = output(&program, &ran::<Envelope>(&program, &[], number));
    for lane in 0..LANES {
        let arguments: Vec<Vec<EnvelopeFloat>> = (types.iter().zip(["a", "b", "c"]))
            .map(|(ty, name)| {
                let count = if *ty == TypeId::FLOAT { 1 } else { 3 };
                (0..count).map(|flat| EnvelopeFloat::from_f64(number(name, lane) + f64::from(flat))).collect()
            })
            .collect();
        let numbers: Vec<Vec<f64>> =
            arguments.iter().map(|argument| argument.iter().map(|number| number.value).collect()).collect();
        let lists: Vec<&[EnvelopeFloat]> = arguments.iter().map(Vec::as_slice).collect();
        let values: Vec<&[f64]> = numbers.iter().map(Vec::as_slice).collect();
        for component in 0..if ret == TypeId::FLOAT { 1 } else { 3 } {
            let (fast, slow) = (found[lane][component], evaluate(formula, &lists, component));
            let value = evaluate(formula, &values, component);
            let given = exact[lane][component];
            let near = (given - value).abs() <= 1e-12 * value.abs().max(1.0) || given.is_nan() && value.is_nan();
            assert!(near, "`{call}`: {given} for {value}");
            let width = (slow.high - slow.low).max(fast.high - fast.low).max(ulp(value));
            let near = |a: f64, b: f64| a == b || (a - b).abs() <= width;
            assert!(near(fast.low, slow.low) && near(fast.high, slow.high), "`{call}`: {fast:?} for {slow:?}");
        }
    }
}

#[test]
fn functions_of_vectors_are_computed_by_the_formulas_of_their_rules() {
    let mut count = 0;
    for function in BuiltinFunction::ALL {
        let Class::Composite(op) = function.class() else { continue };
        match op.rule().formula() {
            Some(formula) => agree(*function, formula),
            None => assert!(matches!(op, Composite::Determinant | Composite::Inverse), "{}", op.name()),
        }
        count += 1;
    }
    assert_eq!(count, Composite::ALL.len());
}
