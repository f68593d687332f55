// name: subsurface
// kind: diffuse
// equation: f = p max(c, 0) + q max(c + w, 0) / (1 + w)^2 + (1 - p - q) / 4, c = N.L, with the first three harmonics of Lambert's ball spread by R(r) = (e^(-r / d) + e^(-r / 3 d)) / (8 pi d r); d = l / (1.9 - A + 3.5 (A - 0.8)^2)
// source: Christensen and Burley, Approximate Reflectance Profiles for Efficient Subsurface Scattering, SIGGRAPH 2015, (3) and (6); Penner and Borshukov, Pre-Integrated Skin Shading, GPU Pro 2, 2011; McAuley, Energy-Conserving Wrapped Diffuse, 2011
// stability: moments of the profile as sums of positive terms where differences cancel, then by a recurrence without differences
//
// Light that enters a body and leaves it elsewhere: skin, wax, milk, marble. Each point of a lit ball of radius 1 is the mean of its
// neighbors' light under normalized diffusion, which is a convolution: it takes a part of each harmonic but the first. For chords r
// these parts are moments: a = <r^2> / 2 of the second harmonic, b = 3 <r^2> / 2 - 3 <r^4> / 8 of the third one. Lambert's factor,
// McAuley's wrapped one, which keeps its energy, and light from everywhere have harmonics in closed form, and their mean above has
// these three. It is within 0.026 of the convolution for every d, and a white ball returns all light. Bodies of other shapes have the
// radius of their bends.
//
// The factor is no reflection function: light and eye may not change places, and a point in its own shadow may be lit.
#ifndef GLISTEN_SUBSURFACE_MODULE
#define GLISTEN_SUBSURFACE_MODULE
#include "safe.glsl"

// The means of e^-xt, of t^2 e^-xt and of t^4 e^-xt over t from 0 to 1.
//   x  limited to [0, 2^20]
// bound: 6e-7 abs
vec3 subsurfaceMoments(float x)
{
    float y = clamp(x, 0.0, exp2(20.0));
    float e = exp(-y);
    float fourth = 0.0;
    if (y < 2.0) {
        // The first omitted terms are 1e-17.
        float term = e / 5.0;
        for (int k = 1; k <= 22; ++k) {
            fourth += term;
            term *= y / (5.0 + float(k));
        }
    } else {
        float p = (((y + 4.0) * y + 12.0) * y + 24.0) * y + 24.0;
        fourth = (24.0 - e * p) / (y * y) / (y * y * y);
    }
    float second = (y * (y * fourth + e) / 4.0 + e) / 3.0;
    return vec3(y * (y * second + e) / 2.0 + e, second, fourth);
}

// The parts of the second and of the third harmonic that travel takes: a and b, from 0 for none to 2/3 and 4/5.
//   d  the distance of the profile for a ball of radius 1, limited to [0, 1024]
// bound: 2e-6 abs
vec2 subsurfaceBands(float d)
{
    float x = 2.0 / clamp(d, exp2(-19.0), 1024.0);
    vec3 m = subsurfaceMoments(x) + subsurfaceMoments(x / 3.0);
    return vec2(2.0 * m.y, 6.0 * (m.y - m.z)) / m.x;
}

// The same for each channel, of what a body is made of: a and b are the columns.
//   radius  the way of light between two collisions, for a ball of radius 1, limited to [0, 1024]
//   albedo  the color of the body, limited to [0, 1]
// bound: 3e-6 abs
mat2x3 subsurfaceBands(vec3 radius, vec3 albedo)
{
    vec3 A = clamp(albedo, vec3(0.0), vec3(1.0));
    vec3 k = A - 0.8;
    vec3 d = clamp(radius, vec3(0.0), vec3(1024.0)) / (1.9 - A + 3.5 * k * k);
    vec2 r = subsurfaceBands(d.x);
    vec2 g = subsurfaceBands(d.y);
    vec2 b = subsurfaceBands(d.z);
    return mat2x3(r.x, g.x, b.x, r.y, g.y, b.y);
}

// The factor of one channel.
//   c  N.L    a, b  of subsurfaceBands(), limited to [0, 2/3], and to [a, 3 a] and at most 1
// bound: 4e-7 abs
float subsurfaceLit(float c, float a, float b)
{
    float cosine = clamp(c, -1.0, 1.0);
    float lambert = max(cosine, 0.0);
    float second = clamp(a, 0.0, 2.0 / 3.0);
    float third = clamp(b, second, min(3.0 * second, 1.0));
    if (third < 2.0 * second)
        return (1.0 - third) * lambert + 0.5 * (third - second) * (1.0 + cosine) + 0.25 * (2.0 * second - third);
    if (!(second > exp2(-100.0)))
        return lambert;
    float w = 2.0 - 0.5 * third / second;
    float q = 2.0 * second / w;
    return (1.0 - q) * lambert + q * max(cosine + w, 0.0) / ((1.0 + w) * (1.0 + w));
}

// The factor that replaces N.L, per channel: its mean over a ball is that of Lambert's.
//   N, L  unit normal, unit vector towards the light    bands  subsurfaceBands()
// bound: 6e-7 abs
vec3 subsurfaceFactor(vec3 N, vec3 L, mat2x3 bands)
{
    float c = safeFinite(dot(N, L));
    return vec3(
        subsurfaceLit(c, bands[0].x, bands[1].x),
        subsurfaceLit(c, bands[0].y, bands[1].y),
        subsurfaceLit(c, bands[0].z, bands[1].z));
}

#endif
