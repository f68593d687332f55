// name: illumination
// kind: equation
// equation: (93), (97), (99), (100), (101)
// source: textbook, sections 10.1.4 to 10.1.7
#ifndef GLISTEN_ILLUMINATION
#define GLISTEN_ILLUMINATION

// One light (93): I_amb + I_diff + I_spec.
vec3 illumination(vec3 Iamb, vec3 Idiff, vec3 Ispec)
{
    return Iamb + Idiff + Ispec;
}

// With distance (97): I_amb + d (I_diff + I_spec).
vec3 illumination(vec3 Iamb, vec3 Idiff, vec3 Ispec, float d)
{
    return Iamb + d * (Idiff + Ispec);
}

// With a beam (99): c_spot (I_amb + d (I_diff + I_spec)).
vec3 illumination(vec3 Iamb, vec3 Idiff, vec3 Ispec, float d, float cspot)
{
    return cspot * (Iamb + d * (Idiff + Ispec));
}

// What no light gives (100): K_amb * L_glob + L_emi. The full equation (101) is this plus the sum over the lights.
vec3 background(vec3 Kamb, vec3 Lglob, vec3 Lemi)
{
    return Kamb * Lglob + Lemi;
}

#endif
