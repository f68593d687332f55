//! Checks every overload of every built-in function, in f64 and f32, on random inputs and edge cases, against numbers
//! of 320 bits.
//!
//! [`super::builtins`] checks the results for infinities and NaN.

mod big;
mod bits;
mod matrix;
mod oracle;

use crate::domain::{Domain, F32, F64, Integer, Number};
use crate::exec::{Code, LANES, Machine, Mask};
use big::Big;
use glisten_front::builtin::BuiltinFunction;
use glisten_front::builtin::functions::{Effect, Signature, all, named};
use glisten_front::compiler::{Compiler, Options, Source};
use glisten_front::hir::{Scalar, Stage, TypeId, Types};
use glisten_front::language::Since;
use glisten_front::link::Program;
use oracle::{Argument, Want, expected};
use std::collections::BTreeSet;

/// A deterministic random number generator.
struct Random(u64);

impl Random {
    fn bits(&mut self) -> u32 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 32) as u32
    }

    fn below(&mut self, count: usize) -> usize {
        self.bits() as usize % count
    }

    fn unit(&mut self) -> f64 {
        (f64::from(self.bits()) + f64::from(self.bits()) / 4_294_967_296.0) / 4_294_967_296.0
    }

    fn sign(&mut self) -> f64 {
        if self.bits() & 1 == 0 { 1.0 } else { -1.0 }
    }

    /// Edge cases, numbers around 1, halves, and numbers of all sizes.
    fn float(&mut self) -> f64 {
        const EDGES: [f64; 16] = [
            0.0,
            1.0,
            0.5,
            2.5,
            1.0 + f32::EPSILON as f64,
            1.0 - f32::EPSILON as f64 / 2.0,
            8_388_609.0,
            16_777_217.0,
            4_294_967_296.0,
            f32::MAX as f64,
            f32::MIN_POSITIVE as f64,
            1e-40,
            std::f64::consts::FRAC_PI_2,
            std::f64::consts::PI,
            88.72,
            3.0e6,
        ];
        let value = match self.below(8) {
            0 => EDGES[self.below(EDGES.len())],
            1 => self.below(20) as f64 / 2.0,
            2 | 3 => self.unit(),
            4 => 1.0 - self.unit() * 2.0_f64.powi(-(self.below(20) as i32)),
            5 => self.unit() * 20.0,
            6 => self.unit() * 200.0,
            _ => (1.0 + self.unit()) * 2.0_f64.powi(self.below(252) as i32 - 126),
        };
        value * self.sign()
    }

    fn integer(&mut self, scalar: Scalar) -> u32 {
        const EDGES: [u32; 6] = [0, 1, u32::MAX, i32::MAX as u32, i32::MIN as u32, 2];
        match (scalar, self.below(3)) {
            (Scalar::Bool, _) => self.bits() & 1,
            (_, 0) => EDGES[self.below(EDGES.len())],
            (_, 1) => (self.below(9) as u32).wrapping_sub(4),
            _ => self.bits(),
        }
    }
}

/// The type that carries a type between stages: `bool`s become `int`s.
fn carrier(types: &Types, ty: TypeId) -> String {
    match types.scalar_of(ty) {
        Some(Scalar::Bool) => types.name(ty).replace("bvec", "ivec").replace("bool", "int"),
        _ => types.name(ty),
    }
}

/// A vertex stage that calls the function once.
fn program(name: &str, signature: &Signature, is_modf: bool) -> Program {
    let types = Types::new();
    let inputs: Vec<TypeId> =
        signature.params().iter().take(if is_modf { 1 } else { 5 }).map(|param| param.0).collect();
    let mut text = String::from("#version 460\n");
    let by_extension = named(name).iter().filter(|row| row.availability.since == Since::NEVER);
    let extensions: BTreeSet<&str> = by_extension.filter_map(|row| row.availability.extensions.name()).collect();
    text.extend(extensions.iter().map(|name| format!("#extension {name} : require\n")));
    for (index, ty) in inputs.iter().enumerate() {
        text += &format!("in {} a{index};\n", carrier(&types, *ty));
    }
    let given: Vec<String> =
        inputs.iter().enumerate().map(|(index, ty)| format!("{}(a{index})", types.name(*ty))).collect();
    let result = carrier(&types, signature.ret);
    let flat = if types.scalar_of(signature.ret) == Some(Scalar::Float) { "" } else { "flat " };
    text += &format!("{flat}out {result} o;\n");
    if is_modf {
        text += &format!("out {result} whole;\nvoid main() {{ o = {name}({}, whole); }}\n", given.join(", "));
    } else {
        text += &format!("void main() {{ o = {result}({name}({})); }}\n", given.join(", "));
    }
    let source = Source { name: "test.vert".into(), text: text.as_str().into(), stage: Stage::Vertex };
    let compilation = Compiler::new(Options::default()).compile(&[source]);
    let messages: Vec<String> = compilation.diagnostics.iter().map(|found| found.message.clone()).collect();
    compilation.program.unwrap_or_else(|| panic!("{messages:?} in\n{text}"))
}

/// Half the distance between the two f32 around a value.
fn half_step(value: f64) -> f64 {
    let exponent = value.abs().log2().floor().max(-126.0);
    2.0_f64.powf(exponent - 24.0)
}

