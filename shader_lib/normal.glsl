// name: normal
// kind: geometry
// equation: N' = (M^-1)^T N / |(M^-1)^T N|
// source: textbook, section 10.2.1, where it is a heading without a text
// stability: correct for columns of any length, 1e-38 to 1e38; singular matrices have a normal wherever one exists
#ifndef GLISTEN_NORMAL
#define GLISTEN_NORMAL
#include "safe.glsl"

// A positive multiple of (M^-1)^T for the upper 3x3 of `model`: it keeps normals perpendicular to a surface that
// `model` transforms, except for their length. It consists of cofactors, so that singular matrices have one, too:
// that of a plane onto which everything is projected. The zero matrix yields zero.
// bound: 2.4e-7 rel
mat3 normalMatrix(mat4 model)
{
    vec3 s = vec3(safeExtent(model[0].xyz), safeExtent(model[1].xyz), safeExtent(model[2].xyz));
    float most = safeExtent(s);
    if (!(most > 0.0))
        return mat3(0.0);
    // Each column is scaled to the extent 1, so that no product overflows or underflows.
    vec3 x = s.x > 0.0 ? model[0].xyz / s.x : vec3(0.0);
    vec3 y = s.y > 0.0 ? model[1].xyz / s.y : vec3(0.0);
    vec3 z = s.z > 0.0 ? model[2].xyz / s.z : vec3(0.0);
    // The scaling's effect on each cofactor: the product of the other two columns' extents, up to a common factor.
    float least = min(s.x, min(s.y, s.z));
    vec3 e = s / most;
    vec3 w = least > 0.0 ? vec3(least) / s : vec3(e.y * e.z, e.z * e.x, e.x * e.y);
    vec3 yz = cross(y, z);
    // A mirroring matrix inverts the cofactors.
    if (dot(x, yz) < 0.0)
        w = -w;
    return mat3(w.x * yz, w.y * cross(z, x), w.z * cross(x, y));
}

// The unit normal after that matrix; zero if the matrix maps it to zero.
//   matrix  the result of normalMatrix(), or any other    normal  of any length
// bound: 3e-7 abs
vec3 transformNormal(mat3 matrix, vec3 normal)
{
    // The length does not matter: scaled, a large normal does not overflow.
    return safeNormalize(safeFinite(matrix * (safeScale(safeExtent(normal)) * normal)));
}

#endif
