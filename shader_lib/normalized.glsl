// name: normalized
// kind: specular
// equation: (k + 8) / (8 pi) (N.H)^k N.L and (k + 2) / (2 pi) (R.V)^k N.L
// source: Akenine-Moller, Haines and Hoffman, Real-Time Rendering, 3rd edition, section 7.6; Lafortune and Willems, Using the Modified Phong Reflectance Model, 1994
// stability: that of `blinn_phong` and `phong`: the error does not grow with the exponent
//
// Highlights that grow brighter as they grow smaller, so that a surface keeps its reflectance when its shininess changes. Factors are
// f times pi and N.L, as in `ggx`.
#ifndef GLISTEN_NORMALIZED
#define GLISTEN_NORMALIZED
#include "blinn_phong.glsl"
#include "phong.glsl"

// Blinn and Phong's factor.
//   N  unit normal    L, V  unit vectors towards the light and the eye    shininess  limited to [0, 2^24]
// bound: 6e-7 size
float normalizedBlinnFactor(vec3 N, vec3 L, vec3 V, float shininess)
{
    float k = clamp(shininess, 0.0, exp2(24.0));
    return (k / 8.0 + 1.0) * safeUnit(dot(N, L)) * blinnPhongFactor(N, L, V, k);
}

// Phong's factor.
//   N  unit normal    L, V  unit vectors towards the light and the eye    shininess  limited to [0, 2^24]
// bound: 6e-7 size
float normalizedPhongFactor(vec3 N, vec3 L, vec3 V, float shininess)
{
    float k = clamp(shininess, 0.0, exp2(24.0));
    return (k / 2.0 + 1.0) * safeUnit(dot(N, L)) * phongFactor(N, L, V, k);
}

#endif
