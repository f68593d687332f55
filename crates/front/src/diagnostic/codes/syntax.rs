//! Codes of the phase `syntax` (`E02xx`): literals and the grammar (GLSL 1.50 §3.6, §4.1, §9).

use super::Example::{Fragment, Vertex};

codes! {
    UNEXPECTED_TOKEN = "E0201" "unexpected-token" Error "GLSL 1.50 §9"
        "The grammar requires something else here. The message says what was expected and what was found."
        bad Fragment("out vec4 c; void main() { c = vec4(1.0) + ; }"),
        good Fragment("out vec4 c; void main() { c = vec4(1.0) + 1.0; }");
    MISSING_SEMICOLON = "E0202" "missing-semicolon" Error "GLSL 1.50 §9"
        "Statements and declarations end with `;`."
        bad Fragment("out vec4 c;\nvoid main() {\n    c = vec4(1.0)\n}"),
        good Fragment("out vec4 c;\nvoid main() {\n    c = vec4(1.0);\n}");
    RESERVED_WORD = "E0203" "reserved-word" Error "GLSL 1.50 §3.6"
        "The word is reserved for future versions and cannot be a name. Some of these words became types or qualifiers \
         in later versions; they have no meaning in 1.50."
        bad Fragment("out vec4 c; void main() { float filter = 1.0; c = vec4(1.0); }"),
        good Fragment("out vec4 c; void main() { float kernel = 1.0; c = vec4(kernel); }");
    KEYWORD_AS_NAME = "E0204" "keyword-as-name" Error "GLSL 1.50 §3.6"
        "The word is a keyword and cannot be a name."
        bad Fragment("out vec4 c; void main() { float smooth = 1.0; c = vec4(1.0); }"),
        good Fragment("out vec4 c; void main() { float smoothed = 1.0; c = vec4(smoothed); }");
    UNCLOSED_DELIMITER = "E0205" "unclosed-delimiter" Error "GLSL 1.50 §9"
        "A bracket or brace is opened but never closed."
        bad Vertex("void main() {\n    gl_Position = vec4(1.0);\n"),
        good Vertex("void main() {\n    gl_Position = vec4(1.0);\n}");
    STRAY_DELIMITER = "E0206" "stray-delimiter" Error "GLSL 1.50 §9"
        "A bracket or brace is closed but was never opened."
        bad Vertex("void main() { gl_Position = vec4(1.0); } }"), good Vertex("void main() { gl_Position = vec4(1.0); }");
    MALFORMED_NUMBER = "E0207" "malformed-number" Error "GLSL 1.50 §4.1.3, §4.1.4"
        "Integers are decimal, octal after a leading 0, or hexadecimal after 0x, and may end in `u`. Floats have a point \
         or an exponent and may end in `f`."
        bad Fragment("out vec4 c; void main() { c = vec4(089); }"), good Fragment("out vec4 c; void main() { c = vec4(89); }");
    INTEGER_TOO_LARGE = "E0208" "integer-too-large" Error "GLSL 1.50 §4.1.3"
        "An integer literal has at most 32 bits."
        bad Fragment("out vec4 c; void main() { uint a = 4294967296u; c = vec4(a); }"),
        good Fragment("out vec4 c; void main() { uint a = 4294967295u; c = vec4(a); }");
    NESTED_FUNCTION = "E0209" "function-inside-function" Error "GLSL 1.50 §6.1"
        "Functions can be defined only at global scope. If the function was not meant to be nested, a `}` is \
         missing above."
        bad Vertex("void main() { float f() { return 1.0; } }"), good Vertex("float f() { return 1.0; } void main() { f(); }");
    STRAY_CASE = "E0210" "stray-case-label" Error "GLSL 1.50 §6.2"
        "`case` and `default` must be directly inside the braces of a `switch`."
        bad Vertex("void main() { case 1: gl_Position = vec4(1.0); }"),
        good Vertex("void main() { switch (1) { case 1: gl_Position = vec4(1.0); } }");
    MISSING_TYPE = "E0211" "missing-type" Error "GLSL 1.50 §4"
        "A declaration must name its type, and statements must be inside functions."
        bad Vertex("uniform float a;\nb = 2.0;\nvoid main() {}"), good Vertex("uniform float a;\nfloat b = 2.0;\nvoid main() {}");
    MEMBER_INITIALIZER = "E0212" "member-initializer" Error "GLSL 1.50 §4.1.8, §4.3.7"
        "Members of structs and blocks have no initializers of their own."
        bad Vertex("struct S { float a = 1.0; };\nvoid main() {}"), good Vertex("struct S { float a; };\nvoid main() { S s = S(1.0); gl_Position = vec4(s.a); }");
    MISSING_BLOCK_QUALIFIER = "E0213" "missing-block-qualifier" Error "GLSL 1.50 §4.3.7"
        "An interface block begins with `uniform`, `in` or `out`."
        bad Vertex("Lights { vec4 a; };\nvoid main() {}"), good Vertex("uniform Lights { vec4 a; };\nvoid main() {}");
    LIST_WITHOUT_EXTENSION = "E0214" "initializer-list-without-extension" Error "ARB_shading_language_420pack"
        "A list in braces is an initializer from GLSL 4.20 on, or with GL_ARB_shading_language_420pack."
        bad Vertex("void main() { float a[2] = { 1.0, 2.0 }; gl_Position = vec4(a[0]); }"),
        good Vertex("void main() { float a[2] = float[2](1.0, 2.0); gl_Position = vec4(a[0]); }");

    STRAY_SEMICOLON = "W0201" "stray-semicolon" Warning "GLSL 1.50 §9"
        "The grammar has no empty declaration: a `;` at global scope belongs to nothing."
        bad Vertex("float f() { return 1.0; };\nvoid main() { f(); }"), good Vertex("float f() { return 1.0; }\nvoid main() { f(); }");
    LITERAL_WRAPS = "W0202" "literal-out-of-range" Warning "GLSL 1.50 §4.1.3, §4.1.4"
        "The literal does not fit its type: a decimal integer above 2147483648 becomes negative, and a float above \
         3.4e38 becomes infinite. Compilers accept both."
        bad Fragment("out vec4 c; void main() { c = vec4(3000000000); }"),
        good Fragment("out vec4 c; void main() { c = vec4(3000000000u); }");
}
