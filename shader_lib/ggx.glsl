// name: ggx
// kind: specular
// equation: f = D V F; D = alpha^2 / (pi cos^4 (alpha^2 + tan^2)^2), V = G_2 / (4 N.L N.V) with Smith's correlated G_2
// source: Walter et al., Microfacet Models for Refraction, EGSR 2007, (33); Heitz, Masking-Shadowing Function, JCGT 2014, (72), (85), (99); KHR_materials_anisotropy, Khronos 2023
// stability: from |N x H|^2 and not 1 - (N.H)^2, so highlights hold their shape down to alpha = 1e-6, a roughness of 0.001
//
// The microfacet model of Trowbridge and Reitz, which everybody calls GGX. alpha is limited to [2^-20, 1]; artists set its
// root, the roughness of glTF: pass roughness * roughness.
//
// Factors are f times pi and the cosine of the light, since the library's lights are without pi: Lambert's factor for
// them is N.L. An eye below the surface, as interpolated normals have it, counts as grazing; a light below it gives nothing.
#ifndef GLISTEN_GGX
#define GLISTEN_GGX
#include "blinn_phong.glsl"
#include "fresnel.glsl"

// alpha as the models use it.
// bound: 0 rel
float ggxLimit(float alpha)
{
    return clamp(alpha, exp2(-20.0), 1.0);
}

// D, the density of microfacets with the normal H; its integral times N.H is 1. 0 for H behind the surface.
//   N, H  unit normal and half vector    alpha  limited to [2^-20, 1]
// bound: 6e-7 rel
float ggxDistribution(vec3 N, vec3 H, float alpha)
{
    float a = ggxLimit(alpha);
    float c = dot(N, H);
    if (!(c > 0.0))
        return 0.0;
    vec3 s = cross(N, H);
    float ac = a * min(c, 1.0);
    float k = a / (dot(s, s) + ac * ac);
    return safeFinite(k * k / radians(180.0));
}

// D for a brushed surface.
//   N, T, H  unit normal, unit tangent and half vector    alpha  along T and across it, each limited to [2^-20, 1]
// bound: 1e-6 rel
float ggxDistribution(vec3 N, vec3 T, vec3 H, vec2 alpha)
{
    vec2 a = vec2(ggxLimit(alpha.x), ggxLimit(alpha.y));
    float z = dot(N, H);
    if (!(z > 0.0))
        return 0.0;
    vec2 p = vec2(dot(T, H), dot(cross(N, T), H)) / a;
    float q = min(dot(p, p) + z * z, exp2(60.0));
    return safeFinite(1.0 / (radians(180.0) * a.x * a.y * q * q));
}

// V, Smith's shadowing and masking, correlated by height, divided by 4 N.L N.V. The largest float where both are 0.
//   NL, NV  the cosines, limited to [0, 1]    alpha  limited to [2^-20, 1]
// bound: 4e-7 rel
float ggxVisibility(float NL, float NV, float alpha)
{
    float a = ggxLimit(alpha);
    float l = safeUnit(NL);
    float v = safeUnit(NV);
    float w = (1.0 - a) * (1.0 + a);
    float d = l * sqrt(a * a + w * v * v) + v * sqrt(a * a + w * l * l);
    return d > 0.0 ? min(0.5 / d, safeLargest()) : safeLargest();
}

// pi D V N.L: the factor of a light without pi.
//   N  unit normal    L, V  unit vectors towards the light and the eye    alpha  limited to [2^-20, 1]
// bound: 2e-6 size, dozens of roundings
float ggxFactor(vec3 N, vec3 L, vec3 V, float alpha)
{
    float NL = min(dot(N, L), 1.0);
    if (!(NL > 0.0))
        return 0.0;
    float a = ggxLimit(alpha);
    float v = safeUnit(dot(N, V));
    float w = (1.0 - a) * (1.0 + a);
    float d = NL * sqrt(a * a + w * v * v) + v * sqrt(a * a + w * NL * NL);
    float D = radians(180.0) * ggxDistribution(N, halfVector(L, V), a);
    return d > 0.0 ? safeFinite(D * (0.5 * NL / d)) : 0.0;
}

