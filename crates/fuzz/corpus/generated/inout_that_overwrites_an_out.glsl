//# vertex
#version 100
uniform float uf;
uniform int ui;
uniform bool never;
uniform vec2 u0;
uniform ivec2 u1[4];
attribute vec2 place;
attribute float pw;
varying float y0;
varying vec4 ya;
vec4 acc = vec4(0.0);
void main() {
    vec4 v12 = u0.gggr;
    y0 = 1.0;
    ya = acc;
    gl_Position = vec4(place * pw, 0.0, pw);
}
//# fragment
#version 100
precision highp float;
struct S0 { ivec4 m0; bvec2 m1; };
uniform float uf;
uniform ivec3 u2;
uniform S0 us;
vec4 acc = vec4(0.0);
void f5(out S0 p2, out bvec2 p3, inout S0 p4) {
}
void main() {
    gl_FragColor = vec4(0.25);
    float v13 = uf;
    S0 v16 = S0(ivec4(1), bvec2(true));
    f5(v16, v16.m1, v16);
    vec3 v18 = vec3(u2);
    for (int i19 = 0; i19 < 3; i19++) {
        for (int i20 = 0; i20 < 3; i20++) {
            mediump ivec4 v21 = ivec4(1, ivec3(us.m1.rgg));
            v16.m1 = bvec2(true);
            acc.y += float(v21.w) * 0.0625;
        }
    }
    gl_FragColor = acc + vec4(1.0, 1.0, 1.0, float(v16.m0.w));
}
//# scene
[[draw]]
vertex = "a.vert"
fragment = "a.frag"
[draw.attributes]
place = { size = 2, values = [-1, -1, 3, -1, -1, 3] }
pw = { size = 1, values = [1, 2, 1.5] }

