// name: attenuation
// kind: light
// equation: (94), (95), (96): r = |P_l - P|, d = 1 / r^2, d = 1 / (s_c + s_l r + s_q r^2)
// source: textbook, section 10.1.5
//
// Outside the model: r = 0 in (95), and weights that sum to nothing in (96), give the largest float.
#ifndef GLISTEN_ATTENUATION
#define GLISTEN_ATTENUATION
#include "safe.glsl"

// The distance (94) of the shaded point P from the light at Pl.
float lightDistance(vec3 Pl, vec3 P)
{
    return safeLength(Pl - P);
}

// The inverse square law (95).
float attenuationInverseSquare(float r)
{
    if (!(r > 0.0))
        return safeLargest();
    // 1/r twice and not 1/(r r): the square of a small r is already 0 where 1/r still has its value.
    float q = 1.0 / r;
    return min(q * q, safeLargest());
}

// The law with three weights (96), each >= 0; s = (s_c, s_l, s_q).
float attenuation(float r, vec3 s)
{
    if (r > 1.0) {
        // In powers of 1/r nothing overflows; with s_q (or s_q and s_l) zero a power less is asked for.
        float q = 1.0 / r;
        if (s.z > 0.0)
            return min(q * (q / (q * (s.x * q + s.y) + s.z)), safeLargest());
        if (s.y > 0.0)
            return min(q / (s.x * q + s.y), safeLargest());
        return s.x > 0.0 ? min(1.0 / s.x, safeLargest()) : safeLargest();
    }
    float below = s.x + r * (s.y + s.z * r);
    return below > 0.0 ? min(1.0 / below, safeLargest()) : safeLargest();
}

#endif