// The same for a brushed surface. 0 for an eye straight below it, which has no grazing direction.
//   N, T  unit normal and unit tangent    L, V  unit vectors    alpha  along T and across it, each limited to [2^-20, 1]
// bound: 2e-6 size, dozens of roundings
float ggxFactor(vec3 N, vec3 T, vec3 L, vec3 V, vec2 alpha)
{
    float NL = min(dot(N, L), 1.0);
    if (!(NL > 0.0))
        return 0.0;
    vec2 a = vec2(ggxLimit(alpha.x), ggxLimit(alpha.y));
    float NV = safeUnit(dot(N, V));
    vec3 B = cross(N, T);
    // The stretched directions, of which Smith's function is the length; their heights are the cosines.
    vec2 light = a * vec2(dot(T, L), dot(B, L));
    vec2 eye = vec2(dot(T, V), dot(B, V));
    if (!(NV > 0.0))
        eye = safeNormalize(vec3(eye, 0.0)).xy;
    eye *= a;
    float l = sqrt(NL * NL + dot(light, light));
    float v = sqrt(NV * NV + dot(eye, eye));
    float d = NL * v + NV * l;
    float D = radians(180.0) * ggxDistribution(N, T, halfVector(L, V), a);
    return d > 0.0 ? safeFinite(D * (0.5 * NL / d)) : 0.0;
}

// The widths of a brushed surface: along T, which is across the scratches and where highlights are wide, and across it.
//   roughness  along the scratches, the root of alpha, limited to [0, 1]    strength  limited to [0, 1]: 0 for a surface that is not brushed
// bound: 3e-7 abs
vec2 ggxBrushed(float roughness, float strength)
{
    float r = safeUnit(roughness);
    float s = safeUnit(strength);
    float a = r * r;
    return vec2(a + s * s * (1.0 - a), a);
}

// The normal by which a brushed surface mirrors its surroundings: bent towards the eye in the plane of N and T, more as it is smoother.
//   N, T  unit normal, and unit tangent across the scratches    V  unit vector towards the eye    roughness, strength  as of ggxBrushed()
// bound: 2e-6 abs, the eye's direction in that plane
vec3 ggxBent(vec3 N, vec3 T, vec3 V, float roughness, float strength)
{
    vec3 B = cross(N, T);
    vec3 across = safeNormalize(safeFinite(V - dot(V, B) * B));
    float k = 1.0 - safeUnit(strength) * (1.0 - safeUnit(roughness));
    k *= k;
    k *= k;
    vec3 bent = safeNormalize(safeFinite((1.0 - k) * across + k * N));
    return dot(bent, bent) > 0.0 ? bent : N;
}

// The specular reflection of white light from everywhere, by the fit that Karis published for mobile GPUs. It was made for dielectrics:
// for F_0 = 1 and a roughness of 1 it is 0.45 at every angle, where the integral of this module's f is 0.64 at N.V = 0.2 and nearly 1 at 0;
// the table `ltc_albedo` has that.
//   cosine  N.V, limited to [0, 1]    roughness  the root of alpha, limited to [0, 1]    Kspec  reflectance at normal incidence, 0 to 1
// bound: 2e-6 color, e to a power, and coefficients that cancel
vec3 ggxAlbedo(float cosine, float roughness, vec3 Kspec)
{
    vec4 r = safeUnit(roughness) * vec4(-1.0, -0.0275, -0.572, 0.022) + vec4(1.0, 0.0425, 1.04, -0.04);
    float a = min(r.x * r.x, exp2(-9.28 * safeUnit(cosine))) * r.x + r.y;
    return safeLimit(max(Kspec * (r.z - 1.04 * a) + (1.04 * a + r.w), vec3(0.0)));
}

// Specular reflection with Schlick's Fresnel term, linear RGB.
//   N  unit normal    L, V  unit vectors towards the light and the eye    alpha  limited to [2^-20, 1]
//   Kspec  reflectance at normal incidence, 0 to 1    Lspec  intensity of the light, >= 0
// bound: 2e-6 size, dozens of roundings
vec3 ggx(vec3 N, vec3 L, vec3 V, float alpha, vec3 Kspec, vec3 Lspec)
{
    vec3 F = fresnelSchlick(dot(V, halfVector(L, V)), Kspec, vec3(1.0));
    return safeLimit(ggxFactor(N, L, V, alpha) * safeLimit(F * Lspec));
}

#endif
