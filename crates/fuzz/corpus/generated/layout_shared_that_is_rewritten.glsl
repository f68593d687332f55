//# vertex
#version 410
layout(shared) uniform Block { vec3 k0; layout(column_major) mat2x3 k1; mat4x3 k2[2]; } block;
in vec2 place;
in float pw;
flat out float y0;
out vec4 ya;
vec4 acc = vec4(0.0);
void main() {
    y0 = 1.0;
    ya = acc;
    gl_Position = vec4(place * pw, 0.0, pw);
}
//# fragment
#version 410
layout(location = 0) out vec4 c0;
layout(location = 1) out vec4 c1;
void main() {
    c0 = vec4(0.25);
    c1 = vec4(0.25);
}
//# scene
framebuffer = { width = 4, height = 4, attachments = 2, clear = [0, 0, 0, 0] }
[[draw]]
vertex = "a.vert"
fragment = "a.frag"
[draw.attributes]
place = { size = 2, values = [-1, -1, 3, -1, -1, 3] }
pw = { size = 1, values = [1, 2, 1.5] }
