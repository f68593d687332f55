#version 150
#extension GL_ARB_shading_language_include : require
// The standard program: (101) at each fragment.
#include <glisten/standard.glsl>

in vec3 world;
in vec3 direction;
in vec2 st;
uniform vec3 eye;           // in world space
uniform sampler2D decal;    // colors the body, not the gloss
out vec4 color;

void main()
{
    vec3 N = safeNormalize(direction);
    vec3 V = safeNormalize(eye - world);
    color = vec4(standardColor(standardReflection(world, N, V), texture(decal, st).rgb), 1.0);
}
