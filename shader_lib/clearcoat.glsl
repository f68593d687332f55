// name: clearcoat
// kind: specular
// equation: (1 - w) base + w f, w = strength (0.04 + 0.96 (1 - N.V)^5), f by `ggx` without its Fresnel term
// source: KHR_materials_clearcoat, Khronos 2020
// stability: that of `ggx`; the mix cannot overshoot its two sides
//
// A thin layer of lacquer over any other reflection: what it mirrors is missing below.
#ifndef GLISTEN_CLEARCOAT
#define GLISTEN_CLEARCOAT
#include "ggx.glsl"

// The part of the light that the coat mirrors: 0 to strength.
//   N, V  unit normal, unit vector towards the eye    strength  limited to [0, 1]
// bound: 3e-7 abs
float clearcoatWeight(vec3 N, vec3 V, float strength)
{
    return safeUnit(strength) * fresnelSchlick(abs(dot(N, V)), vec3(1.0 / 25.0), vec3(1.0)).x;
}

// A reflection under a coat of lacquer, linear RGB.
//   base  the reflection of the light without the coat, >= 0    N  unit normal    L, V  unit vectors
//   strength  limited to [0, 1]    alpha  of the coat, limited to [2^-20, 1]    Lspec  intensity of the light, >= 0
// bound: 4e-6 size, the sum of two reflections with dozens of roundings
vec3 clearcoat(vec3 base, vec3 N, vec3 L, vec3 V, float strength, float alpha, vec3 Lspec)
{
    float w = clearcoatWeight(N, V, strength);
    return safeLimit((1.0 - w) * base + safeLimit(w * ggxFactor(N, L, V, alpha) * Lspec));
}

#endif
