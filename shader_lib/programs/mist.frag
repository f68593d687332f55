#version 150
#extension GL_ARB_shading_language_include : require
// Lambert's reflection in fog that lies on the ground.
#include <glisten/fog.glsl>
#include <glisten/lambert.glsl>
#include <glisten/scene.glsl>

in vec3 world;
in vec3 direction;          // along the normal
uniform vec3 eye;           // in world space
uniform vec3 body = vec3(0.5);
uniform vec3 fog = vec3(0.6);
uniform float density = 0.1;
uniform float falloff = 0.5;
out vec4 color;

void main()
{
    vec3 N = safeNormalize(direction);
    vec3 sum = vec3(0.0);
    for (int i = 0; i < min(lights, GLISTEN_LIGHTS); ++i) {
        vec3 L = lightVector(light[i], world);
        sum += lightTerm(light[i], body, world, N, L, lambert(N, L, body, light[i].diffuse), vec3(0.0));
    }
    vec3 ray = safeNormalize(world - eye);
    float seen = fogFactor(eye.y, ray, safeLength(world - eye), density, falloff);
    color = vec4(mix(fog, sum, seen), 1.0);
}
