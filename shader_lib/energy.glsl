// name: energy
// kind: specular
// equation: f = (1 - E_L)(1 - E_V) / (pi (1 - E_m)) F, F = F_m^2 E_m / (1 - F_m (1 - E_m)); f' = f (1 + F_0 (1 - E) / E)
// source: Kulla and Conty, Revisiting Physically Based Shading at Imageworks, SIGGRAPH 2017; Turquin, Practical Multiple Scattering, 2019
// stability: nothing is divided by what a smooth surface lacks: there, both factors are those of one reflection
//
// Light that `ggx` loses, since it leaves a rough surface only after several reflections: without it, rough metals are dark. E is the
// part that the model reflects of light from everywhere, from the pattern `ltc_albedo`, E_m its mean over all directions.
//
// The tables are by one roughness. A brushed surface takes that of energyRoughness(): it loses about as much.
#ifndef GLISTEN_ENERGY
#define GLISTEN_ENERGY
#include "ltc.glsl"

// The roughness of a surface that is not brushed and loses about as much light, for the other functions: by the mean square of alpha.
//   alpha  along a tangent and across it, each limited to [2^-20, 1]
// bound: 4e-7 abs
float energyRoughness(vec2 alpha)
{
    vec2 a = clamp(alpha, vec2(exp2(-20.0)), vec2(1.0));
    return sqrt(sqrt(0.5 * dot(a, a)));
}

// The factor of all further reflections, pi f N.L, reciprocal: add it to that of ggxFactor().
//   table  `ltc_albedo`, of any filter    N, L, V  unit vectors    roughness  the root of alpha, limited to [0, 1]
//   Kspec  reflectance at normal incidence, each channel limited to [0, 1]
// bound: 1e-5 abs, the steep ends of the table
vec3 energyFactor(sampler2D table, vec3 N, vec3 L, vec3 V, float roughness, vec3 Kspec)
{
    float NL = min(dot(N, L), 1.0);
    if (!(NL > 0.0))
        return vec3(0.0);
    vec4 l = ltcTexel(table, vec2(sqrt(NL), roughness));
    vec4 v = ltcTexel(table, vec2(sqrt(safeUnit(dot(N, V))), roughness));
    float mean = safeUnit(v.z);
    float lost = 1.0 - mean;
    float least = exp2(-20.0);
    // A smooth surface loses nothing.
    if (!(lost > least))
        return vec3(0.0);
    vec3 k = vec3(safeUnit(Kspec.x), safeUnit(Kspec.y), safeUnit(Kspec.z));
    // The mean of Schlick's term.
    vec3 F = (20.0 * k + 1.0) / 21.0;
    vec3 share = F * F * mean / max(1.0 - F * lost, vec3(least));
    return safeLimit(share * (NL * ((1.0 - safeUnit(l.x)) / lost) * (1.0 - safeUnit(v.x))));
}

// What the single reflection is multiplied by instead: cheaper, but not reciprocal.
//   table, N, V, roughness, Kspec  as above
// bound: 1e-5 size, the steep ends of the table
vec3 energyCompensation(sampler2D table, vec3 N, vec3 V, float roughness, vec3 Kspec)
{
    float E = max(safeUnit(ltcTexel(table, vec2(sqrt(safeUnit(dot(N, V))), roughness)).x), exp2(-10.0));
    return vec3(1.0) + vec3(safeUnit(Kspec.x), safeUnit(Kspec.y), safeUnit(Kspec.z)) * ((1.0 - E) / E);
}

#endif
