//# vertex
#version 140
in vec2 place;
in float pw;
in ivec4 bv;
flat out int y0;
out mat2 y1;
flat out vec4 y2;
flat out ivec4 y3;
flat out vec4 ya;
vec4 acc = vec4(0.0);
void main() {
    y0 = bv.g;
    y1 = mat2(1.0);
    y2 = vec4(1.0);
    y3 = ivec4(1);
    ya = acc;
    gl_Position = vec4(place * pw, 0.0, pw);
}
//# fragment
#version 140
uniform int ui;
flat in int y0;
flat in ivec4 y3;
out vec4 c0;
out vec4 c1;
vec4 acc = vec4(0.0);
uvec3 f5(const in int p3, in vec4 p4) {
    for (int i6 = 0; i6 < min(ui, 2); i6++) {
        if ((y3.q <= p3)) break;
        bvec3 v7 = bvec3(true, gl_FrontFacing, true);
        acc.y += float(v7.y) * 0.0625;
    }
    return uvec3(1u);
}
void main() {
    c0 = vec4(0.25);
    c1 = vec4(0.25);
    float v15 = 1.0;
    uvec3 v21 = f5(y0, vec4(1.0));
    c0 = acc + vec4(1.0, 1.0, v15, 1.0);
}
//# scene
[[draw]]
vertex = "a.vert"
fragment = "a.frag"
[draw.attributes]
place = { size = 2, values = [-1, -1, 3, -1, -1, 3] }
pw = { size = 1, values = [1, 2, 1.5] }
bv = { size = 4, values = [3, -1, 5, 8, 0, 2, -7, 4, 1, 6, 100, -3] }
[draw.uniforms]
"ui" = 100
