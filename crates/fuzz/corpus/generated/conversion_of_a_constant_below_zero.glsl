//# vertex
#version 310 es
in vec2 place;
in float pw;
smooth out vec3 y0;
smooth out vec3 y1;
flat out vec2 y2;
smooth out mat2 y3;
out vec4 ya;
vec4 acc = vec4(0.0);
void main() {
    y0 = vec3(1.0);
    y1 = vec3(1.0);
    y2 = vec2(1.0);
    y3 = mat2(1.0);
    ya = acc;
    gl_Position = vec4(place * pw, 0.0, pw);
}
//# fragment
#version 310 es
precision highp float;
layout(location = 0) out vec4 c0;
layout(location = 1) out vec4 c1;
layout(location = 2) out vec4 c2;
uvec4 g2 = uvec4(1u);
void main() {
    c0 = vec4(0.25);
    c1 = vec4(0.25);
    c2 = vec4(0.25);
    lowp int v16 = 1;
    imulExtended(v16, ((g2.wzz, (-32768)) | int(ivec3(1))), v16, v16);
}
//# scene
framebuffer = { width = 4, height = 4, attachments = 3, clear = [0, 0, 0, 0] }
[[draw]]
vertex = "a.vert"
fragment = "a.frag"
[draw.attributes]
place = { size = 2, values = [-1, -1, 3, -1, -1, 3] }
pw = { size = 1, values = [1, 2, 1.5] }

