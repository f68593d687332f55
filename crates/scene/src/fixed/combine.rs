//! `GL_COMBINE`: a texture environment of functions, sources and operands (OpenGL 2.1 §3.8.13, tables 3.24 to 3.27).
//!
//! *In:* the state of a unit. *Out:* statements of GLSL. *Holds:* the initial state modulates, as that of OpenGL does. The source
//! of another unit's texture is that of texture crossbars, in the core since 1.4.

use super::UNITS;

/// The state of both halves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Combine {
    /// Red, green and blue.
    pub rgb: Combination,
    /// Alpha. [`CombineFunction::Dot3Rgba`] for the colors replaces it.
    pub alpha: Combination,
}

/// The computation of one half.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Combination {
    /// The function of the arguments.
    pub function: CombineFunction,
    /// Arg0 to Arg2.
    pub arguments: [CombineArgument; 3],
    /// `RGB_SCALE` or `ALPHA_SCALE`: 1, 2 or 4.
    pub scale: u8,
}

/// An argument: a color and the part that is taken of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CombineArgument {
    /// The color.
    pub source: CombineSource,
    /// The part that is taken of it.
    pub operand: CombineOperand,
}

/// `COMBINE_RGB`, `COMBINE_ALPHA`
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(missing_docs, reason = "the names say it")]
pub enum CombineFunction {
    Replace,
    Modulate,
    Add,
    AddSigned,
    Interpolate,
    Subtract,
    /// For colors only.
    Dot3Rgb,
    /// For colors only; alpha is the same number.
    Dot3Rgba,
}

impl CombineFunction {
    /// The names in scene files. Those from [`Self::DOTS`] on are for colors only.
    pub const NAMES: &[(&str, Self)] = &[
        ("replace", Self::Replace),
        ("modulate", Self::Modulate),
        ("add", Self::Add),
        ("add_signed", Self::AddSigned),
        ("interpolate", Self::Interpolate),
        ("subtract", Self::Subtract),
        ("dot3_rgb", Self::Dot3Rgb),
        ("dot3_rgba", Self::Dot3Rgba),
    ];

    /// How many of the names are for alpha, too.
    pub const DOTS: usize = 6;

    /// The number of arguments.
    fn arguments(self) -> usize {
        match self {
            Self::Replace => 1,
            Self::Interpolate => 3,
            Self::Modulate | Self::Add | Self::AddSigned | Self::Subtract | Self::Dot3Rgb | Self::Dot3Rgba => 2,
        }
    }
}

/// `SRCn_RGB`, `SRCn_ALPHA`
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CombineSource {
    /// The unit's texture.
    Texture,
    /// `TEXTURE_ENV_COLOR`
    Constant,
    /// `gl_Color`
    Primary,
    /// The result of the unit before.
    Previous,
    /// The texture of another unit.
    Unit(u8),
}

impl CombineSource {
    /// The names in scene files.
    pub const NAMES: &[(&str, Self)] = &[
        ("texture", Self::Texture),
        ("constant", Self::Constant),
        ("primary_color", Self::Primary),
        ("previous", Self::Previous),
        ("texture0", Self::Unit(0)),
        ("texture1", Self::Unit(1)),
        ("texture2", Self::Unit(2)),
        ("texture3", Self::Unit(3)),
        ("texture4", Self::Unit(4)),
        ("texture5", Self::Unit(5)),
        ("texture6", Self::Unit(6)),
        ("texture7", Self::Unit(7)),
    ];
}

/// `OPERANDn_RGB`, `OPERANDn_ALPHA`
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(missing_docs, reason = "the names say it")]
pub enum CombineOperand {
    SrcColor,
    OneMinusSrcColor,
    SrcAlpha,
    OneMinusSrcAlpha,
}

impl CombineOperand {
    /// The names in scene files. The last two are for alpha, too.
    pub const NAMES: &[(&str, Self)] = &[
        ("src_color", Self::SrcColor),
        ("one_minus_src_color", Self::OneMinusSrcColor),
        ("src_alpha", Self::SrcAlpha),
        ("one_minus_src_alpha", Self::OneMinusSrcAlpha),
    ];
}

impl Default for Combine {
    fn default() -> Self {
        let arguments = |operands: [CombineOperand; 3]| {
            let sources = [CombineSource::Texture, CombineSource::Previous, CombineSource::Constant];
            let mut operands = operands.into_iter();
            sources
                .map(|source| CombineArgument { source, operand: operands.next().unwrap_or(CombineOperand::SrcAlpha) })
        };
        let half =
            |operands| Combination { function: CombineFunction::Modulate, arguments: arguments(operands), scale: 1 };
        let alpha = CombineOperand::SrcAlpha;
        Self { rgb: half([CombineOperand::SrcColor, CombineOperand::SrcColor, alpha]), alpha: half([alpha; 3]) }
    }
}

