// name: specular_lut
// kind: specular
// equation: texture(u), u = N.H or N.L
// source: article, program `texspec` and the metal variant
//
// The highlight drawn into a texture, so that it may have any profile. Build the texture with texel i = f(i / (n - 1))
// and let the sampler clamp; the coordinate below then meets texel centers at both ends, which costs the linear filter
// nothing (the plain coordinate costs it half a texel everywhere).
#ifndef GLISTEN_SPECULAR_LUT
#define GLISTEN_SPECULAR_LUT
#include "blinn_phong.glsl"

// The coordinate at which a table of n texels holds the value for x in [0, 1].
float lutCoordinate(float x, float n)
{
    return (safeUnit(x) * (n - 1.0) + 0.5) / n;
}

// Table look-up by the angle between half vector and normal.
vec3 specularLutHalf(sampler2D table, vec3 N, vec3 L, vec3 V)
{
    float u = lutCoordinate(dot(N, halfVector(L, V)), float(textureSize(table, 0).x));
    return texture(table, vec2(u, 0.5)).rgb;
}

// Table look-up by the angle between light and normal (the article's register c0 holding the light's direction).
vec3 specularLutLight(sampler2D table, vec3 N, vec3 L)
{
    float u = lutCoordinate(dot(N, L), float(textureSize(table, 0).x));
    return texture(table, vec2(u, 0.5)).rgb;
}

#endif
