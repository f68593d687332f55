// name: safe
// kind: helper
// equation: none
// source: none
//
// Building blocks that are finite for every finite input. Each equals the plain form wherever that is defined and
// does not overflow on the way.
//
// Literals here and in all modules are exact in binary or quotients of such, so that the same text evaluated in f64 is
// right to f64's last places.
#ifndef GLISTEN_SAFE
#define GLISTEN_SAFE

// The largest finite float.
float safeLargest()
{
    return 16777215.0 * exp2(104.0);
}

// max(x, 0) that is 0 for a NaN, too, whatever the driver's max() does.
float safePositive(float x)
{
    return x > 0.0 ? x : 0.0;
}

// x limited to [0, 1]; 0 for a NaN.
float safeUnit(float x)
{
    return x > 0.0 ? min(x, 1.0) : 0.0;
}

// |v| for every finite v: scaled by its largest component, so that no square leaves the range of a float.
// Past the largest float: the largest float.
float safeLength(vec3 v)
{
    vec3 a = abs(v);
    float m = max(a.x, max(a.y, a.z));
    if (!(m > 0.0))
        return 0.0;
    vec3 u = v / m;
    return min(m * sqrt(dot(u, u)), safeLargest());
}

// v / |v| for every finite v but zero; the zero vector stays the zero vector (no direction, and no light from it).
vec3 safeNormalize(vec3 v)
{
    vec3 a = abs(v);
    float m = max(a.x, max(a.y, a.z));
    if (!(m > 0.0))
        return vec3(0.0);
    vec3 u = v / m;
    return u / sqrt(dot(u, u));
}

// log(1 - d) for d in [0, 1), accurate for small d where 1 - d has lost it: -2 atanh(d / (2 - d)) by its series.
// Returns the largest negative float for d >= 1.
float safeLogOneMinus(float d)
{
    if (d >= 1.0)
        return -safeLargest();
    if (d > 0.125)
        return log(1.0 - d);
    float s = d / (2.0 - d);
    float q = s * s;
    // At d = 1/8 the first term left out is 2e-18 of the sum.
    float sum = 1.0 + q * (1.0 / 3.0 + q * (1.0 / 5.0 + q * (1.0 / 7.0 + q * (1.0 / 9.0 + q * (1.0 / 11.0 + q / 13.0)))));
    return -2.0 * s * sum;
}

// (1 - d)^k for d >= 0 and k >= 0: the power of a cosine whose distance d from 1 is known better than itself.
// 1 for k = 0 (also at d >= 1, where the literal power is 0^0), 0 for d >= 1 and k > 0.
float safePowOneMinus(float d, float k)
{
    if (!(k > 0.0))
        return 1.0;
    if (!(d > 0.0))
        return 1.0;
    if (d >= 1.0)
        return 0.0;
    return exp(max(k * safeLogOneMinus(d), -safeLargest()));
}

// x^k for x in [0, 1] (limited to it) and k >= 0 (limited to it); 0^0 is 1.
float safePow(float x, float k)
{
    if (!(k > 0.0))
        return 1.0;
    x = safeUnit(x);
    if (x <= 0.0)
        return 0.0;
    return safePowOneMinus(1.0 - x, k);
}

// The distance 1 - cos of two unit vectors from each other: |a - b|^2 / 2. Where a and b are near, this keeps the
// digits that dot(a, b) rounds away.
float safeOneMinusCos(vec3 a, vec3 b)
{
    vec3 d = a - b;
    return 0.5 * dot(d, d);
}

#endif
