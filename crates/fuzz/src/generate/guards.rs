//! Arguments for which the built-in functions are defined.
//!
//! *In:* a function and the number of an argument. *Out:* a pattern around the argument, or a constant. *Holds:* functions that the table does
//! not name here are defined for every number.

use super::types::Ty;
use glisten_front::hir::Scalar;

/// How an argument is passed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Guard {
    /// As it is.
    None,
    /// In a pattern.
    Pattern(&'static str),
    /// This constant, of the type.
    Constant(&'static str),
}

/// How an argument of a function is passed, by the name of the function, the number of the argument and its type.
pub(super) fn guard(name: &str, index: usize, count: usize, ty: &Ty) -> Guard {
    use Guard::{Constant, Pattern};
    let kind = |float, int, uint| match ty.scalar() {
        Some(Scalar::Int) => int,
        Some(Scalar::Uint) => uint,
        _ => float,
    };
    match (name, index) {
        ("asin" | "acos", 0) => Pattern("clamp(@, -0.875, 0.875)"),
        ("atanh", 0) => Pattern("clamp(@, -0.75, 0.75)"),
        ("acosh", 0) => Pattern("(abs(@) + 1.25)"),
        ("log" | "log2" | "inversesqrt", 0) | ("pow", 0) => Pattern("(abs(@) + 0.25)"),
        ("sqrt", 0) => Pattern("abs(@)"),
        ("pow", 1) | ("exp" | "exp2" | "sinh" | "cosh", 0) => Pattern("clamp(@, -3.0, 3.0)"),
        ("tan", 0) => Pattern("clamp(@, -1.25, 1.25)"),
        ("mod", 1) => Pattern("(abs(@) + 0.5)"),
        ("atan", 1) if count == 2 => Pattern("(abs(@) + 0.5)"),
        ("clamp", 1) => Constant(kind("-0.5", "-3", "2u")),
        ("clamp", 2) => Constant(kind("1.5", "7", "9u")),
        ("smoothstep", 0) => Constant("-1.0"),
        ("smoothstep", 1) => Constant("1.5"),
        ("ldexp", 1) => Pattern("clamp(@, -6, 6)"),
        ("frexp" | "modf", 0) => Pattern("clamp(@, -100.0, 100.0)"),
        // The sign of a sum of products that is 0 is that of the order in which they are added.
        ("floatBitsToInt" | "floatBitsToUint", 0) => Pattern("(clamp(@, -100.0, 100.0) + 0.0)"),
        ("packHalf2x16", 0) => Pattern("clamp(@, -1000.0, 1000.0)"),
        ("bitfieldExtract", 1) => Constant("3"),
        ("bitfieldExtract", 2) => Constant("7"),
        ("bitfieldInsert", 2) => Constant("4"),
        ("bitfieldInsert", 3) => Constant("9"),
        ("intBitsToFloat", 0) => Pattern("((@ & 0x007fffff) | 0x3f800000)"),
        ("uintBitsToFloat", 0) => Pattern("((@ & 0x007fffffu) | 0x3f800000u)"),
        ("refract", 2) => Pattern("clamp(@, 0.25, 1.5)"),
        _ => Guard::None,
    }
}

/// How an argument of a lookup is passed, by the name of the function and of the parameter.
pub(super) fn lookup_guard(name: &str, parameter: &str, ty: &Ty) -> Guard {
    use Guard::{Constant, Pattern};
    let is_float = ty.scalar() == Some(Scalar::Float);
    match parameter {
        "offset" => Constant("1"),
        "comp" => Constant("2"),
        "bias" => Constant("0.5"),
        "lod" if is_float => Pattern("clamp(@, 0.0, 1.5)"),
        "lod" | "sample" => Constant("0"),
        "dPdx" | "dPdy" => Pattern("clamp(@, -0.5, 0.5)"),
        "refZ" | "compare" => Pattern("clamp(@, 0.0, 1.0)"),
        _ if is_float => Pattern("clamp(@, 0.125, 2.5)"),
        // With its offset, it stays in a texture of two texels a side.
        _ if name.starts_with("texelFetch") && name.ends_with("Offset") => Pattern("(@ & 0)"),
        _ => Pattern("(@ & 1)"),
    }
}
