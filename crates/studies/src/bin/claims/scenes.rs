//! The ball with a highlight, shaded in many ways, as scenes in memory.
//!
//! *In:* a [`Highlight`]. *Out:* its shaders and its scene. *Holds:* all ways compute the same function of the same cosine,
//! N.H with one light and an eye that are far away; only `Mirror` is the article's own R.V.

use glisten::scene::{MemoryFiles, Scene, load};
use glisten::{Compiler, Options, Picture, RenderOptions, render};

/// Where the highlight is computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Place {
    Vertices,
    Fragments,
}

/// How the power of the cosine is computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum By {
    Pow,
    Squaring,
    /// The article's program without a texture: squaring, of R.V in place of N.H.
    Mirror,
    /// A table of so many texels, linear or nearest.
    Table(u32, bool),
}

/// A way to draw the highlight.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Highlight {
    pub(crate) at: Place,
    pub(crate) by: By,
    /// A power of two.
    pub(crate) exponent: u32,
    /// Whether the interpolated normal is made a unit vector again.
    pub(crate) renormalized: bool,
}

/// The ball's mesh and its picture.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ball {
    pub(crate) size: u32,
    pub(crate) segments: u32,
}

impl Highlight {
    pub(crate) fn new(at: Place, by: By, exponent: u32) -> Self {
        Self { at, by, exponent, renormalized: true }
    }

    /// A name for people.
    pub(crate) fn name(self) -> String {
        let how = match self.by {
            By::Pow => "`pow`".into(),
            By::Squaring => "squaring".into(),
            By::Mirror => "squaring, of R.V".into(),
            By::Table(texels, true) => format!("table of {texels} texels, linear"),
            By::Table(texels, false) => format!("table of {texels} texels, nearest"),
        };
        let place = if self.at == Place::Vertices { "vertices" } else { "fragments" };
        format!("{how}, at the {place}")
    }

    /// The function of the cosine `x`, in GLSL.
    fn function(self) -> String {
        let squares = "    x *= x;\n".repeat(self.exponent.ilog2() as usize);
        match self.by {
            By::Pow => format!("float f(float x)\n{{\n    return pow(x, {}.0);\n}}\n", self.exponent),
            By::Squaring | By::Mirror => format!("float f(float x)\n{{\n{squares}    return x;\n}}\n"),
            By::Table(texels, _) => format!(
                "uniform sampler2D table;\nfloat f(float x)\n{{\n    \
                 return textureLod(table, vec2(x * {:?} + {:?}, 0.5), 0.0).r;\n}}\n",
                f64::from(texels - 1) / f64::from(texels),
                0.5 / f64::from(texels)
            ),
        }
    }

    fn cosine(self) -> &'static str {
        match self.by {
            By::Mirror => "max(2.0 * dot(n, L) * dot(n, V) - dot(L, V), 0.0)",
            _ => "max(dot(n, H), 0.0)",
        }
    }

    /// The vertex and the fragment stage.
    pub(crate) fn shaders(self) -> [String; 2] {
        let uniforms = "uniform vec3 L;\nuniform vec3 V;\nuniform vec3 H;\n";
        let (function, cosine) = (self.function(), self.cosine());
        let table = matches!(self.by, By::Table(..));
        let unit = if self.renormalized { "normalize(normal)" } else { "normal" };
        let head = "in vec3 pv;\nin vec3 nv;\nuniform mat4 mc;\n";
        let position = "gl_Position = mc * vec4(pv, 1.0);";
        let [vertex, fragment] = match self.at {
            Place::Fragments => [
                format!("{head}out vec3 normal;\nvoid main()\n{{\n    normal = nv;\n    {position}\n}}\n"),
                format!(
                    "in vec3 normal;\n{uniforms}out vec4 color;\n{function}void main()\n{{\n    vec3 n = {unit};\n    \
                     color = vec4(vec3(f({cosine})), 1.0);\n}}\n"
                ),
            ],
            // The cosine is a texture coordinate that is interpolated, as in the article.
            Place::Vertices if table => [
                format!(
                    "{head}{uniforms}out float x;\nvoid main()\n{{\n    vec3 n = nv;\n    x = {cosine};\n    {position}\n}}\n"
                ),
                format!(
                    "in float x;\nout vec4 color;\n{function}void main()\n{{\n    color = vec4(vec3(f(x)), 1.0);\n}}\n"
                ),
            ],
            Place::Vertices => [
                format!(
                    "{head}{uniforms}out float shade;\n{function}void main()\n{{\n    vec3 n = nv;\n    \
                     shade = f({cosine});\n    {position}\n}}\n"
                ),
                "in float shade;\nout vec4 color;\nvoid main()\n{\n    color = vec4(vec3(shade), 1.0);\n}\n".into(),
            ],
        };
        [vertex, fragment].map(|text| format!("#version 150\n{text}"))
    }

    /// The keys of a draw, with names of files that begin with `stem`.
    pub(crate) fn keys(self, stem: &str) -> String {
        let table = match self.by {
            By::Table(texels, linear) => {
                let filter = if linear { "linear" } else { "nearest" };
                format!(
                    ", textures = {{ table = {{ pattern = \"specular\", exponent = {}, width = {texels}, \
                     filter = \"{filter}\" }} }}",
                    self.exponent
                )
            }
            _ => String::new(),
        };
        format!("vertex = \"{stem}.vert\", fragment = \"{stem}.frag\"{table}")
    }
}

