#version 150 core
#extension GL_ARB_shading_language_include : require
#include <glisten/half_lambert.glsl>
in vec4 vc;
in vec3 vn;
uniform vec3 light = vec3(0.0, 0.8, 0.6);
out vec4 fc;
void main(void)
{
    fc = vec4(halfLambert(normalize(vn), light, vc.rgb, vec3(1.0)), vc.a);
}
