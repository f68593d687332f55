#version 150
in vec4 position;
in vec3 direction;
uniform mat4 transform;
out vec3 normal;
void main()
{
    normal = direction;
    gl_Position = transform * position;
}
