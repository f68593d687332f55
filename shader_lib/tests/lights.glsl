// Tests of lights, color and helpers: `glisten test shader_lib/tests`.
#include <glisten/attenuation.glsl>
#include <glisten/spot.glsl>
#include <glisten/srgb.glsl>
#include <glisten/illumination.glsl>
#include <glisten/lut.glsl>
#include <glisten/safe.glsl>

//! test: (96) with one weight
//! r = 0.001..1000
void inverseSquare(float r, out float got, out float expected)
{
    got = attenuation(r, vec3(0.0, 0.0, 1.0));
    expected = attenuationInverseSquare(r);
}

//! test
//! 2.0, vec3(1, 0, 0) => 1.0
//! 2.0, vec3(0, 1, 0) => 0.5
//! 2.0, vec3(0, 0, 1) => 0.25
//! 2.0, vec3(1, 1, 1) => 0.142857142857
float attenuationValues(float r, vec3 s)
{
    return attenuation(r, s);
}

//! test
//! vec3(3, 0, 0), vec3(0, 4, 0) => 5.0
float distances(vec3 Pl, vec3 P)
{
    return lightDistance(Pl, P);
}

//! test: (98), 1 on the axis
//! L = unit, exponent = 0..100
//! tolerance 1e-5
void spotOnItsAxis(vec3 L, float exponent, out float got, out float expected)
{
    got = spotFactor(L, -L, exponent);
    expected = 1.0;
}

//! test: encoding and decoding cancel
//! x = 0.001..1
//! tolerance 1e-5
void thereAndBack(float x, out float got, out float expected)
{
    got = srgbDecode(srgbEncode(x));
    expected = x;
}

//! test: IEC 61966-2-1
//! 0.0 => 0.0
//! 0.001 => 0.01292
//! 1.0 => 1.0
float srgbValues(float linear)
{
    return srgbEncode(linear);
}

//! test: (93), the sum of the parts
//! a = 0..2, b = 0..2, c = 0..2
void sumOfParts(vec3 a, vec3 b, vec3 c, out vec3 got, out vec3 expected)
{
    got = illumination(a, b, c);
    expected = a + b + c;
}

//! test: the first and the last texel
//! 0.0, 4 => 0.125
//! 1.0, 4 => 0.875
//! 0.5, 4 => 0.5
float tableCoordinates(float x, float n)
{
    return lutCoordinate(x, n);
}

//! test
//! v = -1000..1000
//! tolerance 1e-5
void lengthOfANormalizedVector(vec3 v, out float got, out float expected)
{
    got = length(safeNormalize(v));
    expected = 1.0;
}

//! test
//! x = -1e38..1e38, y = -1e38..1e38
float sumsAreLimited(float x, float y)
{
    return safeFinite(safeLimit(x * 3.0) + safeLimit(y));
}
