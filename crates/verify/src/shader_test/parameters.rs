//! The parameters of a test's texture: filters, wrap modes, comparison, levels and swizzle.
//!
//! *In:* `texparameter` commands. *Out:* what a scene's texture has. *Holds:* a base level is the first one that is kept, and a
//! swizzle is applied to the texels, so that no runner knows of either.

use super::known::{self, PARAMETERS, WRAPS};
use super::words::Words;
use super::{TestResult, skip};
use crate::scene::{Compare, Filter, Sampling, Texels, TextureLevel, Wrap};
use glisten_front::hir::DepthMode;

/// The parameters of a texture.
#[derive(Clone, Debug)]
pub(super) struct Parameters {
    /// The filter within a level, and between levels, for minification.
    pub(super) min: Filter,
    /// The filter for magnification.
    pub(super) mag: Filter,
    /// The wrap modes of `s`, `t` and `r`.
    pub(super) wraps: [Wrap; 3],
    pub(super) compare: Compare,
    /// `GL_DEPTH_TEXTURE_MODE`
    pub(super) depth_mode: DepthMode,
    pub(super) lod_bias: f32,
    pub(super) base_level: u32,
    pub(super) max_level: u32,
    /// The channel of the image that each component is, or 0 or 1.
    pub(super) swizzle: [Channel; 4],
}

/// The source of a component.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Channel {
    Of(usize),
    Zero,
    One,
}

const CHANNELS: &[(&str, Channel)] = &[
    ("red", Channel::Of(0)),
    ("green", Channel::Of(1)),
    ("blue", Channel::Of(2)),
    ("alpha", Channel::Of(3)),
    ("zero", Channel::Zero),
    ("one", Channel::One),
];

/// OpenGL's filters by their names in small letters.
const FILTERS: &[(&str, Filter)] = &[
    ("nearest", Filter::Nearest),
    ("linear", Filter::Linear),
    ("nearest_mipmap_nearest", Filter::NearestMipmapNearest),
    ("linear_mipmap_nearest", Filter::LinearMipmapNearest),
    ("nearest_mipmap_linear", Filter::NearestMipmapLinear),
    ("linear_mipmap_linear", Filter::Trilinear),
];

const DEPTH_MODES: &[(&str, DepthMode)] = &[
    ("luminance", DepthMode::Luminance),
    ("intensity", DepthMode::Intensity),
    ("alpha", DepthMode::Alpha),
    ("red", DepthMode::Red),
];

const WRAP_NAMES: &[&str] = &["wrap_s", "wrap_t", "wrap_r"];

const SWIZZLES: &[&str] = &["swizzle_r", "swizzle_g", "swizzle_b", "swizzle_a"];

impl Default for Parameters {
    fn default() -> Self {
        Self {
            min: Filter::Nearest,
            mag: Filter::Nearest,
            wraps: [Wrap::Repeat; 3],
            compare: Compare::Lequal,
            depth_mode: DepthMode::default(),
            lod_bias: 0.0,
            base_level: 0,
            max_level: 1000,
            swizzle: [0, 1, 2, 3].map(Channel::Of),
        }
    }
}

fn named<T: Copy>(table: &[(&str, T)], name: &str) -> Option<T> {
    table.iter().find(|(known, _)| *known == name).map(|row| row.1)
}

impl Parameters {
    /// Runs a command such as `texparameter 2D min nearest`, after the name of the target.
    pub(super) fn set(&mut self, words: &mut Words<'_>) -> Result<(), TestResult> {
        let line = words.line;
        let name = words.word()?;
        match name {
            "lod_bias" => self.lod_bias = words.number()? as f32,
            "base_level" => self.base_level = words.count()?,
            "max_level" => self.max_level = words.count()?,
            _ => {
                let value = words.word()?;
                if self.choose(name, value).is_none() {
                    return unsupported(line, name, value);
                }
            }
        }
        Ok(())
    }

    /// Sets a parameter whose value is a name.
    fn choose(&mut self, name: &str, value: &str) -> Option<()> {
        if let Some(component) = SWIZZLES.iter().position(|known| *known == name) {
            *self.swizzle.get_mut(component)? = named(CHANNELS, value)?;
            return Some(());
        }
        if let Some(direction) = WRAP_NAMES.iter().position(|known| *known == name) {
            *self.wraps.get_mut(direction)? = Wrap::of_opengl(value)?;
            return Some(());
        }
        match name {
            "min" => self.min = named(FILTERS, value)?,
            "mag" => self.mag = named(FILTERS, value).filter(|filter| !filter.uses_levels())?,
            "depth_mode" => self.depth_mode = named(DEPTH_MODES, value)?,
            "compare_func" => self.compare = named(Compare::NAMES, value)?,
            _ => return None,
        }
        Some(())
    }

