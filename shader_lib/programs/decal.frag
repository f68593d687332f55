#version 150
// A color times a decal, unlit.
#ifndef INTERPOLATION
#define INTERPOLATION smooth
#endif

INTERPOLATION in vec2 st;
uniform vec4 tint = vec4(1.0);
uniform sampler2D decal;
out vec4 color;

void main()
{
    color = tint * texture(decal, st);
}
