//# vertex
#version 150
in vec2 place;
in float pw;
flat out vec2 y0;
out Ioy1 { float a; flat ivec3 b; } y1;
out vec4 ya;
vec4 acc = vec4(0.0);
void main() {
    y0 = vec2(1.0);
    y1.a = 1.0;
    y1.b = ivec3(1);
    ya = acc;
    gl_Position = vec4(place * pw, 0.0, pw);
}
//# fragment
#version 150
out vec4 c0;
vec4 acc = vec4(0.0);
const uint g1 = (- 1u);
void main() {
    c0 = vec4(0.25);
    uint v30 = g1;
    acc.x += float(v30 & 0xffffu) * 0.0625;
}
//# scene
[[draw]]
vertex = "a.vert"
fragment = "a.frag"
[draw.attributes]
place = { size = 2, values = [-1, -1, 3, -1, -1, 3] }
pw = { size = 1, values = [1, 2, 1.5] }

