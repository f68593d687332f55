//! Codes for names, scopes and declarations (`E03xx`).

use super::Example::{Fragment, Geometry, Vertex};

codes! {
    UNDECLARED = "E0301" "undeclared-identifier" Error "GLSL 1.50 §4.2"
        "A name is used where it is not declared. The scope of a declaration extends from the end of its \
         initializer to the end of the braces around it. A variable of an inner block or of a loop's header, or one \
         that is declared further down, is therefore unknown."
        bad Fragment("out vec4 c; void main() { c = vec4(lihgt); }"),
        good Fragment("uniform float light; out vec4 c; void main() { c = vec4(light); }");
    REDEFINED = "E0302" "redefinition" Error "GLSL 1.50 §4.2"
        "One scope declares a name twice. Variables, structs and functions share one name space. Only functions may be \
         declared again, and arrays without a size, to give them one. An inner scope may hide any name."
        bad Vertex("float a; int a; void main() { gl_Position = vec4(a); }"),
        good Vertex("float a; void main() { int a = 1; gl_Position = vec4(a); }");
    UNKNOWN_TYPE = "E0303" "unknown-type" Error "GLSL 1.50 §4.1"
        "A type is required here. The name is not a type of this language version, is not declared as a struct, or \
         is hidden by a variable of the same name."
        bad Vertex("void main() { Vec4 a; gl_Position = vec4(0.0); }"),
        good Vertex("void main() { vec4 a = vec4(0.0); gl_Position = a; }");
    UNKNOWN_FUNCTION = "E0304" "undeclared-function" Error "GLSL 1.50 §6.1"
        "A function is called that is neither built in nor declared before the call. A prototype above the call is \
         enough; the body may follow later."
        bad Vertex("void main() { gl_Position = f(); } vec4 f() { return vec4(0.0); }"),
        good Vertex("vec4 f(); void main() { gl_Position = f(); } vec4 f() { return vec4(0.0); }");
    RESERVED_NAME = "E0305" "reserved-name" Error "GLSL 1.50 §3.7"
        "Names that start with `gl_` belong to OpenGL. A shader may redeclare a few of the built-in ones, and no \
         others."
        bad Vertex("uniform vec4 gl_Color2; void main() { gl_Position = gl_Color2; }"),
        good Vertex("uniform vec4 color; void main() { gl_Position = color; }");
    NO_MEMBER = "E0306" "no-such-member" Error "GLSL 1.50 §5.7"
        "A struct or block has no member of this name, or the value has no members at all."
        bad Fragment("struct Light { vec3 color; }; uniform Light l; out vec4 c; void main() { c = vec4(l.colour, 1.0); }"),
        good Fragment("struct Light { vec3 color; }; uniform Light l; out vec4 c; void main() { c = vec4(l.color, 1.0); }");
    NOT_A_VARIABLE = "E0307" "not-a-variable" Error "GLSL 1.50 §4.2"
        "A value is required, but the name is that of a function or a type."
        bad Vertex("float f() { return 1.0; } void main() { gl_Position = vec4(f); }"),
        good Vertex("float f() { return 1.0; } void main() { gl_Position = vec4(f()); }");
    BUILTIN_UNAVAILABLE = "E0308" "builtin-unavailable" Error "GLSL 1.50 §7"
        "The variable or function is built in, but it is not available in this stage, or not in this version \
         without an extension."
        bad Vertex("void main() { gl_Position = gl_FragCoord; }"),
        good Fragment("out vec4 c; void main() { c = gl_FragCoord; }");
    BLOCK_NAME = "E0309" "block-name-reused" Error "GLSL 1.50 §4.3.7"
        "At global scope the name of a block means only the block: the stages and the application find it by this \
         name. Give the variable or the instance another name."
        bad Vertex("uniform Light { vec4 color; }; vec4 Light; void main() { gl_Position = color; }"),
        good Vertex("uniform Light { vec4 color; }; vec4 light; void main() { light = color; gl_Position = light; }");
    BUILTIN_REDECLARED = "E0310" "builtin-redeclared" Error "GLSL 1.50 §7"
        "Only a few built-in variables may be redeclared: `gl_ClipDistance` and `gl_in` to set their size, \
         `gl_FragCoord` to choose its origin. Their types and storage must stay the same."
        bad Vertex("out vec4 gl_Position; void main() { gl_Position = vec4(0.0); }"),
        good Vertex("out float gl_ClipDistance[2]; void main() { gl_ClipDistance[1] = 1.0; gl_Position = vec4(0.0); }");
    REDECLARED_AFTER_USE = "E0311" "redeclared-after-use" Error "GLSL 1.50 §4.6.1, §4.3.8.1"
        "A declaration that changes a variable, such as `invariant` or another layout of `gl_FragCoord`, must \
         precede the variable's first use."
        bad Vertex("out vec4 a; void f() { a = vec4(0.0); } invariant a; void main() { f(); gl_Position = vec4(0.0); }"),
        good Vertex("out vec4 a; invariant a; void main() { a = vec4(0.0); gl_Position = vec4(0.0); }");
    NOT_A_FUNCTION = "E0312" "not-a-function" Error "GLSL 1.50 §4.2"
        "A variable is called like a function. A variable hides the functions of its name, including built-in ones, \
         to the end of its scope."
        bad Fragment("out vec4 c; void main() { float dot = 1.0; c = vec4(dot(vec2(1.0), vec2(1.0))); }"),
        good Fragment("out vec4 c; void main() { float d = dot(vec2(1.0), vec2(1.0)); c = vec4(d); }");
    PER_VERTEX = "E0313" "gl-per-vertex-redeclared" Error "ARB_separate_shader_objects"
        "The block `gl_PerVertex` may be redeclared to select its members: once, before any of them is used, only \
         with members that it has and their own types, and as `gl_in[]` for a geometry shader's input."
        bad Geometry("layout(points) in; layout(points, max_vertices = 1) out; \
            in gl_PerVertex { vec4 gl_Position; } verts[]; void main() { EmitVertex(); }"),
        good Geometry("layout(points) in; layout(points, max_vertices = 1) out; \
            in gl_PerVertex { vec4 gl_Position; } gl_in[]; \
            void main() { gl_Position = gl_in[0].gl_Position; EmitVertex(); }");
}
