#version 150 core
in vec4 pv;
uniform mat4 mc;
uniform float time;
uniform vec4 color = vec4(0.2, 0.5, 1.0, 1.0);
out vec4 vc;
out vec3 vn;
void main(void)
{
    vec4 p = pv;
    float phase = 10.0 * p.x + time;
    p.y += 0.1 * sin(phase);
    vc = color * (0.5 + 0.5 * p.y);
    vn = vec3(-cos(phase), 1.0, 0.0);
    gl_Position = mc * p;
}
