// name: toon
// kind: diffuse
// equation: ramp(0.5 (N.L) + 0.5)
// source: article, program `soft`
#ifndef GLISTEN_TOON
#define GLISTEN_TOON
#include "half_lambert.glsl"

// Soft toon: the color of a ramp texture (dark side at 0, lit side at 1) for the half-range cosine.
vec3 toonSoft(sampler2D ramp, vec3 N, vec3 L)
{
    float n = float(textureSize(ramp, 0).x);
    float u = (halfLambertFactor(N, L) * (n - 1.0) + 0.5) / n;
    return texture(ramp, vec2(u, 0.5)).rgb;
}

// Hard toon: two colors, parted where N.L passes the threshold.
vec3 toonHard(vec3 N, vec3 L, float threshold, vec3 lit, vec3 dark)
{
    return dot(N, L) > threshold ? lit : dark;
}

// The ramp of the soft toon by formula: from dark to lit over the half-range cosine `edge` +- `width`.
vec3 toonRamp(vec3 N, vec3 L, float edge, float width, vec3 lit, vec3 dark)
{
    float u = halfLambertFactor(N, L);
    return mix(dark, lit, width > 0.0 ? smoothstep(edge - width, edge + width, u) : step(edge, u));
}

#endif
