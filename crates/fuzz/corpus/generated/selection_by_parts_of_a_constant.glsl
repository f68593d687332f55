//# vertex
#version 310 es
in vec2 place;
in float pw;
out vec2 y0;
out vec2 y1[2];
out vec4 ya;
vec4 acc = vec4(0.0);
const bvec2 g3 = bvec2(true);
void f7(const in uvec4 p4, in mat4x3 p5, mat2 p6) {
}
void main() {
    f7(mix((place, uvec4(1u)), uvec4(1u), bvec4(true, g3.t, g3.r, false)), mat4x3(1.0), mat2(1.0));
    y0 = vec2(1.0);
    y1 = vec2[2](vec2(1.0), vec2(1.0));
    ya = acc;
    gl_Position = vec4(place * pw, 0.0, pw);
}
//# fragment
#version 310 es
precision highp float;
layout(location = 0) out vec4 c0;
void main() {
    c0 = vec4(0.25);
}
//# scene
[[draw]]
vertex = "a.vert"
fragment = "a.frag"
[draw.attributes]
place = { size = 2, values = [-1, -1, 3, -1, -1, 3] }
pw = { size = 1, values = [1, 2, 1.5] }

