#version 150
// Figure 127: a quad that fills the picture, with the angle and the height for the curves.
in vec3 position;           // -1 to 1
uniform float below = -0.06;
uniform float above = 1.1;
out vec2 place;             // the angle in radians, from -90 to 90 degrees; the height

void main()
{
    place = vec2(position.x * radians(90.0), mix(below, above, 0.5 * position.y + 0.5));
    gl_Position = vec4(position.xy, 0.0, 1.0);
}
