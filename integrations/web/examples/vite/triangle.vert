#version 150

out vec2 at;

void main() {
    at = vec2(gl_VertexID == 1 ? 1.0 : -1.0, gl_VertexID == 2 ? 1.0 : -1.0);
    gl_Position = vec4(at * 0.9, 0.0, 1.0);
}
