// name: sdf
// kind: helper
// equation: |p| - r; |max(q, 0)| + min(max(q), 0) with q = |p| - b; the smooth minimum min(a, b) - k h^2 / 4, h = max(k - |a - b|, 0) / k
// source: Hart, Sphere Tracing, The Visual Computer 12, 1996; Quilez, Distance Functions
// stability: lengths without overflow; the smooth minimum is the plain one for k = 0
//
// Distances from shapes, negative inside. Shapes join by min(), cut by max(a, -b), get round by d - r, become shells by
// abs(d) - t. An edge is drawn smooth by sdfCoverage(d, fwidth(d)).
#ifndef GLISTEN_SDF
#define GLISTEN_SDF
#include "safe.glsl"

// A circle.
//   p  from its center    radius  of any size
// bound: 3e-7 size
float sdfCircle(vec2 p, float radius)
{
    return safeFinite(safeLength(vec3(p, 0.0)) - radius);
}

// A rectangle.
//   p  from its center    extent  half its sides, >= 0
// bound: 3e-7 size
float sdfBox(vec2 p, vec2 extent)
{
    vec2 q = clamp(abs(p) - extent, vec2(-safeLargest()), vec2(safeLargest()));
    return safeFinite(safeLength(vec3(max(q, vec2(0.0)), 0.0)) + min(max(q.x, q.y), 0.0));
}

// A box.
//   p  from its center    extent  half its sides, >= 0
// bound: 3e-7 size
float sdfBox(vec3 p, vec3 extent)
{
    vec3 q = safeLimit(abs(p) - extent);
    return safeFinite(safeLength(max(q, vec3(0.0))) + min(max(q.x, max(q.y, q.z)), 0.0));
}

// A line of a breadth, with round ends.
//   p  the place    a, b  the ends, which may be one    radius  half the breadth
// bound: 6e-7 size
float sdfSegment(vec2 p, vec2 a, vec2 b, float radius)
{
    float s = safeScale(max(safeExtent(vec3(p, 0.0)), max(safeExtent(vec3(a, 0.0)), safeExtent(vec3(b, 0.0)))));
    vec2 along = s * b - s * a;
    vec2 to = s * p - s * a;
    float square = dot(along, along);
    float t = square > 0.0 ? safeUnit(dot(to, along) / square) : 0.0;
    return safeFinite(safeLength(vec3(to - t * along, 0.0)) / s - radius);
}

// A torus around the y axis.
//   p  from its center    radius  of the ring    tube  of its tube
// bound: 6e-7 size
float sdfTorus(vec3 p, float radius, float tube)
{
    float ring = safeFinite(safeLength(vec3(p.xz, 0.0)) - radius);
    return safeFinite(safeLength(vec3(ring, p.y, 0.0)) - tube);
}

// The union of two shapes, with a smooth seam of the breadth k; k <= 0 is min().
// bound: 3e-7 size
float sdfBlend(float a, float b, float k)
{
    float apart = min(abs(a - b), safeLargest());
    if (!(k > apart))
        return min(a, b);
    float h = 1.0 - apart / k;
    return safeFinite(min(a, b) - 0.25 * k * (h * h));
}

// How much of a pixel a shape covers, 0 to 1.
//   d  distance at the pixel's center    width  by how much the distance changes over a pixel: fwidth(d); 0 is a hard edge
// bound: 3e-7 abs
float sdfCoverage(float d, float width)
{
    if (!(width > 0.0))
        return d < 0.0 ? 1.0 : (d > 0.0 ? 0.0 : 0.5);
    return safeUnit(0.5 - safeFinite(d / width));
}

#endif
