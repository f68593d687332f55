// name: blinn_phong
// kind: specular
// equation: (87), (88), (89): H = (L + V) / |L + V|, I_spec = max(N.H, 0)^K_shi K_spec * L_spec
// source: textbook, section 10.1.3
//
// The cosine is taken from |N - H|^2 / 2 = 1 - N.H, which keeps the digits that N.H loses near 1: the error no longer
// grows with the exponent. Outside the model: L = -V has no half vector and no highlight; nor has a
// surface that the light does not reach (N.L <= 0).
#ifndef GLISTEN_BLINN_PHONG
#define GLISTEN_BLINN_PHONG
#include "safe.glsl"

// The half vector (87) of two unit vectors; zero for L = -V.
vec3 halfVector(vec3 L, vec3 V)
{
    return safeNormalize(L + V);
}

// max(N.H, 0)^shininess: 0 to 1.
//   N  unit normal    L, V  unit vectors towards the light and the eye
float blinnPhongFactor(vec3 N, vec3 L, vec3 V, float shininess)
{
    if (!(dot(N, L) > 0.0))
        return 0.0;
    vec3 H = halfVector(L, V);
    if (!(dot(N, H) > 0.0))
        return shininess > 0.0 ? 0.0 : 1.0;
    return safePowOneMinus(safeOneMinusCos(N, H), shininess);
}

// Specular reflection (89), linear RGB.
//   Kspec  specular reflectance, 0 to 1    Lspec  intensity of the light
vec3 blinnPhong(vec3 N, vec3 L, vec3 V, float shininess, vec3 Kspec, vec3 Lspec)
{
    return blinnPhongFactor(N, L, V, shininess) * Kspec * Lspec;
}

#endif
