#version 150
#extension GL_ARB_shading_language_include : require
// A surface in the light of a panorama: the split sum and nine coefficients, which are those of the gallery's studio; or the panorama
// itself, behind everything.
#include <glisten/environment.glsl>
#include <glisten/irradiance.glsl>

in vec3 world;
in vec3 direction;          // along the normal
uniform sampler2D map;      // of `glisten lib prefilter`
uniform sampler2D albedos;  // ltc_albedo
uniform vec3 eye;           // in world space
uniform vec3 coefficients[9] = vec3[9](
    vec3(3.985, 3.759, 3.576),
    vec3(1.427, 1.512, 1.599),
    vec3(1.963, 1.862, 1.696),
    vec3(-2.243, -1.942, -1.419),
    vec3(-1.505, -1.362, -1.113),
    vec3(1.143, 1.100, 1.016),
    vec3(-0.496, -0.554, -0.693),
    vec3(-2.546, -2.338, -2.000),
    vec3(0.456, 0.591, 0.800));
uniform vec3 body = vec3(0.0);
uniform vec3 gloss = vec3(0.04);
uniform float roughness = 0.5;
uniform bool backdrop = false;
out vec4 color;

void main()
{
    vec3 seen = vec3(0.0);
    if (backdrop) {
        seen = environmentRadiance(map, world - eye, roughness);
    } else {
        vec3 N = safeNormalize(direction);
        vec3 V = safeNormalize(eye - world);
        // What is mirrored is missing in the body.
        vec3 share = 1.0 - ltcAlbedo(albedos, N, V, roughness, gloss);
        seen = environmentSpecular(map, albedos, N, V, roughness, gloss);
        seen += body * share * max(irradiance(N, coefficients), vec3(0.0));
    }
    color = vec4(seen, 1.0);
}
