//! Codes of the lint rules (`L0xxx`); each rule is a file in `src/lint/rules`.

use super::Example::{Fragment, Program};

codes! {
    UNUSED_VARYING = "L0001" "unused-varying" Note "GLSL 1.50 §4.3.6"
        "A stage writes an output that the next stage does not declare. That is legal but costs time, and often \
         means that a name was changed on only one side."
        bad Program(
            "out vec4 tint; out vec4 unused; void main() { tint = unused = vec4(1.0); gl_Position = vec4(0.0); }",
            "in vec4 tint; out vec4 c; void main() { c = tint; }"),
        good Program(
            "out vec4 tint; void main() { tint = vec4(1.0); gl_Position = vec4(0.0); }",
            "in vec4 tint; out vec4 c; void main() { c = tint; }");
    UNWRITTEN_OUTPUT = "L0002" "unwritten-output" Warning "GLSL 1.50 §7.2"
        "A fragment output is declared but never written, so its color is undefined."
        bad Fragment("out vec4 color; out vec4 glow; void main() { color = vec4(1.0); }"),
        good Fragment("out vec4 color; out vec4 glow; void main() { color = vec4(1.0); glow = color; }");
    POSITION_NOT_WRITTEN = "L0003" "position-not-written" Warning "GLSL 1.50 §7.1"
        "The stage before the rasterizer never writes `gl_Position`. That is legal, but what is drawn is undefined."
        bad Program(
            "out vec4 tint; void main() { tint = vec4(1.0); }",
            "in vec4 tint; out vec4 c; void main() { c = tint; }"),
        good Program(
            "out vec4 tint; void main() { tint = vec4(1.0); gl_Position = vec4(0.0); }",
            "in vec4 tint; out vec4 c; void main() { c = tint; }");
    FLAT_PROVOKING_VERTEX = "L0004" "flat-provoking-vertex" Note "OpenGL 3.2 §2.18"
        "A `flat` varying has the value of the provoking vertex: the last vertex of the primitive in OpenGL, the \
         first in WebGPU and Vulkan. A host that draws the emitted code must rotate the indices of each primitive, \
         as glisten's own runner does; otherwise the picture changes."
        bad Program(
            "flat out vec4 tint; void main() { tint = vec4(1.0); gl_Position = vec4(0.0); }",
            "flat in vec4 tint; out vec4 c; void main() { c = tint; }"),
        good Program(
            "out vec4 tint; void main() { tint = vec4(1.0); gl_Position = vec4(0.0); }",
            "in vec4 tint; out vec4 c; void main() { c = tint; }");
    UNINITIALIZED_READ = "L0005" "uninitialized-read" Warning "GLSL 1.50 §4.1"
        "A variable or an `out` parameter is read before anything can have been assigned to it. Its value is \
         undefined: zero on one machine and anything on another."
        bad Fragment("out vec4 c; void main() { vec4 sum; sum += vec4(1.0); c = sum; }"),
        good Fragment("out vec4 c; void main() { vec4 sum = vec4(0.0); sum += vec4(1.0); c = sum; }");
    UNWRITTEN_OUT_PARAMETER = "L0006" "unwritten-out-parameter" Warning "GLSL 1.50 §6.1.1"
        "A function never assigns one of its `out` parameters. The argument of each call becomes undefined."
        bad Fragment("void f(out float a, out float b) { a = 1.0; }\n\
                      out vec4 c; void main() { float x = 0.0, y = 0.0; f(x, y); c = vec4(x, y, 0.0, 1.0); }"),
        good Fragment("void f(out float a, out float b) { a = b = 1.0; }\n\
                       out vec4 c; void main() { float x = 0.0, y = 0.0; f(x, y); c = vec4(x, y, 0.0, 1.0); }");
    NON_FINITE_CONSTANT = "L0007" "non-finite-constant" Warning "GLSL 1.50 §4.1.4"
        "A constant operation yields an infinity or NaN, from a division by zero, an overflow, or a function \
         outside its domain. GLSL leaves the value undefined, and WGSL rejects it."
        bad Fragment("out vec4 c; void main() { c = vec4(1.0 / 0.0); }"),
        good Fragment("out vec4 c; void main() { c = vec4(3.4e38); }");
    DIVISION_BY_ZERO = "L0008" "integer-division-by-zero" Warning "GLSL 1.50 §5.9"
        "An integer is divided by a constant zero. The value is undefined."
        bad Fragment("uniform int n; out vec4 c; void main() { c = vec4(n / 0); }"),
        good Fragment("uniform int n; out vec4 c; void main() { c = vec4(n / 2); }");
    POW_OF_NEGATIVE = "L0009" "pow-of-negative" Warning "GLSL 1.50 §8.2"
        "`pow` of a negative base is undefined, also for whole exponents: drivers compute it with a logarithm and \
         return NaN."
        bad Fragment("uniform float k; out vec4 c; void main() { c = vec4(pow(-2.0, k)); }"),
        good Fragment("uniform float k; out vec4 c; void main() { c = vec4(pow(2.0, k)); }");
    DIVERGENT_DERIVATIVE = "L0010" "divergent-derivative" Warning "GLSL 1.50 §8.7"
        "Derivatives, and texture lookups whose level of detail depends on them, compare neighboring fragments. If \
         a condition may send the neighbors along another path, the result is undefined. WGSL rejects such calls \
         unless a directive disables the check."
        bad Fragment("uniform sampler2D t; in vec2 p; out vec4 c;\n\
                      void main() { c = vec4(0.0); if (p.x > 0.5) c = texture(t, p); }"),
        good Fragment("uniform sampler2D t; in vec2 p; out vec4 c;\n\
                       void main() { vec4 s = texture(t, p); c = vec4(0.0); if (p.x > 0.5) c = s; }");
    INFINITE_LOOP = "L0011" "infinite-loop" Warning "GLSL 1.50 §6.3"
        "The condition of a loop is always true, and nothing in the loop leaves it. The machine may hang."
        bad Fragment("out vec4 c; void main() { c = vec4(0.0); while (true) { c += 1.0; } }"),
        good Fragment("out vec4 c; void main() { c = vec4(0.0); while (true) { c += 1.0; if (c.x > 9.0) break; } }");
    UNREACHABLE_CODE = "L0012" "unreachable-code" Warning "GLSL 1.50 §6.4"
        "Statements follow one that always leaves the body, so they never run."
        bad Fragment("out vec4 c; void main() { c = vec4(0.0); return; c = vec4(1.0); }"),
        good Fragment("out vec4 c; void main() { c = vec4(0.0); }");
    MISSING_RETURN = "L0013" "return-on-some-ways" Warning "GLSL 1.50 §6.1"
        "Some path through a function ends without a `return`, although the function must return a value. The value \
         is then undefined: the emitted code returns zero, an OpenGL driver anything."
        bad Fragment("in float x; out vec4 c; float f() { if (x > 0.5) return 1.0; } void main() { c = vec4(f()); }"),
        good Fragment("in float x; out vec4 c; float f() { if (x > 0.5) return 1.0; return 0.0; }\n\
                       void main() { c = vec4(f()); }");
    UNWRITTEN_VARYING = "L0014" "unwritten-varying" Warning "GLSL 1.50 §4.3.6"
        "The fragment stage reads a varying, or a part of one, that the vertex stage declares and never writes, or does not \
         write on every way through `main`. What is interpolated there is undefined."
        bad Program(
            "in vec4 p; uniform bool lit; out vec4 tint; void main() { if (lit) tint = p; gl_Position = p; }",
            "in vec4 tint; out vec4 c; void main() { c = tint; }"),
        good Program(
            "in vec4 p; uniform bool lit; out vec4 tint; void main() { tint = lit ? p : vec4(1.0); gl_Position = p; }",
            "in vec4 tint; out vec4 c; void main() { c = tint; }");
}
