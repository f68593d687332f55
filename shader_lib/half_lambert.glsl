// name: half_lambert
// kind: diffuse
// equation: u = (N.L) / 2 + 0.5
// source: article, "texture maps revisited"
// stability: finite for every finite input
#ifndef GLISTEN_HALF_LAMBERT
#define GLISTEN_HALF_LAMBERT
#include "safe.glsl"

// The cosine of the angle of incidence, mapped from [-1, 1] to [0, 1], so that the side away from the light keeps its
// shape. It is also the coordinate of ramps and lookup textures that cover both sides.
//   N  unit normal    L  unit vector towards the light
// bound: 3e-7 abs
float halfLambertFactor(vec3 N, vec3 L)
{
    return safeUnit(0.5 * dot(N, L) + 0.5);
}

// The register with which a single four-component dot product does the same: (l_x / 2, l_y / 2, l_z / 2, 0.5).
//   L  unit vector towards the light
// bound: 2.4e-7 abs
vec4 halfLambertRegister(vec3 L)
{
    return vec4(0.5 * L, 0.5);
}

// That dot product, limited to [0, 1].
//   N  unit normal, whose fourth component is 1    c0  the result of halfLambertRegister()
// bound: 2.4e-7 abs
float halfLambertDot(vec3 N, vec4 c0)
{
    return safeUnit(dot(vec4(N, 1.0), c0));
}

// Diffuse reflection with that factor, linear RGB.
//   Kdiff  diffuse reflectance, 0 to 1    Ldiff  intensity of the light, >= 0
// bound: 2.4e-7 rel
vec3 halfLambert(vec3 N, vec3 L, vec3 Kdiff, vec3 Ldiff)
{
    return halfLambertFactor(N, L) * safeLimit(Kdiff * Ldiff);
}

#endif
