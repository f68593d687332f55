// name: scene
// kind: interface
// equation: none
// source: textbook, section 10.1.7
// stability: declarations only
//
// The uniforms for a scene's [[light]], [material] and global_ambient: include this in your own program, and the
// scene sets them. The structs are those of `lights`. All positions and directions are in one space: world space,
// unless the scene's draw says `light_space = "eye"`.
//
// The selected models are uniforms and not macros, so that one program draws every scene. A compiler that knows the
// uniforms can remove the other models.
//
// With GLISTEN_SURFACE, a material has what changes from point to point by its textures, as in glTF 2.0.
#ifndef GLISTEN_SCENE
#define GLISTEN_SCENE
#include "lights.glsl"

// Finish.diffuse_model
const int DIFFUSE_NONE = 0;
const int DIFFUSE_LAMBERT = 1;
const int DIFFUSE_HALF_LAMBERT = 2;
const int DIFFUSE_TOON_SOFT = 3;
const int DIFFUSE_TOON_HARD = 4;
const int DIFFUSE_OREN_NAYAR = 5;
const int DIFFUSE_EON = 6;
const int DIFFUSE_BURLEY = 7;
const int DIFFUSE_WRAP = 8;
const int DIFFUSE_MINNAERT = 9;

// Finish.specular_model
const int SPECULAR_NONE = 0;
const int SPECULAR_PHONG = 1;
const int SPECULAR_BLINN_PHONG = 2;
const int SPECULAR_SCHLICK_PHONG = 3;
const int SPECULAR_SCHLICK_BLINN = 4;
const int SPECULAR_THRESHOLD = 5;
const int SPECULAR_QUARTIC = 6;
const int SPECULAR_TABLE_HALF = 7;
const int SPECULAR_TABLE_LIGHT = 8;
const int SPECULAR_GGX = 9;
const int SPECULAR_BECKMANN = 10;
const int SPECULAR_SHEEN = 11;
const int SPECULAR_NORMALIZED = 12;

// Finish.transmission_pass: which part of a surface that light passes through a draw adds. The first one is for draws without blending,
// the others for a draw that multiplies what is behind, and one that is added to it.
const int GLASS_ALL = 0;
const int GLASS_THROUGH = 1;
const int GLASS_SURFACE = 2;

// The models of a material, and their parameters besides its reflectances.
struct Finish {
    int diffuse_model;
    int specular_model;
    // t of (91), and the cosine at which hard toon shading changes.
    float threshold;
    // The dark color of hard toon shading.
    vec3 shade;
    // The roughness of microfacets and of rough diffuse surfaces, 0 to 1: the root of alpha.
    float roughness;
    // The strength of a coat of lacquer, and its roughness.
    float clearcoat;
    float clearcoat_roughness;
    // How metallic the base color is; below 0 for a material that is not by this model.
    float metallic;
#ifdef GLISTEN_SURFACE
    // The color before its parts are told apart, linear RGB.
    vec3 base_color;
    // 1 for a material that states its ambient reflectance, which otherwise is the diffuse one.
    float own_ambient;
    // What a part that is no metal mirrors at normal incidence.
    vec3 dielectric;
    // How much of the base color covers what is behind it, below 0 for all; above 0, the value below which nothing is drawn.
    float alpha;
    float alpha_cutoff;
    // 1 for a surface whose normal turns with the side that is seen.
    float two_sided;
    // How strong the two textures are.
    float normal_scale;
    float occlusion_strength;
#endif
#ifdef GLISTEN_FIBERS
    // The color of fibers over the rest, 0 to 1, and their roughness.
    vec3 sheen;
    float sheen_roughness;
#endif
#ifdef GLISTEN_BRUSHED
    // How much rougher a brushed surface is across its scratches, 0 to 1, and the cosine and the sine of the angle from the tangent to that
    // direction, in which highlights are wide.
    float anisotropy;
    vec2 anisotropy_turn;
#endif
#ifdef GLISTEN_FILM
    // How strong a thin film is, 0 to 1, its index of refraction, and its thickness in nanometers, where its texture is white and black.
    float film;
    float film_index;
    float film_thickness;
    float film_thinnest;
#endif
#ifdef GLISTEN_COAT_NORMALS
    // How strong the texture of the coat's normals is.
    float clearcoat_normal_scale;
#endif
#ifdef GLISTEN_GLASS
    // The part of the light that passes instead of being scattered, 0 to 1; e^-absorption of it is left behind, per channel.
    float transmission;
    vec3 absorption;
    int transmission_pass;
#endif
#ifdef GLISTEN_REFRACTION
    // The index of refraction of a body, and how it spreads over the colors: 20 divided by Abbe's number.
    float refraction;
    float dispersion;
#endif
#ifdef GLISTEN_DIELECTRIC_STRENGTH
    // How much of that a part that is no metal mirrors, 0 to 1, at all angles.
    float dielectric_strength;
#endif
#ifdef GLISTEN_LEAF
    // The part of the light that is scattered through the surface instead of back, 0 to 1, and its color, linear RGB.
    float leaf;
    vec3 leaf_color;
#endif
#ifdef GLISTEN_SUBSURFACE
    // The part of the diffuse light that travels in the body, 0 to 1, and its way between two collisions as a part of the body's radius.
    float subsurface;
    vec3 subsurface_radius;
#endif
};

#ifdef GLISTEN_PLACES
// Where a texture is on a surface: its coordinates are the products of these rows and (s, t, 1), of the second set of texture coordinates
// where `second` is 1.
struct Place {
    vec3 s;
    vec3 t;
    float second;
};

// The places of a material's textures.
struct Places {
    Place decal;
    Place metallic_roughness;
    Place emission_map;
    Place occlusion_map;
    Place normal_map;
    Place sheen_map;
    Place sheen_roughness_map;
    Place anisotropy_map;
    Place iridescence_map;
    Place iridescence_thickness_map;
    Place clearcoat_map;
    Place clearcoat_roughness_map;
    Place clearcoat_normal_map;
    Place dielectric_map;
    Place dielectric_strength_map;
    Place transmission_map;
    Place thickness_map;
    Place diffuse_transmission_map;
    Place diffuse_transmission_color_map;
};

uniform Places places;
#endif

uniform Light light[GLISTEN_LIGHTS];
// How many of the lights are used.
uniform int lights;
uniform Material material;
uniform Finish finish;
// L_glob of (100).
uniform vec3 global_ambient;

#endif
