// name: lambert
// kind: diffuse
// equation: (82), (83): I_diff = max(N.L, 0) K_diff * L_diff
// source: textbook, section 10.1.3
// stability: finite for every finite input; the sign of a grazing N.L is that of its rounding
#ifndef GLISTEN_LAMBERT
#define GLISTEN_LAMBERT
#include "safe.glsl"

// The cosine of the angle of incidence, max(N.L, 0): 0 to 1 for unit vectors, 0 for light from behind.
//   N  unit normal    L  unit vector towards the light
// bound: 2.4e-7 abs
float lambertFactor(vec3 N, vec3 L)
{
    return safePositive(dot(N, L));
}

// Diffuse reflection (83), linear RGB.
//   N  unit normal    L  unit vector towards the light
//   Kdiff  diffuse reflectance of the material, 0 to 1    Ldiff  intensity of the light, >= 0
// bound: 2.4e-7 rel
vec3 lambert(vec3 N, vec3 L, vec3 Kdiff, vec3 Ldiff)
{
    return safeLimit(lambertFactor(N, L) * safeLimit(Kdiff * Ldiff));
}

// Diffuse reflection without the limit at 0 (82), linear RGB: negative where the light comes from behind, for surfaces that
// let it through. Arguments as above.
// bound: 2.4e-7 rel
vec3 lambertUnclamped(vec3 N, vec3 L, vec3 Kdiff, vec3 Ldiff)
{
    return safeLimit(safeFinite(dot(N, L)) * safeLimit(Kdiff * Ldiff));
}

#endif
