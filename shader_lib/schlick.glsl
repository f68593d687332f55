// name: schlick
// kind: specular
// equation: (90): t / (K_shi - t K_shi + t), t = cos(theta_r) or cos(theta_h)
// source: textbook, section 10.1.4
// stability: K - tK does not cancel, so the error does not grow with K as in the literal (90)
//
// Schlick's rational approximation of the power t^K, written as t / (K d + t) with d = 1 - t computed from the
// vectors' distance. Outside the model: t is limited to [0, 1] (otherwise (90) has a pole at t = -K / (1 - K)); t = 0
// yields 0, also for K = 0, where (90) is 0/0. A surface that the light does not reach (N.L <= 0) has no highlight.
#ifndef GLISTEN_SCHLICK
#define GLISTEN_SCHLICK
#include "blinn_phong.glsl"
#include "phong.glsl"

// (90) for a cosine t: 0 to 1.
//   t  limited to [0, 1]    shininess  K_shi, limited to >= 0
// bound: 2.4e-7 abs
float schlick(float t, float shininess)
{
    t = safeUnit(t);
    return t > 0.0 ? t / (max(shininess, 0.0) * (1.0 - t) + t) : 0.0;
}

// (90) for the angle between two unit vectors: 0 to 1.
//   a, b  unit vectors    shininess  K_shi, limited to >= 0
// bound: 2.4e-7 abs
float schlickBetween(vec3 a, vec3 b, float shininess)
{
    float t = dot(a, b);
    if (!(t > 0.0))
        return 0.0;
    float d = safeOneMinusCos(a, b);
    // As in safeCosPow(): the distance near 1, the cosine elsewhere.
    t = d < 0.125 ? 1.0 - d : min(t, 1.0);
    return t / (max(shininess, 0.0) * min(d, 1.0) + t);
}

// (90) on the angle between half vector and normal, instead of Blinn and Phong's power.
//   N  unit normal    L, V  unit vectors towards the light and the eye    shininess  K_shi, limited to >= 0
// bound: 2.4e-7 abs
float schlickBlinnFactor(vec3 N, vec3 L, vec3 V, float shininess)
{
    return dot(N, L) > 0.0 ? schlickBetween(N, halfVector(L, V), shininess) : 0.0;
}

// (90) on the angle between mirror direction and eye, instead of Phong's power. Arguments as above.
// bound: 2.4e-7 abs
float schlickPhongFactor(vec3 N, vec3 L, vec3 V, float shininess)
{
    return dot(N, L) > 0.0 ? schlickBetween(mirrorDirection(N, L), V, shininess) : 0.0;
}

#endif
