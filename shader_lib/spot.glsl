// name: spot
// kind: light
// equation: (98): c_spot = max(-L.L_dir, 0)^L_exp
// source: textbook, section 10.1.6
// stability: the error does not grow with the exponent, as it does in the literal (98)
//
// Outside the model: L_exp <= 0 is not a beam but a point light, with the factor 1 in all directions.
#ifndef GLISTEN_SPOT
#define GLISTEN_SPOT
#include "safe.glsl"

// The factor of a spot light: 1 on its axis, falling to 0 at a right angle to it.
//   L  unit vector towards the light    Ldir  unit vector along the beam    exponent  sharpness L_exp, limited to >= 0
// bound: 2.4e-7 abs
float spotFactor(vec3 L, vec3 Ldir, float exponent)
{
    return safeCosPow(-L, Ldir, exponent);
}

#endif
