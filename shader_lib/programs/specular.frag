#version 150
// The interpolated color times the decal, and the white highlight on top of it.
in vec3 shade;
in vec3 gloss;
in vec2 st;
uniform sampler2D decal;
out vec4 color;

void main()
{
    color = vec4(shade * texture(decal, st).rgb + gloss, 1.0);
}
