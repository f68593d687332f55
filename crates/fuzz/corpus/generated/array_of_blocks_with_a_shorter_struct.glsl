//# vertex
#version 420
struct S0 { float m0[2]; mat2x4 m1; };
uniform float uf;
uniform int ui;
uniform bool never;
layout(std140) uniform Block { vec4 k0; layout(column_major) mat4x2 k1; S0 k2[2]; mat4 k3; } block[2];
in vec2 place;
in float pw;
in ivec4 bv;
out Ioy0 { float a; flat ivec4 b; } y0;
out Ioy1 { vec4 a; flat int b; } y1;
noperspective out vec4 y2[2];
flat out ivec2 y3;
flat out vec4 ya;
vec4 acc = vec4(0.0);
mat3x2 f5() {
    vec4 v6 = (mat4(vec4(1.0), block[1].k0, vec4(1.0), block[0].k3[2]) * vec4(1.0));
    acc.x += (1.0 < 8.0 ? max(v6.x, -8.0) : 8.0);
    return mat3x2(vec2(1.0), vec2(1.0), block[1].k1[0]);
}
void main() {
    mat3x2 v21 = f5();
    for (int i28 = 0; i28 < min(ui, 2); i28 += 1) {
    }
    acc.x += (1.0 < 8.0 ? max(v21[2].y, -8.0) : 8.0);
    y0.a = 1.0;
    y0.b = bv;
    y1.a = vec4(1.0);
    y1.b = 1;
    y2 = vec4[2](vec4(1.0), vec4(1.0));
    y3 = ivec2(1);
    ya = acc;
    gl_Position = vec4(place * pw, 0.0, pw);
}
//# fragment
#version 420
struct S0 { float m0[2]; mat2x4 m1; };
uniform mat3x4 u0[2];
layout(std140) uniform Block { vec4 k0; layout(column_major) mat4x2 k1; S0 k2[2]; mat4 k3; } block[2];
uniform sampler2DArray ta;
flat in vec4 ya;
layout(location = 0) out vec4 c0;
layout(location = 1) out vec4 c1;
vec4 acc = vec4(0.0);
void main() {
    c0 = vec4(0.25);
    c1 = vec4(0.25);
    vec4 v19 = (block[1].k2[1].m1[1] - ya);
    float v22 = 1.0;
    vec4 v24 = textureLodOffset(ta, clamp(vec3(1.0), 0.125, 2.5), clamp(u0[0][1].w, 0.0, 1.5), ivec2(1));
    c0 = acc + vec4(v19.w, 1.0, 1.0, v22);
}
//# scene
[[draw]]
vertex = "a.vert"
fragment = "a.frag"
[draw.attributes]
place = { size = 2, values = [-1, -1, 3, -1, -1, 3] }
pw = { size = 1, values = [1, 2, 1.5] }
[draw.uniforms]
"Block[1].k2[1].m1" = [3.0, 0.25, 1.5, 3.0, 1.5, 0.3, 1.0, -2.0]

