// name: lut
// kind: helper
// equation: U = (x (n - 1) + 0.5) / n
// source: article, "texture maps revisited"
// stability: finite for every finite input and table
//
// Functions of one number, stored in a texture with one row of n texels. Let texel i contain f(i / (n - 1)), and let
// the sampler clamp: with these coordinates, x = 0 and x = 1 are the centers of the first and the last texel. The
// plain coordinate U = x is off by half a texel at both ends, which cancels the gain of a linear filter.
#ifndef GLISTEN_LUT
#define GLISTEN_LUT
#include "safe.glsl"

// The coordinate at which a table of n texels contains the value for x.
//   x  limited to [0, 1]    n  limited to n >= 1
// bound: 2.4e-7 abs
float lutCoordinate(float x, float n)
{
    n = max(n, 1.0);
    return (safeUnit(x) * (n - 1.0) + 0.5) / n;
}

// The color that a table contains for x, limited to [0, 1]. The linear filter differs from f by about f'' / (8 n^2);
// for f = x^k by (k / n)^2 / 8.
// bound: 2.4e-7 abs
vec3 lutColor(sampler2D table, float x)
{
    return texture(table, vec2(lutCoordinate(x, float(textureSize(table, 0).x)), 0.5)).rgb;
}

#endif
