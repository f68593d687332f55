// name: hemisphere
// kind: ambient
// equation: color = 0.5 (1 + cos) sky + 0.5 (1 - cos) ground, cos = N.A
// source: article, programs `hemisphere`, `hemi_amb`, `hemi_spec`
// stability: finite for every finite input; exact at both poles, and the darker half sphere keeps its digits near them
#ifndef GLISTEN_HEMISPHERE
#define GLISTEN_HEMISPHERE
#include "lambert.glsl"
#include "lut.glsl"

// How much of the sky a surface sees: 0 if it faces away from the axis, 1 if it faces along it.
//   N  unit normal    axis  unit vector towards the middle of the sky
// bound: 3e-7 abs
float hemisphereWeight(vec3 N, vec3 axis)
{
    return safeUnit(0.5 * dot(N, axis) + 0.5);
}

// Light from two half spheres of uniform color, linear RGB. It is a weighted mean and not the article's ground +
// weight (sky - ground), whose difference loses the darker color if the two differ by orders of magnitude.
//   N  unit normal    axis  unit vector towards the middle of the sky    sky, ground  colors of the two half spheres
// bound: 2.4e-7 rel
vec3 hemisphere(vec3 N, vec3 axis, vec3 sky, vec3 ground)
{
    float a = hemisphereWeight(N, axis);
    float b = 1.0 - a;
    float c = dot(N, axis);
    // Near a pole, the smaller weight is a distance: as a difference it would lose its digits.
    if (c > 0.875)
        b = min(0.5 * safeOneMinusCos(N, axis), 1.0);
    else if (c < -0.875)
        a = min(0.5 * safeOneMinusCos(N, -axis), 1.0);
    return safeLimit(a * sky + b * ground);
}

// The same light from a table whose first texel is the ground and whose last is the sky.
//   table  n by 1 texels, clamped
// bound: 7e-7 abs
vec3 hemisphereLut(sampler2D table, vec3 N, vec3 axis)
{
    return lutColor(table, hemisphereWeight(N, axis));
}

// A directional light with the hemisphere as its ambient light, linear RGB: max(N.L, 0) L_diff + hemisphere, times
// the color of the material.
//   L  unit vector towards the light    Kdiff  color of the material, 0 to 1    Ldiff  intensity of the light, >= 0
// bound: 2.4e-7 rel
vec3 hemisphereDirectional(vec3 N, vec3 L, vec3 axis, vec3 Kdiff, vec3 Ldiff, vec3 sky, vec3 ground)
{
    vec3 light = safeLimit(lambertFactor(N, L) * Ldiff) + hemisphere(N, axis, sky, ground);
    return safeLimit(Kdiff * safeFinite(light));
}

// The same light with a highlight.
//   Ispec  specular reflection of any model, linear RGB
// bound: 2.4e-7 rel
vec3 hemisphereSpecular(vec3 N, vec3 L, vec3 axis, vec3 Kdiff, vec3 Ldiff, vec3 sky, vec3 ground, vec3 Ispec)
{
    return safeLimit(hemisphereDirectional(N, L, axis, Kdiff, Ldiff, sky, ground) + Ispec);
}

#endif
