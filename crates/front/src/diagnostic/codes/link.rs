//! Codes of the phase `link` (`E07xx`, `W07xx`).

use super::Example::{Fragment, Geometry, Program, Shaders, Text, Vertex};
use crate::language::Stage;

codes! {
    MISSING_MAIN = "E0701" "missing-main" Error "GLSL 1.50 §6.1"
        "Every stage of a program needs a function `main` without parameters or a result. It may be defined in any \
         one of the shaders of the stage."
        bad Program(
            "out float x; void mian() { x = 1.0; gl_Position = vec4(0.0); }",
            "in float x; out vec4 c; void main() { c = vec4(x); }"),
        good Program(
            "out float x; void main() { x = 1.0; gl_Position = vec4(0.0); }",
            "in float x; out vec4 c; void main() { c = vec4(x); }");
    NO_MATCHING_OUTPUT = "E0702" "no-matching-output" Error "GLSL 1.50 §4.3.4"
        "An input that a stage reads must be an output of the previous stage with the same name; blocks match by \
         their block names. An input that is declared but never read needs no partner."
        bad Program(
            "out vec4 color; void main() { color = vec4(1.0); gl_Position = vec4(0.0); }",
            "in vec4 colour; out vec4 c; void main() { c = colour; }"),
        good Program(
            "out vec4 color; void main() { color = vec4(1.0); gl_Position = vec4(0.0); }",
            "in vec4 color; out vec4 c; void main() { c = color; }");
    INTERFACE_TYPE_MISMATCH = "E0703" "interface-type-mismatch" Error "GLSL 1.50 §4.3.4"
        "An output and the input of the same name in the next stage must have the same type, array size included. The \
         inputs of a geometry shader are arrays of what the vertex shader writes."
        bad Program(
            "out vec3 v; void main() { v = vec3(1.0); gl_Position = vec4(0.0); }",
            "in vec4 v; out vec4 c; void main() { c = v; }"),
        good Program(
            "out vec4 v; void main() { v = vec4(1.0); gl_Position = vec4(0.0); }",
            "in vec4 v; out vec4 c; void main() { c = v; }");
    INTERPOLATION_MISMATCH = "E0704" "interpolation-mismatch" Error "GLSL 1.50 §4.3.9"
        "The interpolation qualifiers of an output and of the input that it feeds must be the same, and must be on \
         both sides or on neither. From 4.30 on they may differ, and the qualifier of the fragment stage counts."
        bad Program(
            "out vec4 v; void main() { v = vec4(1.0); gl_Position = vec4(0.0); }",
            "flat in vec4 v; out vec4 c; void main() { c = v; }"),
        good Program(
            "noperspective out vec4 v; void main() { v = vec4(1.0); gl_Position = vec4(0.0); }",
            "noperspective in vec4 v; out vec4 c; void main() { c = v; }");
    QUALIFIER_MISMATCH = "E0705" "qualifier-mismatch" Error "GLSL 1.50 §4.3.9"
        "`centroid`, `sample` and `invariant` must be on both sides of an interface between stages, or on neither. From 4.30 and \
         ES 3.10 on, the qualifiers of the fragment stage count alone."
        bad Program(
            "centroid out vec4 v; void main() { v = vec4(1.0); gl_Position = vec4(0.0); }",
            "in vec4 v; out vec4 c; void main() { c = v; }"),
        good Program(
            "centroid out vec4 v; void main() { v = vec4(1.0); gl_Position = vec4(0.0); }",
            "centroid in vec4 v; out vec4 c; void main() { c = v; }");
    INTERFACE_BLOCK_MISMATCH = "E0706" "interface-block-mismatch" Error "GLSL 1.50 §4.3.7"
        "An output block and the input block of the same block name must have the same number of members in the \
         same order, with the same names, types and qualifiers, and the same array size. Instance names may differ."
        bad Program(
            "out B { vec4 a; vec4 b; } o; void main() { o.a = o.b = vec4(1.0); gl_Position = vec4(0.0); }",
            "in B { vec4 b; vec4 a; } i; out vec4 c; void main() { c = i.a; }"),
        good Program(
            "out B { vec4 a; vec4 b; } o; void main() { o.a = o.b = vec4(1.0); gl_Position = vec4(0.0); }",
            "in B { vec4 a; vec4 b; } i; out vec4 c; void main() { c = i.a; }");
    UNIFORM_TYPE_MISMATCH = "E0707" "uniform-type-mismatch" Error "GLSL 1.50 §4.3.5"
        "All shaders of a program share one name space of uniforms: a name must have the same type wherever it is \
         declared, and no two explicit locations or bindings."
        bad Program(
            "uniform vec3 u; void main() { gl_Position = vec4(u, 1.0); }",
            "uniform vec4 u; out vec4 c; void main() { c = u; }"),
        good Program(
            "uniform vec4 u; void main() { gl_Position = u; }",
            "uniform vec4 u; out vec4 c; void main() { c = u; }");
    UNIFORM_INITIALIZER_MISMATCH = "E0708" "uniform-initializer-mismatch" Error "GLSL 1.50 §4.3.5"
        "A uniform may be initialized in one shader and not in another, but all initializers must be equal."
        bad Program(
            "uniform float u = 1.0; void main() { gl_Position = vec4(u); }",
            "uniform float u = 2.0; out vec4 c; void main() { c = vec4(u); }"),
        good Program(
            "uniform float u = 1.0; void main() { gl_Position = vec4(u); }",
            "uniform float u; out vec4 c; void main() { c = vec4(u); }");
    UNIFORM_BLOCK_MISMATCH = "E0709" "uniform-block-mismatch" Error "OpenGL 3.2 §2.11.4"
        "A uniform block that is declared in several shaders must be the same in all of them: layout, binding, members with \
         their names, types and matrix order, array size, and whether it has an instance name."
        bad Program(
            "layout(std140) uniform B { vec4 a; }; void main() { gl_Position = a; }",
            "layout(std140) uniform B { vec3 a; }; out vec4 c; void main() { c = a.xyzz; }"),
        good Program(
            "layout(std140) uniform B { vec4 a; }; void main() { gl_Position = a; }",
            "layout(std140) uniform B { vec4 a; }; out vec4 c; void main() { c = a; }");
    TOO_MANY_ATTRIBUTES = "E0710" "too-many-attributes" Error "OpenGL 3.2 §2.11.3"
        "There are 16 attribute locations. A scalar or vector takes one, a matrix one for each column, an array as \
         many as its elements. Attributes that nothing reads take none."
        bad Vertex("in mat4 m[4]; in vec4 v; void main() { gl_Position = m[0] * m[1] * m[2] * m[3] * v; }"),
        good Vertex("in mat4 m[3]; in vec4 v; void main() { gl_Position = m[0] * m[1] * m[2] * v; }");
    ATTRIBUTE_ALIASING = "E0711" "attribute-aliasing" Error "OpenGL 3.2 §2.11.3"
        "Two attributes have the same location, and one execution of the shader may read both. Only one of them can \
         have its own data. In ES from 3.00 on, no two may have the same location, read or not."
        bad Vertex("#extension GL_ARB_explicit_attrib_location : enable\nlayout(location = 1) in vec4 a;\n\
                    layout(location = 1) in vec4 b; void main() { gl_Position = a + b; }"),
        good Vertex("#extension GL_ARB_explicit_attrib_location : enable\nlayout(location = 1) in vec4 a;\n\
                     layout(location = 2) in vec4 b; void main() { gl_Position = a + b; }");
    OUTPUT_CONFLICT = "E0712" "output-conflict" Error "GLSL 1.50 §7.2"
        "A fragment stage writes either `gl_FragColor`, or elements of `gl_FragData`, or its own outputs. It must \
         not write two of these, even in different shaders of the stage."
        bad Shaders(&[
            (Stage::Fragment, "void tint(); void main() { tint(); gl_FragColor = vec4(1.0); }"),
            (Stage::Fragment, "out vec4 c; void tint() { c = vec4(0.5); }"),
        ]),
        good Shaders(&[
            (Stage::Fragment, "out vec4 c; void tint(); void main() { tint(); }"),
            (Stage::Fragment, "out vec4 c; void tint() { c = vec4(0.5); }"),
        ]);
    OUTPUT_OVERLAP = "E0713" "output-overlap" Error "OpenGL 3.2 §3.9.2"
        "Two outputs have the same color number and index."
        bad Fragment("#extension GL_ARB_explicit_attrib_location : enable\nlayout(location = 0) out vec4 a;\n\
                      layout(location = 0) out vec4 b; void main() { a = b = vec4(1.0); }"),
        good Fragment("#extension GL_ARB_explicit_attrib_location : enable\nlayout(location = 0) out vec4 a;\n\
                       layout(location = 1) out vec4 b; void main() { a = b = vec4(1.0); }");
    TOO_MANY_OUTPUTS = "E0714" "too-many-outputs" Error "OpenGL 3.2 §3.9.2"
        "There are eight color numbers, from 0 to 7. An array of outputs takes one for each element."
        bad Fragment("out vec4 a[6]; out vec4 b[3]; void main() { a[0] = b[0] = vec4(1.0); }"),
        good Fragment("out vec4 a[6]; out vec4 b[2]; void main() { a[0] = b[0] = vec4(1.0); }");
    VARYING_OVERLAP = "E0731" "varying-overlap" Error "GLSL 4.40 §4.4.1"
        "Each component of a location between two stages belongs to one varying. Several varyings share a location if each \
         has a `component` of its own, and all have the same type of numbers and the same interpolation."
        bad Vertex("#version 440\nlayout(location = 0) out vec2 a; layout(location = 0) out vec2 b; \
            void main() { a = b = vec2(0.0); gl_Position = vec4(0.0); }"),
        good Vertex("#version 440\nlayout(location = 0) out vec2 a; layout(location = 0, component = 2) out vec2 b; \
            void main() { a = b = vec2(0.0); gl_Position = vec4(0.0); }");
    TOO_MANY_VARYINGS = "E0715" "too-many-varyings" Error "GLSL 1.50 §7.4"
        "The varyings take more than 32 locations of four components, even when scalars and vectors share \
         locations. No target has more."
        bad Program(
            "out vec4 v[40]; void main() { v[0] = vec4(1.0); gl_Position = vec4(0.0); }",
            "in vec4 v[40]; out vec4 c; void main() { c = v[0]; }"),
        good Program(
            "out vec4 v[4]; void main() { v[0] = vec4(1.0); gl_Position = vec4(0.0); }",
            "in vec4 v[4]; out vec4 c; void main() { c = v[0]; }");
    TOO_MANY_SAMPLERS = "E0716" "too-many-samplers" Error "GLSL 1.50 §7.4"
        "The program declares more than a thousand samplers, counting each element of an array."
        bad Fragment("uniform sampler2D t[2000]; out vec4 c; void main() { c = texture(t[0], vec2(0.0)); }"),
        good Fragment("uniform sampler2D t[2]; out vec4 c; void main() { c = texture(t[0], vec2(0.0)); }");
    TOO_MUCH_UNIFORM_STORAGE = "E0717" "too-much-uniform-storage" Error "OpenGL 3.2 §2.11.4"
        "A uniform block, or all loose uniforms together, take more than 64 KiB, which is the largest size that \
         every target supports."
        bad Fragment("uniform vec4 u[5000]; out vec4 c; void main() { c = u[0]; }"),
        good Fragment("uniform vec4 u[50]; out vec4 c; void main() { c = u[0]; }");
    TOO_MANY_BLOCKS = "E0718" "too-many-uniform-blocks" Error "OpenGL 3.2 §2.11.4"
        "An array of uniform blocks takes one buffer for each element, which is more than any target can bind."
        bad Fragment("uniform B { vec4 a; } b[100]; out vec4 c; void main() { c = b[0].a; }"),
        good Fragment("uniform B { vec4 a; } b[3]; out vec4 c; void main() { c = b[0].a; }");
    MISSING_STAGE = "E0719" "missing-stage" Error "OpenGL 3.2 §2.12"
        "A geometry shader processes the output of a vertex shader, so a program that has one needs the other."
        bad Shaders(&[
            (Stage::Geometry, "layout(points) in; layout(points, max_vertices = 1) out; void main() { gl_Position = vec4(0.0); EmitVertex(); }"),
            (Stage::Fragment, "out vec4 c; void main() { c = vec4(1.0); }"),
        ]),
        good Shaders(&[
            (Stage::Vertex, "void main() { gl_Position = vec4(0.0); }"),
            (Stage::Geometry, "layout(points) in; layout(points, max_vertices = 1) out; void main() { gl_Position = vec4(0.0); EmitVertex(); }"),
            (Stage::Fragment, "out vec4 c; void main() { c = vec4(1.0); }"),
        ]);
    MISSING_GEOMETRY_LAYOUT = "E0720" "missing-geometry-layout" Error "GLSL 1.50 §4.3.8"
        "Some shader of the geometry stage must declare the input primitive, the output primitive and the largest \
         number of vertices."
        bad Shaders(&[
            (Stage::Vertex, "void main() { gl_Position = vec4(0.0); }"),
            (Stage::Geometry, "layout(points) in; void main() { }"),
        ]),
        good Shaders(&[
            (Stage::Vertex, "void main() { gl_Position = vec4(0.0); }"),
            (Stage::Geometry, "layout(points) in; layout(points, max_vertices = 1) out; void main() { gl_Position = vec4(0.0); EmitVertex(); }"),
        ]);
    SHARED_GLOBAL_MISMATCH = "E0721" "shared-global-mismatch" Error "GLSL 1.50 §4.2"
        "Global variables with the same name in shaders of one stage are one variable: they must agree in type, \
         qualifiers and initializer. An array without a size in one shader takes its size from another."
        bad Shaders(&[
            (Stage::Fragment, "float scale; void g(); out vec4 c; void main() { scale = 1.0; g(); c = vec4(scale); }"),
            (Stage::Fragment, "int scale; void g() { scale += 1; }"),
        ]),
        good Shaders(&[
            (Stage::Fragment, "float scale; void g(); out vec4 c; void main() { scale = 1.0; g(); c = vec4(scale); }"),
            (Stage::Fragment, "float scale; void g() { scale += 1.0; }"),
        ]);
    DUPLICATE_DEFINITION = "E0722" "duplicate-definition" Error "GLSL 1.50 §6.1"
        "A function must be defined in only one shader of a stage; the others declare it with a prototype."
        bad Shaders(&[
            (Stage::Fragment, "float f() { return 1.0; } out vec4 c; void main() { c = vec4(f()); }"),
            (Stage::Fragment, "float f() { return 2.0; }"),
        ]),
        good Shaders(&[
            (Stage::Fragment, "float f(); out vec4 c; void main() { c = vec4(f()); }"),
            (Stage::Fragment, "float f() { return 2.0; }"),
        ]);
    FUNCTION_MISMATCH = "E0723" "function-mismatch" Error "GLSL 1.50 §6.1"
        "A function that several shaders of a stage declare must have the same return type and parameter qualifiers \
         in all of them."
        bad Shaders(&[
            (Stage::Fragment, "float f(); out vec4 c; void main() { c = vec4(f()); }"),
            (Stage::Fragment, "int f() { return 2; }"),
        ]),
        good Shaders(&[
            (Stage::Fragment, "float f(); out vec4 c; void main() { c = vec4(f()); }"),
            (Stage::Fragment, "float f() { return 2.0; }"),
        ]);
    UNDEFINED_FUNCTION = "E0724" "undefined-function" Error "GLSL 1.50 §6.1"
        "A function is called, but no shader of its stage defines it."
        bad Program(
            "float f(); void main() { gl_Position = vec4(f()); }",
            "out vec4 c; void main() { c = vec4(1.0); }"),
        good Program(
            "float f() { return 1.0; } void main() { gl_Position = vec4(f()); }",
            "out vec4 c; void main() { c = vec4(1.0); }");
    GEOMETRY_LAYOUT_CONFLICT = "E0725" "geometry-layout-conflict" Error "GLSL 1.50 §4.3.8"
        "All geometry shaders of a program that declare the input primitive, the output primitive or `max_vertices` must \
         declare the same."
        bad Shaders(&[
            (Stage::Vertex, "void main() { gl_Position = vec4(0.0); }"),
            (Stage::Geometry, "layout(points) in; layout(points, max_vertices = 1) out; void main() { gl_Position = vec4(0.0); EmitVertex(); }"),
            (Stage::Geometry, "layout(lines) in;"),
        ]),
        good Shaders(&[
            (Stage::Vertex, "void main() { gl_Position = vec4(0.0); }"),
            (Stage::Geometry, "layout(points) in; layout(points, max_vertices = 1) out; void main() { gl_Position = vec4(0.0); EmitVertex(); }"),
            (Stage::Geometry, "layout(points) in;"),
        ]);
    GEOMETRY_INPUT_SIZE = "E0726" "geometry-inputs-disagree" Error "GLSL 1.50 §4.3.8.1"
        "The inputs of a geometry stage are arrays with one element for each vertex of the input primitive, which \
         some shader of the stage declares. Other sizes and indices contradict it."
        bad Shaders(&[
            (Stage::Vertex, "void main() { gl_Position = vec4(0.0); }"),
            (Stage::Geometry, "layout(triangles) in; layout(points, max_vertices = 1) out; void emit(); void main() { emit(); }"),
            (Stage::Geometry, "void emit() { gl_Position = gl_in[3].gl_Position; EmitVertex(); }"),
        ]),
        good Shaders(&[
            (Stage::Vertex, "void main() { gl_Position = vec4(0.0); }"),
            (Stage::Geometry, "layout(triangles) in; layout(points, max_vertices = 1) out; void emit(); void main() { emit(); }"),
            (Stage::Geometry, "void emit() { gl_Position = gl_in[2].gl_Position; EmitVertex(); }"),
        ]);
    FRAG_COORD_CONFLICT = "E0727" "frag-coord-conflict" Error "GLSL 1.50 §4.3.8.1"
        "All fragment shaders of a program that use `gl_FragCoord` must declare it with the same layout."
        bad Shaders(&[
            (Stage::Fragment, "layout(origin_upper_left) in vec4 gl_FragCoord; float f(); out vec4 c; void main() { c = gl_FragCoord + f(); }"),
            (Stage::Fragment, "float f() { return gl_FragCoord.x; }"),
        ]),
        good Shaders(&[
            (Stage::Fragment, "float f(); out vec4 c; void main() { c = gl_FragCoord + f(); }"),
            (Stage::Fragment, "float f() { return gl_FragCoord.x; }"),
        ]);
    PER_VERTEX_MISMATCH = "E0728" "per-vertex-mismatch" Error "GLSL 1.50 §4.3.7"
        "`gl_PerVertex` is a block: if one shader declares it again, all shaders that use its members on the same interface \
         must declare it alike."
        bad Shaders(&[
            (Stage::Vertex, "out gl_PerVertex { vec4 gl_Position; }; void f(); void main() { gl_Position = vec4(0.0); f(); }"),
            (Stage::Vertex, "void f() { gl_PointSize = 1.0; }"),
        ]),
        good Shaders(&[
            (Stage::Vertex, "out gl_PerVertex { vec4 gl_Position; }; void f(); void main() { gl_Position = vec4(0.0); f(); }"),
            (Stage::Vertex, "void f() { }"),
        ]);
    BINDING_REFUSED = "E0729" "refused-binding" Error "OpenGL 3.2 §2.11.3, §3.9.2"
        "A host binds a location to a name that begins with `gl_` (GL_INVALID_OPERATION), or a number that no attribute \
         or color output can have (GL_INVALID_VALUE)."
        bad Text("glisten compile --bind-attrib gl_Vertex=0 lit.vert -o out"),
        good Text("glisten compile --bind-attrib position=0 lit.vert -o out");
    BINDING_WITHOUT_VARIABLE = "W0708" "binding-without-variable" Warning "OpenGL 3.2 §2.11.3, §3.9.2"
        "A host binds a location by a name that is no attribute, or no output of the fragment stage. OpenGL allows that and \
         ignores it, so the variable that was meant gets another location. Varyings have no locations that a host binds. If \
         several programs are compiled at once, one of them must have the name."
        bad Text("glisten compile --bind-attrib positon=0 lit.vert -o out  # in vec3 position;"),
        good Text("glisten compile --bind-attrib position=0 lit.vert -o out");
    BINDING_IGNORED = "W0701" "binding-ignored" Warning "ARB_explicit_attrib_location"
        "A location was bound by name, but the declaration in the text gives another one, which takes precedence. A \
         host that relies on its binding sends its data to the wrong location."
        bad Text("glisten compile --bind-attrib position=1 lit.vert -o out   # lit.vert: layout(location = 0) in vec4 position;"), good Text("glisten compile --bind-attrib position=0 lit.vert -o out");
    LONE_WITHOUT_MAIN = "W0702" "lone-shader-without-main" Warning "GLSL 1.50 §6.1"
        "The shader has no `main`. That is legal for one of several shaders of a stage, but the shader alone does \
         nothing."
        bad Vertex("float twice(float x) { return 2.0 * x; }"),
        good Vertex("void main() { gl_Position = vec4(0.0); }");
    LONE_WITHOUT_LAYOUT = "W0703" "lone-shader-without-layout" Warning "GLSL 1.50 §4.3.8"
        "The geometry shader lacks a layout declaration that some shader of its stage must have. It cannot be \
         linked alone."
        bad Geometry("void main() { }"),
        good Geometry("layout(points) in; layout(points, max_vertices = 1) out; void main() { }");
    LONE_WITHOUT_DEFINITION = "W0707" "lone-shader-without-definition" Warning "GLSL 1.50 §6.1"
        "The shader calls a function that it only declares. Another shader of its stage may define it; the shader \
         cannot be linked alone. `lint` tells the same of a program whose files it found by their names: they do not say that \
         there is no other shader."
        bad Vertex("float f(); void main() { gl_Position = vec4(f()); }"),
        good Vertex("float f() { return 1.0; } void main() { gl_Position = vec4(f()); }");
    ATTRIBUTE_ALIASING_UNUSED = "W0704" "attribute-aliasing-on-separate-paths" Warning "OpenGL 3.2 §2.11.3"
        "Two attributes have the same location. That is legal as long as no execution of the shader reads both, \
         which is the case here."
        bad Vertex("#extension GL_ARB_explicit_attrib_location : enable\nlayout(location = 1) in vec4 a;\n\
                    layout(location = 1) in vec4 b; uniform bool u;\n\
                    void main() { if (u) gl_Position = a; else gl_Position = b; }"),
        good Vertex("#extension GL_ARB_explicit_attrib_location : enable\nlayout(location = 1) in vec4 a;\n\
                     layout(location = 2) in vec4 b; uniform bool u;\n\
                     void main() { if (u) gl_Position = a; else gl_Position = b; }");
    MIXED_LANGUAGES = "E0730" "mixed-languages" Error "GLSL ES 3.00 §3.4"
        "The shaders of one program are all of OpenGL's language, in any versions, or all of the same version of OpenGL \
         ES's."
        bad Program("#version 330\nvoid main() { gl_Position = vec4(0.0); }",
            "#version 300 es\nprecision highp float; out vec4 c; void main() { c = vec4(1.0); }"),
        good Program("#version 150\nvoid main() { gl_Position = vec4(0.0); }",
            "#version 330\nout vec4 c; void main() { c = vec4(1.0); }");
    UNIFORM_PRECISION_MISMATCH = "E0732" "uniform-precision-mismatch" Error "GLSL ES 3.00 §4.3.5"
        "The stages of a program share their uniforms: a uniform, or a member of its struct or of a uniform block, has the same \
         precision wherever it is declared. From ES 3.10 on, members of blocks may differ. Without a qualifier it has the default of its \
         stage, and those differ: vertex shaders have `highp` for floats and integers, fragment shaders `mediump` for integers and none \
         for floats."
        bad Program("#version 300 es\nuniform vec4 u; void main() { gl_Position = u; }",
            "#version 300 es\nprecision mediump float; uniform vec4 u; out vec4 c; void main() { c = u; }"),
        good Program("#version 300 es\nuniform mediump vec4 u; void main() { gl_Position = u; }",
            "#version 300 es\nprecision mediump float; uniform vec4 u; out vec4 c; void main() { c = u; }");
    UNIFORM_OVERLAP = "E0733" "uniform-location-overlap" Error "GLSL 4.30 §4.4.3"
        "No two uniforms outside of blocks have the same location, even if nothing uses them. An array or a struct takes a location \
         for each of its scalars, vectors and matrices."
        bad Fragment("#version 430\nlayout(location = 0) uniform vec4 a[2]; layout(location = 1) uniform vec4 b;\n\
            out vec4 c; void main() { c = a[0] + b; }"),
        good Fragment("#version 430\nlayout(location = 0) uniform vec4 a[2]; layout(location = 2) uniform vec4 b;\n\
            out vec4 c; void main() { c = a[0] + b; }");
    UNIFORM_NAMES = "E0734" "uniform-name-clash" Error "GLSL 4.40 §4.3.9"
        "A host finds a uniform by its name, and a member of a block without an instance name by its own. From 4.40 and ES 3.10 on, no \
         stage has a uniform, or such a member, that has the name of a member of another such block in another stage."
        bad Program("#version 440\nuniform B { vec4 a; }; void main() { gl_Position = a; }",
            "#version 440\nuniform vec4 a; out vec4 c; void main() { c = a; }"),
        good Program("#version 440\nuniform B { vec4 a; } b; void main() { gl_Position = b.a; }",
            "#version 440\nuniform vec4 a; out vec4 c; void main() { c = a; }");
    VARYINGS_ABOVE_MINIMUM = "W0705" "varyings-above-minimum" Warning "GLSL 1.50 §7.4"
        "The varyings have more components than the smallest value that gl_MaxVaryingComponents may have, 60. Many \
         implementations support more; some do not."
        bad Program(
            "out vec4 v[16]; void main() { v[0] = vec4(1.0); gl_Position = vec4(0.0); }",
            "in vec4 v[16]; out vec4 c; void main() { c = v[0]; }"),
        good Program(
            "out vec4 v[15]; void main() { v[0] = vec4(1.0); gl_Position = vec4(0.0); }",
            "in vec4 v[15]; out vec4 c; void main() { c = v[0]; }");
    SAMPLERS_ABOVE_MINIMUM = "W0706" "samplers-above-minimum" Warning "GLSL 1.50 §7.4"
        "A stage reads more samplers than the 16 that every implementation supports, or a program more than 48."
        bad Fragment("uniform sampler2D t[17]; out vec4 c; void main() { c = texture(t[0], vec2(0.0)); }"),
        good Fragment("uniform sampler2D t[16]; out vec4 c; void main() { c = texture(t[0], vec2(0.0)); }");
}
