//# vertex
#version 150
struct S0 { vec2 m0; };
in vec2 place;
in float pw;
out Ioy0 { vec4 a; flat ivec4 b; } y0;
out Ioy1 { vec3 a; flat ivec4 b; } y1;
out vec4 ya;
vec4 acc = vec4(0.0);
mat3x4 f7(bool p4[2], in vec2 p5, mat2x4 p6) {
    return mat3x4(modf(clamp(vec4(1.0), -100.0, 100.0), p6[1]), vec4(1.0), place.grgr);
}
void main() {
    mat3x4 v13 = f7(bool[2](true, true), place, mat2x4(1.0, 2.0, 3.0, .75, .75, 17.0, 2.0, 1.0));
    S0 v14 = S0(vec2(1.0));
    acc.z += (1.0 < 8.0 ? max(v13[2].y, -8.0) : 8.0);
    y0.a = vec4(1.0);
    y0.b = ivec4(1);
    y1.a = vec3(1.0);
    y1.b = ivec4(1);
    ya = acc;
    gl_Position = vec4(place * pw, 0.0, pw);
}
//# fragment
#version 150
in vec4 ya;
out vec4 c0;
out vec4 c1;
vec4 acc = vec4(0.0);
void main() {
    c0 = vec4(0.25);
    c1 = vec4(0.25);
    acc += ya;
    if (true) { c0 = acc; return; }
}
//# scene
framebuffer = { width = 4, height = 4, attachments = 2, clear = [0, 0, 0, 0] }
[[draw]]
vertex = "a.vert"
fragment = "a.frag"
[draw.attributes]
place = { size = 2, values = [-1, -1, 3, -1, -1, 3] }
pw = { size = 1, values = [1, 2, 1.5] }
