#version 150
#extension GL_ARB_shading_language_include : require
// A white surface in the light of nine coefficients.
#include <glisten/irradiance.glsl>

in vec3 world;
in vec3 direction;          // along the normal
uniform vec3 coefficients[9];
uniform vec3 body = vec3(0.8);
out vec4 color;

void main()
{
    color = vec4(body * max(irradiance(safeNormalize(direction), coefficients), vec3(0.0)), 1.0);
}
