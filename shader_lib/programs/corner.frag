#version 150
#extension GL_ARB_shading_language_include : require
// A surface between a floor, a wall and balls under light from everywhere: what they hide, and what they reflect.
#include <glisten/ao.glsl>
#include <glisten/noise.glsl>

in vec3 world;
in vec3 direction;          // along the normal
uniform vec3 eye;           // in world space
uniform vec3 body = vec3(0.8);
uniform vec3 room = vec3(1.0);      // the light
uniform float floor_height = 0.0;
uniform float wall_depth = -1.0;    // the wall faces the eye
uniform vec4 balls[3];      // center and radius
uniform bool bounces = true;
out vec4 color;

const int SLICES = 12;

// The horizons of a slice: the angles from the eye's direction, before and after it, at which something is in the way.
struct Slice {
    vec3 V;                 // towards the eye
    vec3 T;                 // at right angles to it, in the slice
    float low;
    float high;
};

// A plane through the point `off` along its normal from here; nothing that is seen is behind it.
void hidePlane(inout Slice slice, vec3 normal)
{
    float along = max(dot(slice.V, normal), 0.0);
    float angle = atan(along, -dot(slice.T, normal));
    slice.high = min(slice.high, angle);
    slice.low = max(slice.low, angle - radians(180.0));
}

// A ball: the slice cuts a circle out of it.
void hideBall(inout Slice slice, vec4 ball)
{
    vec3 c = ball.xyz - world;
    float off = dot(c, cross(slice.V, slice.T));
    float square = ball.w * ball.w - off * off;
    vec2 p = vec2(dot(c, slice.V), dot(c, slice.T));
    float d = safeLength(vec3(p, 0.0));
    if (!(square > 0.0) || !(d > 0.0))
        return;
    float half_width = asin(min(sqrt(square) / d, 1.0));
    float middle = atan(p.y, p.x);
    if (middle > 0.0)
        slice.high = min(slice.high, max(middle - half_width, 0.0));
    else
        slice.low = max(slice.low, min(middle + half_width, 0.0));
}

// The part of the slice's light that arrives, times its share of all slices.
float seen(Slice slice, vec3 N)
{
    vec3 side = cross(slice.V, slice.T);
    vec3 flat_normal = N - dot(N, side) * side;
    vec2 n = vec2(dot(flat_normal, slice.V), dot(flat_normal, slice.T));
    float size = safeLength(vec3(n, 0.0));
    return size > 0.0 ? size * aoSlice(slice.low, slice.high, atan(n.y, n.x)) : 0.0;
}

float arriving(vec3 N, vec3 V)
{
    vec3 x = safeNormalize(abs(V.y) < 0.5 ? vec3(V.z, 0.0, -V.x) : vec3(0.0, V.z, -V.y));
    vec3 y = cross(V, x);
    float off = noiseUnit(noiseHash(ivec3(gl_FragCoord.xy, 0)));
    float sum = 0.0;
    for (int i = 0; i < SLICES; ++i) {
        float turn = radians(180.0) * (float(i) + off) / float(SLICES);
        Slice slice = Slice(V, cos(turn) * x + sin(turn) * y, -radians(180.0), radians(180.0));
        hidePlane(slice, vec3(0.0, 1.0, 0.0));
        hidePlane(slice, vec3(0.0, 0.0, 1.0));
        for (int j = 0; j < 3; ++j)
            hideBall(slice, balls[j]);
        sum += seen(slice, N);
    }
    return sum / float(SLICES);
}

void main()
{
    vec3 N = safeNormalize(direction);
    float a = arriving(N, safeNormalize(eye - world));
    vec3 light = bounces ? aoBounced(a, body) : vec3(a);
    color = vec4(room * body * light, 1.0);
}
