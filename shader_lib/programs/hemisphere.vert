#version 150
#extension GL_ARB_shading_language_include : require
// The article's `hemisphere`: light from two half spheres, at each vertex. The program that the article prints reads
//   dp3 r0, v3, c20         N.A
//   mad r0, r0, c12.y, c12.y    a = (1 + N.A) / 2
//   mad r0, c18 - c19, r0, c19  a (L_u - L_d) + L_d
//   mul oD0, r0, c15
#include <glisten/hemisphere.glsl>
#include <glisten/normal.glsl>

in vec3 position;                       // v0
in vec3 normal;                         // v3
in vec2 texcoord;                       // v7
uniform mat4 model_view_projection;     // c0 to c3: world, view and projection
uniform mat3 model_normal;
uniform vec3 mesh_color;                // c15: color of the mesh
uniform vec3 sky;                       // c18: color of the upper half sphere
uniform vec3 ground;                    // c19: color of the lower half sphere
uniform vec3 axis;                      // c20: axis of the half spheres
out vec3 shade;                         // oD0
out vec2 st;                            // oT0

void main()
{
    vec3 N = transformNormal(model_normal, normal);
    shade = hemisphere(N, safeNormalize(axis), sky, ground) * mesh_color;
    st = texcoord;
    gl_Position = model_view_projection * vec4(position, 1.0);
}
