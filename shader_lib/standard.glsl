// name: standard
// kind: equation
// equation: (101): I_tot = K_amb * L_glob + L_emi + sum of c_spot (I_amb + d (I_diff + I_spec)) over the lights
// source: textbook, section 10.1.7; article, program `hemi_spec`
// stability: finite for every finite input
//
// The sum over a scene's lights (module `scene`) with any of the library's models, as the standard program computes
// it. With GLISTEN_SURFACE, textures change the material from point to point: standardSurface() is called first. With
// GLISTEN_SURROUNDED, a map of `glisten lib prefilter` is one more light, from all around, or nine coefficients with
// GLISTEN_HARMONICS. With GLISTEN_AREAS, lights may have a shape. With GLISTEN_BALL, a picture of a lit ball is all of the light.
#ifndef GLISTEN_STANDARD
#define GLISTEN_STANDARD
#include "artistic.glsl"
#include "beckmann.glsl"
#include "burley.glsl"
#include "clearcoat.glsl"
#include "half_lambert.glsl"
#ifdef GLISTEN_FILM
#include "iridescence.glsl"
#endif
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
#ifdef GLISTEN_SURROUNDED
#include "environment.glsl"
#ifdef GLISTEN_HARMONICS
#include "irradiance.glsl"
#endif
#endif
#ifdef GLISTEN_AREAS
#include "ltc.glsl"
#endif
#ifdef GLISTEN_BALL
#include "matcap.glsl"
#endif
#ifdef GLISTEN_SUBSURFACE
#include "subsurface.glsl"
#endif
#if defined(GLISTEN_GLASS) || (defined(GLISTEN_LEAF) && defined(GLISTEN_AREAS))
#include "transmission.glsl"
#endif

// The ramp of soft toon shading: the dark side at s = 0, the lit side at 1.
uniform sampler2D ramp;
// The specular tables: cosine 0 at s = 0, 1 at 1.
uniform sampler2D highlight;
#ifdef GLISTEN_SURROUNDED
#ifdef GLISTEN_HARMONICS
// Light from all around, for irradiance().
uniform vec3 harmonics[9];
#else
// Light from all around, for environmentRadiance().
uniform sampler2D environment;
#endif
// Light.kind of that light, which is none of the scene's list.
const int LIGHT_ENVIRONMENT = 4;
#endif
#ifdef GLISTEN_AREAS
// `ltc_matrix`.
uniform sampler2D area_table;
#endif
#if defined(GLISTEN_SURROUNDED) || defined(GLISTEN_AREAS)
#define STANDARD_ALBEDO_TABLE
// `ltc_albedo`.
uniform sampler2D albedo_table;
#endif
#ifdef GLISTEN_BALL
// The picture of a lit ball, linear RGB.
uniform sampler2D matcap;
#endif

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
#ifdef GLISTEN_BRUSHED
#ifdef GLISTEN_BRUSHED_MAP
// The direction in which highlights are wide in red and green, from -1 to 1, and a part of the strength in blue.
uniform sampler2D anisotropy_map;
#endif
// The unit tangent in which highlights are wide, across the scratches, and the strength of the brush.
vec3 surface_brush;
float surface_anisotropy;
#endif
#ifdef GLISTEN_FIBERS
#ifdef GLISTEN_FIBERS_MAPS
// The color of fibers, linear RGB, and their roughness in alpha, as parts of the material's.
uniform sampler2D sheen_map;
uniform sampler2D sheen_roughness_map;
#endif
// `sheen_albedo`.
uniform sampler2D sheen_table;
// The fibers' color, their roughness, and what they return of light from everywhere.
vec3 surface_sheen;
float surface_sheen_roughness;
vec3 surface_fibers;
#endif
#ifdef GLISTEN_FILM
#ifdef GLISTEN_FILM_MAPS
// How strong a film is, in red, and how thick, in green.
uniform sampler2D iridescence_map;
uniform sampler2D iridescence_thickness_map;
#endif
// The film's strength and thickness.
float surface_film;
float surface_film_thickness;
#endif
#ifdef GLISTEN_SUBSURFACE
// subsurfaceBands() of the material.
mat2x3 surface_bands;
#endif
#ifdef GLISTEN_DIELECTRIC_MAPS
// What a part that is no metal mirrors, as parts of the material's: the color, linear RGB, and the strength in alpha.
uniform sampler2D dielectric_map;
uniform sampler2D dielectric_strength_map;
#endif
#ifdef GLISTEN_DIELECTRIC_STRENGTH
// The part of all that microfacets mirror, also at grazing angles.
float surface_mirror;
#define STANDARD_MIRROR surface_mirror
#else
#define STANDARD_MIRROR 1.0
#endif
#ifdef GLISTEN_LEAF
#ifdef GLISTEN_LEAF_MAPS
// The part of the light that is scattered through the surface, in alpha, and its color, linear RGB, as parts of the material's.
uniform sampler2D diffuse_transmission_map;
uniform sampler2D diffuse_transmission_color_map;
#endif
// The color of light that is scattered through the surface, linear RGB.
vec3 surface_leaf;
#endif
#ifdef GLISTEN_COAT_MAPS
// The strength of the coat in red, and its roughness in green, as parts of the material's.
uniform sampler2D clearcoat_map;
uniform sampler2D clearcoat_roughness_map;
float surface_coat;
float surface_coat_roughness;
#define STANDARD_COAT surface_coat
#define STANDARD_COAT_ROUGHNESS surface_coat_roughness
#else
#define STANDARD_COAT finish.clearcoat
#define STANDARD_COAT_ROUGHNESS finish.clearcoat_roughness
#endif
#if defined(GLISTEN_NORMALS) || defined(GLISTEN_COAT_NORMALS)
// The coat's normal, which is not that of the layers below.
vec3 surface_coat_normal;
#define STANDARD_COAT_NORMAL surface_coat_normal
#else
#define STANDARD_COAT_NORMAL N
#endif
#ifdef GLISTEN_GLASS
#ifdef GLISTEN_GLASS_MAPS
// The part of the light that passes in red, and the way through the volume in green, as parts of the material's.
uniform sampler2D transmission_map;
uniform sampler2D thickness_map;
#endif
// The color of light that passes, linear RGB.
vec3 surface_through;
#ifdef GLISTEN_REFRACTION
// How much of it a way as long as the body is thick takes.
vec3 surface_absorbed;
#endif
#endif
#define STANDARD_MATERIAL surface
#define STANDARD_ROUGHNESS surface_roughness
#else
#define STANDARD_MATERIAL material
#define STANDARD_MIRROR 1.0
#define STANDARD_ROUGHNESS finish.roughness
#define STANDARD_COAT finish.clearcoat
#define STANDARD_COAT_ROUGHNESS finish.clearcoat_roughness
#define STANDARD_COAT_NORMAL N
#endif

