// name: standard
// kind: equation
// equation: (101): I_tot = K_amb * L_glob + L_emi + sum of c_spot (I_amb + d (I_diff + I_spec)) over the lights
// source: textbook, section 10.1.7; article, program `hemi_spec`
// stability: finite for every finite input
//
// The sum over a scene's lights (module `scene`) with any of the library's models, as the standard program computes
// it.
#ifndef GLISTEN_STANDARD
#define GLISTEN_STANDARD
#include "half_lambert.glsl"
#include "lambert.glsl"
#include "phong.glsl"
#include "quartic.glsl"
#include "scene.glsl"
#include "schlick.glsl"
#include "specular_lut.glsl"
#include "threshold.glsl"
#include "toon.glsl"

// The ramp of soft toon shading: the dark side at s = 0, the lit side at 1.
uniform sampler2D ramp;
// The specular tables: cosine 0 at s = 0, 1 at 1.
uniform sampler2D highlight;

// The light that reaches the eye, in two parts so that a decal can color one and not the other; linear RGB.
struct Reflection {
    // Ambient and diffuse.
    vec3 body;
    // Specular.
    vec3 gloss;
};

// The factor of the diffuse model, per channel.
//   N  unit normal    L  unit vector towards the light
vec3 standardDiffuse(vec3 N, vec3 L)
{
    switch (finish.diffuse_model) {
    case DIFFUSE_LAMBERT:
        return vec3(lambertFactor(N, L));
    case DIFFUSE_HALF_LAMBERT:
        return vec3(halfLambertFactor(N, L));
    case DIFFUSE_TOON_SOFT:
        return toonSoft(ramp, N, L);
    case DIFFUSE_TOON_HARD:
        return toonHard(N, L, finish.threshold, vec3(1.0), finish.shade);
    }
    return vec3(0.0);
}

// The factor of the specular model, per channel.
//   N  unit normal    L, V  unit vectors towards the light and the eye
vec3 standardSpecular(vec3 N, vec3 L, vec3 V)
{
    switch (finish.specular_model) {
    case SPECULAR_PHONG:
        return vec3(phongFactor(N, L, V, material.shininess));
    case SPECULAR_BLINN_PHONG:
        return vec3(blinnPhongFactor(N, L, V, material.shininess));
    case SPECULAR_SCHLICK_PHONG:
        return vec3(schlickPhongFactor(N, L, V, material.shininess));
    case SPECULAR_SCHLICK_BLINN:
        return vec3(schlickBlinnFactor(N, L, V, material.shininess));
    case SPECULAR_THRESHOLD:
        return vec3(thresholdFactor(N, L, V, finish.threshold));
    case SPECULAR_QUARTIC:
        return vec3(quarticFactor(N, L, V));
    case SPECULAR_TABLE_HALF:
        return specularLutHalf(highlight, N, L, V);
    case SPECULAR_TABLE_LIGHT:
        return specularLutLight(highlight, N, L);
    }
    return vec3(0.0);
}

// One light's part of (101).
//   one  the light    P  shaded point    N  unit normal    V  unit vector towards the eye
Reflection standardLight(Light one, vec3 P, vec3 N, vec3 V)
{
    if (one.kind == LIGHT_HEMISPHERE)
        return Reflection(ambient(material.ambient, lightDome(one, N)), vec3(0.0));
    vec3 L = lightVector(one, P);
    float d = lightAttenuation(one, P);
    float cspot = lightBeam(one, L);
    vec3 Iamb = ambient(material.ambient, one.ambient);
    vec3 Idiff = safeLimit(standardDiffuse(N, L) * material.diffuse * one.diffuse);
    vec3 Ispec = safeLimit(standardSpecular(N, L, V) * material.specular * one.specular);
    vec3 none = vec3(0.0);
    return Reflection(illumination(Iamb, Idiff, none, d, cspot), illumination(none, none, Ispec, d, cspot));
}

// (101) without emission.
//   P, N, V  as above
Reflection standardReflection(vec3 P, vec3 N, vec3 V)
{
    Reflection sum = Reflection(ambient(material.ambient, global_ambient), vec3(0.0));
    int last = min(lights, GLISTEN_LIGHTS);
    for (int k = 0; k < last; ++k) {
        Reflection one = standardLight(light[k], P, N, V);
        sum.body = safeLimit(sum.body + one.body);
        sum.gloss = safeLimit(sum.gloss + one.gloss);
    }
    return sum;
}

// (101), linear RGB: a decal multiplies the color of the body.
//   reflection  of all lights    decal  white for none
vec3 standardColor(Reflection reflection, vec3 decal)
{
    return safeLimit(safeLimit(reflection.body * decal) + safeLimit(reflection.gloss + material.emission));
}

#endif
