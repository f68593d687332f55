#version 150
// A quad that fills the picture, for programs that draw in the plane.
in vec3 position;           // -1 to 1
out vec2 place;

void main()
{
    place = position.xy;
    gl_Position = vec4(position.xy, 0.0, 1.0);
}
