//# vertex
#version 440
in vec2 place;
mat4x2[2][3] f() {
    return mat4x2[2][3](mat4x2[3](mat4x2(1.0), mat4x2(1.0), mat4x2(1.0)), mat4x2[3](mat4x2(1.0), mat4x2(1.0), mat4x2(1.0)));
}
void main() {
    gl_Position = vec4(place * f()[1][2][0].x, 0.0, 1.0);
}
//# fragment
#version 440
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
