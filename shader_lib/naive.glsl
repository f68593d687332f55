// name: naive
// kind: reference
// equation: (82) to (108), literally
// source: textbook and article
// stability: none: as in the literal equations
//
// The equations as printed, regardless of rounding, range and poles, to measure the value of the stable forms in the
// other modules. Do not draw with them. K and L are omitted in all but (82) and (83).
#ifndef GLISTEN_NAIVE
#define GLISTEN_NAIVE

// (82), unlimited.
vec3 naiveLambertUnclamped(vec3 N, vec3 L, vec3 Kdiff, vec3 Ldiff) { return dot(N, L) * Kdiff * Ldiff; }

// (83)
vec3 naiveLambert(vec3 N, vec3 L, vec3 Kdiff, vec3 Ldiff) { return max(dot(N, L), 0.0) * Kdiff * Ldiff; }

// (84)
vec3 naiveMirror(vec3 N, vec3 L) { return 2.0 * dot(N, L) * N - L; }

// (85), unlimited.
float naivePhongUnclamped(vec3 N, vec3 L, vec3 V, float k) { return pow(dot(naiveMirror(N, L), V), k); }

// (86)
float naivePhong(vec3 N, vec3 L, vec3 V, float k) { return pow(max(dot(naiveMirror(N, L), V), 0.0), k); }

// (87)
vec3 naiveHalf(vec3 L, vec3 V) { return (L + V) / length(L + V); }

// (88), unlimited.
float naiveBlinnPhongUnclamped(vec3 N, vec3 L, vec3 V, float k) { return pow(dot(N, naiveHalf(L, V)), k); }

// (89)
float naiveBlinnPhong(vec3 N, vec3 L, vec3 V, float k) { return pow(max(dot(N, naiveHalf(L, V)), 0.0), k); }

// The power of (86), (89) and (98) for a cosine c.
float naivePower(float c, float k) { return pow(max(c, 0.0), k); }

// (90)
float naiveSchlick(float t, float k) { return t / (k - t * k + t); }

// (91)
float naiveThreshold(float c, float t) { return ceil(max(c, 0.0) - t); }

// (94)
float naiveDistance(vec3 Pl, vec3 P) { return length(Pl - P); }

// (95)
float naiveInverseSquare(float r) { return 1.0 / (r * r); }

// (96)
float naiveAttenuation(float r, vec3 s) { return 1.0 / (s.x + s.y * r + s.z * r * r); }

// (98)
float naiveSpot(vec3 L, vec3 Ldir, float k) { return pow(max(dot(-L, Ldir), 0.0), k); }

// (105)
vec2 naiveBarycentric(vec2 P, vec2 P0, vec2 P1, vec2 P2)
{
    vec2 u = P1 - P0;
    vec2 v = P2 - P0;
    float area = u.x * v.y - v.x * u.y;
    return vec2((P.x - P0.x) * v.y - (P.y - P0.y) * v.x, (P.y - P0.y) * u.x - (P.x - P0.x) * u.y) / area;
}

// (107)
vec2 naiveSegment(float t, vec2 a, vec2 b)
{
    float z = 1.0 / (1.0 / a.y * (1.0 - t) + 1.0 / b.y * t);
    return vec2(z * (a.x / a.y * (1.0 - t) + b.x / b.y * t), z);
}

// (108)
vec4 naivePerspective(vec2 uv, vec3 w, vec4 C0, vec4 C1, vec4 C2)
{
    float b = 1.0 - uv.x - uv.y;
    return 1.0 / (b / w.x + uv.x / w.y + uv.y / w.z) * (b * C0 / w.x + uv.x * C1 / w.y + uv.y * C2 / w.z);
}

// The article's two half spheres.
vec3 naiveHemisphere(vec3 N, vec3 A, vec3 sky, vec3 ground)
{
    return 0.5 * (1.0 + dot(N, A)) * sky + 0.5 * (1.0 - dot(N, A)) * ground;
}

// Heitz et al. 2016: the integral of an edge as its arc cosine.
float naiveEdge(vec3 a, vec3 b) { return acos(dot(a, b)) * normalize(cross(a, b)).z; }

// Cigolle et al. 2014: a direction on the unfolded octahedron.
vec2 naiveOctahedron(vec3 d)
{
    vec2 p = d.xz / (abs(d.x) + abs(d.y) + abs(d.z));
    return 0.5 + 0.5 * (d.y < 0.0 ? (1.0 - abs(p.yx)) * sign(p) : p);
}

// The coordinate of the article's half-range lookup.
float naiveHalfRange(vec3 N, vec3 L) { return 0.5 * dot(N, L) + 0.5; }

#endif
