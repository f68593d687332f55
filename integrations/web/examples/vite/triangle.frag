#version 150

uniform vec4 tint;
in vec2 at;
out vec4 color;

void main() {
    color = tint * vec4(at * 0.5 + 0.5, 1.0, 1.0);
}
