//! Generates random numeric programs as text: nested built-in functions, operators, loops and branches over two varyings.
//!
//! *In:* a seed. *Out:* a fragment stage. *Holds:* each function is defined for the arguments that it gets.

use std::fmt::Write;

/// The scene of every program.
pub const SCENE: &str = "[framebuffer]\nwidth = 8\nheight = 8\n[[draw]]\nvertex = \"n.vert\"\nfragment = \"n.frag\"\n\
    primitive = \"triangles\"\nvertex_count = 3\n[draw.uniforms]\nu = [0.37, -1.9, 2.3]\n";
/// The vertex stage of every program.
pub const VERTEX: &str = "#version 150\nout vec2 a;\nout vec3 b;\nvoid main() { vec2 p = vec2(gl_VertexID % 2 * 4 - 1, gl_VertexID / 2 \
    * 4 - 1); a = p * vec2(1.3, 0.7) + 0.11; b = vec3(p.y * 2.1, 0.3 - p.x, p.x * 0.9 + 1.7); gl_Position = vec4(p, 0, 1); }\n";

/// Functions of one number, defined for every argument.
const SCALARS: &[&str] = &[
    "sin(#)",
    "cos(#)",
    "atan(#)",
    "abs(#)",
    "fract(#)",
    "floor(#)",
    "ceil(#)",
    "sign(#)",
    "round(#)",
    "trunc(#)",
    "exp(clamp(#, -8.0, 8.0))",
    "exp2(clamp(#, -8.0, 8.0))",
    "log(abs(#) + 0.2)",
    "log2(abs(#) + 0.2)",
    "sqrt(abs(#))",
    "inversesqrt(abs(#) + 0.1)",
    "tanh(clamp(#, -9.0, 9.0))",
    "sinh(clamp(#, -4.0, 4.0))",
    "cosh(clamp(#, -4.0, 4.0))",
    "asinh(#)",
    "asin(clamp(#, -1.0, 1.0))",
    "acos(clamp(#, -1.0, 1.0))",
    "radians(#)",
    "degrees(#)",
    "pow(abs(#) + 0.05, 2.7)",
    "mod(#, 1.7)",
    "smoothstep(-1.0, 1.5, #)",
    "step(0.3, #)",
    "(1.0 / (abs(#) + 0.6))",
];

/// Functions of two or three numbers.
const PAIRS: &[&str] = &[
    "(# + #)",
    "(# - #)",
    "(# * #)",
    "(# / (abs(#) + 0.5))",
    "min(#, #)",
    "max(#, #)",
    "mix(#, #, 0.3)",
    "atan(#, abs(#) + 0.4)",
    "clamp(#, -0.5, abs(#) + 0.5)",
    "(# * 0.7 + # * 1.9 - 0.4)",
    "pow(abs(#) + 0.3, clamp(#, -2.0, 2.0))",
    "(# < # ? 0.25 : -1.5)",
];

/// Vectors: `@` is a vector, `#` a number.
const VECTORS: &[&str] = &[
    "(normalize(@ + vec3(0.0, 0.0, 9.0)) * #)",
    "cross(@, @)",
    "reflect(@, normalize(@ + vec3(9.0, 0.0, 0.0)))",
    "refract(normalize(@ + vec3(0.0, 9.0, 0.0)), vec3(0.0, 1.0, 0.0), 0.7)",
    "mix(@, @, #)",
    "(mat3(u, u.zxy, u.yzx) * @)",
    "vec3(#, #, #)",
    "(@ - #)",
];

/// Numbers of vectors.
const LENGTHS: &[&str] = &["dot(@, @)", "length(@)", "distance(@, @)"];

/// The fragment stage of a seed.
pub fn fragment(seed: u64) -> String {
    Writer(seed * 7919 + 1).fragment()
}

struct Writer(u64);

impl Writer {
    fn below(&mut self, count: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % count
    }

    fn filled(&mut self, form: &str, depth: u32) -> String {
        let mut text = String::new();
        for letter in form.chars() {
            match letter {
                '#' => text += &self.number(depth),
                '@' => text += &self.vector(depth),
                letter => text.push(letter),
            }
        }
        text
    }

    fn number(&mut self, depth: u32) -> String {
        const LEAVES: &[&str] = &["a.x", "a.y", "b.x", "b.y", "b.z", "u.x", "u.y", "s", "t", "0.85", "-2.25"];
        let form = match (depth, self.below(10)) {
            (0, _) | (_, 0) => return (*LEAVES.get(self.below(LEAVES.len())).unwrap_or(&"s")).to_owned(),
            (_, 1..=4) => SCALARS[self.below(SCALARS.len())],
            (_, 5..=8) => PAIRS[self.below(PAIRS.len())],
            _ => LENGTHS[self.below(LENGTHS.len())],
        };
        self.filled(form, depth - 1)
    }

    fn vector(&mut self, depth: u32) -> String {
        if depth == 0 {
            return ["b", "u", "vec3(s, t, a.x)", "b.zxy"][self.below(4)].to_owned();
        }
        let form = VECTORS[self.below(VECTORS.len())];
        self.filled(form, depth - 1)
    }

    fn fragment(&mut self) -> String {
        let mut body = String::from("float s = a.x * 0.9, t = b.y - 0.2;\n");
        for _ in 0..2 + self.below(6) {
            let depth = 1 + self.below(3) as u32;
            let value = self.number(depth);
            let target = ["s", "t"][self.below(2)];
            let _ = match self.below(6) {
                0 => writeln!(
                    body,
                    "for (int i = 0; i < {}; i++) {target} = {target} * 0.6 + 0.2 * ({value});",
                    2 + self.below(5)
                ),
                1 => writeln!(body, "if ({value} < s) {target} += 0.5; else {target} *= 0.75;"),
                2 => writeln!(
                    body,
                    "for (int i = 0; i < 6; i++) {{ if (abs(t) > 3.0) break; {target} += 0.3 + 0.1 * ({value}); }}"
                ),
                _ => writeln!(body, "{target} = {value};"),
            };
        }
        let last = self.vector(2);
        format!(
            "#version 150\nin vec2 a;\nin vec3 b;\nuniform vec3 u;\nout vec4 color;\nvoid main() {{\n{body}color = vec4({last}, \
             s + t);\n}}\n"
        )
    }
}
