#version 150
#extension GL_ARB_shading_language_include : require
// The article's `hemi_amb`: a parallel light, and the half spheres in place of the constant ambient light.
#include <glisten/hemisphere.glsl>
#include <glisten/lambert.glsl>
#include <glisten/normal.glsl>

in vec3 position;                       // v0
in vec3 normal;                         // v3
in vec2 texcoord;                       // v7
uniform mat4 model_view_projection;     // c0 to c3: world, view and projection
uniform mat3 model_normal;
uniform vec3 light_direction;           // c13: towards the light
uniform vec3 light_color;               // c14: color of the parallel light
uniform vec3 mesh_color;                // c15: color of the mesh
uniform vec3 sky;                       // c18: color of the upper half sphere
uniform vec3 ground;                    // c19: color of the lower half sphere
uniform vec3 axis;                      // c20: axis of the half spheres
out vec3 shade;                         // oD0
out vec2 st;                            // oT0

void main()
{
    vec3 N = transformNormal(model_normal, normal);
    vec3 dome = hemisphere(N, safeNormalize(axis), sky, ground);
    shade = (lambertFactor(N, safeNormalize(light_direction)) * light_color + dome) * mesh_color;
    st = texcoord;
    gl_Position = model_view_projection * vec4(position, 1.0);
}
