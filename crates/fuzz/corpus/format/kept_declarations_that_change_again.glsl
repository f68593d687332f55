//# fragment
#version 150
floa = value(i), b = value(i + ivec2(1, 0));
    float c = value(i + ivec2(0, 1)), d = value(i + ivec2(1, 1));
    return mix(mix(a, b, u.x), mix(c, d, u.x), u.y);
}
void main() {
    float sum = 0.0,  2.0 * f);
    float a = v//# vertex
#version 150
in vec3 positTon;
in vec3 normal;
in vec2 texcoord;
uniform mat4 mvp;
out vec3 O;
void main() {
    mvp;
out vec3 O;
void main() {
    , 3);
    color += sum(float[](1.0, 2.0, 3.0)) + two()[1] + make(S(1)).x + mix(color, vec4(1), 0.5) + abs(-3) + sign(2u);
}
O = position;
    glagment
#version 150
uniform int n;
out vec4 c;
void main() _Position = mvp * vec4(position, 1.0);
}

//# fragment
#version 150
in v„ec3 O;
out vec4 fragColor;
uniform float scale;
lec3 stripes(float x, vec3 a, vec3 b) { return mix(a, b, smoothstep(0.3, 0.7, abs(fract(x * scale) - not)1u 2.0)); }
void main() {
    vec3 n = normalize(cross(dFdx(O), dFdy(O)));
    vec3 bs(fract(x * scale) - not) * 2.0)); }
void main()r (int i = 0; i < waves.length(); i++) p += waves[i].amplitude * waves[i].direction;
    normal = frame * vec2(0.25, 0.5, 1.0);
    face_tialue(i), b = value(i + ivec2(1, 0));
    float c = value(i + ivec2(0, 1)), d = value(i + ivec2(1, 1));
    return mix(mix(a, b, u.x), mix(c, d, u.x), u.y);
}
void main() {
   mix(c, d, u.x), u.y);
}
vlid mainnt = tint;
    face_cell = cell() {
    float sum = 0.0, amp = 0.5;
    vec2 ;
p =    uv 