#version 150

// A sphere of any material that this program knows, lit by up to eight lights.

in vec2 uv;
out vec4 fragColor;

uniform float time;
uniform int kind;           // 0 one color, 1 stripes, 2 noise in octaves
uniform vec3 base_color;
uniform vec3 second_color;
uniform float frequency;
uniform int octaves;
uniform int lights;
uniform vec4 toward[8];     // w is the strength
uniform float shininess;
uniform float highlight;
uniform bool rim;
uniform float rim_power;

float hash(vec3 p) {
    return fract(sin(dot(p, vec3(12.9898, 78.233, 37.719))) * 43758.547);
}

float noise(vec3 p) {
    vec3 cell = floor(p);
    vec3 f = fract(p);
    f = f * f * (3.0 - 2.0 * f);
    float sum = 0.0;
    for (int i = 0; i < 8; ++i) {
        vec3 corner = vec3(float(i & 1), float((i >> 1) & 1), float(i >> 2));
        vec3 weight = mix(1.0 - f, f, corner);
        sum += hash(cell + corner) * weight.x * weight.y * weight.z;
    }
    return sum;
}

vec3 surface(vec3 p) {
    switch (kind) {
    case 1:
        return mix(base_color, second_color, step(0.5, fract(p.y * frequency)));
    case 2:
        float sum = 0.0;
        float amplitude = 0.5;
        vec3 q = p * frequency;
        for (int i = 0; i < octaves; ++i) {
            sum += amplitude * noise(q);
            q *= 2.0;
            amplitude *= 0.5;
        }
        return mix(base_color, second_color, sum);
    default:
        return base_color;
    }
}

void main() {
    float square = dot(uv, uv);
    if (square > 0.8) {
        fragColor = vec4(0.0, 0.0, 0.0, 1.0);
        return;
    }
    vec3 n = vec3(uv, sqrt(0.8 - square)) * inversesqrt(0.8);
    float angle = time;
    vec3 p = vec3(cos(angle) * n.x + sin(angle) * n.z, n.y, cos(angle) * n.z - sin(angle) * n.x);
    vec3 albedo = surface(p);
    vec3 color = 0.05 * albedo;
    for (int i = 0; i < lights; ++i) {
        vec3 l = toward[i].xyz;
        float lambert = max(dot(n, l), 0.0);
        color += albedo * (lambert * toward[i].w);
        if (highlight > 0.0) {
            vec3 h = normalize(l + vec3(0.0, 0.0, 1.0));
            color += vec3(highlight * toward[i].w * pow(max(dot(n, h), 0.0), shininess));
        }
    }
    if (rim) {
        color += vec3(0.3) * pow(1.0 - n.z, rim_power);
    }
    fragColor = vec4(color, 1.0);
}
