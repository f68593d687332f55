// name: srgb
// kind: color
// equation: V = 12.92 C for C <= 0.0031308, else 1.055 C^(1/2.4) - 0.055; and back
// source: IEC 61966-2-1, sections 4.2 and 4.3; neither document has it
// stability: finite for every finite input; at the joint of the two pieces the standard's own digits leave a step of 3e-8
//
// The transfer function of most screens and of most 8-bit pictures. All models of the library compute with linear light:
// decode a texture that was painted or photographed, and encode the color last, if the framebuffer does not do it. Without
// that, falloffs and terminators look steeper than the model has them, and sums too bright. Values outside of [0, 1] are
// limited to it.
#ifndef GLISTEN_SRGB
#define GLISTEN_SRGB
#include "safe.glsl"

// A linear value as the one to store or to show: 0 to 1.
//   linear  limited to [0, 1]
// bound: 4e-7 rel
float srgbEncode(float linear)
{
    float c = safeUnit(linear);
    // 0.0031308, 12.92, 1.055 and 0.055 as quotients of exact numbers.
    return c <= 7827.0 / 2500000.0 ? c * (323.0 / 25.0) : safeUnit((211.0 * safePow(c, 5.0 / 12.0) - 11.0) / 200.0);
}

// The same for each channel.
// bound: 4e-7 rel
vec3 srgbEncode(vec3 linear)
{
    return vec3(srgbEncode(linear.r), srgbEncode(linear.g), srgbEncode(linear.b));
}

// A stored value as the linear one: 0 to 1.
//   encoded  limited to [0, 1]
// bound: 1e-6 rel, a steep power
float srgbDecode(float encoded)
{
    float v = safeUnit(encoded);
    // 0.04045 and 12.92.
    return v <= 809.0 / 20000.0 ? v * (25.0 / 323.0) : safePow((200.0 * v + 11.0) / 211.0, 12.0 / 5.0);
}

// The same for each channel.
// bound: 1e-6 rel, a steep power
vec3 srgbDecode(vec3 encoded)
{
    return vec3(srgbDecode(encoded.r), srgbDecode(encoded.g), srgbDecode(encoded.b));
}

#endif
