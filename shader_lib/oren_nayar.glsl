// name: oren_nayar
// kind: diffuse
// equation: A + B max(cos phi, 0) sin a tan b, A = 1 - 0.5 s^2 / (s^2 + 0.33), B = 0.45 s^2 / (s^2 + 0.09); EON = f_ss + f_ms
// source: Oren and Nayar, Generalization of Lambert's Model, SIGGRAPH 1994; Portsmouth, Kutz and Hill, EON, JCGT 14(1), 2025, listing 1
// stability: no angle is computed: cos phi sin a tan b is (L.V - N.L N.V) / max(N.L, N.V); the energy that EON returns is never 0/0
//
// Rough surfaces without gloss: plaster, clay, the moon. They are flatter than Lambert has it, and brighter where the light
// comes from behind the eye. The model of 1994 loses energy; EON adds what is reflected more than once.
#ifndef GLISTEN_OREN_NAYAR
#define GLISTEN_OREN_NAYAR
#include "safe.glsl"

// N.L cos phi sin a tan b where the light and the eye are on one side, and N.L cos phi sin a sin b where they are not: the term
// of Fujii's model, on which EON is built. -1 to 1; 0 where N.L is.
//   NL, NV, LV  the cosines between normal, light and eye, limited to [0, 1], [0, 1] and [-1, 1]
// bound: 4e-7 abs
float orenNayarTerm(float NL, float NV, float LV)
{
    float l = safeUnit(NL);
    float v = safeUnit(NV);
    float s = clamp(safeFinite(LV), -1.0, 1.0) - l * v;
    if (!(l > 0.0))
        return 0.0;
    return s > 0.0 ? s * (l / max(l, v)) : s * l;
}

// The factor of the model of 1994, which replaces N.L.
//   N  unit normal    L, V  unit vectors towards the light and the eye    sigma  the deviation of slopes in radians, limited to >= 0
// bound: 6e-7 abs
float orenNayarFactor(vec3 N, vec3 L, vec3 V, float sigma)
{
    float NL = min(dot(N, L), 1.0);
    if (!(NL > 0.0))
        return 0.0;
    sigma = clamp(sigma, 0.0, exp2(20.0));
    float s2 = sigma * sigma;
    float A = 1.0 - 0.5 * s2 / (s2 + 0.33);
    float B = 0.45 * s2 / (s2 + 0.09);
    return safePositive(A * NL + B * max(orenNayarTerm(NL, dot(N, V), dot(L, V)), 0.0));
}

// The part of a white EON surface's energy that leaves after one reflection, by the paper's polynomial: its albedo.
//   cosine  of the direction, limited to [0, 1]    roughness  limited to [0, 1]
// bound: 4e-7 abs
float eonSingle(float cosine, float roughness)
{
    float d = 1.0 - safeUnit(cosine);
    float r = safeUnit(roughness);
    float G = d * (0.0571085289 + d * (0.491881867 + d * (-0.332181442 + d * 0.0714429953)));
    return (1.0 + r * G) / (1.0 + r * (0.5 - 2.0 / radians(540.0)));
}

// The factor of EON, which replaces K_diff N.L: pi f times N.L, linear RGB.
//   N  unit normal    L, V  unit vectors    Kdiff  color, limited to [0, 1]    roughness  limited to [0, 1]
// bound: 2e-6 abs, dozens of roundings
vec3 eonFactor(vec3 N, vec3 L, vec3 V, vec3 Kdiff, float roughness)
{
    float NL = min(dot(N, L), 1.0);
    if (!(NL > 0.0))
        return vec3(0.0);
    float NV = safeUnit(dot(N, V));
    float r = safeUnit(roughness);
    vec3 K = clamp(Kdiff, vec3(0.0), vec3(1.0));
    // The paper's two constants; A is 1 / (1 + c1 r).
    float c1 = 0.5 - 2.0 / radians(540.0);
    float c2 = 2.0 / 3.0 - 28.0 / radians(2700.0);
    float A = 1.0 / (1.0 + c1 * r);
    vec3 single = K * A * (NL + r * orenNayarTerm(NL, NV, dot(L, V)));
    // What does not leave after one reflection, (1 - E(L)) (1 - E(V)) / (1 - mean E), without r / r.
    float dl = 1.0 - NL;
    float dv = 1.0 - NV;
    float Gl = dl * (0.0571085289 + dl * (0.491881867 + dl * (-0.332181442 + dl * 0.0714429953)));
    float Gv = dv * (0.0571085289 + dv * (0.491881867 + dv * (-0.332181442 + dv * 0.0714429953)));
    float lost = A * r * max(c1 - Gl, 0.0) * max(c1 - Gv, 0.0) / (c1 - c2);
    float mean = A * (1.0 + c2 * r);
    vec3 multiple = K * K * mean / (1.0 - K * (A * r * (c1 - c2)));
    return max(single + multiple * (lost * NL), vec3(0.0));
}

#endif
