// name: environment
// kind: ambient
// equation: I = (F_0 A + B) L((1 - s) N + s R), s = (1 - alpha) (sqrt(1 - alpha) + alpha), L(R) the integral of L D (N.L) over that of D (N.L) for N = V = R
// source: Karis, Real Shading in Unreal Engine 4, SIGGRAPH 2013; Lagarde and de Rousiers, Moving Frostbite to PBR, SIGGRAPH 2014; Cigolle et al., A Survey of Efficient Representations for Independent Unit Vectors, JCGT 2014
// stability: the lower half of the octahedron is folded by sums instead of 1 - |s|, with a sign at 0 as well
//
// Light from all around as a smooth or a rough surface mirrors it: the split sum, whose first factor is a map that `glisten lib
// prefilter` makes of a panorama, and whose second is the pattern `ltc_albedo` (ltcAlbedo()). What a matte surface gets of it are nine
// coefficients, which the command writes for irradiance().
//
// A map has squares on top of each other, one for each roughness from 0 to 1. Each is an octahedron, unfolded: +y is its middle, -y all
// four corners. Its outermost texels are on the edge, so that those of one direction are equal, and nothing shows a seam.
#ifndef GLISTEN_ENVIRONMENT
#define GLISTEN_ENVIRONMENT
#include "ltc.glsl"

// The place of a direction on the octahedron, 0 to 1; the middle for the zero vector.
//   d  of any length
// bound: 2.4e-7 abs
vec2 environmentPlace(vec3 d)
{
    vec3 a = safeScale(safeExtent(d)) * abs(d);
    float sum = a.x + a.y + a.z;
    if (!(sum > 0.0))
        return vec2(0.5);
    float below = d.y < 0.0 ? a.y : 0.0;
    vec2 p = 0.5 * (a.xz + below) / sum;
    return vec2(d.x < 0.0 ? 0.5 - p.x : 0.5 + p.x, d.z < 0.0 ? 0.5 - p.y : 0.5 + p.y);
}

// The radiance of a place for one roughness of a map, by weights that are exact: a GPU's own filter has as few as 256 steps.
//   place  limited to [0, 1]    level  limited to those of the map: 0 is the roughness 0, the last one 1
// bound: 2e-6 abs, the steep ends of the table
vec3 environmentTexel(sampler2D map, vec2 place, int level)
{
    ivec2 size = textureSize(map, 0);
    int last = size.x - 1;
    int first = clamp(level, 0, max(size.y / size.x - 1, 0)) * size.x;
    vec2 at = float(last) * vec2(safeUnit(place.x), safeUnit(place.y));
    vec2 low = floor(at);
    vec2 t = at - low;
    ivec2 a = ivec2(low);
    ivec2 b = min(a + 1, ivec2(last));
    int row = min(first + a.y, size.y - 1);
    int above = min(first + b.y, size.y - 1);
    vec3 near = (1.0 - t.x) * texelFetch(map, ivec2(a.x, row), 0).rgb + t.x * texelFetch(map, ivec2(b.x, row), 0).rgb;
    vec3 far = (1.0 - t.x) * texelFetch(map, ivec2(a.x, above), 0).rgb + t.x * texelFetch(map, ivec2(b.x, above), 0).rgb;
    return (1.0 - t.y) * near + t.y * far;
}

// The radiance that a surface mirrors from a direction, between those of the two nearest roughnesses of a map.
//   d  of any length    roughness  the root of alpha, limited to [0, 1]
// bound: 2e-6 abs, the steep ends of the table
vec3 environmentRadiance(sampler2D map, vec3 d, float roughness)
{
    ivec2 size = textureSize(map, 0);
    float at = safeUnit(roughness) * float(max(size.y / size.x - 1, 0));
    float low = floor(at);
    float t = at - low;
    vec2 place = environmentPlace(d);
    vec3 smoother = environmentTexel(map, place, int(low));
    return (1.0 - t) * smoother + t * environmentTexel(map, place, int(low) + 1);
}

// The direction from which a rough surface mirrors most: between the normal and the mirror direction, at which a lobe would be cut by
// the surface. Not of unit length.
//   N, V  unit vectors    roughness  the root of alpha, limited to [0, 1]
// bound: 1e-6 abs
vec3 environmentDominant(vec3 N, vec3 V, float roughness)
{
    float r = safeUnit(roughness);
    float rest = (1.0 - r) * (1.0 + r);
    float s = rest * (sqrt(rest) + r * r);
    return safeFinite((1.0 - s) * N + s * (2.0 * dot(N, V) * N - V));
}

// The light of everything around that a surface of microfacets mirrors towards the eye.
//   map  of `glisten lib prefilter`    table  `ltc_albedo`, of any filter    N, V  unit vectors
//   roughness  the root of alpha, limited to [0, 1]    Kspec  reflectance at normal incidence
// bound: 4e-6 color, the mirror direction and the steep ends of the tables
vec3 environmentSpecular(sampler2D map, sampler2D table, vec3 N, vec3 V, float roughness, vec3 Kspec)
{
    vec3 seen = environmentRadiance(map, environmentDominant(N, V, roughness), roughness);
    return safeLimit(ltcAlbedo(table, N, V, roughness, Kspec) * seen);
}

#endif
