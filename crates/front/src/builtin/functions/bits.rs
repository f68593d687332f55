//! Functions of the bits of numbers, and fused ones: §8.3 of 3.30 (bit casts), §8.3, §8.4 and §8.8 of 4.00 to 4.20.
//!
//! ES 3.00 has the bit casts and the 16-bit packings; ES 3.10 the rest.

use super::{Availability, BuiltinFunction, Effect, Parameter, Row, matcher, rows};
use crate::language::{Extensions, Since};

const CAST: Extensions = Extensions::SHADER_BIT_ENCODING.union(Extensions::GPU_SHADER5);
const PACKS: Extensions = Extensions::SHADING_LANGUAGE_PACKING;
const PACKS4: Extensions = PACKS.union(Extensions::GPU_SHADER5);

const fn from(section: &'static str, desktop: u16, es: u16, extensions: Extensions) -> Row {
    Row::base(section, desktop).available(Availability::from(Since::new(desktop, es)).or(extensions))
}

const B330: Row = from("GLSL 3.30 §8.3", 330, 300, CAST);
const F400: Row = from("GLSL 4.00 §8.3", 400, 320, Extensions::GPU_SHADER5);
const F310: Row = from("GLSL 4.00 §8.3", 400, 310, Extensions::GPU_SHADER5);
const I400: Row = from("GLSL 4.00 §8.8", 400, 310, Extensions::GPU_SHADER5);
const P400: Row = from("GLSL 4.00 §8.4", 400, 310, PACKS4);
const U400: Row = from("GLSL 4.10 §8.4", 400, 300, PACKS4);
const S420: Row = from("GLSL 4.20 §8.4", 420, 300, PACKS);
const M450: Row = from("GLSL 4.50 §8.3", 450, 310, Extensions::SHADER_INTEGER_MIX);
const W310: Row = Row { effect: Effect::WritesArgument, constant: false, ..F310 };
const WI400: Row = Row { effect: Effect::WritesArgument, constant: false, ..I400 };

pub(super) static ROWS: &[Row] = rows! {
    B330 FloatBitsToInt: genIType floatBitsToInt(genType value);
    B330 FloatBitsToUint: genUType floatBitsToUint(genType value);
    B330 IntBitsToFloat: genType intBitsToFloat(genIType value);
    B330 UintBitsToFloat: genType uintBitsToFloat(genUType value);
    F400 Fma: genType fma(genType a, genType b, genType c);
    W310 Frexp: genType frexp(genType x, out_genIType exp);
    F310 Ldexp: genType ldexp(genType x, genIType exp);
    M450 Mix: genIType mix(genIType x, genIType y, genBType a);
    M450 Mix: genUType mix(genUType x, genUType y, genBType a);
    M450 Mix: genBType mix(genBType x, genBType y, genBType a);

    U400 PackUnorm2x16: uint packUnorm2x16(vec2 v);
    S420 PackSnorm2x16: uint packSnorm2x16(vec2 v);
    P400 PackUnorm4x8: uint packUnorm4x8(vec4 v);
    P400 PackSnorm4x8: uint packSnorm4x8(vec4 v);
    S420 PackHalf2x16: uint packHalf2x16(vec2 v);
    U400 UnpackUnorm2x16: vec2 unpackUnorm2x16(uint p);
    S420 UnpackSnorm2x16: vec2 unpackSnorm2x16(uint p);
    P400 UnpackUnorm4x8: vec4 unpackUnorm4x8(uint p);
    P400 UnpackSnorm4x8: vec4 unpackSnorm4x8(uint p);
    S420 UnpackHalf2x16: vec2 unpackHalf2x16(uint v);

    WI400 UaddCarry: genUType uaddCarry(genUType x, genUType y, out_genUType carry);
    WI400 UsubBorrow: genUType usubBorrow(genUType x, genUType y, out_genUType borrow);
    WI400 UmulExtended: void umulExtended(genUType x, genUType y, out_genUType msb, out_genUType lsb);
    WI400 ImulExtended: void imulExtended(genIType x, genIType y, out_genIType msb, out_genIType lsb);
    I400 BitfieldExtract: genIType bitfieldExtract(genIType value, int offset, int bits);
    I400 BitfieldExtract: genUType bitfieldExtract(genUType value, int offset, int bits);
    I400 BitfieldInsert: genIType bitfieldInsert(genIType base, genIType insert, int offset, int bits);
    I400 BitfieldInsert: genUType bitfieldInsert(genUType base, genUType insert, int offset, int bits);
    I400 BitfieldReverse: genIType bitfieldReverse(genIType value);
    I400 BitfieldReverse: genUType bitfieldReverse(genUType value);
    I400 BitCount: genIType bitCount(genIType value);
    I400 BitCount: genIType bitCount(genUType value);
    I400 FindLsb: genIType findLSB(genIType value);
    I400 FindLsb: genIType findLSB(genUType value);
    I400 FindMsb: genIType findMSB(genIType value);
    I400 FindMsb: genIType findMSB(genUType value);
};
