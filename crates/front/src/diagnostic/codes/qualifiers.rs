//! Codes for qualifiers, layouts, blocks and built-in variables (`E06xx`).

use super::Example::{Fragment, Geometry, Vertex};

codes! {
    REPEATED = "E0601" "repeated-qualifier" Error "GLSL 1.50 §4.3"
        "A declaration has at most one qualifier of each kind: one for storage, one for interpolation, one for precision."
        bad Vertex("uniform in vec4 a; void main() { gl_Position = a; }"),
        good Vertex("in vec4 a; void main() { gl_Position = a; }");
    ORDER = "E0602" "qualifier-order" Error "GLSL 1.50 §4.7"
        "Before GLSL 4.20, qualifiers must be in a fixed order: layout, `invariant`, interpolation, `centroid`, \
         storage, precision; for a parameter `const`, then `in`, `out` or `inout`, then precision. \
         GL_ARB_shading_language_420pack lifts this rule."
        bad Fragment("in flat vec4 a; out vec4 c; void main() { c = a; }"),
        good Fragment("flat in vec4 a; out vec4 c; void main() { c = a; }");
    MISPLACED = "E0603" "misplaced-qualifier" Error "GLSL 1.50 §4.3 to §4.6"
        "The qualifier does not apply to this declaration. Interpolation qualifiers belong to what is interpolated \
         between stages, `in` and `out` to globals and parameters; a local variable can only be `const`."
        bad Vertex("flat in vec4 a; void main() { gl_Position = a; }"),
        good Vertex("in vec4 a; void main() { gl_Position = a; }");
    UNKNOWN_LAYOUT = "E0604" "unknown-layout" Error "GLSL 1.50 §4.3.8"
        "This version has no layout identifier of this name. In 1.50, layout identifiers are not case-sensitive."
        bad Fragment("layout(upper_left) in vec4 gl_FragCoord; out vec4 c; void main() { c = gl_FragCoord; }"),
        good Fragment("layout(origin_upper_left) in vec4 gl_FragCoord; out vec4 c; void main() { c = gl_FragCoord; }");
    LAYOUT_PLACE = "E0605" "misplaced-layout" Error "GLSL 1.50 §4.3.8"
        "Each layout identifier belongs to one kind of declaration: locations to vertex inputs and fragment \
         outputs, std140 and the other block layouts to uniform blocks, primitives to `in` and `out` on their own \
         in a geometry shader."
        bad Vertex("layout(std140) uniform vec4 a; void main() { gl_Position = a; }"),
        good Vertex("layout(std140) uniform B { vec4 a; }; void main() { gl_Position = a; }");
    LAYOUT_OF_STRUCT = "W0601" "layout-of-struct" Warning "GLSL 1.50 §4.3.8"
        "A struct has no layout of its own: that of the block decides in which it stands. Drivers ignore one before a \
         struct that declares no variable, so this is a warning; `--strict` makes it an error."
        bad Fragment("layout(std140) struct S { vec4 a; }; uniform S s; out vec4 c; void main() { c = s.a; }"),
        good Fragment("struct S { vec4 a; }; layout(std140) uniform B { S s; }; out vec4 c; void main() { c = s.a; }");
    LAYOUT_VALUE = "E0606" "layout-value" Error "GLSL 1.50 §4.3.8"
        "Some layout identifiers take a value, a non-negative integer literal; the others take none."
        bad Geometry("layout(points) in; layout(points, max_vertices) out; void main() {}"),
        good Geometry("layout(points) in; layout(points, max_vertices = 1) out; void main() {}");
    INTERFACE_TYPE = "E0607" "bad-interface-type" Error "GLSL 1.50 §4.3.4, §4.3.6"
        "Not every type can cross the interface of a stage: booleans never can, structs can neither enter a vertex \
         shader nor leave a fragment shader, and matrices cannot leave a fragment shader."
        bad Vertex("in bool b; void main() { gl_Position = vec4(b); }"),
        good Vertex("in int b; void main() { gl_Position = vec4(b != 0); }");
    INTEGER_NOT_FLAT = "E0608" "integer-not-flat" Error "GLSL 1.50 §4.3.4"
        "Integers are not interpolated, so an input of a fragment shader that is or contains an integer must be \
         `flat`. In 1.30, 1.40 and ES 3.00, so must an output of a vertex shader."
        bad Fragment("in ivec2 i; out vec4 c; void main() { c = vec4(i, i); }"),
        good Fragment("flat in ivec2 i; out vec4 c; void main() { c = vec4(i, i); }");
    CONST_WITHOUT_VALUE = "E0609" "const-without-value" Error "GLSL 1.50 §4.3.2"
        "A constant can never be written, so its declaration must give it a value."
        bad Vertex("const float a; void main() { gl_Position = vec4(a); }"),
        good Vertex("const float a = 1.0; void main() { gl_Position = vec4(a); }");
    NO_INITIALIZER = "E0610" "initializer-not-allowed" Error "GLSL 1.50 §4.3"
        "Only constants, uniforms and variables without a storage qualifier have initializers; inputs and outputs have \
         none, and samplers are set by the application."
        bad Vertex("in vec4 a = vec4(0.0); void main() { gl_Position = a; }"),
        good Vertex("uniform vec4 a = vec4(0.0); void main() { gl_Position = a; }");
    BLOCK = "E0611" "bad-block" Error "GLSL 1.50 §4.3.7"
        "A block is `in`, `out` or `uniform`, and its members cannot differ from that. A vertex shader has no input \
         blocks and a fragment shader no output blocks."
        bad Vertex("in B { vec4 a; }; void main() { gl_Position = a; }"),
        good Vertex("uniform B { vec4 a; }; void main() { gl_Position = a; }");
    GEOMETRY_INPUT = "E0612" "bad-geometry-input" Error "GLSL 1.50 §4.3.4, §4.3.8.1"
        "A geometry shader sees all vertices of a primitive, so its inputs are arrays. Their sizes, if they are \
         given, and that of the input primitive must be the same."
        bad Geometry("layout(points) in; layout(points, max_vertices = 1) out; in vec4 a; void main() {}"),
        good Geometry("layout(points) in; layout(points, max_vertices = 1) out; in vec4 a[]; void main() {}");
    GEOMETRY_LAYOUT = "E0613" "geometry-layout-contradiction" Error "GLSL 1.50 §4.3.8.1, §4.3.8.2"
        "A geometry shader has one input primitive, one output primitive, and one largest number of emitted \
         vertices, which is at most gl_MaxGeometryOutputVertices. Repeated declarations must agree."
        bad Geometry("layout(points) in; layout(lines) in; layout(points, max_vertices = 1) out; void main() {}"),
        good Geometry("layout(points) in; layout(points) in; layout(points, max_vertices = 1) out; void main() {}");
    FRAG_COORD = "E0614" "frag-coord-contradiction" Error "GLSL 1.50 §4.3.8.1"
        "All declarations of `gl_FragCoord` in a program must have the same layout."
        bad Fragment("layout(origin_upper_left) in vec4 gl_FragCoord; in vec4 gl_FragCoord; out vec4 c; \
            void main() { c = gl_FragCoord; }"),
        good Fragment("layout(origin_upper_left) in vec4 gl_FragCoord; layout(origin_upper_left) in vec4 gl_FragCoord; \
            out vec4 c; void main() { c = gl_FragCoord; }");
    OUTPUTS_EXCLUDE = "E0615" "outputs-exclude-each-other" Error "GLSL 1.50 §7.2"
        "A fragment shader writes either `gl_FragColor`, or `gl_FragData`, or the outputs that it declares, but not \
         two of these."
        bad Fragment("out vec4 c; void main() { c = vec4(0.0); gl_FragColor = vec4(1.0); }"),
        good Fragment("out vec4 c; void main() { c = vec4(0.0); }");
    INVARIANT = "E0616" "not-invariant" Error "GLSL 1.50 §4.6.1"
        "Only outputs of a shader can be invariant, and inputs of a fragment shader that such an output feeds."
        bad Vertex("uniform vec4 a; invariant a; void main() { gl_Position = a; }"),
        good Vertex("out vec4 a; invariant a; void main() { a = vec4(0.0); gl_Position = a; }");
    GLOBAL_INITIALIZER = "W0602" "global-initializer" Warning "GLSL ES 1.00 §4.3"
        "In GLSL ES 1.00, the initializer of a global variable must be a constant expression. WebGL accepts uniforms and other \
         global variables there with a warning, for the sake of old sources; other implementations reject them."
        bad Fragment("#version 100\nprecision highp float; uniform float u; float a = 2.0 * u; void main() { gl_FragColor = vec4(a); }"),
        good Fragment("#version 100\nprecision highp float; uniform float u; float a; void main() { a = 2.0 * u; gl_FragColor = vec4(a); }");
    NEEDS_EXTENSION = "E0617" "needs-extension" Error "GLSL 1.50 §3.3"
        "This version of the language does not have the construct. A later version has it, or an earlier one, or an \
         extension provides it that the source can enable; the message says which. docs/versions.md lists the versions."
        bad Vertex("layout(location = 1) in vec4 a; void main() { gl_Position = a; }"),
        good Vertex("#extension GL_ARB_explicit_attrib_location : enable\nlayout(location = 1) in vec4 a; \
            void main() { gl_Position = a; }");
    MISSING_PRECISION = "E0618" "missing-precision" Error "GLSL ES 3.00 §4.5.4"
        "In GLSL ES, `float` has no default precision in fragment shaders, and neither have the samplers that came with \
         ES 3.00 in any stage. A precision statement gives one, or each declaration names its own. OpenGL's language has \
         no precision and needs none."
        bad Fragment("#version 300 es\nout vec4 c; void main() { c = vec4(1.0); }"),
        good Fragment("#version 300 es\nprecision highp float; out vec4 c; void main() { c = vec4(1.0); }");
    MISSING_LOCATION = "E0619" "missing-output-location" Error "GLSL ES 3.00 §4.3.8.2"
        "In GLSL ES, a fragment shader with more than one output says the location of each. OpenGL's language leaves the choice to \
         the host and the linker."
        bad Fragment("#version 300 es\nprecision highp float; out vec4 a; out vec4 b; void main() { a = b = vec4(1.0); }"),
        good Fragment("#version 300 es\nprecision highp float; layout(location = 0) out vec4 a; layout(location = 1) out vec4 b; \
            void main() { a = b = vec4(1.0); }");
}
