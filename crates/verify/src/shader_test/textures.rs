//! The textures of the units, with the patterns that tests name.

use super::known;
use super::parameters::Parameters;
use super::words::Words;
use super::{TestResult, fail, skip};
use crate::scene::{Compare, Texels, Texture, TextureLevel, Wrap};
use glisten_front::hir::{DepthMode, SamplerDim, SamplerType, Scalar};
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
    parameters: Parameters,
}

const RED: [f32; 4] = [1.0, 0.0, 0.0, 1.0];
const GREEN: [f32; 4] = [0.0, 1.0, 0.0, 1.0];
const BLUE: [f32; 4] = [0.0, 0.0, 1.0, 1.0];
const WHITE: [f32; 4] = [1.0; 4];
/// The texels of the second layer of a texture of three dimensions.
const BEHIND: [[f32; 4]; 4] = [[1.0, 1.0, 0.0, 1.0], [1.0, 0.0, 1.0, 1.0], [0.0, 1.0, 1.0, 1.0], [0.0, 0.0, 0.0, 1.0]];
/// The targets of textures, and which textures of tests they are for.
const TARGETS: &[(&str, Option<(SamplerDim, bool)>)] = &[
    ("1D", Some((SamplerDim::D1, false))),
    ("2D", Some((SamplerDim::D2, false))),
    ("3D", Some((SamplerDim::D3, false))),
    ("Rect", Some((SamplerDim::Rect, false))),
    ("Cube", None),
    ("1DArray", Some((SamplerDim::D1, true))),
    ("2DArray", Some((SamplerDim::D2, true))),
    ("CubeArray", None),
];

/// The directions in which coordinates of a texture wrap.
fn directions(dim: SamplerDim) -> usize {
    match dim {
        SamplerDim::D1 | SamplerDim::Buffer => 1,
        SamplerDim::D3 => 3,
        SamplerDim::D2 | SamplerDim::Cube | SamplerDim::Rect | SamplerDim::Multisample => 2,
    }
}

/// The largest side of a texture that a test may request.
const LARGEST: u32 = 4096;

impl TextureUnit {
    fn new(dim: SamplerDim, arrayed: bool) -> Self {
        Self { dim, arrayed, levels: Vec::new(), parameters: Parameters::default() }
    }

    fn with(self, level: TextureLevel) -> Self {
        let parameters = Parameters { wraps: [Wrap::ClampToEdge; 3], ..self.parameters };
        Self { levels: vec![level], parameters, ..self }
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
                words.pass_over();
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
                let parameters = Parameters { wraps: [Wrap::ClampToEdge; 3], ..Parameters::default() };
                TextureUnit { levels, parameters, ..plane() }
            }
            ("rgbw" | "junk", Some("1DArray")) => {
                let [width, layers] = checked([words.count()?, words.count()?], line)?;
                TextureUnit::new(SamplerDim::D1, true).with(layered([width, 1, layers]))
            }
            ("rgbw" | "junk", Some("2DArray")) => {
                let sides = checked([words.count()?, words.count()?, words.count()?], line)?;
                TextureUnit::new(SamplerDim::D2, true).with(layered(sides))
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
        let target = words.word()?;
        let Some((_, of_target)) = TARGETS.iter().find(|row| row.0 == target) else {
            return known::mistake(line, target, "a target of textures", TARGETS.iter().map(|row| row.0));
        };
        let Some(unit) = self.units.get_mut(&self.active) else { return fail(line, "there is no texture yet") };
        if *of_target != Some((unit.dim, unit.arrayed)) {
            return skip(line, format_args!("the last texture is not a `{target}`"));
        }
        unit.parameters.set(words)
    }

    /// `GL_DEPTH_TEXTURE_MODE` of the textures at these units.
    pub(super) fn depth_mode(&self, line: u32, units: impl Iterator<Item = u32>) -> Result<DepthMode, TestResult> {
        let mut modes = units.filter_map(|number| self.units.get(&number)).map(|unit| unit.parameters.depth_mode);
        let first = modes.next().unwrap_or_default();
        match modes.all(|mode| mode == first) {
            true => Ok(first),
            false => skip(line, "textures with different values of GL_DEPTH_TEXTURE_MODE in one draw"),
        }
    }

    /// The texture for a sampler of this type at a unit; an unbound unit is black (OpenGL 3.2 §3.8.15).
    pub(super) fn texture(&self, line: u32, number: u32, kind: SamplerType) -> Result<Arc<Texture>, TestResult> {
        let Some(unit) = self.units.get(&number) else { return Ok(Arc::new(Texture::unset(kind, 0))) };
        if unit.dim != kind.dim || unit.arrayed != kind.arrayed || kind.texel != Scalar::Float {
            return skip(line, format_args!("a texture of another kind at a `{}`", kind.name()));
        }
        let parameters = &unit.parameters;
        let Some(wrap) = parameters.wrap(directions(kind.dim)) else {
            return skip(line, "a texture with a wrap mode for each direction");
        };
        Ok(Arc::new(Texture {
            kind,
            levels: parameters.levels(&unit.levels),
            filter: parameters.min,
            wrap,
            compare: parameters.compare,
            sampling: parameters.sampling(kind.shadow),
        }))
    }
}

/// A depth texture that grows from 0 at the left to 1 at the right, for comparisons by `greater`.
fn depth(dim: SamplerDim, arrayed: bool, sides: [u32; 3], line: u32) -> Result<TextureUnit, TestResult> {
    let [width, height, depth] = checked(sides, line)?;
    let last = f64::from(width.max(2) - 1);
    let row = (0..width).map(|x| (f64::from(x) / last) as f32);
    let texels = (0..height * depth).flat_map(|_| row.clone().map(|value| [value, 0.0, 0.0, 1.0])).collect();
    let level = TextureLevel { width, height, depth, texels: Texels::Float(texels) };
    let parameters = Parameters { compare: Compare::Greater, ..Parameters::default() };
    Ok(TextureUnit { parameters, ..TextureUnit::new(dim, arrayed) }.with(level))
}

/// Layers of one color each: red, green, blue, white, and again.
fn layered([width, height, depth]: [u32; 3]) -> TextureLevel {
    let colors = [RED, GREEN, BLUE, WHITE].into_iter().cycle().take(depth as usize);
    let texels = colors.flat_map(|color| (0..width * height).map(move |_| color)).collect();
    TextureLevel { width, height, depth, texels: Texels::Float(texels) }
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
