//! Lint rules of the group `legacy`: what later versions replaced.

use super::super::Example::{Fragment, Vertex};

lints! {    LEGACY_LOOKUP = "L0070" "legacy-lookup" Note Legacy Safe "0.1.0" "GLSL 1.50 §8.7"
        "A lookup has the name that it had before GLSL 1.30: `texture2D` is `texture`. `shadow2D` and its like are left out, since \
         their results are vectors."
        why
        "Drivers accept it in these versions, and later ones drop it; sources of 1.20 and before are left out."
        bad Fragment(
            "#version 130\nuniform sampler2D t; in vec2 p; out vec4 c; void main() { c = texture2D(t, p); }"),
        good Fragment(
            "#version 130\nuniform sampler2D t; in vec2 p; out vec4 c; void main() { c = texture(t, p); }");
    LEGACY_QUALIFIER = "L0071" "legacy-qualifier" Note Legacy Safe "0.1.0" "GLSL 1.50 §4.3"
        "A declaration says `attribute` or `varying`, in place of which GLSL 1.30 has `in` and `out`."
        why
        "Drivers accept it in these versions, and later ones drop it; sources of 1.20 and before are left out."
        bad Vertex(
            "#version 130\nattribute vec4 p; void main() { gl_Position = p; }"),
        good Vertex(
            "#version 130\nin vec4 p; void main() { gl_Position = p; }");
    LEGACY_OUTPUT = "L0072" "legacy-output" Note Legacy Unsafe "0.1.0" "GLSL 1.50 §7.2"
        "The fragment stage writes `gl_FragColor`, in place of which GLSL 1.30 has outputs that the shader declares."
        why
        "The fix is unsafe because `gl_FragColor` goes to all colors of a framebuffer, and a declared output to one."
        bad Fragment(
            "#version 130\nvoid main() { gl_FragColor = vec4(1.0); }"),
        good Fragment(
            "#version 130\nout vec4 c; void main() { c = vec4(1.0); }");
}
