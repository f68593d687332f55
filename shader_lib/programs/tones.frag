#version 150
#extension GL_ARB_shading_language_include : require
// Six tone curves, one in each column: all hues from left to right, from six stops below 1 to four above it upwards.
#include <glisten/tonemap.glsl>

in vec2 place;
out vec4 color;

vec3 toned(int curve, vec3 light)
{
    switch (curve) {
    case 0:
        return min(tonemapReinhard(light, 16.0), vec3(1.0));
    case 1:
        return tonemapHable(light);
    case 2:
        return tonemapNarkowicz(light);
    case 3:
        return tonemapAces(light);
    case 4:
        return tonemapAgx(light);
    }
    return tonemapNeutral(light);
}

void main()
{
    float column = 3.0 * (place.x + 1.0);
    float curve = min(floor(column), 5.0);
    float hue = 6.0 * (column - curve);
    // A wheel of hues whose colors keep a tenth of white.
    vec3 wheel = clamp(vec3(abs(hue - 3.0) - 1.0, 2.0 - abs(hue - 2.0), 2.0 - abs(hue - 4.0)), vec3(0.0), vec3(1.0));
    vec3 light = (0.1 + 0.9 * wheel) * exp2(5.0 * place.y - 1.0);
    // A gap between the columns, two hundredths of a column wide.
    float gap = step(0.02, abs(column - floor(column + 0.5)));
    color = vec4(gap * toned(int(curve), light), 1.0);
}
