// name: ao
// kind: light
// equation: a = (sin h_1 sin(h_1 - n) + h_1 sin n + sin h_2 sin(h_2 - n) + h_2 sin n) / 2; max(a, ((a A + B) a + C) a) with A, B, C of the color
// source: Jimenez et al., Practical Realtime Strategies for Accurate Indirect Occlusion, 2016; Lagarde and de Rousiers, course, SIGGRAPH 2014
// stability: cos n - cos(2 h - n) of the paper is a product of two sines
//
// How much of the light from everywhere arrives where things stand in its way: 1 for all, 0 for none.
#ifndef GLISTEN_AO
#define GLISTEN_AO
#include "safe.glsl"

// The part of the light that a slice through the eye's direction lets in, weighted by the cosine to the normal.
//   low, high  the angles of the two horizons from the eye's direction, in radians: low before it, high after it; limited to a right
//   angle from the normal. The eye sees the point, so a horizon may hide the normal's direction, but not the eye's
//   n  that of the normal in the slice, limited to [-pi / 2, pi / 2]
// bound: 6e-7 abs
float aoSlice(float low, float high, float n)
{
    float right = radians(90.0);
    float m = clamp(n, -right, right);
    float a = clamp(low, m - right, 0.0);
    float b = clamp(high, 0.0, m + right);
    float s = sin(m);
    return 0.5 * (sin(a) * sin(a - m) + a * s + sin(b) * sin(b - m) + b * s);
}

// Light that surfaces in the way reflect, by a fit to path tracing: a white corner is not dark.
//   a  limited to [0, 1]    Kdiff  the color of the surface, each channel limited to [0, 1]
// bound: 2e-6 abs, the polynomial's terms cancel
vec3 aoBounced(float a, vec3 Kdiff)
{
    float v = safeUnit(a);
    vec3 k = vec3(safeUnit(Kdiff.x), safeUnit(Kdiff.y), safeUnit(Kdiff.z));
    vec3 p = v * (v * (v * (2.0404 * k - 0.3324) + (0.6417 - 4.7951 * k)) + (2.7552 * k + 0.6903));
    return max(p, vec3(v));
}

// The part of mirrored light that arrives, from that of scattered light: smooth surfaces lose less.
//   cosine  N.V, limited to [0, 1]    a  limited to [0, 1]    roughness  limited to [0, 1]
// bound: 6e-7 abs
float aoSpecular(float cosine, float a, float roughness)
{
    float v = safeUnit(a);
    float x = safeUnit(cosine) + v;
    float power = exp2(-16.0 * safeUnit(roughness) - 1.0);
    return x > 0.0 ? safeUnit(pow(x, power) - 1.0 + v) : 0.0;
}

#endif
