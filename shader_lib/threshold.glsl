// name: threshold
// kind: specular
// equation: (91): ceil(max(N.H, 0) - t) K_spec * L_spec
// source: textbook, section 10.1.4
// stability: a step: within rounding of the threshold (about 2e-7), either value is possible
//
// A highlight with a sharp edge. The ceiling is meant as a step from 0 to 1; literally it yields -1 at N.H = 0, t =
// 1, and 2 where rounding makes N.H larger than 1.
#ifndef GLISTEN_THRESHOLD
#define GLISTEN_THRESHOLD
#include "blinn_phong.glsl"

// 1 where the cosine c is above the threshold t, else 0.
//   c  limited to [0, 1]    t  0 to 1; from 1 on there is no highlight, below 0 it is everywhere
// bound: 2.4e-7 abs
float thresholdStep(float c, float t)
{
    return safeUnit(c) > t ? 1.0 : 0.0;
}

// (91) without its colors: 0 or 1. 0 where the light does not reach the surface (N.L <= 0).
//   N  unit normal    L, V  unit vectors towards the light and the eye    t  the threshold
// bound: 2.4e-7 abs
float thresholdFactor(vec3 N, vec3 L, vec3 V, float t)
{
    return dot(N, L) > 0.0 ? thresholdStep(dot(N, halfVector(L, V)), t) : 0.0;
}

// Specular reflection (91), linear RGB.
//   Kspec  specular reflectance, 0 to 1    Lspec  intensity of the light, >= 0
// bound: 2.4e-7 color
vec3 threshold(vec3 N, vec3 L, vec3 V, float t, vec3 Kspec, vec3 Lspec)
{
    return thresholdFactor(N, L, V, t) * safeLimit(Kspec * Lspec);
}

#endif
