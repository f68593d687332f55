// name: matcap
// kind: diffuse
// equation: (s, t) = 1/2 + 0.495 (x.N, y.N) with x = (V_z, 0, -V_x) / |(V_z, 0, -V_x)|, y = V x x
// source: Sloan et al., The Lit Sphere, Graphics Interface 2001; corrected for perspective as in three.js' MeshMatcapMaterial
// stability: an eye straight above or below has an axis of its own
//
// A picture of a lit ball as a material: the normal as the eye sees it is the place in the picture.
#ifndef GLISTEN_MATCAP
#define GLISTEN_MATCAP
#include "safe.glsl"

// The place in the picture of a ball, within a margin of half a percent: 0 to 1, y upwards.
//   N, V  unit normal and unit vector towards the eye, in the space of the eye: x to the right, y upwards
// bound: 1e-6 abs, the axis of an eye that looks down
vec2 matcapCoordinate(vec3 N, vec3 V)
{
    vec3 x = safeNormalize(vec3(V.z, 0.0, -V.x));
    if (!(safeExtent(x) > 0.0))
        x = vec3(1.0, 0.0, 0.0);
    vec3 y = cross(V, x);
    float s = clamp(safeFinite(dot(x, N)), -1.0, 1.0);
    float t = clamp(safeFinite(dot(y, N)), -1.0, 1.0);
    return 0.5 + 99.0 / 200.0 * vec2(s, t);
}

#endif
