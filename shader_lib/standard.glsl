// name: standard
// kind: equation
// equation: (101): I_tot = K_amb * L_glob + L_emi + sum of c_spot (I_amb + d (I_diff + I_spec)) over the lights
// source: textbook, section 10.1.7; article, program `hemi_spec`
// stability: finite for every finite input
//
// The sum over a scene's lights (module `scene`) with any of the library's models, as the standard program computes
// it. With GLISTEN_SURFACE, textures change the material from point to point: standardSurface() is called first.
#ifndef GLISTEN_STANDARD
#define GLISTEN_STANDARD
#include "artistic.glsl"
#include "beckmann.glsl"
#include "burley.glsl"
#include "clearcoat.glsl"
#include "half_lambert.glsl"
#include "lambert.glsl"
#include "normalized.glsl"
#include "oren_nayar.glsl"
#include "phong.glsl"
#include "quartic.glsl"
#include "scene.glsl"
#include "schlick.glsl"
#include "sheen.glsl"
#include "specular_lut.glsl"
#include "threshold.glsl"
#include "toon.glsl"

// The ramp of soft toon shading: the dark side at s = 0, the lit side at 1.
uniform sampler2D ramp;
// The specular tables: cosine 0 at s = 0, 1 at 1.
uniform sampler2D highlight;

#ifdef GLISTEN_SURFACE
// Roughness and metal in green and blue, as parts of the material's; light that the surface sends out, a part of its emission;
// ambient light that reaches it, in red.
uniform sampler2D metallic_roughness;
uniform sampler2D emission_map;
uniform sampler2D occlusion_map;

// The material at the shaded point.
Material surface;
float surface_roughness;
float surface_occlusion;
#define STANDARD_MATERIAL surface
#define STANDARD_ROUGHNESS surface_roughness
#else
#define STANDARD_MATERIAL material
#define STANDARD_ROUGHNESS finish.roughness
#endif

// The light that reaches the eye, in two parts so that a decal can color one and not the other; linear RGB.
struct Reflection {
    // Ambient and diffuse.
    vec3 body;
    // Specular.
    vec3 gloss;
};

#ifdef GLISTEN_SURFACE
// The material at a point: the base color, the roughness and the rest of the uniforms, each times its texture.
//   st  texture coordinates    base  the texel of the base color, linear RGB
void standardSurface(vec2 st, vec3 base)
{
    vec4 rough = texture(metallic_roughness, st);
    surface = material;
    if (finish.metallic < 0.0) {
        surface.diffuse = material.diffuse * base;
        surface.ambient = material.ambient * base;
    } else {
        vec3 color = finish.base_color * base;
        float metallic = safeUnit(finish.metallic * rough.b);
        surface.diffuse = color * (1.0 - metallic);
        surface.ambient = surface.diffuse;
        surface.specular = mix(finish.dielectric, color, metallic);
    }
    surface.emission = material.emission * texture(emission_map, st).rgb;
    surface_roughness = safeUnit(finish.roughness * rough.g);
    surface_occlusion = safeUnit(1.0 + finish.occlusion_strength * (texture(occlusion_map, st).r - 1.0));
}
#endif

