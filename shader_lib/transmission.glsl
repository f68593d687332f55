// name: transmission
// kind: diffuse
// equation: f = D V (1 - F) K for the light mirrored at the surface, L' = L - 2 (N.L) N; T = e^-x of a volume
// source: KHR_materials_transmission and KHR_materials_volume, Khronos 2021; Beer, Bestimmung der Absorption des rothen Lichts, 1852
// stability: the half vector's angle by N x (L + V), in which the mirrored direction's part along N is not there at all
//
// Light that passes through a thin wall: a window, a bottle, a leaf of plastic. It leaves in the direction in which it came, spread by the
// roughness as a highlight is; there is no refraction. Factors are f times pi and the cosine, as those of `ggx`.
#ifndef GLISTEN_TRANSMISSION
#define GLISTEN_TRANSMISSION
#include "ggx.glsl"

// The direction to a light behind a surface, mirrored to the eye's side.
//   N, L  unit vectors
// bound: 6e-7 abs
vec3 transmissionMirrored(vec3 N, vec3 L)
{
    return safeFinite(L - 2.0 * dot(N, L) * N);
}

// pi D V |N.L|: the factor of a light behind the surface; 0 for one before it.
//   N  unit normal    L, V  unit vectors towards the light and the eye    alpha  limited to [2^-20, 1]
// bound: 2e-6 size, dozens of roundings
float transmissionFactor(vec3 N, vec3 L, vec3 V, float alpha)
{
    float NL = min(-dot(N, L), 1.0);
    if (!(NL > 0.0))
        return 0.0;
    float a = ggxLimit(alpha);
    float NV = dot(N, V);
    float v = safeUnit(NV);
    float w = (1.0 - a) * (1.0 + a);
    float d = NL * sqrt(a * a + w * v * v) + v * sqrt(a * a + w * NL * NL);
    // The half vector before it has unit length, in parts along N and across it.
    float c = NL + NV;
    vec3 s = cross(N, L + V);
    float across = dot(s, s);
    if (!(c > 0.0 && d > 0.0))
        return 0.0;
    float k = a * (across + c * c) / (across + a * a * c * c);
    return safeFinite(safeFinite(k * k) * (0.5 * NL / d));
}

// The part of the light that a volume leaves, e^-x, per channel.
//   depth  the way times the attenuation, each limited to [0, 64]
// bound: 3e-7 abs
vec3 transmissionLeft(vec3 depth)
{
    return exp(-clamp(depth, vec3(0.0), vec3(64.0)));
}

#endif
