//# vertex
#version 450
uniform sampler2D t2;
in vec2 place;
in float pw;
out Ioy0 { float a; flat ivec4 b; } y0;
out vec3 y1[2];
flat out int y2;
flat out vec4 ya;
vec4 acc = vec4(0.0);
void main() {
    int v5 = textureQueryLevels(t2);
    y0.a = 1.0;
    y0.b = ivec4(1);
    y1 = vec3[2](vec3(1.0), vec3(1.0));
    y2 = gl_InstanceID;
    ya = acc;
    gl_Position = vec4(place * pw, 0.0, pw);
}
//# fragment
#version 450
layout(location = 0) out vec4 c0;
layout(location = 1) out vec4 c1;
void main() {
    c0 = vec4(0.25);
    c1 = vec4(0.25);
}
//# scene
framebuffer = { width = 4, height = 4, attachments = 2, clear = [0, 0, 0, 0] }
[[draw]]
vertex = "a.vert"
fragment = "a.frag"
[draw.attributes]
place = { size = 2, values = [-1, -1, 3, -1, -1, 3] }
pw = { size = 1, values = [1, 2, 1.5] }
