//! Lint rules of the group `performance`: work that need not be done, or not so often.

use super::super::Example::{Fragment, Program};

lints! {    LOOP_INVARIANT_LOOKUP = "L0037" "loop-invariant-lookup" Note Performance No "0.1.0" "GLSL 1.50 §8.7"
        "A texture is read at the same place in each iteration of a loop."
        why
        "Compilers move such work out only if they can see that nothing writes in between; a lookup behind a \
         condition is left out."
        bad Fragment(
            "uniform sampler2D t; uniform int n; in vec2 p; out vec4 c; void main() { c = vec4(0.0); for (int i = 0; \
             i < n; i++) c += texture(t, p) * float(i); }"),
        good Fragment(
            "uniform sampler2D t; uniform int n; in vec2 p; out vec4 c; void main() { vec4 s = texture(t, p); c = \
             vec4(0.0); for (int i = 0; i < n; i++) c += s * float(i); }");
    LOOP_INVARIANT_CALL = "L0038" "loop-invariant-call" Note Performance No "0.1.0" ""
        "A costly function is called in a loop with arguments that the loop does not change: `normalize(normal)` for \
         each light."
        why
        "Many compilers move it out of the loop themselves, so it is a note."
        bad Fragment(
            "uniform vec3 light[4]; in vec3 n; out vec4 c; void main() { c = vec4(0.0); for (int i = 0; i < 4; i++) \
             c += dot(normalize(n), light[i]); }"),
        good Fragment(
            "uniform vec3 light[4]; in vec3 n; out vec4 c; void main() { vec3 u = normalize(n); c = vec4(0.0); for \
             (int i = 0; i < 4; i++) c += dot(u, light[i]); }");
    UNIFORM_WORK = "L0039" "uniform-work" Note Performance No "0.1.0" ""
        "The fragment stage calls a costly function whose arguments are uniforms and constants alone. Every fragment \
         computes the same."
        why
        "It makes little difference where the shader waits for memory, so it is a note. Sines and exponentials, \
         which shaders take of the time, are left out."
        bad Fragment(
            "uniform vec3 light; in vec3 n; out vec4 c; void main() { c = vec4(dot(n, normalize(light))); }"),
        good Fragment(
            "uniform vec3 lightDirection; in vec3 n; out vec4 c; void main() { c = vec4(dot(n, lightDirection)); }");
    MATRIX_INVERSE = "L0040" "matrix-inverse" Note Performance No "0.1.0" "GLSL 1.50 §8.5"
        "A matrix is inverted for each fragment, or for each vertex though it is the same in the whole draw. An \
         inverse of a `mat4` takes about a hundred multiplications, and loses precision that the host has in \
         doubles."
        why
        "It is right, and only costs time."
        bad Fragment(
            "uniform mat4 m; in vec4 p; out vec4 c; void main() { c = inverse(m) * p; }"),
        good Fragment(
            "uniform mat4 inverseM; in vec4 p; out vec4 c; void main() { c = inverseM * p; }");
    VERTEX_WORK = "L0041" "vertex-work" Off Performance No "0.1.0" "GLSL 1.50 §4.3.6"
        "The fragment stage multiplies an interpolated vector by a matrix that is the same in the whole draw. \
         Interpolation keeps such products, so the vertex stage can compute it."
        why
        "It costs a varying and changes rounding, so it is off."
        bad Program(
            "in vec4 p; out vec4 q; void main() { q = p; gl_Position = p; }",
            "in vec4 q; uniform mat4 m; out vec4 c; void main() { c = m * q; }"),
        good Program(
            "in vec4 p; uniform mat4 m; out vec4 q; void main() { q = m * p; gl_Position = p; }",
            "in vec4 q; out vec4 c; void main() { c = q; }");
    UNIFORM_BRANCH = "L0042" "uniform-branch" Off Performance No "0.1.0" ""
        "A condition of the fragment stage is the same in the whole draw. `glisten specialize` removes it, with what \
         the other branch needs, from the programs of scenes that fix its uniforms."
        why
        "Such conditions are cheap and usual, so it is off."
        bad Fragment(
            "uniform bool lit; out vec4 c; void main() { c = vec4(0.0); if (lit) c = vec4(1.0); }"),
        good Fragment(
            "in float x; out vec4 c; void main() { c = vec4(0.0); if (x > 0.5) c = vec4(1.0); }");
    LATE_DISCARD = "L0043" "late-discard" Off Performance No "0.1.0" "GLSL 1.50 §6.4"
        "A fragment is discarded after texture lookups that the condition does not depend on, and that are made for \
         nothing then."
        why
        "Compilers may move the lookups behind it, unless they need derivatives, so it is off."
        bad Fragment(
            "uniform sampler2D t, mask; in vec2 p; out vec4 c; void main() { vec4 s = texture(t, p); float m = \
             texture(mask, p).r; if (m < 0.5) discard; c = s; }"),
        good Fragment(
            "uniform sampler2D t, mask; in vec2 p; out vec4 c; void main() { float m = texture(mask, p).r; if (m < \
             0.5) discard; c = texture(t, p); }");
    DEPTH_WRITTEN = "L0044" "depth-written" Off Performance No "0.1.0" "GLSL 1.50 §7.2"
        "The fragment stage writes `gl_FragDepth`, so the GPU cannot test the depth before it, and shades what is \
         hidden."
        why
        "It is needed where it is used, so it is off."
        bad Fragment(
            "in float x; out vec4 c; void main() { gl_FragDepth = x; c = vec4(1.0); }"),
        good Fragment(
            "out vec4 c; void main() { c = vec4(1.0); }");
}
