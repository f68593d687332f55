// name: half_lambert
// kind: diffuse
// equation: u = 0.5 (N.L) + 0.5
// source: article, "texture maps revisited"
#ifndef GLISTEN_HALF_LAMBERT
#define GLISTEN_HALF_LAMBERT
#include "safe.glsl"

// The cosine of the angle of incidence moved from [-1, 1] to [0, 1], so that the side turned away from the light keeps
// its shape. Also the coordinate of ramps and look-up textures that cover both sides.
//   N  unit normal    L  unit vector towards the light
float halfLambertFactor(vec3 N, vec3 L)
{
    return safeUnit(0.5 * dot(N, L) + 0.5);
}

// Diffuse reflection with that factor, linear RGB.
vec3 halfLambert(vec3 N, vec3 L, vec3 Kdiff, vec3 Ldiff)
{
    return halfLambertFactor(N, L) * Kdiff * Ldiff;
}

#endif
