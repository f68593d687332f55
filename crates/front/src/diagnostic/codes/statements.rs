//! Codes for statements and functions (`E05xx`).

use super::Example::{Fragment, Text, Vertex};

codes! {
    STRAY_JUMP = "E0501" "stray-jump" Error "GLSL 1.50 §6.4"
        "`break` leaves the innermost loop or `switch`, `continue` continues the innermost loop. There is none \
         around this statement."
        bad Fragment("out vec4 c; void main() { c = vec4(0.0); break; }"),
        good Fragment("out vec4 c; void main() { c = vec4(0.0); while (true) { break; } }");
    RETURN = "E0502" "return-mismatch" Error "GLSL 1.50 §6.4, §6.1"
        "The returned value must have the function's return type, and a `void` function returns no value."
        bad Fragment("out vec4 c; float f() { return vec2(1.0); } void main() { c = vec4(f()); }"),
        good Fragment("out vec4 c; float f() { return vec2(1.0).x; } void main() { c = vec4(f()); }");
    NO_RETURN = "E0514" "missing-return" Error "GLSL 1.50 §4.1.1, §6.4"
        "A function that is declared to return a value has no `return`. Functions that do not return a value must \
         be declared `void`."
        bad Fragment("out vec4 c; float f(float x) { x *= 2.0; } void main() { c = vec4(f(1.0)); }"),
        good Fragment("out vec4 c; float f(float x) { return x * 2.0; } void main() { c = vec4(f(1.0)); }");
    RETURN_CONVERSION = "W0501" "implicit-return-conversion" Warning "GLSL 1.50 §6.4"
        "Before GLSL 4.20 (or GL_ARB_shading_language_420pack), a returned value is not implicitly converted to the \
         return type. Every driver converts it nevertheless, so this is a warning; `--strict` makes it an error."
        bad Fragment("out vec4 c; float f() { return 1; } void main() { c = vec4(f()); }"),
        good Fragment("out vec4 c; float f() { return 1.0; } void main() { c = vec4(f()); }");
    DISCARD = "E0503" "discard-outside-fragment" Error "GLSL 1.50 §6.4"
        "`discard` abandons a fragment, which only a fragment shader has."
        bad Vertex("void main() { gl_Position = vec4(0.0); discard; }"),
        good Fragment("out vec4 c; void main() { c = vec4(0.0); discard; }");
    SWITCH_TYPE = "E0504" "switch-type" Error "GLSL 1.50 §6.2"
        "`switch` selects by one `int` or `uint`, and its cases must have the same type."
        bad Fragment("uniform float f; out vec4 c; void main() { switch (f) { case 0: c = vec4(0.0); } }"),
        good Fragment("uniform int i; out vec4 c; void main() { switch (i) { case 0: c = vec4(0.0); } }");
    REPEATED_CASE = "E0505" "repeated-case" Error "GLSL 1.50 §6.2"
        "A `switch` can have each case only once, and `default` at most once."
        bad Fragment("uniform int i; out vec4 c; void main() { switch (i) { case 1: break; case 1: c = vec4(0.0); } }"),
        good Fragment("uniform int i; out vec4 c; void main() { switch (i) { case 1: break; case 2: c = vec4(0.0); } }");
    BEFORE_CASE = "E0506" "statement-before-case" Error "GLSL 1.50 §6.2"
        "A statement in a `switch` before its first label can never run."
        bad Fragment("uniform int i; out vec4 c; void main() { switch (i) { c = vec4(0.0); case 1: c = vec4(1.0); } }"),
        good Fragment("uniform int i; out vec4 c; void main() { c = vec4(0.0); switch (i) { case 1: c = vec4(1.0); } }");
    EMPTY_CASE = "E0507" "empty-last-case" Error "GLSL 1.50 §6.2"
        "The last label of a `switch` must be followed by a statement; `break;` is enough."
        bad Fragment("uniform int i; out vec4 c; void main() { switch (i) { case 1: c = vec4(1.0); default: } }"),
        good Fragment("uniform int i; out vec4 c; void main() { switch (i) { case 1: c = vec4(1.0); default: break; } }");
    RECURSION = "E0508" "recursion" Error "GLSL 1.50 §6.1"
        "A function must not call itself, neither directly nor through others, even if the call is never reached: \
         the hardware of the time had no stack."
        bad Fragment("out vec4 c; float f(int n) { return n > 0 ? f(n - 1) : 0.0; } void main() { c = vec4(f(3)); }"),
        good Fragment("out vec4 c; float f(int n) { float s = 0.0; for (; n > 0; n--) s += 1.0; return s; } \
            void main() { c = vec4(f(3)); }");
    FUNCTION_REDEFINED = "E0509" "function-redefined" Error "GLSL 1.50 §6.1"
        "A function may be declared any number of times, but has only one body."
        bad Fragment("out vec4 c; float f() { return 1.0; } float f() { return 2.0; } void main() { c = vec4(f()); }"),
        good Fragment("out vec4 c; float f(); float f() { return 2.0; } void main() { c = vec4(f()); }");
    MAIN_SIGNATURE = "E0510" "main-signature" Error "GLSL 1.50 §6.1"
        "The entry point is `void main()`, without parameters and without a result."
        bad Fragment("out vec4 c; int main() { c = vec4(0.0); return 0; }"),
        good Fragment("out vec4 c; void main() { c = vec4(0.0); }");
    NESTED_FUNCTION = "E0511" "nested-function" Error "GLSL 1.50 §4.2"
        "Functions are declared at global scope. A function can contain neither prototypes nor bodies of other \
         functions."
        bad Fragment("out vec4 c; void main() { float f(float a); c = vec4(0.0); }"),
        good Fragment("out vec4 c; float f(float a); void main() { c = vec4(0.0); }");
    OVERLOAD_DIFFERS = "E0512" "overloads-too-alike" Error "GLSL 1.50 §6.1"
        "Overloads differ in the types of their parameters. Two declarations with the same parameter types are the \
         same function, so their return type and all qualifiers must be the same."
        bad Fragment("float f(float a) { return a; } int f(float a) { return 1; } out vec4 c; void main() { c = vec4(0.0); }"),
        good Fragment("float f(float a) { return a; } int f(int a) { return a; } out vec4 c; void main() { c = vec4(f(0.5), f(1), 0.0, 1.0); }");
    TOO_MANY_OVERLOADS = "E0513" "too-many-overloads" Error ""
        "A name may have at most 1,024 overloads."
        bad Text("float f(float a[1]) { return a[0]; }\nfloat f(float a[2]) { return a[0]; }   // and so on, 1,025 times"),
        good Fragment("float f(float a[1]) { return a[0]; }\nfloat f(float a[2]) { return a[0]; }\nvoid main() {}");
}
