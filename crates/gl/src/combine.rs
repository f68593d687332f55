//! Sets the state of `GL_COMBINE` (OpenGL 2.1 §3.8.13).
//!
//! *In:* the combiner of the active unit. *Out:* the driver's state.

use super::old::Old;
use glisten_scene::fixed::{Combination, Combine, CombineFunction, CombineOperand, CombineSource};

const TEXTURE_ENV: u32 = 0x2300;
const COMBINE_RGB: u32 = 0x8571;
const COMBINE_ALPHA: u32 = 0x8572;
const RGB_SCALE: u32 = 0x8573;
const ALPHA_SCALE: u32 = 0x0D1C;
const SRC0_RGB: u32 = 0x8580;
const SRC0_ALPHA: u32 = 0x8588;
const OPERAND0_RGB: u32 = 0x8590;
const OPERAND0_ALPHA: u32 = 0x8598;

/// Sets both halves.
pub(super) fn set(old: &Old, combine: &Combine) {
    half(old, &combine.rgb, [COMBINE_RGB, RGB_SCALE, SRC0_RGB, OPERAND0_RGB]);
    half(old, &combine.alpha, [COMBINE_ALPHA, ALPHA_SCALE, SRC0_ALPHA, OPERAND0_ALPHA]);
}

fn half(old: &Old, half: &Combination, [combine, scale, sources, operands]: [u32; 4]) {
    let set = |name: u32, value: f32| (old.texture_environment)(TEXTURE_ENV, name, &[value; 4]);
    set(combine, function(half.function) as f32);
    set(scale, f32::from(half.scale));
    for ((argument, source), operand) in half.arguments.iter().zip(sources..).zip(operands..) {
        set(source, source_of(argument.source) as f32);
        set(operand, operand_of(argument.operand) as f32);
    }
}

fn function(function: CombineFunction) -> u32 {
    match function {
        CombineFunction::Replace => 0x1E01,
        CombineFunction::Modulate => 0x2100,
        CombineFunction::Add => 0x0104,
        CombineFunction::AddSigned => 0x8574,
        CombineFunction::Interpolate => 0x8575,
        CombineFunction::Subtract => 0x84E7,
        CombineFunction::Dot3Rgb => 0x86AE,
        CombineFunction::Dot3Rgba => 0x86AF,
    }
}

fn source_of(source: CombineSource) -> u32 {
    match source {
        CombineSource::Texture => 0x1702,
        CombineSource::Constant => 0x8576,
        CombineSource::Primary => 0x8577,
        CombineSource::Previous => 0x8578,
        CombineSource::Unit(unit) => glow::TEXTURE0 + u32::from(unit),
    }
}

fn operand_of(operand: CombineOperand) -> u32 {
    match operand {
        CombineOperand::SrcColor => glow::SRC_COLOR,
        CombineOperand::OneMinusSrcColor => glow::ONE_MINUS_SRC_COLOR,
        CombineOperand::SrcAlpha => glow::SRC_ALPHA,
        CombineOperand::OneMinusSrcAlpha => glow::ONE_MINUS_SRC_ALPHA,
    }
}
