//# vertex
#version 440
in vec2 place;
in float pw;
flat out vec3 y0[2];
noperspective out vec3 y1;
smooth centroid out vec3 y2;
out Ioy3 { vec4 a; flat int b; } y3;
out vec4 ya;
vec4 acc = vec4(0.0);
void main() {
    y0 = vec3[2](vec3(1.0), vec3(3.0, 2.0, 4.5));
    y1 = vec3(1.0);
    y2 = vec3(1.0);
    y3.a = vec4(2.0, 1.0, 0.25, 0.5);
    y3.b = 1;
    ya = acc;
    gl_Position = vec4(place * pw, 0.0, pw);
}
//# fragment
#version 440
flat in vec3 y0[2];
in Ioy3 { vec4 a; flat int b; } y3;
layout(location = 0) out vec4 c0;
layout(location = 1) out vec4 c1;
vec4 acc = vec4(0.0);
void main() {
    c0 = vec4(0.25);
    c1 = vec4(0.25);
    int v6 = 1;
    vec4 v7 = y0[(v6 & 1)].rrgb;
    mat4 v9 = mat4(y3.a, vec4(1.0, 2.0, 0.5, 0.25), v7, vec4(0.0, 4., (-2.3), 0.0));
    v9 = inverse(v9);
    c0 = acc + vec4(1.0, 1.0, v9[1].x, 1.0);
}
//# scene
[[draw]]
vertex = "a.vert"
fragment = "a.frag"
[draw.attributes]
place = { size = 2, values = [-1, -1, 3, -1, -1, 3] }
pw = { size = 1, values = [1, 2, 1.5] }

