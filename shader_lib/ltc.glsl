// name: ltc
// kind: light
// equation: E = |sum of theta_i (p_i x p_j)_z / |p_i x p_j|| / (2 pi) over the edges i, j of the light above the horizon, p = M^-1 times a corner
// source: Heitz et al., Real-Time Polygonal-Light Shading with Linearly Transformed Cosines, SIGGRAPH 2016; Heitz and Hill, course, SIGGRAPH 2017
// stability: an edge's angle by its chord, never by a cosine; each edge is cut at the horizon, so a light in the surface's plane is finite
//
// Lights with a size: rectangles, disks, spheres and tubes that shine evenly to both sides, exactly for diffuse surfaces but for the
// corners of round lights, and for `ggx` as near as a cosine under a matrix comes to it. The matrices are tables by roughness and
// angle, which a scene has as the patterns `ltc_matrix` and `ltc_albedo`. Round lights have sixteen corners, tubes twelve or sixteen, and
// their true area.
//
// A light of radiance 1 over all of the sky gives a diffuse surface 1: multiply by the radiance over pi times the library's pi, that is by
// the radiance, and by the diffuse color or ltcAlbedo(). For `ggx` it gives less, where a part of the bent cosine is below the horizon:
// down to 0.82 at a grazing angle. docs/library.md has the figures.
#ifndef GLISTEN_LTC
#define GLISTEN_LTC
#include "safe.glsl"

// The frame of a surface: multiplied by a vector, it has N as z and the eye in the plane of x and z.
//   N, V  unit normal, unit vector towards the eye
// bound: 3e-6 abs, the eye's direction across the normal
mat3 ltcFrame(vec3 N, vec3 V)
{
    vec3 y = cross(N, V);
    // Seen from straight above, any tangent does.
    if (!(safeExtent(y) > exp2(-60.0)))
        y = abs(N.x) < 0.5 ? vec3(0.0, N.z, -N.y) : vec3(-N.z, 0.0, N.x);
    y = safeNormalize(safeFinite(y));
    vec3 x = safeFinite(cross(y, N));
    return mat3(x.x, y.x, N.x, x.y, y.y, N.y, x.z, y.z, N.z);
}

// A table's numbers between its texels, by weights that are exact: a GPU's own filter has as few as 256 steps.
//   place  limited to [0, 1]: from the first to the last column, and from the first to the last row
// bound: 2e-6 abs, the steep ends of the table
vec4 ltcTexel(sampler2D table, vec2 place)
{
    ivec2 last = textureSize(table, 0) - 1;
    vec2 at = vec2(last) * vec2(safeUnit(place.x), safeUnit(place.y));
    vec2 low = floor(at);
    ivec2 a = ivec2(low);
    ivec2 b = min(a + 1, last);
    vec2 t = at - low;
    vec4 below = (1.0 - t.x) * texelFetch(table, a, 0) + t.x * texelFetch(table, ivec2(b.x, a.y), 0);
    vec4 above = (1.0 - t.x) * texelFetch(table, ivec2(a.x, b.y), 0) + t.x * texelFetch(table, b, 0);
    return (1.0 - t.y) * below + t.y * above;
}

// The frame, and then the inverse matrix of the cosine that is like `ggx`.
//   table  `ltc_matrix`, of any filter    N, V  unit vectors    roughness  the root of alpha, limited to [0, 1]
// bound: 6e-6 abs, the frame and the steep ends of the table
mat3 ltcMatrix(sampler2D table, vec3 N, vec3 V, float roughness)
{
    // The columns are sqrt(1 - N.V), by the distance of the directions.
    vec4 m = ltcTexel(table, vec2(sqrt(safeOneMinusCos(N, V)), roughness));
    mat3 shape = mat3(m.x, 0.0, m.z, 0.0, 1.0, 0.0, m.y, 0.0, m.w);
    mat3 to = ltcFrame(N, V);
    return mat3(safeFinite(shape * to[0]), safeFinite(shape * to[1]), safeFinite(shape * to[2]));
}

// The color of all light that `ggx` reflects, which multiplies a light's E.
//   table  `ltc_albedo`, of any filter    N, V  unit vectors    roughness  limited to [0, 1]    Kspec  0 to 1
// bound: 2e-6 color, the steep ends of the table
vec3 ltcAlbedo(sampler2D table, vec3 N, vec3 V, float roughness, vec3 Kspec)
{
    // The columns are sqrt(N.V): towards the horizon, the reflection changes most.
    vec2 a = ltcTexel(table, vec2(sqrt(safeUnit(dot(N, V))), roughness)).xy;
    return safeLimit(Kspec * (a.x - a.y) + a.y);
}

