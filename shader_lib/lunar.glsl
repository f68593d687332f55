// name: lunar
// kind: diffuse
// equation: s 2 N.L / (N.L + N.V) + (1 - s) N.L
// source: McEwen, Photometric Functions for Photoclinometry and Other Applications, Icarus 92, 1991; Fairbairn, Planetary Photometry: The Lommel-Seeliger Law, Journal of the Royal Astronomical Society of Canada 99, 2005
// stability: the divisor is a sum of two cosines that are not negative, and N.L alone where the eye grazes
//
// The moon, asteroids, dark dust: light is scattered once by grains that hide each other. A full moon is as bright at its limb as in
// its middle. s = 1 is the law of Lommel and Seeliger, 0 that of Lambert. Grazing light leaves a surface with up to four times
// its color: a color of w / 8 is that of grains with an albedo of w.
#ifndef GLISTEN_LUNAR
#define GLISTEN_LUNAR
#include "safe.glsl"

// 2 N.L / (N.L + N.V), the law of Lommel and Seeliger: 0 to 2, 1 where both cosines are equal; 0 where N.L is.
//   NL, NV  the cosines between normal, light and eye, limited to [0, 1]
// bound: 6e-7 abs
float lunarTerm(float NL, float NV)
{
    float l = safeUnit(NL);
    if (!(l > 0.0))
        return 0.0;
    return 2.0 * safeUnit(l / (l + safeUnit(NV)));
}

// The factor that replaces N.L. An eye below the surface counts as grazing.
//   N  unit normal    L, V  unit vectors towards the light and the eye    s  the part of Lommel and Seeliger, limited to [0, 1]
// bound: 9e-7 abs
float lunarFactor(vec3 N, vec3 L, vec3 V, float s)
{
    float NL = safeUnit(dot(N, L));
    float part = safeUnit(s);
    return part * lunarTerm(NL, dot(N, V)) + (1.0 - part) * NL;
}

#endif
