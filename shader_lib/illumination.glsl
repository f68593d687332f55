// name: illumination
// kind: equation
// equation: (93), (97), (99), (100): I_tot = c_spot (I_amb + d (I_diff + I_spec)) and its parts
// source: textbook, sections 10.1.4 to 10.1.7
// stability: finite for every finite input
#ifndef GLISTEN_ILLUMINATION
#define GLISTEN_ILLUMINATION
#include "safe.glsl"

// One light (93): I_amb + I_diff + I_spec, linear RGB.
//   Iamb, Idiff, Ispec  its ambient, diffuse and specular reflection, >= 0
// bound: 2.4e-7 rel
vec3 illumination(vec3 Iamb, vec3 Idiff, vec3 Ispec)
{
    return safeLimit(Iamb + Idiff + Ispec);
}

// With distance (97): I_amb + d (I_diff + I_spec), linear RGB.
//   d  attenuation (95) or (96), >= 0
// bound: 2.4e-7 rel
vec3 illumination(vec3 Iamb, vec3 Idiff, vec3 Ispec, float d)
{
    return safeLimit(Iamb + d * safeLimit(Idiff + Ispec));
}

// With a beam (99): c_spot (I_amb + d (I_diff + I_spec)), linear RGB.
//   d  attenuation (95) or (96), >= 0    cspot  factor of the beam (98), 0 to 1
// bound: 2.4e-7 rel
vec3 illumination(vec3 Iamb, vec3 Idiff, vec3 Ispec, float d, float cspot)
{
    return safeLimit(cspot * illumination(Iamb, Idiff, Ispec, d));
}

// The part that comes from no light (100): K_amb * L_glob + L_emi, linear RGB. The full equation (101) is this plus
// the sum of (99) over the lights (module `lights`).
//   Kamb  ambient reflectance, 0 to 1    Lglob  global ambient light, >= 0    Lemi  light that the surface sends out itself, >= 0
// bound: 2.4e-7 rel
vec3 background(vec3 Kamb, vec3 Lglob, vec3 Lemi)
{
    return safeLimit(Kamb * Lglob + Lemi);
}

#endif