impl Ball {
    /// The scene's text, whose draw has these keys.
    pub(crate) fn text(self, keys: &str) -> String {
        let Self { size, segments } = self;
        let rings = segments / 2;
        let keys = keys.split(", textures").collect::<Vec<_>>().join("\ntextures").replace(", fragment", "\nfragment");
        // The half vector is between two vertices of the coarse meshes, neither at one nor in the middle.
        format!(
            "[framebuffer]\nwidth = {size}\nheight = {size}\n[camera]\neye = [0.0, 0.0, 4.0]\northo = 1.02\n[[draw]]\n\
             {keys}\ncull = \"back\"\n[draw.mesh]\nshape = \"sphere\"\nposition = \"pv\"\nnormal = \"nv\"\n\
             segments = {segments}\nrings = {rings}\n[draw.matrices]\nmc = \"model_view_projection\"\n\
             [draw.uniforms]\nL = {L:?}\nV = [0.0, 0.0, 1.0]\nH = {:?}\n",
            half()
        )
    }
}

/// Towards the light.
const L: [f64; 3] = [0.48, 0.6, 0.64];

/// The half vector of the light and the eye, in f32 of length 1 but for rounding.
fn half() -> [f64; 3] {
    let sum = [L[0], L[1], L[2] + 1.0];
    let length = sum.iter().map(|x| x * x).sum::<f64>().sqrt();
    sum.map(|x| x / length)
}

/// The files of some ways, `0.vert`, `0.frag`, `1.vert` and so on.
pub(crate) fn files(ways: &[Highlight]) -> MemoryFiles {
    let mut files = MemoryFiles::default();
    for (number, way) in ways.iter().enumerate() {
        for (extension, text) in ["vert", "frag"].into_iter().zip(way.shaders()) {
            files.0.insert(format!("{number}.{extension}"), text.into_bytes());
        }
    }
    files
}

/// Loads a scene from its text.
pub(crate) fn loaded(text: &str, mut files: MemoryFiles) -> Result<Scene, String> {
    files.0.insert("s.toml".into(), text.as_bytes().to_vec());
    let loaded = load("s.toml", &files, &Compiler::new(Options::default()));
    let messages: Vec<String> = loaded.diagnostics.iter().map(|one| one.message.clone()).collect();
    loaded.scene.ok_or_else(|| format!("{}\n{text}", messages.join("\n")))
}

/// The scene of a way on a ball.
pub(crate) fn scene(way: Highlight, ball: Ball) -> Result<Scene, String> {
    loaded(&ball.text(&way.keys("0")), files(&[way]))
}

/// The picture in f64.
pub(crate) fn picture(scene: &Scene) -> Result<Picture, String> {
    let options = RenderOptions { mark_edges: false, ..RenderOptions::default() };
    render(scene, &options)
        .map_err(|errors| errors.iter().map(|one| one.message.clone()).collect::<Vec<_>>().join("; "))
}

/// The red of the covered pixels of both pictures.
pub(crate) fn reds<'p>(a: &'p Picture, b: &'p Picture) -> impl Iterator<Item = [f64; 2]> + 'p {
    let colors = a.attachments.iter().flatten().zip(b.attachments.iter().flatten());
    let both = a.covered.iter().zip(&b.covered).map(|(a, b)| *a && *b);
    colors.zip(both).filter(|(_, both)| *both).map(|((a, b), _)| [a[0], b[0]])
}

/// The largest difference, and the root of the mean square.
pub(crate) fn errors(picture: &Picture, truth: &Picture) -> (f64, f64) {
    let (mut largest, mut squares, mut count) = (0.0f64, 0.0, 0u64);
    for [a, b] in reds(picture, truth) {
        largest = largest.max((a - b).abs());
        squares += (a - b) * (a - b);
        count += 1;
    }
    (largest, (squares / count.max(1) as f64).sqrt())
}
