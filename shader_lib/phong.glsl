// name: phong
// kind: specular
// equation: (84), (85), (86): R = 2 (N.L) N - L, I_spec = max(R.V, 0)^K_shi K_spec * L_spec
// source: textbook, section 10.1.3
//
// Outside the model: without light on the surface (N.L <= 0) there is no highlight, although the literal (86) would
// light a surface from behind. K_shi <= 0 gives the flat highlight 1.
#ifndef GLISTEN_PHONG
#define GLISTEN_PHONG
#include "safe.glsl"

// The mirror direction (84) of the unit vector L about the unit normal N.
vec3 mirrorDirection(vec3 N, vec3 L)
{
    return 2.0 * dot(N, L) * N - L;
}

// max(R.V, 0)^shininess: 0 to 1.
//   N  unit normal    L, V  unit vectors towards the light and the eye
float phongFactor(vec3 N, vec3 L, vec3 V, float shininess)
{
    if (!(dot(N, L) > 0.0))
        return 0.0;
    vec3 R = mirrorDirection(N, L);
    if (!(dot(R, V) > 0.0))
        return shininess > 0.0 ? 0.0 : 1.0;
    return safePowOneMinus(safeOneMinusCos(R, V), shininess);
}

// Specular reflection (86), linear RGB.
//   Kspec  specular reflectance, 0 to 1    Lspec  intensity of the light
vec3 phong(vec3 N, vec3 L, vec3 V, float shininess, vec3 Kspec, vec3 Lspec)
{
    return phongFactor(N, L, V, shininess) * Kspec * Lspec;
}

#endif
