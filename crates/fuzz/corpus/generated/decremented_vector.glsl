//# vertex
#version 440
in vec2 place;
void main() {
}
//# fragment
#version 440
struct S0 { bvec4 m0; uvec3 m1; uvec3 m2[2]; };
void main() {
    uvec3 v13[2] = uvec3[2](uvec3(1u), uvec3(1u));
    S0 v17 = S0(bvec4(true), v13[1]--, uvec3[2](uvec3(1u), uvec3(1u)));
}
//# scene
[[draw]]
vertex = "a.vert"
fragment = "a.frag"
[draw.attributes]
place = { size = 2, values = [-1, -1, 3, -1, -1, 3] }