// An arc over its chord, 1 to pi / 2.
//   a, b  unit vectors
// bound: 6e-7 abs
float ltcArc(vec3 a, vec3 b)
{
    vec3 d = a - b;
    vec3 s = a + b;
    // The tangents of a quarter, an eighth and a sixteenth of the angle, without the chord in the numerator.
    float chord = sqrt(dot(d, d));
    float quarter = 1.0 / (2.0 + sqrt(dot(s, s)));
    float q = chord * quarter;
    float eighth = 1.0 / (1.0 + sqrt(1.0 + q * q));
    float e = q * eighth;
    float sixteenth = 1.0 / (1.0 + sqrt(1.0 + e * e));
    float t = e * sixteenth;
    float k = -t * t;
    // The arc tangent's series. The first omitted term is 2e-17 of the sum.
    float sum = 1.0 + k * (1.0 / 3.0 + k * (1.0 / 5.0 + k * (1.0 / 7.0 + k * (1.0 / 9.0 + k * (1.0 / 11.0 + k * (1.0 / 13.0
        + k * (1.0 / 15.0 + k * (1.0 / 17.0 + k * (1.0 / 19.0 + k / 21.0)))))))));
    return safeFinite(16.0 * quarter * eighth * sixteenth * sum);
}

// The part of an edge: its angle times the height of its plane's normal. 0 for opposite ends.
//   a, b  unit vectors towards the ends
// bound: 1e-6 abs
float ltcEdge(vec3 a, vec3 b)
{
    vec3 d = a - b;
    vec3 s = a + b;
    float sum = sqrt(dot(s, s));
    return sum > 0.0 ? safeFinite((d.x * s.y - d.y * s.x) / sum * ltcArc(a, b)) : 0.0;
}

// E of a flat convex light with corners, as seen from both sides: 0 to 1. Light below the horizon is cut off.
//   corners  in the order of its rim, in the frame    count  of them, limited to 3 to 16
//   turn  > 0 if they go around counterclockwise, as the shaded point sees them
// bound: 2e-6 abs, a sum over the edges
float ltcPolygon(vec3[16] corners, int count, float turn)
{
    int n = clamp(count, 3, 16);
    vec3 leaves = vec3(0.0);
    vec3 enters = vec3(0.0);
    float sum = 0.0;
    vec3 a = safeNormalize(corners[n - 1]);
    for (int i = 0; i < n; ++i) {
        vec3 b = safeNormalize(corners[i]);
        if (a.z > 0.0 || b.z > 0.0) {
            vec3 from = a;
            vec3 to = b;
            if (!(a.z > 0.0 && b.z > 0.0)) {
                // Where the edge meets the horizon.
                vec3 meets = safeNormalize(vec3(abs(b.z) * a.xy + abs(a.z) * b.xy, 0.0));
                if (a.z > 0.0)
                    to = leaves = meets;
                else
                    from = enters = meets;
            }
            sum += ltcEdge(from, to);
        }
        a = b;
    }
    // The cut along the horizon goes around as the corners do, even where it is half of a turn.
    float cut = length(leaves - enters) * ltcArc(leaves, enters);
    return safeUnit(abs(sum + (turn > 0.0 ? cut : -cut)) / radians(360.0));
}

// How three vectors turn: the volume between their directions.
//   a, b, c  vectors
// bound: 4e-7 abs
float ltcTurn(vec3 a, vec3 b, vec3 c)
{
    return dot(safeNormalize(a), cross(safeNormalize(b), safeNormalize(c)));
}

// E of a rectangle, or of any parallelogram.
//   to  of ltcFrame() for diffuse reflection, of ltcMatrix() for `ggx`    center  of the light, from the shaded point
//   x, y  from there to the middles of two sides
// bound: 4e-6 abs, a sum over the edges
float ltcRectangle(mat3 to, vec3 center, vec3 x, vec3 y)
{
    vec3 corners[16];
    for (int i = 0; i < 16; ++i)
        corners[i] = vec3(0.0);
    // With the middles of the sides, which a point near a long side needs.
    corners[0] = safeFinite(to * safeNormalize(safeLimit(center - x - y)));
    corners[1] = safeFinite(to * safeNormalize(safeLimit(center - y)));
    corners[2] = safeFinite(to * safeNormalize(safeLimit(center + x - y)));
    corners[3] = safeFinite(to * safeNormalize(safeLimit(center + x)));
    corners[4] = safeFinite(to * safeNormalize(safeLimit(center + x + y)));
    corners[5] = safeFinite(to * safeNormalize(safeLimit(center + y)));
    corners[6] = safeFinite(to * safeNormalize(safeLimit(center - x + y)));
    corners[7] = safeFinite(to * safeNormalize(safeLimit(center - x)));
    return ltcPolygon(corners, 8, ltcTurn(center, x, y));
}

// E of a disk, or of any ellipse.
//   to, center  as for a rectangle    x, y  from there to the rim, at right angles for a disk
// bound: 4e-6 abs, a sum over the edges
float ltcDisk(mat3 to, vec3 center, vec3 x, vec3 y)
{
    // A sixteenth of a turn, and how far out corners are for the area of a disk.
    float c = 0.5 * sqrt(2.0 + sqrt(2.0));
    float s = 0.5 * sqrt(2.0 - sqrt(2.0));
    vec2 at = vec2(sqrt(radians(22.5) / s), 0.0);
    vec3 corners[16];
    for (int i = 0; i < 16; ++i) {
        corners[i] = safeFinite(to * safeNormalize(safeFinite(center + (at.x * x + at.y * y))));
        at = vec2(c * at.x - s * at.y, s * at.x + c * at.y);
    }
    return ltcPolygon(corners, 16, ltcTurn(center, x, y));
}

