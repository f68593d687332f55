#version 150
#extension GL_ARB_shading_language_include : require
// A white metal in a white room: the sum over directions that the model prefers, on the right with what later reflections add.
#include <glisten/energy.glsl>
#include <glisten/ggx.glsl>
#include <glisten/noise.glsl>

in vec3 world;
in vec3 direction;          // along the normal
uniform sampler2D albedos;  // ltc_albedo
uniform vec3 eye;           // in world space
uniform vec3 room = vec3(1.0);
uniform float roughness = 0.5;
uniform float middle = 0.0; // the left of which has no compensation
out vec4 color;

const int SAMPLES = 64;

// pi f N.L of all light from a white room, by the half vectors that the eye sees.
float returned(vec3 N, vec3 V, float alpha, float turn)
{
    mat3 frame = ltcFrame(N, V);
    vec3 v = frame * V;
    // The half sphere as the eye sees it, stretched: Heitz, Sampling the GGX Distribution of Visible Normals, 2018.
    vec3 wide = safeNormalize(vec3(alpha * v.x, 0.0, v.z));
    vec3 up = vec3(-wide.z, 0.0, wide.x);
    float other = v.z + sqrt(alpha * alpha + (1.0 - alpha * alpha) * v.z * v.z);
    float sum = 0.0;
    for (int i = 0; i < SAMPLES; ++i) {
        float u = (float(i) + 0.5) / float(SAMPLES);
        float around = radians(360.0) * fract(turn + float((uint(i) * 1640531527u) >> 8u) / 16777216.0);
        float x = sqrt(u) * cos(around);
        float y = mix(sqrt(max(1.0 - x * x, 0.0)), sqrt(u) * sin(around), 0.5 + 0.5 * wide.z);
        vec3 h = vec3(0.0, x, 0.0) + y * up + sqrt(max(1.0 - x * x - y * y, 0.0)) * wide;
        h = safeNormalize(vec3(alpha * h.xy, max(h.z, 0.0)));
        vec3 l = 2.0 * dot(v, h) * h - v;
        // G_2 over G_1 of the eye.
        if (l.z > 0.0)
            sum += 2.0 * l.z * other * ggxVisibility(l.z, v.z, alpha);
    }
    return sum / float(SAMPLES);
}

void main()
{
    vec3 V = safeNormalize(eye - world);
    vec3 N = safeNormalize(direction);
    // Interpolated normals at the rim may face away.
    N = safeNormalize(N + max(0.01 - dot(N, V), 0.0) * V);
    float turn = noiseUnit(noiseHash(ivec3(gl_FragCoord.xy, 0)));
    vec3 seen = vec3(returned(N, V, roughness * roughness, turn));
    if (world.x > middle)
        seen *= energyCompensation(albedos, N, V, roughness, vec3(1.0));
    color = vec4(room * seen, 1.0);
}
