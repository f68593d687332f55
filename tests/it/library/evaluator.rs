//! [`Evaluator`]: the types that a function may take and return, and the errors for others.

use super::call;
use crate::support::compiler;
use glisten::evaluate::Evaluator;
use glisten_reference::Precision;
use glisten_verify::evaluate::signatures;

fn evaluator(text: &str, signature: &str) -> Evaluator {
    Evaluator::new(&compiler(), text, signature, &[]).unwrap_or_else(|error| panic!("{error}"))
}

#[track_caller]
fn refused(text: &str, signature: &str, word: &str) {
    let error = Evaluator::new(&compiler(), text, signature, &[]).expect_err("it cannot be called");
    assert!(error.to_string().contains(word), "{error}");
}

#[test]
fn parameters_of_all_shapes_are_filled_in_order() {
    let text = "struct Inner { vec2 a; bool b; };\nstruct Outer { int i; Inner inner[2]; uint u; };\n\
        float f(Outer o, mat2x3 m) {\n\
        return float(o.i) + o.inner[1].a.y + (o.inner[0].b ? 100.0 : 0.0) + float(o.u) + m[1].z; }";
    let f = evaluator(text, "f(Outer,mat2x3)");
    assert_eq!((f.inputs(), f.results()), (1 + 2 * 3 + 1 + 6, 1));
    let row = [-3.0, 0.0, 0.0, 1.0, 0.0, 0.25, 0.0, 7.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.5];
    assert_eq!(call(&f, &row), [[-3.0 + 0.25 + 100.0 + 7.0 + 0.5]]);
}

#[test]
fn results_of_all_shapes_come_back_in_order() {
    let matrix = evaluator("mat3 f(vec3 v) { return mat3(v, 2.0 * v, 3.0 * v); }", "f(vec3)");
    // More than one line of the picture.
    let rows: Vec<f32> = (0..130u16).flat_map(|i| [f32::from(i), 1.0, -1.0]).collect();
    let results = call(&matrix, &rows);
    assert_eq!(results.len(), 130);
    for (i, result) in (0..130u16).zip(results) {
        let v = [f64::from(i), 1.0, -1.0];
        let expected: Vec<f64> = [1.0, 2.0, 3.0].iter().flat_map(|s| v.map(|x| s * x)).collect();
        assert_eq!(result, expected);
    }
    assert_eq!(call(&evaluator("bool f(float x) { return x > 0.5; }", "f(float)"), &[0.0, 1.0]), [[0.0], [1.0]]);
    assert_eq!(call(&evaluator("ivec2 f() { return ivec2(-1, 2); }", "f()"), &[]), [[-1.0, 2.0]]);
}

#[test]
fn overloads_are_told_apart_and_listed() {
    let text = "float f(float x) { return x; }\nfloat f(vec2 x) { return x.y; }\nvoid g() { }";
    assert_eq!(signatures(&compiler(), text).expect("it compiles"), ["f(float)", "f(vec2)", "g()"]);
    assert_eq!(call(&evaluator(text, "f(vec2)"), &[1.0, 2.0]), [[2.0]]);
}

#[test]
fn what_cannot_be_called_is_told() {
    refused("float f(float x) { return x; }", "f(flaot)", "did you mean `f(float)`?");
    refused("float f(float x) { return y; }", "f(float)", "`y`");
    refused("float f(out float x) { x = 1.0; return x; }", "f(float)", "parameter `x`");
    refused("float f(samplerCube s) { return texture(s, vec3(1.0)).r; }", "f(samplerCube)", "samplerCube");
    refused("struct S { float x; }; S f(float x) { return S(x); }", "f(float)", "returns `S`");
    let f = evaluator("float f(vec2 x) { return x.y; }", "f(vec2)");
    for numbers in [&[][..], &[1.0], &[1.0, 2.0, 3.0]] {
        assert!(f.reference(numbers, &[], Precision::F64).is_err(), "{numbers:?}");
    }
    let table = evaluator("float f(sampler2D s, float x) { return texture(s, vec2(x)).r; }", "f(sampler2D,float)");
    assert!(table.reference(&[1.0], &[], Precision::F64).is_err());
}
