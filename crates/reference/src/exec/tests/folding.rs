//! Checks for every row of the table of operations, and for every operator, that constant folding yields the
//! executor's f32 result bit for bit, especially for special values.
//!
//! Folding and executor are two programs: one traverses expressions in the compiler, the other compiles them to
//! registers. Both must take the cases that GLSL leaves undefined from the same definitions
//! (`glisten_front::builtin::operations::kernel`), or this test fails.

use crate::domain::{Domain, F32, Integer, Number};
use crate::exec::{Code, LANES, Machine, Mask};
use glisten_front::builtin::functions::{Effect, all};
use glisten_front::builtin::operations::Class;
use glisten_front::compiler::{Compiler, Options, Source};
use glisten_front::fold;
use glisten_front::hir::{
    ExprId, ExprKind, Global, GlobalId, Scalar, ScalarValue, Shader, Stage, StmtKind, TypeId, Types, Value, VarRef,
};
use glisten_front::link::Program;

const FLOATS: [f32; 16] = [
    0.0,
    -0.0,
    1.0,
    -1.0,
    0.5,
    -2.5,
    1e-40,
    -1e-40,
    f32::MIN_POSITIVE,
    3.0e6,
    -1.0e30,
    f32::MAX,
    f32::MIN,
    f32::INFINITY,
    f32::NEG_INFINITY,
    f32::NAN,
];

const INTS: [u32; 8] = [0, 1, u32::MAX, 2, i32::MIN as u32, i32::MAX as u32, 33, (-7i32) as u32];

/// An expression of `a0`, `a1`, ... of these types.
struct Case {
    expression: String,
    inputs: Vec<TypeId>,
    ret: TypeId,
}

/// The type that carries a type between stages: `bool`s become `int`s.
fn carrier(types: &Types, ty: TypeId) -> String {
    match types.scalar_of(ty) {
        Some(Scalar::Bool) => types.name(ty).replace("bvec", "ivec").replace("bool", "int"),
        _ => types.name(ty),
    }
}

impl Case {
    fn text(&self) -> String {
        let types = Types::basic();
        let mut text = String::from("#version 460\n#extension GL_EXT_gpu_shader4 : enable\n");
        let mut call = self.expression.clone();
        for (index, ty) in self.inputs.iter().enumerate() {
            text += &format!("in {} a{index};\n", carrier(types, *ty));
            call = call.replace(&format!("${index}"), &format!("{}(a{index})", types.name(*ty)));
        }
        let result = carrier(types, self.ret);
        let flat = if types.scalar_of(self.ret) == Some(Scalar::Float) { "" } else { "flat " };
        text + &format!("{flat}out {result} o;\nvoid main() {{ o = {result}({call}); }}\n")
    }

    fn program(&self) -> Program {
        let text = self.text();
        let source = Source { name: "test.vert".into(), text: text.as_str().into(), stage: Stage::Vertex };
        let compilation = Compiler::new(Options::default()).compile(&[source]);
        let messages: Vec<String> = compilation.diagnostics.iter().map(|found| found.message.clone()).collect();
        compilation.program.unwrap_or_else(|| panic!("{messages:?} in\n{text}"))
    }

    /// The value of an input's scalar in a set: all combinations if all inputs are scalars, otherwise a mixture.
    fn scalar(&self, scalar: Scalar, set: usize, input: usize, flat: usize) -> u32 {
        let singles = self.inputs.iter().all(|ty| Types::basic().flat_len(*ty) == 1);
        let mixed = (set * 31 + input * 17 + flat * 7).wrapping_mul(2_654_435_761) >> 7;
        match (scalar, singles) {
            (Scalar::Float, true) => FLOATS[(set >> (4 * input)) % 16].to_bits(),
            // Only a few special values at a time, or a vector would contain only NaN.
            (Scalar::Float, false) if set.is_multiple_of(2) => FLOATS[mixed % 6].to_bits(),
            (Scalar::Float, false) => FLOATS[mixed % 16].to_bits(),
            (Scalar::Bool, _) => (mixed & 1) as u32,
            (Scalar::Int | Scalar::Uint, true) => INTS[(set >> (3 * input)) % 8],
            (Scalar::Int | Scalar::Uint, false) => INTS[mixed % 8],
        }
    }

