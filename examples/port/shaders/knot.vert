#version 120

// A knot under a lamp.
attribute vec3 position;
attribute vec3 normal;
attribute vec2 uv;

uniform mat4 view;          // from the model to the eye
uniform mat4 projection;    // with a depth from -1 to 1

varying vec3 eye_position;
varying vec3 eye_normal;
varying vec2 place;

void main()
{
    vec4 eye = view * vec4(position, 1.0);
    eye_position = eye.xyz;
    eye_normal = mat3(view) * normal;
    place = uv;
    gl_Position = projection * eye;
}
