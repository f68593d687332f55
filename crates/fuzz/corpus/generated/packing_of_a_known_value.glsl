//# vertex
#version 400
in vec2 place;
in float pw;
out vec3 y0;
centroid out vec2 y1;
void main() {
    y0 = vec3(1.0);
    y1 = vec2(1.0);
    gl_Position = vec4(place * pw, 0.0, pw);
}
//# fragment
#version 400
uniform vec4 u0;
layout(location = 0) out vec4 c0;
layout(location = 1) out vec4 c1;
layout(location = 2) out vec4 c2;
void main() {
    c0 = vec4(0.25);
    c1 = vec4(0.25);
    c2 = vec4(0.25);
    uvec4 v16 = uvec4(1u);
    v16 += packUnorm4x8(u0);
    c0 = vec4(1.0, 1.0, float(v16.x >> 16u), 1.0);
}
//# scene
framebuffer = { width = 4, height = 4, attachments = 3, clear = [0, 0, 0, 0] }
[[draw]]
vertex = "a.vert"
fragment = "a.frag"
[draw.attributes]
place = { size = 2, values = [-1, -1, 3, -1, -1, 3] }
pw = { size = 1, values = [1, 2, 1.5] }
[draw.uniforms]
"u0" = [-2.0, -2.0, 0.3, 0.3]