// The light that reaches the eye, in two parts so that a decal can color one and not the other; linear RGB.
struct Reflection {
    // Ambient and diffuse.
    vec3 body;
    // Specular.
    vec3 gloss;
};

#ifdef GLISTEN_PLACES
#ifdef GLISTEN_TWO_SETS
// The second set of texture coordinates.
vec2 surface_second;
#endif

// The texture coordinates of a texture.
//   place  where it is    st  those of the surface
vec2 standardPlace(Place place, vec2 st)
{
#ifdef GLISTEN_TWO_SETS
    if (place.second > 0.0)
        st = surface_second;
#endif
    return vec2(dot(place.s, vec3(st, 1.0)), dot(place.t, vec3(st, 1.0)));
}
#define STANDARD_PLACE(map) standardPlace(places.map, st)
#else
#define STANDARD_PLACE(map) st
#endif

#ifdef GLISTEN_SURFACE
// The material at a point: the base color, the roughness and the rest of the uniforms, each times its texture.
//   st  texture coordinates    base  the texel of the base color, linear RGB
void standardSurface(vec2 st, vec3 base)
{
    vec4 rough = texture(metallic_roughness, STANDARD_PLACE(metallic_roughness));
    surface = material;
#ifdef GLISTEN_DIELECTRIC_STRENGTH
    surface_mirror = 1.0;
#endif
    if (finish.metallic < 0.0) {
        surface.diffuse = material.diffuse * base;
        surface.ambient = material.ambient * base;
    } else {
        vec3 color = finish.base_color * base;
        float metallic = safeUnit(finish.metallic * rough.b);
        surface.diffuse = color * (1.0 - metallic);
        surface.ambient = finish.own_ambient > 0.0 ? material.ambient * base : surface.diffuse;
        vec3 dielectric = finish.dielectric;
#ifdef GLISTEN_DIELECTRIC_MAPS
        dielectric *= texture(dielectric_map, STANDARD_PLACE(dielectric_map)).rgb;
#endif
#ifdef GLISTEN_DIELECTRIC_STRENGTH
        float strength = finish.dielectric_strength;
#ifdef GLISTEN_DIELECTRIC_MAPS
        strength *= texture(dielectric_strength_map, STANDARD_PLACE(dielectric_strength_map)).a;
#endif
        // The strength is that of what is no metal; the color of both is that of their sum.
        surface_mirror = mix(safeUnit(strength), 1.0, metallic);
        metallic = surface_mirror > 0.0 ? min(metallic / surface_mirror, 1.0) : 0.0;
#endif
        surface.specular = mix(dielectric, color, metallic);
    }
#ifdef GLISTEN_SUBSURFACE
    surface_bands = subsurfaceBands(finish.subsurface_radius, surface.diffuse);
#endif
#ifdef GLISTEN_GLASS
    float passing = finish.transmission;
    vec3 absorbed = finish.absorption;
#ifdef GLISTEN_GLASS_MAPS
    passing *= texture(transmission_map, STANDARD_PLACE(transmission_map)).r;
    absorbed *= texture(thickness_map, STANDARD_PLACE(thickness_map)).g;
#endif
    passing = safeUnit(passing);
    surface_through = passing * surface.diffuse;
#ifdef GLISTEN_REFRACTION
    surface_absorbed = absorbed;
#else
    surface_through *= transmissionLeft(absorbed);
#endif
    surface.diffuse *= 1.0 - passing;
    surface.ambient *= 1.0 - passing;
#endif
#ifdef GLISTEN_LEAF
    float scattered = finish.leaf;
    surface_leaf = finish.leaf_color;
#ifdef GLISTEN_LEAF_MAPS
    scattered *= texture(diffuse_transmission_map, STANDARD_PLACE(diffuse_transmission_map)).a;
    surface_leaf *= texture(diffuse_transmission_color_map, STANDARD_PLACE(diffuse_transmission_color_map)).rgb;
#endif
    scattered = safeUnit(scattered);
    surface_leaf *= scattered;
    if (finish.metallic >= 0.0)
        surface_leaf *= 1.0 - safeUnit(finish.metallic * rough.b);
#ifdef GLISTEN_GLASS
    surface_leaf *= 1.0 - passing;
#endif
    surface.diffuse *= 1.0 - scattered;
    surface.ambient *= 1.0 - scattered;
#endif
#ifdef GLISTEN_COAT_MAPS
    surface_coat = finish.clearcoat * texture(clearcoat_map, STANDARD_PLACE(clearcoat_map)).r;
    surface_coat_roughness = finish.clearcoat_roughness * texture(clearcoat_roughness_map, STANDARD_PLACE(clearcoat_roughness_map)).g;
#endif
#ifdef GLISTEN_FILM
    surface_film = finish.film;
    surface_film_thickness = finish.film_thickness;
#ifdef GLISTEN_FILM_MAPS
    surface_film *= texture(iridescence_map, STANDARD_PLACE(iridescence_map)).r;
    float thick = texture(iridescence_thickness_map, STANDARD_PLACE(iridescence_thickness_map)).g;
    surface_film_thickness = mix(finish.film_thinnest, finish.film_thickness, thick);
#endif
    surface_film = safeUnit(surface_film);
#endif
    surface.emission = material.emission * texture(emission_map, STANDARD_PLACE(emission_map)).rgb;
    surface_roughness = safeUnit(finish.roughness * rough.g);
    surface_occlusion = safeUnit(1.0 + finish.occlusion_strength * (texture(occlusion_map, STANDARD_PLACE(occlusion_map)).r - 1.0));
}

