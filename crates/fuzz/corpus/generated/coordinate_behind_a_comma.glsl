//# vertex
#version 400
in vec2 place;
in float pw;
out Ioy0 { vec3 a; flat ivec4 b; } y0;
out Ioy1 { vec3 a; flat ivec4 b; } y1;
flat out vec3 y2[2];
out vec4 ya;
vec4 acc = vec4(0.0);
void main() {
    y0.a = vec3(1.0);
    y0.b = ivec4(1);
    y1.a = vec3(1.0);
    y1.b = ivec4(1);
    y2 = vec3[2](vec3(1.0), vec3(1.0));
    ya = acc;
    gl_Position = vec4(place * pw, 0.0, pw);
}
//# fragment
#version 400
layout(location = 0) out vec4 c0;
layout(location = 1) out vec4 c1;
vec4 acc = vec4(0.0);
void main() {
    c0 = vec4(0.25);
    c1 = vec4(0.25);
    float v12 = (mat2x4(1.0), gl_FragCoord.s);
    vec3 v15 = gl_FragCoord.wwy;
    c0 = acc + vec4(1.0, 1.0, 1.0, v15.z);
}
//# scene
framebuffer = { width = 4, height = 4, attachments = 2, clear = [0, 0, 0, 0] }
[[draw]]
vertex = "a.vert"
fragment = "a.frag"
[draw.attributes]
place = { size = 2, values = [-1, -1, 3, -1, -1, 3] }
pw = { size = 1, values = [1, 2, 1.5] }

