#version 150
#extension GL_ARB_shading_language_include : require
// The article's `hemi_amb`: a parallel light, and the half spheres in place of the constant ambient light.
#include <glisten/hemisphere.glsl>
#include <glisten/lambert.glsl>
#include <glisten/normal.glsl>

in vec3 position;
in vec3 normal;
in vec2 texcoord;
uniform mat4 model_view_projection;     // world, view and projection
uniform mat3 model_normal;
uniform vec3 light_direction;           // towards the light
uniform vec3 light_color;               // color of the parallel light
uniform vec3 mesh_color;                // color of the mesh
uniform vec3 sky;                       // color of the upper half sphere
uniform vec3 ground;                    // color of the lower half sphere
uniform vec3 axis;                      // axis of the half spheres
out vec3 shade;
out vec2 st;

void main()
{
    vec3 N = transformNormal(model_normal, normal);
    vec3 dome = hemisphere(N, safeNormalize(axis), sky, ground);
    shade = (lambertFactor(N, safeNormalize(light_direction)) * light_color + dome) * mesh_color;
    st = texcoord;
    gl_Position = model_view_projection * vec4(position, 1.0);
}
