//# vertex
#version 330
in vec2 place;
in float pw;
smooth centroid out vec3 y0;
out Ioy1 { float a; flat ivec2 b; } y1;
out Ioy2 { vec4 a; flat int b; } y2;
smooth out vec3 y3;
out vec4 ya;
vec4 acc = vec4(0.0);
void main() {
    vec4 v8 = vec4(place, place);
    acc.z += (1.0 < 8.0 ? max(v8.y, -8.0) : 8.0);
    y0 = vec3(1.0);
    y1.a = 1.0;
    y1.b = ivec2(1);
    y2.a = vec4(1.0);
    y2.b = 1;
    y3 = vec3(1.0);
    ya = acc;
    gl_Position = vec4(place * pw, 0.0, pw);
}
//# fragment
#version 330
layout(location = 0) out vec4 c0;
layout(location = 1) out vec4 c1;
layout(location = 2) out vec4 c2;
layout(location = 3) out vec4 c3;
void main() {
    c0 = vec4(0.25);
    c1 = vec4(0.25);
    c2 = vec4(0.25);
    c3 = vec4(0.25);
}
//# scene
framebuffer = { width = 4, height = 4, attachments = 4, clear = [0, 0, 0, 0] }
[[draw]]
vertex = "a.vert"
fragment = "a.frag"
[draw.attributes]
place = { size = 2, values = [-1, -1, 3, -1, -1, 3] }
pw = { size = 1, values = [1, 2, 1.5] }
