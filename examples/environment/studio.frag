#version 150
// A room of a photographer, as a panorama: the direction of a pixel, and its radiance. +y is up, the middle of the picture is +x.
uniform vec2 size;
out vec4 color;

// 1 inside of a rectangle that faces the middle of the room, with soft edges.
float panel(vec3 d, vec3 center, vec3 right, vec3 up, vec2 extent, float soft)
{
    float depth = dot(d, normalize(center));
    if (depth <= 0.0)
        return 0.0;
    vec2 p = length(center) / depth * vec2(dot(d, right), dot(d, up)) - vec2(dot(center, right), dot(center, up));
    vec2 inside = smoothstep(vec2(0.0), vec2(soft), extent - abs(p));
    return inside.x * inside.y;
}

void main()
{
    float around = 6.2831853 * (gl_FragCoord.x / size.x - 0.5);
    float up = 3.1415927 * (gl_FragCoord.y / size.y - 0.5);
    vec3 d = vec3(cos(up) * cos(around), sin(up), cos(up) * sin(around));
    // Walls that are darker below, and a floor with the light of the lamps on it.
    vec3 light = mix(vec3(0.16, 0.15, 0.15), vec3(0.3, 0.34, 0.42), smoothstep(-0.1, 0.8, d.y));
    if (d.y < 0.0) {
        vec2 at = d.xz / max(-d.y, 0.02);
        light = mix(light, vec3(0.24, 0.18, 0.14) + 0.5 * exp(-0.25 * dot(at, at)) * vec3(1.0, 0.85, 0.65), smoothstep(0.0, -0.12, d.y));
    }
    // A window with four panes to the left, in front; a strip to the right, behind; a round lamp above.
    vec3 z = normalize(vec3(-0.75, 0.42, 0.62));
    vec3 x = normalize(cross(vec3(0.0, 1.0, 0.0), z));
    vec3 y = cross(z, x);
    for (int i = 0; i < 4; i++) {
        vec2 pane = vec2(i % 2 == 0 ? -0.33 : 0.33, i < 2 ? -0.33 : 0.33);
        light += panel(d, z + pane.x * x + pane.y * y, x, y, vec2(0.3), 0.03) * vec3(7.5, 7.0, 6.2);
    }
    z = normalize(vec3(0.95, 0.2, 0.1));
    x = normalize(cross(vec3(0.0, 1.0, 0.0), z));
    light += panel(d, z, x, cross(z, x), vec2(0.12, 0.9), 0.06) * vec3(2.0, 3.4, 6.0);
    light += smoothstep(0.965, 0.975, dot(d, normalize(vec3(0.15, 0.9, -0.3)))) * vec3(5.0, 4.2, 3.2);
    color = vec4(light, 1.0);
}
