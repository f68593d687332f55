#version 150 core
// The textbook's program of section 10.2.4: a color at each vertex. Interpolation: smooth: with regard to the perspective, equation (108).
in vec4 pv;
in vec4 cv;
uniform mat4 mc;
out vec4 vc;
void main(void)
{
    vc = cv;
    gl_Position = mc * pv;
}
