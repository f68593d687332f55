//# vertex
#version 460
in vec2 place;
in float pw;
smooth out vec4 y0;
out vec3 y1;
flat out int y2;
out Ioy3 { float a; flat ivec4 b; } y3;
out vec4 ya;
vec4 acc = vec4(0.0);
void main() {
    ivec3 v23 = ivec3(1, 698, 1);
    acc.x += float(v23.y & 0xffff) * 0.0625;
    y0 = vec4(1.0);
    y1 = vec3(1.0);
    y2 = 1;
    y3.a = 1.0;
    y3.b = ivec4(1);
    ya = acc;
    gl_Position = vec4(place * pw, 0.0, pw);
}
//# fragment
#version 460
uniform sampler1DArray t1a;
in vec4 ya;
layout(location = 0) out vec4 c0;
layout(location = 1) out vec4 c1;
vec3 g2 = (floatBitsToInt((clamp((-0.25), -100.0, 100.0) + 0.0)) + vec3(1.0));
vec2 f3() {
    return mod(vec2(1.0, g2.b), (abs(ya.x) + 0.5));
}
void main() {
    c0 = vec4(0.25);
    c1 = vec4(0.25);
    vec2 v19 = f3();
    vec4 v23 = textureLod(t1a, clamp(v19, 0.125, 2.5), clamp(1.0, 0.0, 1.5));
    c1 = vec4(1.0, v23.x, 1.0, 1.0);
}
//# scene
framebuffer = { width = 4, height = 4, attachments = 2, clear = [0, 0, 0, 0] }
[[draw]]
vertex = "a.vert"
fragment = "a.frag"
[draw.attributes]
place = { size = 2, values = [-1, -1, 3, -1, -1, 3] }
pw = { size = 1, values = [1, 2, 1.5] }
[draw.textures]
t1a = { width = 2, layers = 2, filter = "linear", values = [0.6875, 0, 0.3125, 0.625, 0.9375, 0.25, 0.5625, 0.875, 0.1875, 0.5, 0.8125, 0.125, 0.4375, 0.75, 0.0625, 0.375] }

