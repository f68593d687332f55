// name: ambient
// kind: ambient
// equation: (92): I_amb = K_amb * L_amb
// source: textbook, section 10.1.4
#ifndef GLISTEN_AMBIENT
#define GLISTEN_AMBIENT

// Reflection of light that comes from everywhere, linear RGB. K_amb is mostly the same as K_diff.
vec3 ambient(vec3 Kamb, vec3 Lamb)
{
    return Kamb * Lamb;
}

#endif
