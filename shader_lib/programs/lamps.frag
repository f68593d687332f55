#version 150
#extension GL_ARB_shading_language_include : require
// A surface of microfacets under a sphere and a tube of light.
#include <glisten/area_light.glsl>
#include <glisten/ggx.glsl>
#include <glisten/lambert.glsl>

in vec3 world;
in vec3 direction;          // along the normal
uniform vec3 eye;           // in world space
uniform vec3 body = vec3(0.2);
uniform vec3 gloss = vec3(0.04);
uniform float roughness = 0.3;
uniform vec3 bulb;          // the sphere's center
uniform float bulb_radius = 0.3;
uniform vec3 bulb_color = vec3(1.0);
uniform vec3 tube_from;     // the ends of the tube
uniform vec3 tube_to;
uniform float tube_radius = 0.05;
uniform vec3 tube_color = vec3(1.0);
uniform vec3 room = vec3(0.05);   // light from everywhere, half as much from below
out vec4 color;

// The unit vector towards the point of a tube that is nearest to the ray R.
vec3 nearestOfTube(vec3 a, vec3 b, float radius, vec3 R)
{
    // From the nearer end, whose digits matter.
    bool swapped = safeExtent(b) < safeExtent(a);
    vec3 from = swapped ? b : a;
    vec3 d = safeLimit(swapped ? a - b : b - a);
    float size = safeExtent(d);
    vec3 u = size > 0.0 ? d / size : vec3(0.0);
    // (R.a) (R.u) - a.u and u.u - (R.u)^2 as products of what is across the ray.
    vec3 across = cross(R, u);
    float square = dot(across, across);
    float t = square > 0.0 ? clamp(safeFinite(-dot(cross(R, from), across) / square), 0.0, size) : 0.0;
    return areaSphere(safeFinite(from + t * u), radius, R);
}

// The reflection of a light whose nearest point is in the direction `sharp`, for the irradiance that comes from `soft`.
vec3 lit(vec3 N, vec3 V, vec3 sharp, vec3 soft, float irradiance, float size, vec3 radiance)
{
    float alpha = roughness * roughness;
    // A wider highlight has less of the light at each point: Karis' normalization.
    float wide = min(alpha + 0.5 * size, 1.0);
    float spread = alpha / wide;
    vec3 highlight = ggx(N, sharp, V, alpha, gloss, vec3(spread * spread * size * size));
    return radiance * (lambertFactor(N, soft) * irradiance * body + highlight);
}

void main()
{
    vec3 N = safeNormalize(direction);
    vec3 V = safeNormalize(eye - world);
    vec3 R = safeNormalize(2.0 * dot(N, V) * N - V);
    vec3 to_bulb = bulb - world;
    float bulb_size = min(bulb_radius / max(safeLength(to_bulb), 0.001), 1.0);
    vec3 sum = lit(N, V, areaSphere(to_bulb, bulb_radius, R), safeNormalize(to_bulb), bulb_size * bulb_size, bulb_size, bulb_color);
    vec3 from = tube_from - world;
    vec3 to = tube_to - world;
    vec3 middle = 0.5 * (from + to);
    float tube_size = min(tube_radius / max(safeLength(middle), 0.001), 1.0);
    // The irradiance of a thin tube: its breadth times the angle that its length fills, for ends that are not too near.
    float along = safeLength(to - from) / max(safeLength(middle), 0.001);
    vec3 near = nearestOfTube(from, to, tube_radius, R);
    sum += lit(N, V, near, safeNormalize(middle), tube_size * along, sqrt(tube_size), tube_color);
    vec3 mirrored = ggxAlbedo(dot(N, V), roughness, gloss) * (0.75 + 0.25 * R.y);
    sum += room * (body * (0.75 + 0.25 * N.y) + mirrored);
    color = vec4(sum, 1.0);
}
