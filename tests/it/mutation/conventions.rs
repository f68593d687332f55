//! Faults of the conventions between languages and GPUs: where coordinates begin, which side is the front, how depth is
//! counted, which way a derivative goes.
//!
//! *In:* a module, the stage, the height of the picture. *Out:* mutations.

use super::module::{Builder, Module, class};
use super::words::{Instruction, encoded, op};
use super::{Kind, Mutation, Target};

/// Built-in variables (§3.21).
const POSITION: u32 = 0;
const FRAG_COORD: u32 = 15;
const POINT_COORD: u32 = 16;
const FRONT_FACING: u32 = 17;
const FRAG_DEPTH: u32 = 22;
const VERTEX_INDEX: u32 = 42;
const INSTANCE_INDEX: u32 = 43;

/// A change of one component: `factor` times itself, plus `plus`, plus `w` times the fourth component.
struct Affine {
    built_in: u32,
    name: &'static str,
    component: u32,
    factor: f32,
    plus: f32,
    w: f32,
}

const fn affine(built_in: u32, name: &'static str, component: u32, [factor, plus, w]: [f32; 3]) -> Affine {
    Affine { built_in, name, component, factor, plus, w }
}

/// Changes of what the fragment stage reads.
const READ: [Affine; 5] = [
    affine(FRAG_COORD, "FragCoord.x is half a pixel more", 0, [1.0, 0.5, 0.0]),
    affine(FRAG_COORD, "FragCoord.y is half a pixel more", 1, [1.0, 0.5, 0.0]),
    affine(FRAG_COORD, "FragCoord.z is from -1 to 1", 2, [2.0, -1.0, 0.0]),
    affine(FRAG_COORD, "FragCoord.w has the other sign", 3, [-1.0, 0.0, 0.0]),
    affine(POINT_COORD, "PointCoord.y counts from the other side", 1, [-1.0, 1.0, 0.0]),
];

/// Changes of what the stages write.
const WRITTEN: [Affine; 5] = [
    affine(POSITION, "Position.y is flipped", 1, [-1.0, 0.0, 0.0]),
    affine(POSITION, "Position.x is flipped", 0, [-1.0, 0.0, 0.0]),
    affine(POSITION, "Position.z is from -w to w", 2, [2.0, 0.0, -1.0]),
    affine(POSITION, "Position.z is halved twice", 2, [0.5, 0.0, 0.5]),
    affine(FRAG_DEPTH, "FragDepth is reversed", 0, [-1.0, 1.0, 0.0]),
];

/// All of these faults.
pub(super) fn faults(module: &Module<'_>, target: Target) -> Vec<Mutation> {
    let mut found = Vec::new();
    for one in module.code() {
        match one.opcode() {
            op::LOAD => found.extend(loads(module, one, target)),
            op::STORE => found.extend(stores(module, one)),
            208 | 211 | 214 => found.extend(negated(module, one)),
            _ => {}
        }
    }
    found
}

fn fault(builder: Builder<'_, '_>, name: &str) -> Mutation {
    Mutation { kind: Kind::Convention, name: name.to_owned(), rewrite: builder.finish() }
}

/// The derivative along y with the other sign.
fn negated(module: &Module<'_>, one: &Instruction<'_>) -> Option<Mutation> {
    let mut builder = Builder::new(module);
    let plain = builder.id();
    let mut words = one.words.to_vec();
    words[2] = plain;
    builder.replace(one, vec![words, encoded(op::F_NEGATE, &[one.word(1), one.word(2), plain])]);
    Some(fault(builder, &format!("%{} the derivative along y has the other sign", one.word(2))))
}

/// The code that changes one component of `value` to the result `new`.
fn changed(builder: &mut Builder<'_, '_>, ty: u32, [value, new]: [u32; 2], row: &Affine) -> Option<Vec<Vec<u32>>> {
    let (scalar, count) = builder.module.components(ty);
    if row.component >= count || !builder.module.is_float(ty) || (row.w != 0.0 && count < 4) {
        return None;
    }
    let [old, w, scaled, shifted, moved, sum] = std::array::from_fn(|_| builder.id());
    let [factor, plus, by_w] = [row.factor, row.plus, row.w].map(|number| builder.float(scalar, number));
    let part = |result: u32, component: u32| match count {
        1 => encoded(op::COPY_OBJECT, &[scalar, result, value]),
        _ => encoded(op::COMPOSITE_EXTRACT, &[scalar, result, value, component]),
    };
    let whole = match count {
        1 => encoded(op::COPY_OBJECT, &[ty, new, sum]),
        _ => encoded(op::COMPOSITE_INSERT, &[ty, new, sum, value, row.component]),
    };
    Some(vec![
        part(old, row.component),
        part(w, count - 1),
        encoded(op::F_MUL, &[scalar, scaled, old, factor]),
        encoded(op::F_ADD, &[scalar, moved, scaled, plus]),
        encoded(op::F_MUL, &[scalar, shifted, w, by_w]),
        encoded(op::F_ADD, &[scalar, sum, moved, shifted]),
        whole,
    ])
}

/// The built-in variables that are read.
fn loads(module: &Module<'_>, one: &Instruction<'_>, target: Target) -> Vec<Mutation> {
    let [ty, result, variable] = [1, 2, 3].map(|place| one.word(place));
    let is = |built_in: u32| module.is_built_in(variable, class::INPUT, built_in);
    let flipped = affine(FRAG_COORD, "FragCoord.y counts from the other side", 1, [-1.0, target.height as f32, 0.0]);
    let mut found = Vec::new();
    for row in READ.iter().chain([&flipped]).filter(|row| is(row.built_in)) {
        let mut builder = Builder::new(module);
        let plain = builder.id();
        let Some(code) = changed(&mut builder, ty, [plain, result], row) else { continue };
        let all = [vec![encoded(op::LOAD, &[ty, plain, variable])], code].concat();
        builder.replace(one, all);
        found.push(fault(builder, row.name));
    }
    let mut simple = |built_in: u32, opcode: u16, step: Option<u32>, name: &str| {
        if is(built_in) {
            let mut builder = Builder::new(module);
            let plain = builder.id();
            let mut operands = vec![ty, result, plain];
            operands.extend(step.map(|step| builder.splat(ty, step)));
            builder.replace(one, vec![encoded(op::LOAD, &[ty, plain, variable]), encoded(opcode, &operands)]);
            found.push(fault(builder, name));
        }
    };
    simple(FRONT_FACING, op::LOGICAL_NOT, None, "FrontFacing is inverted");
    simple(VERTEX_INDEX, op::I_ADD, Some(1), "VertexIndex counts from 1");
    simple(INSTANCE_INDEX, op::I_ADD, Some(1), "InstanceIndex counts from 1");
    found
}

/// The built-in variables that are written.
fn stores(module: &Module<'_>, one: &Instruction<'_>) -> Vec<Mutation> {
    let [variable, value] = [1, 2].map(|place| one.word(place));
    let Some(ty) = module.pointee(variable) else { return Vec::new() };
    let mut found = Vec::new();
    for row in WRITTEN.iter().filter(|row| module.is_built_in(variable, class::OUTPUT, row.built_in)) {
        let mut builder = Builder::new(module);
        let new = builder.id();
        let Some(mut code) = changed(&mut builder, ty, [value, new], row) else { continue };
        code.push(encoded(op::STORE, &[variable, new]));
        builder.replace(one, code);
        found.push(fault(builder, row.name));
    }
    found
}
