//# vertex
#version 460
layout(shared) uniform Block { uvec4 k0[2]; uint k1; vec2 k2[2]; };
in vec2 place;
void main() {
    gl_Position = vec4(place * k2[1], float(k1), 1.0);
}
//# fragment
#version 460
layout(location = 0) out vec4 c0;
void main() {
    c0 = vec4(1.0);
}
//# scene
framebuffer = { width = 4, height = 4 }
[[draw]]
vertex = "a.vert"
fragment = "a.frag"
primitive = "triangles"
[draw.attributes]
place = { size = 2, values = [-1, -1, 3, -1, -1, 3] }
[draw.uniforms]
k0 = [0, 0, 0, 0, 0, 0, 0, 0]
k1 = 0
k2 = [1, 1, 1, 1]
