//! The keys of a texture unit whose environment combines (OpenGL 2.1 §3.8.13).
//!
//! *In:* the table of a unit. *Out:* a [`Combine`]. *Holds:* what a table leaves out is OpenGL's initial state.

use crate::fixed::{Combination, Combine, CombineFunction, CombineOperand, CombineSource};
use crate::tables::{Node, Reader};
use toml::de::DeTable;

/// The keys.
pub(super) const KEYS: &[&str] = &[
    "combine_rgb",
    "combine_alpha",
    "source_rgb",
    "source_alpha",
    "operand_rgb",
    "operand_alpha",
    "rgb_scale",
    "alpha_scale",
];

const SCALES: std::ops::RangeInclusive<u32> = 1..=4;

/// The combiner of a unit.
pub(super) fn load(reader: &mut Reader, table: &DeTable<'_>) -> Combine {
    let initial = Combine::default();
    let alone = CombineFunction::NAMES.get(..CombineFunction::DOTS).unwrap_or(CombineFunction::NAMES);
    let alphas = CombineOperand::NAMES.get(2..).unwrap_or(CombineOperand::NAMES);
    let rgb = reader.choice_at(table, "combine_rgb", initial.rgb.function, CombineFunction::NAMES);
    let alpha = reader.choice_at(table, "combine_alpha", initial.alpha.function, alone);
    let mut combine = Combine {
        rgb: Combination { function: rgb, ..initial.rgb },
        alpha: Combination { function: alpha, ..initial.alpha },
    };
    for (half, names, operands) in [
        (&mut combine.rgb, ["source_rgb", "operand_rgb", "rgb_scale"], CombineOperand::NAMES),
        (&mut combine.alpha, ["source_alpha", "operand_alpha", "alpha_scale"], alphas),
    ] {
        let [sources_key, operands_key, scale_key] = names;
        for (argument, source) in half.arguments.iter_mut().zip(list(reader, table, sources_key, CombineSource::NAMES))
        {
            argument.source = source;
        }
        for (argument, operand) in half.arguments.iter_mut().zip(list(reader, table, operands_key, operands)) {
            argument.operand = operand;
        }
        half.scale = scale(reader, table, scale_key);
    }
    combine
}

/// Up to three names.
fn list<T: Copy>(reader: &mut Reader, table: &DeTable<'_>, key: &str, names: &[(&str, T)]) -> Vec<T> {
    let Some(node) = table.get(key) else { return Vec::new() };
    let given: &[Node<'_>] = match node.get_ref().as_array() {
        Some(array) if array.len() <= 3 => array,
        _ => {
            reader.wrong_type(node, key, "a list of up to three names");
            return Vec::new();
        }
    };
    given.iter().filter_map(|name| reader.choice(name, key, names)).collect()
}

fn scale(reader: &mut Reader, table: &DeTable<'_>, key: &str) -> u8 {
    let scale = reader.count(table, key, 1, SCALES);
    if let Some(node) = table.get(key).filter(|_| scale == 3) {
        let span = reader.span_of(node);
        reader.wrong_value(span, format!("`{key}` is 1, 2 or 4"), "not 3");
    }
    scale as u8
}
