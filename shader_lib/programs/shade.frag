#version 150
// The interpolated color of the programs that shade each vertex.
#ifndef INTERPOLATION
#define INTERPOLATION smooth
#endif

INTERPOLATION in vec3 shade;
out vec4 color;

void main()
{
    color = vec4(shade, 1.0);
}