impl Combine {
    /// The other units whose textures are read.
    pub fn units(&self) -> impl Iterator<Item = u8> {
        [self.rgb, self.alpha].into_iter().flat_map(|half| half.used().map(|argument| argument.source)).filter_map(
            |source| match source {
                CombineSource::Unit(unit) if usize::from(unit) < UNITS => Some(unit),
                _ => None,
            },
        )
    }

    /// The statements that change `color`, for unit `index`.
    pub(super) fn statements(&self, index: usize) -> String {
        let rgb = self.rgb.value(index, true);
        let alpha = match self.rgb.function {
            // The alpha function is ignored, but not its scale.
            CombineFunction::Dot3Rgba => scaled(self.rgb.computed(index, true), self.alpha.scale),
            _ => self.alpha.value(index, false),
        };
        let is_dot = matches!(self.rgb.function, CombineFunction::Dot3Rgb | CombineFunction::Dot3Rgba);
        let rgb = if is_dot { format!("vec3({rgb})") } else { rgb };
        format!("    color = clamp(vec4({rgb}, {alpha}), 0.0, 1.0);\n")
    }
}

impl Combination {
    fn used(self) -> impl Iterator<Item = CombineArgument> {
        self.arguments.into_iter().take(self.function.arguments())
    }

    fn value(self, index: usize, colors: bool) -> String {
        scaled(self.computed(index, colors), self.scale)
    }

    /// The function of the arguments, before it is scaled.
    fn computed(self, index: usize, colors: bool) -> String {
        let [a, b, c] = self.arguments.map(|argument| argument.text(index, colors));
        match self.function {
            CombineFunction::Replace => a,
            CombineFunction::Modulate => format!("{a} * {b}"),
            CombineFunction::Add => format!("({a} + {b})"),
            CombineFunction::AddSigned => format!("({a} + {b} - 0.5)"),
            CombineFunction::Interpolate => format!("mix({b}, {a}, {c})"),
            CombineFunction::Subtract => format!("({a} - {b})"),
            CombineFunction::Dot3Rgb | CombineFunction::Dot3Rgba => format!("4.0 * dot({a} - 0.5, {b} - 0.5)"),
        }
    }
}

fn scaled(value: String, scale: u8) -> String {
    if scale == 1 { value } else { format!("{scale}.0 * {value}") }
}

impl CombineArgument {
    /// The argument as a `vec3` for colors, or as a `float` for alpha.
    fn text(self, index: usize, colors: bool) -> String {
        let color = match self.source {
            CombineSource::Texture => format!("texel{index}"),
            CombineSource::Constant => format!("gl_TextureEnvColor[{index}]"),
            CombineSource::Primary => "gl_Color".to_owned(),
            CombineSource::Previous => "color".to_owned(),
            CombineSource::Unit(unit) => format!("texel{unit}"),
        };
        let alpha = if colors { format!("vec3({color}.a)") } else { format!("{color}.a") };
        match (self.operand, colors) {
            (CombineOperand::SrcColor, true) => format!("{color}.rgb"),
            (CombineOperand::OneMinusSrcColor, true) => format!("(1.0 - {color}.rgb)"),
            (CombineOperand::SrcAlpha | CombineOperand::SrcColor, _) => alpha,
            (CombineOperand::OneMinusSrcAlpha | CombineOperand::OneMinusSrcColor, _) => format!("(1.0 - {alpha})"),
        }
    }
}

#[cfg(test)]
mod unit {
    use super::*;

    #[test]
    fn the_initial_state_modulates() {
        let text = Combine::default().statements(2);
        assert_eq!(text, "    color = clamp(vec4(texel2.rgb * color.rgb, texel2.a * color.a), 0.0, 1.0);\n");
    }

    #[test]
    fn functions_scales_and_operands() {
        let mut combine = Combine::default();
        combine.rgb = Combination { function: CombineFunction::Dot3Rgba, scale: 2, ..combine.rgb };
        combine.alpha.scale = 4;
        let dot = "4.0 * dot(texel0.rgb - 0.5, color.rgb - 0.5)";
        let text = format!("    color = clamp(vec4(vec3(2.0 * {dot}), 4.0 * {dot}), 0.0, 1.0);\n");
        assert_eq!(combine.statements(0), text);
        combine.rgb = Combination { function: CombineFunction::Interpolate, scale: 1, ..combine.rgb };
        combine.rgb.arguments[2] =
            CombineArgument { source: CombineSource::Unit(1), operand: CombineOperand::OneMinusSrcAlpha };
        combine.alpha = Combination { function: CombineFunction::Subtract, scale: 1, ..combine.alpha };
        let rgb = "mix(color.rgb, texel0.rgb, (1.0 - vec3(texel1.a)))";
        let text = format!("    color = clamp(vec4({rgb}, (texel0.a - color.a)), 0.0, 1.0);\n");
        assert_eq!(combine.statements(0), text);
        assert_eq!(combine.units().collect::<Vec<u8>>(), [1]);
    }
}
