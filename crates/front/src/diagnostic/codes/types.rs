//! Codes for types, expressions and constants (`E04xx`).

use super::Example::{Fragment, Geometry, Vertex};

codes! {
    MISMATCH = "E0401" "type-mismatch" Error "GLSL 1.50 §5.8, §4.1.10"
        "A value does not have the type that is required. Only integers implicitly become `float` (and their \
         vectors); any other conversion needs a constructor."
        bad Fragment("out vec4 c; void main() { int i = 1.5; c = vec4(i); }"),
        good Fragment("out vec4 c; void main() { int i = int(1.5); c = vec4(i); }");
    OPERANDS = "E0402" "bad-operands" Error "GLSL 1.50 §5.9"
        "The operator is not defined for operands of these types. Vectors must have the same size, `int` and `uint` \
         cannot be mixed, `%` and the bit operators require integers, relational operators require scalars, and \
         logical operators require a `bool`."
        bad Fragment("out vec4 c; void main() { c = vec4(vec3(1.0) + vec2(1.0), 1.0); }"),
        good Fragment("out vec4 c; void main() { c = vec4(vec3(1.0) + vec3(1.0), 1.0); }");
    NO_OVERLOAD = "E0403" "no-matching-overload" Error "GLSL 1.50 §6.1"
        "No function of this name accepts arguments of these types, exactly or after implicit conversions."
        bad Fragment("out vec4 c; void main() { c = vec4(dot(vec3(1.0), 2.0)); }"),
        good Fragment("out vec4 c; void main() { c = vec4(dot(vec3(1.0), vec3(2.0))); }");
    AMBIGUOUS_CALL = "E0404" "ambiguous-call" Error "GLSL 1.50 §6.1"
        "No overload accepts the arguments as they are, and more than one accepts them after implicit conversions. \
         1.50 has no rule that prefers one of them."
        bad Fragment("float f(float a, int b) { return a; } float f(int a, float b) { return b; } out vec4 c; \
            void main() { c = vec4(f(1, 2)); }"),
        good Fragment("float f(float a, int b) { return a; } float f(int a, float b) { return b; } out vec4 c; \
            void main() { c = vec4(f(1.0, 2)); }");
    NOT_AN_LVALUE = "E0405" "not-an-lvalue" Error "GLSL 1.50 §5.8"
        "Only a variable, or a part of one, can be written to, and not if it is a constant, a uniform, an input, a \
         `const` parameter or a sampler. A swizzle that names a component twice cannot be written to either."
        bad Fragment("uniform vec4 u; out vec4 c; void main() { u.x = 1.0; c = u; }"),
        good Fragment("uniform vec4 u; out vec4 c; void main() { vec4 a = u; a.x = 1.0; c = a; }");
    SWIZZLE = "E0406" "bad-swizzle" Error "GLSL 1.50 §5.5"
        "Components are named by one of the sets `xyzw`, `rgba`, `stpq`: at most four at once, all from the same \
         set, and only those that the vector has."
        bad Fragment("uniform vec2 u; out vec4 c; void main() { c = vec4(u.z); }"),
        good Fragment("uniform vec3 u; out vec4 c; void main() { c = vec4(u.z); }");
    CONSTRUCTOR = "E0407" "bad-constructor" Error "GLSL 1.50 §5.4"
        "A constructor needs enough components, and must not have arguments after the last one that it uses. \
         Structs and arrays take one argument for each member or element; a matrix constructed from a matrix takes \
         no other argument."
        bad Fragment("out vec4 c; void main() { c = vec4(1.0, 2.0); }"),
        good Fragment("out vec4 c; void main() { c = vec4(1.0, 2.0, 0.0, 1.0); }");
    NOT_CONSTANT = "E0408" "not-constant" Error "GLSL 1.50 §4.3.3"
        "A constant expression is required here: literals, `const` variables, operators, constructors, and built-in \
         functions of those. Functions of the shader never count, nor do parameters that are `const`."
        bad Vertex("uniform int n; void main() { float a[n]; gl_Position = vec4(0.0); }"),
        good Vertex("const int n = 2; void main() { float a[n]; a[0] = 1.0; gl_Position = vec4(a[0]); }");
    ARRAY_SIZE = "E0409" "bad-array-size" Error "GLSL 1.50 §4.1.9"
        "The size of an array must be an integer greater than zero, within the limits of what a target can bind."
        bad Vertex("uniform float a[0]; void main() { gl_Position = vec4(0.0); }"),
        good Vertex("uniform float a[1]; void main() { gl_Position = vec4(a[0]); }");
    INDEX_RANGE = "E0410" "index-out-of-range" Error "GLSL 1.50 §4.1.9, §5.5, §5.6"
        "A constant index is outside the array, vector or matrix, or a gather names a component that is none of 0, 1, 2 and 3. An \
         index that is not constant is not checked; the value is then undefined."
        bad Vertex("uniform vec4 a[2]; void main() { gl_Position = a[2]; }"),
        good Vertex("uniform vec4 a[2]; void main() { gl_Position = a[1]; }");
    INDEX = "E0411" "bad-index" Error "GLSL 1.50 §5.7"
        "Arrays, vectors and matrices are indexed by one `int` or `uint`."
        bad Vertex("uniform vec4 a[2]; void main() { gl_Position = a[1.0]; }"),
        good Vertex("uniform vec4 a[2]; void main() { gl_Position = a[1]; }");
    ARRAY_OF_ARRAYS = "E0412" "array-of-arrays" Error "GLSL 1.50 §4.1.9"
        "Arrays have one dimension before GLSL 4.30. A struct that contains an array may be an array's element."
        bad Vertex("uniform float a[2][3]; void main() { gl_Position = vec4(0.0); }"),
        good Vertex("struct Row { float a[3]; }; uniform Row r[2]; void main() { gl_Position = vec4(r[1].a[2]); }");
    SAMPLER = "E0413" "sampler-misused" Error "GLSL 1.50 §4.1.7"
        "Samplers, and structs that contain one, are uniforms or `in` parameters: they cannot be computed, \
         returned, stored in variables, or be in blocks."
        bad Fragment("sampler2D s; out vec4 c; void main() { c = texture(s, vec2(0.0)); }"),
        good Fragment("uniform sampler2D s; out vec4 c; void main() { c = texture(s, vec2(0.0)); }");
    UNSIZED_ARRAY = "E0414" "unsized-array" Error "GLSL 1.50 §4.1.9"
        "An array without a size can only be indexed with constants. To be indexed in any other way, passed, \
         assigned, returned, compared or asked for its length, it must have a size by then. Members of structs, \
         parameters, return types and elements of arrays must always have one."
        bad Vertex("float a[]; uniform int i; void main() { gl_Position = vec4(a[i]); }"),
        good Vertex("float a[4]; uniform int i; void main() { gl_Position = vec4(a[i]); }");
    UNSIZED_CLIP_DISTANCES = "W0401" "unsized-clip-distances" Warning "GLSL 1.50 §4.1.9, §7.1"
        "`gl_ClipDistance` has the size that its redeclaration or its constant indices give it, and an array without a \
         size cannot be assigned. Drivers take it where a geometry shader passes the clip distances on, so this is a \
         warning: as many are copied as the shader has indexed by then, one if it has indexed none. `--strict` makes it an error."
        bad Geometry("layout(points) in; layout(points, max_vertices = 1) out; void main() { \
            gl_Position = gl_in[0].gl_Position; gl_ClipDistance = gl_in[0].gl_ClipDistance; EmitVertex(); }"),
        good Geometry("layout(points) in; layout(points, max_vertices = 1) out; void main() { \
            gl_Position = gl_in[0].gl_Position; gl_ClipDistance[0] = gl_in[0].gl_ClipDistance[0]; EmitVertex(); }");
    VOID_VALUE = "E0415" "void-value" Error "GLSL 1.50 §4.1.1"
        "`void` is only for functions that return nothing; such a call is not a value."
        bad Vertex("void f() {} void main() { float a = float(f()); gl_Position = vec4(a); }"),
        good Vertex("float f() { return 1.0; } void main() { float a = f(); gl_Position = vec4(a); }");
    METHOD = "E0416" "bad-method" Error "GLSL 1.50 §5.7"
        "The only method is `length()`, without arguments, of an array. The length of a vector is the function \
         `length`."
        bad Vertex("uniform vec3 v; void main() { gl_Position = vec4(v.length()); }"),
        good Vertex("uniform vec3 v; void main() { gl_Position = vec4(length(v)); }");
    STRUCT = "E0417" "bad-struct" Error "GLSL 1.50 §4.1.8"
        "A struct has at least one member, each with a name and without an initializer. Structs are declared on \
         their own: not inside a struct or block, nor in a parameter."
        bad Vertex("struct S { struct T { float a; } t; }; void main() { gl_Position = vec4(0.0); }"),
        good Vertex("struct T { float a; }; struct S { T t; }; uniform S s; void main() { gl_Position = vec4(s.t.a); }");
    SAMPLER_INDEX = "E0418" "index-must-be-constant" Error "GLSL 1.50 §4.1.7, §4.3.7"
        "From GLSL 1.30 to 3.30, and in ES 3.00 and 3.10, arrays of samplers and of uniform blocks can only be indexed \
         with constant expressions; the counter of a loop is not one. Earlier and later versions allow any index."
        bad Fragment("uniform sampler2D s[2]; uniform int i; out vec4 c; void main() { c = texture(s[i], vec2(0.0)); }"),
        good Fragment("uniform sampler2D s[2]; out vec4 c; void main() { c = texture(s[1], vec2(0.0)); }");
    CONDITION = "E0419" "condition-not-bool" Error "GLSL 1.50 §6.2, §6.3"
        "The condition of `if`, loops and `?:` must be one `bool`. Compare numbers first, and use `any` or `all` \
         for vectors of booleans."
        bad Fragment("uniform int i; out vec4 c; void main() { c = vec4(0.0); if (i) c = vec4(1.0); }"),
        good Fragment("uniform int i; out vec4 c; void main() { c = vec4(0.0); if (i != 0) c = vec4(1.0); }");
    LIST = "E0420" "bad-initializer-list" Error "ARB_shading_language_420pack"
        "A list in braces initializes a variable of a vector, matrix, array or struct type. It has as many entries \
         as the type has components, columns, elements or members."
        bad Fragment("#extension GL_ARB_shading_language_420pack : enable\nout vec4 c; void main() { vec3 a = {1.0, 2.0}; c = vec4(a, 1.0); }"),
        good Fragment("#extension GL_ARB_shading_language_420pack : enable\nout vec4 c; void main() { vec2 a = {1.0, 2.0}; c = vec4(a, a); }");
    TOO_LARGE = "E0422" "too-large-to-bind" Error "OpenGL 3.2 §2.11.4"
        "A type may contain 1,048,576 numbers, and so may all variables of a function, or those of a shader without \
         its uniforms; all uniforms of a shader may contain 262,144. A shader may have 4,096 inputs, outputs, \
         blocks and samplers. No target can bind more."
        bad Vertex("struct A { mat4 m[4096]; }; struct B { A a[16]; }; uniform B b[2]; void main() { gl_Position = b[0].a[0].m[0][0]; }"),
        good Vertex("struct A { mat4 m[16]; }; struct B { A a[16]; }; uniform B b[2]; void main() { gl_Position = b[0].a[0].m[0][0]; }");
    OFFSET_RANGE = "E0423" "texel-offset-out-of-range" Error "GLSL 1.50 §8.7"
        "The offset of a texture lookup is from -8 to 7 texels in each direction: the range that every implementation has \
         (gl_MinProgramTexelOffset, gl_MaxProgramTexelOffset)."
        bad Fragment("uniform sampler2D t; out vec4 c; void main() { c = textureOffset(t, vec2(0.5), ivec2(8, 0)); }"),
        good Fragment("uniform sampler2D t; out vec4 c; void main() { c = textureOffset(t, vec2(0.5), ivec2(7, 0)); }");
    PRECISION_TYPE = "E0421" "bad-precision-type" Error "GLSL 1.50 §4.5.2, §4.5.3"
        "Integers and floats, and their vectors and matrices, may be declared with a precision; booleans and \
         structs cannot. Only `int` and `float` have a default precision."
        bad Fragment("precision highp vec4; out vec4 c; void main() { c = vec4(0.0); }"),
        good Fragment("precision highp float; out vec4 c; void main() { c = vec4(0.0); }");
}
