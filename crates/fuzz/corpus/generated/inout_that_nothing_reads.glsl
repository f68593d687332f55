//# vertex
#version 140
in vec2 place;
in float pw;
smooth out vec2 y0;
out vec4 ya;
vec4 acc = vec4(0.0);
void main() {
    y0 = vec2(1.0);
    ya = acc;
    gl_Position = vec4(place * pw, 0.0, pw);
}
//# fragment
#version 140
uniform sampler2DArray ta;
out vec4 c0;
out vec4 c1;
out vec4 c2;
vec4 acc = vec4(0.0);
void f14(out int p11, inout int p12, const in bvec2 p13) {
    p11 = 725;
}
void main() {
    c0 = vec4(0.25);
    c1 = vec4(0.25);
    c2 = vec4(0.25);
    int v19 = 1;
    f14(v19, v19, bvec2(true));
    vec4 v23 = textureOffset(ta, clamp(vec3(1.0), 0.125, 2.5), ivec2(1), 0.5);
    acc.y += float(v19 & 0xffff) * 0.0625;
    c0 = acc + vec4(1.0, 1.0, 1.0, v23.w);
}
//# scene
[[draw]]
vertex = "a.vert"
fragment = "a.frag"
[draw.attributes]
place = { size = 2, values = [-1, -1, 3, -1, -1, 3] }
pw = { size = 1, values = [1, 2, 1.5] }

