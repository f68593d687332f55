#version 150 core
// The textbook's program of section 10.2.4: a color at each vertex. Interpolation: flat: the last vertex of the triangle gives its color to all of it.
in vec4 pv;
in vec4 cv;
uniform mat4 mc;
flat out vec4 vc;
void main(void)
{
    vc = cv;
    gl_Position = mc * pv;
}
