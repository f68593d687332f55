#version 450
in vec2 at;
out vec4 c;
void main() { c = vec4(mix(1, 2, at.x > 0.5)); }
