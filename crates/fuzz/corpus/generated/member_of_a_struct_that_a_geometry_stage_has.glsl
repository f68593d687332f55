//# vertex
#version 460
struct S1 { vec4 m0; };
in vec2 place;
in float pw;
centroid out mat2 y0;
noperspective out S1 y1;
out Ioy2 { vec4 a; flat ivec3 b; } y2;
noperspective out float y3;
out vec4 ya;
vec4 acc = vec4(0.0);
void main() {
    y0 = mat2(1.0);
    y1 = S1(vec4(1.0));
    y2.a = vec4(1.0);
    y2.b = ivec3(1);
    y3 = 1.0;
    ya = acc;
    gl_Position = vec4(place * pw, 0.0, pw);
}
//# geometry
#version 460
struct S0 { mat3x2 m0; mat2x4 m1; uvec2 m2; };
struct S1 { vec4 m0; };
uniform mat4x2 u0;
uniform S0 us;
layout(triangles) in;
layout(triangle_strip, max_vertices = 3) out;
centroid in mat2 y0[];
noperspective in S1 y1[];
in Ioy2 { vec4 a; flat ivec3 b; } y2[];
noperspective in float y3[];
in vec4 ya[];
centroid out mat2 zy0;
noperspective out S1 zy1;
out Iozy2 { vec4 a; flat ivec3 b; } zy2;
noperspective out float zy3;
out vec4 zya;
vec4 acc = vec4(0.0);
vec4 f12(const in uvec2 p7, const in mat4x2 p8) {
    return vec4(1.0);
}
void main() {
    vec4 v18 = f12(us.m2, u0);
    for (int corner = 0; corner < 3; corner++) {
        zy0 = y0[corner];
        zy1 = y1[corner];
        zy2.a = y2[corner].a;
        zy2.b = y2[corner].b;
        zy3 = y3[corner];
        zya = ya[corner] + acc;
        gl_Position = gl_in[corner].gl_Position;
        EmitVertex();
    }
    EndPrimitive();
}
//# fragment
#version 460
struct S0 { mat3x2 m0; mat2x4 m1; uvec2 m2; };
layout(location = 0) out vec4 c0;
layout(location = 1) out vec4 c1;
void main() {
    c0 = vec4(0.25);
    c1 = vec4(0.25);
    S0 v19 = S0(mat3x2(1.0), mat2x4(1.0), uvec2(1u));
}
//# scene
framebuffer = { width = 4, height = 4, attachments = 2, clear = [0, 0, 0, 0] }
[[draw]]
vertex = "a.vert"
fragment = "a.frag"
geometry = "a.geom"
[draw.attributes]
place = { size = 2, values = [-1, -1, 3, -1, -1, 3] }
pw = { size = 1, values = [1, 2, 1.5] }