// The diffuse reflection of a light of intensity 1, per channel.
//   N  unit normal    L, V  unit vectors towards the light and the eye
vec3 standardDiffuse(vec3 N, vec3 L, vec3 V)
{
    switch (finish.diffuse_model) {
    case DIFFUSE_LAMBERT:
        return vec3(lambertFactor(N, L)) * STANDARD_MATERIAL.diffuse;
    case DIFFUSE_HALF_LAMBERT:
        return vec3(halfLambertFactor(N, L)) * STANDARD_MATERIAL.diffuse;
    case DIFFUSE_TOON_SOFT:
        return toonSoft(ramp, N, L) * STANDARD_MATERIAL.diffuse;
    case DIFFUSE_TOON_HARD:
        return toonHard(N, L, finish.threshold, vec3(1.0), finish.shade) * STANDARD_MATERIAL.diffuse;
    case DIFFUSE_OREN_NAYAR:
        return vec3(orenNayarFactor(N, L, V, STANDARD_ROUGHNESS)) * STANDARD_MATERIAL.diffuse;
    case DIFFUSE_EON:
        return eonFactor(N, L, V, STANDARD_MATERIAL.diffuse, STANDARD_ROUGHNESS);
    case DIFFUSE_BURLEY:
        return vec3(burleyFactor(N, L, V, STANDARD_ROUGHNESS)) * STANDARD_MATERIAL.diffuse;
    case DIFFUSE_WRAP:
        return vec3(wrapFactor(N, L, finish.threshold)) * STANDARD_MATERIAL.diffuse;
    case DIFFUSE_MINNAERT:
        return vec3(minnaertFactor(N, L, V, 1.0 + STANDARD_ROUGHNESS)) * STANDARD_MATERIAL.diffuse;
    }
    return vec3(0.0);
}

// Whether the specular model is one of microfacets, with a Fresnel term.
bool standardHasFresnel()
{
    return finish.specular_model == SPECULAR_GGX || finish.specular_model == SPECULAR_BECKMANN;
}

// The part of the light that microfacets mirror; 0 for other models, which mirror nothing away from the body. A reflectance
// below 0.02 is none at all, also at grazing angles.
//   L, V  unit vectors towards the light and the eye
vec3 standardFresnel(vec3 L, vec3 V)
{
    if (!standardHasFresnel())
        return vec3(0.0);
    vec3 F90 = vec3(safeUnit(50.0 * safeExtent(STANDARD_MATERIAL.specular)));
    return fresnelSchlick(dot(V, halfVector(L, V)), STANDARD_MATERIAL.specular, F90);
}

// The specular reflection of a light of intensity 1, per channel.
//   N  unit normal    L, V  unit vectors towards the light and the eye    fresnel  standardFresnel()
vec3 standardSpecular(vec3 N, vec3 L, vec3 V, vec3 fresnel)
{
    float alpha = STANDARD_ROUGHNESS * STANDARD_ROUGHNESS;
    switch (finish.specular_model) {
    case SPECULAR_PHONG:
        return vec3(phongFactor(N, L, V, STANDARD_MATERIAL.shininess)) * STANDARD_MATERIAL.specular;
    case SPECULAR_BLINN_PHONG:
        return vec3(blinnPhongFactor(N, L, V, STANDARD_MATERIAL.shininess)) * STANDARD_MATERIAL.specular;
    case SPECULAR_SCHLICK_PHONG:
        return vec3(schlickPhongFactor(N, L, V, STANDARD_MATERIAL.shininess)) * STANDARD_MATERIAL.specular;
    case SPECULAR_SCHLICK_BLINN:
        return vec3(schlickBlinnFactor(N, L, V, STANDARD_MATERIAL.shininess)) * STANDARD_MATERIAL.specular;
    case SPECULAR_THRESHOLD:
        return vec3(thresholdFactor(N, L, V, finish.threshold)) * STANDARD_MATERIAL.specular;
    case SPECULAR_QUARTIC:
        return vec3(quarticFactor(N, L, V)) * STANDARD_MATERIAL.specular;
    case SPECULAR_TABLE_HALF:
        return specularLutHalf(highlight, N, L, V) * STANDARD_MATERIAL.specular;
    case SPECULAR_TABLE_LIGHT:
        return specularLutLight(highlight, N, L) * STANDARD_MATERIAL.specular;
    case SPECULAR_GGX:
        return ggxFactor(N, L, V, alpha) * fresnel;
    case SPECULAR_BECKMANN:
        return beckmannFactor(N, L, V, alpha) * fresnel;
    case SPECULAR_SHEEN:
        return vec3(sheenFactor(N, L, V, alpha)) * STANDARD_MATERIAL.specular;
    case SPECULAR_NORMALIZED:
        return vec3(normalizedBlinnFactor(N, L, V, STANDARD_MATERIAL.shininess)) * STANDARD_MATERIAL.specular;
    }
    return vec3(0.0);
}

