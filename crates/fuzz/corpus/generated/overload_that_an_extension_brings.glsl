//# vertex
#version 410
in vec2 place;
in float pw;
out Ioy0 { vec3 a; flat int b; } y0;
out vec3 y1;
out Ioy2 { vec2 a; flat int b; } y2;
out vec4 ya;
vec4 acc = vec4(0.0);
void main() {
    y0.a = vec3(1.0);
    y0.b = 1;
    y1 = vec3(1.0);
    y2.a = vec2(1.0);
    y2.b = 3;
    ya = acc;
    gl_Position = vec4(place * pw, 0.0, pw);
}
//# fragment
#version 410
uniform sampler2DShadow ts;
uniform sampler2DArrayShadow tas;
layout(location = 0) out vec4 c0;
layout(location = 1) out vec4 c1;
layout(location = 2) out vec4 c2;
layout(location = 3) out vec4 c3;
void main() {
    c0 = vec4(0.25);
    c1 = vec4(0.25);
    c2 = vec4(0.25);
    c3 = vec4(0.25);
    ivec3 v16 = ivec3(1);
    vec4 v21 = shadow2DLod(ts, clamp(vec3(1.0), 0.125, 2.5), clamp(0.7, 0.0, 1.5));
    float v24 = textureGrad(tas, clamp(vec4(1.0), 0.125, 2.5), clamp(vec2(1.0), -0.5, 0.5), clamp(frexp(clamp(v21.yx, -100.0, 100.0), v16.xz), -0.5, 0.5));
}
//# scene
framebuffer = { width = 4, height = 4, attachments = 4, clear = [0, 0, 0, 0] }
[[draw]]
vertex = "a.vert"
fragment = "a.frag"
[draw.attributes]
place = { size = 2, values = [-1, -1, 3, -1, -1, 3] }
pw = { size = 1, values = [1, 2, 1.5] }

