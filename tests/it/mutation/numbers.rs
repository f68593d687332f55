//! Faults of numbers: constants with too few digits, integers one off in one of their uses, conversions.
//!
//! *In:* a module. *Out:* mutations.

use super::module::{Builder, Module, Type};
use super::words::{Instruction, encoded, glsl, op};
use super::{Kind, Mutation};

/// All faults of numbers.
pub(super) fn faults(module: &Module<'_>) -> Vec<Mutation> {
    let mut found: Vec<Mutation> = module.instructions.iter().flat_map(|one| constants(module, one)).collect();
    for one in module.code() {
        found.extend(integers(module, one));
        found.extend(conversions(module, one));
    }
    found
}

/// A constant with the digits of a half float, one that is a hundredth too large, and one of the other sign.
fn constants(module: &Module<'_>, one: &Instruction<'_>) -> Vec<Mutation> {
    if one.opcode() != op::CONSTANT || module.ty(one.word(1)) != Type::Float {
        return Vec::new();
    }
    let (bits, value) = (one.word(3), f32::from_bits(one.word(3)));
    // Ten bits of the fraction, to the nearest.
    let half = bits.wrapping_add(0x1000) & !0x1fff;
    let changes = [
        (half, "has the digits of a half float"),
        ((value * 1.01).to_bits(), "is 1 % larger"),
        ((-value).to_bits(), "has the other sign"),
    ];
    changes
        .into_iter()
        .filter(|(new, _)| *new != bits && value.is_finite() && value != 0.0)
        .map(|(new, what)| {
            let name = format!("%{} constant {value} {what}", one.word(2));
            Mutation::new(Kind::Constant, name, one.with(3, new))
        })
        .collect()
}

/// The places of the operands of an instruction that are identifiers of values and may be integers.
fn operands(one: &Instruction<'_>) -> std::ops::Range<usize> {
    let end = one.words.len();
    match one.opcode() {
        // The end of a clamped index is left alone: beyond it is nothing.
        op::EXT_INST if one.word(4) == glsl::U_MIN => end..end,
        op::EXT_INST => 5..end,
        op::ACCESS_CHAIN | op::FUNCTION_CALL => 4..end,
        op::STORE => 2..end.min(3),
        254 => 1..end,
        // Sizes of levels of detail, texels.
        103 => 4..end,
        95 => 4..5,
        op::COMPOSITE_CONSTRUCT | op::CONVERT_S_TO_F | op::CONVERT_U_TO_F | op::BITCAST | 128..=200 => 3..end,
        _ => end..end,
    }
}

/// Constant integers that are one off in one use.
fn integers(module: &Module<'_>, one: &Instruction<'_>) -> Vec<Mutation> {
    let mut found = Vec::new();
    for place in operands(one) {
        let Some((_, constant)) = module.definition(one.word(place)) else { continue };
        let is_vector = constant.opcode() == op::CONSTANT_COMPOSITE;
        let scalar = if is_vector { constant.word(3) } else { constant.word(2) };
        let Some(&(ty, bits)) = module.constants.get(&scalar).filter(|(ty, _)| module.is_int(*ty)) else { continue };
        for (step, more) in [(1, "+ 1"), (u32::MAX, "- 1")] {
            let number = bits.wrapping_add(step);
            // A negative index, shift or count is no fault of this kind.
            if bits == 0 && step != 1 {
                continue;
            }
            let mut builder = Builder::new(module);
            let mut new = builder.constant(ty, number);
            if is_vector {
                let vector = builder.id();
                let mut words = constant.words[1..].to_vec();
                (words[1], words[2], new) = (vector, new, vector);
                builder.declare(op::CONSTANT_COMPOSITE, &words);
            }
            builder.splices.push(one.with(place, new));
            let name = format!("{} {more} in operand {place} of {}", bits as i32, described(one));
            found.push(Mutation { kind: Kind::Integer, name, rewrite: builder.finish() });
        }
    }
    found
}

fn described(one: &Instruction<'_>) -> String {
    match one.result() {
        0 => format!("an instruction {}", one.opcode()),
        id => format!("%{id}"),
    }
}

