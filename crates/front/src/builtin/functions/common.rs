//! Angle, trigonometry, exponential and common functions (GLSL 1.50 §8.1 to §8.3), which work component by component; and the minima,
//! maxima and medians of three numbers of AMD_shader_trinary_minmax.

use super::{Availability, BuiltinFunction, Effect, Parameter, Row, matcher, rows};
use crate::language::Extensions;

const A110: Row = Row::base("§8.1", 110);
const A130: Row = Row::base("§8.1", 130);
const E110: Row = Row::base("§8.2", 110);
const C110: Row = Row::base("§8.3", 110);
const C130: Row = Row::base("§8.3", 130);
/// EXT_gpu_shader4 brings functions of integers, and `round`, to 1.10 and 1.20.
const SHADER4: Row = C130.available(C130.availability.or(Extensions::GPU_SHADER4));
const TRUNCATE: Row = Row {
    deprecated: true,
    ..Row::base("EXT_gpu_shader4", 110).available(Availability::extension(Extensions::GPU_SHADER4))
};
const AMD: Row =
    Row::base("AMD_shader_trinary_minmax", 110).available(Availability::extension(Extensions::SHADER_TRINARY_MINMAX));
const OUT130: Row = C130.with(Effect::WritesArgument, false);

pub(super) static ROWS: &[Row] = rows! {
    A110 Radians: genType radians(genType degrees);
    A110 Degrees: genType degrees(genType radians);
    A110 Sin: genType sin(genType angle);
    A110 Cos: genType cos(genType angle);
    A110 Tan: genType tan(genType angle);
    A110 Asin: genType asin(genType x);
    A110 Acos: genType acos(genType x);
    A110 Atan: genType atan(genType y, genType x);
    A110 Atan: genType atan(genType y_over_x);
    A130 Sinh: genType sinh(genType x);
    A130 Cosh: genType cosh(genType x);
    A130 Tanh: genType tanh(genType x);
    A130 Asinh: genType asinh(genType x);
    A130 Acosh: genType acosh(genType x);
    A130 Atanh: genType atanh(genType x);

    E110 Pow: genType pow(genType x, genType y);
    E110 Exp: genType exp(genType x);
    E110 Log: genType log(genType x);
    E110 Exp2: genType exp2(genType x);
    E110 Log2: genType log2(genType x);
    E110 Sqrt: genType sqrt(genType x);
    E110 Inversesqrt: genType inversesqrt(genType x);

    C110 Abs: genType abs(genType x);
    SHADER4 Abs: genIType abs(genIType x);
    C110 Sign: genType sign(genType x);
    SHADER4 Sign: genIType sign(genIType x);
    C110 Floor: genType floor(genType x);
    C130 Trunc: genType trunc(genType x);
    TRUNCATE Trunc: genType truncate(genType x);
    SHADER4 Round: genType round(genType x);
    C130 RoundEven: genType roundEven(genType x);
    C110 Ceil: genType ceil(genType x);
    C110 Fract: genType fract(genType x);
    C110 Mod: genType mod(genType x, float y);
    C110 Mod: genType mod(genType x, genType y);
    OUT130 Modf: genType modf(genType x, out_genType i);
    C110 Min: genType min(genType x, genType y);
    C110 Min: genType min(genType x, float y);
    SHADER4 Min: genIType min(genIType x, genIType y);
    SHADER4 Min: genIType min(genIType x, int y);
    SHADER4 Min: genUType min(genUType x, genUType y);
    SHADER4 Min: genUType min(genUType x, uint y);
    C110 Max: genType max(genType x, genType y);
    C110 Max: genType max(genType x, float y);
    SHADER4 Max: genIType max(genIType x, genIType y);
    SHADER4 Max: genIType max(genIType x, int y);
    SHADER4 Max: genUType max(genUType x, genUType y);
    SHADER4 Max: genUType max(genUType x, uint y);
    AMD Min3: genType min3(genType x, genType y, genType z);
    AMD Min3: genIType min3(genIType x, genIType y, genIType z);
    AMD Min3: genUType min3(genUType x, genUType y, genUType z);
    AMD Max3: genType max3(genType x, genType y, genType z);
    AMD Max3: genIType max3(genIType x, genIType y, genIType z);
    AMD Max3: genUType max3(genUType x, genUType y, genUType z);
    AMD Mid3: genType mid3(genType x, genType y, genType z);
    AMD Mid3: genIType mid3(genIType x, genIType y, genIType z);
    AMD Mid3: genUType mid3(genUType x, genUType y, genUType z);
    C110 Clamp: genType clamp(genType x, genType minVal, genType maxVal);
    C110 Clamp: genType clamp(genType x, float minVal, float maxVal);
    SHADER4 Clamp: genIType clamp(genIType x, genIType minVal, genIType maxVal);
    SHADER4 Clamp: genIType clamp(genIType x, int minVal, int maxVal);
    SHADER4 Clamp: genUType clamp(genUType x, genUType minVal, genUType maxVal);
    SHADER4 Clamp: genUType clamp(genUType x, uint minVal, uint maxVal);
    C110 Mix: genType mix(genType x, genType y, genType a);
    C110 Mix: genType mix(genType x, genType y, float a);
    C130 Mix: genType mix(genType x, genType y, genBType a);
    C110 Step: genType step(genType edge, genType x);
    C110 Step: genType step(float edge, genType x);
    C110 Smoothstep: genType smoothstep(genType edge0, genType edge1, genType x);
    C110 Smoothstep: genType smoothstep(float edge0, float edge1, genType x);
    C130 Isnan: genBType isnan(genType x);
    C130 Isinf: genBType isinf(genType x);
};
