//! `[environment]` by nine coefficients of spherical harmonics, or by a sky and a ground, which are its first two bands.
//!
//! *In:* the scene's table. *Out:* [`Harmonics`], the radiance in the order of the library's module `irradiance`. *Holds:* a table has
//! one form: a texture, coefficients, or half spheres. *Not done here:* the texture (`textures`).

use crate::tables::{Node, NumberValue, Reader};
use glam::DVec3;
use glisten_front::diagnostic::codes::scenes::SCENE_WRONG_SIZE;
use glisten_front::source::Span;
use std::f64::consts::PI;
use toml::de::DeTable;

/// The uniform of programs that gets the coefficients.
pub(super) const HARMONICS: &str = "harmonics";

/// The coefficients of nine harmonics.
const N: usize = 9;

const HALVES: &[&str] = &["sky", "ground", "axis"];

/// Light from all around, without detail.
#[derive(Clone, Copy, Debug)]
pub(super) struct Harmonics {
    /// L_00, L_1-1, L_10, L_11, L_2-2, L_2-1, L_20, L_21, L_22 of the radiance, linear RGB.
    pub(super) coefficients: [DVec3; N],
    /// The span of its table.
    pub(super) span: Span,
}

/// The harmonics of an environment; `None` for one that is a texture, or `Some(None)` (reported) for one that is wrong.
pub(super) fn load(reader: &mut Reader, node: &Node<'_>) -> Option<Option<Harmonics>> {
    let table = node.get_ref().as_table()?;
    let by_halves = HALVES.iter().any(|key| table.contains_key(*key));
    let by_coefficients = table.contains_key("coefficients");
    if !by_halves && !by_coefficients {
        return None;
    }
    if by_coefficients {
        reader.check_keys(table, "an environment by coefficients", &["coefficients"]);
    } else {
        reader.check_keys(table, "an environment of two half spheres", HALVES);
    }
    let coefficients = if by_coefficients { stated(reader, table) } else { halves(reader, table) };
    Some(coefficients.map(|coefficients| Harmonics { coefficients, span: reader.span_of(node) }))
}

/// Nine colors as the scene states them.
fn stated(reader: &mut Reader, table: &DeTable<'_>) -> Option<[DVec3; N]> {
    let node = table.get("coefficients")?;
    let numbers = reader.numbers(node, "coefficients")?;
    if numbers.len() != 3 * N {
        let span = reader.span_of(node);
        let message = format!("`coefficients` are nine colors, which are 27 numbers, not {}", numbers.len());
        reader.error(&SCENE_WRONG_SIZE, span, message, "L_00, L_1-1, L_10, L_11, L_2-2, L_2-1, L_20, L_21, L_22");
        return None;
    }
    let mut coefficients = [DVec3::ZERO; N];
    for (into, from) in coefficients.iter_mut().zip(numbers.chunks_exact(3)) {
        if let [r, g, b] = from {
            *into = DVec3::from([r, g, b].map(|number| real(number.value)));
        }
    }
    Some(coefficients)
}

fn real(number: NumberValue) -> f64 {
    match number {
        NumberValue::Float(value) | NumberValue::Int(_, value) => f64::from(value),
        NumberValue::Bool(value) => f64::from(u8::from(value)),
    }
}

/// The light of a sky and a ground: its mean, and their difference along the axis. What a matte surface gets of it is
/// (sky + ground) / 2 + (sky - ground) / 2 cos, which these two bands are exactly.
fn halves(reader: &mut Reader, table: &DeTable<'_>) -> Option<[DVec3; N]> {
    let sky = DVec3::from(reader.reals(table, "sky", [1.0; 3]));
    let ground = DVec3::from(reader.reals(table, "ground", [0.0; 3]));
    let axis = DVec3::from(reader.reals(table, "axis", [0.0, 1.0, 0.0]));
    let Some(up) = axis.try_normalize() else {
        let span = table.get("axis").map(|node| reader.span_of(node)).unwrap_or_default();
        reader.wrong_value(span, "the `axis` of an environment points to the middle of its sky", "no direction");
        return None;
    };
    let mean = (sky + ground) / 2.0;
    let slope = (sky - ground) / 2.0;
    // The functions of the first two bands are sqrt(1 / 4 pi) and sqrt(3 / 4 pi) cos; the cosine of a matte surface keeps 1 and 2/3 of them.
    let [first, second] = [(4.0 * PI).sqrt(), (4.0 * PI / 3.0).sqrt() * 1.5];
    let mut coefficients = [DVec3::ZERO; N];
    let bands = [mean * first, slope * (second * up.y), slope * (second * up.z), slope * (second * up.x)];
    for (into, from) in coefficients.iter_mut().zip(bands) {
        *into = from;
    }
    Some(coefficients)
}
