//! Geometric, matrix, vector relational, fragment, noise and geometry-shader functions (GLSL 1.50 §8.4 to §8.6, §8.8 to
//! §8.10).

use super::{Availability, BuiltinFunction, Effect, Parameter, Row, matcher, rows};
use crate::builtin::Stages;
use crate::language::{Extensions, NEVER, Since};

const G110: Row = Row::base("§8.4", 110);
/// §8.4 of 1.10 to 1.30 and of the compatibility profile.
const FIXED: Row = Row::base("GLSL 1.20 §8.4", 110)
    .with(Effect::None, false)
    .available(Availability { compatibility_only: true, ..Availability::since(110).es(NEVER).stages(Stages::VERTEX) });
const M110: Row = Row::base("§8.5", 110);
const M120: Row = Row::base("§8.5", 120);
const M140: Row = Row::base("§8.5", 140).available(Availability::since(140).es(300));
const M150: Row = Row::base("§8.5", 150).available(Availability::since(150).es(300));
const R110: Row = Row::base("§8.6", 110);
const R130: Row = Row::base("§8.6", 130);
/// Zero in a constant expression (§4.3.3).
const D110: Row = Row::base("§8.8", 110)
    .with(Effect::Derivative, true)
    .available(Availability::since(110).es(300).or(Extensions::STANDARD_DERIVATIVES).stages(Stages::FRAGMENT));
/// Derivatives of which the program says from which neighbors they are.
const FINE: Row = Row::base("GLSL 4.50 §8.14.1", 450)
    .with(Effect::Derivative, true)
    .available(Availability::from(Since::new(450, NEVER)).or(Extensions::DERIVATIVE_CONTROL).stages(Stages::FRAGMENT));
const N110: Row = Row::base("§8.9", 110).with(Effect::None, false).available(Availability::since(110).es(NEVER));
const EMIT: Row = Row::base("§8.10", 150)
    .with(Effect::Emits, false)
    .available(Availability::since(150).es(320).stages(Stages::GEOMETRY));

pub(super) static ROWS: &[Row] = rows! {
    G110 Length: float length(genType x);
    G110 Distance: float distance(genType p0, genType p1);
    G110 Dot: float dot(genType x, genType y);
    G110 Cross: vec3 cross(vec3 x, vec3 y);
    G110 Normalize: genType normalize(genType x);
    G110 Faceforward: genType faceforward(genType N, genType I, genType Nref);
    FIXED Ftransform: vec4 ftransform();
    G110 Reflect: genType reflect(genType I, genType N);
    G110 Refract: genType refract(genType I, genType N, float eta);

    M110 MatrixCompMult: mat matrixCompMult(mat x, mat y);
    M120 OuterProduct: mat2 outerProduct(vec2 c, vec2 r);
    M120 OuterProduct: mat3 outerProduct(vec3 c, vec3 r);
    M120 OuterProduct: mat4 outerProduct(vec4 c, vec4 r);
    M120 OuterProduct: mat2x3 outerProduct(vec3 c, vec2 r);
    M120 OuterProduct: mat3x2 outerProduct(vec2 c, vec3 r);
    M120 OuterProduct: mat2x4 outerProduct(vec4 c, vec2 r);
    M120 OuterProduct: mat4x2 outerProduct(vec2 c, vec4 r);
    M120 OuterProduct: mat3x4 outerProduct(vec4 c, vec3 r);
    M120 OuterProduct: mat4x3 outerProduct(vec3 c, vec4 r);
    M120 Transpose: mat2 transpose(mat2 m);
    M120 Transpose: mat3 transpose(mat3 m);
    M120 Transpose: mat4 transpose(mat4 m);
    M120 Transpose: mat2x3 transpose(mat3x2 m);
    M120 Transpose: mat3x2 transpose(mat2x3 m);
    M120 Transpose: mat2x4 transpose(mat4x2 m);
    M120 Transpose: mat4x2 transpose(mat2x4 m);
    M120 Transpose: mat3x4 transpose(mat4x3 m);
    M120 Transpose: mat4x3 transpose(mat3x4 m);
    M150 Determinant: float determinant(mat2 m);
    M150 Determinant: float determinant(mat3 m);
    M150 Determinant: float determinant(mat4 m);
    M140 Inverse: mat2 inverse(mat2 m);
    M140 Inverse: mat3 inverse(mat3 m);
    M140 Inverse: mat4 inverse(mat4 m);

    R110 LessThan: bvec lessThan(vec x, vec y);
    R110 LessThan: bvec lessThan(ivec x, ivec y);
    R130 LessThan: bvec lessThan(uvec x, uvec y);
    R110 LessThanEqual: bvec lessThanEqual(vec x, vec y);
    R110 LessThanEqual: bvec lessThanEqual(ivec x, ivec y);
    R130 LessThanEqual: bvec lessThanEqual(uvec x, uvec y);
    R110 GreaterThan: bvec greaterThan(vec x, vec y);
    R110 GreaterThan: bvec greaterThan(ivec x, ivec y);
    R130 GreaterThan: bvec greaterThan(uvec x, uvec y);
    R110 GreaterThanEqual: bvec greaterThanEqual(vec x, vec y);
    R110 GreaterThanEqual: bvec greaterThanEqual(ivec x, ivec y);
    R130 GreaterThanEqual: bvec greaterThanEqual(uvec x, uvec y);
    R110 Equal: bvec equal(vec x, vec y);
    R110 Equal: bvec equal(ivec x, ivec y);
    R130 Equal: bvec equal(uvec x, uvec y);
    R110 Equal: bvec equal(bvec x, bvec y);
    R110 NotEqual: bvec notEqual(vec x, vec y);
    R110 NotEqual: bvec notEqual(ivec x, ivec y);
    R130 NotEqual: bvec notEqual(uvec x, uvec y);
    R110 NotEqual: bvec notEqual(bvec x, bvec y);
    R110 Any: bool any(bvec x);
    R110 All: bool all(bvec x);
    R110 Not: bvec not(bvec x);

    D110 DFdx: genType dFdx(genType p);
    D110 DFdy: genType dFdy(genType p);
    D110 Fwidth: genType fwidth(genType p);

    FINE DFdxFine: genType dFdxFine(genType p);
    FINE DFdyFine: genType dFdyFine(genType p);
    FINE FwidthFine: genType fwidthFine(genType p);
    FINE DFdxCoarse: genType dFdxCoarse(genType p);
    FINE DFdyCoarse: genType dFdyCoarse(genType p);
    FINE FwidthCoarse: genType fwidthCoarse(genType p);

    N110 Noise1: float noise1(genType x);
    N110 Noise2: vec2 noise2(genType x);
    N110 Noise3: vec3 noise3(genType x);
    N110 Noise4: vec4 noise4(genType x);

    EMIT EmitVertex: void EmitVertex();
    EMIT EndPrimitive: void EndPrimitive();
};
