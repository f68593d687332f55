#version 150
#extension GL_ARB_shading_language_include : require
#include <height.glsl>

uniform mat4 modelViewProjection;
uniform float time;
in vec2 place;
out float high;

void main() {
    high = height(place, time);
    gl_Position = modelViewProjection * vec4(place.x, high, place.y, 1.0);
}
