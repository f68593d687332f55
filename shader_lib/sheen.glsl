// name: sheen
// kind: specular
// equation: D = (2 + 1 / alpha) sin^(1 / alpha) / (2 pi), V = 1 / (4 (N.L + N.V - N.L N.V))
// source: Estevez and Kulla, Production Friendly Microfacet Sheen BRDF, 2017, section 2 (Charlie); Neubelt and Pettineo, Crafting a Next-Gen Material Pipeline, 2013
// stability: near sin = 1 the power is that of 1 - (N.H)^2 by its distance from 1, elsewhere that of |N x H|^2
//
// Fibers that stand on a cloth: light comes from its rim, as on velvet. alpha is the square of the roughness, as in `ggx`,
// and so is the factor.
#ifndef GLISTEN_SHEEN
#define GLISTEN_SHEEN
#include "ggx.glsl"

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

#endif
