#version 150
#extension GL_ARB_shading_language_include : require
// The standard program at each vertex: (101) there, its two parts interpolated.
#include <glisten/normal.glsl>
#include <glisten/standard.glsl>

in vec3 position;
in vec3 normal;
in vec2 texcoord;
uniform mat4 model;
uniform mat3 model_normal;
uniform mat4 model_view_projection;
uniform vec3 eye;           // in world space
out vec3 body;
out vec3 gloss;
out vec2 st;

void main()
{
    vec3 world = (model * vec4(position, 1.0)).xyz;
    vec3 N = transformNormal(model_normal, normal);
    vec3 V = safeNormalize(eye - world);
    Reflection reflection = standardReflection(world, N, V);
    body = reflection.body;
    gloss = reflection.gloss + standardEmission(N, V);
    st = texcoord;
    gl_Position = model_view_projection * vec4(position, 1.0);
}
