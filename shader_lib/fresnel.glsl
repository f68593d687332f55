// name: fresnel
// kind: specular
// equation: Fresnel's equations, F = (|r_s|^2 + |r_p|^2) / 2; Schlick: F = F_0 + (F_90 - F_0) (1 - cos)^5
// source: Born and Wolf, Principles of Optics, sections 1.5.2 and 14.2; Schlick, An Inexpensive BRDF Model, 1994
// stability: no differences cancel: not for equal media, and not for metals, whose n is small next to k
//
// How much light a smooth surface mirrors, by the cosine of the angle to its normal (for rough surfaces: to the half
// vector). Cosines are limited to [0, 1]: rounding takes them above 1, where Schlick's literal power is a NaN.
//
// With c for the cosine and g = sqrt(n^2 - 1 + c^2), the exact equations have c - g and n^2 c - g, which cancel where the
// media are nearly equal. They are -(n^2 - 1) / (c + g) and (n^2 - 1) (c^2 (n^2 + 1) - 1) / (n^2 c + g). A metal needs the
// complex root a + ib of (n + ik)^2 - sin^2: its smaller part is n k divided by the larger one.
#ifndef GLISTEN_FRESNEL
#define GLISTEN_FRESNEL
#include "safe.glsl"

// Schlick's approximation, linear RGB.
//   cosine  limited to [0, 1]    F0  reflectance at normal incidence, 0 to 1    F90  at grazing angles, mostly 1
// bound: 3e-7 color
vec3 fresnelSchlick(float cosine, vec3 F0, vec3 F90)
{
    float d = 1.0 - safeUnit(cosine);
    float p = d * d;
    p = p * p * d;
    return safeLimit((1.0 - p) * F0 + p * F90);
}

// The reflectance of a dielectric at normal incidence, F_0: 0.04 for glass.
//   n  the quotient of the refractive indices behind and before the surface, limited to >= 0
// bound: 3e-7 rel
float fresnelNormal(float n)
{
    n = clamp(n, 0.0, exp2(120.0));
    float r = (n - 1.0) / (n + 1.0);
    return r * r;
}

// The exact reflectance of a dielectric for unpolarized light; 1 where all light is reflected.
//   cosine  limited to [0, 1]    n  the quotient of the refractive indices, limited to [2^-20, 2^20]
// bound: 4e-7 abs
float fresnelDielectric(float cosine, float n)
{
    float c = safeUnit(cosine);
    n = clamp(n, exp2(-20.0), exp2(20.0));
    float k = (n - 1.0) * (n + 1.0);
    float g2 = c * c + k;
    if (k == 0.0)
        return 0.0;
    if (!(g2 > 0.0))
        return 1.0;
    float g = sqrt(g2);
    float s = k / ((c + g) * (c + g));
    float m = n * n * c + g;
    float p = k * (c * c * (n * n + 1.0) - 1.0) / (m * m);
    return min(0.5 * (s * s + p * p), 1.0);
}

// The exact reflectance of a metal for unpolarized light, by channel.
//   cosine  limited to [0, 1]    n, k  refractive index and extinction, limited to [2^-20, 2^20] and [0, 2^20]
// bound: 6e-7 abs
vec3 fresnelConductor(float cosine, vec3 n, vec3 k)
{
    float c = safeUnit(cosine);
    float s2 = (1.0 - c) * (1.0 + c);
    n = clamp(n, vec3(exp2(-20.0)), vec3(exp2(20.0)));
    k = clamp(k, vec3(0.0), vec3(exp2(20.0)));
    vec3 t = (n - k) * (n + k) - s2;
    vec3 nk = n * k;
    vec3 larger = sqrt(0.5 * (sqrt(t * t + 4.0 * nk * nk) + abs(t)));
    vec3 smaller = nk / max(larger, vec3(exp2(-60.0)));
    bvec3 real = greaterThan(t, vec3(0.0));
    vec3 a = vec3(real.x ? larger.x : smaller.x, real.y ? larger.y : smaller.y, real.z ? larger.z : smaller.z);
    vec3 b = vec3(real.x ? smaller.x : larger.x, real.y ? smaller.y : larger.y, real.z ? smaller.z : larger.z);
    vec3 tiny = vec3(exp2(-100.0));
    vec3 s = ((a - c) * (a - c) + b * b) / max((a + c) * (a + c) + b * b, tiny);
    vec3 bc = c * b;
    vec3 p = ((c * a - s2) * (c * a - s2) + bc * bc) / max((c * a + s2) * (c * a + s2) + bc * bc, tiny);
    return min(0.5 * s * (1.0 + p), vec3(1.0));
}

#endif
