// name: irradiance
// kind: ambient
// equation: E = c_1 L_22 (x^2 - y^2) + c_3 L_20 z^2 + c_4 L_00 - c_5 L_20 + 2 c_1 (L_2-2 xy + L_21 xz + L_2-1 yz) + 2 c_2 (L_11 x + L_1-1 y + L_10 z)
// source: Ramamoorthi and Hanrahan, An Efficient Representation for Irradiance Environment Maps, SIGGRAPH 2001, (13); Frequency Space Environment Map Rendering, SIGGRAPH 2002
// stability: polynomials of a direction and of a roughness; finite for every finite input
//
// The light that a surface gets from all around, by nine coefficients of spherical harmonics. The hemisphere of the article is its
// first four, exactly: L_00 from the mean of the two colors, L_10 from their difference.
#ifndef GLISTEN_IRRADIANCE
#define GLISTEN_IRRADIANCE
#include "safe.glsl"

// Irradiance over pi, linear RGB: what a white surface shows, as with the library's lights.
//   N  unit normal    c  the coefficients of the radiance: L_00, L_1-1, L_10, L_11, L_2-2, L_2-1, L_20, L_21, L_22
// bound: 1e-6 color
vec3 irradiance(vec3 N, vec3 c[9])
{
    vec3 n = clamp(N, vec3(-1.0), vec3(1.0));
    float s = exp2(-8.0);
    vec3 e = 0.886227 * (s * c[0]) + 1.023328 * ((s * c[1]) * n.y + (s * c[2]) * n.z + (s * c[3]) * n.x)
        + 0.858086 * ((s * c[4]) * (n.x * n.y) + (s * c[5]) * (n.y * n.z) + (s * c[7]) * (n.x * n.z))
        + (s * c[6]) * (0.743125 * n.z * n.z - 0.247708) + 0.429043 * (s * c[8]) * (n.x * n.x - n.y * n.y);
    return safeLimit(e / (radians(180.0) * s));
}

// How much of the second and the third band a rough mirror shows: 1 and 1 for a smooth one, 2/3 and 1/4 for the roughness 1, as
// irradiance() has them. A fit within 1e-3 of the mean of cos and of (3 cos^2 - 1) / 2 over D (N.L) of `ggx` for N = V = R, by which the
// maps of `environment` are made.
//   roughness  the root of alpha, limited to [0, 1]
// bound: 3e-6 abs, a polynomial with large coefficients
vec2 irradianceLobe(float roughness)
{
    float r = safeUnit(roughness);
    vec2 rest = vec2(0.92711, 4.14206);
    rest = vec2(4.1439, 15.75818) - r * rest;
    rest = vec2(-6.498, -21.56136) + r * rest;
    rest = vec2(3.8422, 11.33742) + r * rest;
    rest = vec2(-0.22766, -0.64218) + r * rest;
    return clamp(1.0 - r * r * rest, vec2(0.0), vec2(1.0));
}

// The radiance that a rough mirror shows, linear RGB. It may be negative, as any sum of few bands.
//   R  unit vector, the eye's mirror direction    c  the coefficients, as for irradiance()    roughness  as for irradianceLobe()
// bound: 2e-6 color, the lobe
vec3 irradianceMirrored(vec3 R, vec3 c[9], float roughness)
{
    vec3 d = clamp(R, vec3(-1.0), vec3(1.0));
    vec2 lobe = irradianceLobe(roughness);
    float s = exp2(-8.0);
    vec3 second = 0.488603 * ((s * c[1]) * d.y + (s * c[2]) * d.z + (s * c[3]) * d.x);
    vec3 third = 1.092548 * ((s * c[4]) * (d.x * d.y) + (s * c[5]) * (d.y * d.z) + (s * c[7]) * (d.x * d.z))
        + (s * c[6]) * (0.946175 * d.z * d.z - 0.315392) + 0.546274 * (s * c[8]) * (d.x * d.x - d.y * d.y);
    return safeLimit((0.282095 * (s * c[0]) + lobe.x * second + lobe.y * third) / s);
}

#endif
