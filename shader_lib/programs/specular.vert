#version 150
#extension GL_ARB_shading_language_include : require
// The article's `specular`: `diffuse`, and a highlight by the mirror direction whose power is two squarings, since a
// vertex processor of the time has no pow().
#include <glisten/ambient.glsl>
#include <glisten/lambert.glsl>
#include <glisten/normal.glsl>
#include <glisten/quartic.glsl>

in vec3 position;                       // v0
in vec3 normal;                         // v3
in vec2 texcoord;                       // v7
uniform mat4 model;
uniform mat4 model_view_projection;     // c0 to c3: world, view and projection
uniform mat3 model_normal;
uniform vec3 eye;
uniform vec3 light_direction;           // c13: towards the light
uniform vec3 ambient_color;             // c14: color of the ambient light
uniform vec3 mesh_color;                // c15: color of the light and the mesh
out vec3 shade;                         // oD0
out vec3 gloss;                         // oD1
out vec2 st;                            // oT0

void main()
{
    vec3 N = transformNormal(model_normal, normal);
    vec3 L = safeNormalize(light_direction);
    vec3 V = safeNormalize(eye - (model * vec4(position, 1.0)).xyz);
    shade = lambert(N, L, mesh_color, vec3(1.0)) + ambient(mesh_color, ambient_color);
    gloss = vec3(quarticFactor(N, L, V));
    st = texcoord;
    gl_Position = model_view_projection * vec4(position, 1.0);
}
