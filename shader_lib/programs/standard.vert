#version 150
#extension GL_ARB_shading_language_include : require
// The standard program: any lights and any model, computed at each fragment.
#include <glisten/normal.glsl>
#if defined(GLISTEN_NORMALS) || defined(GLISTEN_BRUSHED) || defined(GLISTEN_COAT_NORMALS)
#define STANDARD_TANGENTS
#endif

in vec3 position;
in vec3 normal;
in vec2 texcoord;
#ifdef STANDARD_TANGENTS
in vec4 tangent;
out vec4 along;         // tangent in world space, not of unit length, and its handedness
#endif
#ifdef GLISTEN_TWO_SETS
in vec2 texcoord2;
out vec2 st2;           // the second set of texture coordinates
#endif
#ifdef GLISTEN_COLORS
in vec4 vertex_color;
out vec4 tint;
#endif
uniform mat4 model;
uniform mat3 model_normal;
uniform mat4 model_view_projection;
out vec3 world;         // position in world space
out vec3 direction;     // normal in world space, not of unit length
out vec2 st;

void main()
{
    world = (model * vec4(position, 1.0)).xyz;
    direction = transformNormal(model_normal, normal);
    st = texcoord;
#ifdef STANDARD_TANGENTS
    along = vec4(mat3(model) * tangent.xyz, tangent.w);
#endif
#ifdef GLISTEN_TWO_SETS
    st2 = texcoord2;
#endif
#ifdef GLISTEN_COLORS
    tint = vertex_color;
#endif
    gl_Position = model_view_projection * vec4(position, 1.0);
}
