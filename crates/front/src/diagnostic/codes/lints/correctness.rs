//! Lint rules of the group `correctness`: what is hardly meant, or undefined.

use super::super::Example::{Fragment, Program};

lints! {
    UNWRITTEN_OUTPUT = "L0002" "unwritten-output" Warning Correctness No "0.1.0" "GLSL 1.50 §7.2"
        "A fragment output is declared but never written, so its color is undefined; or a component of it is never written, such as \
         the alpha, on which blending depends."
        why "An undefined color is never meant."
        bad Fragment("out vec4 color; out vec4 glow; void main() { color = vec4(1.0); }"),
        good Fragment("out vec4 color; out vec4 glow; void main() { color = vec4(1.0); glow = color; }");
    POSITION_NOT_WRITTEN = "L0003" "position-not-written" Warning Correctness No "0.1.0" "GLSL 1.50 §7.1"
        "The stage before the rasterizer never writes `gl_Position`. That is legal, but what is drawn is undefined."
        why "Nothing can be drawn without a position."
        bad Program(
            "out vec4 tint; void main() { tint = vec4(1.0); }",
            "in vec4 tint; out vec4 c; void main() { c = tint; }"),
        good Program(
            "out vec4 tint; void main() { tint = vec4(1.0); gl_Position = vec4(0.0); }",
            "in vec4 tint; out vec4 c; void main() { c = tint; }");
    UNINITIALIZED_READ = "L0005" "uninitialized-read" Warning Correctness No "0.1.0" "GLSL 1.50 §4.1"
        "A variable, an output or an `out` parameter is read before anything can have been assigned to it, or a component of a \
         vector that nothing assigns. Its value is undefined: zero on one machine and anything on another."
        why "The value is undefined on every path."
        bad Fragment("out vec4 c; void main() { vec4 sum; sum += vec4(1.0); c = sum; }"),
        good Fragment("out vec4 c; void main() { vec4 sum = vec4(0.0); sum += vec4(1.0); c = sum; }");
    UNWRITTEN_OUT_PARAMETER = "L0006" "unwritten-out-parameter" Warning Correctness No "0.1.0" "GLSL 1.50 §6.1.1"
        "A function never assigns one of its `out` parameters. The argument of each call becomes undefined."
        why "The value of the argument is undefined after every call."
        bad Fragment("void f(out float a, out float b) { a = 1.0; }\n\
                      out vec4 c; void main() { float x = 0.0, y = 0.0; f(x, y); c = vec4(x, y, 0.0, 1.0); }"),
        good Fragment("void f(out float a, out float b) { a = b = 1.0; }\n\
                       out vec4 c; void main() { float x = 0.0, y = 0.0; f(x, y); c = vec4(x, y, 0.0, 1.0); }");
    DIVERGENT_DERIVATIVE = "L0010" "divergent-derivative" Warning Correctness No "0.1.0" "GLSL 1.50 §8.7"
        "Derivatives, and texture lookups whose level of detail depends on them, compare neighboring fragments. If \
         a condition may send the neighbors along another path, the result is undefined. WGSL rejects such calls \
         unless a directive disables the check."
        why "Targets that check it refuse the shader. Textures that have one level, or nearly always have (lines, volumes, maps of depths and noise, by type or name), are left out."
        bad Fragment("uniform sampler2D t; in vec2 p; out vec4 c;\n\
                      void main() { c = vec4(0.0); if (p.x > 0.5) c = texture(t, p); }"),
        good Fragment("uniform sampler2D t; in vec2 p; out vec4 c;\n\
                       void main() { vec4 s = texture(t, p); c = vec4(0.0); if (p.x > 0.5) c = s; }");
    INFINITE_LOOP = "L0011" "infinite-loop" Warning Correctness No "0.1.0" "GLSL 1.50 §6.3"
        "The condition of a loop is always true, and nothing in the loop leaves it. The machine may hang."
        why "The machine may hang."
        bad Fragment("out vec4 c; void main() { c = vec4(0.0); while (true) { c += 1.0; } }"),
        good Fragment("out vec4 c; void main() { c = vec4(0.0); while (true) { c += 1.0; if (c.x > 9.0) break; } }");
    UNREACHABLE_CODE = "L0012" "unreachable-code" Warning Correctness No "0.1.0" "GLSL 1.50 §6.4"
        "Statements follow one that always leaves the body, so they never run."
        why "What never runs is not what was meant. A `break` after a `return` in a `switch` is left out."
        bad Fragment("out vec4 c; void main() { c = vec4(0.0); return; c = vec4(1.0); }"),
        good Fragment("out vec4 c; void main() { c = vec4(0.0); }");
    RETURN_ON_SOME_WAYS = "L0013" "return-on-some-ways" Warning Correctness No "0.1.0" "GLSL 1.50 §6.1"
        "Some path through a function ends without a `return`, although the function must return a value. The value \
         is then undefined: the emitted code returns zero, an OpenGL driver anything."
        why "The value is undefined on that path."
        bad Fragment("in float x; out vec4 c; float f() { if (x > 0.5) return 1.0; } void main() { c = vec4(f()); }"),
        good Fragment("in float x; out vec4 c; float f() { if (x > 0.5) return 1.0; return 0.0; }\n\
                       void main() { c = vec4(f()); }");
    UNWRITTEN_VARYING = "L0014" "unwritten-varying" Warning Correctness No "0.1.0" "GLSL 1.50 §4.3.6"
        "The fragment stage reads a varying, or a part of one, that the vertex stage declares and never writes, or does not \
         write on every way through `main`. What is interpolated there is undefined."
        why "What is interpolated is undefined. Only parts that the fragment stage reads on every path count."
        bad Program(
            "in vec4 p; uniform bool lit; out vec4 tint; void main() { if (lit) tint = p; gl_Position = p; }",
            "in vec4 tint; out vec4 c; void main() { c = tint; }"),
        good Program(
            "in vec4 p; uniform bool lit; out vec4 tint; void main() { tint = lit ? p : vec4(1.0); gl_Position = p; }",
            "in vec4 tint; out vec4 c; void main() { c = tint; }");
    MAYBE_UNINITIALIZED_READ = "L0015" "maybe-uninitialized-read" Warning Correctness No "0.1.0" "GLSL 1.50 §4.1"
        "A variable or an `out` parameter is read although some path before the read assigns nothing to it. On that \
         path its value is undefined."
        why
        "Reads behind a condition of their own are left out, since the same condition may rule the assignment; all \
         that a loop assigns counts from its start."
        bad Fragment(
            "uniform int mode; out vec4 c; void main() { vec4 s; if (mode == 0) s = vec4(1.0); else if (mode == 1) s \
             = vec4(0.5); c = s; }"),
        good Fragment(
            "uniform int mode; out vec4 c; void main() { vec4 s; if (mode == 0) s = vec4(1.0); else s = vec4(0.5); c \
             = s; }");
    ASSIGNMENT_IN_CONDITION = "L0016" "assignment-in-condition" Warning Correctness Unsafe "0.1.0" "GLSL 1.50 §5.8"
        "A condition assigns one `bool` to another where a comparison may be meant. A second pair of parentheses \
         says that the assignment is meant."
        why
        "The condition is then the value that was assigned, which is rarely wanted."
        bad Fragment(
            "uniform bool lit; out vec4 c; void main() { bool on = false; c = vec4(0.0); if (on = lit) c = \
             vec4(1.0); }"),
        good Fragment(
            "uniform bool lit; out vec4 c; void main() { bool on = false; c = vec4(0.0); if (on == lit) c = \
             vec4(1.0); }");
    LOOP_COUNTS_AWAY = "L0017" "loop-counts-away" Warning Correctness No "0.1.0" "GLSL 1.50 §6.3"
        "The counter of a loop moves away from the constant that it is compared with. The loop runs until the number \
         overflows, or not at all."
        why
        "Only counters that nothing else in the loop assigns count."
        bad Fragment(
            "out vec4 c; void main() { c = vec4(0.0); for (int i = 0; i < 4; i--) c += 0.25; }"),
        good Fragment(
            "out vec4 c; void main() { c = vec4(0.0); for (int i = 0; i < 4; i++) c += 0.25; }");
    SELF_ASSIGNMENT = "L0018" "self-assignment" Warning Correctness Safe "0.1.0" "GLSL 1.50 §5.8"
        "A variable is assigned to itself, which does nothing. Often one of the two should have another name."
        why
        "What a macro writes is left out: its arguments may happen to agree."
        bad Fragment(
            "in vec4 p; out vec4 c; void main() { c = p; c.x = c.x; }"),
        good Fragment(
            "in vec4 p; out vec4 c; void main() { c = p; c.x = c.y; }");
    IDENTICAL_BRANCHES = "L0019" "identical-branches" Warning Correctness Unsafe "0.1.0" "GLSL 1.50 §6.2"
        "Both branches of a condition do the same, or both values of a selection are the same, so the condition \
         decides nothing."
        why
        "Branches that declare variables, and conditions in macros, are left out."
        bad Fragment(
            "in float x; out vec4 c; void main() { c = x > 0.5 ? vec4(1.0) : vec4(1.0); }"),
        good Fragment(
            "in float x; out vec4 c; void main() { c = x > 0.5 ? vec4(1.0) : vec4(0.0); }");
    EMPTY_BODY = "L0020" "empty-body" Warning Correctness No "0.1.0" "GLSL 1.50 §6.2"
        "A `;` directly behind a condition is all that it guards; or it is all that a loop repeats, and a block \
         follows. What follows runs in any case."
        why
        "A loop without a body is common where its step does the work, so it counts only before a block."
        bad Fragment(
            "in float x; out vec4 c; void main() { c = vec4(0.0); if (x > 0.5); { c = vec4(1.0); } }"),
        good Fragment(
            "in float x; out vec4 c; void main() { c = vec4(0.0); if (x > 0.5) { c = vec4(1.0); } }");
    VALUE_DROPPED = "L0077" "value-dropped" Warning Correctness Unsafe "0.1.0" "GLSL 1.50 §5.9"
        "A statement computes a value that nothing takes, such as `a == b;` for `a = b;` and `max(a, b);`; or the comma \
         operator drops one, such as the 5 of `a * 0,5`."
        why
        "Calls of the shader's functions are left out, and what a macro writes. So is a variable alone that nothing else \
         names, or that is in parentheses: people write it to silence who reports it as unused."
        bad Fragment(
            "in vec4 p; out vec4 c; void main() { c = p; c.y == 1.0; }"),
        good Fragment(
            "in vec4 p; out vec4 c; void main() { c = p; c.y = 1.0; }");
    COMPARISON_CHAIN = "L0021" "comparison-chain" Warning Correctness No "0.1.0" "GLSL 1.50 §5.9"
        "`a == b == c` compares the truth of `a == b` with `c`, not three values with each other."
        why
        "In parentheses, the comparison of two truths is meant."
        bad Fragment(
            "uniform bool a, b, d; out vec4 c; void main() { c = vec4(a == b == d); }"),
        good Fragment(
            "uniform bool a, b, d; out vec4 c; void main() { c = vec4(a == b && b == d); }");
    CONSTANT_CONDITION = "L0022" "constant-condition" Note Correctness No "0.1.0" "GLSL 1.50 §6.2"
        "A condition is made of literals alone, so one of the two branches never runs."
        why
        "People turn code off in this way, so it is a note. Conditions that name a constant or a macro are switches \
         and left out."
        bad Fragment(
            "out vec4 c; void main() { c = vec4(0.0); if (false) c = vec4(1.0); }"),
        good Fragment(
            "const bool LIT = false; out vec4 c; void main() { c = vec4(0.0); if (LIT) c = vec4(1.0); }");
    INTEGER_DIVISION = "L0023" "integer-division" Warning Correctness Unsafe "0.1.0" "GLSL 1.50 §5.9"
        "Two whole numbers are divided, the rest is dropped, and the result becomes a float: `1 / 2 * x` is 0."
        why
        "Only quotients of two literals with a rest count; those of variables are often meant."
        bad Fragment(
            "in float x; out vec4 c; void main() { c = vec4(1 / 2 * x); }"),
        good Fragment(
            "in float x; out vec4 c; void main() { c = vec4(1.0 / 2.0 * x); }");
    MISSING_DEFAULT = "L0024" "missing-default" Off Correctness No "0.1.0" "GLSL 1.50 §6.2"
        "A `switch` has no `default`, so nothing happens for values without a `case`."
        why
        "A matter of taste, so it is off. What is left without a value by it, `maybe-uninitialized-read` reports."
        bad Fragment(
            "uniform int n; out vec4 c; void main() { c = vec4(0.0); switch (n) { case 0: c = vec4(1.0); break; } }"),
        good Fragment(
            "uniform int n; out vec4 c; void main() { switch (n) { case 0: c = vec4(1.0); break; default: c = \
             vec4(0.0); } }");
    SELF_COMPARISON = "L0025" "self-comparison" Note Correctness No "0.1.0" "GLSL 1.50 §5.9"
        "Both sides of a comparison are the same. The result is always the same, except for NaN, which compilers \
         need not respect."
        why
        "People test for NaN in this way, so it is a note; `isnan` says it."
        bad Fragment(
            "in float x; out vec4 c; void main() { c = vec4(x != x ? 0.0 : x); }"),
        good Fragment(
            "in float x; out vec4 c; void main() { c = vec4(isnan(x) ? 0.0 : x); }");
}
