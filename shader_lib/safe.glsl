// name: safe
// kind: helper
// equation: none
// source: none
// stability: finite for every finite input
//
// Building blocks that are finite for every finite input. Each equals the plain form wherever that is defined and
// does not overflow in between. Numbers below 2^-126 may count as 0: most GPUs flush them.
//
// Literals here and in all modules are exact in binary, or quotients of exact ones, so that the same text is also
// accurate when evaluated in f64.
#ifndef GLISTEN_SAFE
#define GLISTEN_SAFE

// The largest finite float, 2^128 - 2^104.
// bound: 0 abs
float safeLargest()
{
    return 16777215.0 * exp2(104.0);
}

// x with infinities replaced by the largest floats. x must not be a NaN.
// bound: 0 rel
float safeLimit(float x)
{
    return clamp(x, -safeLargest(), safeLargest());
}

// The scalar function for each component.
// bound: 0 rel
vec3 safeLimit(vec3 v)
{
    return clamp(v, vec3(-safeLargest()), vec3(safeLargest()));
}

// The scalar function for each component.
// bound: 0 rel
vec4 safeLimit(vec4 v)
{
    return clamp(v, vec4(-safeLargest()), vec4(safeLargest()));
}

// x with infinities replaced by the largest floats and a NaN by 0. It uses only comparisons: what min() and max()
// return for a NaN depends on the driver.
// bound: 0 rel
float safeFinite(float x)
{
    return x > 0.0 ? min(x, safeLargest()) : (x < 0.0 ? max(x, -safeLargest()) : 0.0);
}

// The scalar function for each component.
// bound: 0 rel
vec3 safeFinite(vec3 v)
{
    return vec3(safeFinite(v.x), safeFinite(v.y), safeFinite(v.z));
}

// max(x, 0), at most the largest float; 0 for a NaN.
// bound: 0 rel
float safePositive(float x)
{
    return x > 0.0 ? min(x, safeLargest()) : 0.0;
}

// x limited to [0, 1]; 0 for a NaN.
// bound: 0 abs
float safeUnit(float x)
{
    return x > 0.0 ? min(x, 1.0) : 0.0;
}

// The largest of |v.x|, |v.y|, |v.z|.
// bound: 0 rel
float safeExtent(vec3 v)
{
    vec3 a = abs(v);
    return max(a.x, max(a.y, a.z));
}

// The power of two 2^-100, 1 or 2^100 by which a vector of this extent is multiplied so that the square of a
// component neither overflows nor, if it matters, is flushed to zero. Multiplying by a power of two does not round.
// bound: 0 abs
float safeScale(float extent)
{
    return extent > exp2(60.0) ? exp2(-100.0) : (extent < exp2(-40.0) ? exp2(100.0) : 1.0);
}

// |v| for every finite v, where the literal length() overflows from 1.8e19 on and vanishes below 1.1e-19. It is
// limited to the largest float.
// bound: 2.4e-7 rel
float safeLength(vec3 v)
{
    float s = safeScale(safeExtent(v));
    vec3 u = s * v;
    return min(sqrt(dot(u, u)) / s, safeLargest());
}

// v / |v| for every finite v but zero, where the literal form yields 0 or NaN for lengths outside 1.1e-19 to 1.8e19.
// The zero vector stays the zero vector: no direction, and no light from it.
// bound: 2.4e-7 abs
vec3 safeNormalize(vec3 v)
{
    float m = safeExtent(v);
    if (!(m > 0.0))
        return vec3(0.0);
    vec3 u = safeScale(m) * v;
    return u / sqrt(dot(u, u));
}

// log(1 - d) for d in [0, 1), accurate for small d where 1 - d loses it: -2 atanh(d / (2 - d)) by its series. 0 for d
// <= 0, the largest negative float for d >= 1.
// bound: 2.4e-7 rel
float safeLogOneMinus(float d)
{
    if (!(d > 0.0))
        return 0.0;
    if (d >= 1.0)
        return -safeLargest();
    if (d > 0.125)
        return log(1.0 - d);
    float s = d / (2.0 - d);
    float q = s * s;
    // At d = 1/8, the first omitted term is 2e-18 of the sum.
    float sum = 1.0 + q * (1.0 / 3.0 + q * (1.0 / 5.0 + q * (1.0 / 7.0 + q * (1.0 / 9.0 + q * (1.0 / 11.0 + q / 13.0)))));
    return -2.0 * s * sum;
}

// (1 - d)^k: the power of a number in [0, 1] whose distance d from 1 is known more precisely than the number.
//   d  limited to [0, 1]    k  limited to k >= 0
// 1 for k = 0 (also at d = 1, where the literal power is 0^0).
// bound: 2.4e-7 abs
float safePowOneMinus(float d, float k)
{
    if (!(k > 0.0))
        return 1.0;
    return d < 1.0 ? exp(max(k * safeLogOneMinus(d), -safeLargest())) : 0.0;
}

// x^k.
//   x  limited to [0, 1]    k  limited to k >= 0
// 1 for k = 0 (also 0^0). Near x = 1 the logarithm is computed by a series: a GPU's log2 loses precision there, and k
// amplifies the loss.
// bound: 2.4e-7 abs
float safePow(float x, float k)
{
    if (!(k > 0.0))
        return 1.0;
    x = safeUnit(x);
    if (!(x > 0.0))
        return 0.0;
    float l = x < 0.875 ? log(x) : safeLogOneMinus(1.0 - x);
    return exp(max(k * l, -safeLargest()));
}

// 1 - cos of the angle between two unit vectors: |a - b|^2 / 2. If a and b are close, this keeps the digits that
// dot(a, b) rounds away. At least 0, at most the largest float.
// bound: 3e-7 abs
float safeOneMinusCos(vec3 a, vec3 b)
{
    vec3 d = a - b;
    return min(0.5 * dot(d, d), safeLargest());
}

// max(cos, 0)^k of the angle between two unit vectors, 0 to 1: near 1 from |a - b|^2 / 2, so that the error does not
// grow with the exponent; elsewhere from dot(a, b), which is exact for perpendicular vectors.
//   k  limited to k >= 0
// 1 for k = 0, whatever the angle (the literal power is 0^0 from a right angle on).
// bound: 2.4e-7 abs
float safeCosPow(vec3 a, vec3 b, float k)
{
    if (!(k > 0.0))
        return 1.0;
    float c = dot(a, b);
    if (!(c > 0.0))
        return 0.0;
    float d = safeOneMinusCos(a, b);
    float l = d < 0.125 ? safeLogOneMinus(d) : log(min(c, 1.0));
    return exp(max(k * l, -safeLargest()));
}

#endif