// E of a sphere, by the disk that it looks like. 1 inside of it.
//   to, center  as for a rectangle    radius  limited to >= 0
// bound: 4e-6 abs, a sum over the edges
float ltcSphere(mat3 to, vec3 center, float radius)
{
    float d = safeLength(center);
    float r = max(radius, 0.0);
    if (!(d > r))
        return 1.0;
    vec3 axis = safeNormalize(center);
    float sine = r / d;
    float cosine = sqrt((1.0 - sine) * (1.0 + sine));
    vec3 x = sine * safeNormalize(abs(axis.x) < 0.5 ? vec3(0.0, axis.z, -axis.y) : vec3(-axis.z, 0.0, axis.x));
    return ltcDisk(to, cosine * axis, x, cross(axis, x));
}

// E of a tube with flat ends, by its outline: the lines where sight touches it, and of each rim the part that bounds it, in four or eight
// edges of its true area. 1 inside of it. Up to a radius of 0.9 of the axis's distance, E is within 0.002; nearer to the axis, the edges of
// the rims show, by about 0.01.
//   to  as for a rectangle    a, b  the ends, from the shaded point    radius  limited to >= 0
// bound: 3e-5 abs, the axis near a tube that ends at the point
float ltcTube(mat3 to, vec3 a, vec3 b, float radius)
{
    float scale = safeScale(max(max(safeExtent(a), safeExtent(b)), abs(radius)));
    vec3 p = scale * a;
    vec3 q = scale * b;
    float r = scale * max(radius, 0.0);
    vec3 along = safeNormalize(q - p);
    // Where the ends are, from the foot of the point on the axis.
    vec2 ends = vec2(dot(along, p), dot(along, q));
    if (!(r > 0.0 && ends.x < ends.y))
        return 0.0;
    vec3 side = cross(along, safeExtent(p) < safeExtent(q) ? p : q);
    float d = safeLength(side);
    if (!(d > r)) {
        if (ends.x <= 0.0 && ends.y >= 0.0)
            return 1.0;
        // One end hides the rest.
        vec3 x = r * safeNormalize(abs(along.x) < 0.5 ? vec3(0.0, along.z, -along.y) : vec3(-along.z, 0.0, along.x));
        return ltcDisk(to, ends.x > 0.0 ? p : q, x, cross(along, x));
    }
    side = side / d;
    // From the axis to the point.
    vec3 up = cross(along, side);
    float sine = r / d;
    float cosine = sqrt((1.0 - sine) * (1.0 + sine));
    vec2 touch = cosine * vec2(-d * cosine, r);
    // Half of the angle from there to where sight touches the tube.
    vec2 turn = sqrt(vec2(0.5 + 0.5 * sine, 0.5 - 0.5 * sine));
    vec3 corners[16];
    for (int i = 0; i < 16; ++i)
        corners[i] = vec3(0.0);
    int n = 0;
    for (int end = 0; end < 2; ++end) {
        // The first end from one line to the other, the second back.
        float way = end == 0 ? 1.0 : -1.0;
        float height = end == 0 ? ends.x : ends.y;
        // The rim around an end that is seen is the far one.
        bool isSeen = way * height > 0.0;
        vec2 part = turn;
        if (isSeen) {
            float c = sqrt(0.5 + 0.5 * turn.y);
            part = vec2(c, 0.5 * turn.x / c);
        }
        int last = isSeen ? 8 : 4;
        // How far out the corners between both lines are for the area of the rim's segment.
        float arc = ltcArc(vec3(part, 0.0), vec3(part.x, -part.y, 0.0));
        float wide = isSeen ? (sqrt(1.0 + 48.0 * arc) - 1.0) / 6.0 : 0.5 * (sqrt(1.0 + 8.0 * arc) - 1.0);
        float s = isSeen ? -way * part.y : way * part.y;
        vec2 at = vec2(sine, -way * cosine);
        for (int i = 0; i <= last; ++i) {
            vec2 place = wide * r * at - vec2(d, 0.0);
            if (i == 0)
                place = vec2(touch.x, -way * touch.y);
            else if (i == last)
                place = vec2(touch.x, way * touch.y);
            corners[n] = safeFinite(to * safeNormalize(height * along + place.x * up + place.y * side));
            at = vec2(part.x * at.x - s * at.y, s * at.x + part.x * at.y);
            n++;
        }
        // Between the ends, where the line is nearest.
        corners[n] = safeFinite(to * safeNormalize(clamp(0.0, ends.x, ends.y) * along + touch.x * up + way * touch.y * side));
        n++;
    }
    return ltcPolygon(corners, n, 1.0);
}

#endif
