//! Lint rules of the group `numerics`: infinities, values that are not a number, lost precision.

use super::super::Example::{Fragment, Program, Text, Vertex};

lints! {
    NON_FINITE_CONSTANT = "L0007" "non-finite-constant" Warning Numerics No "0.1.0" "GLSL 1.50 §4.1.4"
        "A constant operation yields an infinity or NaN, from a division by zero, an overflow, or a function \
         outside its domain. GLSL leaves the value undefined, and WGSL rejects it."
        why "The constant is not what arithmetic says, and one of the targets refuses it."
        bad Fragment("out vec4 c; void main() { c = vec4(1.0 / 0.0); }"),
        good Fragment("out vec4 c; void main() { c = vec4(3.4e38); }");
    INTEGER_DIVISION_BY_ZERO = "L0008" "integer-division-by-zero" Warning Numerics No "0.1.0" "GLSL 1.50 §5.9"
        "An integer is divided by a constant zero. The value is undefined."
        why "The value is undefined."
        bad Fragment("uniform int n; out vec4 c; void main() { c = vec4(n / 0); }"),
        good Fragment("uniform int n; out vec4 c; void main() { c = vec4(n / 2); }");
    POW_OF_NEGATIVE = "L0009" "pow-of-negative" Warning Numerics No "0.1.0" "GLSL 1.50 §8.2"
        "`pow` of a negative base is undefined, also for whole exponents: drivers compute it with a logarithm and \
         return NaN."
        why "The base is known, so there is no doubt."
        bad Fragment("in float k; out vec4 c; void main() { c = vec4(pow(-2.0, k)); }"),
        good Fragment("in float k; out vec4 c; void main() { c = vec4(pow(2.0, k)); }");
    FLOAT_EQUALITY = "L0026" "float-equality" Off Numerics No "0.1.0" "GLSL 1.50 §4.1.4"
        "`==` or `!=` compares floats that were computed. Rounding, which differs between machines, decides the \
         result."
        why
        "Equal inputs, and whole numbers in floats, are compared in this way, so it is off. Comparisons with \
         constants, and of rounded or clamped values, are left out."
        bad Fragment(
            "in float x; in float y; out vec4 c; void main() { c = vec4(x * y == x + y); }"),
        good Fragment(
            "in float x; in float y; out vec4 c; void main() { c = vec4(abs(x * y - x - y) < 1e-4); }");
    FLOAT_LOOP_COUNTER = "L0027" "float-loop-counter" Note Numerics No "0.1.0" "GLSL 1.50 §6.3"
        "A loop counts in steps that a float does not have exactly. Rounding adds up and decides how often the loop \
         runs."
        why
        "Steps that are exact in binary, such as 1.0 or 0.25, are left out, and so are ends that are no whole number of steps away, \
         such as 1.0 in steps of 0.15: any rounding gives seven rounds."
        bad Fragment(
            "out vec4 c; void main() { c = vec4(0.0); for (float t = 0.0; t < 1.0; t += 0.1) c += t; }"),
        good Fragment(
            "out vec4 c; void main() { c = vec4(0.0); for (int i = 0; i < 10; i++) c += float(i) * 0.1; }");
    POW_MAYBE_NEGATIVE = "L0028" "pow-maybe-negative" Warning Numerics Unsafe "0.1.0" "GLSL 1.50 §8.2"
        "The base of `pow` is negative for some input: a cosine that is not clamped, a sine, a component of a \
         direction. `pow` is undefined then, and drivers return NaN."
        why
        "The range of the base must be known and be reached; what is clamped, or may be guarded by a condition, is \
         left out."
        bad Fragment(
            "in vec3 n; in vec3 l; out vec4 c; void main() { c = vec4(pow(dot(normalize(n), normalize(l)), 8.0)); }"),
        good Fragment(
            "in vec3 n; in vec3 l; out vec4 c; void main() { c = vec4(pow(max(dot(normalize(n), normalize(l)), 0.0), \
             8.0)); }");
    SQRT_MAYBE_NEGATIVE = "L0029" "sqrt-maybe-negative" Warning Numerics Unsafe "0.1.0" "GLSL 1.50 §8.2"
        "A root is taken of a number that is negative for some input, also by rounding alone: `1.0 - x * x` of a \
         cosine `x` can be less than zero. The root is NaN then."
        why
        "The range must be known and be reached; what is clamped, or may be guarded by a condition, is left out."
        bad Fragment(
            "in vec3 n; in vec3 l; out vec4 c; void main() { float x = dot(normalize(n), normalize(l)); c = \
             vec4(sqrt(1.0 - x * x)); }"),
        good Fragment(
            "in vec3 n; in vec3 l; out vec4 c; void main() { float x = dot(normalize(n), normalize(l)); c = \
             vec4(sqrt(max(1.0 - x * x, 0.0))); }");
    ACOS_BEYOND_ONE = "L0030" "acos-beyond-one" Warning Numerics Unsafe "0.1.0" "GLSL 1.50 §8.1"
        "The product of two directions of length 1 can be 1.0000001, because lengths are rounded. `acos` and `asin` \
         are undefined there, and drivers return NaN."
        why
        "The range must be known and be reached; what is clamped, or may be guarded by a condition, is left out."
        bad Fragment(
            "in vec3 a; in vec3 b; out vec4 c; void main() { c = vec4(acos(dot(normalize(a), normalize(b)))); }"),
        good Fragment(
            "in vec3 a; in vec3 b; out vec4 c; void main() { c = vec4(acos(clamp(dot(normalize(a), normalize(b)), \
             -1.0, 1.0))); }");
    LOG_OF_ZERO = "L0031" "log-of-zero" Warning Numerics Unsafe "0.1.0" "GLSL 1.50 §8.2"
        "The argument of a logarithm is zero or less for some input, where the logarithm is infinite or undefined."
        why
        "The range must be known and be reached; what is clamped above zero, or may be guarded by a condition, is \
         left out."
        bad Fragment(
            "in vec3 n; in vec3 l; out vec4 c; void main() { c = vec4(log(max(dot(normalize(n), normalize(l)), \
             0.0))); }"),
        good Fragment(
            "in vec3 n; in vec3 l; out vec4 c; void main() { c = vec4(log(max(dot(normalize(n), normalize(l)), \
             1e-6))); }");
    DIVISION_BY_CLAMPED_ZERO = "L0032" "division-by-clamped-zero" Warning Numerics Unsafe "0.1.0" "GLSL 1.50 §5.9"
        "A number is divided by one that was clamped at zero, so that zero is its least value: `1.0 / max(dot(n, v), \
         0.0)`. The quotient is infinite or NaN at every grazing angle."
        why
        "The clamp shows that zero occurs. What a condition may guard is left out."
        bad Fragment(
            "in vec3 n; in vec3 v; out vec4 c; void main() { c = vec4(1.0 / max(dot(normalize(n), normalize(v)), \
             0.0)); }"),
        good Fragment(
            "in vec3 n; in vec3 v; out vec4 c; void main() { c = vec4(1.0 / max(dot(normalize(n), normalize(v)), \
             1e-3)); }");
    NORMALIZE_OF_ZERO = "L0033" "normalize-of-zero" Warning Numerics No "0.1.0" "GLSL 1.50 §8.4"
        "A vector that is zero, always or for some input, is normalized. It has no direction, and the result is NaN."
        why
        "Only vectors that are zero by their form count: constants, `a - a`, `cross(a, a)`, vectors that are clamped \
         at zero."
        bad Fragment(
            "in vec3 n; out vec4 c; void main() { c = vec4(normalize(n - n), 1.0); }"),
        good Fragment(
            "in vec3 n; in vec3 p; out vec4 c; void main() { c = vec4(normalize(n - p), 1.0); }");
    INTERPOLATED_NORMAL = "L0034" "interpolated-normal" Note Numerics Unsafe "0.1.0" "GLSL 1.50 §4.3.6"
        "The vertex stage normalizes a vector, and the fragment stage uses what is interpolated as if it had the \
         length 1. Between the vertices it is shorter, so highlights are too dark and change shape."
        why
        "On a fine mesh the difference is small, and some shaders accept it, so it is a note. Only programs whose \
         vertex stage writes nothing but normalized values count."
        bad Program(
            "in vec4 p; in vec3 a; out vec3 normal; void main() { normal = normalize(a); gl_Position = p; }",
            "in vec3 normal; uniform vec3 light; out vec4 c; void main() { c = vec4(max(dot(normal, light), 0.0)); }"),
        good Program(
            "in vec4 p; in vec3 a; out vec3 normal; void main() { normal = normalize(a); gl_Position = p; }",
            "in vec3 normal; uniform vec3 light; out vec4 c; void main() { c = vec4(max(dot(normalize(normal), \
             light), 0.0)); }");
    UNNORMALIZED_DIRECTION = "L0035" "unnormalized-direction" Note Numerics Unsafe "0.1.0" "GLSL 1.50 §8.4"
        "A cosine is computed with the difference of two places, which is as long as their distance. The light \
         becomes brighter with the distance."
        why
        "If the length is taken anywhere in the function, the product may be divided by it, and the rule is silent. A \
         constant is not a place: `2.0 * t.xyz - 1.0` decodes a direction."
        bad Fragment(
            "in vec3 n; in vec3 p; uniform vec3 light; out vec4 c; void main() { c = vec4(max(dot(normalize(n), \
             light - p), 0.0)); }"),
        good Fragment(
            "in vec3 n; in vec3 p; uniform vec3 light; out vec4 c; void main() { c = vec4(max(dot(normalize(n), \
             normalize(light - p)), 0.0)); }");
    NORMAL_BY_MODEL_MATRIX = "L0036" "normal-by-model-matrix" Note Numerics No "0.1.0" ""
        "A normal is transformed by the 3x3 part of a model matrix. If the matrix scales directions differently, \
         normals must be transformed by the transposed inverse, or they no longer stand on their surfaces."
        why
        "Right if the host scales evenly, which the shader does not show; so it is a note."
        bad Vertex(
            "in vec4 p; in vec3 aNormal; uniform mat4 model; out vec3 n; void main() { n = mat3(model) * aNormal; \
             gl_Position = model * p; }"),
        good Vertex(
            "in vec4 p; in vec3 aNormal; uniform mat4 model; uniform mat3 normalMatrix; out vec3 n; void main() { n \
             = normalMatrix * aNormal; gl_Position = model * p; }");
    NON_FINITE_IN_RANGE = "L0074" "non-finite-in-range" Warning Numerics No "0.1.0" "GLSL 1.50 §4.1.4"
        "A value is infinite or NaN for inputs within the ranges that `[lint.ranges]` of `glisten.toml` or a comment \
         `// glisten: range(low, high)` at a declaration states. The reference ran the shader with these inputs, which the finding \
         names. Inputs without a range are given harmless values."
        why
        "It is told only where a run shows it, so it is never a guess."
        bad Text("uniform float roughness; // glisten: range(0, 1)\n.. 1.0 / roughness"),
        good Text("uniform float roughness; // glisten: range(0.01, 1)\n.. 1.0 / roughness");
    REVERSED_BOUNDS = "L0075" "reversed-bounds" Note Numerics Unsafe "0.1.0" "GLSL 1.50 §8.3"
        "The lower edge of `smoothstep` is not below the upper one, or the least value of `clamp` is above the largest. The \
         specification leaves the result undefined."
        why
        "GPUs compute the formula of `smoothstep`, which gives the reversed curve for reversed edges, and many shaders count on it; \
         so it is a note. Only bounds that are constants count."
        bad Fragment(
            "in float x; out vec4 c; void main() { c = vec4(smoothstep(1.0, 0.0, x)); }"),
        good Fragment(
            "in float x; out vec4 c; void main() { c = vec4(1.0 - smoothstep(0.0, 1.0, x)); }");
}
