// name: fog
// kind: equation
// equation: e^-(rho r), e^-(rho r)^2, and e^-(rho e^-(b y) r (1 - e^-x) / x) with x = b r dy
// source: OpenGL 3.2 compatibility profile, section 3.11; Quilez, Better Fog, 2010, for a density that falls with the height
// stability: (1 - e^-x) / x by its series near 0, where level rays have 0/0; thick fog is 0 and never 0 times infinity
//
// What is left of the light of a point behind fog: mix(fog color, color, factor).
#ifndef GLISTEN_FOG
#define GLISTEN_FOG
#include "safe.glsl"

// (1 - e^-x) / x, the mean of e^-t from 0 to x; 1 at 0. At most the largest float.
// bound: 8e-7 rel
float fogMean(float x)
{
    if (abs(x) < 0.25) {
        float sum = 1.0 - x / 12.0;
        for (float n = 11.0; n > 1.5; n -= 1.0)
            sum = 1.0 - x / n * sum;
        return sum;
    }
    return min((1.0 - exp(min(-x, safeLargest()))) / x, safeLargest());
}

// Fog of one density everywhere: 0 to 1.
//   r  distance, limited to >= 0    density  limited to >= 0
// bound: 4e-7 abs
float fogFactor(float r, float density)
{
    return exp(-min(safePositive(r) * safePositive(density), 1024.0));
}

// The same by the square of the exponent, which leaves what is near clear and closes sooner: 0 to 1. OpenGL's EXP2.
//   r  distance, limited to >= 0    density  limited to >= 0
// bound: 4e-7 abs
float fogFactorSquared(float r, float density)
{
    float x = min(safePositive(r) * safePositive(density), 32.0);
    return exp(-x * x);
}

// Fog that lies on the ground: its density is that at height 0 there, and e times less 1 / falloff above it.
//   height  of the eye    direction  unit vector of the ray    r  distance, limited to >= 0
//   density  at height 0, limited to [0, 2^20]    falloff  limited to [0, 2^20]
// The density is taken at the lower end of the ray, from which it falls: the other end's may be nothing, and the mean along the ray too large for
// a float. The ray ends at height + direction.y * r, which rounds where these are large.
// bound: 2e-6 abs, an exponent of an exponent
float fogFactor(float height, vec3 direction, float r, float density, float falloff)
{
    float b = clamp(falloff, 0.0, exp2(20.0));
    float rise = clamp(clamp(direction.y, -1.0, 1.0) * safePositive(r), -exp2(100.0), exp2(100.0));
    float lower = clamp(height, -exp2(100.0), exp2(100.0)) + min(rise, 0.0);
    float at = clamp(density, 0.0, exp2(20.0)) * exp(clamp(-b * lower, -80.0, 70.0));
    return exp(-min(safeFinite(at * safePositive(r) * fogMean(abs(b * rise))), 1024.0));
}

#endif
