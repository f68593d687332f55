#version 150
#extension GL_ARB_shading_language_include : require
// The textbook's (101) with (83) and (89): diffuse reflection and the highlight of the half vector, at each fragment.
#include <glisten/blinn_phong.glsl>
#include <glisten/lambert.glsl>
#include <glisten/scene.glsl>

in vec3 world;
in vec3 direction;      // along the normal, not of unit length
uniform vec3 eye;       // in world space
out vec4 color;

void main()
{
    vec3 N = safeNormalize(direction);
    vec3 V = safeNormalize(eye - world);
    vec3 sum = background(material.ambient, global_ambient, material.emission);
    for (int i = 0; i < min(lights, GLISTEN_LIGHTS); ++i) {
        vec3 L = lightVector(light[i], world);
        vec3 Idiff = lambert(N, L, material.diffuse, light[i].diffuse);
        vec3 Ispec = blinnPhong(N, L, V, material.shininess, material.specular, light[i].specular);
        sum += lightTerm(light[i], material.ambient, world, N, L, Idiff, Ispec);
    }
    color = vec4(sum, 1.0);
}
