#version 120

uniform sampler2D pattern;
uniform vec3 lamp;          // in the space of the eye
uniform vec3 ambient;
uniform float shininess;

varying vec3 eye_position;
varying vec3 eye_normal;
varying vec2 place;

void main()
{
    vec3 n = normalize(eye_normal);
    vec3 l = normalize(lamp - eye_position);
    vec3 h = normalize(l - normalize(eye_position));
    vec3 color = texture2D(pattern, place).rgb;
    float diffuse = max(dot(n, l), 0.0);
    float highlight = diffuse > 0.0 ? pow(max(dot(n, h), 0.0), shininess) : 0.0;
    gl_FragColor = vec4(color * (ambient + diffuse) + 0.6 * highlight, 1.0);
}
