#version 150
#extension GL_ARB_shading_language_include : require
// The article's `edge`: the mesh moved along its normals on the screen, then towards the viewer, in one color. Draw it
// before the model, with depth write and culling off; the model then covers all but the rim.
#include <glisten/outline.glsl>

in vec3 position;
in vec3 normal;
uniform mat4 model_view_projection;     // world, view and projection
uniform mat4 projection;                // for the ratio of the picture's sides
uniform float width = 0.02;             // of the rim: the picture is 2 high
uniform float start = 0.0;              // the distance from which on it thins; 0: never
uniform float least = 0.0;              // the width that it keeps
uniform float push = 0.0;               // towards the viewer, in normalized device coordinates

void main()
{
    vec4 place = model_view_projection * vec4(position, 1.0);
    vec4 along = model_view_projection * vec4(normal, 0.0);
    float rim = start > 0.0 ? outlineThinned(place.w, width, start, least) : width;
    float aspect = projection[1][1] / projection[0][0];
    gl_Position = outlinePosition(place, outlineDirection(place, along), rim, push, aspect);
}
