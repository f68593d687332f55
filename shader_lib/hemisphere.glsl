// name: hemisphere
// kind: ambient
// equation: color = 0.5 (1 + cos) sky + 0.5 (1 - cos) ground, cos = N.A
// source: article, programs `hemisphere`, `hemi_amb`, `hemi_spec`
#ifndef GLISTEN_HEMISPHERE
#define GLISTEN_HEMISPHERE
#include "safe.glsl"

// How much of the sky a surface sees: 0 turned away from the axis, 1 turned along it.
//   N  unit normal    axis  unit vector towards the middle of the sky
float hemisphereWeight(vec3 N, vec3 axis)
{
    return safeUnit(0.5 * dot(N, axis) + 0.5);
}

// Light from two half spheres of uniform color, as the article's last line writes it: ground + weight (sky - ground).
vec3 hemisphere(vec3 N, vec3 axis, vec3 sky, vec3 ground)
{
    float a = hemisphereWeight(N, axis);
    return a * sky + (1.0 - a) * ground;
}

// The same from a table whose ends are ground and sky.
vec3 hemisphereLut(sampler2D table, vec3 N, vec3 axis)
{
    float n = float(textureSize(table, 0).x);
    float u = (hemisphereWeight(N, axis) * (n - 1.0) + 0.5) / n;
    return texture(table, vec2(u, 0.5)).rgb;
}

#endif
