//! Level of detail (OpenGL 3.2 §3.8.11).

use super::cube;
use super::texel::dimensions;
use crate::hir::{SamplerDim, SamplerType};
use crate::scene::Texture;

/// The change of the coordinates from pixel to pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Gradients {
    pub(crate) dx: [f64; 3],
    pub(crate) dy: [f64; 3],
}

/// `log2(rho)`, rho being the longer of the two steps in texels of the base level (equation 3.21 and the one below it).
/// Minus infinity where nothing changes.
pub(crate) fn level_of_detail(texture: &Texture, kind: SamplerType, at: [f64; 3], gradients: Gradients) -> f64 {
    let Some(base) = texture.levels.first() else { return f64::NEG_INFINITY };
    let sizes = [base.width, base.height, base.depth].map(f64::from);
    let step = |d: [f64; 3]| -> f64 {
        let scaled = match kind.dim {
            SamplerDim::Cube => on_face(at, d).map(|change| change * sizes[0]),
            SamplerDim::Rect => [d[0], d[1], 0.0],
            dim => {
                let count = dimensions(dim);
                std::array::from_fn(|axis| if axis < count { d[axis] * sizes[axis] } else { 0.0 })
            }
        };
        scaled.iter().map(|change| change * change).sum::<f64>().sqrt()
    };
    step(gradients.dx).max(step(gradients.dy)).log2()
}

/// How s and t of the face that a direction meets change with the direction.
fn on_face(at: [f64; 3], d: [f64; 3]) -> [f64; 3] {
    let there = cube::face_of(at);
    let [dsc, dtc, dma] = cube::forms(there.face, d);
    let change = |c: f64, dc: f64| 0.5 * (dc * there.ma - c * dma) / (there.ma * there.ma);
    [change(there.sc, dsc), change(there.tc, dtc), 0.0]
}
