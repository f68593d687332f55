//! Each built-in function and variable in one sentence, with its equation (GLSL 1.50 §7, §8; later ones from 4.60).
//!
//! *In:* a name. *Out:* a sentence for people. *Holds:* names of texture lookups that differ in the sampler alone share a row, which
//! is found by the end of the name.

/// The sentences of names.
static SENTENCES: &[(&str, &str)] = &[
    ("radians", "Degrees to radians: π / 180 · degrees."),
    ("degrees", "Radians to degrees: 180 / π · radians."),
    ("sin", "The sine of an angle in radians."),
    ("cos", "The cosine of an angle in radians."),
    ("tan", "The tangent of an angle in radians."),
    ("asin", "The angle in [-π/2, π/2] whose sine is x; undefined if |x| > 1."),
    ("acos", "The angle in [0, π] whose cosine is x; undefined if |x| > 1."),
    (
        "atan",
        "The angle whose tangent is y / x: in [-π, π] with two arguments, undefined if both are 0; in [-π/2, π/2] with one.",
    ),
    ("sinh", "The hyperbolic sine: (eˣ - e⁻ˣ) / 2."),
    ("cosh", "The hyperbolic cosine: (eˣ + e⁻ˣ) / 2."),
    ("tanh", "The hyperbolic tangent: sinh(x) / cosh(x)."),
    ("asinh", "The inverse of sinh."),
    ("acosh", "The inverse of cosh that is not negative; undefined if x < 1."),
    ("atanh", "The inverse of tanh; undefined if |x| ≥ 1."),
    ("pow", "x to the power y; undefined if x < 0, or if x = 0 and y ≤ 0."),
    ("exp", "eˣ."),
    ("log", "The natural logarithm; undefined if x ≤ 0."),
    ("exp2", "2ˣ."),
    ("log2", "The logarithm to base 2; undefined if x ≤ 0."),
    ("sqrt", "The square root; undefined if x < 0."),
    ("inversesqrt", "1 / √x; undefined if x ≤ 0."),
    ("abs", "x if x ≥ 0, otherwise -x."),
    ("sign", "1, 0 or -1, as x is positive, zero or negative."),
    ("floor", "The greatest integer that is at most x."),
    ("truncate", "The integer next to x towards 0."),
    ("trunc", "The integer next to x towards 0."),
    ("round", "The nearest integer; a fraction of 0.5 goes either way, as is fastest."),
    ("roundEven", "The nearest integer; a fraction of 0.5 goes to the even one."),
    ("ceil", "The least integer that is at least x."),
    ("fract", "x - floor(x)."),
    ("mod", "x - y · floor(x / y): it has the sign of y."),
    ("modf", "The fraction of x; the whole part goes to the second argument. Both have the sign of x."),
    ("min", "y if y < x, otherwise x."),
    ("max", "y if x < y, otherwise x."),
    ("min3", "The smallest of x, y and z."),
    ("max3", "The largest of x, y and z."),
    ("mid3", "The second of x, y and z in their order."),
    ("clamp", "min(max(x, minVal), maxVal); undefined if minVal > maxVal."),
    ("mix", "x · (1 - a) + y · a; with a boolean, y where it is true and x elsewhere."),
    ("step", "0 if x < edge, otherwise 1."),
    ("smoothstep", "t² · (3 - 2t) with t = clamp((x - edge0) / (edge1 - edge0), 0, 1); undefined if edge0 ≥ edge1."),
    ("isnan", "Whether x is no number."),
    ("isinf", "Whether x is infinite."),
    ("fma", "a · b + c, rounded once if the result is `precise`."),
    (
        "frexp",
        "The significand in [0.5, 1) of x; the exponent goes to the second argument: x = significand · 2^exponent.",
    ),
    ("ldexp", "x · 2^exp."),
    ("floatBitsToInt", "The bits of a float as an integer."),
    ("floatBitsToUint", "The bits of a float as an unsigned integer."),
    ("intBitsToFloat", "The float with these bits."),
    ("uintBitsToFloat", "The float with these bits."),
    ("length", "The length of a vector: √(x · x)."),
    ("distance", "The distance of two points: length(p0 - p1)."),
    ("dot", "The dot product: x₀y₀ + x₁y₁ + ..."),
    ("cross", "The cross product: (x₁y₂ - y₁x₂, x₂y₀ - y₂x₀, x₀y₁ - y₀x₁)."),
    ("normalize", "The vector of length 1 in the same direction; undefined for the zero vector."),
    (
        "ftransform",
        "The position as the fixed-function pipeline computes it: gl_ModelViewProjectionMatrix · gl_Vertex.",
    ),
    ("faceforward", "N if dot(Nref, I) < 0, otherwise -N."),
    ("reflect", "The direction of reflection: I - 2 · dot(N, I) · N, with N of length 1."),
    ("refract", "The direction of refraction by Snell's law for the ratio eta; zero if all light is reflected."),
    ("matrixCompMult", "The product of two matrices component by component."),
    ("outerProduct", "The matrix c · rᵀ."),
    ("transpose", "The transposed matrix."),
    ("determinant", "The determinant."),
    ("inverse", "The inverse matrix; undefined if the determinant is 0 or nearly so."),
    ("lessThan", "x < y, component by component."),
    ("lessThanEqual", "x ≤ y, component by component."),
    ("greaterThan", "x > y, component by component."),
    ("greaterThanEqual", "x ≥ y, component by component."),
    ("equal", "x = y, component by component."),
    ("notEqual", "x ≠ y, component by component."),
    ("any", "Whether any component is true."),
    ("all", "Whether all components are true."),
    ("not", "The opposite of each component."),
    ("bitCount", "The number of bits that are 1."),
    ("bitfieldExtract", "The bits from `offset` on, `bits` of them, extended by their sign if they have one."),
    ("bitfieldInsert", "`base` with `bits` bits from `offset` on replaced by those of `insert`."),
    ("bitfieldReverse", "The bits in the opposite order."),
    ("findLSB", "The number of the least bit that is 1; -1 for 0."),
    ("findMSB", "The number of the greatest bit that is 1, of a negative number that is 0; -1 if there is none."),
    ("uaddCarry", "The sum modulo 2³²; the carry goes to the third argument."),
    ("usubBorrow", "The difference modulo 2³²; the borrow goes to the third argument."),
    ("umulExtended", "The product of 64 bits, in two halves."),
    ("imulExtended", "The product of 64 bits, in two halves."),
    ("packHalf2x16", "Two floats as halves in one integer, the first in the low bits."),
    ("unpackHalf2x16", "Two floats from the halves of an integer."),
    ("packUnorm2x16", "Two floats of [0, 1] in 16 bits each: round(clamp(c, 0, 1) · 65535)."),
    ("packSnorm2x16", "Two floats of [-1, 1] in 16 bits each: round(clamp(c, -1, 1) · 32767)."),
    ("packUnorm4x8", "Four floats of [0, 1] in 8 bits each: round(clamp(c, 0, 1) · 255)."),
    ("packSnorm4x8", "Four floats of [-1, 1] in 8 bits each: round(clamp(c, -1, 1) · 127)."),
    ("unpackUnorm2x16", "Two floats of [0, 1]: f / 65535."),
    ("unpackSnorm2x16", "Two floats of [-1, 1]: clamp(f / 32767, -1, 1)."),
    ("unpackUnorm4x8", "Four floats of [0, 1]: f / 255."),
    ("unpackSnorm4x8", "Four floats of [-1, 1]: clamp(f / 127, -1, 1)."),
    (
        "dFdx",
        "The derivative along the window's x, from neighboring fragments; undefined where they take other branches.",
    ),
    (
        "dFdy",
        "The derivative along the window's y, from neighboring fragments; undefined where they take other branches.",
    ),
    ("fwidth", "|dFdx(p)| + |dFdy(p)|."),
    ("dFdxCoarse", "The derivative along x, perhaps one for all four fragments of a quad."),
    ("dFdyCoarse", "The derivative along y, perhaps one for all four fragments of a quad."),
    ("dFdxFine", "The derivative along x, from the fragment and its neighbor."),
    ("dFdyFine", "The derivative along y, from the fragment and its neighbor."),
    ("fwidthCoarse", "|dFdxCoarse(p)| + |dFdyCoarse(p)|."),
    ("fwidthFine", "|dFdxFine(p)| + |dFdyFine(p)|."),
    ("noise1", "One value of noise; implementations return 0."),
    ("noise2", "Two values of noise; implementations return 0."),
    ("noise3", "Three values of noise; implementations return 0."),
    ("noise4", "Four values of noise; implementations return 0."),
    ("EmitVertex", "Emits a vertex with the current values of the outputs, which are undefined afterwards."),
    ("EndPrimitive", "Ends the current primitive and begins the next one."),
    ("gl_Position", "The position of the vertex in clip space."),
    ("gl_PointSize", "The size of a point in pixels."),
    ("gl_ClipDistance", "The distances to clip planes of the shader: what is negative is cut off."),
    ("gl_VertexID", "The index of the vertex."),
    ("gl_InstanceID", "The number of the instance, from 0."),
    ("gl_InstanceIDARB", "The number of the instance, from 0."),
    ("gl_InvocationID", "The number of the invocation for this primitive."),
    ("gl_PrimitiveIDIn", "The number of the input primitive, from 0."),
    ("gl_PrimitiveID", "The number of the primitive, from 0."),
    ("gl_Layer", "The layer of the framebuffer to draw to."),
    ("gl_in", "The built-in outputs of the vertex stage, for each vertex of the primitive."),
    (
        "gl_FragCoord",
        "The position of the fragment in the window: x and y of its center, the depth, and 1 / w. The origin is at the lower left.",
    ),
    ("gl_FrontFacing", "Whether the fragment is of a primitive that faces the viewer."),
    ("gl_PointCoord", "The place in a point, from (0, 0) at the upper left to (1, 1)."),
    (
        "gl_FragDepth",
        "The depth of the fragment, in [0, 1]; a shader that writes it anywhere must write it everywhere.",
    ),
    ("gl_FragDepthEXT", "The depth of the fragment, in [0, 1]."),
    ("gl_FragColor", "The color of the fragment, for all color buffers."),
    ("gl_FragData", "The colors of the fragment, one for each color buffer."),
    ("gl_SampleID", "The number of the sample that the shader runs for."),
    ("gl_SampleMaskIn", "The samples that the primitive covers, as bits."),
    ("gl_DepthRange", "The range of depths in the window: near, far and far - near."),
    (
        "textureSize",
        "The size of a level of the texture in texels; the last component is the number of layers of an array.",
    ),
    ("textureQueryLod", "The level of detail that a lookup would use: after clamping, and before."),
    ("textureQueryLOD", "The level of detail that a lookup would use: after clamping, and before."),
    ("textureQueryLevels", "The number of levels of the texture."),
    (
        "textureGather",
        "One component of the four texels that a linear filter would use, from the lower left clockwise from above: (i₀j₁, i₁j₁, i₁j₀, i₀j₀).",
    ),
    ("textureGatherOffset", "As `textureGather`, with an offset in texels."),
    ("textureGatherOffsets", "As `textureGather`, with an offset in texels for each of the four."),
];

