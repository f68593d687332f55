//! The textures of the units, with the patterns that tests name.

use super::words::Words;
use super::{TestResult, fail, skip};
use crate::scene::{Compare, Filter, Texels, Texture, TextureLevel, Wrap};
use glisten_front::hir::{SamplerDim, SamplerType, Scalar};
use std::collections::BTreeMap;
use std::sync::Arc;

/// The textures that are bound to units.
#[derive(Clone, Debug, Default)]
pub(super) struct Units {
    units: BTreeMap<u32, TextureUnit>,
    /// The unit that `texparameter` refers to: that of the last `texture` command.
    active: u32,
}

/// A texture with its parameters.
#[derive(Clone, Debug)]
struct TextureUnit {
    dim: SamplerDim,
    arrayed: bool,
    levels: Vec<TextureLevel>,
    /// The filter within a level, and between levels, for minification.
    min: Filter,
    /// The filter for magnification.
    mag: Filter,
    wrap: Wrap,
    compare: Compare,
    /// `GL_DEPTH_TEXTURE_MODE` other than luminance.
    mode: Option<String>,
}

const RED: [f32; 4] = [1.0, 0.0, 0.0, 1.0];
const GREEN: [f32; 4] = [0.0, 1.0, 0.0, 1.0];
const BLUE: [f32; 4] = [0.0, 0.0, 1.0, 1.0];
const WHITE: [f32; 4] = [1.0; 4];
/// The texels of the second layer of a texture of three dimensions.
const BEHIND: [[f32; 4]; 4] = [[1.0, 1.0, 0.0, 1.0], [1.0, 0.0, 1.0, 1.0], [0.0, 1.0, 1.0, 1.0], [0.0, 0.0, 0.0, 1.0]];
/// The largest side of a texture that a test may request.
const LARGEST: u32 = 4096;

impl TextureUnit {
    fn new(dim: SamplerDim, arrayed: bool) -> Self {
        Self {
            dim,
            arrayed,
            levels: Vec::new(),
            min: Filter::Nearest,
            mag: Filter::Nearest,
            wrap: Wrap::Repeat,
            compare: Compare::Lequal,
            mode: None,
        }
    }

    fn with(self, level: TextureLevel) -> Self {
        Self { levels: vec![level], wrap: Wrap::ClampToEdge, ..self }
    }
}

impl Units {
    /// Runs a `texture` command such as `texture checkerboard 0 0 (8, 8) (..) (..)`.
    pub(super) fn create(&mut self, words: &mut Words<'_>) -> Result<(), TestResult> {
        let line = words.line;
        let form = words.word()?;
        let dimensions = ["1D", "3D", "2DArray", "1DArray"].into_iter().find(|name| words.eat(name));
        let number = words.count()?;
        let plane = || TextureUnit::new(SamplerDim::D2, false);
        let made = match (form, dimensions) {
            ("checkerboard", None) => {
                let level = words.count()? as usize;
                let [width, height] = size(words)?;
                let colors = [words.numbers::<4>()?, words.numbers::<4>()?].map(|color| color.map(|c| c as f32));
                let (across, up) = ((width / 2).max(1), (height / 2).max(1));
                let board = image(width, height, |x, y| colors[(((x / across) ^ (y / up)) & 1) as usize]);
                let mut unit = self.units.remove(&number).unwrap_or_else(plane);
                if level > unit.levels.len() {
                    return skip(line, "levels of a texture out of order");
                }
                unit.levels.truncate(level);
                unit.levels.push(board);
                unit
            }
            ("rgbw", None) => {
                let [width, height] = size(words)?;
                if words.rest().iter().any(|format| !["GL_RGBA", "GL_RGBA8", "GL_RGB"].contains(format)) {
                    return skip(line, "textures of this format");
                }
                let level = image(width, height, |x, y| match (x < width / 2, y < height / 2) {
                    (true, true) => RED,
                    (false, true) => GREEN,
                    (true, false) => BLUE,
                    (false, false) => WHITE,
                });
                plane().with(level)
            }
            ("rgbw", Some("1D")) => {
                let texels = vec![RED, GREEN, BLUE, WHITE];
                let level = TextureLevel { width: 4, height: 1, depth: 1, texels: Texels::Float(texels) };
                TextureUnit::new(SamplerDim::D1, false).with(level)
            }
            ("rgbw", Some("3D")) => {
                let texels = [RED, GREEN, BLUE, WHITE].into_iter().chain(BEHIND).collect();
                let level = TextureLevel { width: 2, height: 2, depth: 2, texels: Texels::Float(texels) };
                TextureUnit::new(SamplerDim::D3, false).with(level)
            }
            ("shadow1D", None) => depth(SamplerDim::D1, false, [words.count()?, 1, 1], line)?,
            ("shadow2D", None) => depth(SamplerDim::D2, false, [words.count()?, words.count()?, 1], line)?,
            ("shadowRect", None) => depth(SamplerDim::Rect, false, [words.count()?, words.count()?, 1], line)?,
            ("shadow1DArray", None) => {
                let (width, layers) = (words.count()?, words.count()?);
                depth(SamplerDim::D1, true, [width, 1, layers], line)?
            }
            ("shadow2DArray", None) => {
                depth(SamplerDim::D2, true, [words.count()?, words.count()?, words.count()?], line)?
            }
            ("miptree", None) => {
                let levels = [(8, RED), (4, GREEN), (2, BLUE), (1, WHITE)];
                let levels = levels.map(|(side, color)| image(side, side, |_, _| color)).to_vec();
                TextureUnit { levels, wrap: Wrap::ClampToEdge, ..plane() }
            }
            _ => {
                return skip(
                    line,
                    format_args!("`texture {form} {}` is not supported", dimensions.unwrap_or_default()),
                );
            }
        };
        self.units.insert(number, made);
        self.active = number;
        Ok(())
    }

