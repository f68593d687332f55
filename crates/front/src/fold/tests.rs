//! Unit tests of exact constant evaluation.

use super::*;
use crate::builtin::BuiltinFunction;
use crate::hir::{ArraySize, BinaryOp, ConstructKind, Stage, Swizzle, UnaryOp};
use crate::source::Span;
use crate::syntax::ast::{Profile, Version};
use ScalarValue::{Bool, Float, Int, Uint};

struct Builder {
    shader: Shader,
    types: Types,
}

impl Builder {
    fn new() -> Self {
        let version = Version { number: 150, profile: Profile::Core, span: Span::default() };
        Self { shader: Shader::new(Stage::Fragment, version), types: Types::new() }
    }

    fn add(&mut self, kind: ExprKind, ty: TypeId) -> ExprId {
        self.shader.push(kind, ty, Span::default())
    }

    fn literal(&mut self, value: ScalarValue) -> ExprId {
        self.add(ExprKind::Literal(value), TypeId::vector(value.scalar(), 1))
    }

    fn vector(&mut self, values: &[f32]) -> ExprId {
        let parts = values.iter().map(|&value| self.literal(Float(value))).collect();
        self.add(
            ExprKind::Construct(ConstructKind::Compose, parts),
            TypeId::vector(crate::hir::Scalar::Float, values.len() as u8),
        )
    }

    fn matrix(&mut self, size: u8, values: &[f32]) -> ExprId {
        let parts = values.iter().map(|&value| self.literal(Float(value))).collect();
        self.add(ExprKind::Construct(ConstructKind::Compose, parts), TypeId::matrix(size, size))
    }

    fn binary(&mut self, op: BinaryOp, left: ScalarValue, right: ScalarValue) -> Option<ScalarValue> {
        let (a, b) = (self.literal(left), self.literal(right));
        let expr = self.add(ExprKind::Binary(op, a, b), TypeId::vector(left.scalar(), 1));
        self.value(expr).and_then(|scalars| scalars.first().copied())
    }

    fn call(&mut self, function: BuiltinFunction, arguments: Vec<ExprId>, ty: TypeId) -> Option<Vec<ScalarValue>> {
        let expr = self.add(ExprKind::BuiltinCall(function, arguments), ty);
        self.value(expr)
    }

    fn value(&self, expr: ExprId) -> Option<Vec<ScalarValue>> {
        evaluate(&self.shader, &self.types, expr, &|_| None).map(|value| value.scalars)
    }
}

#[test]
fn integers_wrap_and_never_trap() {
    let mut builder = Builder::new();
    let mut check = |op, a, b, expected| assert_eq!(builder.binary(op, a, b), Some(expected), "{a:?} {op:?} {b:?}");
    check(BinaryOp::Add, Int(i32::MAX), Int(1), Int(i32::MIN));
    check(BinaryOp::Mul, Uint(u32::MAX), Uint(2), Uint(u32::MAX - 1));
    check(BinaryOp::Div, Int(7), Int(0), Int(-1));
    check(BinaryOp::Rem, Int(7), Int(0), Int(-1));
    check(BinaryOp::Div, Int(i32::MIN), Int(-1), Int(i32::MIN));
    check(BinaryOp::Rem, Int(i32::MIN), Int(-1), Int(0));
    check(BinaryOp::Div, Uint(7), Uint(0), Uint(u32::MAX));
    check(BinaryOp::Shl, Int(1), Uint(33), Int(2));
    check(BinaryOp::Shr, Int(-8), Int(1), Int(-4));
    check(BinaryOp::Shr, Uint(0x8000_0000), Int(31), Uint(1));
}

#[test]
fn floats_round_once_an_operation() {
    let mut builder = Builder::new();
    assert_eq!(builder.binary(BinaryOp::Add, Float(16_777_216.0), Float(1.0)), Some(Float(16_777_216.0)));
    assert_eq!(builder.binary(BinaryOp::Div, Float(1.0), Float(0.0)), Some(Float(f32::INFINITY)));
    assert_eq!(builder.binary(BinaryOp::Less, Float(f32::NAN), Float(1.0)), Some(Bool(false)));
    assert_eq!(builder.binary(BinaryOp::Equal, Float(-0.0), Float(0.0)), Some(Bool(true)));
}

#[test]
fn a_long_chain_needs_no_stack() {
    let mut builder = Builder::new();
    let one = builder.literal(Int(1));
    let mut sum = one;
    for _ in 0..100_000 {
        sum = builder.add(ExprKind::Binary(BinaryOp::Add, sum, one), TypeId::INT);
    }
    assert_eq!(builder.value(sum), Some(vec![Int(100_001)]));
}

