// name: irradiance
// kind: ambient
// equation: E = c_1 L_22 (x^2 - y^2) + c_3 L_20 z^2 + c_4 L_00 - c_5 L_20 + 2 c_1 (L_2-2 xy + L_21 xz + L_2-1 yz) + 2 c_2 (L_11 x + L_1-1 y + L_10 z)
// source: Ramamoorthi and Hanrahan, An Efficient Representation for Irradiance Environment Maps, SIGGRAPH 2001, (13); Frequency Space Environment Map Rendering, SIGGRAPH 2002
// stability: polynomials of a direction; a rough mirror's lobe by its distance from the middle, and by Gauss' rule where logarithms cancel
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

// How much of the second and the third band a rough mirror shows: the mean of cos and of (3 cos^2 - 1) / 2 over D (N.L) of `ggx` for
// N = V = R, as in the maps of `environment`. 1 and 1 for a smooth mirror, 2/3 and 1/4 for the roughness 1, as irradiance() has them.
//   roughness  the root of alpha, limited to [2^-6, 1]
// bound: 4e-6 abs, differences of logarithms
vec2 irradianceLobe(float roughness)
{
    float r = clamp(roughness, exp2(-6.0), 1.0);
    float a = r * r;
    // The density is 1 / (1 + x u)^2 with u = 1 - cos; m is its moments from u = 0 to 1.
    float x = 0.5 * (1.0 - a) * (1.0 + a) / (a * a);
    vec4 m = vec4(0.0);
    if (x < 1.0) {
        // Gauss' rule with five points is within 1e-7 of the integral.
        for (int k = -2; k <= 2; ++k) {
            float size = abs(float(k));
            float u = 0.5 + 0.5 * sign(float(k)) * (size < 0.5 ? 0.0 : size < 1.5 ? 0.5384693101 : 0.9061798459);
            float weight = size < 0.5 ? 0.2844444444 : size < 1.5 ? 0.2393143352 : 0.1184634425;
            float d = 1.0 + x * u;
            m += weight / (d * d) * vec4(1.0, u, u * u, u * u * u);
        }
    } else {
        float t = 1.0 + x;
        float log_t = log(t);
        m.x = 1.0 / t;
        m.y = (log_t - x / t) / (x * x);
        m.z = (x + x / t - 2.0 * log_t) / (x * x * x);
        m.w = (0.5 * x * (x - 4.0) - x / t + 3.0 * log_t) / (x * x * x * x);
    }
    float all = m.x - m.y;
    return vec2(1.0 - (m.y - m.z) / all, 1.0 - 1.5 * (2.0 * m.y - 3.0 * m.z + m.w) / all);
}

// The radiance that a rough mirror shows, linear RGB. It may be negative, as any sum of few bands.
//   R  unit vector, the eye's mirror direction    c  the coefficients, as for irradiance()    roughness  as for irradianceLobe()
// bound: 8e-6 color, the lobe
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
