//# vertex
#version 130
in vec2 place;
in float pw;
flat out float y0[2];
flat out vec4 ya;
vec4 acc = vec4(0.0);
void main() {
    y0 = float[2](1.0, 1.0);
    ya = acc;
    gl_ClipDistance[0] = 1.0;
    gl_ClipDistance[1] = place.x + 1.5;
    gl_Position = vec4(place * pw, 0.0, pw);
}
//# fragment
#version 130
out vec4 c0;
out vec4 c1;
vec4 acc = vec4(0.0);
vec3 f1 (const in uvec4 p7, bool p8, in uvec3 p9) {
    mat3x2 v10 = mat3x2(1.0);
    float v11 = mix(float(vec4(1.0)), 1.0, (v10[0].x = 1e-1));
    acc.z += (v11 < 8.0 ? max(v11, -8.0) : 8.0);
    return (vec3(1.0) + acc.xyz);
}
void main() {
    c0 = vec4(0.25);
    c1 = vec4(0.25);
    vec3 v19 = f1 (uvec4(1u), true, uvec3(1u));
}
//# scene
framebuffer = { width = 4, height = 4, attachments = 2, clear = [0, 0, 0, 0] }
[[draw]]
vertex = "a.vert"
fragment = "a.frag"
[draw.attributes]
place = { size = 2, values = [-1, -1, 3, -1, -1, 3] }
pw = { size = 1, values = [1, 2, 1.5] }

