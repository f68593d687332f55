//! Lint rules of the group `style`: what can be said more simply, and what nothing uses.

use super::super::Example::Program;

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
}
