//! Lint rules of the group `port`: what other machines and interfaces do differently.

use super::super::Example::{Fragment, Program, Vertex};

lints! {
    FLAT_PROVOKING_VERTEX = "L0004" "flat-provoking-vertex" Note Port No "0.1.0" "OpenGL 3.2 §2.18"
        "A `flat` varying has the value of the provoking vertex: the last vertex of the primitive in OpenGL, the \
         first in WebGPU and Vulkan. A host that draws the emitted code must rotate the indices of each primitive, \
         as glisten's own runner does; otherwise the picture changes."
        why "True of every `flat` varying, and harmless if the vertices of a primitive agree; so it is a note."
        bad Program(
            "flat out vec4 tint; void main() { tint = vec4(1.0); gl_Position = vec4(0.0); }",
            "flat in vec4 tint; out vec4 c; void main() { c = tint; }"),
        good Program(
            "out vec4 tint; void main() { tint = vec4(1.0); gl_Position = vec4(0.0); }",
            "in vec4 tint; out vec4 c; void main() { c = tint; }");
    BEYOND_WEBGL = "L0076" "beyond-webgl" Warning Port No "0.1.0" "GLSL ES 1.00 appendix A"
        "GLSL ES 1.00 has loops and indices that OpenGL ES 2.0 need not support, and WebGL 1.0 refuses them: `while` and `do`; a \
         `for` whose index does not run from a constant to a constant by a constant; an index that is neither constant nor \
         made of the indices of loops, but for the uniforms of vertex shaders."
        why "Drivers of that time may unroll every loop. GLSL ES 3.00 has no such limits."
        bad Fragment("#version 100\nprecision highp float; uniform int n;\n\
            void main() { float a = 0.0; for (int i = 0; i < n; i++) { a += 0.1; } gl_FragColor = vec4(a); }"),
        good Fragment("#version 100\nprecision highp float; uniform int n;\n\
            void main() { float a = 0.0; for (int i = 0; i < 9; i++) { if (i >= n) break; a += 0.1; } gl_FragColor = vec4(a); }");
    FRAG_COORD_ROW = "L0045" "frag-coord-row" Off Port No "0.1.0" "GLSL 1.50 §7.2"
        "The shader reads the second component of `gl_FragCoord`, which counts from the lower edge in OpenGL and \
         from the upper one in WebGPU, Direct3D and Metal."
        why
        "`glisten compile` corrects it, so it is off; it matters to other translators."
        bad Fragment(
            "out vec4 c; void main() { c = vec4(gl_FragCoord.y); }"),
        good Fragment(
            "out vec4 c; void main() { c = vec4(gl_FragCoord.x); }");
    POINT_SIZE = "L0046" "point-size" Off Port No "0.1.0" "GLSL 1.50 §7.1"
        "The shader writes `gl_PointSize`. WebGPU and Direct3D draw points of one pixel."
        why
        "`glisten compile` tells it for targets that have no size, so it is off."
        bad Vertex(
            "in vec4 p; void main() { gl_Position = p; gl_PointSize = 4.0; }"),
        good Vertex(
            "in vec4 p; void main() { gl_Position = p; }");
    WEBGPU_LIMITS = "L0047" "webgpu-limits" Note Port No "0.1.0" ""
        "The program needs more locations of varyings, textures, uniform blocks or colors than WebGPU promises on \
         every machine."
        why
        "Many machines have more, so it is a note."
        bad Fragment(
            "uniform sampler2D t[17]; in vec2 p; out vec4 c; void main() { c = texture(t[0], p) + texture(t[1], p) + \
             texture(t[2], p) + texture(t[3], p) + texture(t[4], p) + texture(t[5], p) + texture(t[6], p) + \
             texture(t[7], p) + texture(t[8], p) + texture(t[9], p) + texture(t[10], p) + texture(t[11], p) + \
             texture(t[12], p) + texture(t[13], p) + texture(t[14], p) + texture(t[15], p) + texture(t[16], p); }"),
        good Fragment(
            "uniform sampler2D t[16]; in vec2 p; out vec4 c; void main() { c = texture(t[0], p) + texture(t[1], p) + \
             texture(t[2], p) + texture(t[3], p) + texture(t[4], p) + texture(t[5], p) + texture(t[6], p) + \
             texture(t[7], p) + texture(t[8], p) + texture(t[9], p) + texture(t[10], p) + texture(t[11], p) + \
             texture(t[12], p) + texture(t[13], p) + texture(t[14], p) + texture(t[15], p); }");
    WGSL_RESERVED_NAME = "L0048" "wgsl-reserved-name" Off Port No "0.1.0" ""
        "An attribute, a uniform or an output has a name that WGSL reserves. A translation gives it another name, so \
         a host cannot find it by this one."
        why
        "Reflection tells the new name, so it is off. One finding for a shader."
        bad Fragment(
            "uniform vec4 target; out vec4 c; void main() { c = target; }"),
        good Fragment(
            "uniform vec4 goal; out vec4 c; void main() { c = goal; }");
    STD140_PADDING = "L0049" "std140-padding" Note Port No "0.1.0" "GLSL 1.50 §4.3.7"
        "An array of scalars or short vectors is in a uniform block. With `std140`, each element takes 16 bytes, and \
         an array of the host that is packed does not fit."
        why
        "Right if the host knows it, so it is a note."
        bad Fragment(
            "layout(std140) uniform B { float weight[4]; }; out vec4 c; void main() { c = vec4(weight[0]); }"),
        good Fragment(
            "layout(std140) uniform B { vec4 weight; }; out vec4 c; void main() { c = vec4(weight[0]); }");
    INITIALIZED_UNIFORM = "L0050" "initialized-uniform" Off Port No "0.1.0" "GLSL 1.50 §4.3.5"
        "A uniform has a value in its declaration. OpenGL ES, Vulkan and WebGPU have no such values: the host must \
         set it."
        why
        "Reflection tells the value, so it is off."
        bad Fragment(
            "uniform float strength = 0.5; out vec4 c; void main() { c = vec4(strength); }"),
        good Fragment(
            "uniform float strength; out vec4 c; void main() { c = vec4(strength); }");
}
