#version 150
// The rim's color.
uniform vec3 edge_color = vec3(0.0);
out vec4 color;

void main()
{
    color = vec4(edge_color, 1.0);
}
