// name: noise
// kind: helper
// equation: sums over the corners of a cell; fade t^3 (t (6 t - 15) + 10)
// source: Jarzynski and Olano, Hash Functions for GPU Rendering, JCGT 9(3), 2020; Perlin, Improving Noise, SIGGRAPH 2002; Gustavson, Simplex Noise Demystified, 2005; Worley, A Cellular Texture Basis Function, SIGGRAPH 1996
// stability: the hash is of integers: the same on every GPU, where fract(sin(x) * 43758.5) is not the same on two
//
// Noise that is the same picture on all GPUs. Coordinates are limited to [-2^22, 2^22]; cells are 1 wide.
#ifndef GLISTEN_NOISE
#define GLISTEN_NOISE
#include "safe.glsl"

// The hash of PCG, 32 bits.
// bound: 3e-7 rel
uint noiseHash(uint x)
{
    uint s = x * 747796405u + 2891336453u;
    uint w = ((s >> ((s >> 28u) + 4u)) ^ s) * 277803737u;
    return (w >> 22u) ^ w;
}

// The hash of a cell.
// bound: 3e-7 rel
uint noiseHash(ivec3 cell)
{
    return noiseHash(uint(cell.x) + noiseHash(uint(cell.y) + noiseHash(uint(cell.z))));
}

// A hash as a number from 0 to 1, excluding 1: its upper 24 bits, which f32 has exactly.
// bound: 0 abs
float noiseUnit(uint hash)
{
    return float(hash >> 8u) / 16777216.0;
}

// The coordinates as all functions here take them.
// bound: 0 rel
vec3 noisePlace(vec3 p)
{
    return clamp(p, vec3(-4194304.0), vec3(4194304.0));
}

// The mean of the random numbers of a cell's corners: 0 to 1.
// bound: 1.9e-6 abs
float noiseValue(vec3 p)
{
    p = noisePlace(p);
    vec3 low = floor(p);
    vec3 f = p - low;
    f = f * f * f * (f * (f * 6.0 - 15.0) + 10.0);
    ivec3 cell = ivec3(low);
    float sum = 0.0;
    for (int i = 0; i < 8; ++i) {
        ivec3 corner = ivec3(i & 1, (i >> 1) & 1, i >> 2);
        vec3 w = mix(1.0 - f, f, vec3(corner));
        sum += w.x * w.y * w.z * noiseUnit(noiseHash(cell + corner));
    }
    return sum;
}

// Perlin's noise with gradients along the edges of a cube: within -1.04 and 1.04, 0 at the corners of cells.
// bound: 1.9e-6 abs
float noiseGradient(vec3 p)
{
    p = noisePlace(p);
    vec3 low = floor(p);
    vec3 f = p - low;
    vec3 fade = f * f * f * (f * (f * 6.0 - 15.0) + 10.0);
    ivec3 cell = ivec3(low);
    float sum = 0.0;
    for (int i = 0; i < 8; ++i) {
        ivec3 corner = ivec3(i & 1, (i >> 1) & 1, i >> 2);
        vec3 w = mix(1.0 - fade, fade, vec3(corner));
        vec3 d = f - vec3(corner);
        // One of 12 gradients, four of them twice: (1, 1, 0) and its like.
        uint h = noiseHash(cell + corner) >> 28u;
        float u = h < 8u ? d.x : d.y;
        float v = h < 4u ? d.y : (h == 12u || h == 14u ? d.x : d.z);
        sum += w.x * w.y * w.z * (((h & 1u) == 0u ? u : -u) + ((h & 2u) == 0u ? v : -v));
    }
    return sum;
}

// Simplex noise in the plane, of the three corners of a triangle: -1 to 1.
// bound: 3e-4 abs, at coordinates of a thousand the skewed ones have lost ten bits
float noiseSimplex(vec2 p)
{
    p = noisePlace(vec3(p, 0.0)).xy;
    float skew = 0.5 * (sqrt(3.0) - 1.0);
    float back = (3.0 - sqrt(3.0)) / 6.0;
    vec2 cell = floor(p + (p.x + p.y) * skew);
    // The place from the cell's corner: differences of whole numbers first.
    vec2 d0 = (p - cell) + (cell.x + cell.y) * back;
    vec2 step1 = d0.x > d0.y ? vec2(1.0, 0.0) : vec2(0.0, 1.0);
    float sum = 0.0;
    for (int i = 0; i < 3; ++i) {
        vec2 corner = i == 0 ? vec2(0.0) : (i == 1 ? step1 : vec2(1.0));
        vec2 d = d0 - corner + float(i) * back;
        float t = max(0.5 - dot(d, d), 0.0);
        uint h = noiseHash(ivec3(ivec2(cell + corner), 0)) >> 29u;
        // One of eight directions.
        vec2 g = h < 4u ? vec2(h & 1u, h >> 1u) * 2.0 - 1.0 : vec2(0.0);
        if (h >= 4u)
            g = (h & 2u) == 0u ? vec2((h & 1u) == 0u ? sqrt(2.0) : -sqrt(2.0), 0.0) : vec2(0.0, (h & 1u) == 0u ? sqrt(2.0) : -sqrt(2.0));
        sum += t * t * t * t * dot(g, d);
    }
    return clamp(70.0 * sum, -1.0, 1.0);
}

// Worley's noise: the distance to the nearest of one random point in each cell.
// bound: 6e-7 abs
float noiseWorley(vec3 p)
{
    p = noisePlace(p);
    vec3 low = floor(p);
    vec3 f = p - low;
    ivec3 cell = ivec3(low);
    float nearest = 8.0;
    // What is farther away than 1 may be nearest from two cells away, which is rare.
    for (int reach = 1; reach == 1 || (reach == 2 && nearest > 1.0); ++reach) {
        int n = 2 * reach + 1;
        for (int i = 0; i < n * n * n; ++i) {
            ivec3 to = ivec3(i % n, (i / n) % n, i / (n * n)) - reach;
            uint h = noiseHash(cell + to);
            uint k = noiseHash(h);
            vec3 d = vec3(to) + vec3(noiseUnit(h), noiseUnit(k), noiseUnit(noiseHash(k))) - f;
            nearest = min(nearest, dot(d, d));
        }
    }
    return sqrt(nearest);
}

// Octaves of Perlin's noise, each twice as fine and half as strong: within -2.08 and 2.08.
//   octaves  limited to [1, 16]
// bound: 2e-5 abs, sixteen octaves, the last at 65536 times the coordinates
float noiseFractal(vec3 p, int octaves)
{
    p = noisePlace(p);
    float sum = 0.0;
    float size = 1.0;
    for (int i = 0; i < clamp(octaves, 1, 16); ++i) {
        sum += size * noiseGradient(p);
        p = 2.0 * p;
        size *= 0.5;
    }
    return sum;
}

#endif
