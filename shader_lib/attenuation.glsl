// name: attenuation
// kind: light
// equation: (94), (95), (96): r = |P_l - P|, d = 1 / r^2, d = 1 / (s_c + s_l r + s_q r^2)
// source: textbook, section 10.1.5
// stability: the literal (96) is NaN for a zero weight once r^2 overflows; this is correct to rounding of normal floats
//
// Outside the model: r = 0 in (95), and weights of (96) that are all zero, yield the largest float. A GPU may take a
// sum of (96) below the smallest normal float, 2^-126, for zero, too, and a result below it.
#ifndef GLISTEN_ATTENUATION
#define GLISTEN_ATTENUATION
#include "safe.glsl"

// The distance (94) of the shaded point P from the light at Pl, both in the same space; at most the largest float.
// bound: 2.4e-7 rel
float lightDistance(vec3 Pl, vec3 P)
{
    return safeLength(safeLimit(Pl - P));
}

// The inverse square law (95) for a distance r >= 0, at most the largest float.
// bound: 3e-7 rel
float attenuationInverseSquare(float r)
{
    if (!(r > 0.0))
        return safeLargest();
    // 1/r twice and not 1/(r r): the square of a small r is 0 while 1/r is still representable.
    float q = min(1.0 / r, safeLargest());
    return min(q * q, safeLargest());
}

// The law with three weights (96), at most the largest float.
//   r  distance >= 0    s  (s_c, s_l, s_q), each >= 0: constant, inverse, inverse square part
// s = (1, 0, 0) is 1 at any distance, (0, 1, 0) is 1/r, (0, 0, 1) is (95).
// bound: 3e-7 rel
float attenuation(float r, vec3 s)
{
    // With Horner's rule, 0 is never multiplied by infinity: a zero weight removes its power of r before r is
    // squared. Where the sum overflows, d is below the smallest normal float. Where r is so small that its square is,
    // the sum is scaled by a power of two, which does not round.
    float scale = r < 1.0 ? exp2(24.0) : 1.0;
    float sum = scale * s.x + scale * r * (s.y + r * s.z);
    return sum > 0.0 ? min(scale / sum, safeLargest()) : safeLargest();
}

#endif
