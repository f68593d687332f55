// name: subsurface
// kind: diffuse
// equation: f = max(N.L + w, 0) / (1 + w)^2, w the mean of r^2 over R(r) = (e^(-r / d) + e^(-r / 3 d)) / (8 pi d r) on a ball of radius 1; d = l / (1.9 - A + 3.5 (A - 0.8)^2)
// source: Christensen and Burley, Approximate Reflectance Profiles for Efficient Subsurface Scattering, SIGGRAPH 2015, (3) and (6); Penner and Borshukov, Pre-Integrated Skin Shading, GPU Pro 2, 2011; McAuley, Energy-Conserving Wrapped Diffuse, 2011
// stability: moments of the profile as means of e^-xt over t from 0 to 1, by their series where differences cancel
//
// Light that enters a body and leaves it elsewhere: skin, wax, milk, marble. Each point of a lit ball is the mean of its neighbors' light
// under the normalized diffusion of Christensen and Burley. A factor of N.L alone has the ball's light in harmonics: wrapped light
// that keeps its energy has the first one for each w, and its second one is 1 - w / 2 of Lambert's. Normalized diffusion on a ball has
// 1 - <r^2> / 2 there, r the length of chords: so w is <r^2>, and both are exact. A body without that shape has the radius of its bends.
//
// The factor is no reflection function: light and eye may not change places, and a point in its own shadow may be lit.
#ifndef GLISTEN_SUBSURFACE_MODULE
#define GLISTEN_SUBSURFACE_MODULE
#include "safe.glsl"

// The means of e^-xt and of t^2 e^-xt over t from 0 to 1.
//   x  limited to [0, 2^20]
// bound: 1e-6 abs
vec2 subsurfaceMoments(float x)
{
    float y = clamp(x, 0.0, exp2(20.0));
    if (y < 1.0) {
        // The first omitted terms are 1e-17.
        vec2 sum = vec2(0.0);
        for (int k = 16; k >= 0; --k)
            sum = vec2(1.0 / (float(k) + 1.0), 1.0 / (float(k) + 3.0)) - y / (float(k) + 1.0) * sum;
        return sum;
    }
    float e = exp(-y);
    return vec2((1.0 - e) / y, (2.0 - e * (y * y + 2.0 * y + 2.0)) / (y * y * y));
}

// How far light reaches around the terminator: w, from 0 for none to 4/3 for a ball that is lit alike from all sides.
//   d  the distance of the profile for a ball of radius 1, limited to [0, 1024]
// bound: 2e-6 abs
float subsurfaceReach(float d)
{
    float x = 2.0 / clamp(d, exp2(-19.0), 1024.0);
    vec2 m = subsurfaceMoments(x) + subsurfaceMoments(x / 3.0);
    return 4.0 * m.y / m.x;
}

// The same per channel, of what a body is made of.
//   radius  the way of light between two collisions, for a ball of radius 1, >= 0    albedo  the color of the body, limited to [0, 1]
// bound: 3e-6 abs
vec3 subsurfaceReach(vec3 radius, vec3 albedo)
{
    vec3 A = clamp(albedo, vec3(0.0), vec3(1.0));
    vec3 k = A - 0.8;
    vec3 d = clamp(radius, vec3(0.0), vec3(1024.0)) / (1.9 - A + 3.5 * k * k);
    return vec3(subsurfaceReach(d.x), subsurfaceReach(d.y), subsurfaceReach(d.z));
}

// The factor that replaces N.L, per channel: its mean over a ball is that of Lambert's for every reach.
//   N, L  unit normal, unit vector towards the light    reach  subsurfaceReach(), limited to [0, 4/3]
// bound: 4e-7 abs
vec3 subsurfaceFactor(vec3 N, vec3 L, vec3 reach)
{
    vec3 w = clamp(reach, vec3(0.0), vec3(4.0 / 3.0));
    float c = clamp(safeFinite(dot(N, L)), -1.0, 1.0);
    vec3 wrapped = min(w, vec3(1.0)) + 1.0;
    vec3 near = max(c + w, vec3(0.0)) / (wrapped * wrapped);
    // Beyond 1 all of the ball is lit, and the second harmonic goes on to shrink.
    vec3 far = 0.25 + 0.25 * (2.0 - w) * c;
    return mix(near, far, greaterThan(w, vec3(1.0)));
}

#endif
