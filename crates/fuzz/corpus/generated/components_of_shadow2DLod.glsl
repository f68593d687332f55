//# vertex
#version 140
in vec2 place;
in float pw;
flat out vec2 y1;
void main() {
    y1 = mat4x2(1.0)[2];
    gl_Position = vec4(place * pw, 0.0, pw);
}
//# fragment
#version 140
uniform sampler2DShadow ts;
flat in vec2 y1;
out vec4 c0;
void main() {
    float v3 = 1.0;
    vec4 v5 = shadow2DLod(ts, clamp(y1.tst, 0.125, 2.5), clamp(v3, 0.0, 1.5));
    mat4 v6 = mat4(vec4(1.0), vec4(1.0), v5, v5);
    c0 = vec4(1.0, 1.0, 1.0, v6[2].y);
}
//# scene
[[draw]]
vertex = "a.vert"
fragment = "a.frag"
[draw.attributes]
place = { size = 2, values = [-1, -1, 3, -1, -1, 3] }
pw = { size = 1, values = [1, 2, 1.5] }
[draw.textures]
ts = { width = 2, height = 2, values = [0.6875, 0, 0.3125, 0.625] }
