#version 150
// Color of the mesh times decal times ramp.
in vec3 shade;
in vec2 st;
in float ramp_s;
uniform sampler2D decal;
uniform sampler2D ramp;
out vec4 color;

void main()
{
    color = vec4(shade * texture(decal, st).rgb * texture(ramp, vec2(ramp_s, 0.5)).rgb, 1.0);
}
