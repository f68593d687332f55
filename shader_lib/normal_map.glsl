// name: normal_map
// kind: geometry
// equation: N' = x T + y B + z N; T and B from the derivatives of place and texture coordinates
// source: Blinn, Simulation of Wrinkled Surfaces, SIGGRAPH 1978; Schuler, Normal Mapping without Precomputed Tangents, ShaderX5, 2006
// stability: a frame without texture coordinates, or of a triangle without area, leaves the normal as it is
//
// Normals from textures. Triplanar weights and the parallax of a height are here, too: they need no texture of their own.
#ifndef GLISTEN_NORMAL_MAP
#define GLISTEN_NORMAL_MAP
#include "safe.glsl"

// The unit normal of a texel in the frame of a vertex.
//   N  unit normal    T  unit tangent    handedness  1, or -1 where the texture is mirrored    texel  0 to 1 by channel
// bound: 3e-7 abs
vec3 normalMapped(vec3 N, vec3 T, float handedness, vec3 texel)
{
    vec3 t = 2.0 * clamp(texel, vec3(0.0), vec3(1.0)) - 1.0;
    vec3 B = handedness < 0.0 ? -cross(N, T) : cross(N, T);
    vec3 mapped = safeNormalize(safeFinite(t.x * T + t.y * B + t.z * N));
    return dot(mapped, mapped) > 0.0 ? mapped : N;
}

// The columns T, B and N without tangents at the vertices. The longer of T and B is a unit vector; both are 0 where the triangle or
// its texture has no area.
//   N  unit normal    px, py  dFdx and dFdy of the place    sx, sy  dFdx and dFdy of the texture coordinates
// bound: 6e-7 abs
mat3 normalFrame(vec3 N, vec3 px, vec3 py, vec2 sx, vec2 sy)
{
    // One scale for both, which leaves the directions as they are.
    float size = safeScale(max(safeExtent(px), safeExtent(py)));
    vec3 across = cross(size * py, N);
    vec3 along = cross(N, size * px);
    vec3 T = safeFinite(across * sx.x + along * sy.x);
    vec3 B = safeFinite(across * sx.y + along * sy.y);
    float longest = max(safeLength(T), safeLength(B));
    float scale = longest > 0.0 ? 1.0 / longest : 0.0;
    return mat3(safeFinite(T * scale), safeFinite(B * scale), N);
}

// The weights of three projections along the axes: they add up to 1, except for the zero vector.
//   N  unit normal    sharpness  1 blends widely, 8 hardly, limited to [0, 1024]
// bound: 1e-6 abs
vec3 triplanarWeights(vec3 N, float sharpness)
{
    float most = safeExtent(N);
    if (!(most > 0.0))
        return vec3(0.0);
    float k = clamp(sharpness, 0.0, 1024.0);
    // Relative to the largest, so that high powers do not all vanish.
    vec3 a = abs(N) / most;
    vec3 w = vec3(safePow(a.x, k), safePow(a.y, k), safePow(a.z, k));
    return w / (w.x + w.y + w.z);
}

// By how much the texture coordinates move so that a height is seen from the side, without the division by the slope that
// smears grazing views.
//   V  unit vector towards the eye in the frame of the texture    height  0 to 1    scale  of the relief in texture coordinates
// bound: 3e-7 size
vec2 parallaxOffset(vec3 V, float height, float scale)
{
    return clamp(V.xy * (safeUnit(height) * clamp(scale, -1024.0, 1024.0)), vec2(-safeLargest()), vec2(safeLargest()));
}

#endif
