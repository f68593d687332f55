//# vertex
#version 130
in vec2 place;
in float pw;
smooth centroid out vec2 y0;
out vec4 ya;
vec4 acc = vec4(0.0);
void main() {
    y0 = vec2(1.0);
    ya = acc;
    gl_Position = vec4(place * pw, 0.0, pw);
}
//# fragment
#version 130
struct S0 { ivec4 m0; mat3 m1; bvec4 m2[2]; };
out vec4 c0;
vec4 acc = vec4(0.0);
mat4 f10(in S0 p9) {
    return mat4(1.0);
}
bvec2 f10 () {
    return bvec2(true);
}
void main() {
    c0 = vec4(0.25);
    mat4 v19 = f10(S0(ivec4(1), mat3(1.0), bvec4[2](bvec4(true), bvec4(true))));
    bvec2 v20 = f10 ();
    if (all(v20)) discard;
    c0 = acc + vec4(1.0, 1.0, v19[1].y, 1.0);
}
//# scene
[[draw]]
vertex = "a.vert"
fragment = "a.frag"
[draw.attributes]
place = { size = 2, values = [-1, -1, 3, -1, -1, 3] }
pw = { size = 1, values = [1, 2, 1.5] }
