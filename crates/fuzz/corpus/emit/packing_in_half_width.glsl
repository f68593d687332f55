#version 420
in vec2 at;
out vec4 c;
void main() { c = unpackUnorm4x8(packHalf2x16(at)) + vec4(unpackHalf2x16(packUnorm2x16(at)), unpackSnorm2x16(packSnorm2x16(at))); }