#ifdef GLISTEN_BRUSHED
// The brush at a point.
//   st  texture coordinates    N  unit normal    T  unit tangent    handedness  1, or -1 where the texture is mirrored
void standardBrush(vec2 st, vec3 N, vec3 T, float handedness)
{
    vec2 turn = finish.anisotropy_turn;
    surface_anisotropy = finish.anisotropy;
#ifdef GLISTEN_BRUSHED_MAP
    vec3 texel = texture(anisotropy_map, STANDARD_PLACE(anisotropy_map)).rgb;
    vec2 d = safeNormalize(vec3(2.0 * texel.rg - 1.0, 0.0)).xy;
    turn = vec2(turn.x * d.x - turn.y * d.y, turn.y * d.x + turn.x * d.y);
    surface_anisotropy *= texel.b;
#endif
    vec3 B = handedness < 0.0 ? -cross(N, T) : cross(N, T);
    surface_brush = turn.x * T + turn.y * B;
#ifdef GLISTEN_NORMALS
    // The normal is no longer the one at right angles to the tangent.
    surface_brush = safeNormalize(surface_brush - dot(surface_brush, N) * N);
#endif
}
#endif

#ifdef GLISTEN_FIBERS
// The fibers at a point.
//   st  texture coordinates    N  unit normal    V  unit vector towards the eye
void standardFibers(vec2 st, vec3 N, vec3 V)
{
    surface_sheen = finish.sheen;
    surface_sheen_roughness = finish.sheen_roughness;
#ifdef GLISTEN_FIBERS_MAPS
    surface_sheen *= texture(sheen_map, STANDARD_PLACE(sheen_map)).rgb;
    surface_sheen_roughness *= texture(sheen_roughness_map, STANDARD_PLACE(sheen_roughness_map)).a;
#endif
    surface_sheen = clamp(surface_sheen, vec3(0.0), vec3(1.0));
    surface_sheen_roughness = safeUnit(surface_sheen_roughness);
    surface_fibers = surface_sheen * sheenAlbedo(sheen_table, N, V, surface_sheen_roughness);
}
#endif
#endif

