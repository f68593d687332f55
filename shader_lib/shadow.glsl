// name: shadow
// kind: light
// equation: mean of [t <= z(x + r p_i)] over taps p_i, r = (t - b) / b times the light's size, b the mean of what blocks; p = v / (v + (t - m)^2) for t > m, v = max(M_2 - m^2, least); light leaks are cut by (p - cut) / (1 - cut)
// source: Reeves, Salesin and Cook, Rendering Antialiased Shadows with Depth Maps, SIGGRAPH 1987; Fernando, Percentage-Closer Soft Shadows, 2005; Zhang et al., Parallel-Split Shadow Maps, 2006; Donnelly and Lauritzen, Variance Shadow Maps, I3D 2006; Lauritzen, Summed-Area Variance Shadow Maps, GPU Gems 3, 2007, chapter 8
// stability: with moments about 0.5, M_2 - m^2 keeps two bits more; without variance the comparison is exact; four texels by weights that are exact, so filters do not jump from texel to texel
//
// Shadows of a map of depths: filtered with one width, filtered as wide as the half shadow is, and by two moments, which can be filtered
// as any texture. Where two casters overlap, light leaks through the moments: `cut` darkens it, and the soft edge with it.
//
// A `place` is a point as the map sees it: its texture coordinates, and its depth from 0 to 1, less a bias against surfaces that shade
// themselves. `slope` is how that depth changes over the map on the plane of the surface, by shadowSlope(): with it, wide filters need
// no wide bias.
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

// What blocks the light among the four texels around a place: the part of them, and the sum of their depths times their weights.
//   map  depths in its first channel, of any filter    place  coordinates limited to [0, 1], and a depth
// bound: 1e-5 abs, the weights are coordinates times the size of the map
vec2 shadowBlocked(sampler2D map, vec3 place)
{
    ivec2 last = textureSize(map, 0) - 1;
    vec2 at = clamp(vec2(last + 1) * vec2(safeUnit(place.x), safeUnit(place.y)) - 0.5, vec2(0.0), vec2(last));
    vec2 low = floor(at);
    ivec2 a = ivec2(low);
    ivec2 b = min(a + 1, last);
    vec2 t = at - low;
    vec4 depths = vec4(texelFetch(map, a, 0).r, texelFetch(map, ivec2(b.x, a.y), 0).r, texelFetch(map, ivec2(a.x, b.y), 0).r,
        texelFetch(map, b, 0).r);
    vec4 weights = vec4((1.0 - t.x) * (1.0 - t.y), t.x * (1.0 - t.y), (1.0 - t.x) * t.y, t.x * t.y);
    vec4 kept = vec4(lessThan(depths, vec4(place.z))) * weights;
    return vec2(safeUnit(dot(kept, vec4(1.0))), safeUnit(dot(kept, depths)));
}

// A place moved within the plane of the surface.
//   place  coordinates and depth    slope  of the depth    off  change of the coordinates
// bound: 3e-7 size
vec3 shadowMoved(vec3 place, vec2 slope, vec2 off)
{
    return safeFinite(vec3(place.xy + off, place.z + dot(slope, off)));
}

// How the depth of a plane changes over the map, from the changes of a place: dFdx() and dFdy() of it. 0 for a plane that the map sees
// from its edge. Each number is limited to [-16, 16].
//   x, y  changes of coordinates and depth along two directions
// bound: 1e-6 size
vec2 shadowSlope(vec3 x, vec3 y)
{
    // Both sides of the quotient have both scales.
    vec3 a = safeScale(safeExtent(x)) * x;
    vec3 b = safeScale(safeExtent(y)) * y;
    float d = a.x * b.y - a.y * b.x;
    vec2 s = vec2(a.z * b.y - b.z * a.y, b.z * a.x - a.z * b.x);
    return d != 0.0 ? clamp(vec2(safeFinite(s.x / d), safeFinite(s.y / d)), -16.0, 16.0) : vec2(0.0);
}

// Percentage-closer filtering: the part of the light that arrives, 0 to 1, as the mean over a disk of the map.
//   map, place, slope  as above    radius  of the disk in coordinates, limited to [0, 1]    count  of taps, limited to [1, 64]
//   turn  of shadowTap()
// bound: 1e-5 abs, the weights are coordinates times the size of the map
float shadowPercentageCloser(sampler2D map, vec3 place, vec2 slope, float radius, int count, float turn)
{
    int n = clamp(count, 1, 64);
    float r = safeUnit(radius);
    float blocked = 0.0;
    for (int i = 0; i < n; ++i)
        blocked += shadowBlocked(map, shadowMoved(place, slope, r * shadowTap(i, n, turn))).x;
    return safeUnit(1.0 - blocked / float(n));
}