/// Conversions to or from the other signedness, of the bits, and by another rounding.
fn conversions(module: &Module<'_>, one: &Instruction<'_>) -> Vec<Mutation> {
    let [result, from] = [2, 3].map(|place| one.word(place));
    let is_from_float = module.type_of(from).is_some_and(|ty| module.is_float(ty));
    let is_to_float = module.is_float(one.word(1));
    let coded = |name: &str, code: u16| {
        let mut words = one.words.to_vec();
        words[0] = words[0] & !0xffff | u32::from(code);
        Some(Mutation::new(Kind::Conversion, format!("%{result} {name}"), one.replaced(words)))
    };
    let found: Vec<Option<Mutation>> = match one.opcode() {
        op::CONVERT_F_TO_S => vec![
            by_unsigned(module, one),
            coded("ConvertFToS becomes Bitcast", op::BITCAST),
            rounded(module, one, glsl::FLOOR, "Floor"),
            rounded(module, one, glsl::ROUND_EVEN, "RoundEven"),
            rounded(module, one, glsl::CEIL, "Ceil"),
        ],
        op::CONVERT_F_TO_U => vec![
            coded("ConvertFToU becomes ConvertFToS", op::CONVERT_F_TO_S),
            coded("ConvertFToU becomes Bitcast", op::BITCAST),
            rounded(module, one, glsl::ROUND_EVEN, "RoundEven"),
        ],
        op::CONVERT_S_TO_F => vec![
            coded("ConvertSToF becomes ConvertUToF", op::CONVERT_U_TO_F),
            coded("ConvertSToF becomes Bitcast", op::BITCAST),
        ],
        op::CONVERT_U_TO_F => vec![
            coded("ConvertUToF becomes ConvertSToF", op::CONVERT_S_TO_F),
            coded("ConvertUToF becomes Bitcast", op::BITCAST),
        ],
        op::BITCAST if is_from_float && !is_to_float => vec![coded("Bitcast becomes ConvertFToS", op::CONVERT_F_TO_S)],
        op::BITCAST if is_to_float && !is_from_float => vec![coded("Bitcast becomes ConvertSToF", op::CONVERT_S_TO_F)],
        op::EXT_INST => roundings(one),
        _ => Vec::new(),
    };
    found.into_iter().flatten().collect()
}

/// `floor` as `trunc`, and the others.
fn roundings(one: &Instruction<'_>) -> Vec<Option<Mutation>> {
    let others: &[(u32, &str)] = match one.word(4) {
        glsl::FLOOR => &[(glsl::TRUNC, "Floor becomes Trunc"), (glsl::ROUND_EVEN, "Floor becomes RoundEven")],
        glsl::TRUNC => &[(glsl::ROUND_EVEN, "Trunc becomes RoundEven"), (glsl::CEIL, "Trunc becomes Ceil")],
        glsl::CEIL => &[(glsl::ROUND_EVEN, "Ceil becomes RoundEven"), (glsl::TRUNC, "Ceil becomes Trunc")],
        1 | glsl::ROUND_EVEN => &[(glsl::FLOOR, "Round becomes Floor"), (glsl::CEIL, "Round becomes Ceil")],
        _ => &[],
    };
    let made = |(number, name): &(u32, &str)| {
        Some(Mutation::new(Kind::Conversion, format!("%{} {name}", one.word(2)), one.with(4, *number)))
    };
    others.iter().map(made).collect()
}

/// A conversion to a signed integer by way of an unsigned one.
fn by_unsigned(module: &Module<'_>, one: &Instruction<'_>) -> Option<Mutation> {
    let (component, count) = module.components(one.word(1));
    let Type::Int { signed: true } = module.ty(component) else { return None };
    let uint = module.type_id(Type::Int { signed: false })?;
    let mut builder = Builder::new(module);
    let ty = match count {
        1 => uint,
        _ => {
            let wanted = Type::Vector { component: uint, count };
            module.type_id(wanted).unwrap_or_else(|| {
                let id = builder.id();
                builder.declare(op::TYPE_VECTOR, &[id, uint, count]);
                id
            })
        }
    };
    let unsigned = builder.id();
    let code = vec![
        encoded(op::CONVERT_F_TO_U, &[ty, unsigned, one.word(3)]),
        encoded(op::BITCAST, &[one.word(1), one.word(2), unsigned]),
    ];
    builder.replace(one, code);
    let name = format!("%{} ConvertFToS becomes ConvertFToU", one.word(2));
    Some(Mutation { kind: Kind::Conversion, name, rewrite: builder.finish() })
}

/// A conversion of what another rounding has made an integer.
fn rounded(module: &Module<'_>, one: &Instruction<'_>, number: u32, name: &str) -> Option<Mutation> {
    let ty = module.type_of(one.word(3))?;
    let mut builder = Builder::new(module);
    let integer = builder.id();
    let mut converted = one.words.to_vec();
    converted[3] = integer;
    let code = vec![builder.extended(ty, integer, number, &[one.word(3)]), converted];
    builder.replace(one, code);
    let name = format!("%{} is converted after {name}", one.word(2));
    Some(Mutation { kind: Kind::Conversion, name, rewrite: builder.finish() })
}