// A reflection under the fibers of a material, if it has any: it loses what they return.
//   base  the reflection without them
Reflection standardUnderFibers(Reflection base)
{
#ifdef GLISTEN_FIBERS
    float left = 1.0 - safeExtent(surface_fibers);
    return Reflection(left * base.body, left * base.gloss);
#else
    return base;
#endif
}

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

// The same for a body in which a part of the light travels.
//   N, L, V  as above
vec3 standardBody(vec3 N, vec3 L, vec3 V)
{
#ifdef GLISTEN_SUBSURFACE
    vec3 traveled = subsurfaceFactor(N, L, surface_bands) * STANDARD_MATERIAL.diffuse;
    return mix(standardDiffuse(N, L, V), traveled, safeUnit(finish.subsurface));
#else
    return standardDiffuse(N, L, V);
#endif
}

// Whether the specular model is one of microfacets, with a Fresnel term.
bool standardHasFresnel()
{
    return finish.specular_model == SPECULAR_GGX || finish.specular_model == SPECULAR_BECKMANN;
}

// What microfacets mirror at grazing angles: all, as glTF 2.0 has it (appendix B.3.4), for a material by `metallic`. One that states its
// specular color mirrors nothing there either if it is black; a reflectance below 0.02 is less than any body has.
float standardGrazing()
{
    if (finish.metallic >= 0.0)
        return 1.0;
    return safeUnit(50.0 * safeExtent(STANDARD_MATERIAL.specular));
}

// The part of the light that microfacets mirror; 0 for other models, which mirror nothing away from the body.
//   L, V  unit vectors towards the light and the eye
vec3 standardFresnel(vec3 L, vec3 V)
{
    if (!standardHasFresnel())
        return vec3(0.0);
    float c = dot(V, halfVector(L, V));
    vec3 F = fresnelSchlick(c, STANDARD_MATERIAL.specular, vec3(standardGrazing()));
#ifdef GLISTEN_FILM
    vec3 film = iridescenceFresnel(c, 1.0, finish.film_index, surface_film_thickness, STANDARD_MATERIAL.specular);
    F = mix(F, film, surface_film);
#endif
    return STANDARD_MIRROR * F;
}

// The light that what is mirrored leaves for the body. Under a film it has no color of its own, and the body none of its complement.
//   mirrored  a part of the light, per channel
vec3 standardLeft(vec3 mirrored)
{
#ifdef GLISTEN_FILM
    return mix(1.0 - mirrored, vec3(1.0 - safeUnit(safeExtent(mirrored))), surface_film);
#else
    return 1.0 - mirrored;
#endif
}

#ifdef GLISTEN_GLASS
// The part of the light behind a surface that passes, but for what is mirrored.
//   N  unit normal    V  unit vector towards the eye
vec3 standardPassing(vec3 N, vec3 V)
{
#ifdef GLISTEN_REFRACTION
    return surface_through * transmissionLeft(transmissionPath(N, V, finish.refraction) * surface_absorbed);
#else
    return surface_through;
#endif
}

// The roughness with which light passes.
float standardBlur()
{
#ifdef GLISTEN_REFRACTION
    return transmissionRoughness(STANDARD_ROUGHNESS, finish.refraction);
#else
    return STANDARD_ROUGHNESS;
#endif
}

// Light that comes through the surface from behind it, without pi.
//   N  unit normal    L, V  unit vectors towards the light and the eye
vec3 standardThrough(vec3 N, vec3 L, vec3 V)
{
    vec3 across = transmissionMirrored(N, L);
    float alpha = standardBlur() * standardBlur();
    return transmissionFactor(N, L, V, alpha) * standardPassing(N, V) * standardLeft(standardFresnel(across, V));
}
#endif

#ifdef GLISTEN_LEAF
// Light that is scattered through the surface from behind it, without pi.
//   N  unit normal    L, V  unit vectors towards the light and the eye
vec3 standardScattered(vec3 N, vec3 L, vec3 V)
{
    vec3 across = safeFinite(L - 2.0 * dot(N, L) * N);
    return lambertFactor(-N, L) * surface_leaf * standardLeft(standardFresnel(across, V));
}
#endif

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
#ifdef GLISTEN_BRUSHED
        return ggxFactor(N, surface_brush, L, V, ggxBrushed(STANDARD_ROUGHNESS, surface_anisotropy)) * fresnel;
#else
        return ggxFactor(N, L, V, alpha) * fresnel;
#endif
    case SPECULAR_BECKMANN:
        return beckmannFactor(N, L, V, alpha) * fresnel;
    case SPECULAR_SHEEN:
        return vec3(sheenFactor(N, L, V, alpha)) * STANDARD_MATERIAL.specular;
    case SPECULAR_NORMALIZED:
        return vec3(normalizedBlinnFactor(N, L, V, STANDARD_MATERIAL.shininess)) * STANDARD_MATERIAL.specular;
    }
    return vec3(0.0);
}

