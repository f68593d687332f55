#version 150
#extension GL_ARB_shading_language_include : require
// A diffuse surface under a sun and a sky, with one of four shadows of a map.
#include <glisten/hemisphere.glsl>
#include <glisten/lambert.glsl>
#include <glisten/noise.glsl>
#include <glisten/shadow.glsl>

in vec3 world;
in vec3 direction;          // along the normal
uniform sampler2D map;      // depths, as the sun sees them, with mipmaps
uniform mat4 to_map;
uniform vec3 body = vec3(0.6);
uniform vec3 sun = vec3(0.0, 1.0, 0.0);     // towards the sun
uniform vec3 sun_color = vec3(1.0);
uniform vec3 sky = vec3(0.1);
uniform vec3 ground = vec3(0.05);
uniform int method = 0;     // 0: one comparison; 1: a filter of one width; 2: as wide as the half shadow; 3: moments
uniform float size = 0.1;   // of the sun, as shadowSoftSun() has it
uniform float radius = 0.01;
uniform float bias = 0.002;
uniform float cut = 0.0;
out vec4 color;

const int TAPS = 24;

// The mean of moments over a disk, from a level of the map that is filtered already.
vec2 moments(vec2 at, float turn)
{
    vec2 sum = vec2(0.0);
    for (int i = 0; i < TAPS; ++i)
        sum += textureLod(map, at + radius * shadowTap(i, TAPS, turn), 1.0).gb;
    return sum / float(TAPS);
}

void main()
{
    vec3 N = safeNormalize(direction);
    vec3 place = (to_map * vec4(world, 1.0)).xyz;
    vec2 slope = shadowSlope(dFdx(place), dFdy(place));
    place.z -= bias;
    float turn = noiseUnit(noiseHash(ivec3(gl_FragCoord.xy, 0)));
    float lit = lambertFactor(N, safeNormalize(sun));
    if (method == 0)
        lit *= shadowPercentageCloser(map, place, slope, 0.0, 1, 0.0);
    else if (method == 1)
        lit *= shadowPercentageCloser(map, place, slope, radius, TAPS, turn);
    else if (method == 2)
        lit *= shadowSoftSun(map, place, slope, size, TAPS, turn);
    else
        lit *= shadowVariance(moments(place.xy, turn), place.z, 1e-6, cut);
    vec3 seen = body * (lit * sun_color + mix(ground, sky, hemisphereWeight(N, vec3(0.0, 1.0, 0.0))));
    color = vec4(seen, 1.0);
}
