#version 150
#extension GL_ARB_shading_language_include : require
// Solid textures of the module `noise`, lit by one light and two half spheres.
#include <glisten/artistic.glsl>
#include <glisten/noise.glsl>
#include <glisten/scene.glsl>

in vec3 world;
in vec3 direction;          // along the normal
uniform int kind;           // 0 marble, 1 cells, 2 wood, 3 a planet
uniform vec3 eye;           // in world space
uniform vec3 dark;
uniform vec3 bright;
uniform float scale = 3.0;
out vec4 color;

vec3 body(vec3 p)
{
    switch (kind) {
    case 0: {
        // Veins where a distorted wave is near 0.
        float wave = abs(p.x + 0.6 * p.y + 1.4 * noiseFractal(p, 5));
        return mix(dark, bright, sqrt(safeUnit(0.8 * wave)));
    }
    case 1:
        return mix(bright, dark, safeUnit(1.2 * noiseWorley(p)));
    case 2: {
        float rings = 5.0 * safeLength(vec3(p.x, 0.15 * p.y, p.z)) + 1.2 * noiseValue(1.5 * p);
        float ring = rings - floor(rings);
        float fiber = 0.15 * noiseGradient(vec3(24.0 * p.x, 2.0 * p.y, 24.0 * p.z));
        return mix(dark, bright, safeUnit(ring * (2.0 - ring) + fiber));
    }
    }
    float height = noiseFractal(p, 6);
    vec3 ground = mix(bright, vec3(0.35, 0.28, 0.18), smoothstep(0.05, 0.4, height));
    ground = mix(ground, vec3(0.9), smoothstep(0.45, 0.55, height));
    vec3 world = mix(dark, ground, smoothstep(-0.02, 0.02, height));
    float cloud = smoothstep(0.05, 0.5, noiseFractal(1.3 * p + vec3(9.0, 2.0, 5.0), 5));
    return mix(world, vec3(0.95), cloud);
}

void main()
{
    vec3 N = safeNormalize(direction);
    vec3 V = safeNormalize(eye - world);
    vec3 albedo = body(scale * world);
    vec3 sum = vec3(0.0);
    for (int i = 0; i < min(lights, GLISTEN_LIGHTS); ++i) {
        vec3 L = lightVector(light[i], world);
        vec3 Idiff = lambert(N, L, albedo, light[i].diffuse);
        vec3 Ispec = blinnPhong(N, L, V, 60.0, vec3(0.12), light[i].specular);
        sum += lightTerm(light[i], albedo, world, N, L, Idiff, Ispec);
    }
    color = vec4(sum, 1.0);
}
