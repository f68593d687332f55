#version 150
#extension GL_ARB_shading_language_include : require
// A clock of distances: every edge is as smooth as the pixel's width has it.
#include <glisten/sdf.glsl>

in vec2 place;              // -1 to 1
uniform vec3 paper = vec3(0.9);
uniform vec3 metal = vec3(0.3);
uniform vec3 ink = vec3(0.02);
uniform vec3 signal = vec3(0.8, 0.05, 0.02);
uniform vec2 hands = vec2(10.15, 9.0);      // hours and minutes
out vec4 color;

vec3 over(vec3 below, vec3 above, float d, float width)
{
    return mix(below, above, sdfCoverage(d, width));
}

vec2 turned(vec2 p, float turn)
{
    float a = radians(360.0) * turn;
    return vec2(cos(a) * p.x - sin(a) * p.y, sin(a) * p.x + cos(a) * p.y);
}

void main()
{
    vec2 p = place;
    float width = fwidth(p.x) + fwidth(p.y);
    width *= 0.7;
    // A shadow on the wall, then the case, the ring and the face.
    float body = sdfCircle(p, 0.86);
    vec3 seen = mix(vec3(0.32, 0.4, 0.42), vec3(0.2, 0.26, 0.28), 0.5 - 0.5 * p.y);
    float fall = sdfCircle(p - vec2(0.05, -0.07), 0.86);
    seen *= 1.0 - 0.55 * (1.0 - smoothstep(-0.12, 0.12, fall));
    seen = over(seen, metal * (0.75 + 0.5 * smoothstep(-0.9, 0.9, p.y - p.x)), body, width);
    seen = over(seen, metal * (0.9 - 0.6 * smoothstep(-0.9, 0.9, p.y - p.x)), body + 0.06, width);
    seen = over(seen, paper * (0.92 + 0.08 * smoothstep(-1.0, 1.0, p.y - p.x)), body + 0.1, width);
    // Sixty strokes: the plane is turned to the nearest one.
    float turn = p.x == 0.0 && p.y == 0.0 ? 0.0 : atan(p.x, p.y) / radians(360.0);
    float stroke = floor(60.0 * turn + 0.5);
    vec2 q = turned(p, stroke / 60.0);
    bool hour = mod(stroke, 5.0) == 0.0;
    vec2 extent = hour ? vec2(0.018, 0.06) : vec2(0.006, 0.025);
    seen = over(seen, ink, sdfBox(q - vec2(0.0, 0.7 - extent.y), extent) - 0.004, width);
    // The hands, with the shadow that they throw.
    vec2 h = turned(p, hands.x / 12.0);
    vec2 m = turned(p, hands.y / 60.0);
    vec2 s = turned(p, 0.58);
    float pair = min(sdfSegment(h, vec2(0.0, -0.1), vec2(0.0, 0.36), 0.03), sdfSegment(m, vec2(0.0, -0.12), vec2(0.0, 0.58), 0.02));
    vec2 off = p - vec2(0.02, -0.03);
    float thrown = min(sdfSegment(turned(off, hands.x / 12.0), vec2(0.0, -0.1), vec2(0.0, 0.36), 0.03),
        sdfSegment(turned(off, hands.y / 60.0), vec2(0.0, -0.12), vec2(0.0, 0.58), 0.02));
    seen *= 1.0 - 0.25 * (1.0 - smoothstep(-0.02, 0.03, thrown));
    seen = over(seen, ink, sdfBlend(pair, sdfCircle(p, 0.05), 0.06), width);
    float second = sdfBlend(sdfSegment(s, vec2(0.0, -0.2), vec2(0.0, 0.62), 0.006), sdfCircle(s - vec2(0.0, -0.2), 0.035), 0.05);
    seen = over(seen, signal, min(second, sdfCircle(p, 0.028)), width);
    seen = over(seen, paper, sdfCircle(p, 0.009), width);
    color = vec4(seen, 1.0);
}
