//! [`literal`]: the naive form of a function: the equation as the documents print it, or as one writes it without thought.
//!
//! *In:* a function of the library. *Out:* GLSL in terms of its parameters. *Holds:* functions without a naive form that
//! differs (limits, constants, lookups) have none.

/// The naive form of a function, by its signature.
pub(super) fn literal(signature: &str) -> Option<&'static str> {
    LITERAL.iter().find(|(known, _)| *known == signature).map(|(_, form)| *form)
}

static LITERAL: &[(&str, &str)] = &[
    ("ambient(vec3,vec3)", "Kamb * Lamb"),
    ("lightDistance(vec3,vec3)", "naiveDistance(Pl, P)"),
    ("attenuationInverseSquare(float)", "naiveInverseSquare(r)"),
    ("attenuation(float,vec3)", "naiveAttenuation(r, s)"),
    ("halfVector(vec3,vec3)", "naiveHalf(L, V)"),
    ("blinnPhongFactor(vec3,vec3,vec3,float)", "naiveBlinnPhong(N, L, V, shininess)"),
    ("blinnPhong(vec3,vec3,vec3,float,vec3,vec3)", "naiveBlinnPhong(N, L, V, shininess) * Kspec * Lspec"),
    ("halfLambertFactor(vec3,vec3)", "naiveHalfRange(N, L)"),
    ("halfLambertDot(vec3,vec4)", "dot(vec4(N, 1.0), c0)"),
    ("halfLambert(vec3,vec3,vec3,vec3)", "naiveHalfRange(N, L) * Kdiff * Ldiff"),
    ("hemisphereWeight(vec3,vec3)", "0.5 * (1.0 + dot(N, axis))"),
    ("hemisphere(vec3,vec3,vec3,vec3)", "naiveHemisphere(N, axis, sky, ground)"),
    (
        "hemisphereDirectional(vec3,vec3,vec3,vec3,vec3,vec3,vec3)",
        "Kdiff * (max(dot(N, L), 0.0) * Ldiff + naiveHemisphere(N, axis, sky, ground))",
    ),
    (
        "hemisphereSpecular(vec3,vec3,vec3,vec3,vec3,vec3,vec3,vec3)",
        "Kdiff * (max(dot(N, L), 0.0) * Ldiff + naiveHemisphere(N, axis, sky, ground)) + Ispec",
    ),
    ("illumination(vec3,vec3,vec3)", "Iamb + Idiff + Ispec"),
    ("illumination(vec3,vec3,vec3,float)", "Iamb + d * (Idiff + Ispec)"),
    ("illumination(vec3,vec3,vec3,float,float)", "cspot * (Iamb + d * (Idiff + Ispec))"),
    ("background(vec3,vec3,vec3)", "Kamb * Lglob + Lemi"),
    ("barycentric(vec2,vec2,vec2,vec2)", "naiveBarycentric(P, P0, P1, P2)"),
    ("interpolateLinear(vec2,vec4,vec4,vec4)", "(1.0 - uv.x - uv.y) * C0 + uv.x * C1 + uv.y * C2"),
    (
        "perspectiveWeights(vec2,vec3)",
        "vec3((1.0 - uv.x - uv.y) / w.x, uv.x / w.y, uv.y / w.z) / ((1.0 - uv.x - uv.y) / w.x + uv.x / w.y + uv.y / w.z)",
    ),
    ("interpolatePerspective(vec2,vec3,vec4,vec4,vec4)", "naivePerspective(uv, w, C0, C1, C2)"),
    ("segmentPoint(float,vec2,vec2)", "naiveSegment(t, a, b)"),
    ("lambertFactor(vec3,vec3)", "max(dot(N, L), 0.0)"),
    ("lambert(vec3,vec3,vec3,vec3)", "naiveLambert(N, L, Kdiff, Ldiff)"),
    ("lambertUnclamped(vec3,vec3,vec3,vec3)", "naiveLambertUnclamped(N, L, Kdiff, Ldiff)"),
    (
        "lightVector(Light,vec3)",
        "light.kind == LIGHT_DIRECTIONAL ? normalize(-light.direction) : normalize(light.position - P)",
    ),
    (
        "lightAttenuation(Light,vec3)",
        "light.kind == LIGHT_DIRECTIONAL ? 1.0 : naiveAttenuation(naiveDistance(light.position, P), light.attenuation)",
    ),
    (
        "lightBeam(Light,vec3)",
        "light.kind == LIGHT_SPOT ? naiveSpot(L, normalize(light.direction), light.exponent) : 1.0",
    ),
    ("lightDome(Light,vec3)", "naiveHemisphere(N, normalize(light.direction), light.diffuse, light.ambient)"),
    ("lutCoordinate(float,float)", "(x * (n - 1.0) + 0.5) / n"),
    ("normalMatrix(mat4)", "transpose(inverse(mat3(model)))"),
    ("transformNormal(mat3,vec3)", "normalize(matrix * normal)"),
    ("outlineDirection(vec4,vec4)", "vec3(normal.xy * position.w - position.xy * normal.w, 0.0)"),
    (
        "outlinePosition(vec4,vec3,float,float)",
        "vec4(position.xy + width * normalize(direction.xy) * position.w, position.z - push * position.w, position.w)",
    ),
    ("mirrorDirection(vec3,vec3)", "naiveMirror(N, L)"),
    ("phongFactor(vec3,vec3,vec3,float)", "naivePhong(N, L, V, shininess)"),
    ("phong(vec3,vec3,vec3,float,vec3,vec3)", "naivePhong(N, L, V, shininess) * Kspec * Lspec"),
    ("quartic(float)", "pow(max(x, 0.0), 4.0)"),
    ("quarticFactor(vec3,vec3,vec3)", "naivePhong(N, L, V, 4.0)"),
    ("safeLength(vec3)", "length(v)"),
    ("safeNormalize(vec3)", "normalize(v)"),
    ("safeLogOneMinus(float)", "log(1.0 - d)"),
    ("safePowOneMinus(float,float)", "pow(1.0 - d, k)"),
    ("safePow(float,float)", "naivePower(x, k)"),
    ("safeOneMinusCos(vec3,vec3)", "1.0 - dot(a, b)"),
    ("safeCosPow(vec3,vec3,float)", "naivePower(dot(a, b), k)"),
    ("schlick(float,float)", "naiveSchlick(t, shininess)"),
    ("schlickBetween(vec3,vec3,float)", "naiveSchlick(dot(a, b), shininess)"),
    ("schlickBlinnFactor(vec3,vec3,vec3,float)", "naiveSchlick(max(dot(N, naiveHalf(L, V)), 0.0), shininess)"),
    ("schlickPhongFactor(vec3,vec3,vec3,float)", "naiveSchlick(max(dot(naiveMirror(N, L), V), 0.0), shininess)"),
    ("spotFactor(vec3,vec3,float)", "naiveSpot(L, Ldir, exponent)"),
    ("thresholdStep(float,float)", "naiveThreshold(c, t)"),
    ("thresholdFactor(vec3,vec3,vec3,float)", "naiveThreshold(dot(N, naiveHalf(L, V)), t)"),
    ("threshold(vec3,vec3,vec3,float,vec3,vec3)", "naiveThreshold(dot(N, naiveHalf(L, V)), t) * Kspec * Lspec"),
    (
        "toonRamp(vec3,vec3,float,float,vec3,vec3)",
        "mix(dark, lit, smoothstep(edge - width, edge + width, naiveHalfRange(N, L)))",
    ),
    ("shadowDistance(float,vec2)", "range.x * range.y / (range.y - depth * (range.y - range.x))"),
    ("transmissionLeft(vec3)", "exp(-depth)"),
    ("transmissionPath(vec3,vec3,float)", "sqrt(1.0 - (1.0 - max(dot(N, V), 0.0) * max(dot(N, V), 0.0)) / (n * n))"),
    (
        "transmissionSphere(vec3,vec3,float)",
        "refract(refract(-V, N, 1.0 / n), 2.0 * dot(refract(-V, N, 1.0 / n), N) * N - N, n)",
    ),
    ("environmentPlace(vec3)", "naiveOctahedron(d)"),
    (
        "environmentDominant(vec3,vec3,float)",
        "mix(N, naiveMirror(N, V), (1.0 - roughness * roughness) * (sqrt(1.0 - roughness * roughness) + roughness * roughness))",
    ),
    ("srgbEncode(float)", "linear <= 0.0031308 ? 12.92 * linear : 1.055 * pow(linear, 1.0 / 2.4) - 0.055"),
    ("srgbDecode(float)", "encoded <= 0.04045 ? encoded / 12.92 : pow((encoded + 0.055) / 1.055, 2.4)"),
    ("fresnelSchlick(float,vec3,vec3)", "F0 + (F90 - F0) * pow(1.0 - cosine, 5.0)"),
    ("fresnelNormal(float)", "pow((n - 1.0) / (n + 1.0), 2.0)"),
    (
        "fresnelDielectric(float,float)",
        "0.5 * (pow((cosine - sqrt(n * n - 1.0 + cosine * cosine)) / (cosine + sqrt(n * n - 1.0 + cosine * cosine)), 2.0) + \
         pow((n * n * cosine - sqrt(n * n - 1.0 + cosine * cosine)) / (n * n * cosine + sqrt(n * n - 1.0 + cosine * cosine)), 2.0))",
    ),
    (
        "ggxDistribution(vec3,vec3,float)",
        "pow(alpha / (dot(N, H) * dot(N, H) * (alpha * alpha - 1.0) + 1.0), 2.0) / 3.14159265",
    ),
    (
        "ggxVisibility(float,float,float)",
        "0.5 / (NL * sqrt(NV * NV * (1.0 - alpha * alpha) + alpha * alpha) + NV * sqrt(NL * NL * (1.0 - alpha * alpha) + alpha * alpha))",
    ),
    (
        "ggxFactor(vec3,vec3,vec3,float)",
        "pow(alpha / (dot(N, naiveHalf(L, V)) * dot(N, naiveHalf(L, V)) * (alpha * alpha - 1.0) + 1.0), 2.0) * max(dot(N, L), 0.0) * \
         ggxVisibility(max(dot(N, L), 0.0), max(dot(N, V), 0.0), alpha)",
    ),
    (
        "ggxDistribution(vec3,vec3,vec3,vec2)",
        "1.0 / (3.14159265 * alpha.x * alpha.y * pow(dot(T, H) * dot(T, H) / (alpha.x * alpha.x) + \
         dot(cross(N, T), H) * dot(cross(N, T), H) / (alpha.y * alpha.y) + dot(N, H) * dot(N, H), 2.0))",
    ),
    ("ggxBrushed(float,float)", "vec2(mix(roughness * roughness, 1.0, strength * strength), roughness * roughness)"),
    (
        "iridescenceNormal(vec3,float)",
        "clamp((F - pow(1.0 - cosine, 5.0)) / (1.0 - pow(1.0 - cosine, 5.0)), vec3(0.0), vec3(1.0))",
    ),
    (
        "beckmannDistribution(vec3,vec3,float)",
        "exp((dot(N, H) * dot(N, H) - 1.0) / (alpha * alpha * dot(N, H) * dot(N, H))) / (3.14159265 * alpha * alpha * pow(dot(N, H), 4.0))",
    ),
    (
        "sheenDistribution(vec3,vec3,float)",
        "(2.0 + 1.0 / alpha) * pow(sqrt(1.0 - dot(N, H) * dot(N, H)), 1.0 / alpha) / 6.2831853",
    ),
    (
        "sheenFactor(vec3,vec3,vec3,float)",
        "max(dot(N, L), 0.0) * (2.0 + 1.0 / alpha) * pow(sqrt(1.0 - dot(N, naiveHalf(L, V)) * dot(N, naiveHalf(L, V))), 1.0 / alpha) / 8.0 / \
         (max(dot(N, L), 0.0) + max(dot(N, V), 0.0) - max(dot(N, L), 0.0) * max(dot(N, V), 0.0))",
    ),
    (
        "wardFactor(vec3,vec3,vec3,vec3,vec2)",
        "max(dot(N, L), 0.0) * exp(-(pow(dot(L + V, T) / alpha.x, 2.0) + pow(dot(L + V, cross(N, T)) / alpha.y, 2.0)) / \
         pow(dot(L + V, N), 2.0)) / (alpha.x * alpha.y) * dot(L + V, L + V) / pow(dot(L + V, N), 4.0)",
    ),
    (
        "orenNayarFactor(vec3,vec3,vec3,float)",
        "dot(N, L) * (1.0 - 0.5 * sigma * sigma / (sigma * sigma + 0.33) + 0.45 * sigma * sigma / (sigma * sigma + 0.09) * \
         max(dot(normalize(L - N * dot(N, L)), normalize(V - N * dot(N, V))), 0.0) * \
         sin(max(acos(dot(N, L)), acos(dot(N, V)))) * tan(min(acos(dot(N, L)), acos(dot(N, V)))))",
    ),
    ("eonFactor(vec3,vec3,vec3,vec3,float)", "naiveEon(N, L, V, Kdiff, roughness)"),
    (
        "burleyFactor(vec3,vec3,vec3,float)",
        "max(dot(N, L), 0.0) * (1.0 + (2.0 * roughness * pow(dot(L, naiveHalf(L, V)), 2.0) - 0.5) * pow(1.0 - max(dot(N, L), 0.0), 5.0)) * \
         (1.0 + (2.0 * roughness * pow(dot(L, naiveHalf(L, V)), 2.0) - 0.5) * pow(1.0 - max(dot(N, V), 0.0), 5.0))",
    ),
    ("tonemapReinhard(vec3,float)", "color * (1.0 + color / (white * white)) / (1.0 + color)"),
    (
        "tonemapHableCurve(vec3)",
        "(color * (0.15 * color + 0.05) + 0.004) / (color * (0.15 * color + 0.5) + 0.06) - 0.02 / 0.3",
    ),
    (
        "tonemapNarkowicz(vec3)",
        "clamp((color * (2.51 * color + 0.03)) / (color * (2.43 * color + 0.59) + 0.14), vec3(0.0), vec3(1.0))",
    ),
    (
        "normalizedBlinnFactor(vec3,vec3,vec3,float)",
        "(shininess + 8.0) / 8.0 * max(dot(N, L), 0.0) * naiveBlinnPhong(N, L, V, shininess)",
    ),
    (
        "normalizedPhongFactor(vec3,vec3,vec3,float)",
        "(shininess + 2.0) / 2.0 * max(dot(N, L), 0.0) * naivePhong(N, L, V, shininess)",
    ),
    ("wrapFactor(vec3,vec3,float)", "max((dot(N, L) + wrap) / (1.0 + wrap), 0.0)"),
    ("minnaertFactor(vec3,vec3,vec3,float)", "pow(max(dot(N, L), 0.0), k) * pow(max(dot(N, V), 0.0), k - 1.0)"),
    ("rimFactor(vec3,vec3,float)", "pow(1.0 - dot(N, V), k)"),
    ("fogMean(float)", "(1.0 - exp(-x)) / x"),
    ("fogFactor(float,float)", "exp(-r * density)"),
    ("fogFactorSquared(float,float)", "exp(-pow(r * density, 2.0))"),
    (
        "fogFactor(float,vec3,float,float,float)",
        "exp(-density * exp(-falloff * height) * (1.0 - exp(-falloff * r * direction.y)) / (falloff * direction.y))",
    ),
    (
        "sdfSegment(vec2,vec2,vec2,float)",
        "length(p - a - clamp(dot(p - a, b - a) / dot(b - a, b - a), 0.0, 1.0) * (b - a)) - radius",
    ),
    ("sdfBlend(float,float,float)", "min(a, b) - pow(max(k - abs(a - b), 0.0) / k, 2.0) * k * 0.25"),
    ("punctualFalloff(float,float)", "pow(clamp(1.0 - pow(r / range, 4.0), 0.0, 1.0), 2.0) / (r * r)"),
    (
        "punctualCone(vec3,vec3,float,float)",
        "pow(clamp((dot(-L, Ldir) - (1.0 - outer)) / ((1.0 - inner) - (1.0 - outer)), 0.0, 1.0), 2.0)",
    ),
    (
        "areaSphere(vec3,float,vec3)",
        "normalize(center + (dot(center, R) * R - center) * clamp(radius / length(dot(center, R) * R - center), 0.0, 1.0))",
    ),
    ("ltcEdge(vec3,vec3)", "naiveEdge(a, b)"),
    ("triplanarWeights(vec3,float)", "pow(abs(N), vec3(sharpness)) / dot(pow(abs(N), vec3(sharpness)), vec3(1.0))"),
    ("colorCubeRoot(float)", "pow(x, 1.0 / 3.0)"),
    (
        "outlinePosition(vec4,vec3,float,float,float)",
        "vec4(position.xy + width * normalize(vec2(aspect * direction.x, direction.y)) / vec2(aspect, 1.0) * position.w, \
         position.z - push * position.w, position.w)",
    ),
];
