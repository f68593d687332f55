// name: threshold
// kind: specular
// equation: (91): ceil(max(N.H, 0) - t) K_spec * L_spec
// source: textbook, section 10.1.4
//
// A highlight with a sharp edge. The ceiling is meant as a step from 0 to 1; literally it gives -1 at N.H = 0, t = 1 and
// 2 where rounding puts N.H past 1.
#ifndef GLISTEN_THRESHOLD
#define GLISTEN_THRESHOLD
#include "blinn_phong.glsl"

// 1 where the cosine c is above the threshold t, else 0.
float thresholdStep(float c, float t)
{
    return safeUnit(c) > t ? 1.0 : 0.0;
}

// (91) for unit vectors.
float thresholdFactor(vec3 N, vec3 L, vec3 V, float t)
{
    return dot(N, L) > 0.0 ? thresholdStep(dot(N, halfVector(L, V)), t) : 0.0;
}

#endif
