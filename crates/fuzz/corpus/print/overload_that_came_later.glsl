#version 430
in vec2 at;
out vec4 c;
uniform sampler2DArrayShadow s;
void main() { c = vec4(textureOffset(s, vec4(at, 0.0, 1.0), ivec2(1))); }
