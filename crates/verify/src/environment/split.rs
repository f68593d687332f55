//! [`SplitSum`]: the part of light from everywhere that `ggx` reflects, which is the second factor of the split sum.
//!
//! *In:* the pattern `ltc_albedo` of scenes. *Out:* its texels as a picture, and the lookup of `ltcAlbedo()` in f64. *Holds:* there is one
//! table of it: that of the modules `ltc` and `energy`.

use crate::scene::{MemoryFiles, Texels, load};
use glisten_front::{Compiler, Options};
use glisten_scene::picture::{ImageError, exr_of_colors};

/// The table: what is reflected by F_0 = 1, and by the rest of Schlick's term; by sqrt(N.V) and by roughness.
#[derive(Clone, Debug)]
pub struct SplitSum {
    width: usize,
    height: usize,
    texels: Vec<[f32; 4]>,
}

const SCENE: &str = "[[draw]]\nvertex = \"a.vert\"\nfragment = \"a.frag\"\nvertex_count = 3\n\
    textures = { table = { pattern = \"ltc_albedo\" } }\n";
const VERTEX: &str = "#version 150\nvoid main() { gl_Position = vec4(0.0); }\n";
const FRAGMENT: &str =
    "#version 150\nuniform sampler2D table;\nout vec4 color;\nvoid main() { color = texture(table, vec2(0.0)); }\n";

impl SplitSum {
    /// The table; `None` never, as the pattern is there.
    pub fn new() -> Option<Self> {
        let files = MemoryFiles::new([("a.toml", SCENE), ("a.vert", VERTEX), ("a.frag", FRAGMENT)]);
        let scene = load("a.toml", &files, &Compiler::new(Options::default())).scene?;
        let texture = scene.draws.first()?.textures.first()?.clone()?;
        let level = texture.levels.first()?;
        let Texels::Float(texels) = &level.texels else { return None };
        Some(Self { width: level.width as usize, height: level.height as usize, texels: texels.clone() })
    }

    /// The table as an OpenEXR file: red and green are the two parts, blue is the mean of the first over all directions.
    ///
    /// # Errors
    /// It cannot be encoded.
    pub fn exr(&self) -> Result<Vec<u8>, ImageError> {
        let rows = self.texels.chunks(self.width).rev().flatten();
        let colors: Vec<[f32; 3]> = rows.map(|[a, b, c, _]| [*a, *b, *c]).collect();
        exr_of_colors(self.width as u32, self.height as u32, &colors)
    }

    /// The part that F_0 = 1 reflects to an eye at this cosine.
    pub(super) fn white(&self, cosine: f64, roughness: f64) -> f64 {
        let at = |x: f64, count: usize| x.clamp(0.0, 1.0) * (count - 1) as f64;
        let (x, y) = (at(cosine.sqrt(), self.width), at(roughness, self.height));
        let (column, row, u, v) = (x.floor() as usize, y.floor() as usize, x.fract(), y.fract());
        let texel = |column: usize, row: usize| {
            let index = row.min(self.height - 1) * self.width + column.min(self.width - 1);
            self.texels.get(index).map_or(0.0, |texel| f64::from(texel[0]))
        };
        (1.0 - v) * ((1.0 - u) * texel(column, row) + u * texel(column + 1, row))
            + v * ((1.0 - u) * texel(column, row + 1) + u * texel(column + 1, row + 1))
    }
}
