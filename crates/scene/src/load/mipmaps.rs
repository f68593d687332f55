//! Computes mipmap chains with a box filter (OpenGL 3.2 §3.8.11).
//!
//! *In:* the first level. *Out:* all levels down to one texel. Each texel is the weighted mean of the texels of the
//! level before that it covers; for even sizes, the mean of 2, 4 or 8. *Holds:* sums are in f64 and rounded once per
//! level, as a texture in `rgba32f` stores them. Faces and layers are filtered separately.

use crate::model::{Texels, TextureLevel};
use glisten_front::hir::{SamplerDim, SamplerType};

/// The whole chain that starts with `base`. Integers are not averaged: such textures have only one level.
pub(super) fn chain(base: TextureLevel, kind: SamplerType) -> Vec<TextureLevel> {
    let shrinks_depth = kind.dim == SamplerDim::D3;
    let mut levels = vec![base];
    while let Some(last) = levels.last() {
        let is_last = last.width == 1 && last.height == 1 && (!shrinks_depth || last.depth == 1);
        let next = if is_last { None } else { halve(last, shrinks_depth) };
        match next {
            Some(next) => levels.push(next),
            None => break,
        }
    }
    levels
}

/// The texels of `from` that texel `index` of `to` covers: the first one, and weights that add up to 1.
fn footprint(from: u32, to: u32, index: u32) -> (u32, Vec<f64>) {
    let scale = f64::from(from) / f64::from(to);
    let (start, end) = (f64::from(index) * scale, f64::from(index + 1) * scale);
    let first = start.floor() as u32;
    let last = (end.ceil() as u32).min(from);
    let weights = (first..last)
        .map(|texel| (end.min(f64::from(texel) + 1.0) - start.max(f64::from(texel))).max(0.0) / scale)
        .collect();
    (first, weights)
}

fn halve(level: &TextureLevel, shrinks_depth: bool) -> Option<TextureLevel> {
    let Texels::Float(source) = &level.texels else { return None };
    let (width, height) = ((level.width / 2).max(1), (level.height / 2).max(1));
    let depth = if shrinks_depth { (level.depth / 2).max(1) } else { level.depth };
    let columns: Vec<_> = (0..width).map(|x| footprint(level.width, width, x)).collect();
    let rows: Vec<_> = (0..height).map(|y| footprint(level.height, height, y)).collect();
    let slices: Vec<_> = (0..depth).map(|z| footprint(level.depth, depth, z)).collect();
    let mut texels = Vec::with_capacity(width as usize * height as usize * depth as usize);
    for (first_z, z_weights) in &slices {
        for (first_y, y_weights) in &rows {
            for (first_x, x_weights) in &columns {
                let mut sum = [0.0_f64; 4];
                for (z, z_weight) in (*first_z..).zip(z_weights) {
                    for (y, y_weight) in (*first_y..).zip(y_weights) {
                        for (x, x_weight) in (*first_x..).zip(x_weights) {
                            let index = ((z * level.height + y) * level.width + x) as usize;
                            let Some(texel) = source.get(index) else { continue };
                            let weight = z_weight * y_weight * x_weight;
                            for (total, channel) in sum.iter_mut().zip(texel) {
                                *total += weight * f64::from(*channel);
                            }
                        }
                    }
                }
                texels.push(sum.map(|channel| channel as f32));
            }
        }
    }
    Some(TextureLevel { width, height, depth, texels: Texels::Float(texels) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use glisten_front::hir::Scalar;

    fn level(width: u32, height: u32, depth: u32, values: &[f32]) -> TextureLevel {
        TextureLevel {
            width,
            height,
            depth,
            texels: Texels::Float(values.iter().map(|&v| [v, 0.0, 0.0, 1.0]).collect()),
        }
    }

    fn reds(level: &TextureLevel) -> Vec<f32> {
        match &level.texels {
            Texels::Float(texels) => texels.iter().map(|texel| texel[0]).collect(),
            Texels::Int(_) | Texels::Uint(_) => Vec::new(),
        }
    }

    #[test]
    fn even_sizes_are_means_of_four_and_odd_ones_weigh_by_area() {
        let d2 = SamplerType { texel: Scalar::Float, dim: SamplerDim::D2, arrayed: false, shadow: false };
        let levels = chain(level(4, 2, 1, &[0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0]), d2);
        assert_eq!(levels.iter().map(reds).collect::<Vec<_>>()[1..], [vec![2.5, 4.5], vec![3.5]]);
        let levels = chain(level(3, 1, 1, &[0.0, 3.0, 6.0]), d2);
        assert_eq!(reds(&levels[1]), [3.0]);
        assert_eq!(footprint(5, 2, 1).1, [0.2, 0.4, 0.4]);
    }

    #[test]
    fn layers_stay_and_slices_shrink() {
        let array = SamplerType { texel: Scalar::Float, dim: SamplerDim::D2, arrayed: true, shadow: false };
        let levels = chain(level(2, 1, 2, &[0.0, 2.0, 4.0, 6.0]), array);
        assert_eq!(reds(&levels[1]), [1.0, 5.0]);
        let volume = SamplerType { texel: Scalar::Float, dim: SamplerDim::D3, arrayed: false, shadow: false };
        let levels = chain(level(2, 1, 2, &[0.0, 2.0, 4.0, 6.0]), volume);
        assert_eq!(reds(&levels[1]), [3.0]);
    }
}
