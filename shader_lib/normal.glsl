// name: normal
// kind: geometry
// equation: N' = (M^-1)^T N
// source: textbook, section 10.2.1
#ifndef GLISTEN_NORMAL
#define GLISTEN_NORMAL
#include "safe.glsl"

// The matrix that keeps normals at right angles to a surface moved by `model`, but for its length: the transposed
// cofactors, which exist for singular matrices, too, and are (M^-1)^T times the determinant.
mat3 normalMatrix(mat4 model)
{
    vec3 x = model[0].xyz;
    vec3 y = model[1].xyz;
    vec3 z = model[2].xyz;
    vec3 yz = cross(y, z);
    // A mirroring matrix turns the cofactors round.
    float turn = dot(x, yz) < 0.0 ? -1.0 : 1.0;
    return mat3(turn * yz, turn * cross(z, x), turn * cross(x, y));
}

// The unit normal after that matrix.
vec3 transformNormal(mat3 matrix, vec3 normal)
{
    return safeNormalize(matrix * normal);
}

#endif
