// name: irradiance
// kind: ambient
// equation: c_1 L_22 (x^2 - y^2) + c_3 L_20 z^2 + c_4 L_00 - c_5 L_20 + 2 c_1 (L_2-2 xy + L_21 xz + L_2-1 yz) + 2 c_2 (L_11 x + L_1-1 y + L_10 z)
// source: Ramamoorthi and Hanrahan, An Efficient Representation for Irradiance Environment Maps, SIGGRAPH 2001, (13)
// stability: a polynomial of the normal; finite for every finite input
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

#endif