#[test]
fn matrices_multiply_by_columns() {
    let mut builder = Builder::new();
    let matrix = builder.matrix(2, &[1.0, 2.0, 3.0, 4.0]);
    let vector = builder.vector(&[10.0, 100.0]);
    let column = builder.add(ExprKind::Binary(BinaryOp::MatMul, matrix, vector), TypeId::VEC2);
    assert_eq!(builder.value(column), Some(vec![Float(310.0), Float(420.0)]));
    let row = builder.add(ExprKind::Binary(BinaryOp::MatMul, vector, matrix), TypeId::VEC2);
    assert_eq!(builder.value(row), Some(vec![Float(210.0), Float(430.0)]));
    let square = builder.add(ExprKind::Binary(BinaryOp::MatMul, matrix, matrix), TypeId::matrix(2, 2));
    assert_eq!(builder.value(square), Some([7.0, 10.0, 15.0, 22.0].map(Float).to_vec()));
}

#[test]
fn inverse_times_matrix_is_the_identity() {
    let mut builder = Builder::new();
    let entries = [2.0, 0.0, 1.0, 0.0, 1.0, 3.0, 0.0, 0.0, 0.0, 1.0, 4.0, 1.0, 5.0, 0.0, 0.0, 1.0];
    let matrix = builder.matrix(4, &entries);
    let ty = TypeId::matrix(4, 4);
    let inverse = builder.add(ExprKind::BuiltinCall(BuiltinFunction::Inverse, vec![matrix]), ty);
    let product = builder.add(ExprKind::Binary(BinaryOp::MatMul, matrix, inverse), ty);
    for (index, value) in builder.value(product).expect("constant").into_iter().enumerate() {
        let expected = if index % 5 == 0 { 1.0 } else { 0.0 };
        let Float(value) = value else { panic!("a matrix holds floats") };
        assert!((value - expected).abs() < 1e-6, "{index}: {value}");
    }
    let determinant = builder.call(BuiltinFunction::Determinant, vec![matrix], TypeId::FLOAT);
    assert_eq!(determinant, Some(vec![Float(40.0)]));
}

#[test]
fn parts_of_aggregates() {
    let mut builder = Builder::new();
    let (a, b) = (builder.vector(&[1.0, 2.0]), builder.vector(&[3.0, 4.0]));
    let ty = builder.types.array(TypeId::VEC2, ArraySize::Sized(2));
    let array = builder.add(ExprKind::Construct(ConstructKind::Array, vec![a, b]), ty);
    let index = builder.literal(Int(1));
    let element = builder.add(ExprKind::Index(array, index), TypeId::VEC2);
    let swizzle = Swizzle { len: 3, components: [1, 0, 1, 0] };
    let swizzled = builder.add(ExprKind::Swizzle(element, swizzle), TypeId::VEC3);
    assert_eq!(builder.value(swizzled), Some([4.0, 3.0, 4.0].map(Float).to_vec()));
    let beyond = builder.literal(Int(2));
    let missing = builder.add(ExprKind::Index(array, beyond), TypeId::VEC2);
    assert_eq!(builder.value(missing), None);
}

#[test]
fn constructors_fill_and_cut() {
    let mut builder = Builder::new();
    let two = builder.literal(Float(2.0));
    let diagonal = builder.add(ExprKind::Construct(ConstructKind::Diagonal, vec![two]), TypeId::matrix(2, 3));
    assert_eq!(builder.value(diagonal), Some([2.0, 0.0, 0.0, 0.0, 2.0, 0.0].map(Float).to_vec()));
    let resized = builder.add(ExprKind::Construct(ConstructKind::Resize, vec![diagonal]), TypeId::matrix(3, 3));
    let expected = [2.0, 0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 1.0];
    assert_eq!(builder.value(resized), Some(expected.map(Float).to_vec()));
}

#[test]
fn functions_round_their_f64_value() {
    let mut builder = Builder::new();
    let x = builder.literal(Float(0.5));
    assert_eq!(builder.call(BuiltinFunction::Sin, vec![x], TypeId::FLOAT), Some(vec![Float(0.5_f64.sin() as f32)]));
    let (low, high, t) = (builder.literal(Float(0.0)), builder.literal(Float(1.0)), builder.vector(&[-1.0, 0.25]));
    let clamped = builder.call(BuiltinFunction::Clamp, vec![t, low, high], TypeId::VEC2);
    assert_eq!(clamped, Some(vec![Float(0.0), Float(0.25)]));
    let negated = builder.add(ExprKind::Unary(UnaryOp::Negate, t), TypeId::VEC2);
    assert_eq!(
        builder.call(BuiltinFunction::Step, vec![low, negated], TypeId::VEC2),
        Some(vec![Float(1.0), Float(0.0)])
    );
    assert_eq!(builder.call(BuiltinFunction::Noise1, vec![x], TypeId::FLOAT), None);
    assert_eq!(builder.call(BuiltinFunction::Fwidth, vec![t], TypeId::VEC2), Some(vec![Float(0.0); 2]));
}

#[test]
fn variables_come_from_the_caller() {
    let mut builder = Builder::new();
    let local = builder.add(ExprKind::Var(VarRef::Local(crate::hir::LocalId::new(0))), TypeId::INT);
    let value = Value { ty: TypeId::INT, scalars: vec![Int(5)] };
    let known = evaluate(&builder.shader, &builder.types, local, &|_| Some(&value));
    assert_eq!(known, Some(value.clone()));
    assert_eq!(builder.value(local), None);
}
