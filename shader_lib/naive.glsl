// name: naive
// kind: reference
// equation: (82) to (101), letter by letter
// source: textbook and article
//
// The equations as they are printed, with no thought for rounding, range or poles: to measure what the stable forms
// of the other modules are worth. Do not draw with them.
#ifndef GLISTEN_NAIVE
#define GLISTEN_NAIVE

// (82)
vec3 naiveLambertUnclamped(vec3 N, vec3 L, vec3 Kdiff, vec3 Ldiff) { return dot(N, L) * Kdiff * Ldiff; }

// (83)
vec3 naiveLambert(vec3 N, vec3 L, vec3 Kdiff, vec3 Ldiff) { return max(dot(N, L), 0.0) * Kdiff * Ldiff; }

// (84)
vec3 naiveMirror(vec3 N, vec3 L) { return 2.0 * dot(N, L) * N - L; }

// (86)
float naivePhong(vec3 N, vec3 L, vec3 V, float k) { return pow(max(dot(naiveMirror(N, L), V), 0.0), k); }

// (87)
vec3 naiveHalf(vec3 L, vec3 V) { return (L + V) / length(L + V); }

// (89)
float naiveBlinnPhong(vec3 N, vec3 L, vec3 V, float k) { return pow(max(dot(N, naiveHalf(L, V)), 0.0), k); }

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

// The article's two half spheres.
vec3 naiveHemisphere(vec3 N, vec3 A, vec3 sky, vec3 ground)
{
    return 0.5 * (1.0 + dot(N, A)) * sky + 0.5 * (1.0 - dot(N, A)) * ground;
}

#endif
