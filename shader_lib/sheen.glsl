// name: sheen
// kind: specular
// equation: D = (2 + 1 / alpha) sin^(1 / alpha) / (2 pi), V = 1 / (4 (N.L + N.V - N.L N.V)); over a base, (1 - max(K) E) base + K f
// source: Estevez and Kulla, Production Friendly Microfacet Sheen BRDF, 2017, section 2 (Charlie); Neubelt and Pettineo, Crafting a Next-Gen Material Pipeline, 2013; KHR_materials_sheen, Khronos 2020
// stability: near sin = 1 the power is that of 1 - (N.H)^2 by its distance from 1, elsewhere that of |N x H|^2
//
// Fibers that stand on a cloth: light comes from its rim, as on velvet. alpha is the square of the roughness, as in `ggx`,
// and so is the factor.
#ifndef GLISTEN_SHEEN
#define GLISTEN_SHEEN
#include "ggx.glsl"
#include "ltc.glsl"

// D, the density of fibers across H. It is even: as large for -H.
//   N, H  unit normal and half vector    alpha  limited to [2^-20, 1]
// bound: 6e-6 size, the power of a large exponent
float sheenDistribution(vec3 N, vec3 H, float alpha)
{
    float k = 1.0 / ggxLimit(alpha);
    float c = abs(dot(N, H));
    vec3 s = cross(N, H);
    float power = c < 0.5 ? safePowOneMinus(c * c, 0.5 * k) : safePow(dot(s, s), 0.5 * k);
    return safeFinite((2.0 + k) * power / radians(360.0));
}

// pi D V N.L: the factor of a light without pi.
//   N  unit normal    L, V  unit vectors towards the light and the eye    alpha  limited to [2^-20, 1]
// bound: 6e-6 size, the power of a large exponent
float sheenFactor(vec3 N, vec3 L, vec3 V, float alpha)
{
    float NL = min(dot(N, L), 1.0);
    if (!(NL > 0.0))
        return 0.0;
    float d = NL + safeUnit(dot(N, V)) * (1.0 - NL);
    float D = radians(180.0) * sheenDistribution(N, halfVector(L, V), alpha);
    return safeFinite(D * (0.25 * NL / d));
}

// E, the part of the light from everywhere that white fibers return: 0 to 1. Below a roughness of 0.45 the model itself returns more than
// all of it at grazing angles, up to 1.7 times the light at a roughness of 0.25 and 2.1 times at 0.2; E is 1 there.
//   table  `sheen_albedo`, of any filter    N, V  unit normal, unit vector towards the eye    roughness  the root of alpha, limited to [0, 1]
// bound: 2e-6 abs, the steep ends of the table
float sheenAlbedo(sampler2D table, vec3 N, vec3 V, float roughness)
{
    return safeUnit(ltcTexel(table, vec2(sqrt(safeUnit(dot(N, V))), roughness)).x);
}

// A reflection under fibers, linear RGB: what they return is missing below, but no more than all of it: with smooth fibers
// (see above) there is more light than there was.
//   table, N, V, roughness  as above    base  the reflection of the light without the fibers, >= 0    L  unit vector towards the light
//   Kspec  the fibers' color, each channel limited to [0, 1]    Lspec  intensity of the light, >= 0
// bound: 8e-6 size, the power of a large exponent
vec3 sheen(sampler2D table, vec3 base, vec3 N, vec3 L, vec3 V, float roughness, vec3 Kspec, vec3 Lspec)
{
    vec3 k = vec3(safeUnit(Kspec.x), safeUnit(Kspec.y), safeUnit(Kspec.z));
    float left = 1.0 - max(k.x, max(k.y, k.z)) * sheenAlbedo(table, N, V, roughness);
    float r = safeUnit(roughness);
    return safeLimit(left * base + safeLimit(sheenFactor(N, L, V, r * r) * safeLimit(k * Lspec)));
}

#endif
