//# vertex
#version 310 es
in vec2 place;
void main() {
}
//# fragment
#version 310 es
void main() {
    if ((mat3x4[2][2](mat3x4[2](mat3x4(1.0), mat3x4(1.0)), mat3x4[2](mat3x4(1.0), mat3x4(1.0))) != mat3x4[2][2](mat3x4[2](mat3x4(1.0), mat3x4(1.0)), mat3x4[2](mat3x4(1.0), mat3x4(1.0))))) {
    } else if (gl_FrontFacing) {
    } else {
    }
}
//# scene
[[draw]]
vertex = "a.vert"
fragment = "a.frag"
[draw.attributes]
place = { size = 2, values = [-1, -1, 3, -1, -1, 3] }
