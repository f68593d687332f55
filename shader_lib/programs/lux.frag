#version 150
#extension GL_ARB_shading_language_include : require
// A diffuse surface under three lamps of a room, in the units of their data sheets.
#include <glisten/photometry.glsl>

in vec3 world;
in vec3 direction;          // along the normal
uniform sampler2D narrow;   // candela by the angle from the axis, for the first lamp
uniform sampler2D wide;     // for the second
uniform sampler2D wings;    // for the third
uniform vec3 lamps[3];      // in metres
uniform vec3 tints[3];
uniform vec3 axis = vec3(0.0, -1.0, 0.0);   // of all lamps
uniform vec3 body = vec3(0.7);
uniform float room = 5.0;   // lux from everywhere
uniform float ev = 6.0;
out vec4 color;

vec3 lux(sampler2D profile, vec3 lamp, vec3 tint, vec3 N)
{
    vec3 to = lamp - world;
    vec3 L = safeNormalize(to);
    float candela = photometryProfile(profile, L, axis).r;
    return tint * photometryLux(candela, dot(N, L), safeLength(to));
}

void main()
{
    vec3 N = safeNormalize(direction);
    vec3 E = vec3(room);
    E += lux(narrow, lamps[0], tints[0], N);
    E += lux(wide, lamps[1], tints[1], N);
    E += lux(wings, lamps[2], tints[2], N);
    // Nits of a surface that scatters evenly.
    vec3 nits = body * E / radians(180.0);
    color = vec4(photometryExposure(ev) * nits, 1.0);
}
