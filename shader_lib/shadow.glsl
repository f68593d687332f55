// name: shadow
// kind: light
// equation: p = v / (v + (t - m)^2) for t > m, v = max(M_2 - m^2, least); light leaks are cut by (p - cut) / (1 - cut)
// source: Donnelly and Lauritzen, Variance Shadow Maps, I3D 2006; Lauritzen, Summed-Area Variance Shadow Maps, GPU Gems 3, 2007, chapter 8
// stability: with moments about 0.5, M_2 - m^2 keeps two bits more; without variance the comparison is exact
//
// Soft shadows of a map of two moments, which can be filtered as any texture. Where two casters overlap, light leaks: `cut`
// darkens it, and the soft edge with it.
#ifndef GLISTEN_SHADOW
#define GLISTEN_SHADOW
#include "safe.glsl"

// The moments of a depth that a shadow map stores, about the middle.
//   depth  0 to 1
// bound: 3e-7 abs
vec2 shadowMoments(float depth)
{
    float d = safeUnit(depth) - 0.5;
    return vec2(d, d * d);
}

// How much of the light arrives at most, by Chebyshev's inequality: 0 to 1.
//   moments  filtered, of shadowMoments()    depth  of the receiver, 0 to 1    least  the smallest variance, limited to [0, 1]
//   cut  the part that counts as a leak, limited to [0, 0.99]
// bound: 2e-3 abs, the variance is a difference of squares
float shadowVariance(vec2 moments, float depth, float least, float cut)
{
    float m = clamp(safeFinite(moments.x), -0.5, 0.5);
    float t = safeUnit(depth) - 0.5 - m;
    if (!(t > 0.0))
        return 1.0;
    float v = max(safeUnit(moments.y) - m * m, safeUnit(least));
    float c = clamp(cut, 0.0, 0.99);
    return safeUnit((v / (v + t * t) - c) / (1.0 - c));
}

#endif
