// name: quartic
// kind: specular
// equation: brightness = max(R.V, 0)^4
// source: article, program `specular`
// stability: finite for every finite input
//
// The power of the article's highlight by color: two squarings, which are also exact where a GPU's pow() is not.
#ifndef GLISTEN_QUARTIC
#define GLISTEN_QUARTIC
#include "phong.glsl"

// x^4 for x limited to [0, 1].
// bound: 2.4e-7 abs
float quartic(float x)
{
    x = safeUnit(x);
    x *= x;
    return x * x;
}

// Phong's highlight with the exponent 4: 0 to 1; 0 where the light does not reach the surface (N.L <= 0).
//   N  unit normal    L, V  unit vectors towards the light and the eye
// bound: 2e-6 abs
float quarticFactor(vec3 N, vec3 L, vec3 V)
{
    return dot(N, L) > 0.0 ? quartic(dot(mirrorDirection(N, L), V)) : 0.0;
}

#endif
