//# fragment
#version 150
vec4 lit(
uniform vec3 normal out vec4 color;
void main() { color = vec4(normal, 1.0); }
