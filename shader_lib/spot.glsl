// name: spot
// kind: light
// equation: (98): c_spot = max(-L.L_dir, 0)^L_exp
// source: textbook, section 10.1.6
#ifndef GLISTEN_SPOT
#define GLISTEN_SPOT
#include "safe.glsl"

// The factor of a spot light: 1 on its axis, falling to 0 at a right angle to it.
//   L  unit vector towards the light    Ldir  unit vector along the beam    exponent  sharpness L_exp >= 0
float spotFactor(vec3 L, vec3 Ldir, float exponent)
{
    if (!(dot(-L, Ldir) > 0.0))
        return exponent > 0.0 ? 0.0 : 1.0;
    return safePowOneMinus(safeOneMinusCos(-L, Ldir), exponent);
}

#endif
