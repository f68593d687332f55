#version 150
// A surface under one distant light.

uniform mat4 modelViewProjection; // to clip space
uniform mat4 modelView;           // to eye space
uniform mat3 normalMatrix;        // of the model-view matrix

in vec3 position; // in model space
in vec3 normal;   // in model space, a unit vector

out vec3 place;
out vec3 direction;

void main() {
    place = (modelView * vec4(position, 1.0)).xyz;
    direction = normalMatrix * normal;
    gl_Position = modelViewProjection * vec4(position, 1.0);
}