// The light of a hemisphere that a mirror of a roughness shows: its horizon is as wide as the roughness, and that of the whole half
// spheres for 1.
//   one  the light    R  unit vector, the eye's mirror direction    roughness  0 to 1
vec3 standardMirrored(Light one, vec3 R, float roughness)
{
    float t = clamp(dot(R, safeNormalize(one.direction)) / clamp(roughness, 1.0 / 64.0, 1.0), -1.0, 1.0);
    return safeLimit(mix(one.ambient, one.diffuse, 0.5 + 0.5 * t));
}

// The hemisphere's part of (101), and what microfacets and the coat mirror of it.
//   one  the light    N  unit normal    V  unit vector towards the eye
Reflection standardDome(Light one, vec3 N, vec3 V)
{
    Reflection sum = Reflection(ambient(STANDARD_MATERIAL.ambient, lightDome(one, N)), vec3(0.0));
    vec3 R = mirrorDirection(N, V);
    float NV = safeUnit(dot(N, V));
    if (standardHasFresnel()) {
        vec3 seen = STANDARD_MATERIAL.specular * 50.0;
        vec3 albedo = min(ggxAlbedo(NV, STANDARD_ROUGHNESS, STANDARD_MATERIAL.specular), seen);
        sum.body = sum.body * (1.0 - min(albedo, vec3(1.0)));
        sum.gloss = safeLimit(albedo * standardMirrored(one, R, STANDARD_ROUGHNESS));
    }
    if (finish.clearcoat > 0.0) {
        float w = clearcoatWeight(N, V, finish.clearcoat);
        sum.body = sum.body * (1.0 - w);
        sum.gloss = safeLimit((1.0 - w) * sum.gloss + w * standardMirrored(one, R, finish.clearcoat_roughness));
    }
    return sum;
}

// One light's part of (101).
//   one  the light    P  shaded point    N  unit normal    V  unit vector towards the eye
Reflection standardLight(Light one, vec3 P, vec3 N, vec3 V)
{
#ifdef GLISTEN_SURFACE
    if (one.kind == LIGHT_HEMISPHERE) {
        Reflection dome = standardDome(one, N, V);
        return Reflection(surface_occlusion * dome.body, surface_occlusion * dome.gloss);
    }
#else
    if (one.kind == LIGHT_HEMISPHERE)
        return standardDome(one, N, V);
#endif
    vec3 L = lightVector(one, P);
    float d = lightAttenuation(one, P);
    float cspot = lightBeam(one, L);
    vec3 fresnel = standardFresnel(L, V);
    vec3 Iamb = ambient(STANDARD_MATERIAL.ambient, one.ambient);
    vec3 Idiff = safeLimit(standardDiffuse(N, L, V) * one.diffuse * (1.0 - fresnel));
    vec3 Ispec = safeLimit(standardSpecular(N, L, V, fresnel) * one.specular);
    if (finish.clearcoat > 0.0) {
        float w = clearcoatWeight(N, V, finish.clearcoat);
        float alpha = finish.clearcoat_roughness * finish.clearcoat_roughness;
        Idiff = (1.0 - w) * Idiff;
        Ispec = clearcoat(Ispec, N, L, V, finish.clearcoat, alpha, one.specular);
    }
    vec3 none = vec3(0.0);
    return Reflection(illumination(Iamb, Idiff, none, d, cspot), illumination(none, none, Ispec, d, cspot));
}

// (101) without emission.
//   P, N, V  as above
Reflection standardReflection(vec3 P, vec3 N, vec3 V)
{
    Reflection sum = Reflection(ambient(STANDARD_MATERIAL.ambient, global_ambient), vec3(0.0));
#ifdef GLISTEN_SURFACE
    sum.body *= surface_occlusion;
#endif
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
    return safeLimit(safeLimit(reflection.body * decal) + safeLimit(reflection.gloss + STANDARD_MATERIAL.emission));
}

#endif