    fn rounds(&self) -> usize {
        let singles = self.inputs.iter().all(|ty| Types::basic().flat_len(*ty) == 1);
        match (singles, self.inputs.len()) {
            (true, 1) => 1,
            (true, 2) => 4,
            (true, _) => 64,
            (false, _) => 8,
        }
    }
}

fn value_of(scalar: Scalar, bits: u32) -> ScalarValue {
    match scalar {
        Scalar::Float => ScalarValue::Float(f32::from_bits(bits)),
        Scalar::Int | Scalar::Bool => ScalarValue::Int(bits as i32),
        Scalar::Uint => ScalarValue::Uint(bits),
    }
}

/// All NaNs are equal.
fn bits_of(value: &ScalarValue) -> u32 {
    match value {
        ScalarValue::Float(value) if value.is_nan() => f32::NAN.to_bits(),
        ScalarValue::Float(value) => value.to_bits(),
        ScalarValue::Int(value) => *value as u32,
        ScalarValue::Uint(value) => *value,
        ScalarValue::Bool(value) => u32::from(*value),
    }
}

/// The expression that is assigned to `o`.
fn assigned(shader: &Shader) -> ExprId {
    let main = shader.functions.iter().filter_map(|function| function.body.as_ref()).flatten();
    let mut values = main.filter_map(|stmt| match stmt.kind {
        StmtKind::Expr(id) => match shader.expr(id).kind {
            ExprKind::Assign(_, _, value) => Some(value),
            _ => None,
        },
        _ => None,
    });
    values.next_back().expect("`main` assigns")
}

fn find<'a>(shader: &'a Shader, name: &str) -> Option<(GlobalId, &'a Global)> {
    shader.globals().find(|(_, global)| global.name == name)
}

/// Runs 64 sets of arguments and folds each. Returns `None` if the expression is never constant.
fn agree(case: &Case, program: &Program, code: &Code, round: usize) -> Option<usize> {
    let shader = program.stage(Stage::Vertex).expect("it was compiled");
    let types = &program.types;
    let mut machine = Machine::<F32>::new(code, &[], &[]);
    let mut sets: Vec<Vec<(GlobalId, Value)>> = vec![Vec::new(); LANES];
    for (index, ty) in case.inputs.iter().enumerate() {
        let Some((id, global)) = find(shader, &format!("a{index}")) else { continue };
        let scalar = types.scalar_of(*ty).expect("inputs are numbers");
        for (lane, set) in sets.iter_mut().enumerate() {
            let mut scalars = Vec::new();
            for flat in 0..types.flat_len(global.ty) {
                let bits = case.scalar(scalar, round * LANES + lane, index, flat as usize);
                if let Some(input) = machine.float_input(id, flat) {
                    input.set(lane, f32::from_bits(bits));
                } else if let Some(input) = machine.int_input(id, flat) {
                    input.set(lane, <F32 as Domain>::Int::from_bits(bits));
                }
                scalars.push(value_of(scalar, bits));
            }
            set.push((id, Value { ty: global.ty, scalars }));
        }
    }
    machine.run(Mask::ALL, Mask::NONE);
    let (o, _) = find(shader, "o").expect("it has an output");
    for (lane, set) in sets.iter().enumerate() {
        let given = |variable: VarRef| match variable {
            VarRef::Global(id) => set.iter().find(|(known, _)| *known == id).map(|(_, value)| value),
            VarRef::Local(_) => None,
        };
        let folded = fold::evaluate(shader, types, assigned(shader), &given)?;
        for (flat, folded) in folded.scalars.iter().enumerate() {
            let flat = flat as u32;
            let found = match machine.float_output(o, flat) {
                Some(lanes) => ScalarValue::Float(lanes.get(lane).value() as f32),
                None => ScalarValue::Uint(machine.int_output(o, flat).expect("an output").get(lane).bits()),
            };
            let arguments: Vec<&[ScalarValue]> = set.iter().map(|(_, value)| value.scalars.as_slice()).collect();
            assert_eq!(
                bits_of(folded),
                bits_of(&found),
                "`{}`, scalar {flat} of {arguments:?}: folded {folded:?}, executed {found:?}",
                case.expression
            );
        }
    }
    Some(sets.len())
}

