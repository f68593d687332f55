#version 150
#extension GL_ARB_shading_language_include : require
// A technical drawing: cool and warm tones instead of light and shadow, and a rim that darkens like a line.
#include <glisten/artistic.glsl>
#include <glisten/blinn_phong.glsl>

in vec3 world;
in vec3 direction;          // along the normal
uniform vec3 eye;           // in world space
uniform vec3 towards = vec3(0.4, 0.7, 0.6);
uniform vec3 warm = vec3(0.75, 0.5, 0.22);
uniform vec3 cool = vec3(0.1, 0.16, 0.42);
uniform vec3 ink = vec3(0.02, 0.025, 0.05);
out vec4 color;

void main()
{
    vec3 N = safeNormalize(direction);
    vec3 L = safeNormalize(towards);
    vec3 V = safeNormalize(eye - world);
    vec3 tone = gooch(N, L, warm, cool) + 0.6 * blinnPhongFactor(N, L, V, 60.0);
    color = vec4(mix(tone, ink, rimFactor(N, V, 2.5)), 1.0);
}
