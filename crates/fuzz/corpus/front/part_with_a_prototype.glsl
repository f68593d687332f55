//# fragment
#version 150
float f(); out vec4 c; void main() { c = vec4(f()); } //~ E0723 7:8

