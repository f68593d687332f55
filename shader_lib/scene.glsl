// name: scene
// kind: interface
// equation: none
// source: textbook, section 10.1.7
// stability: declarations alone
//
// The uniforms that a scene's [[light]], [material] and global_ambient fill: include this in a program of your own, and
// the scene gives them their values. The structs are those of `lights`. All positions and directions are in one space:
// world space, unless the scene's draw says `light_space = "eye"`.
//
// Which models are chosen are uniforms and not macros, so that one program draws every scene; a compiler that knows the
// uniforms can leave out the rest.
#ifndef GLISTEN_SCENE
#define GLISTEN_SCENE
#include "lights.glsl"

// Finish.diffuse_model
const int DIFFUSE_NONE = 0;
const int DIFFUSE_LAMBERT = 1;
const int DIFFUSE_HALF_LAMBERT = 2;
const int DIFFUSE_TOON_SOFT = 3;
const int DIFFUSE_TOON_HARD = 4;

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

// The models of a material, and what they take beside its reflectances.
struct Finish {
    int diffuse_model;
    int specular_model;
    // t of (91), and the cosine at which the hard toon parts.
    float threshold;
    // The dark color of the hard toon.
    vec3 shade;
};

uniform Light light[GLISTEN_LIGHTS];
// How many of them shine.
uniform int lights;
uniform Material material;
uniform Finish finish;
// L_glob of (100).
uniform vec3 global_ambient;

#endif
