//# vertex
#version 460
in vec2 place;
in float pw;
centroid out float y0[2];
out vec3 y1;
smooth centroid out vec2 y2;
out vec3 y3;
flat out vec4 ya;
vec4 acc = vec4(0.0);
void main() {
    y0 = float[2](1.0, 1.0);
    y1 = vec3(1.0);
    y2 = (vec4(1.0) * mat2x4(.75));
    y3 = vec3(1.0);
    ya = acc;
    gl_Position = vec4(place * pw, 0.0, pw);
}
//# fragment
#version 460
uniform samplerCubeArray tca;
smooth centroid in vec2 y2;
layout(location = 0) out vec4 c0;
vec4 acc = vec4(0.0);
const mat3x4 g2 = outerProduct(vec4(1e-1, 0.5, 0.51378, 1.22130), vec3(1.0));
vec4 f13(vec4 p14, vec4 p15, bool p16) {
    vec4 p14_own = p14;
    p14_own = (p14 + p15);
    return p14_own;
}
void main() {
    c0 = vec4(0.25);
    vec4 v21 = vec4(1.0);
    vec4 v22 = f13((g2 * vec3(1.0)), v21, false);
    vec4 v29 = textureGather(tca, clamp((v22 - (v22 - y2.yyyy)), 0.125, 2.5));
    c0 = acc + vec4(v29.z, 1.0, 1.0, 1.0);
}
//# scene
[[draw]]
vertex = "a.vert"
fragment = "a.frag"
[draw.attributes]
place = { size = 2, values = [-1, -1, 3, -1, -1, 3] }
pw = { size = 1, values = [1, 2, 1.5] }
[draw.textures]
tca = { width = 2, layers = 1, filter = "linear", values = [0.6875, 0, 0.3125, 0.625, 0.9375, 0.25, 0.5625, 0.875, 0.1875, 0.5, 0.8125, 0.125, 0.4375, 0.75, 0.0625, 0.375, 0.6875, 0, 0.3125, 0.625, 0.9375, 0.25, 0.5625, 0.875, 0.1875, 0.5, 0.8125, 0.125, 0.4375, 0.75, 0.0625, 0.375, 0.6875, 0, 0.3125, 0.625, 0.9375, 0.25, 0.5625, 0.875, 0.1875, 0.5, 0.8125, 0.125, 0.4375, 0.75, 0.0625, 0.375, 0.6875, 0, 0.3125, 0.625, 0.9375, 0.25, 0.5625, 0.875, 0.1875, 0.5, 0.8125, 0.125, 0.4375, 0.75, 0.0625, 0.375, 0.6875, 0, 0.3125, 0.625, 0.9375, 0.25, 0.5625, 0.875, 0.1875, 0.5, 0.8125, 0.125, 0.4375, 0.75, 0.0625, 0.375, 0.6875, 0, 0.3125, 0.625, 0.9375, 0.25, 0.5625, 0.875, 0.1875, 0.5, 0.8125, 0.125, 0.4375, 0.75, 0.0625, 0.375] }

