//! Level of detail (OpenGL 3.2 §3.8.11).

use super::{BoundedFloat, cube};
use crate::domain::rules;
use glisten_front::hir::{SamplerDim, SamplerType};
use glisten_scene::Texture;

/// The change of the coordinates from one pixel to the next.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Gradients {
    pub(crate) dx: [f64; 3],
    pub(crate) dy: [f64; 3],
}

/// The smallest and the largest change along each axis of the texture, in either direction of the window.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Steps {
    pub(crate) least: [f64; 3],
    pub(crate) most: [f64; 3],
    /// The largest width of the interval of a change.
    pub(crate) width: f64,
}

impl Steps {
    /// Adds the change of one coordinate to a neighboring pixel.
    pub(crate) fn add(&mut self, axis: usize, change: BoundedFloat) {
        let least = if change.low <= 0.0 && change.high >= 0.0 { 0.0 } else { change.low.abs().min(change.high.abs()) };
        if let (Some(low), Some(high)) = (self.least.get_mut(axis), self.most.get_mut(axis)) {
            // If the intervals are disjoint, it is known which of both directions is the longer one.
            *low = low.max(least);
            *high = high.max(change.low.abs()).max(change.high.abs());
            self.width = self.width.max(change.high - change.low);
        }
    }
}

/// A level of detail with the interval for a GPU: the scale factor may be anything from the longest step along one
/// axis to the sum of these (conditions 1 and 2 of §3.8.11). For a cube, the steps are not separated by axis.
pub(crate) fn level_bounds(
    texture: &Texture,
    kind: SamplerType,
    at: [BoundedFloat; 3],
    value: f64,
    steps: Option<&Steps>,
) -> BoundedFloat {
    let (Some(steps), Some(base)) = (steps, texture.levels.first()) else { return BoundedFloat::exact(value) };
    if kind.dim == SamplerDim::Cube {
        let (low, high) = const { rules::CUBE_LEVEL.between() };
        let (scale, off) = (value.exp2(), f64::from(base.width) * cube_error(at, steps));
        let least = (scale * low.exp2() - off).max(0.0);
        return BoundedFloat {
            value,
            low: least.log2().min(value),
            high: (scale * high.exp2() + off).log2().max(value),
        };
    }
    let sizes = match kind.dim {
        SamplerDim::Rect => [1.0; 3],
        _ => [base.width, base.height, base.depth].map(f64::from),
    };
    let count = usize::from(kind.dimensions());
    let scaled = |steps: [f64; 3]| (0..count).map(move |axis| steps[axis] * sizes[axis]);
    let least = scaled(steps.least).fold(0.0, f64::max);
    let most: f64 = scaled(steps.most).sum();
    BoundedFloat { value, low: value.min(least.log2()), high: value.max(most.log2()) }
}

/// The largest error of the scale factor on a face of size 1, if the direction and its changes have errors. It is the
/// derivative of a change of s or t, `(dc m - c dm) / (2 m^2)` with `|c| <= m`, twice: for s and for t.
fn cube_error(at: [BoundedFloat; 3], steps: &Steps) -> f64 {
    let off = at.iter().map(|at| at.error()).fold(0.0, f64::max);
    let axis = cube::face_of(at.map(|at| at.value)).ma - off;
    let most = steps.most.iter().copied().fold(0.0, f64::max);
    if axis > 0.0 { 2.0 * (steps.width + 2.0 * most * off / axis) / axis } else { f64::INFINITY }
}

/// The steps in texels of the base level along the rows and the columns of the picture (equation 3.21).
pub(crate) fn steps_in_texels(
    texture: &Texture,
    kind: SamplerType,
    at: [f64; 3],
    gradients: Gradients,
) -> [[f64; 3]; 2] {
    let Some(base) = texture.levels.first() else { return [[0.0; 3]; 2] };
    let sizes = [base.width, base.height, base.depth].map(f64::from);
    let step = |d: [f64; 3]| match kind.dim {
        SamplerDim::Cube => on_face(at, d).map(|change| change * sizes[0]),
        SamplerDim::Rect => [d[0], d[1], 0.0],
        SamplerDim::D1 | SamplerDim::D2 | SamplerDim::D3 | SamplerDim::Buffer | SamplerDim::Multisample => {
            let count = usize::from(kind.dimensions());
            std::array::from_fn(|axis| if axis < count { d[axis] * sizes[axis] } else { 0.0 })
        }
    };
    [step(gradients.dx), step(gradients.dy)]
}

/// How s and t of the face that a direction hits change with the direction.
fn on_face(at: [f64; 3], d: [f64; 3]) -> [f64; 3] {
    let there = cube::face_of(at);
    let [dsc, dtc, dma] = cube::forms(there.face, d);
    let change = |c: f64, dc: f64| 0.5 * (dc * there.ma - c * dma) / (there.ma * there.ma);
    [change(there.sc, dsc), change(there.tc, dtc), 0.0]
}
