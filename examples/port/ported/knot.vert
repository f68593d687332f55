#version 450

// A knot under a lamp.
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 uv;

layout(std140, set = 0, binding = 0) uniform Uniforms {
    layout(offset = 0) mat4 view;         // from the model to the eye
    layout(offset = 64) mat4 projection;  // with a depth from -1 to 1
    layout(offset = 128) vec3 lamp;
    layout(offset = 144) vec3 ambient;
    layout(offset = 156) float shininess;
};

layout(location = 0) out vec3 eye_position;
layout(location = 1) out vec3 eye_normal;
layout(location = 2) out vec2 place;

void openglMain()
{
    vec4 eye = view * vec4(position, 1.0);
    eye_position = eye.xyz;
    eye_normal = mat3(view) * normal;
    place = uv;
    gl_Position = projection * eye;
}

// Vulkan's depth: [0, w] in clip space; a size for points.
void main()
{
    openglMain();
    gl_Position.z = (gl_Position.z + gl_Position.w) * 0.5;
    gl_PointSize = 1.0;
}
