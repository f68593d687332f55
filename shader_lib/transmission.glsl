// name: transmission
// kind: diffuse
// equation: f = D V (1 - F) K for the light mirrored at the surface, L' = L - 2 (N.L) N; T = e^-x of a volume; sin a = n sin b
// source: KHR_materials_transmission and KHR_materials_volume, Khronos 2021; KHR_materials_dispersion, Khronos 2023; Beer, Bestimmung der Absorption des rothen Lichts, 1852; Born and Wolf, Principles of Optics, section 1.5.1
// stability: the half vector's angle by N x (L + V), in which the mirrored direction's part along N is not there at all; the cosine in a body is that of n^2 - 1 + cos^2, where nothing cancels
//
// Light that passes through a thin wall: a window, a bottle, a leaf of plastic. It leaves in the direction in which it came, spread by the
// roughness as a highlight is. Factors are f times pi and the cosine, as those of `ggx`.
//
// A thick body bends light. What its other side does, a shader does not know; transmissionSphere() takes the body for a ball, as marbles,
// drops and lenses nearly are: light that enters it at an angle a goes on at b, and leaves it at a, turned by 2 (a - b) in all. A ball
// mirrors nothing inside that has come in.
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

// How far light goes in a ball, as a part of its diameter: the cosine of the angle in it.
// An eye behind the surface counts as grazing.
//   N, V  unit normal, unit vector towards the eye    n  index of refraction, limited to [1, 16]
// bound: 6e-7 abs
float transmissionPath(vec3 N, vec3 V, float n)
{
    float k = clamp(n, 1.0, 16.0);
    float c = safeUnit(dot(N, V));
    return min(sqrt((k - 1.0) * (k + 1.0) + c * c) / k, 1.0);
}

// The direction in which one looks on through a ball: where what the eye sees comes from. -V for n = 1.
//   N, V  unit normal, unit vector towards the eye    n  index of refraction, limited to [1, 16]
// bound: 2e-6 abs, a sum of products
vec3 transmissionSphere(vec3 N, vec3 V, float n)
{
    float k = clamp(n, 1.0, 16.0);
    vec3 s = cross(N, V);
    float a2 = min(dot(s, s), 1.0);
    float ca = clamp(dot(N, V), -1.0, 1.0);
    float one = 1.0 - 2.0 * a2 / (k * k);
    float both = 2.0 * sqrt((k - 1.0) * (k + 1.0) + ca * ca) / (k * k);
    // cos(2 b - a) along the normal, and sin(2 b - a) / sin a of V's part across it.
    float along = one * ca + both * a2;
    float across = both * ca - one;
    return safeFinite(-along * N - across * (V - ca * N));
}

// The roughness with which a body blurs what is behind it, by its index of refraction: none for 1, that of the highlight from 1.5 on, as
// Khronos' sample renderer has it.
//   roughness  the root of alpha, limited to [0, 1]    n  index of refraction
// bound: 3e-7 abs
float transmissionRoughness(float roughness, float n)
{
    return safeUnit(roughness) * safeUnit(2.0 * clamp(n, 1.0, 16.0) - 2.0);
}

// The indices of refraction for red, green and blue.
//   n  that of the middle, limited to [1, 16]    dispersion  20 / V for a glass of Abbe's number V, limited to [0, 16]
// bound: 4e-7 rel
vec3 transmissionIndices(float n, float dispersion)
{
    float k = clamp(n, 1.0, 16.0);
    float half_spread = (k - 1.0) * (clamp(dispersion, 0.0, 16.0) / 40.0);
    return vec3(max(k - half_spread, 1.0), k, k + half_spread);
}

#endif
