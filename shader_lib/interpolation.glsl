// name: interpolation
// kind: geometry
// equation: (105), (106), (107), (108): C = w sum(b_i C_i / w_i), 1 / w = sum(b_i / w_i)
// source: textbook, section 10.2.2
// stability: correct for w of any size, 1e-38 to 1e38; w = 0 and triangles without area have a value
//
// The rasterizer's interpolation as functions: `noperspective` is (106), `smooth` is (108), `flat` takes the last
// vertex. They are useful for rays, decals and tests.
#ifndef GLISTEN_INTERPOLATION
#define GLISTEN_INTERPOLATION
#include "safe.glsl"

// The coordinates (u, v) of P in the triangle P0 P1 P2 (105): P = P0 + u (P1 - P0) + v (P2 - P0). Both 0 for a triangle
// without area.
//   P, P0, P1, P2  in window space
// bound: 2.4e-7 rel
vec2 barycentric(vec2 P, vec2 P0, vec2 P1, vec2 P2)
{
    vec2 u = P1 - P0;
    vec2 v = P2 - P0;
    vec2 p = P - P0;
    // (u, v) is a ratio of areas. Each edge scaled by itself cancels, and no product leaves the range.
    vec2 us = safeScale(safeExtent(vec3(u, 0.0))) * u;
    vec2 vs = safeScale(safeExtent(vec3(v, 0.0))) * v;
    vec2 area = vec2(u.x * vs.y - vs.x * u.y, us.x * v.y - v.x * us.y);
    if (area.x == 0.0 || area.y == 0.0)
        return vec2(0.0);
    vec2 b = vec2(p.x * vs.y - p.y * vs.x, p.y * us.x - p.x * us.y) / area;
    return vec2(safeFinite(b.x), safeFinite(b.y));
}

// A weighted mean of three vertices, linear in window space (106): (1 - u - v) C0 + u C1 + v C2.
//   uv  coordinates in window space (105)    C0, C1, C2  attributes of the vertices
// bound: 2.4e-7 rel
vec4 interpolateLinear(vec2 uv, vec4 C0, vec4 C1, vec4 C2)
{
    vec4 sum = (1.0 - uv.x - uv.y) * C0 + uv.x * C1 + uv.y * C2;
    return vec4(safeFinite(sum.xyz), safeFinite(sum.w));
}

// Weights of three vertices for a mean that is linear in space (108), with sum 1: b_i / w_i over their sum.
//   uv  coordinates in window space (105)    w  of the vertices in clip space, none negative
// Outside the model: a vertex with w = 0, in the plane of the eye, gets all the weight, as in the limit (the first
// one of several). Weights that sum to 0 yield the first vertex.
// bound: 3e-7 abs
vec3 perspectiveWeights(vec2 uv, vec3 w)
{
    vec3 b = vec3(1.0 - uv.x - uv.y, uv.x, uv.y);
    vec3 a = abs(w);
    if (!(a.x > 0.0))
        return vec3(1.0, 0.0, 0.0);
    if (!(a.y > 0.0))
        return vec3(0.0, 1.0, 0.0);
    if (!(a.z > 0.0))
        return vec3(0.0, 0.0, 1.0);
    // 1 / w_i times the smallest w of those that count, to avoid overflow, and underflow of all of them.
    bvec3 counts = notEqual(b, vec3(0.0));
    vec3 least = mix(vec3(safeLargest()), a, counts);
    vec3 q = mix(vec3(0.0), b * (min(least.x, min(least.y, least.z)) / w), counts);
    float sum = q.x + q.y + q.z;
    if (!(sum > 0.0) && !(sum < 0.0))
        return vec3(1.0, 0.0, 0.0);
    return safeFinite(q / sum);
}

// A mean of three vertices that is linear in space (108).
//   uv  coordinates in window space (105)    w  of the vertices in clip space
// bound: 2.4e-7 rel
vec4 interpolatePerspective(vec2 uv, vec3 w, vec4 C0, vec4 C1, vec4 C2)
{
    vec3 q = perspectiveWeights(uv, w);
    vec4 sum = q.x * C0 + q.y * C1 + q.z * C2;
    return vec4(safeFinite(sum.xyz), safeFinite(sum.w));
}

// The point (x, z) of the segment from (x_a, z_a) to (x_b, z_b) whose projection divides the projected segment in the
// ratio t : (1 - t) (107).
//   t  0 to 1    a, b  the ends, (x, z) with z > 0
// bound: 2.4e-7 rel
vec2 segmentPoint(float t, vec2 a, vec2 b)
{
    return interpolatePerspective(vec2(t, 0.0), vec3(a.y, b.y, a.y), vec4(a, 0.0, 0.0), vec4(b, 0.0, 0.0), vec4(0.0)).xy;
}

#endif