/// Whether f64, or f32 with one rounding, may yield `found`.
fn holds(want: &Want, found: f64, is_single: bool) -> bool {
    match want {
        Want::Anything => true,
        Want::Bits(_) => false,
        Want::Exactly(value) => {
            let value = if is_single { f64::from(*value as f32) } else { *value };
            found == value || (found.is_nan() && value.is_nan())
        }
        Want::Near(value, slack) => {
            let most = if is_single { f64::from(f32::MAX) } else { f64::MAX };
            let size = value.approx();
            if found.is_infinite() {
                let may_turn = *slack > size.abs();
                return (found.signum() == size.signum() || may_turn) && size.abs() + slack >= most * (1.0 - 1e-9);
            }
            // A tie may be rounded either way, depending on the error of f64.
            let rounding =
                if is_single { half_step(size) } else { size.abs() * f64::EPSILON / 2.0 + f64::MIN_POSITIVE };
            (&Big::of(found) - value).approx().abs() <= rounding + slack
        }
    }
}

struct Check {
    function: BuiltinFunction,
    told: String,
    signature: Signature,
    program: Program,
    code: Code,
}

impl Check {
    fn new(function: BuiltinFunction, name: &str, signature: Signature) -> Self {
        let program = program(name, &signature, function == BuiltinFunction::Modf);
        let code = Code::compile(&program, Stage::Vertex).unwrap_or_else(|errors| panic!("{name}: {errors:?}"));
        Self { function, told: signature.describe(name, &Types::new()), signature, program, code }
    }

    /// 64 sets of arguments, each a few times similar to the one before, so that equal ones occur.
    fn arguments(&self, random: &mut Random) -> Vec<Vec<Argument>> {
        let types = &self.program.types;
        (0..LANES)
            .map(|_| {
                let mut set: Vec<Argument> = Vec::new();
                for (ty, _) in self.signature.params() {
                    let scalar = types.scalar_of(*ty).expect("a scalar, vector or matrix");
                    let count = types.flat_len(*ty) as usize;
                    let (mut floats, mut bits) = (vec![0.0; count], vec![0; count]);
                    let before = set.last().filter(|before| before.scalar == scalar && before.bits.len() == count);
                    match (scalar, before) {
                        (_, Some(before)) if random.below(4) == 0 => {
                            floats.clone_from(&before.floats);
                            bits.clone_from(&before.bits);
                        }
                        (Scalar::Float, _) => floats.iter_mut().for_each(|slot| *slot = random.float()),
                        _ => bits.iter_mut().for_each(|slot| *slot = random.integer(scalar)),
                    }
                    set.push(Argument { ty: types.get(*ty), scalar, floats, bits });
                }
                set
            })
            .collect()
    }

    fn run<D: Domain>(&self, lanes: &mut [Vec<Argument>]) {
        let mut machine = Machine::<D>::new(&self.code, &[], &[]);
        let shader = self.program.stage(Stage::Vertex).expect("it was compiled");
        let global = |name: &str| shader.globals().find(|(_, global)| global.name == name).map(|(id, _)| id);
        for index in 0..self.signature.params().len() {
            let Some(id) = global(&format!("a{index}")) else { continue };
            for flat in 0..lanes[0][index].floats.len() {
                for (lane, set) in lanes.iter_mut().enumerate() {
                    if let Some(input) = machine.float_input(id, flat as u32) {
                        input.set(lane, D::Float::from_f64(set[index].floats[flat]));
                        set[index].floats[flat] = input.get(lane).value();
                    } else if let Some(input) = machine.int_input(id, flat as u32) {
                        input.set(lane, D::Int::from_bits(set[index].bits[flat]));
                    }
                }
            }
        }
        machine.run(Mask::ALL, Mask::NONE);
        let count = self.program.types.flat_len(self.signature.ret) as usize;
        for (lane, set) in lanes.iter().enumerate() {
            let wants = expected(self.function, set, count).unwrap_or_else(|| panic!("{} is not known", self.told));
            for (place, want) in wants.iter().enumerate() {
                let id = global(if place < count { "o" } else { "whole" }).expect("an output");
                let flat = (place % count) as u32;
                if let Some(output) = machine.float_output(id, flat) {
                    let found = output.get(lane).value();
                    let given: Vec<&[f64]> = set.iter().map(|argument| argument.floats.as_slice()).collect();
                    let fine = holds(want, found, D::NAME == "f32");
                    assert!(fine, "{} in {}, scalar {place}, of {given:?}: {found:e} for {want:?}", self.told, D::NAME);
                } else if let Some(output) = machine.int_output(id, flat) {
                    let given: Vec<_> = set.iter().map(|argument| (&argument.bits, &argument.floats)).collect();
                    let bits = match want {
                        Want::Anything => continue,
                        Want::Bits(bits) => bits,
                        _ => panic!("{}: {want:?}", self.told),
                    };
                    assert_eq!(output.get(lane).bits(), *bits, "{} of {given:?}", self.told);
                } else {
                    panic!("{} gives nothing", self.told);
                }
            }
        }
    }
}

#[test]
fn every_overload_agrees_with_numbers_of_320_bits() {
    let mut random = Random(2026);
    let mut n_checked = 0;
    for row in all() {
        // Textures and derivatives have tests of their own.
        let checked = row.effect == Effect::None || row.function == BuiltinFunction::Modf;
        if !checked || row.availability.compatibility_only {
            continue;
        }
        for signature in row.signatures(Stage::Fragment) {
            let check = Check::new(row.function, row.name, signature);
            // The components of vectors are computed in the same way.
            let rounds = if Types::new().flat_len(signature.ret) == 1 { 4 } else { 1 };
            for _ in 0..rounds {
                let mut lanes = check.arguments(&mut random);
                check.run::<F64>(&mut lanes);
                check.run::<F32>(&mut lanes);
            }
            n_checked += 1;
        }
    }
    assert!(n_checked > 250, "only {n_checked} overloads");
}