// The mean depth of what blocks the light over a disk of the map, and the part of the disk that it takes. (0, 0) if nothing does.
//   map, place, slope, radius, count, turn  as above
// bound: 1e-5 abs, the weights are coordinates times the size of the map
vec2 shadowBlockers(sampler2D map, vec3 place, vec2 slope, float radius, int count, float turn)
{
    int n = clamp(count, 1, 64);
    float r = safeUnit(radius);
    vec2 sum = vec2(0.0);
    for (int i = 0; i < n; ++i)
        sum += shadowBlocked(map, shadowMoved(place, slope, r * shadowTap(i, n, turn)));
    return sum.x > 0.0 ? vec2(safeUnit(sum.y / sum.x), sum.x / float(n)) : vec2(0.0);
}

// The distance from a lamp along its axis, for a depth of the map that its perspective camera draws.
//   depth  limited to [0, 1]    range  near and far of the camera, near limited to >= 2^-60, far to >= near
// bound: 4e-7 rel
float shadowDistance(float depth, vec2 range)
{
    float n = clamp(range.x, exp2(-60.0), exp2(60.0));
    float f = clamp(range.y, n, exp2(60.0));
    float d = safeUnit(depth);
    return n / (d * (n / f) + (1.0 - d));
}

// The width of the half shadow of a light with a size.
//   receiver, blocker  distances from the light, the blocker's limited to >= 2^-60    size  of the light, limited to >= 0
// bound: 6e-7 size
float shadowPenumbra(float receiver, float blocker, float size)
{
    float b = max(blocker, exp2(-60.0));
    return safePositive(safePositive(safeFinite(receiver - b)) / b * max(size, 0.0));
}

// The part of the light that arrives by a filter as wide as the half shadow. Less than one tap of blockers counts by its part.
//   blockers  of shadowBlockers()    map, place, slope, count, turn  as above    radius  of the filter, limited to [0, 1]
// bound: 1e-5 abs, the weights are coordinates times the size of the map
float shadowWithin(sampler2D map, vec3 place, vec2 slope, vec2 blockers, float radius, int count, float turn)
{
    float part = safeUnit(blockers.y * float(clamp(count, 1, 64)));
    if (!(part > 0.0))
        return 1.0;
    return safeUnit(1.0 - part * (1.0 - shadowPercentageCloser(map, place, slope, radius, count, turn)));
}

// Percentage-closer soft shadows of a lamp with a size, whose map a perspective camera draws: the part of the light that arrives, 0 to 1.
// The search covers all that could be in the way from the near end on.
//   map, place, slope, count, turn  as above    range  near and far of the camera, limited as above
//   size  the lamp's width over that of what the map shows at the distance 1, limited to >= 0
// bound: 1e-4 abs, the radius follows from depths of which there are a few texels
float shadowSoftLamp(sampler2D map, vec3 place, vec2 slope, vec2 range, float size, int count, float turn)
{
    float r = shadowDistance(place.z, range);
    float search = 0.5 * shadowPenumbra(r, shadowDistance(0.0, range), size) / r;
    vec2 blockers = shadowBlockers(map, place, slope, search, count, turn);
    float radius = 0.5 * shadowPenumbra(r, shadowDistance(blockers.x, range), size) / r;
    return shadowWithin(map, place, slope, blockers, radius, count, turn);
}

// The same for the sun, whose map an orthographic camera draws.
//   map, place, slope, count, turn  as above    size  the half width of the half shadow in coordinates, 1 of depth behind what
//   blocks: the tangent of half of the sun's angle times the map's range of depth over its width; limited to >= 0
// bound: 1e-4 abs, the radius follows from depths of which there are a few texels
float shadowSoftSun(sampler2D map, vec3 place, vec2 slope, float size, int count, float turn)
{
    float most = safePositive(size);
    float depth = safeUnit(place.z);
    vec2 blockers = shadowBlockers(map, place, slope, most * depth, count, turn);
    return shadowWithin(map, place, slope, blockers, most * safeUnit(depth - blockers.x), count, turn);
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
