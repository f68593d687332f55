#version 150
#extension GL_ARB_shading_language_include : require
// A surface of microfacets under a rectangle, a disk and a tube of light; its roughness may change from tile to tile.
#include <glisten/ltc.glsl>

in vec3 world;
in vec3 direction;          // along the normal
uniform sampler2D matrices; // ltc_matrix
uniform sampler2D albedos;  // ltc_albedo
uniform vec3 eye;           // in world space
uniform vec3 body = vec3(0.2);
uniform vec3 gloss = vec3(0.04);
uniform vec2 roughness = vec2(0.3);     // of the tiles in turn
uniform float tiles = 1.0;  // to a unit of length
uniform vec3 window[3];     // the center, and from there to the middles of two sides
uniform vec3 window_color = vec3(1.0);
uniform vec3 dish[3];       // the center, and from there to the rim
uniform vec3 dish_color = vec3(1.0);
uniform vec3 tube[2];       // the ends
uniform float tube_radius = 0.05;
uniform vec3 tube_color = vec3(1.0);
out vec4 color;

// The radiance of all lights by the cosine of a frame.
vec3 lit(mat3 to)
{
    return ltcRectangle(to, window[0] - world, window[1], window[2]) * window_color
        + ltcDisk(to, dish[0] - world, dish[1], dish[2]) * dish_color
        + ltcTube(to, tube[0] - world, tube[1] - world, tube_radius) * tube_color;
}

void main()
{
    vec3 N = safeNormalize(direction);
    vec3 V = safeNormalize(eye - world);
    vec2 tile = floor(tiles * world.xz);
    float rough = mod(tile.x + tile.y, 2.0) == 0.0 ? roughness.x : roughness.y;
    vec3 mirrored = lit(ltcMatrix(matrices, N, V, rough)) * ltcAlbedo(albedos, N, V, rough, gloss);
    vec3 scattered = body.r + body.g + body.b > 0.0 ? lit(ltcFrame(N, V)) * body : vec3(0.0);
    color = vec4(mirrored + scattered, 1.0);
}
