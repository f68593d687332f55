//! Lint rules of the group `style`: what can be said more simply, and what nothing uses.

use super::super::Example::{Fragment, Program};

lints! {
    UNUSED_VARYING = "L0001" "unused-varying" Note Style No "0.1.0" "GLSL 1.50 §4.3.6"
        "A stage writes an output that the next stage does not declare. That is legal but costs time, and often \
         means that a name was changed on only one side."
        why "What is computed for nobody costs a register between the stages; it may be meant for another program."
        bad Program(
            "out vec4 tint; out vec4 unused; void main() { tint = unused = vec4(1.0); gl_Position = vec4(0.0); }",
            "in vec4 tint; out vec4 c; void main() { c = tint; }"),
        good Program(
            "out vec4 tint; void main() { tint = vec4(1.0); gl_Position = vec4(0.0); }",
            "in vec4 tint; out vec4 c; void main() { c = tint; }");
    UNUSED_VARIABLE = "L0051" "unused-variable" Note Style Safe "0.1.0" ""
        "A local variable is never read."
        why
        "What only text names that an `#if` skips is left out."
        bad Fragment(
            "in vec4 p; out vec4 c; void main() { vec4 q = 2.0 * p; c = p; }"),
        good Fragment(
            "in vec4 p; out vec4 c; void main() { vec4 q = 2.0 * p; c = q; }");
    UNUSED_PARAMETER = "L0052" "unused-parameter" Off Style No "0.1.0" "GLSL 1.50 §6.1"
        "A function does not use one of its parameters."
        why
        "A signature may be that of a family of functions, so it is off."
        bad Fragment(
            "float f(float a, float b) { return a; } out vec4 c; void main() { c = vec4(f(1.0, 2.0)); }"),
        good Fragment(
            "float f(float a, float b) { return a + b; } out vec4 c; void main() { c = vec4(f(1.0, 2.0)); }");
    UNUSED_FUNCTION = "L0053" "unused-function" Note Style No "0.1.0" "GLSL 1.50 §6.1"
        "Nothing calls a function of the shader."
        why
        "Functions of headers, and functions that text names which an `#if` skips, are left out. One finding for a \
         shader."
        bad Fragment(
            "float f() { return 1.0; } out vec4 c; void main() { c = vec4(1.0); }"),
        good Fragment(
            "float f() { return 1.0; } out vec4 c; void main() { c = vec4(f()); }");
    UNUSED_ATTRIBUTE = "L0054" "unused-attribute" Note Style Unsafe "0.1.0" "GLSL 1.50 §4.3.4"
        "The vertex stage declares an attribute and never reads it."
        why
        "Hosts may have the same attributes for all shaders, so it is a note, and lone files are left out. The fix \
         changes what the host sees, so it is unsafe."
        bad Program(
            "in vec4 p; in vec2 uv; void main() { gl_Position = p; }",
            "out vec4 c; void main() { c = vec4(1.0); }"),
        good Program(
            "in vec4 p; void main() { gl_Position = p; }",
            "out vec4 c; void main() { c = vec4(1.0); }");
    UNUSED_UNIFORM = "L0055" "unused-uniform" Note Style Unsafe "0.1.0" "GLSL 1.50 §4.3.5"
        "A shader declares a uniform and never reads it. Drivers remove it, and hosts that look for it find nothing."
        why
        "Uniforms of headers, of blocks and of lone files are left out: their hosts may set the same for all. The \
         fix changes what the host sees, so it is unsafe."
        bad Program(
            "in vec4 p; void main() { gl_Position = p; }",
            "uniform vec4 tint; out vec4 c; void main() { c = vec4(1.0); }"),
        good Program(
            "in vec4 p; void main() { gl_Position = p; }",
            "uniform vec4 tint; out vec4 c; void main() { c = tint; }");
    UNUSED_INPUT = "L0056" "unused-input" Note Style Unsafe "0.1.0" "GLSL 1.50 §4.3.4"
        "The fragment stage declares an input and never reads it."
        why
        "The stage before may need its counterpart for other programs, so it is a note. Lone files are left out."
        bad Program(
            "in vec4 p; out vec2 uv; void main() { gl_Position = p; uv = p.xy; }",
            "in vec2 uv; out vec4 c; void main() { c = vec4(1.0); }"),
        good Program(
            "in vec4 p; out vec2 uv; void main() { gl_Position = p; uv = p.xy; }",
            "in vec2 uv; out vec4 c; void main() { c = vec4(uv, 0.0, 1.0); }");
    UNUSED_STRUCT = "L0057" "unused-struct" Note Style No "0.1.0" "GLSL 1.50 §4.1.8"
        "Nothing uses a struct of the shader."
        why
        "Structs of headers are left out."
        bad Fragment(
            "struct Light { vec3 place; }; out vec4 c; void main() { c = vec4(1.0); }"),
        good Fragment(
            "struct Light { vec3 place; }; uniform Light light; out vec4 c; void main() { c = vec4(light.place, \
             1.0); }");
    UNUSED_MACRO = "L0058" "unused-macro" Off Style No "0.1.0" "GLSL 1.50 §3.3"
        "A macro of the shader is defined and never named."
        why
        "Engines read macros as options, so it is off."
        bad Fragment(
            "#define SIZE 4\nout vec4 c; void main() { c = vec4(1.0); }"),
        good Fragment(
            "#define SIZE 4\nout vec4 c; void main() { c = vec4(SIZE); }");
    UNUSED_INCLUDE = "L0059" "unused-include" Note Style Unsafe "0.1.0" ""
        "A shader includes a file and names nothing of it."
        why
        "What text names that an `#if` skips counts, and the rule is silent if an include was not read."
        bad Fragment(
            "#extension GL_GOOGLE_include_directive : require\n#include <glisten/lambert.glsl>\nout vec4 c; void \
             main() { c = vec4(1.0); }"),
        good Fragment(
            "#extension GL_GOOGLE_include_directive : require\n#include <glisten/lambert.glsl>\nin vec3 n; out vec4 \
             c; void main() { c = vec4(lambertFactor(normalize(n), vec3(0.0, 0.0, 1.0))); }");
    POW_OF_TWO = "L0060" "pow-of-two" Off Style Unsafe "0.1.0" "GLSL 1.50 §8.2"
        "`pow(x, 2.0)` is `x * x`, which takes one multiplication, and is defined for a negative `x`."
        why
        "Compilers do it themselves, and the bits may change, so it is off."
        bad Fragment(
            "in float x; out vec4 c; void main() { c = vec4(pow(x, 2.0)); }"),
        good Fragment(
            "in float x; out vec4 c; void main() { c = vec4(x * x); }");
    LENGTH_OF_DIFFERENCE = "L0061" "length-of-difference" Off Style Unsafe "0.1.0" "GLSL 1.50 §8.4"
        "`length(a - b)` is `distance(a, b)`."
        why
        "A matter of taste, so it is off."
        bad Fragment(
            "in vec3 a; in vec3 b; out vec4 c; void main() { c = vec4(length(a - b)); }"),
        good Fragment(
            "in vec3 a; in vec3 b; out vec4 c; void main() { c = vec4(distance(a, b)); }");
    IDENTITY_OPERATION = "L0062" "identity-operation" Off Style Safe "0.1.0" "GLSL 1.50 §5.9"
        "A value is multiplied or divided by 1, which changes nothing."
        why
        "The factors of a filter are written so, each in its line, so it is off. What converts a whole number to a \
         float is left out."
        bad Fragment(
            "in float x; out vec4 c; void main() { c = vec4(x * 1.0); }"),
        good Fragment(
            "in float x; out vec4 c; void main() { c = vec4(x); }");
    CLAMP_BY_MIN_MAX = "L0063" "clamp-by-min-max" Off Style Unsafe "0.1.0" "GLSL 1.50 §8.3"
        "`min(max(x, a), b)` is `clamp(x, a, b)`."
        why
        "A matter of taste, so it is off."
        bad Fragment(
            "in float x; out vec4 c; void main() { c = vec4(min(max(x, 0.0), 1.0)); }"),
        good Fragment(
            "in float x; out vec4 c; void main() { c = vec4(clamp(x, 0.0, 1.0)); }");
    MIX_BY_BOOL = "L0064" "mix-by-bool" Off Style Unsafe "0.1.0" "GLSL 1.50 §8.3"
        "`mix(a, b, float(c))` with a `bool` is a selection. It computes with both values, so that an infinite one \
         that is not selected gives NaN."
        why
        "A matter of taste where both values are finite, so it is off."
        bad Fragment(
            "in float x; uniform bool lit; out vec4 c; void main() { c = vec4(mix(0.5, x, float(lit))); }"),
        good Fragment(
            "in float x; uniform bool lit; out vec4 c; void main() { c = vec4(lit ? x : 0.5); }");
    BOOL_LITERAL_SELECTION = "L0065" "bool-literal-selection" Note Style Safe "0.1.0" "GLSL 1.50 §5.1"
        "`c ? true : false` and `c == true` are `c`."
        why
        "It is right, and longer than need be."
        bad Fragment(
            "in float x; out vec4 c; void main() { bool on = x > 0.5 ? true : false; c = vec4(on); }"),
        good Fragment(
            "in float x; out vec4 c; void main() { bool on = x > 0.5; c = vec4(on); }");
    REPEATED_MACRO = "L0066" "repeated-macro" Note Style Safe "0.1.0" "GLSL 1.50 §3.3"
        "A macro is defined a second time with the same text, which changes nothing."
        why
        "Only definitions outside of conditions count."
        bad Fragment(
            "#define SIZE 4\n#define SIZE 4\nout vec4 c; void main() { c = vec4(SIZE); }"),
        good Fragment(
            "#define SIZE 4\nout vec4 c; void main() { c = vec4(SIZE); }");
    REPEATED_CALL = "L0067" "repeated-call" Note Style Safe "0.1.0" ""
        "A function is applied to its own result, where the second call changes nothing: `abs(abs(x))`, \
         `normalize(normalize(v))`."
        why
        "It is right, and only costs time."
        bad Fragment(
            "in float x; out vec4 c; void main() { c = vec4(abs(abs(x))); }"),
        good Fragment(
            "in float x; out vec4 c; void main() { c = vec4(abs(x)); }");
    SHADOWED_VARIABLE = "L0068" "shadowed-variable" Note Style No "0.1.0" "GLSL 1.50 §4.2"
        "A local variable has the name of a global, a parameter, or a variable of an outer block. Which one a later \
         line means is easily mistaken."
        why
        "It is legal and often harmless, so it is a note. A global counts only if the function uses it, too, and \
         both declarations must be in one file."
        bad Fragment(
            "in float x; out vec4 c; void main() { float y = x; if (x > 0.5) { float y = 1.0; c = vec4(y); } else c \
             = vec4(y); }"),
        good Fragment(
            "in float x; out vec4 c; void main() { float y = x; if (x > 0.5) { float z = 1.0; c = vec4(z); } else c \
             = vec4(y); }");
    SHADOWED_BUILTIN = "L0069" "shadowed-builtin" Note Style No "0.1.0" "GLSL 1.50 §6.1"
        "A function has the name and the parameters of a built-in function, which it hides with all its overloads; \
         or a variable has the name of a built-in function that the same function of the shader calls elsewhere."
        why
        "Legal, and sometimes meant, so it is a note."
        bad Fragment(
            "float sign(float x) { return x < 0.0 ? -1.0 : 1.0; } in float x; out vec4 c; void main() { c = \
             vec4(sign(x)); }"),
        good Fragment(
            "float signOf(float x) { return x < 0.0 ? -1.0 : 1.0; } in float x; out vec4 c; void main() { c = \
             vec4(signOf(x)); }");
    UNUSED_ALLOW = "L0073" "unused-allow" Note Style Safe "0.1.0" ""
        "A comment `glisten: allow(..)` names a lint rule that finds nothing there."
        why
        "Comments in headers, and those for codes that are no lint rules, are left out."
        bad Fragment(
            "in float x; out vec4 c;\nvoid main() {\n    c = vec4(x); // glisten: allow(pow-of-negative)\n}"),
        good Fragment(
            "in float x; out vec4 c;\nvoid main() {\n    c = vec4(pow(-2.0, x)); // glisten: \
             allow(pow-of-negative)\n}");
}
