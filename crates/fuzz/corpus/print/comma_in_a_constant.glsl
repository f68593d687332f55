//# vertex
#version 420
uniform float list[(5, 3)];
const float one = (2.0, 1.0);
void main() {
    gl_Position = vec4(list[2] * one);
}

