// name: artistic
// kind: diffuse
// equation: wrap max((N.L + w) / (1 + w), 0); Gooch (1 + N.L) / 2 warm + (1 - N.L) / 2 cool; Minnaert (N.L N.V)^(k - 1) N.L; rim (1 - N.V)^k
// source: Green, GPU Gems, chapter 16, 2004; Gooch et al., A Non-Photorealistic Lighting Model, SIGGRAPH 1998, (2); Minnaert, Astrophysical Journal 93, 1941
// stability: powers by the distance from 1 where that is small; Minnaert's pole at the limb is cut at the largest float
//
// Diffuse reflection for looks: skin and wax by light that wraps around, drawings by warm and cool, the moon and velvet, and a rim of
// light. No claim of energy.
#ifndef GLISTEN_ARTISTIC
#define GLISTEN_ARTISTIC
#include "half_lambert.glsl"
#include "hemisphere.glsl"

// Light that reaches around the terminator; w = 0 is Lambert's factor, w = 1 the half range of `half_lambert`.
//   N  unit normal    L  unit vector towards the light    wrap  limited to [0, 1]
// bound: 3e-7 abs
float wrapFactor(vec3 N, vec3 L, float wrap)
{
    float w = safeUnit(wrap);
    return safeUnit((clamp(safeFinite(dot(N, L)), -1.0, 1.0) + w) / (1.0 + w));
}

// Gooch's shading from cool to warm, linear RGB.
//   N  unit normal    L  unit vector towards the light    warm, cool  colors, >= 0
// bound: 3e-7 color
vec3 gooch(vec3 N, vec3 L, vec3 warm, vec3 cool)
{
    return hemisphere(N, L, warm, cool);
}

// Minnaert's factor, which replaces N.L: k = 1 is Lambert's, above it the limb is darker, below it brighter. At most the largest
// float, at the limb for k < 1.
//   N  unit normal    L, V  unit vectors towards the light and the eye    k  limited to [0, 16]
// bound: 2e-6 size, two powers
float minnaertFactor(vec3 N, vec3 L, vec3 V, float k)
{
    float NL = min(dot(N, L), 1.0);
    float NV = safeUnit(dot(N, V));
    if (!(NL > 0.0))
        return 0.0;
    k = clamp(k, 0.0, 16.0);
    float seen = safePow(NV, abs(k - 1.0));
    if (k >= 1.0)
        return safePow(NL, k) * seen;
    return seen > 0.0 ? min(safePow(NL, k) / seen, safeLargest()) : safeLargest();
}

// Light along the rim, (1 - N.V)^k: 0 to 1.
//   N  unit normal    V  unit vector towards the eye    k  limited to >= 0
// bound: 3e-7 abs
float rimFactor(vec3 N, vec3 V, float k)
{
    float c = safeUnit(dot(N, V));
    return c < 0.5 ? safePowOneMinus(c, k) : safePow(safeOneMinusCos(N, V), k);
}

#endif
