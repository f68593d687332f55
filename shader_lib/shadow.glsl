// name: shadow
// kind: light
// equation: p = v / (v + (t - m)^2) for t > m, v = max(M_2 - m^2, least); light leaks are cut by (p - cut) / (1 - cut)
// source: Fernando, Percentage-Closer Soft Shadows, 2005; Zhang et al., Parallel-Split Shadow Maps, 2006; Donnelly and Lauritzen, Variance Shadow Maps, I3D 2006; Lauritzen, Summed-Area Variance Shadow Maps, GPU Gems 3, 2007, chapter 8
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

// The place of a sample in a disk of the radius 1, for filters and for the search of blockers: a spiral that covers it evenly.
//   index  0 to count - 1    count  limited to >= 1    turn  by how much of a full turn it is rotated, such as a noise of the pixel
// bound: 2e-6 abs
vec2 shadowTap(int index, int count, float turn)
{
    int i = max(index, 0);
    float r = sqrt(min((float(i) + 0.5) / float(max(count, 1)), 1.0));
    // The golden angle, (3 - sqrt(5)) / 2 of a turn, in units of 2^-32 of a turn: products of whole numbers stay exact.
    float a = float((uint(i) * 1640531527u) >> 8u) / 16777216.0;
    a = radians(360.0) * (a + fract(clamp(turn, -4096.0, 4096.0)));
    return r * vec2(cos(a), sin(a));
}

// The width of the half shadow of a light with a size.
//   receiver, blocker  distances from the light, the blocker's limited to >= 2^-60    size  of the light, limited to >= 0
// bound: 6e-7 size
float shadowPenumbra(float receiver, float blocker, float size)
{
    float b = max(blocker, exp2(-60.0));
    return safePositive(safePositive(safeFinite(receiver - b)) / b * max(size, 0.0));
}

// The far end of a cascade: between even steps and a geometric series.
//   near, far  of the camera, near limited to >= 2^-60, far to >= near    x  which part of the cascades ends there, limited to [0, 1]
//   blend  0 for even steps, 1 for the series, limited to [0, 1]
// bound: 2e-6 rel, the power of a large quotient
float shadowSplit(float near, float far, float x, float blend)
{
    float n = clamp(near, exp2(-60.0), exp2(60.0));
    float f = clamp(far, n, exp2(60.0));
    float t = safeUnit(x);
    float b = safeUnit(blend);
    return b * (n * exp2(t * log2(f / n))) + (1.0 - b) * ((1.0 - t) * n + t * f);
}

// The number of the cascade for a depth, 0 to 4; the part after the point is how far into its last share it is, for a blend.
//   depth  of the point    ends  the far ends of four cascades, growing    share  of a cascade over which it blends, limited to [2^-10, 1]
// bound: 2e-6 abs, the difference to the end
float shadowCascade(float depth, vec4 ends, float share)
{
    float start = 0.0;
    float s = clamp(share, exp2(-10.0), 1.0);
    for (int i = 0; i < 4; ++i) {
        if (depth < ends[i]) {
            float t = safeFinite((depth - start) / max(ends[i] - start, exp2(-60.0)));
            return float(i) + safeUnit((t - (1.0 - s)) / s);
        }
        start = ends[i];
    }
    return 4.0;
}

#endif