// Light from all around as a mirror of a roughness shows it. The horizon of a hemisphere is as wide as the roughness, and that of the
// whole half spheres for 1.
//   one  the light    R  unit vector, the eye's mirror direction    roughness  0 to 1
vec3 standardMirrored(Light one, vec3 R, float roughness)
{
#ifdef GLISTEN_SURROUNDED
    if (one.kind == LIGHT_ENVIRONMENT)
#ifdef GLISTEN_HARMONICS
        return max(irradianceMirrored(safeNormalize(R), harmonics, roughness), vec3(0.0));
#else
        return safeLimit(environmentRadiance(environment, R, roughness));
#endif
#endif
    float t = clamp(dot(R, safeNormalize(one.direction)) / clamp(roughness, 1.0 / 64.0, 1.0), -1.0, 1.0);
    return safeLimit(mix(one.ambient, one.diffuse, 0.5 + 0.5 * t));
}

// The light from all around that arrives at a matte surface, without pi. Of an environment, it is what the roughest mirror shows.
//   one  the light    N  unit normal
vec3 standardArriving(Light one, vec3 N)
{
#ifdef GLISTEN_SURROUNDED
    if (one.kind == LIGHT_ENVIRONMENT)
#ifdef GLISTEN_HARMONICS
        return max(irradiance(N, harmonics), vec3(0.0));
#else
        return safeLimit(environmentRadiance(environment, N, 1.0));
#endif
#endif
    return lightDome(one, N);
}

// The direction from which a surface mirrors light from all around.
//   one  the light    N  unit normal    V  unit vector towards the eye    roughness  0 to 1
vec3 standardTowards(Light one, vec3 N, vec3 V, float roughness)
{
#ifdef GLISTEN_SURROUNDED
    if (one.kind == LIGHT_ENVIRONMENT)
        return environmentDominant(N, V, roughness);
#endif
    return mirrorDirection(N, V);
}

// The part of light from everywhere that microfacets mirror.
//   N  unit normal    V  unit vector towards the eye    Kspec  reflectance at normal incidence
vec3 standardAlbedo(vec3 N, vec3 V, vec3 Kspec)
{
#ifdef STANDARD_ALBEDO_TABLE
    return ltcAlbedo(albedo_table, N, V, STANDARD_ROUGHNESS, Kspec);
#else
    return ggxAlbedo(safeUnit(dot(N, V)), STANDARD_ROUGHNESS, Kspec);
#endif
}

// What the microfacets of the material mirror of light from everywhere.
//   N  unit normal    V  unit vector towards the eye
vec3 standardMirrors(vec3 N, vec3 V)
{
    vec3 albedo = standardAlbedo(N, V, STANDARD_MATERIAL.specular);
    if (finish.metallic < 0.0)
        albedo = min(albedo, STANDARD_MATERIAL.specular * 50.0);
#ifdef GLISTEN_FILM
    float NV = safeUnit(dot(N, V));
    vec3 film = iridescenceFresnel(NV, 1.0, finish.film_index, surface_film_thickness, STANDARD_MATERIAL.specular);
    albedo = mix(albedo, standardAlbedo(N, V, iridescenceNormal(film, NV)), surface_film);
#endif
    return STANDARD_MIRROR * albedo;
}

#ifdef GLISTEN_GLASS
// Light from all around that is behind a surface: beyond a thin wall, or a ball that bends it.
//   one  the light    N  unit normal    V  unit vector towards the eye
vec3 standardBehind(Light one, vec3 N, vec3 V)
{
#ifdef GLISTEN_REFRACTION
    vec3 n = transmissionIndices(finish.refraction, finish.dispersion);
    vec3 seen = standardMirrored(one, transmissionSphere(N, V, n.y), standardBlur());
    if (finish.dispersion > 0.0) {
        seen.x = standardMirrored(one, transmissionSphere(N, V, n.x), standardBlur()).x;
        seen.z = standardMirrored(one, transmissionSphere(N, V, n.z), standardBlur()).z;
    }
    return seen;
#else
    return standardMirrored(one, -V, STANDARD_ROUGHNESS);
#endif
}
#endif