fn check(case: &Case) -> Option<usize> {
    let program = case.program();
    let code = Code::compile(&program, Stage::Vertex).unwrap_or_else(|errors| panic!("{}: {errors:?}", case.text()));
    (0..case.rounds()).map(|round| agree(case, &program, &code, round)).sum()
}

#[test]
fn every_overload_folds_to_what_is_executed() {
    let mut count = 0;
    // Functions that the analysis writes out with locals are constant only if it knows their arguments.
    for row in all().filter(|row| row.effect == Effect::None && row.function.class() != Class::Composed) {
        for signature in row.signatures(Stage::Vertex) {
            let inputs: Vec<TypeId> = signature.params().iter().map(|param| param.0).collect();
            let arguments: Vec<String> = (0..inputs.len()).map(|index| format!("${index}")).collect();
            let expression = format!("{}({})", row.name, arguments.join(", "));
            let case = Case { expression, inputs, ret: signature.ret };
            assert_eq!(check(&case).is_some(), row.constant, "{}: is it constant?", row.prototype());
            count += 1;
        }
    }
    assert!(count > 250, "only {count} overloads");
}

#[test]
fn every_operator_folds_to_what_is_executed() {
    use TypeId as T;
    let mat = |columns, rows| T::matrix(columns, rows);
    let mut cases: Vec<(&str, Vec<TypeId>, TypeId)> = Vec::new();
    for op in ["+", "-", "*", "/"] {
        for ty in [T::FLOAT, T::INT, T::UINT, T::VEC3] {
            cases.push((op, vec![ty, ty], ty));
        }
        cases.push((op, vec![T::VEC2, T::FLOAT], T::VEC2));
        cases.push((op, vec![T::FLOAT, mat(2, 2)], mat(2, 2)));
    }
    for op in ["%", "&", "|", "^", "<<", ">>"] {
        for ty in [T::INT, T::UINT] {
            cases.push((op, vec![ty, ty], ty));
        }
    }
    for op in ["<", "<=", ">", ">=", "==", "!="] {
        for ty in [T::FLOAT, T::INT, T::UINT] {
            cases.push((op, vec![ty, ty], T::BOOL));
        }
    }
    for (inputs, ret) in [
        (vec![mat(2, 3), T::VEC2], T::VEC3),
        (vec![T::VEC3, mat(2, 3)], T::VEC2),
        (vec![mat(3, 2), mat(2, 3)], mat(2, 2)),
        (vec![mat(4, 4), T::VEC4], T::VEC4),
    ] {
        cases.push(("*", inputs, ret));
    }
    for (op, inputs, ret) in cases {
        let case = Case { expression: format!("$0 {op} $1"), inputs, ret };
        assert!(check(&case).is_some(), "{}", case.text());
    }
    for (expression, ty, ret) in [
        ("-$0", T::FLOAT, T::FLOAT),
        ("-$0", T::INT, T::INT),
        ("~$0", T::UINT, T::UINT),
        ("float($0)", T::INT, T::FLOAT),
        ("float($0)", T::UINT, T::FLOAT),
        ("int($0)", T::FLOAT, T::INT),
        ("uint($0)", T::FLOAT, T::UINT),
        ("bool($0)", T::FLOAT, T::BOOL),
        ("$0 > 0.0 ? $0 : 1.0 - $0", T::FLOAT, T::FLOAT),
    ] {
        let case = Case { expression: expression.to_owned(), inputs: vec![ty], ret };
        assert!(check(&case).is_some(), "{}", case.text());
    }
}
