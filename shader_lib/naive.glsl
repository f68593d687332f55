// name: naive
// kind: reference
// equation: (82) to (108), literally; EON, and a dielectric over a diffuse body, as others publish them
// source: textbook and article; Portsmouth, Kutz and Hill, EON, JCGT 14(1), 2025, listing 1; three.js, lights_physical_pars_fragment
// stability: none: as in the literal equations
//
// The equations as printed, regardless of rounding, range and poles, to measure the value of the stable forms in the
// other modules. Do not draw with them. K and L are omitted in all but (82) and (83). Factors of newer models are f times pi and N.L.
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

// The albedo of a rough surface in closed form, E_FON_exact of listing 1: 0/0 at a right angle, NaN where rounding takes the cosine above 1.
float naiveEonExact(float mu, float r)
{
    float A = 1.0 / (1.0 + (0.5 - 2.0 / (3.0 * radians(180.0))) * r);
    float s = sqrt(1.0 - mu * mu);
    float G = s * (acos(mu) - s * mu) + (2.0 / 3.0) * ((s / mu) * (1.0 - s * s * s) - s);
    return A + (r * A / radians(180.0)) * G;
}

// f_EON of listing 1 with that albedo, times pi and N.L.
vec3 naiveEon(vec3 N, vec3 L, vec3 V, vec3 rho, float r)
{
    float c1 = 0.5 - 2.0 / (3.0 * radians(180.0));
    float c2 = 2.0 / 3.0 - 28.0 / (15.0 * radians(180.0));
    float mui = dot(N, L);
    float muo = dot(N, V);
    float s = dot(L, V) - mui * muo;
    float st = s > 0.0 ? s / max(mui, muo) : s;
    float A = 1.0 / (1.0 + c1 * r);
    vec3 single = rho * A * (1.0 + r * st);
    float mean = A * (1.0 + c2 * r);
    vec3 again = rho * rho * mean / (1.0 - rho * (1.0 - mean));
    float lost = max(1.0e-7, 1.0 - naiveEonExact(muo, r)) * max(1.0e-7, 1.0 - naiveEonExact(mui, r));
    return mui * (single + again * lost / max(1.0e-7, 1.0 - mean));
}

// The direct light of MeshStandardMaterial of three.js (RE_Direct_Physical) without metal, for a lamp of intensity pi: the body gets all of
// the light, as if nothing were mirrored.
vec3 naivePlastic(vec3 N, vec3 L, vec3 V, vec3 Kdiff, float F0, float alpha)
{
    vec3 H = naiveHalf(L, V);
    float a2 = alpha * alpha;
    float NL = clamp(dot(N, L), 0.0, 1.0);
    float NV = clamp(dot(N, V), 0.0, 1.0);
    float NH = clamp(dot(N, H), 0.0, 1.0);
    float F = F0 + (1.0 - F0) * pow(1.0 - clamp(dot(V, H), 0.0, 1.0), 5.0);
    float d = NL * sqrt(a2 + (1.0 - a2) * NV * NV) + NV * sqrt(a2 + (1.0 - a2) * NL * NL);
    float q = NH * NH * (a2 - 1.0) + 1.0;
    return NL * (Kdiff + F * (0.5 / max(d, 1.0e-6)) * a2 / (q * q));
}

// White fibers over a white body as three.js has them (sheenEnergyComp): the fibers return 0.157 of the light, whatever their roughness.
float naiveSheen(vec3 N, vec3 L, vec3 V, float alpha)
{
    vec3 H = naiveHalf(L, V);
    float NL = clamp(dot(N, L), 0.0, 1.0);
    float NV = clamp(dot(N, V), 0.0, 1.0);
    float NH = clamp(dot(N, H), 0.0, 1.0);
    float D = (2.0 + 1.0 / alpha) * pow(max(1.0 - NH * NH, 0.0078125), 0.5 / alpha) / 2.0;
    return NL * (1.0 - 0.157 + D * clamp(1.0 / (4.0 * (NL + NV - NL * NV)), 0.0, 1.0));
}

#endif