// The part of (101) that light from all around has, and what microfacets and the coat mirror of it.
//   one  a hemisphere, or the environment    N  unit normal    V  unit vector towards the eye
Reflection standardDome(Light one, vec3 N, vec3 V)
{
    Reflection sum = Reflection(ambient(STANDARD_MATERIAL.ambient, standardArriving(one, N)), vec3(0.0));
#ifdef GLISTEN_LEAF
    sum.body = safeLimit(sum.body + surface_leaf * standardArriving(one, -N));
#endif
    if (standardHasFresnel()) {
#ifdef GLISTEN_BRUSHED
        vec3 bent = ggxBent(N, surface_brush, V, STANDARD_ROUGHNESS, surface_anisotropy);
        vec3 R = standardTowards(one, bent, V, STANDARD_ROUGHNESS);
#else
        vec3 R = standardTowards(one, N, V, STANDARD_ROUGHNESS);
#endif
        vec3 albedo = standardMirrors(N, V);
        vec3 left = standardLeft(min(albedo, vec3(1.0)));
        sum.body = sum.body * left;
        sum.gloss = safeLimit(albedo * standardMirrored(one, R, STANDARD_ROUGHNESS));
#ifdef GLISTEN_GLASS
        if (finish.transmission_pass == GLASS_ALL)
            sum.body += left * standardPassing(N, V) * standardBehind(one, N, V);
#endif
    }
#ifdef GLISTEN_FIBERS
    sum = standardUnderFibers(sum);
    sum.gloss = safeLimit(sum.gloss + surface_fibers * standardArriving(one, N));
#endif
    if (finish.clearcoat > 0.0) {
        vec3 smooth_normal = STANDARD_COAT_NORMAL;
        float w = clearcoatWeight(smooth_normal, V, STANDARD_COAT);
        sum.body = sum.body * (1.0 - w);
        vec3 R = standardTowards(one, smooth_normal, V, STANDARD_COAT_ROUGHNESS);
        vec3 seen = standardMirrored(one, R, STANDARD_COAT_ROUGHNESS);
        sum.gloss = safeLimit((1.0 - w) * sum.gloss + w * seen);
    }
    return sum;
}

// The same, as far as it reaches the surface.
//   one, N, V  as above
Reflection standardAround(Light one, vec3 N, vec3 V)
{
    Reflection dome = standardDome(one, N, V);
#ifdef GLISTEN_SURFACE
    return Reflection(surface_occlusion * dome.body, surface_occlusion * dome.gloss);
#else
    return dome;
#endif
}

#ifdef GLISTEN_AREAS
// How much of a light with a shape arrives, 0 to 1: 1 for a light all over the sky.
//   one  the light    to  ltcFrame(), or ltcMatrix()    center, x, y  of the light, from the shaded point
float standardShape(Light one, mat3 to, vec3 center, vec3 x, vec3 y)
{
    switch (one.kind) {
    case LIGHT_SPHERE:
        return ltcSphere(to, center, one.radius);
    case LIGHT_TUBE:
        return ltcTube(to, safeLimit(center - x), safeLimit(center + x), one.radius);
    case LIGHT_DISK:
        return ltcDisk(to, center, x, y);
    }
    return ltcRectangle(to, center, x, y);
}

// Whether the diffuse model is N.L times a function that is not steep.
bool standardFollowsCosine()
{
    switch (finish.diffuse_model) {
    case DIFFUSE_OREN_NAYAR:
    case DIFFUSE_EON:
    case DIFFUSE_BURLEY:
    case DIFFUSE_MINNAERT:
        return true;
    }
    return false;
}

// Whether a model takes a light with a shape for a point.
bool standardTakesPoint()
{
#if defined(GLISTEN_FIBERS) || defined(GLISTEN_SUBSURFACE)
    return true;
#else
    bool sums = finish.diffuse_model <= DIFFUSE_LAMBERT || standardFollowsCosine();
    return !sums || (finish.specular_model != SPECULAR_NONE && finish.specular_model != SPECULAR_GGX);
#endif
}

// Whether anything but a highlight needs all of the light that arrives.
bool standardScatters()
{
#if defined(GLISTEN_FIBERS) || defined(GLISTEN_GLASS) || defined(GLISTEN_LEAF) || defined(GLISTEN_SUBSURFACE)
    return true;
#else
    return finish.diffuse_model != DIFFUSE_NONE;
#endif
}

// The sums over a light with a shape: of what one gets that faces the light, of what arrives at the surface, of the highlight, of light that
// passes, of light that is scattered through the surface, and of the coat's highlight. Those that a material needs follow each other,
// and one loop has all of them, so that a program has one copy.
const int AREA_FACING = 0;
const int AREA_ARRIVING = 1;
const int AREA_GLOSS = 2;
#ifdef GLISTEN_GLASS
const int AREA_THROUGH = AREA_GLOSS + 1;
#else
const int AREA_THROUGH = AREA_GLOSS;
#endif
#ifdef GLISTEN_LEAF
const int AREA_LEAF = AREA_THROUGH + 1;
#else
const int AREA_LEAF = AREA_THROUGH;
#endif
const int AREA_COAT = AREA_LEAF + 1;

// The first sum that the material needs.
int standardFirst()
{
    if (standardTakesPoint())
        return AREA_FACING;
    return standardScatters() ? AREA_ARRIVING : AREA_GLOSS;
}

// The last sum that the material needs.
int standardLast()
{
    if (finish.clearcoat > 0.0)
        return AREA_COAT;
    if (AREA_LEAF > AREA_GLOSS || finish.specular_model == SPECULAR_GGX)
        return AREA_LEAF;
    return AREA_ARRIVING;
}

