#version 150
#extension GL_ARB_shading_language_include : require
// A surface that burns away: its rim glows, and what is left is lit as the picture of a ball would be.
#include <glisten/dissolve.glsl>
#include <glisten/matcap.glsl>
#include <glisten/noise.glsl>

in vec3 world;
in vec3 direction;          // along the normal
uniform vec3 eye;           // in world space; the axes of the world are those of the eye
uniform float gone = 0.5;
uniform vec3 fire = vec3(1.7, 0.4, 0.05);
out vec4 color;

// A lit ball: a warm lamp above on the left, a cold one behind, and the room.
vec3 ball(vec2 place)
{
    vec2 p = 2.0 * place - 1.0;
    float lamp = exp2(-9.0 * dot(p - vec2(-0.35, 0.45), p - vec2(-0.35, 0.45)));
    float rim = smoothstep(0.55, 1.0, length(p - vec2(-0.2, 0.25)));
    return vec3(0.012, 0.013, 0.016) * (1.4 + p.y) + lamp * vec3(0.5, 0.44, 0.36) + rim * vec3(0.012, 0.035, 0.07);
}

void main()
{
    float x = 0.5 + 0.6 * noiseFractal(3.0 * world, 2);
    float kept = dissolveKept(x, gone, fwidth(x));
    if (!(kept > 0.0))
        discard;
    vec3 seen = ball(matcapCoordinate(safeNormalize(direction), safeNormalize(eye - world)));
    float glow = dissolveGlow(x, gone, 0.1);
    vec3 hot = fire * glow * sqrt(glow);
    color = vec4(seen * (1.0 - 0.8 * glow) + hot, kept);
}
