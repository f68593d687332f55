// name: ambient
// kind: ambient
// equation: (92): I_amb = K_amb * L_amb
// source: textbook, section 10.1.4
// stability: finite for every finite input
#ifndef GLISTEN_AMBIENT
#define GLISTEN_AMBIENT
#include "safe.glsl"

// Reflection (92) of light from all directions, linear RGB.
//   Kamb  reflectance for it, mostly the same as Kdiff, 0 to 1    Lamb  intensity of the light's ambient part, >= 0
// bound: 2.4e-7 rel
vec3 ambient(vec3 Kamb, vec3 Lamb)
{
    return safeLimit(Kamb * Lamb);
}

#endif