    /// Runs a `texparameter` command such as `texparameter 2D min nearest`.
    pub(super) fn parameter(&mut self, words: &mut Words<'_>) -> Result<(), TestResult> {
        let line = words.line;
        words.word()?;
        let (name, value) = (words.word()?, words.word()?);
        let Some(unit) = self.units.get_mut(&self.active) else { return fail(line, "there is no texture yet") };
        let filter = FILTERS.iter().find(|(known, _)| *known == value).map(|(_, filter)| *filter);
        match (name, value, filter) {
            ("min", _, Some(filter)) => unit.min = filter,
            ("mag", _, Some(filter)) if !filter.uses_levels() => unit.mag = filter,
            ("wrap_s" | "wrap_t" | "wrap_r", wrap, _) if Wrap::of_opengl(wrap).is_some() => {
                unit.wrap = Wrap::of_opengl(wrap).unwrap_or(unit.wrap);
            }
            ("depth_mode", mode, _) => unit.mode = Some(mode.to_owned()).filter(|mode| mode != "luminance"),
            ("compare_func", function, _) => match Compare::NAMES.iter().find(|(name, _)| *name == function) {
                Some((_, compare)) => unit.compare = *compare,
                None => return fail(line, format_args!("`{function}` compares nothing")),
            },
            _ => return skip(line, format_args!("`texparameter {name} {value}` is not supported")),
        }
        Ok(())
    }

    /// The texture for a sampler of this type at a unit; an unbound unit is black. `vectors`: whether the program sees all
    /// four components of a comparison.
    pub(super) fn texture(
        &self,
        line: u32,
        number: u32,
        kind: SamplerType,
        vectors: bool,
    ) -> Result<Option<Arc<Texture>>, TestResult> {
        let Some(unit) = self.units.get(&number) else { return Ok(None) };
        if unit.dim != kind.dim || unit.arrayed != kind.arrayed || kind.texel != Scalar::Float {
            return skip(line, format_args!("a texture of another kind at a `{}`", kind.name()));
        }
        if let Some(mode) = unit.mode.as_ref().filter(|_| vectors && kind.shadow) {
            return skip(line, format_args!("GL_DEPTH_TEXTURE_MODE `{mode}`: comparisons give (r, r, r, 1)"));
        }
        if unit.min.is_linear() != unit.mag.is_linear() {
            return skip(line, "a filter for minification and another one for magnification");
        }
        Ok(Some(Arc::new(Texture {
            kind,
            levels: unit.levels.clone(),
            filter: unit.min,
            wrap: unit.wrap,
            compare: unit.compare,
        })))
    }
}

/// OpenGL's filters by their names in small letters.
const FILTERS: &[(&str, Filter)] = &[
    ("nearest", Filter::Nearest),
    ("linear", Filter::Linear),
    ("nearest_mipmap_nearest", Filter::NearestMipmapNearest),
    ("linear_mipmap_nearest", Filter::LinearMipmapNearest),
    ("nearest_mipmap_linear", Filter::NearestMipmapLinear),
    ("linear_mipmap_linear", Filter::Trilinear),
];

/// A depth texture that grows from 0 at the left to 1 at the right, for comparisons by `greater`.
fn depth(dim: SamplerDim, arrayed: bool, sides: [u32; 3], line: u32) -> Result<TextureUnit, TestResult> {
    let [width, height, depth] = checked(sides, line)?;
    let last = f64::from(width.max(2) - 1);
    let row = (0..width).map(|x| (f64::from(x) / last) as f32);
    let texels = (0..height * depth).flat_map(|_| row.clone().map(|value| [value, 0.0, 0.0, 1.0])).collect();
    let level = TextureLevel { width, height, depth, texels: Texels::Float(texels) };
    Ok(TextureUnit { compare: Compare::Greater, ..TextureUnit::new(dim, arrayed) }.with(level))
}

fn checked<const N: usize>(sides: [u32; N], line: u32) -> Result<[u32; N], TestResult> {
    if sides.iter().all(|side| (1..=LARGEST).contains(side)) {
        Ok(sides)
    } else {
        fail(line, format_args!("a texture is 1 to {LARGEST} texels wide and high"))
    }
}

fn size(words: &mut Words<'_>) -> Result<[u32; 2], TestResult> {
    checked([words.count()?, words.count()?], words.line)
}

fn image(width: u32, height: u32, texel: impl Fn(u32, u32) -> [f32; 4]) -> TextureLevel {
    // Textures of tests store 8 bits per channel.
    let stored = |texel: [f32; 4]| texel.map(|channel| (channel.clamp(0.0, 1.0) * 255.0).round() / 255.0);
    let places = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    let texels = places.map(|(x, y)| stored(texel(x, y))).collect();
    TextureLevel { width, height, depth: 1, texels: Texels::Float(texels) }
}
