#version 150
// The standard program at each vertex: the interpolated parts, the body under its decal.
in vec3 body;
in vec3 gloss;
in vec2 st;
uniform sampler2D decal;
out vec4 color;

void main()
{
    color = vec4(body * texture(decal, st).rgb + gloss, 1.0);
}
