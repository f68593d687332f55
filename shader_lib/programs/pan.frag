#version 150
#extension GL_ARB_shading_language_include : require
// The bottom of a pan, brushed in circles, under two lamps with the colors of black bodies.
#include <glisten/color.glsl>
#include <glisten/ward.glsl>

in vec3 world;
in vec3 direction;          // along the normal
uniform vec3 eye;           // in world space
uniform vec3 first;         // the lamps, in world space
uniform vec3 second;
uniform vec2 kelvin = vec2(2900.0, 9000.0);
uniform vec2 alpha = vec2(0.4, 0.11);      // across the scratches, which is along a radius, and along them
uniform float radius = 1.0;
out vec4 color;

void main()
{
    float r = safeLength(world);
    if (r > radius)
        discard;
    vec3 N = safeNormalize(direction);
    vec3 V = safeNormalize(eye - world);
    vec3 T = safeNormalize(world - dot(world, N) * N);
    vec3 sum = vec3(0.14);
    sum += wardFactor(N, T, safeNormalize(first - world), V, alpha) * colorTemperature(kelvin.x);
    sum += wardFactor(N, T, safeNormalize(second - world), V, alpha) * colorTemperature(kelvin.y);
    // The rim, and the rivet in the middle, are turned on a lathe.
    float turned = smoothstep(0.9, 0.92, r / radius) + 1.0 - smoothstep(0.07, 0.08, r / radius);
    color = vec4(sum * vec3(0.28, 0.27, 0.26) * (1.0 - 0.65 * turned), 1.0);
}
