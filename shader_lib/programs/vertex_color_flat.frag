#version 150 core
// The interpolated color is the pixel's.
flat in vec4 vc;
out vec4 fc;
void main(void)
{
    fc = vc;
}
