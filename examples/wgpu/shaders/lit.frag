#version 150
#extension GL_ARB_shading_language_include : require
#include <glisten/lambert.glsl>
#include <glisten/blinn_phong.glsl>

in vec3 place;
in vec3 direction;

layout(std140) uniform Light {
    vec3 toward;     // the light, a unit vector in eye space
    float shininess; // of the surface
    vec3 color;      // of the light
} light;
uniform vec3 surface = vec3(0.6, 0.35, 0.25); // its color

out vec4 color;

void main() {
    vec3 N = normalize(direction);
    vec3 V = normalize(-place);
    vec3 diffuse = lambert(N, light.toward, surface, light.color);
    vec3 shine = blinnPhong(N, light.toward, V, light.shininess, vec3(0.5), light.color);
    color = vec4(diffuse + shine, 1.0);
}
