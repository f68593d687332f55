// name: outline
// kind: geometry
// equation: p'.xy = p.xy + width w n / |n|, p'.z = p.z - push w, n = the normal on the screen
// source: article, program `edge`
// stability: finite for every finite input; a normal that points at the viewer does not move the point sideways
//
// Draw it before the model, without depth writes and culling: the model then covers everything but the rim.
#ifndef GLISTEN_OUTLINE
#define GLISTEN_OUTLINE
#include "safe.glsl"

// The direction in which a point moves on the screen when it moves along its normal: the derivative of p.xy / p.w,
// except for its length. z is 0.
//   position  clip space    normal  the normal, transformed by the same matrix as a direction: matrix * vec4(N, 0)
// bound: 2.4e-7 rel
vec3 outlineDirection(vec4 position, vec4 normal)
{
    vec2 n = normal.xy * position.w - position.xy * normal.w;
    return safeFinite(vec3(n, 0.0));
}

// A clip-space position moved along its normal on the screen and then towards the viewer.
//   position  clip space    direction  on the screen, of any length (its x and y count)
//   width     in normalized device coordinates (2 is the whole picture)    push  the same, in depth
// bound: 2.4e-7 rel
vec4 outlinePosition(vec4 position, vec3 direction, float width, float push)
{
    vec2 n = safeNormalize(vec3(direction.xy, 0.0)).xy;
    // The width is multiplied by the direction first, so that 0 is never multiplied by infinity.
    return safeLimit(vec4(position.xy + width * n * position.w, position.z - push * position.w, position.w));
}

#endif
