#version 150

// A triangle that covers the window.

out vec2 uv;

void main() {
    vec2 corner = vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1)) * 4.0 - 1.0;
    uv = corner;
    gl_Position = vec4(corner, 0.0, 1.0);
}
