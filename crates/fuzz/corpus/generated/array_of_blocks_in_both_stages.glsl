//# vertex
#version 400
struct S0 { vec4 m0; mat2 m1; mat3 m2; };
uniform float uf;
uniform bool never;
layout(std140) uniform Block { uvec3 k0; mat4 k1; mat3x4 k2[2]; S0 k3[2]; } block[2];
uniform sampler2D t2;
uniform isampler2D ti;
in vec2 place;
in float pw;
smooth out mat2 y0;
flat out vec2 y1[2];
out vec4 ya;
vec4 acc = vec4(0.0);
void main() {
    vec4 v14 = textureProjLodOffset(t2, clamp(vec3(1.0), 0.125, 2.5), clamp(block[0].k2[0][2].b, 0.0, 1.5), ivec2(1));
    ivec4 v17 = textureProjGrad(ti, clamp(block[0].k1[1], 0.125, 2.5), clamp(v14.qs, -0.5, 0.5), clamp(vec2(1.0), -0.5, 0.5));
    switch ((1 / 5) & 3) {
default:
        uint v21 = min(block[0].k0.z, block[1].k0.g);
        acc.x += float(v21 >> 16u) * 0.0625;
    case 1: {
    }
case 2:
        break;
    }
    acc.w += float(v17.z & 0xffff) * 0.0625;
    y0 = mat2(1.0);
    y1 = vec2[2](vec2(1.0), vec2(1.0));
    ya = acc;
    gl_Position = vec4(place * pw, 0.0, pw);
}
//# fragment
#version 400
struct S0 { vec4 m0; mat2 m1; mat3 m2; };
struct S1 { mat3x4 m0[2]; };
uniform int ui;
uniform S1 us;
layout(std140) uniform Block { uvec3 k0; mat4 k1; mat3x4 k2[2]; S0 k3[2]; } block[2];
uniform sampler2D t2;
uniform samplerCubeShadow tcs;
uniform isampler2D ti;
in vec4 ya;
layout(location = 0) out vec4 c0;
layout(location = 1) out vec4 c1;
layout(location = 2) out vec4 c2;
layout(location = 3) out vec4 c3;
vec4 acc = vec4(0.0);
void main() {
    c0 = vec4(0.25);
    c1 = vec4(0.25);
    c2 = vec4(0.25);
    c3 = vec4(0.25);
    vec4 v25 = textureProjGradOffset(t2, clamp((us.m0[0][1] * mat3x4(1.0)), 0.125, 2.5), clamp(vec2(1.0), -0.5, 0.5), clamp(vec2(1.0), -0.5, 0.5), ivec2(1));
    vec4 v26 = textureGather(tcs, clamp(vec3(1.0), 0.125, 2.5), clamp(ya.q, 0.0, 1.0));
    float v27 = texture(tcs, clamp((vec4(1.0) * ui), 0.125, 2.5));
    ivec4 v28 = textureProjGradOffset(ti, clamp(vec3(1.0), 0.125, 2.5), clamp(vec2(1.0), -0.5, 0.5), clamp(v26.xx, -0.5, 0.5), ivec2(1));
    mat3 v37 = block[0].k3[0].m2;
    acc.w += (1.0 < 8.0 ? max(v37[0].x, -8.0) : 8.0);
    c0 = acc + vec4(1.0, 1.0, float((v28.w >> 16) & 0xffff), 1.0);
}
//# scene
[[draw]]
vertex = "a.vert"
fragment = "a.frag"
[draw.attributes]
place = { size = 2, values = [-1, -1, 3, -1, -1, 3] }
pw = { size = 1, values = [1, 2, 1.5] }
[draw.textures]
t2 = { width = 4, height = 4, filter = "trilinear", mipmaps = true, values = [0.6875, 0, 0.3125, 0.625, 0.9375, 0.25, 0.5625, 0.875, 0.1875, 0.5, 0.8125, 0.125, 0.4375, 0.75, 0.0625, 0.375, 0.6875, 0, 0.3125, 0.625, 0.9375, 0.25, 0.5625, 0.875, 0.1875, 0.5, 0.8125, 0.125, 0.4375, 0.75, 0.0625, 0.375, 0.6875, 0, 0.3125, 0.625, 0.9375, 0.25, 0.5625, 0.875, 0.1875, 0.5, 0.8125, 0.125, 0.4375, 0.75, 0.0625, 0.375, 0.6875, 0, 0.3125, 0.625, 0.9375, 0.25, 0.5625, 0.875, 0.1875, 0.5, 0.8125, 0.125, 0.4375, 0.75, 0.0625, 0.375] }
ti = { width = 2, height = 2, values = [11, 0, 5, 10, 15, 4, 9, 14, 3, 8, 13, 2, 7, 12, 1, 6] }

