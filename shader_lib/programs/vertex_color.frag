#version 150 core
// The interpolated color is the pixel's.
in vec4 vc;
out vec4 fc;
void main(void)
{
    fc = vc;
}
