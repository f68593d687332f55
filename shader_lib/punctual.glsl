// name: punctual
// kind: light
// equation: max(1 - (r / R)^4, 0)^2 / r^2; clamp((u_o - u) / (u_o - u_i), 0, 1)^2 with u = 1 - cos
// source: Karis, Real Shading in Unreal Engine 4, SIGGRAPH course 2013, (9); KHR_lights_punctual, Khronos 2018
// stability: the cone's edge is in 1 - cos, by the distance of the directions: narrow beams have no steps
//
// The falloffs of today: the inverse square that ends at a range, and a cone with a soft edge.
#ifndef GLISTEN_PUNCTUAL
#define GLISTEN_PUNCTUAL
#include "attenuation.glsl"

// The inverse square with a window that ends it at the range. At the light, the largest float.
//   r  distance, limited to >= 0    range  limited to >= 2^-60
// bound: 1e-6 size
float punctualFalloff(float r, float range)
{
    float x = safePositive(r) / max(range, exp2(-60.0));
    if (!(x < 1.0))
        return 0.0;
    // 1 - x^4 by its factors.
    float w = (1.0 - x) * (1.0 + x) * (1.0 + x * x);
    return min(w * w * attenuationInverseSquare(r), safeLargest());
}

// The factor of a cone: 1 inside of the inner angle, 0 outside of the outer one.
//   L  unit vector towards the light    Ldir  unit vector along the beam
//   inner, outer  1 - cos of the two angles, limited to [0, 2], the outer one to more than the inner one
// bound: 4e-6 abs, the edge of a narrow cone is steep
float punctualCone(vec3 L, vec3 Ldir, float inner, float outer)
{
    float low = clamp(inner, 0.0, 2.0);
    float high = clamp(outer, 0.0, 2.0);
    float u = safeOneMinusCos(-L, Ldir);
    if (!(high > low))
        return u <= low ? 1.0 : 0.0;
    float t = safeUnit((high - u) / (high - low));
    return t * t;
}

#endif
