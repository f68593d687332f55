// name: lights
// kind: equation
// equation: (101): I_tot = K_amb * L_glob + L_emi + sum of c_spot (I_amb + d (I_diff + I_spec)) over the lights
// source: textbook, sections 10.1.2 and 10.1.5 to 10.1.7
// stability: finite for every finite input
//
// The kinds of light as one struct, and a light's whole term with Lambert's diffuse and Blinn and Phong's specular
// reflection. The equation is background() plus a loop over the lights that adds lightTerm(). Write the loop where
// the lights are declared, since an array is copied when it is passed to a function. For other models, pass their
// reflections to the other lightTerm(). All positions and directions are in one space.
//
// GLISTEN_LIGHTS is the size of a scene's array of lights; define it before the include for more than 8. With GLISTEN_CONES, lights
// have the range and the cone of `punctual`, too; with GLISTEN_AREAS, the shapes of `ltc`, which lightTerm() takes for points.
#ifndef GLISTEN_LIGHTS_MODULE
#define GLISTEN_LIGHTS_MODULE
#include "ambient.glsl"
#include "attenuation.glsl"
#include "blinn_phong.glsl"
#include "hemisphere.glsl"
#include "illumination.glsl"
#include "lambert.glsl"
#include "spot.glsl"
#ifdef GLISTEN_CONES
#include "punctual.glsl"
#endif

#ifndef GLISTEN_LIGHTS
#define GLISTEN_LIGHTS 8
#endif

// The values of Light.kind.
const int LIGHT_DIRECTIONAL = 0;
const int LIGHT_POINT = 1;
const int LIGHT_SPOT = 2;
// Two half spheres of light: `direction` points to the center of the sky, `diffuse` is the sky's color and `ambient`
// the ground's. The result counts as ambient light.
const int LIGHT_HEMISPHERE = 3;
// Lights with a shape: `diffuse` and `specular` are their radiance, so that one all over the sky gives as much as a hemisphere.
// `position` is the middle, and flat ones shine along `direction`, to both sides if it is zero.
const int LIGHT_SPHERE = 5;
const int LIGHT_TUBE = 6;
const int LIGHT_DISK = 7;
const int LIGHT_RECTANGLE = 8;

struct Light {
    int kind;
    // Point and spot lights: the position.
    vec3 position;
    // Directional and spot lights: the direction in which the light travels, of any length but 0.
    vec3 direction;
    // The intensity in the three terms, linear RGB.
    vec3 ambient;
    vec3 diffuse;
    vec3 specular;
    // Point and spot lights: s_c, s_l and s_q of (96).
    vec3 attenuation;
    // Spot lights: L_exp of (98).
    float exponent;
#ifdef GLISTEN_CONES
    // Point and spot lights: the distance at which the inverse square law, instead of `attenuation`, ends; 0 for `attenuation`.
    float range;
    // Spot lights: 1 - cos of the cone's inner and outer angle, instead of `exponent`; an outer one of 0 for `exponent`.
    float inner;
    float outer;
#endif
#ifdef GLISTEN_AREAS
    // Tubes: from the middle to an end. Disks and rectangles: from the middle to the rim, and to that at right angles.
    vec3 x;
    vec3 y;
    // Spheres, tubes and disks.
    float radius;
#endif
};

struct Material {
    vec3 ambient;
    vec3 diffuse;
    vec3 specular;
    float shininess;
    // L_emi of (100).
    vec3 emission;
};

// The unit vector L from the shaded point P towards the light. It is zero if there is none: at a point light, for a
// directional light without a direction, for a hemisphere.
// bound: 2.4e-7 abs
vec3 lightVector(Light light, vec3 P)
{
    if (light.kind == LIGHT_HEMISPHERE)
        return vec3(0.0);
    return safeNormalize(light.kind == LIGHT_DIRECTIONAL ? -light.direction : safeLimit(light.position - P));
}

// The attenuation d (96) at the point P; 1 for directional lights.
// bound: 3e-7 rel
float lightAttenuation(Light light, vec3 P)
{
#ifdef GLISTEN_CONES
    if (light.kind != LIGHT_DIRECTIONAL && light.range > 0.0)
        return punctualFalloff(lightDistance(light.position, P), light.range);
#endif
    return light.kind == LIGHT_DIRECTIONAL ? 1.0 : attenuation(lightDistance(light.position, P), light.attenuation);
}

// The factor c_spot (98) of the beam for the unit vector L towards the light; 1 for lights other than spots.
// bound: 2.4e-7 abs
float lightBeam(Light light, vec3 L)
{
#ifdef GLISTEN_CONES
    if (light.kind == LIGHT_SPOT && light.outer > 0.0)
        return punctualCone(L, safeNormalize(light.direction), light.inner, light.outer);
#endif
    return light.kind == LIGHT_SPOT ? spotFactor(L, safeNormalize(light.direction), light.exponent) : 1.0;
}

// The light of a hemisphere, linear RGB.
//   light  the light    N  unit normal
// bound: 2.4e-7 rel
vec3 lightDome(Light light, vec3 N)
{
    return hemisphere(N, safeNormalize(light.direction), light.diffuse, light.ambient);
}

// One term of the sum in (101), for reflections by any model, linear RGB. A hemisphere's light is ambient light alone.
//   light  the light    Kamb  ambient reflectance, 0 to 1    P  shaded point    N  unit normal
//   L  unit vector towards the light: lightVector()    Idiff, Ispec  diffuse and specular reflection, >= 0
// bound: 1e-4 rel, L need not be that of the light, and then the exponent of the beam amplifies what rounds in its angle
vec3 lightTerm(Light light, vec3 Kamb, vec3 P, vec3 N, vec3 L, vec3 Idiff, vec3 Ispec)
{
    if (light.kind == LIGHT_HEMISPHERE)
        return ambient(Kamb, lightDome(light, N));
    vec3 Iamb = ambient(Kamb, light.ambient);
    return illumination(Iamb, Idiff, Ispec, lightAttenuation(light, P), lightBeam(light, L));
}

// One term of the sum in (101) with Lambert's diffuse and Blinn and Phong's specular reflection, linear RGB.
//   light, material  the light and the material    P  shaded point    N  unit normal    V  unit vector towards the eye
// bound: 2.4e-7 rel
vec3 lightTerm(Light light, Material material, vec3 P, vec3 N, vec3 V)
{
    vec3 L = lightVector(light, P);
    vec3 Idiff = lambert(N, L, material.diffuse, light.diffuse);
    vec3 Ispec = blinnPhong(N, L, V, material.shininess, material.specular, light.specular);
    return lightTerm(light, material.ambient, P, N, L, Idiff, Ispec);
}

#endif