/// Sentences for texture lookups by the parts of their names, the first that fits.
static LOOKUPS: &[(&str, &str)] = &[
    ("texelFetch", "One texel by its integer coordinates, without filtering; undefined outside of the texture."),
    ("textureSize", "The size of a level of the texture in texels."),
    ("ProjGrad", "A lookup at P divided by its last component, with these derivatives instead of the implicit ones."),
    ("ProjLod", "A lookup at P divided by its last component, at this level of detail."),
    ("Proj", "A lookup at P divided by its last component."),
    ("Grad", "A lookup with these derivatives instead of the implicit ones."),
    ("Lod", "A lookup at this level of detail."),
    ("Offset", "A lookup with an offset in texels, which is a constant."),
    ("shadow", "A comparison with the depth in a texture: the share of texels that pass, as a color."),
    (
        "texture",
        "A filtered lookup; in a fragment shader the level of detail follows from the derivatives of P. The last component of P for a shadow sampler is what is compared.",
    ),
];

/// The sentence of a built-in function or variable.
pub fn sentence(name: &str) -> Option<&'static str> {
    let own = SENTENCES.iter().find(|row| row.0 == name);
    let lookup = || {
        let is_lookup = ["texture", "texelFetch", "shadow"].iter().any(|start| name.starts_with(start));
        LOOKUPS.iter().find(|row| is_lookup && name.contains(row.0))
    };
    own.or_else(lookup).map(|row| row.1)
}

#[cfg(test)]
mod tests {
    use super::{SENTENCES, sentence};
    use crate::builtin::{functions, variables};

    #[test]
    fn every_function_and_variable_has_a_sentence() {
        let lacks: Vec<&str> = functions::names().filter(|name| sentence(name).is_none()).collect();
        assert!(lacks.is_empty(), "{lacks:?}");
        let lacks: Vec<&str> =
            variables::VARIABLES.iter().map(|row| row.name).filter(|name| sentence(name).is_none()).collect();
        assert!(lacks.is_empty(), "{lacks:?}");
        for (name, _) in SENTENCES {
            let is_known = !functions::named(name).is_empty() || variables::stages_with(name).next().is_some();
            assert!(is_known, "{name}");
        }
    }
}
