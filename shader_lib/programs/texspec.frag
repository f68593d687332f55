#version 150
// The interpolated color times the decal, and the highlight's texel on top of it.
in vec3 shade;
in vec2 st;
in float gloss_s;
uniform sampler2D decal;
uniform sampler2D highlight;
out vec4 color;

void main()
{
    color = vec4(shade * texture(decal, st).rgb + texture(highlight, vec2(gloss_s, 0.5)).rgb, 1.0);
}
