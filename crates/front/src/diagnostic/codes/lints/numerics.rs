//! Lint rules of the group `numerics`: infinities, values that are not a number, lost precision.

use super::super::Example::Fragment;

lints! {
    NON_FINITE_CONSTANT = "L0007" "non-finite-constant" Warning Numerics No "0.1.0" "GLSL 1.50 §4.1.4"
        "A constant operation yields an infinity or NaN, from a division by zero, an overflow, or a function \
         outside its domain. GLSL leaves the value undefined, and WGSL rejects it."
        why "The constant is not what arithmetic says, and one of the targets refuses it."
        bad Fragment("out vec4 c; void main() { c = vec4(1.0 / 0.0); }"),
        good Fragment("out vec4 c; void main() { c = vec4(3.4e38); }");
    DIVISION_BY_ZERO = "L0008" "integer-division-by-zero" Warning Numerics No "0.1.0" "GLSL 1.50 §5.9"
        "An integer is divided by a constant zero. The value is undefined."
        why "The value is undefined."
        bad Fragment("uniform int n; out vec4 c; void main() { c = vec4(n / 0); }"),
        good Fragment("uniform int n; out vec4 c; void main() { c = vec4(n / 2); }");
    POW_OF_NEGATIVE = "L0009" "pow-of-negative" Warning Numerics No "0.1.0" "GLSL 1.50 §8.2"
        "`pow` of a negative base is undefined, also for whole exponents: drivers compute it with a logarithm and \
         return NaN."
        why "The base is known, so there is no doubt."
        bad Fragment("uniform float k; out vec4 c; void main() { c = vec4(pow(-2.0, k)); }"),
        good Fragment("uniform float k; out vec4 c; void main() { c = vec4(pow(2.0, k)); }");
    FLOAT_EQUALITY = "L0026" "float-equality" Note Numerics No "0.1.0" "GLSL 1.50 §4.1.4"
        "`==` or `!=` compares floats that were computed. Rounding, which differs between machines, decides the \
         result."
        why
        "Comparisons with constants, and of rounded or clamped values, are often exact and left out."
        bad Fragment(
            "in float x; in float y; out vec4 c; void main() { c = vec4(x * y == x + y); }"),
        good Fragment(
            "in float x; in float y; out vec4 c; void main() { c = vec4(abs(x * y - x - y) < 1e-4); }");
    FLOAT_LOOP_COUNTER = "L0027" "float-loop-counter" Note Numerics No "0.1.0" "GLSL 1.50 §6.3"
        "A loop counts in steps that a float does not have exactly. Rounding adds up and decides how often the loop \
         runs."
        why
        "Steps that are exact in binary, such as 1.0 or 0.25, are left out."
        bad Fragment(
            "out vec4 c; void main() { c = vec4(0.0); for (float t = 0.0; t < 1.0; t += 0.1) c += t; }"),
        good Fragment(
            "out vec4 c; void main() { c = vec4(0.0); for (int i = 0; i < 10; i++) c += float(i) * 0.1; }");
}
