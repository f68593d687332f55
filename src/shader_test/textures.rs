//! The textures of the units, with the patterns that tests name.

use super::words::Words;
use super::{TestResult, fail, skip};
use crate::scene::{Compare, Filter, Texels, Texture, TextureLevel, Wrap};
use glisten_front::hir::{SamplerType, Scalar};
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
    levels: Vec<TextureLevel>,
    filter: Filter,
    wrap: Wrap,
    compare: Compare,
}

const RED: [f32; 4] = [1.0, 0.0, 0.0, 1.0];
const GREEN: [f32; 4] = [0.0, 1.0, 0.0, 1.0];
const BLUE: [f32; 4] = [0.0, 0.0, 1.0, 1.0];
const WHITE: [f32; 4] = [1.0; 4];
/// The largest side of a texture that a test may request.
const LARGEST: u32 = 4096;

impl Units {
    /// Runs a `texture` command such as `texture checkerboard 0 0 (8, 8) (..) (..)`.
    pub(super) fn create(&mut self, words: &mut Words<'_>) -> Result<(), TestResult> {
        let line = words.line;
        let form = words.word()?;
        let number = words.count()?;
        let unit = self.units.entry(number).or_insert(TextureUnit {
            levels: Vec::new(),
            filter: Filter::Nearest,
            wrap: Wrap::Repeat,
            compare: Compare::Lequal,
        });
        match form {
            "checkerboard" => {
                let level = words.count()? as usize;
                let [width, height] = size(words)?;
                let colors = [words.numbers::<4>()?, words.numbers::<4>()?].map(|color| color.map(|c| c as f32));
                let (across, up) = ((width / 2).max(1), (height / 2).max(1));
                let board = image(width, height, |x, y| colors[(((x / across) ^ (y / up)) & 1) as usize]);
                if level > unit.levels.len() {
                    return skip(line, "levels of a texture out of order");
                }
                unit.levels.truncate(level);
                unit.levels.push(board);
            }
            "rgbw" => {
                let [width, height] = size(words)?;
                if words
                    .rest()
                    .iter()
                    .any(|format| *format != "GL_RGBA" && *format != "GL_RGBA8" && *format != "GL_RGB")
                {
                    return skip(line, "textures of this format");
                }
                unit.levels = vec![image(width, height, |x, y| match (x < width / 2, y < height / 2) {
                    (true, true) => RED,
                    (false, true) => GREEN,
                    (true, false) => BLUE,
                    (false, false) => WHITE,
                })];
            }
            "miptree" => {
                let levels = [(8, RED), (4, GREEN), (2, BLUE), (1, WHITE)];
                unit.levels = levels.map(|(side, color)| image(side, side, |_, _| color)).to_vec();
                unit.wrap = Wrap::ClampToEdge;
                unit.filter = Filter::Nearest;
            }
            _ => return skip(line, format_args!("`texture {form}` is not supported")),
        }
        self.active = number;
        Ok(())
    }

    /// Runs a `texparameter` command such as `texparameter 2D min nearest`.
    pub(super) fn parameter(&mut self, words: &mut Words<'_>) -> Result<(), TestResult> {
        let line = words.line;
        words.word()?;
        let (name, value) = (words.word()?, words.word()?);
        let Some(unit) = self.units.get_mut(&self.active) else { return fail(line, "there is no texture yet") };
        match (name, value) {
            ("min" | "mag", "nearest") => unit.filter = Filter::Nearest,
            ("min" | "mag", "linear") => unit.filter = Filter::Linear,
            ("min", "linear_mipmap_linear") => unit.filter = Filter::Trilinear,
            ("wrap_s" | "wrap_t" | "wrap_r", wrap) if Wrap::of_opengl(wrap).is_some() => {
                unit.wrap = Wrap::of_opengl(wrap).unwrap_or(unit.wrap);
            }
            ("compare_func", function) => match Compare::NAMES.iter().find(|(name, _)| *name == function) {
                Some((_, compare)) => unit.compare = *compare,
                None => return fail(line, format_args!("`{function}` compares nothing")),
            },
            _ => return skip(line, format_args!("`texparameter {name} {value}` is not supported")),
        }
        Ok(())
    }

    /// The texture for a sampler of this type at a unit; an unbound unit is black.
    pub(super) fn texture(
        &self,
        line: u32,
        number: u32,
        kind: SamplerType,
    ) -> Result<Option<Arc<Texture>>, TestResult> {
        let Some(unit) = self.units.get(&number) else { return Ok(None) };
        let dimensions = glisten_front::hir::SamplerDim::D2 == kind.dim && !kind.arrayed && kind.texel == Scalar::Float;
        if !dimensions {
            return skip(line, format_args!("a 2D texture at a `{}`", kind.name()));
        }
        Ok(Some(Arc::new(Texture {
            kind,
            levels: unit.levels.clone(),
            filter: unit.filter,
            wrap: unit.wrap,
            compare: unit.compare,
        })))
    }
}

fn size(words: &mut Words<'_>) -> Result<[u32; 2], TestResult> {
    let size = [words.count()?, words.count()?];
    if size.iter().all(|side| (1..=LARGEST).contains(side)) {
        Ok(size)
    } else {
        fail(words.line, format_args!("a texture is 1 to {LARGEST} texels wide and high"))
    }
}

fn image(width: u32, height: u32, texel: impl Fn(u32, u32) -> [f32; 4]) -> TextureLevel {
    let texels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| texel(x, y)).collect();
    TextureLevel { width, height, depth: 1, texels: Texels::Float(texels) }
}
