// Tests of normals, interpolation and outlines: `glisten test shader_lib/tests`.
#include <glisten/normal.glsl>
#include <glisten/interpolation.glsl>
#include <glisten/outline.glsl>

//! test: a normal stays perpendicular to the surface under non-uniform scale
//! n = unit, t = unit, x = 0.5..2, y = 0.5..2
//! tolerance 1e-5
void perpendicular(vec3 n, vec3 t, float x, float y, out float got, out float expected)
{
    vec3 tangent = t - dot(t, n) * n;
    mat4 model = mat4(x, 0.0, 0.0, 0.0, 0.0, y, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0);
    got = dot(transformNormal(normalMatrix(model), n), (model * vec4(tangent, 0.0)).xyz);
    expected = 0.0;
}

//! test
//! vec2(0, 0) => vec2(0, 0)
//! vec2(2, 0) => vec2(1, 0)
//! vec2(0, 4) => vec2(0, 1)
//! vec2(0.5, 1) => vec2(0.25, 0.25)
vec2 barycentricCoordinates(vec2 P)
{
    return barycentric(P, vec2(0.0), vec2(2.0, 0.0), vec2(0.0, 4.0));
}

//! test: with one w, both interpolations are the same
//! u = 0..0.5, v = 0..0.5, w = 0.5..4
void interpolationsAgree(float u, float v, float w, out vec4 got, out vec4 expected)
{
    vec4 a = vec4(1.0, 0.0, 2.0, 1.0);
    vec4 b = vec4(0.0, 1.0, 3.0, 1.0);
    vec4 c = vec4(0.5, 0.5, 4.0, 1.0);
    got = interpolatePerspective(vec2(u, v), vec3(w), a, b, c);
    expected = interpolateLinear(vec2(u, v), a, b, c);
}

//! test
//! width = 0..0.1, push = 0..0.1
void withoutDirectionNothingMovesSideways(float width, float push, out vec2 got, out vec2 expected)
{
    vec4 position = vec4(0.5, -0.25, 0.0, 1.0);
    got = outlinePosition(position, vec3(0.0), width, push).xy;
    expected = position.xy;
}
