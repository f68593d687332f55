//! Codes of the phase `preprocess` (`E01xx`): characters, comments, directives and macros (GLSL 1.50 §3.1 to §3.4).

use super::Example::{Fragment, Text, Vertex};

codes! {
    ILLEGAL_CHARACTER = "E0103" "illegal-character" Error "GLSL 1.50 §3.1"
        "GLSL has a small character set: the letters, digits and signs of ASCII without quotes, `@`, `$`, the \
         backquote and, outside directives, `#`. All other characters are allowed only in comments."
        bad Fragment("out vec4 c; void main() { c = vec4(1.0) @ 2.0; }"),
        good Fragment("out vec4 c; void main() { c = vec4(1.0) * 2.0; /* ½ */ }");
    UNTERMINATED_COMMENT = "E0104" "unterminated-comment" Error "GLSL 1.50 §3.4"
        "A comment that begins with `/*` ends at the next `*/`; comments do not nest. Without an end, the rest of \
         the file is a comment."
        bad Fragment("void main() {} /* and so on"), good Fragment("void main() {} /* and so on */");
    UNKNOWN_DIRECTIVE = "E0105" "unknown-directive" Error "GLSL 1.50 §3.3"
        "A line whose first character is `#` is a directive, and the specification lists them all."
        bad Fragment("#defin A 1\nvoid main() {}"), good Fragment("#define A 1\nvoid main() {}");
    MALFORMED_DIRECTIVE = "E0106" "malformed-directive" Error "GLSL 1.50 §3.3"
        "The directive exists, but the text after its name is not valid for it."
        bad Fragment("#define 3 x\nvoid main() {}"), good Fragment("#define x 3\nvoid main() {}");
    STRAY_CONDITIONAL = "E0107" "stray-conditional" Error "GLSL 1.50 §3.3"
        "`#elif`, `#else` and `#endif` belong to an `#if`, `#ifdef` or `#ifndef` above them in the same file. After \
         an `#else`, only `#endif` may follow."
        bad Fragment("void main() {}\n#endif"), good Fragment("#ifdef A\n#endif\nvoid main() {}");
    UNTERMINATED_CONDITIONAL = "E0108" "unterminated-conditional" Error "GLSL 1.50 §3.3"
        "Each `#if`, `#ifdef` and `#ifndef` ends with an `#endif` in the same file."
        bad Fragment("#if 1\nvoid main() {}"), good Fragment("#if 1\nvoid main() {}\n#endif");
    MALFORMED_CONDITION = "E0109" "malformed-condition" Error "GLSL 1.50 §3.3"
        "`#if` and `#elif` are followed by an expression of integer literals, `defined`, and C++'s operators except \
         assignment, `?:` and the comma. Floats, function calls and names that are not macros have no value there."
        bad Fragment("#if 1.5 > 1\n#endif\nvoid main() {}"), good Fragment("#if 15 > 10\n#endif\nvoid main() {}");
    DIVISION_BY_ZERO_IN_CONDITION = "E0110" "division-by-zero-in-condition" Error "GLSL 1.50 §3.3"
        "An `#if` expression divides by zero, which has no value."
        bad Fragment("#if 1 / 0\n#endif\nvoid main() {}"), good Fragment("#if 1 / 1\n#endif\nvoid main() {}");
    MACRO_REDEFINED = "E0111" "macro-redefined" Error "GLSL 1.50 §3.3"
        "A macro may be defined again only with the same parameters and the same tokens, white space counting as \
         white space. To change it, write `#undef` first."
        bad Fragment("#define A 1\n#define A 2\nvoid main() {}"),
        good Fragment("#define A 1\n#undef A\n#define A 2\nvoid main() {}");
    RESERVED_MACRO = "E0112" "reserved-macro-name" Error "GLSL 1.50 §3.3"
        "Names that begin with `GL_`, the predefined macros and `defined` may be neither defined nor undefined."
        bad Fragment("#define GL_MINE 1\nvoid main() {}"), good Fragment("#define MINE 1\nvoid main() {}");
    MALFORMED_PARAMETERS = "E0113" "malformed-macro-parameters" Error "GLSL 1.50 §3.3"
        "The parentheses of a function-like macro contain different names, separated by commas. GLSL has no \
         variadic macros."
        bad Fragment("#define F(a, a) a\nvoid main() {}"), good Fragment("#define F(a, b) a\nvoid main() {}");
    MACRO_ARGUMENTS = "E0114" "macro-argument-count" Error "GLSL 1.50 §3.3"
        "A use of a function-like macro must have as many arguments as the macro has parameters. Commas inside \
         parentheses do not separate arguments."
        bad Fragment("#define ADD(a, b) (a + b)\nout vec4 c;\nvoid main() { c = vec4(ADD(1.0)); }"),
        good Fragment("#define ADD(a, b) (a + b)\nout vec4 c;\nvoid main() { c = vec4(ADD(1.0, 2.0)); }");
    UNTERMINATED_MACRO_CALL = "E0115" "unterminated-macro-call" Error "GLSL 1.50 §3.3"
        "The arguments of a function-like macro end with `)` in the same file."
        bad Fragment("#define F(a) a\nout vec4 c;\nvoid main() { c = vec4(1.0) + F(1.0; }"),
        good Fragment("#define F(a) a\nout vec4 c;\nvoid main() { c = vec4(F(1.0)); }");
    INVALID_PASTE = "E0116" "invalid-token-paste" Error "GLSL 1.50 §3.3"
        "`##` joins the tokens on both its sides, which must exist and must form one valid token."
        bad Fragment("#define J(a, b) a ## b\nout vec4 c;\nvoid main() { c = vec4(1.0 J(+, *) 1.0); }"),
        good Fragment("#define J(a, b) a ## b\nout vec4 c;\nvoid main() { c J(+, =) vec4(1.0); }");
    MISPLACED_HASH = "E0117" "misplaced-hash" Error "GLSL 1.50 §3.3"
        "`#` begins a directive and must come first on its line. Macros in GLSL have only `##`: there is no `#` \
         that makes strings, since there are no strings."
        bad Fragment("out vec4 c; void main() { c = vec4(1.0); # }"),
        good Fragment("out vec4 c; void main() { c = vec4(1.0); }");
    ERROR_DIRECTIVE = "E0118" "error-directive" Error "GLSL 1.50 §3.3"
        "The text contains `#error` in an active group, so the shader counts as ill-formed. The message is the \
         author's."
        bad Fragment("#ifndef LIGHTS\n#error LIGHTS is not set\n#endif\nvoid main() {}"),
        good Fragment("#ifndef LIGHTS\n#define LIGHTS 4\n#endif\nvoid main() {}");
    MISSING_VERSION = "E0120" "missing-version" Error "GLSL 1.50 §3.3"
        "By the specification, a shader without a `#version` line is written in GLSL 1.10. This one uses what 1.10 does \
         not have, so it is written in another version and must say so. Other errors of the source are not reported \
         where they may depend on its version."
        bad Text("in vec4 a; out vec4 c; void main() { c = a; }   // this is the first line of the file"), good Fragment("#version 130\nin vec4 a; out vec4 c; void main() { c = a; }");
    UNKNOWN_VERSION = "E0121" "unknown-version" Error "GLSL 1.50 §3.3"
        "The `#version` line names a version that does not exist, or a profile that the version does not have. Other errors of the source \
         are not reported, because they depend on its version."
        bad Vertex("#version 155\nvoid main() {}"), good Vertex("#version 150\nvoid main() {}");
    LATE_VERSION = "E0123" "late-version" Error "GLSL 1.50 §3.3"
        "`#version` must come before everything but comments and white space, and may occur only once. From ES 3.00 on, \
         it is in the first line."
        bad Vertex("float a;\n#version 150\nvoid main() {}"), good Vertex("// A shader\n#version 150\nvoid main() {}");
    UNKNOWN_EXTENSION = "E0124" "unknown-extension" Error "GLSL 1.50 §3.3"
        "The source requires an extension that is not in any registry."
        bad Fragment("#extension GL_ARB_explicit_atrib_location : require\nvoid main() {}"),
        good Fragment("#extension GL_ARB_explicit_attrib_location : require\nvoid main() {}");
    UNSUPPORTED_EXTENSION = "E0125" "unsupported-extension" Error "GLSL 1.50 §3.3"
        "The source requires an extension that exists but that glisten does not implement."
        bad Fragment("#extension GL_ARB_gpu_shader_fp64 : require\nvoid main() {}"),
        good Fragment("#ifdef GL_ARB_gpu_shader_fp64\n#extension GL_ARB_gpu_shader_fp64 : require\n#endif\nvoid main() {}");
    EXTENSION_FOR_ALL = "E0126" "extension-behavior-for-all" Error "GLSL 1.50 §3.3"
        "`all` means every extension. It may be disabled or warned about, but neither enabled nor required."
        bad Fragment("#extension all : enable\nvoid main() {}"), good Fragment("#extension all : disable\nvoid main() {}");
    INCLUDE_NOT_FOUND = "E0127" "include-not-found" Error "ARB_shading_language_include"
        "The file that an `#include` names was not found or could not be read."
        bad Fragment("#extension GL_ARB_shading_language_include : require\n#include \"absent.glsl\"\nvoid main() {}"),
        good Fragment("#extension GL_ARB_shading_language_include : require\nvoid main() {}");
    INCLUDE_TOO_DEEP = "E0128" "include-too-deep" Error "ARB_shading_language_include"
        "Files include each other more than 64 levels deep. Most often a file includes itself; `#ifndef` around its \
         text or `#pragma once` stops that."
        bad Text("// light.glsl\n#include \"light.glsl\""), good Text("// light.glsl\n#ifndef LIGHT\n#define LIGHT\nvec3 light() { return vec3(1.0); }\n#endif");
    EXPANSION_TOO_LARGE = "E0129" "macro-expansion-too-large" Error "GLSL 1.50 §3.3"
        "The macros of a source may produce half a million tokens, and two more for each of its bytes. If one macro \
         uses another twice, which uses another twice and so on, some twenty of them exceed every limit."
        bad Text("#define A0 c += 1.0; c += 1.0;\n#define A1 A0 A0\n#define A2 A1 A1   // and so on, up to A20\nvoid main() { A20 }"),
        good Fragment("out vec4 c; void main() { c = vec4(0.0); for (int i = 0; i < 1000; i++) { c += 1.0; } }");
    EXPANSION_TOO_DEEP = "E0130" "macro-expansion-too-deep" Error "GLSL 1.50 §3.3"
        "Macro uses may nest 4,096 levels deep, and 64 levels deep in each other's arguments."
        bad Text("#define A0 1.0\n#define A1 (A0)\n#define A2 (A1)   // and so on, up to A4097\nfloat a = A4097;"),
        good Fragment("#define A0 1.0\n#define A1 (A0)\nout vec4 c; void main() { c = vec4(A1); }");
    MISPLACED_EXTENSION = "E0131" "misplaced-extension" Error "GLSL ES 3.00 §3.5"
        "From ES 3.00 on, `#extension` lines come before any token that does not belong to the preprocessor. In other versions this is \
         the warning W0104, since their drivers accept it."
        bad Fragment("#version 300 es\nprecision mediump float;\n#extension GL_OES_standard_derivatives : enable\nout vec4 c; void main() { c = vec4(1.0); }"),
        good Fragment("#version 300 es\n#extension GL_OES_standard_derivatives : enable\nprecision mediump float;\nout vec4 c; void main() { c = vec4(1.0); }");
    NAME_TOO_LONG = "E0132" "name-too-long" Error "GLSL ES 3.00 §3.9"
        "From ES 3.00 on, a name has at most 1,024 characters, and so has that of a macro. The desktop language leaves it to drivers."
        bad Text("#version 300 es\nuniform float aaaaaaaa;   // and so on, 1,025 times `a`"), good Fragment("#version 300 es\nvoid main() {}");

    LINE_CONTINUATION = "W0101" "line-continuation" Warning "GLSL 1.50 §3.1"
        "Before 4.20 the language had no line continuation character: a backslash at the end of a line is an \
         illegal character in 1.50. A `//` comment that ends in one is worse, since compilers differ on whether the \
         next line is code."
        bad Fragment("#define A 1.0 + \\\n    2.0\nvoid main() {}"), good Fragment("#define A 1.0 + 2.0\nvoid main() {}");
    UNDEFINED_IN_CONDITION = "W0102" "undefined-macro-in-condition" Warning "GLSL 1.50 §3.3"
        "A name that is not a macro has no value in `#if`. C treats it as 0; in GLSL it is an error. In GLSL ES, whose compilers \
         refuse it, that error is E0109."
        bad Fragment("#if USE_FOG\n#endif\nvoid main() {}"),
        good Fragment("#if defined(USE_FOG) && USE_FOG\n#endif\nvoid main() {}");
    BEFORE_VERSION = "W0103" "directive-before-version" Warning "GLSL 1.50 §3.3"
        "`#version` must come before everything but comments and white space; other directives follow it."
        bad Vertex("#define A 1\n#version 150\nvoid main() {}"), good Vertex("#version 150\n#define A 1\nvoid main() {}");
    LATE_EXTENSION = "W0104" "late-extension" Warning "GLSL 1.50 §3.3"
        "`#extension` lines must come before any token that does not belong to the preprocessor. From ES 3.00 on, compilers refuse \
         others, and this is the error E0131."
        bad Fragment("float a;\n#extension GL_ARB_draw_instanced : enable\nvoid main() {}"),
        good Fragment("#extension GL_ARB_draw_instanced : enable\nfloat a;\nvoid main() {}");
    EXTRA_TEXT = "W0105" "extra-text-after-directive" Warning "GLSL 1.50 §3.3"
        "There is text after a directive that is already complete. In GLSL ES, whose compilers refuse it, this is the error E0106."
        bad Fragment("#ifdef A\n#endif A\nvoid main() {}"), good Fragment("#ifdef A\n#endif // A\nvoid main() {}");
    EXTENSION_IGNORED = "W0106" "extension-ignored" Warning "GLSL 1.50 §3.3"
        "The source requests an extension that glisten does not implement or that is not in any registry, but does \
         not require it: nothing is enabled."
        bad Fragment("#extension GL_ARB_gpu_shader_fp64 : enable\nvoid main() {}"),
        good Fragment("#ifdef GL_ARB_gpu_shader_fp64\n#extension GL_ARB_gpu_shader_fp64 : enable\n#endif\nvoid main() {}");
    RESERVED_NAME = "W0107" "double-underscore" Warning "GLSL 1.50 §3.3, §3.6"
        "Names that contain two consecutive underscores are reserved for future keywords and predefined macros. \
         Drivers accept them; some prefix such names or warn."
        bad Fragment("#define MY__MACRO\nvoid main() {}"), good Fragment("#define MY_MACRO\nvoid main() {}");
    INCLUDE_WITHOUT_EXTENSION = "W0108" "include-without-extension" Warning "GLSL 1.50 §3.3"
        "`#include` is not a directive of GLSL 1.50. The extensions GL_ARB_shading_language_include and \
         GL_GOOGLE_include_directive provide it."
        bad Text("#include \"light.glsl\"   // without an #extension line before it"),
        good Fragment("#extension GL_GOOGLE_include_directive : enable\nvoid main() {}");
    BRANCH_IN_NO_CONFIGURATION = "W0115" "branch-in-no-configuration" Warning "GLSL 1.50 §3.3"
        "`lint --configurations` compiles a program with all values that its conditions name, in all pairs, of the macros that \
         are defined nowhere. Lines that are in none of these texts are dead, or wait for a value that no condition names."
        bad Text("#if LEVEL > 2 && LEVEL < 3   // no condition names a value between 2 and 3\nfloat unseen;\n#endif"),
        good Fragment("#if defined(LEVEL) && LEVEL > 2\n#endif\nvoid main() {}");
    ASSUMED_VERSION = "W0116" "assumed-version" Warning "GLSL ES 1.00 §3.4"
        "The source has no `#version` line, so it is GLSL 1.10 for OpenGL, and GLSL ES 1.00 for OpenGL ES and WebGL. It has \
         precision qualifiers, which 1.10 does not have, outside of `#ifdef GL_ES`; so it is read as ES 1.00, or as ES 3.00 if \
         it uses what 1.00 does not have. A `#version` line says it to everybody."
        bad Text("precision mediump float;   // this is the first line of the file\nvoid main() { gl_FragColor = vec4(1.0); }"),
        good Fragment("#version 100\nprecision mediump float;\nvoid main() { gl_FragColor = vec4(1.0); }");
    EARLY_PASTE = "W0117" "paste-before-1-30" Warning "GLSL 1.20 §3.3"
        "`##`, which joins two tokens, came with GLSL 1.30; 1.10 and 1.20 have no operator with a number sign. Some compilers \
         refuse it there. GLSL ES has it in no version, and there it is the error E0617."
        bad Fragment("#version 120\n#define J(a, b) a ## b\nvoid main() { gl_FragColor = vec4(J(1., 5)); }"),
        good Fragment("#version 130\n#define J(a, b) a ## b\nout vec4 c; void main() { c = vec4(J(1., 5)); }");
    COMMENT_ACROSS_LINES = "W0118" "comment-across-lines" Warning "GLSL 1.50 §3.4"
        "Until GLSL 4.30, and in ES 1.00, a comment does not eliminate the ends of lines, so a directive ends where a line ends inside a \
         comment. Drivers take each comment for one space, as later versions say, and the directive goes on after it."
        bad Fragment("#define ONE /* a number\n    */ 1.0\nout vec4 c; void main() { c = vec4(ONE); }"),
        good Fragment("/* a number\n    */\n#define ONE 1.0\nout vec4 c; void main() { c = vec4(ONE); }");
    UNKNOWN_STDGL_PRAGMA = "W0109" "unknown-stdgl-pragma" Warning "GLSL 1.50 §3.3"
        "Pragmas whose first word is STDGL are reserved for the language, which has only `invariant(all)`. Of the \
         others, `optimize` and `debug` take `(on)` or `(off)`. Unknown pragmas are ignored."
        bad Fragment("#pragma STDGL inline(all)\nvoid main() {}"),
        good Fragment("#pragma optimize(off)\nvoid main() {}");
    EXTENSION_USED = "W0111" "extension-used" Warning "GLSL 1.50 §3.3"
        "`#extension NAME : warn` enables an extension and requests a warning for each use of what it provides; \
         `#extension all : warn` does so for all extensions. A use that the language or another extension allows \
         does not count."
        bad Fragment("#extension GL_ARB_explicit_attrib_location : warn\nlayout(location = 0) out vec4 c; void main() { c = vec4(0.0); }"),
        good Fragment("#extension GL_ARB_explicit_attrib_location : enable\nlayout(location = 0) out vec4 c; void main() { c = vec4(0.0); }");
    PRAGMA_IN_FUNCTION = "W0112" "pragma-in-function" Warning "GLSL 1.50 §3.3"
        "`#pragma optimize` and `#pragma debug` can only be used outside function definitions."
        bad Fragment("void main() {\n#pragma optimize(off)\n}"),
        good Fragment("#pragma optimize(off)\nvoid main() {}");
    BYTE_ORDER_MARK = "W0113" "byte-order-mark" Warning "GLSL 1.50 §3.1"
        "The text begins with U+FEFF, which some editors write before UTF-8. It is not a character of the language: \
         unless the program that reads the file removes it, many drivers reject the shader at its first line."
        bad Fragment("\u{feff}#version 150\nvoid main() {}"), good Fragment("#version 150\nvoid main() {}");
    DIRECTIVE_IN_ARGUMENTS = "W0114" "directive-in-macro-arguments" Warning "GLSL 1.50 §3.3"
        "Macros are expanded as in C++, where a directive inside the arguments of a macro use has no defined \
         effect. Some drivers run it, others treat it as part of the argument."
        bad Fragment("#define F(x) x\nfloat a = F(\n#ifdef B\n2.0\n#else\n1.0\n#endif\n);\nvoid main() {}"),
        good Fragment("#define F(x) x\n#ifdef B\nfloat a = F(2.0);\n#else\nfloat a = F(1.0);\n#endif\nvoid main() {}");
    UNKNOWN_ALLOW = "W0110" "unknown-code-in-comment" Warning ""
        "A comment that begins with `glisten:` must continue with `allow(CODE, ...)`, with codes or names that \
         exist."
        bad Fragment("// glisten: allow(W9999)\nvoid main() {}"),
        good Fragment("// glisten: allow(W0102)\nvoid main() {}");
}
