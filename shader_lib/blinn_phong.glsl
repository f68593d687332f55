// name: blinn_phong
// kind: specular
// equation: (87), (88), (89): H = (L + V) / |L + V|, I_spec = max(N.H, 0)^K_shi K_spec * L_spec
// source: textbook, section 10.1.3
// stability: the error does not grow with the exponent, as it does in the literal (89)
//
// The power is computed from |N - H|^2 / 2 = 1 - N.H, which keeps the digits that N.H loses near 1. Outside the
// model: L = -V has no half vector and no highlight; nor has a surface that the light does not reach (N.L <= 0).
// K_shi <= 0 yields the flat highlight 1.
#ifndef GLISTEN_BLINN_PHONG
#define GLISTEN_BLINN_PHONG
#include "safe.glsl"

// The half vector (87) of two unit vectors: a unit vector, or zero for L = -V. The closer L is to -V, the larger the
// effect of rounding L and V: about 6e-8 / |L + V|.
// bound: 2.4e-7 abs
vec3 halfVector(vec3 L, vec3 V)
{
    // The sum of two large vectors may overflow. Halving them first does not help: drivers turn 0.5 L + 0.5 V into
    // 0.5 (L + V).
    return safeNormalize(safeLimit(L + V));
}

// max(N.H, 0)^shininess: 0 to 1.
//   N  unit normal    L, V  unit vectors towards the light and the eye    shininess  K_shi, limited to >= 0
// bound: 3e-7 abs
float blinnPhongFactor(vec3 N, vec3 L, vec3 V, float shininess)
{
    return dot(N, L) > 0.0 ? safeCosPow(N, halfVector(L, V), shininess) : 0.0;
}

// Specular reflection (89), linear RGB.
//   N  unit normal    L, V  unit vectors towards the light and the eye    shininess  K_shi, limited to >= 0
//   Kspec  specular reflectance, 0 to 1    Lspec  intensity of the light, >= 0
// bound: 2.4e-7 color
vec3 blinnPhong(vec3 N, vec3 L, vec3 V, float shininess, vec3 Kspec, vec3 Lspec)
{
    return blinnPhongFactor(N, L, V, shininess) * safeLimit(Kspec * Lspec);
}

#endif
