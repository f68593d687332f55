#version 150 core
// The textbook's program of section 10.2.4: a color at each vertex. Interpolation: noperspective: linear on the screen, equation (106).
in vec4 pv;
in vec4 cv;
uniform mat4 mc;
noperspective out vec4 vc;
void main(void)
{
    vc = cv;
    gl_Position = mc * pv;
}
