#version 450

layout(location = 0) out vec4 fragColor;
layout(set = 1, binding = 0) uniform sampler2D pattern;
layout(std140, set = 0, binding = 0) uniform Uniforms {
    layout(offset = 0) mat4 view;
    layout(offset = 64) mat4 projection;
    layout(offset = 128) vec3 lamp;  // in the space of the eye
    layout(offset = 144) vec3 ambient;
    layout(offset = 156) float shininess;
};

layout(location = 0) in vec3 eye_position;
layout(location = 1) in vec3 eye_normal;
layout(location = 2) in vec2 place;

void main()
{
    vec3 n = normalize(eye_normal);
    vec3 l = normalize(lamp - eye_position);
    vec3 h = normalize(l - normalize(eye_position));
    vec3 color = texture(pattern, place).rgb;
    float diffuse = max(dot(n, l), 0.0);
    float highlight = diffuse > 0.0 ? pow(max(dot(n, h), 0.0), shininess) : 0.0;
    fragColor = vec4(color * (ambient + diffuse) + 0.6 * highlight, 1.0);
}
