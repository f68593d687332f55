// name: schlick
// kind: specular
// equation: (90): t / (K_shi - t K_shi + t), t = cos(theta_r) or cos(theta_h)
// source: textbook, section 10.1.4
//
// Schlick's rational stand-in for the power t^K. Written as t / (K d + t) with d = 1 - t taken from the vectors' distance,
// so that K - tK does not cancel. Outside the model: t is limited to [0, 1] (without that (90) has a pole at
// t = -K / (1 - K)); t = K = 0, where (90) is 0/0, gives 0.
#ifndef GLISTEN_SCHLICK
#define GLISTEN_SCHLICK
#include "blinn_phong.glsl"
#include "phong.glsl"

// (90) for the cosine 1 - d, d >= 0.
float schlickFromDistance(float d, float shininess)
{
    float t = 1.0 - d;
    if (!(t > 0.0))
        return 0.0;
    return t / (max(shininess, 0.0) * d + t);
}

// (90) for a cosine t, limited to [0, 1].
float schlick(float t, float shininess)
{
    return schlickFromDistance(1.0 - safeUnit(t), shininess);
}

// (90) on the angle between half vector and normal, in place of Blinn and Phong's power.
float schlickBlinnFactor(vec3 N, vec3 L, vec3 V, float shininess)
{
    vec3 H = halfVector(L, V);
    if (!(dot(N, L) > 0.0) || !(dot(N, H) > 0.0))
        return 0.0;
    return schlickFromDistance(safeOneMinusCos(N, H), shininess);
}

// (90) on the angle between mirror direction and eye, in place of Phong's power.
float schlickPhongFactor(vec3 N, vec3 L, vec3 V, float shininess)
{
    vec3 R = mirrorDirection(N, L);
    if (!(dot(N, L) > 0.0) || !(dot(R, V) > 0.0))
        return 0.0;
    return schlickFromDistance(safeOneMinusCos(R, V), shininess);
}

#endif
