//# vertex
#version 410
in vec2 place;
in float pw;
out Ioy0 { vec4 a; flat ivec3 b; } y0;
noperspective out vec2 y1;
smooth out vec4 y2;
flat out vec3 y3;
out vec4 ya;
vec4 acc = vec4(0.0);
void main() {
    y0.a = vec4(1.0);
    y0.b = ivec3(1);
    y1 = vec2(1.0);
    y2 = vec4(1.0);
    y3 = vec3(1.0);
    ya = acc;
    gl_ClipDistance[0] = 1.0;
    gl_ClipDistance[1] = place.x + 1.5;
    gl_Position = vec4(place * pw, 0.0, pw);
}
//# fragment
#version 410
in Ioy0 { vec4 a; flat ivec3 b; } y0;
layout(location = 0) out vec4 c0;
layout(location = 1) out vec4 c1;
layout(location = 2) out vec4 c2;
const uvec2 g1 = uvec2(2010u);
void main() {
    c0 = vec4(0.25);
    c1 = vec4(0.25);
    c2 = vec4(0.25);
    uint v21 = (g1.x << ((y0.b.ptps, g1.t) & 31u));
}
//# scene
framebuffer = { width = 4, height = 4, attachments = 3, clear = [0, 0, 0, 0] }
[[draw]]
vertex = "a.vert"
fragment = "a.frag"
[draw.attributes]
place = { size = 2, values = [-1, -1, 3, -1, -1, 3] }
pw = { size = 1, values = [1, 2, 1.5] }

