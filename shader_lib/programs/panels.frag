#version 150
#extension GL_ARB_shading_language_include : require
// A surface of microfacets under a rectangle of light; its roughness may change from tile to tile.
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
uniform vec3 room = vec3(0.05);   // light from everywhere
out vec4 color;

void main()
{
    vec3 N = safeNormalize(direction);
    vec3 V = safeNormalize(eye - world);
    vec2 tile = floor(tiles * world.xz);
    float rough = mod(tile.x + tile.y, 2.0) == 0.0 ? roughness.x : roughness.y;
    vec3 window_at = window[0] - world;
    vec3 all = ltcAlbedo(albedos, N, V, rough, gloss);
    vec3 seen = room * (body + all);
    seen += all * ltcRectangle(ltcMatrix(matrices, N, V, rough), window_at, window[1], window[2]) * window_color;
    if (body.r > 0.0)
        seen += body * ltcRectangle(ltcFrame(N, V), window_at, window[1], window[2]) * window_color;
    color = vec4(seen, 1.0);
}
