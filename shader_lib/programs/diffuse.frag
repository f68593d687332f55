#version 150
// The interpolated color times the decal, as the article's texture stages multiply them.
in vec3 shade;
in vec2 st;
uniform sampler2D decal;
out vec4 color;

void main()
{
    color = vec4(shade * texture(decal, st).rgb, 1.0);
}
