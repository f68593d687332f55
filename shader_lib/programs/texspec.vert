#version 150
#extension GL_ARB_shading_language_include : require
// The article's `texspec`: `diffuse`, and a highlight that is looked up in a texture by the cosine between normal and
// half vector, so that it may have any profile: a power, or the mottled pattern of a metal. The half vector is one for
// the whole mesh, as a constant register has it: that of the light and the direction to the eye from the mesh's origin.
#include <glisten/ambient.glsl>
#include <glisten/blinn_phong.glsl>
#include <glisten/lambert.glsl>
#include <glisten/lut.glsl>
#include <glisten/normal.glsl>

in vec3 position;
in vec3 normal;
in vec2 texcoord;
uniform mat4 model;
uniform mat4 model_view_projection;     // world, view and projection
uniform mat3 model_normal;
uniform vec3 eye;
uniform vec3 light_direction;           // towards the light
uniform vec3 ambient_color;             // color of the ambient light
uniform vec3 mesh_color;                // color of the light and the mesh
uniform sampler2D highlight;            // the table that the coordinate is for
out vec3 shade;
out vec2 st;
out float gloss_s;                      // N.H, moved to the centers of the outer texels

void main()
{
    vec3 N = transformNormal(model_normal, normal);
    vec3 L = safeNormalize(light_direction);
    vec3 V = safeNormalize(eye - model[3].xyz);
    shade = lambert(N, L, mesh_color, vec3(1.0)) + ambient(mesh_color, ambient_color);
    gloss_s = lutCoordinate(dot(N, halfVector(L, V)), float(textureSize(highlight, 0).x));
    st = texcoord;
    gl_Position = model_view_projection * vec4(position, 1.0);
}
