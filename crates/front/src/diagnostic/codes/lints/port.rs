//! Lint rules of the group `port`: what other machines and interfaces do differently.

use super::super::Example::Program;

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
}
