#version 150
#extension GL_ARB_shading_language_include : require
// The standard program: any lights and any model, computed at each fragment.
#include <glisten/normal.glsl>

in vec3 position;
in vec3 normal;
in vec2 texcoord;
uniform mat4 model;
uniform mat3 model_normal;
uniform mat4 model_view_projection;
out vec3 world;         // position in world space
out vec3 direction;     // normal in world space, not of unit length
out vec2 st;

void main()
{
    world = (model * vec4(position, 1.0)).xyz;
    direction = transformNormal(model_normal, normal);
    st = texcoord;
    gl_Position = model_view_projection * vec4(position, 1.0);
}
