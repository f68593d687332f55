// name: iridescence
// kind: specular
// equation: F = R_12 + R_s + sum over m = 1, 2 of 2 (R_s - T) (R_12 R_23)^(m / 2) S(m D, m phi); T = 1 - R_12, R_s = T^2 R_23 / (1 - R_12 R_23), D = 2 n_2 d cos_2
// source: Belcour and Barla, A Practical Extension to Microfacet Theory for the Modeling of Varying Iridescence, SIGGRAPH 2017, section 4; KHR_materials_iridescence, Khronos 2022
// stability: waves are counted in turns, of which only the part is kept; no index of refraction of a mirror, which is infinite; 1 - R_12 R_23 as a sum
//
// A film on a surface, thinner than a thousandth of a millimeter: soap, oil, the wings of insects. Light that the surface below sends back
// meets what the film mirrors, and both together are brighter or darker by their wave length. It takes the place of Schlick's term in
// `ggx`. What the colors of light are is built in: S is the integral of a wave over the eye's sensitivities, as sums of normal
// distributions over the wave number, in linear RGB of Rec. 709.
#ifndef GLISTEN_IRIDESCENCE
#define GLISTEN_IRIDESCENCE
#include "safe.glsl"

// S, what a wave of the wave number leaves of white light, linear RGB: about (1.2, 0.95, 0.91) for no path, 0 for long ones.
//   path  by which two rays differ, in nanometers, limited to [0, 2^15]    shift  of their phases, in turns, per channel of XYZ
// bound: 2e-6 abs, dozens of turns
vec3 iridescenceSensitivity(float path, vec3 shift)
{
    // Micrometers: wave numbers and widths of the distributions are by them.
    float D = clamp(path, 0.0, exp2(15.0)) * 0.001;
    vec4 turns = vec4(1.6810, 1.7953, 2.2084, 2.2399) * D + clamp(shift.xyzx, vec4(-2.0), vec4(2.0));
    vec4 wave = cos(radians(360.0) * (turns - floor(turns + 0.5)));
    vec4 size = vec4(0.846590002, 1.00022189, 1.00112249, 0.153868307);
    vec4 a = size * wave * exp(-vec4(0.170854696, 0.367330884, 0.261035245, 0.178766171) * (D * D));
    vec3 xyz = vec3(a.x + a.w, a.yz);
    return vec3(
        3.2404542 * xyz.x - 1.5371385 * xyz.y - 0.4985314 * xyz.z,
        -0.9692660 * xyz.x + 1.8760108 * xyz.y + 0.0415560 * xyz.z,
        0.0556434 * xyz.x - 0.2040259 * xyz.y + 1.0572252 * xyz.z);
}

// F, the part of the light that a film and the surface below mirror, linear RGB. Saturated colors may have more than 1 in a channel.
//   cosine  between half vector and eye, limited to [0, 1]    outside, film  indices of refraction, limited to [1/16, 16]
//   thickness  in nanometers, limited to [0, 2^14]: the film fades below 0.03    F0  of the surface in air, each limited to [0, 1]
// bound: 3e-6 abs, dozens of turns
vec3 iridescenceFresnel(float cosine, float outside, float film, float thickness, vec3 F0)
{
    float c1 = safeUnit(cosine);
    float d = clamp(thickness, 0.0, exp2(14.0));
    float n1 = clamp(outside, 0.0625, 16.0);
    float fade = smoothstep(0.0, 0.03, d);
    float n2 = n1 + fade * (clamp(film, 0.0625, 16.0) - n1);
    float q = n1 / n2;
    // The squared cosine in the film, without what cancels where it is flat.
    float c22 = (n2 - n1) / n2 * (1.0 + q) + q * q * c1 * c1;
    // All of the light is reflected.
    if (!(c22 > 0.0))
        return vec3(1.0);
    float c2 = min(sqrt(c22), 1.0);
    // The film from outside: what it mirrors, and what it lets through.
    float r = (n2 - n1) / (n2 + n1);
    float steep = (1.0 - c1) * (1.0 - c1);
    steep = steep * steep * (1.0 - c1);
    float R12 = r * r + (1.0 - r * r) * steep;
    float T = (1.0 - r * r) * (1.0 - steep);
    // The surface from inside: its index is (1 + s) / (1 - s) in air.
    vec3 s = sqrt(clamp(F0, vec3(0.0), vec3(1.0)));
    vec3 base = vec3(1.0) + s;
    vec3 wet = n2 * (vec3(1.0) - s);
    vec3 R1 = (base - wet) / (base + wet);
    R1 *= R1;
    steep = (1.0 - c2) * (1.0 - c2);
    steep = steep * steep * (1.0 - c2);
    vec3 R23 = R1 + (vec3(1.0) - R1) * steep;
    vec3 left = (vec3(1.0) - R1) * (1.0 - steep);
    // Whatever is thinner is mirrored half a turn later.
    vec3 shift = vec3(n2 < n1 ? 0.0 : 0.5) + mix(vec3(0.0), vec3(0.5), lessThan(base, wet));
    vec3 Rs = T * R23 * (T / max(T + R12 * left, vec3(exp2(-60.0))));
    vec3 amplitude = sqrt(R12 * R23);
    vec3 first = (Rs - T) * amplitude;
    float D = 2.0 * n2 * d * c2;
    vec3 F = R12 + Rs + 2.0 * first * iridescenceSensitivity(D, shift);
    F += 2.0 * first * amplitude * iridescenceSensitivity(2.0 * D, 2.0 * shift);
    return max(F, vec3(0.0));
}

// F_0 for which Schlick's term is F at an angle: so that tables over F_0 serve a film, too.
//   F  each channel limited to [0, 1]    cosine  limited to [0, 1]
// bound: 1e-5 abs, a quotient of differences at grazing angles
vec3 iridescenceNormal(vec3 F, float cosine)
{
    float d = 1.0 - safeUnit(cosine);
    float p = d * d;
    p = min(p * p * d, 0.9999);
    return clamp((clamp(F, vec3(0.0), vec3(1.0)) - p) / (1.0 - p), vec3(0.0), vec3(1.0));
}

#endif
