//! Codes for what a target cannot represent, found during lowering and emission (`E08xx`).

use super::Example::{Geometry, Text, Vertex};

codes! {
    STAGE_NOT_IN_TARGET = "E0801" "stage-not-in-target" Error ""
        "WebGPU has no geometry stage, and glisten emits one only as GLSL for OpenGL (`--target glsl`). A geometry shader \
         is parsed, validated and linked. To run it elsewhere, rewrite it by hand as a vertex shader that computes \
         each emitted vertex from the primitive's vertices (pulled by `gl_VertexID`)."
        bad Geometry("layout(points) in; layout(points, max_vertices = 1) out; void main() { EmitVertex(); }"),
        good Vertex("void main() { gl_Position = vec4(0.0); }");
    FEATURE_NOT_IN_TARGET = "E0802" "feature-not-in-target" Error ""
        "The shader uses a feature that the target language lacks and that cannot be dropped without changing the \
         picture. The message names the feature, the target, and a way out."
        bad Text("c = vec4(gl_PointCoord, 0.0, 1.0);   // --target wgsl"), good Text("c = vec4(gl_PointCoord, 0.0, 1.0);   // --target spirv");
    NESTING_TOO_DEEP_FOR_TARGET = "E0803" "nesting-too-deep-for-target" Error ""
        "Statements in the emitted text nest deeper than parsers of the target language accept: Tint accepts 127 \
         levels of WGSL, where an `if` or a loop takes two and a `switch` three. Move the inner statements into a \
         function of their own, or compile for SPIR-V, which nests as deep as glisten's parser does (256)."
        bad Text("if (x > 1.0) { if (x > 2.0) { if (x > 3.0) {   // and so on, 64 times"),
        good Text("if (x > 1.0) { inner(x); }   // the rest is in a function of its own");
    POINT_SIZE_DROPPED = "W0801" "point-size-dropped" Note "GLSL 1.50 §7.1"
        "`gl_PointSize` has an effect only if the program enables PROGRAM_POINT_SIZE. Without \
         `--program-point-size` the write is dropped and points are one pixel wide, as in OpenGL when it is \
         disabled."
        bad Vertex("void main() { gl_Position = vec4(0.0); gl_PointSize = 2.0; }"),
        good Vertex("void main() { gl_Position = vec4(0.0); }");
    COMPARISON_LEVEL_DROPPED = "W0802" "comparison-level-dropped" Warning "GLSL 1.50 §8.7"
        "No target compares depth at an explicit or biased level of detail: WGSL and naga's SPIR-V compare only in \
         the implicit level and in the base level. A lookup with a bias is compiled without it; one with a level or \
         gradients reads the base level. The picture is the same if the depth texture has one level, as shadow maps \
         have; `glisten render` and `glisten verify` reject a scene in which it has more."
        bad Text("c = vec4(texture(shadow, position, 2.0));   // a sampler2DShadow with a bias"), good Text("c = vec4(texture(shadow, position));");
    LEFT_OUT = "W0803" "left-out" Note "OpenGL 3.2 §2.11.3"
        "With `-O`, which is the default for WGSL and SPIR-V, `glisten compile` leaves out what reaches no output: \
         functions, statements, varyings, attributes, uniforms and samplers on which nothing that is drawn depends. \
         Drivers do the same, and call the rest active. `--left-out` reports each of them; `-O0` keeps them. Locations \
         and bindings are the same with and without them, and a block keeps its layout."
        bad Vertex("in vec4 p;\nin vec4 q;\nvoid main() { vec4 unread = q; gl_Position = p; }"),
        good Vertex("in vec4 p;\nvoid main() { gl_Position = p; }");
}
