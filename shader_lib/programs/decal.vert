#version 150
// What needs no light: the article's ground and sky, and the line that shows the light's direction.
#ifndef INTERPOLATION
#define INTERPOLATION smooth
#endif

in vec3 position;
in vec2 texcoord;
uniform mat4 model_view_projection;
uniform vec2 repeat = vec2(1.0);
INTERPOLATION out vec2 st;

void main()
{
    st = texcoord * repeat;
    gl_Position = model_view_projection * vec4(position, 1.0);
}
