#version 150
#extension GL_ARB_shading_language_include : require
// What the programs that shade each fragment need of a vertex: its place and its normal in world space.
#include <glisten/normal.glsl>

in vec3 position;
in vec3 normal;
uniform mat4 model;
uniform mat3 model_normal;
uniform mat4 model_view_projection;
out vec3 world;
out vec3 direction;     // along the normal

void main()
{
    world = (model * vec4(position, 1.0)).xyz;
    direction = transformNormal(model_normal, normal);
    gl_Position = model_view_projection * vec4(position, 1.0);
}
