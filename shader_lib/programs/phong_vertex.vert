#version 150
#extension GL_ARB_shading_language_include : require
// The textbook's (101) with (83) and (86): diffuse reflection and Phong's highlight, at each vertex.
#include <glisten/lambert.glsl>
#include <glisten/normal.glsl>
#include <glisten/phong.glsl>
#include <glisten/scene.glsl>

// How the color is interpolated: smooth, noperspective, or flat for one color a triangle.
#ifndef INTERPOLATION
#define INTERPOLATION smooth
#endif

in vec3 position;
in vec3 normal;
uniform mat4 model;
uniform mat3 model_normal;
uniform mat4 model_view_projection;
uniform vec3 eye;       // in world space
INTERPOLATION out vec3 shade;

void main()
{
    vec3 world = (model * vec4(position, 1.0)).xyz;
    vec3 N = transformNormal(model_normal, normal);
    vec3 V = safeNormalize(eye - world);
    vec3 sum = background(material.ambient, global_ambient, material.emission);
    for (int i = 0; i < min(lights, GLISTEN_LIGHTS); ++i) {
        vec3 L = lightVector(light[i], world);
        vec3 Idiff = lambert(N, L, material.diffuse, light[i].diffuse);
        vec3 Ispec = phong(N, L, V, material.shininess, material.specular, light[i].specular);
        sum += lightTerm(light[i], material.ambient, world, N, L, Idiff, Ispec);
    }
    shade = sum;
    gl_Position = model_view_projection * vec4(position, 1.0);
}
