#version 150
#extension GL_ARB_shading_language_include : require
// The article's `soft`: toon shading with a soft edge. The program that the article prints reads
//   mov oD0, c15
//   dp3 r0.w, v3, c13
//   mul r0.w, r0.w, c12.y
//   add oT1.xy, r0.w, c12.y     0.5 (N.L) + 0.5
#include <glisten/half_lambert.glsl>
#include <glisten/lut.glsl>
#include <glisten/normal.glsl>

in vec3 position;                       // v0
in vec3 normal;                         // v3
in vec2 texcoord;                       // v7
uniform mat4 model_view_projection;     // c0 to c3: world, view and projection
uniform mat3 model_normal;
uniform vec3 light_direction;           // c13: towards the light
uniform vec3 mesh_color;                // c15: color of the light and the mesh
uniform sampler2D ramp;                 // the texture that the coordinate is for
out vec3 shade;                         // oD0
out vec2 st;                            // oT0
out float ramp_s;                       // oT1.x, moved to the centers of the outer texels

void main()
{
    vec3 N = transformNormal(model_normal, normal);
    shade = mesh_color;
    float u = halfLambertFactor(N, safeNormalize(light_direction));
    ramp_s = lutCoordinate(u, float(textureSize(ramp, 0).x));
    st = texcoord;
    gl_Position = model_view_projection * vec4(position, 1.0);
}
