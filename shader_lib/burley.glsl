// name: burley
// kind: diffuse
// equation: (1 + (F_90 - 1) (1 - N.L)^5) (1 + (F_90 - 1) (1 - N.V)^5), F_90 = 0.5 + 2 roughness (L.H)^2
// source: Burley, Physically Based Shading at Disney, SIGGRAPH course 2012, section 5.3
// stability: (L.H)^2 is |L + V|^2 / 4, so that no half vector is needed
//
// Disney's diffuse reflection: smooth surfaces darken towards their rim, rough ones shine there. It is not scaled to keep
// energy: it returns up to 0.56 too much, at grazing angles and a roughness of 1.
#ifndef GLISTEN_BURLEY
#define GLISTEN_BURLEY
#include "safe.glsl"

// The factor that replaces N.L.
//   N  unit normal    L, V  unit vectors towards the light and the eye    roughness  limited to [0, 1]
// bound: 1e-6 abs
float burleyFactor(vec3 N, vec3 L, vec3 V, float roughness)
{
    float NL = min(dot(N, L), 1.0);
    if (!(NL > 0.0))
        return 0.0;
    vec3 h = safeLimit(L + V);
    // F_90 - 1; the square is 4 (L.H)^2, at most 4.
    float more = 0.5 * safeUnit(roughness) * min(dot(h, h), 4.0) - 0.5;
    float l = 1.0 - NL;
    float v = 1.0 - safeUnit(dot(N, V));
    float l2 = l * l;
    float v2 = v * v;
    return NL * (1.0 + more * (l2 * l2 * l)) * (1.0 + more * (v2 * v2 * v));
}

#endif