    /// The wrap mode of a texture with so many directions, if they have the same.
    pub(super) fn wrap(&self, directions: usize) -> Option<Wrap> {
        let [first, ..] = self.wraps;
        self.wraps.iter().take(directions).all(|wrap| *wrap == first).then_some(first)
    }

    /// The parameters of a scene's texture besides its filter and its wrap mode.
    pub(super) fn sampling(&self, shadow: bool) -> Sampling {
        let magnify_linear = Some(self.mag.is_linear()).filter(|linear| *linear != self.min.is_linear());
        // The window's driver stores depth as fixed-point numbers.
        Sampling { lod_bias: self.lod_bias, magnify_linear, fixed_point_depth: shadow }
    }

    /// The levels from the base level to the last one, swizzled.
    pub(super) fn levels(&self, levels: &[TextureLevel]) -> Vec<TextureLevel> {
        let count = (self.max_level.saturating_sub(self.base_level) as usize).saturating_add(1);
        levels.iter().skip(self.base_level as usize).take(count).map(|level| self.swizzled(level)).collect()
    }

    fn swizzled(&self, level: &TextureLevel) -> TextureLevel {
        let mut level = level.clone();
        if let Texels::Float(texels) = &mut level.texels {
            for texel in texels {
                let source = *texel;
                *texel = self.swizzle.map(|channel| match channel {
                    Channel::Of(index) => source.get(index).copied().unwrap_or(0.0),
                    Channel::Zero => 0.0,
                    Channel::One => 1.0,
                });
            }
        }
        level
    }
}

/// Skips a parameter that is not supported, and fails for one that shader_runner does not have.
fn unsupported(line: u32, name: &str, value: &str) -> Result<(), TestResult> {
    let values: Vec<&str> = match name {
        "min" | "mag" => FILTERS.iter().map(|row| row.0).collect(),
        name if WRAP_NAMES.contains(&name) => WRAPS.to_vec(),
        "depth_mode" => DEPTH_MODES.iter().map(|row| row.0).collect(),
        "compare_func" => Compare::NAMES.iter().map(|row| row.0).collect(),
        name if SWIZZLES.contains(&name) => CHANNELS.iter().map(|row| row.0).collect(),
        "border_color" => return skip(line, "`texparameter border_color` is not supported"),
        _ => return known::mistake(line, name, "a parameter of textures", PARAMETERS.iter().copied()),
    };
    match values.contains(&value) {
        true => skip(line, format_args!("`texparameter {name} {value}` is not supported")),
        false => known::mistake(line, value, &format!("a value of `{name}`"), values),
    }
}

#[cfg(test)]
mod unit {
    use super::*;

    #[test]
    fn base_levels_and_swizzles_change_the_image() {
        let mut parameters = Parameters::default();
        for command in ["base_level 1", "swizzle_r blue", "swizzle_a one", "mag linear", "wrap_t clamp_to_edge"] {
            assert_eq!(parameters.set(&mut Words::new(1, command)), Ok(()), "{command}");
        }
        let level =
            |width| TextureLevel { width, height: 1, depth: 1, texels: Texels::Float(vec![[0.1, 0.2, 0.3, 0.4]]) };
        let levels = parameters.levels(&[level(2), level(1)]);
        assert_eq!(levels, [TextureLevel { texels: Texels::Float(vec![[0.3, 0.2, 0.3, 1.0]]), ..level(1) }]);
        assert_eq!(parameters.sampling(false).magnify_linear, Some(true));
        assert_eq!((parameters.wrap(1), parameters.wrap(2)), (Some(Wrap::Repeat), None));
    }

    #[test]
    fn what_is_not_supported_is_skipped_and_what_is_unknown_fails() {
        let set = |command| Parameters::default().set(&mut Words::new(3, command));
        for command in ["border_color 0 0 0 0", "wrap_s clamp_to_border"] {
            assert!(matches!(set(command), Err(TestResult::Skip(_))), "{command}");
        }
        for command in ["anisotropy much", "compare_func nearly", "mag linaer", "wrap_s repaet"] {
            assert!(matches!(set(command), Err(TestResult::Fail(_))), "{command}");
        }
    }
}