// The part of (101) that a light with a shape has. Lambert's reflection and that of `ggx` are sums over the light. Other models of the
// form N.L f have Lambert's sum times f towards the middle of the light; the rest are those of a point there that is as bright.
//   one  the light    P  shaded point    N  unit normal    V  unit vector towards the eye
Reflection standardArea(Light one, vec3 P, vec3 N, vec3 V)
{
    vec3 center = safeLimit(one.position - P);
    // Behind a flat light.
    if (dot(safeNormalize(one.direction), safeNormalize(center)) > 0.0)
        return Reflection(vec3(0.0), vec3(0.0));
    vec3 L = safeNormalize(center);
    float got[6] = float[6](0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
    int last = standardLast();
    for (int k = standardFirst(); k <= last; ++k) {
        vec3 normal = N;
        float roughness = STANDARD_ROUGHNESS;
        vec3 middle = center;
        vec3 x = one.x;
        vec3 y = one.y;
        bool is_matte = k <= AREA_ARRIVING;
        if (k == AREA_FACING) {
            normal = L;
        } else if (k == AREA_COAT) {
            normal = STANDARD_COAT_NORMAL;
            roughness = STANDARD_COAT_ROUGHNESS;
        }
#ifdef GLISTEN_BRUSHED
        if (k == AREA_GLOSS)
            normal = safeNormalize(ggxBent(N, surface_brush, V, STANDARD_ROUGHNESS, surface_anisotropy));
#endif
#ifdef GLISTEN_GLASS
        if (k == AREA_THROUGH)
            roughness = standardBlur();
#endif
#ifdef GLISTEN_LEAF
        if (k == AREA_LEAF)
            is_matte = true;
#endif
#if defined(GLISTEN_GLASS) || defined(GLISTEN_LEAF)
        if (k > AREA_GLOSS && k < AREA_COAT) {
            // The light mirrored at the surface, for one behind it.
            middle = transmissionMirrored(N, center);
            x = transmissionMirrored(N, x);
            y = transmissionMirrored(N, y);
        }
#endif
        mat3 to = is_matte ? ltcFrame(normal, V) : ltcMatrix(area_table, normal, V, roughness);
        got[k] = standardShape(one, to, middle, x, y);
    }
    float arriving = got[AREA_ARRIVING];
    float facing = got[AREA_FACING];
    vec3 albedo = vec3(0.0);
    if (standardHasFresnel())
        albedo = standardMirrors(N, V);
    vec3 body = vec3(0.0);
    vec3 left = vec3(1.0);
    if (standardScatters()) {
        // The same above the horizon.
        vec3 above = safeNormalize(L + max(0.125 - dot(N, L), 0.0) * N);
        if (finish.diffuse_model == DIFFUSE_LAMBERT)
            body = arriving * STANDARD_MATERIAL.diffuse;
        else if (standardFollowsCosine())
            body = safeFinite(arriving / dot(N, above) * standardDiffuse(N, above, V));
        else
            body = facing * standardDiffuse(N, L, V);
#ifdef GLISTEN_SUBSURFACE
        vec3 traveled = subsurfaceFactor(N, L, surface_bands) * STANDARD_MATERIAL.diffuse;
        body = mix(body, facing * traveled, safeUnit(finish.subsurface));
#endif
        // A small light leaves what one direction does, and one all over the sky what all do.
        if (standardHasFresnel())
            left = mix(standardLeft(standardFresnel(above, V)), standardLeft(min(albedo, vec3(1.0))), arriving);
        body *= left;
    }
    vec3 gloss = vec3(0.0);
    if (finish.specular_model == SPECULAR_GGX)
        gloss = albedo * got[AREA_GLOSS];
    else
        gloss = safeLimit(facing * standardSpecular(N, L, V, standardFresnel(L, V)));
#ifdef GLISTEN_GLASS
    vec3 passed = got[AREA_THROUGH] * ltcAlbedo(albedo_table, N, V, standardBlur(), vec3(1.0));
    body += passed * standardPassing(N, V) * left;
#endif
#ifdef GLISTEN_LEAF
    body += got[AREA_LEAF] * surface_leaf * left;
#endif
    Reflection sum = Reflection(safeLimit(body * one.diffuse), safeLimit(gloss * one.specular));
#ifdef GLISTEN_FIBERS
    sum = standardUnderFibers(sum);
    float width = surface_sheen_roughness * surface_sheen_roughness;
    vec3 fibers = mix(facing * sheenFactor(N, L, V, width) * surface_sheen, arriving * surface_fibers, arriving);
    sum.gloss = safeLimit(sum.gloss + safeLimit(fibers * one.specular));
#endif
    if (finish.clearcoat > 0.0) {
        vec3 smooth_normal = STANDARD_COAT_NORMAL;
        float w = clearcoatWeight(smooth_normal, V, STANDARD_COAT);
        vec3 coat = ltcAlbedo(albedo_table, smooth_normal, V, STANDARD_COAT_ROUGHNESS, vec3(1.0)) * got[AREA_COAT];
        sum.body = (1.0 - w) * sum.body;
        sum.gloss = safeLimit((1.0 - w) * sum.gloss + safeLimit(w * coat * one.specular));
    }
    return sum;
}
#endif

// One light's part of (101).
//   one  the light    P  shaded point    N  unit normal    V  unit vector towards the eye
Reflection standardLight(Light one, vec3 P, vec3 N, vec3 V)
{
    if (one.kind == LIGHT_HEMISPHERE)
        return standardAround(one, N, V);
#ifdef GLISTEN_AREAS
    if (one.kind >= LIGHT_SPHERE)
        return standardArea(one, P, N, V);
#endif
    vec3 L = lightVector(one, P);
    float d = lightAttenuation(one, P);
    float cspot = lightBeam(one, L);
    vec3 fresnel = standardFresnel(L, V);
    vec3 Iamb = ambient(STANDARD_MATERIAL.ambient, one.ambient);
#ifdef GLISTEN_SURFACE
    Iamb *= surface_occlusion;
#endif
    vec3 Idiff = safeLimit(standardBody(N, L, V) * one.diffuse * standardLeft(fresnel));
#ifdef GLISTEN_GLASS
    Idiff = safeLimit(Idiff + safeLimit(standardThrough(N, L, V) * one.diffuse));
#endif
#ifdef GLISTEN_LEAF
    Idiff = safeLimit(Idiff + safeLimit(standardScattered(N, L, V) * one.diffuse));
#endif
    vec3 Ispec = safeLimit(standardSpecular(N, L, V, fresnel) * one.specular);
#ifdef GLISTEN_FIBERS
    Reflection base = standardUnderFibers(Reflection(Idiff, Ispec));
    float width = surface_sheen_roughness * surface_sheen_roughness;
    Idiff = base.body;
    Ispec = safeLimit(base.gloss + safeLimit(sheenFactor(N, L, V, width) * safeLimit(surface_sheen * one.specular)));
#endif
    if (finish.clearcoat > 0.0) {
        vec3 smooth_normal = STANDARD_COAT_NORMAL;
        float w = clearcoatWeight(smooth_normal, V, STANDARD_COAT);
        float alpha = STANDARD_COAT_ROUGHNESS * STANDARD_COAT_ROUGHNESS;
        Idiff = (1.0 - w) * Idiff;
        Ispec = clearcoat(Ispec, smooth_normal, L, V, STANDARD_COAT, alpha, one.specular);
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
#ifdef GLISTEN_SURROUNDED
    Light environs = light[0];
    environs.kind = LIGHT_ENVIRONMENT;
    Reflection around = standardAround(environs, N, V);
    sum.body = safeLimit(sum.body + around.body);
    sum.gloss = safeLimit(sum.gloss + around.gloss);
#endif
    return sum;
}

#ifdef GLISTEN_BALL
// The light of a picture of a lit ball, which is that of all lights.
//   N, V  unit normal and unit vector towards the eye, in eye space
Reflection standardBall(vec3 N, vec3 V)
{
    vec3 lit = texture(matcap, matcapCoordinate(N, V)).rgb;
    return Reflection(safeLimit(STANDARD_MATERIAL.diffuse * lit), vec3(0.0));
}
#endif

#ifdef GLISTEN_GLASS
// The part of what is behind a surface that comes through it, per channel, linear RGB.
//   N  unit normal    V  unit vector towards the eye
vec3 standardGlass(vec3 N, vec3 V)
{
    vec3 mirrored = STANDARD_MIRROR * standardAlbedo(N, V, STANDARD_MATERIAL.specular);
    vec3 through = standardPassing(N, V) * standardLeft(min(mirrored, vec3(1.0)));
#ifdef GLISTEN_FIBERS
    through *= 1.0 - safeExtent(surface_fibers);
#endif
    if (finish.clearcoat > 0.0)
        through *= 1.0 - clearcoatWeight(STANDARD_COAT_NORMAL, V, STANDARD_COAT);
    return through;
}
#endif

// The light that the surface sends out, linear RGB: under a coat, without what the coat throws back.
//   N  unit normal    V  unit vector towards the eye
vec3 standardEmission(vec3 N, vec3 V)
{
    if (finish.clearcoat > 0.0)
        return (1.0 - clearcoatWeight(STANDARD_COAT_NORMAL, V, STANDARD_COAT)) * STANDARD_MATERIAL.emission;
    return STANDARD_MATERIAL.emission;
}

// (101), linear RGB: a decal multiplies the color of the body.
//   reflection  of all lights    emission  of the surface    decal  white for none
vec3 standardColor(Reflection reflection, vec3 emission, vec3 decal)
{
    return safeLimit(safeLimit(reflection.body * decal) + safeLimit(reflection.gloss + emission));
}

// The same for a material without a coat.
vec3 standardColor(Reflection reflection, vec3 decal)
{
    return standardColor(reflection, STANDARD_MATERIAL.emission, decal);
}

#endif
