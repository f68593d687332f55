// name: tonemap
// kind: color
// equation: Reinhard c (1 + c / w^2) / (1 + c); Hable's, Hill's and Narkowicz's quotients; AgX by Wrensch's polynomial; Khronos PBR Neutral
// source: Reinhard et al. 2002, (4); Hable, Uncharted 2, GDC 2010; Hill, BakingLab 2016; Narkowicz 2016; Wrensch, AgX 2023; KhronosGroup/ToneMapping 2024
// stability: finite for every finite color: the literal quotients are infinite over infinite above 1e19; Hable's is 0 at 0 by its form
//
// From the light of a scene, which has no largest value, to that of a screen, 0 to 1, all linear RGB with the primaries of
// Rec. 709: encode it after that (module `srgb`). Negative channels count as 0, and those above 2^40
// as 2^40: all curves but Reinhard's have reached their end there.
#ifndef GLISTEN_TONEMAP
#define GLISTEN_TONEMAP
#include "safe.glsl"

// The color as the curves take it: 0 to 2^40.
// bound: 0 rel
vec3 tonemapLimit(vec3 color)
{
    return clamp(color, vec3(0.0), vec3(exp2(40.0)));
}

// The factor of an exposure value at ISO 100: the light that is white.
//   ev100  limited to [-64, 64]
// bound: 4e-7 rel
float tonemapExposure(float ev100)
{
    return exp2(-clamp(ev100, -64.0, 64.0)) / 1.2;
}

// Reinhard's curve for each channel; the channel `white` becomes 1, what is brighter more.
//   color  linear RGB, limited to [0, 2^40]    white  limited to [2^-10, 2^20]
// bound: 6e-7 rel
vec3 tonemapReinhard(vec3 color, float white)
{
    vec3 c = tonemapLimit(color);
    float w = clamp(white, exp2(-10.0), exp2(20.0));
    vec3 s = c / (1.0 + c);
    return s + s * (c / (w * w));
}

// Hable's curve of Uncharted 2 before its white point is divided out, without its difference: 0 at 0.
//   color  linear RGB, limited to [0, 2^40]
// bound: 6e-7 rel
vec3 tonemapHableCurve(vec3 color)
{
    vec3 c = tonemapLimit(color);
    // A = 0.15, B = 0.5, C = 0.1, D = 0.2, E = 0.02, F = 0.3: (c (A c + C B) + D E) / (c (A c + B) + D F) - E / F.
    return c * (7.0 / 50.0 * c + 1.0 / 60.0) / (c * (3.0 / 20.0 * c + 0.5) + 3.0 / 50.0);
}

// Hable's curve with his exposure of 2 and his white of 11.2.
//   color  linear RGB, limited to [0, 2^40]
// bound: 8e-7 rel
vec3 tonemapHable(vec3 color)
{
    return min(tonemapHableCurve(2.0 * tonemapLimit(color)) / tonemapHableCurve(vec3(56.0 / 5.0)), vec3(1.0));
}

// Narkowicz's fit of ACES, for each channel.
//   color  linear RGB, limited to [0, 2^40]
// bound: 6e-7 rel
vec3 tonemapNarkowicz(vec3 color)
{
    vec3 c = tonemapLimit(color);
    return min(c * (2.51 * c + 0.03) / (c * (2.43 * c + 0.59) + 0.14), vec3(1.0));
}

// Hill's fit of ACES, with its matrices: what three.js calls ACES filmic, but for that one's exposure of 1 / 0.6.
//   color  linear RGB, limited to [0, 2^40]
// bound: 2e-6 abs, two matrices and a quotient
vec3 tonemapAces(vec3 color)
{
    vec3 c = mat3(0.59719, 0.076, 0.0284, 0.35458, 0.90834, 0.13383, 0.04823, 0.01566, 0.83777) * tonemapLimit(color);
    vec3 v = (c * (c + 0.0245786) - 0.000090537) / (c * (0.983729 * c + 0.432951) + 0.238081);
    v = mat3(1.60475, -0.10208, -0.00327, -0.53108, 1.10813, -0.07276, -0.07367, -0.00605, 1.07602) * v;
    return clamp(v, vec3(0.0), vec3(1.0));
}

// AgX with its default look: saturated lights go to white instead of to the nearest corner of the gamut.
//   color  linear RGB, limited to [0, 2^40]
// bound: 2e-5 abs, the polynomial's coefficients are up to 40 and cancel
vec3 tonemapAgx(vec3 color)
{
    vec3 c = mat3(0.842479062253094, 0.0423282422610123, 0.0423756549057051, 0.0784335999999992, 0.878468636469772,
        0.0784336, 0.0792237451477643, 0.0791661274605434, 0.879142973793104) * tonemapLimit(color);
    // From 12.47 stops below 1 to 4.03 above.
    vec3 x = clamp((log2(max(c, vec3(exp2(-20.0)))) + 12.47393) / (12.47393 + 4.026069), vec3(0.0), vec3(1.0));
    vec3 y = -0.00232 + x * (0.1191 + x * (0.4298 + x * (-6.868 + x * (31.96 + x * (-40.14 + x * 15.5)))));
    y = mat3(1.19687900512017, -0.0528968517574562, -0.0529716355144438, -0.0980208811401368, 1.15190312990417,
        -0.0980434501171241, -0.0990297440797205, -0.0989611768448433, 1.15107367264116) * y;
    return vec3(safePow(y.x, 2.2), safePow(y.y, 2.2), safePow(y.z, 2.2));
}

// Khronos PBR Neutral: colors of materials stay what they are up to 0.8 but for 0.04 of gloss, highlights fade to white.
//   color  linear RGB, limited to [0, 2^40]
// bound: 6e-7 abs
vec3 tonemapNeutral(vec3 color)
{
    vec3 c = tonemapLimit(color);
    float low = min(c.x, min(c.y, c.z));
    // c - offset with the offset low - 6.25 low^2: what is subtracted from the smallest channel would cancel.
    float kept = low < 0.08 ? 6.25 * low * low : low - 0.04;
    c = (c - low) + kept;
    float peak = max(c.x, max(c.y, c.z));
    float start = 0.8 - 0.04;
    if (!(peak > start))
        return c;
    float d = 1.0 - start;
    float top = 1.0 - d * d / (peak + d - start);
    c *= top / peak;
    float g = 1.0 / (0.15 * (peak - top) + 1.0);
    return min(g * c + (1.0 - g) * top, vec3(1.0));
}

#endif
