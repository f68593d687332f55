// name: outline
// kind: geometry
// equation: p'.xy = p.xy + width w n / |(a n_x, n_y)|, p'.z = p.z - push w, n = the normal on the screen, a = the aspect; width min(start / w, 1)
// source: article, program `edge`
// stability: finite for every finite input; a normal that points at the viewer does not move the point sideways
//
// Draw it before the model, without depth writes and culling: the model then covers everything but the rim.
//
// A width is the same at every distance, and a model far away is all rim. outlineThinned() gives the width of a line that belongs to the
// model: `outlinePosition(p, n, outlineThinned(p.w, width, start, least), push, aspect)`. outlinePixels() gives that of a pen.
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

// A clip-space position moved along its normal on the screen and then towards the viewer, by the same number of pixels
// in every direction.
//   position  clip space    direction  on the screen, of any length (its x and y count)
//   width     in halves of the picture's height    push  in normalized device coordinates, in depth
//   aspect    the picture's width over its height, limited to 2^-20 to 2^20; for a projection matrix M, M[1][1] / M[0][0]
// bound: 2.4e-7 rel
vec4 outlinePosition(vec4 position, vec3 direction, float width, float push, float aspect)
{
    aspect = clamp(aspect, exp2(-20.0), exp2(20.0));
    // The direction in pixels, except for its length.
    vec2 n = safeNormalize(safeLimit(vec3(aspect * direction.x, direction.y, 0.0))).xy;
    // The width is multiplied by the direction first, so that 0 is never multiplied by infinity.
    vec2 by = safeLimit(width * vec3(n.x / aspect, n.y, 0.0)).xy;
    return safeLimit(vec4(position.xy + by * position.w, position.z - push * position.w, position.w));
}

// The same for a square picture.
// bound: 2.4e-7 rel
vec4 outlinePosition(vec4 position, vec3 direction, float width, float push)
{
    return outlinePosition(position, direction, width, push, 1.0);
}

// The width of so many pixels, in halves of the picture's height.
//   pixels  of the rim    height  of the picture in pixels, limited to >= 1
// bound: 2.4e-7 rel
float outlinePixels(float pixels, float height)
{
    return safeLimit(2.0 * (pixels / max(height, 1.0)));
}

// The width at a distance: from `start` on, it falls with the distance as the model's size on the screen does.
//   distance  from the eye, such as w in clip space; nearer than `start`, the width is not changed
//   width  at `start` and nearer, in any unit    start  limited to >= 0; at 0, all of the scene is far
//   least  the width that a line keeps, unless `width` is less
// bound: 2.4e-7 rel
float outlineThinned(float distance, float width, float start, float least)
{
    float s = max(start, 0.0);
    float w = distance > s ? width * (s / distance) : width;
    return max(w, min(least, width));
}

#endif
