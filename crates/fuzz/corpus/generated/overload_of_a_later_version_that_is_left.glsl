//# vertex
#version 430
uniform sampler2DArrayShadow tas;
in vec2 place;
in float pw;
smooth out vec3 y0;
out Ioy1 { vec4 a; flat int b; } y1;
out Ioy2 { float a; flat ivec4 b; } y2;
out Ioy3 { vec3 a; flat ivec4 b; } y3;
flat out vec4 ya;
vec4 acc = vec4(0.0);
void main() {
    int v15 = textureQueryLevels(tas);
    acc.x += float((v15 >> 16) & 0xffff) * 0.0625;
    y0 = vec3(1.0);
    y1.a = vec4(1.0);
    y1.b = 0;
    y2.a = 1.0;
    y2.b = ivec4(1);
    y3.a = vec3(1.0);
    y3.b = ivec4(1);
    ya = acc;
    gl_Position = vec4(place * pw, 0.0, pw);
}
//# fragment
#version 430
uniform sampler2DArrayShadow tas;
flat in vec4 ya;
layout(location = 0) out vec4 c0;
layout(location = 1) out vec4 c1;
layout(location = 2) out vec4 c2;
vec4 acc = vec4(0.0);
void main() {
    c0 = vec4(0.25);
    c1 = vec4(0.25);
    c2 = vec4(0.25);
    float v26 = textureOffset(tas, clamp(vec4(1.0), 0.125, 2.5), ivec2(1));
    acc += ya;
    switch (bitfieldExtract(1, 3, 7) & 3) {
default: {
        if (true) { c0 = acc; return; }
    }
case 1: {
    }
case 2:
        break;
    }
    acc.w += (v26 < 8.0 ? max(v26, -8.0) : 8.0);
}
//# scene
framebuffer = { width = 4, height = 4, attachments = 3, clear = [0, 0, 0, 0] }
[[draw]]
vertex = "a.vert"
fragment = "a.frag"
[draw.attributes]
place = { size = 2, values = [-1, -1, 3, -1, -1, 3] }
pw = { size = 1, values = [1, 2, 1.5] }

