// name: dissolve
// kind: diffuse
// equation: kept = clamp((x - t) / w + 1 / 2, 0, 1), glow = max(1 - (x - t) / g, 0)^2
// source: common practice of games; the edge is that of `sdf`
// stability: an edge of the width 0 is hard and finite
//
// A surface that goes away where a noise x, such as `noise`'s, is below a threshold t: the rim is smooth, and glows.
#ifndef GLISTEN_DISSOLVE
#define GLISTEN_DISSOLVE
#include "sdf.glsl"

// How much of a pixel is left: 0 to 1.
//   x  the noise, 0 to 1    t  what is below goes away    width  by how much x changes over a pixel: fwidth(x)
// bound: 3e-7 abs
float dissolveKept(float x, float t, float width)
{
    return sdfCoverage(safeFinite(t - x), width);
}

// How much the rim glows: 1 at its edge and in what is gone, 0 from the width on.
//   x, t  as above    width  in units of x, limited to >= 2^-20
// bound: 1e-6 abs, the difference over the width
float dissolveGlow(float x, float t, float width)
{
    float g = 1.0 - safeUnit(safeFinite(x - t) / max(width, exp2(-20.0)));
    return g * g;
}

#endif
