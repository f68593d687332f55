// name: specular_lut
// kind: specular
// equation: table(U), U = N.H or N.L
// source: article, program `texspec` and the metal variant
// stability: as good as its table: the error of a linear filter over x^k is (k / n)^2 / 8, that of 8 bits 1/255
//
// The highlight as a texture, so that it may have any profile: x^k, or the blotches that look like metal. `lut` says
// how to fill the table. specularLutHalf() has the gate N.L > 0 of the computed highlights: the half vector may well be
// before a surface that the light is behind, so a table that is 0 at its first texel does not do the same.
#ifndef GLISTEN_SPECULAR_LUT
#define GLISTEN_SPECULAR_LUT
#include "blinn_phong.glsl"
#include "lut.glsl"

// The table's color for the angle between half vector and normal; 0 where the light does not reach the surface (N.L <=
// 0).
//   table  n by 1 texels, clamped    N  unit normal    L, V  unit vectors towards the light and the eye
// bound: 2e-6 abs
vec3 specularLutHalf(sampler2D table, vec3 N, vec3 L, vec3 V)
{
    // The look-up comes first: its derivatives need all fragments.
    vec3 gloss = lutColor(table, dot(N, halfVector(L, V)));
    return dot(N, L) > 0.0 ? gloss : vec3(0.0);
}

// The table's color for the angle between light and normal: the article's dp3 with a register that contains the
// light's direction (or any other fixed vector).
//   table  n by 1 texels, clamped    N  unit normal    L  unit vector
// bound: 7e-7 abs
vec3 specularLutLight(sampler2D table, vec3 N, vec3 L)
{
    return lutColor(table, dot(N, L));
}

#endif
