// name: lambert
// kind: diffuse
// equation: (82), (83): I_diff = max(N.L, 0) K_diff * L_diff
// source: textbook, section 10.1.3
#ifndef GLISTEN_LAMBERT
#define GLISTEN_LAMBERT
#include "safe.glsl"

// The cosine of the angle of incidence, max(N.L, 0): 0 to 1 for unit vectors.
//   N  unit normal    L  unit vector towards the light
float lambertFactor(vec3 N, vec3 L)
{
    return safePositive(dot(N, L));
}

// Diffuse reflection (83), linear RGB.
//   Kdiff  diffuse reflectance of the material, 0 to 1    Ldiff  intensity of the light
vec3 lambert(vec3 N, vec3 L, vec3 Kdiff, vec3 Ldiff)
{
    return lambertFactor(N, L) * Kdiff * Ldiff;
}

#endif
