// name: phong
// kind: specular
// equation: (84), (85), (86): R = 2 (N.L) N - L, I_spec = max(R.V, 0)^K_shi K_spec * L_spec
// source: textbook, section 10.1.3
// stability: the error does not grow with the exponent, as it does in the literal (86)
//
// Outside the model: a surface that the light does not reach (N.L <= 0) has no highlight, although the literal (86)
// would light it from behind. K_shi <= 0 yields the flat highlight 1.
#ifndef GLISTEN_PHONG
#define GLISTEN_PHONG
#include "safe.glsl"

// The mirror direction (84) of the unit vector L about the unit normal N: a unit vector.
// bound: 2.4e-7 abs
vec3 mirrorDirection(vec3 N, vec3 L)
{
    return safeFinite(2.0 * dot(N, L) * N - L);
}

// max(R.V, 0)^shininess: 0 to 1.
//   N  unit normal    L, V  unit vectors towards the light and the eye    shininess  K_shi, limited to >= 0
// bound: 2.4e-7 abs
float phongFactor(vec3 N, vec3 L, vec3 V, float shininess)
{
    return dot(N, L) > 0.0 ? safeCosPow(mirrorDirection(N, L), V, shininess) : 0.0;
}

// Specular reflection (86), linear RGB.
//   N  unit normal    L, V  unit vectors towards the light and the eye    shininess  K_shi, limited to >= 0
//   Kspec  specular reflectance, 0 to 1    Lspec  intensity of the light, >= 0
// bound: 2.4e-7 color
vec3 phong(vec3 N, vec3 L, vec3 V, float shininess, vec3 Kspec, vec3 Lspec)
{
    return phongFactor(N, L, V, shininess) * safeLimit(Kspec * Lspec);
}

#endif
