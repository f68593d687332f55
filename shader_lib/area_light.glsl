// name: area_light
// kind: light
// equation: the point of a sphere that is nearest to the mirror direction; E = (r / d)^2 N.L for a sphere above the horizon
// source: Karis, Real Shading in Unreal Engine 4, SIGGRAPH course 2013, pages 14 to 17
// stability: lengths without overflow; a ray through the light's middle needs no division by its distance
//
// Lights with a size: highlights take their shape. Use the direction that these give instead of L, in `ggx` or any other highlight.
#ifndef GLISTEN_AREA_LIGHT
#define GLISTEN_AREA_LIGHT
#include "safe.glsl"

// The unit vector towards the point of a sphere that is nearest to the ray of the mirror direction: R inside of it.
//   center  of the light, from the shaded point    radius  limited to >= 0    R  unit vector: the eye's mirror direction
// bound: 6e-6 abs, near the middle of a large sphere the distance is a difference
vec3 areaSphere(vec3 center, float radius, vec3 R)
{
    float s = safeScale(max(safeExtent(center), abs(radius)));
    vec3 c = s * center;
    float r = s * max(radius, 0.0);
    if (!(safeLength(c) > r))
        return R;
    vec3 off = max(dot(c, R), 0.0) * R - c;
    float d = safeLength(off);
    return safeNormalize(safeFinite(c + off * (d > r ? r / d : 1.0)));
}

// The irradiance of a sphere of radiance 1 over pi, which replaces N.L / d^2 of a point light: exact where the whole sphere is above
// the horizon, and 0 below it.
//   N  unit normal    center  of the light, from the shaded point    radius  limited to >= 0
// bound: 6e-7 abs
float areaSphereFactor(vec3 N, vec3 center, float radius)
{
    float d = safeLength(center);
    float r = max(radius, 0.0);
    // Inside of the sphere, light comes from everywhere.
    float sine = d > r ? r / d : 1.0;
    return sine * sine * safeUnit(dot(N, safeNormalize(center)));
}

#endif
