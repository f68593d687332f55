// Tests of the specular models: `glisten test shader_lib/tests`.
#include <glisten/phong.glsl>
#include <glisten/blinn_phong.glsl>
#include <glisten/schlick.glsl>
#include <glisten/threshold.glsl>
#include <glisten/quartic.glsl>

//! test: (84), twice mirrored is where it was
//! N = unit, L = unit
void mirroredTwice(vec3 N, vec3 L, out vec3 got, out vec3 expected)
{
    got = mirrorDirection(N, mirrorDirection(N, L));
    expected = L;
}

//! test: (85), the angles to the normal are equal
//! N = unit, L = unit
void mirroredAngle(vec3 N, vec3 L, out float got, out float expected)
{
    got = dot(N, mirrorDirection(N, L));
    expected = dot(N, L);
}

//! test: the highlight is 1 in the mirror direction
//! vec3(0, 0, 1), vec3(0, 0.6, 0.8), vec3(0, -0.6, 0.8), 32 => 1.0
//! vec3(0, 0, 1), vec3(0, 0, 1), vec3(0, 0, 1), 1000 => 1.0
//! vec3(0, 0, 1), vec3(0, 0, -1), vec3(0, 0, 1), 32 => 0.0
//! tolerance 1e-6
float phongPeak(vec3 N, vec3 L, vec3 V, float shininess)
{
    return phongFactor(N, L, V, shininess);
}

//! test
//! N = unit, L = unit, V = unit, shininess = 0..200
bool highlightsAreWithinZeroAndOne(vec3 N, vec3 L, vec3 V, float shininess)
{
    float phong = phongFactor(N, L, V, shininess);
    float blinn = blinnPhongFactor(N, L, V, shininess);
    float rational = schlickBlinnFactor(N, L, V, shininess);
    return min(min(phong, blinn), rational) >= 0.0 && max(max(phong, blinn), rational) <= 1.000001;
}

//! test: (87), the half vector is as far from both
//! L = unit, V = unit
void halfwayBetween(vec3 L, vec3 V, out float got, out float expected)
{
    vec3 H = halfVector(L, V);
    got = dot(H, L);
    expected = dot(H, V);
}

//! test: (90)
//! 0.0, 10 => 0.0
//! 1.0, 10 => 1.0
//! 0.5, 1 => 0.5
//! 0.5, 4 => 0.2
//! 2.0, 4 => 1.0
float schlickValues(float t, float shininess)
{
    return schlick(t, shininess);
}

//! test
//! c in 0.0 0.25 0.5 1.0, t in 0.1 0.3 0.9 1.0
void stepIsZeroOrOne(float c, float t, out float got, out float expected)
{
    got = thresholdStep(c, t);
    expected = c > t ? 1.0 : 0.0;
}

//! test
//! x = 0..1
void fourthPower(float x, out float got, out float expected)
{
    got = quartic(x);
    expected = x * x * x * x;
}
