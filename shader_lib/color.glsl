// name: color
// kind: color
// equation: Y = 0.2126 R + 0.7152 G + 0.0722 B; matrices between primaries; OKLab; u, v of the Planckian locus
// source: ITU-R BT.709-6; BT.2087-0, section 4; SMPTE EG 432-1 (Display P3); Ottosson, OKLab 2020; Krystek, Color Research and Application 10, 1985
// stability: cube roots are corrected by one step of Newton, so that they are exact to rounding for all sizes
//
// Linear colors of one space as those of another. All matrices keep white. Colors of the smaller space lie in the larger one;
// the other way, saturated ones have negative channels.
#ifndef GLISTEN_COLOR
#define GLISTEN_COLOR
#include "safe.glsl"

// The luminance of a color with the primaries of Rec. 709.
// bound: 3e-7 color
float colorLuminance(vec3 color)
{
    return safeLimit(dot(vec3(0.2126, 0.7152, 0.0722), color));
}

// Rec. 709 (and sRGB) as Display P3.
// bound: 3e-7 color
vec3 colorToP3(vec3 color)
{
    return safeLimit(mat3(0.822461969, 0.033194199, 0.017082631, 0.177538031, 0.966805801, 0.072397441, 0.0, 0.0,
        0.910519929) * color);
}

// Display P3 as Rec. 709.
// bound: 4e-7 color
vec3 colorFromP3(vec3 color)
{
    return safeLimit(mat3(1.224940176, -0.042056955, -0.019637555, -0.224940176, 1.042056955, -0.078636046, 0.0, 0.0,
        1.0982736) * color);
}

// Rec. 709 as Rec. 2020, by the numbers of BT.2087.
// bound: 3e-7 color
vec3 colorToRec2020(vec3 color)
{
    return safeLimit(mat3(0.6274, 0.0691, 0.0164, 0.3293, 0.9195, 0.088, 0.0433, 0.0114, 0.8956) * color);
}

// Rec. 2020 as Rec. 709.
// bound: 6e-7 color
vec3 colorFromRec2020(vec3 color)
{
    return safeLimit(mat3(1.660491, -0.12455, -0.018151, -0.587641, 1.1329, -0.100579, -0.07285, -0.008349, 1.11873) * color);
}

// The cube root with its sign.
//   x  any finite number
// bound: 3e-7 rel
float colorCubeRoot(float x)
{
    float a = abs(x);
    if (!(a >= exp2(-126.0)))
        return 0.0;
    float r = exp2(log2(a) / 3.0);
    // One step of Newton's: the logarithm of a GPU is off by more than rounding.
    r -= (r - a / (r * r)) / 3.0;
    return x < 0.0 ? -r : r;
}

// OKLab of a linear Rec. 709 color: lightness 0 to 1, and two opponent axes.
// bound: 1e-6 color
vec3 colorToOklab(vec3 color)
{
    vec3 lms = mat3(0.4122214708, 0.2119034982, 0.0883024619, 0.5363325363, 0.6806995451, 0.2817188376,
        0.0514459929, 0.1073969566, 0.6299787005) * color;
    lms = vec3(colorCubeRoot(lms.x), colorCubeRoot(lms.y), colorCubeRoot(lms.z));
    return mat3(0.2104542553, 1.9779984951, 0.0259040371, 0.793617785, -2.428592205, 0.7827717662, -0.0040720468,
        0.4505937099, -0.808675766) * lms;
}

// The linear Rec. 709 color of an OKLab color. Saturated ones have channels outside of [0, 1].
//   lab  lightness and two axes, each limited to [-16, 16]
// bound: 4e-5 abs, cubes of up to 16 cancel
vec3 colorFromOklab(vec3 lab)
{
    lab = clamp(lab, vec3(-16.0), vec3(16.0));
    vec3 lms = mat3(1.0, 1.0, 1.0, 0.3963377774, -0.1055613458, -0.0894841775, 0.2158037573, -0.0638541728, -1.291485548) * lab;
    lms = lms * lms * lms;
    return mat3(4.0767416621, -1.2684380046, -0.0041960863, -3.3077115913, 2.6097574011, -0.7034186147, 0.2309699292,
        -0.3413193965, 1.707614701) * lms;
}

// The color of a black body, linear Rec. 709 with the luminance 1. The red of a candle has no blue: channels are limited
// to >= 0, and the others share the luminance.
//   kelvin  limited to [1000, 15000], where the fit of the locus is good to 1e-4 in u and v
// bound: 2e-6 abs, the quotient of two polynomials
vec3 colorTemperature(float kelvin)
{
    // In units of 1000 K.
    float T = clamp(kelvin, 1000.0, 15000.0) / 1000.0;
    float u = (0.860117757 + T * (0.154118254 + T * 0.128641212)) / (1.0 + T * (0.842420235 + T * 0.708145163));
    float v = (0.317398726 + T * (0.0422806245 + T * 0.0420481691)) / (1.0 + T * (-0.0289741816 + T * 0.161456053));
    // X and Z for Y = 1.
    float X = 1.5 * u / v;
    float Z = (2.0 - 0.5 * u) / v - 5.0;
    vec3 c = vec3(3.2404542 * X - 1.5371385 - 0.4985314 * Z, -0.969266 * X + 1.8760108 + 0.041556 * Z,
        0.0556434 * X - 0.2040259 + 1.0572252 * Z);
    c = max(c, vec3(0.0));
    return c / colorLuminance(c);
}

// The threshold of ordered dithering at a pixel, by Bayer's 8 by 8 matrix: (i + 0.5) / 64 - 0.5.
//   pixel  of the window; whole pixels count
// bound: 0 abs
float colorBayer(vec2 pixel)
{
    ivec2 p = ivec2(clamp(floor(pixel), vec2(-1048576.0), vec2(1048576.0))) & 7;
    int x = p.x ^ p.y;
    int i = ((x & 1) << 5) | ((p.y & 1) << 4) | ((x & 2) << 2) | ((p.y & 2) << 1) | ((x & 4) >> 1) | ((p.y & 4) >> 2);
    return (float(i) + 0.5) / 64.0 - 0.5;
}

// A color for a screen with few levels: dithered, not rounded, so that a ramp has no bands.
//   color  as it is stored, 0 to 1    pixel  of the window    levels  of a channel, 256 for 8 bits, limited to [2, 65536]
// bound: 3e-7 abs
vec3 colorDither(vec3 color, vec2 pixel, float levels)
{
    float n = clamp(levels, 2.0, 65536.0) - 1.0;
    return clamp(color, vec3(0.0), vec3(1.0)) + colorBayer(pixel) / n;
}

#endif
