#version 150
#define LINE(x, a, b) (b * (x) + a)
in float h;
out vec4 c;
void main() { c = vec4(LINE(h, 2.0, 1.0)); }
