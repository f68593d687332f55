// name: toon
// kind: diffuse
// equation: ramp((N.L) / 2 + 0.5)
// source: article, program `soft`
// stability: finite for every finite input; within rounding of a hard edge, either side is possible
#ifndef GLISTEN_TOON
#define GLISTEN_TOON
#include "half_lambert.glsl"
#include "lut.glsl"

// Soft toon shading: the color of a ramp texture for the half-range cosine, the dark side at 0, the lit side at 1.
//   ramp  n by 1 texels, clamped    N  unit normal    L  unit vector towards the light
// bound: 4e-7 abs
vec3 toonSoft(sampler2D ramp, vec3 N, vec3 L)
{
    return lutColor(ramp, halfLambertFactor(N, L));
}

// Hard toon shading: two colors, separated where N.L exceeds the threshold.
//   threshold  -1 to 1; 0 is the terminator    lit, dark  colors
// bound: 2.4e-7 abs
vec3 toonHard(vec3 N, vec3 L, float threshold, vec3 lit, vec3 dark)
{
    return dot(N, L) > threshold ? lit : dark;
}

// The soft ramp by formula: from dark to lit by a smooth step, over the half-range cosine `edge` +- `width`.
//   edge  0 to 1; 0.5 is the terminator    width  half of the ramp's extent; 0 or less: a hard edge
// bound: 2.4e-7 abs
vec3 toonRamp(vec3 N, vec3 L, float edge, float width, vec3 lit, vec3 dark)
{
    float x = halfLambertFactor(N, L) - edge;
    float s = width > 0.0 ? safeUnit(0.5 * (x / width) + 0.5) : (x < 0.0 ? 0.0 : 1.0);
    s = s * s * (3.0 - 2.0 * s);
    return safeLimit(s * lit + (1.0 - s) * dark);
}

#endif
