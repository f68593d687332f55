// name: beckmann
// kind: specular
// equation: D = exp(-tan^2 / alpha^2) / (pi alpha^2 cos^4), Lambda(a) = (1 - 1.259 a + 0.396 a^2) / (3.535 a + 2.181 a^2), a = 1 / (alpha tan)
// source: Walter et al., Microfacet Models for Refraction, EGSR 2007, (25); Heitz, Masking-Shadowing Function, JCGT 2014, section 5.3
// stability: from |N x H|^2 and not 1 - (N.H)^2; nothing is divided by the cosine of a grazing direction
//
// Slopes with a normal distribution, as sandblasting makes them: a highlight with a softer top and no tail. alpha and the
// factor are as in `ggx`.
#ifndef GLISTEN_BECKMANN
#define GLISTEN_BECKMANN
#include "ggx.glsl"

// D, the density of microfacets with the normal H. 0 for H behind the surface.
//   N, H  unit normal and half vector    alpha  limited to [2^-20, 1]
// bound: 2e-4 size, e to the power of a large number, which rounds
float beckmannDistribution(vec3 N, vec3 H, float alpha)
{
    float a = ggxLimit(alpha);
    float c = min(dot(N, H), 1.0);
    // Below, e^(-2^20 / alpha^2) is 0.
    if (!(c > exp2(-10.0)))
        return 0.0;
    vec3 s = cross(N, H);
    float ac = a * c;
    float t = dot(s, s) / (ac * ac);
    return safeFinite(exp(max(-t, -safeLargest())) / (radians(180.0) * ac * ac * c * c));
}

// The cosine of a direction times its Lambda, the part that other microfacets hide. Finite where Lambda is not.
//   cosine  limited to [0, 1]    alpha  limited to [2^-20, 1]
// bound: 6e-7 abs
float beckmannHidden(float cosine, float alpha)
{
    float c = safeUnit(cosine);
    float as = ggxLimit(alpha) * sqrt((1.0 - c) * (1.0 + c));
    if (!(c < 1.6 * as))
        return 0.0;
    float a = c / as;
    return as * max(1.0 + a * (0.396 * a - 1.259), 0.0) / (3.535 + 2.181 * a);
}

// pi D V N.L: the factor of a light without pi.
//   N  unit normal    L, V  unit vectors towards the light and the eye    alpha  limited to [2^-20, 1]
// bound: 2e-4 size, e to the power of a large number, which rounds
float beckmannFactor(vec3 N, vec3 L, vec3 V, float alpha)
{
    float NL = min(dot(N, L), 1.0);
    if (!(NL > 0.0))
        return 0.0;
    float NV = safeUnit(dot(N, V));
    float d = NL * NV + NV * beckmannHidden(NL, alpha) + NL * beckmannHidden(NV, alpha);
    float D = radians(180.0) * beckmannDistribution(N, halfVector(L, V), alpha);
    return d > 0.0 ? safeFinite(D * (0.25 * NL / d)) : 0.0;
}

#endif
