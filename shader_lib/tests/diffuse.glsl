// Tests of the diffuse and ambient models: `glisten test shader_lib/tests`.
#include <glisten/lambert.glsl>
#include <glisten/half_lambert.glsl>
#include <glisten/hemisphere.glsl>
#include <glisten/ambient.glsl>
#include <glisten/toon.glsl>

//! test: (82), the cosine, and nothing from behind
//! N = unit, L = unit
void cosineOfIncidence(vec3 N, vec3 L, out float got, out float expected)
{
    got = lambertFactor(N, L);
    expected = max(dot(N, L), 0.0);
}

//! test
//! vec3(0, 0, 1), vec3(0, 0, 1) => 1.0
//! vec3(0, 0, 1), vec3(0, 0.6, 0.8) => 0.8
//! vec3(0, 0, 1), vec3(1, 0, 0) => 0.0
//! vec3(0, 0, 1), vec3(0, 0, -1) => 0.0
float knownCosines(vec3 N, vec3 L)
{
    return lambertFactor(N, L);
}

//! test: (83), linear in the light
//! N = unit, L = unit, a = 0..4
void lightCountsOnce(vec3 N, vec3 L, float a, out vec3 got, out vec3 expected)
{
    got = lambert(N, L, vec3(0.25, 0.5, 1.0), vec3(2.0 * a));
    expected = 2.0 * lambert(N, L, vec3(0.25, 0.5, 1.0), vec3(a));
}

//! test
//! N = unit, L = unit
bool halfRangeIsWithinZeroAndOne(vec3 N, vec3 L)
{
    float factor = halfLambertFactor(N, L);
    return factor >= 0.0 && factor <= 1.0;
}

//! test: the register does the same as the formula
//! N = unit, L = unit
void registerAndFormula(vec3 N, vec3 L, out float got, out float expected)
{
    got = halfLambertDot(N, halfLambertRegister(L));
    expected = halfLambertFactor(N, L);
}

//! test
//! N = unit, axis = unit
void sameSkyAndGroundIsThatColor(vec3 N, vec3 axis, out vec3 got, out vec3 expected)
{
    got = hemisphere(N, axis, vec3(0.25, 0.5, 2.0), vec3(0.25, 0.5, 2.0));
    expected = vec3(0.25, 0.5, 2.0);
}

//! test
//! vec3(0, 1, 0) => vec3(1, 2, 3)
//! vec3(0, -1, 0) => vec3(4, 5, 6)
//! vec3(1, 0, 0) => vec3(2.5, 3.5, 4.5)
vec3 polesAndEquatorOfTheSky(vec3 N)
{
    return hemisphere(N, vec3(0.0, 1.0, 0.0), vec3(1.0, 2.0, 3.0), vec3(4.0, 5.0, 6.0));
}

//! test
//! vec3(1.0, 0.5, 0.25), vec3(2, 2, 2) => vec3(2.0, 1.0, 0.5)
vec3 ambientIsAProduct(vec3 K, vec3 L)
{
    return ambient(K, L);
}

//! test
//! N = unit, L = unit, edge = 0..1, width = 0.01..0.5
bool rampIsBetweenItsColors(vec3 N, vec3 L, float edge, float width)
{
    float ramp = toonRamp(N, L, edge, width, vec3(1.0), vec3(0.0)).x;
    return ramp >= 0.0 && ramp <= 1.0;
}
