// name: outline
// kind: geometry
// equation: p' = p + width w n_xy / |n_xy|, z' = z - push w
// source: article, program `edge`
//
// Drawn before the model, with depth write and culling off: the model then covers all but the rim.
#ifndef GLISTEN_OUTLINE
#define GLISTEN_OUTLINE
#include "safe.glsl"

// A clip-space position moved along its normal on the screen and then towards the viewer.
//   position  clip space    normal  clip-space direction of the normal (its x and y count)
//   width     in normalized device coordinates (2 is the whole picture)    push  likewise, in depth
vec4 outlinePosition(vec4 position, vec3 normal, float width, float push)
{
    vec2 direction = safeNormalize(vec3(normal.xy, 0.0)).xy;
    return vec4(position.xy + width * position.w * direction, position.z - push * position.w, position.w);
}

#endif
