#version 150
#extension GL_ARB_shading_language_include : require
// The article's `diffuse`: a parallel light and a constant ambient light, at each vertex. The light's direction is the
// one of the world and not of the mesh, so that a mesh may be turned.
#include <glisten/ambient.glsl>
#include <glisten/lambert.glsl>
#include <glisten/normal.glsl>

in vec3 position;
in vec3 normal;
in vec2 texcoord;
uniform mat4 model_view_projection;     // world, view and projection
uniform mat3 model_normal;
uniform vec3 light_direction;           // towards the light
uniform vec3 ambient_color;             // color of the ambient light
uniform vec3 mesh_color;                // color of the light and the mesh
out vec3 shade;
out vec2 st;

void main()
{
    vec3 N = transformNormal(model_normal, normal);
    vec3 L = safeNormalize(light_direction);
    shade = lambert(N, L, mesh_color, vec3(1.0)) + ambient(mesh_color, ambient_color);
    st = texcoord;
    gl_Position = model_view_projection * vec4(position, 1.0);
}
