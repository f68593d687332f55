#version 150 core
in vec4 pv;
uniform mat4 mc;
uniform float time;
uniform vec4 color = vec4(0.2, 0.5, 1.0, 1.0);
out vec4 vc;
void main(void)
{
    vec4 p = pv;
    p.y += 0.1 * sin(10.0 * p.x + time);
    vc = color * (0.5 + 0.5 * p.y);
    gl_Position = mc * p;
}
