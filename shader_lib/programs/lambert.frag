#version 150
#extension GL_ARB_shading_language_include : require
// The textbook's (83): diffuse reflection, at each fragment.
#include <glisten/ambient.glsl>
#include <glisten/lambert.glsl>
#include <glisten/scene.glsl>

in vec3 world;
in vec3 direction;      // along the normal, not of unit length
out vec4 color;

void main()
{
    vec3 N = safeNormalize(direction);
    vec3 sum = vec3(0.0);
    for (int i = 0; i < min(lights, GLISTEN_LIGHTS); ++i) {
        vec3 L = lightVector(light[i], world);
        vec3 Iamb = ambient(material.ambient, light[i].ambient);
        vec3 Idiff = lambert(N, L, material.diffuse, light[i].diffuse);
        sum += Iamb + Idiff;
    }
    color = vec4(sum, 1.0);
}
