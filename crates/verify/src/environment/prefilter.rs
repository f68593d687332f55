//! [`Prefiltered`]: the radiance that a surface mirrors from each direction, for several roughnesses.
//!
//! *In:* a panorama. *Out:* maps on an octahedron, one above the other, as the module `environment` reads them. *Holds:* the first and the
//! last texel of a row are on the edge of the octahedron, so that texels of one direction are equal and no seam is left. Row 0 is t = 0
//! of the roughness 0.

use super::lobe::{frame, mirrored, placed};
use super::panorama::{MOST, Panorama};
use crate::measure::vector::{V, unit};
use glisten_scene::picture::{ImageError, exr_of_colors};
use rayon::prelude::*;
use std::f64::consts::PI;

/// Prefiltered radiance.
#[derive(Clone, Debug)]
pub struct Prefiltered {
    side: usize,
    levels: usize,
    texels: Vec<[f32; 3]>,
}

/// The place of a direction on the unfolded octahedron: 0 to 1, the middle is +y.
fn place(d: V) -> [f64; 2] {
    let [x, y, z] = d.map(f64::abs);
    let below = if d[1] < 0.0 { y } else { 0.0 };
    let sum = x + y + z;
    [(x + below).copysign(d[0]), (z + below).copysign(d[2])].map(|at| 0.5 + 0.5 * at / sum)
}

/// The direction of a place.
fn direction([s, t]: [f64; 2]) -> V {
    let (x, z) = (2.0 * s - 1.0, 2.0 * t - 1.0);
    let y = 1.0 - x.abs() - z.abs();
    let folded = if y < 0.0 { [(1.0 - z.abs()).copysign(x), (1.0 - x.abs()).copysign(z)] } else { [x, z] };
    unit([folded[0], y, folded[1]])
}

impl Prefiltered {
    /// Maps of `side` by `side` texels for `levels` roughnesses from 0 to 1, by this many rays for each texel.
    pub fn new(panorama: &Panorama, side: usize, levels: usize, rays: usize) -> Self {
        let last = (side.max(2) - 1) as f64;
        let mut texels = Vec::with_capacity(side * side * levels);
        for level in 0..levels {
            let roughness = level as f64 / (levels.max(2) - 1) as f64;
            let lobe = if level == 0 { Vec::new() } else { mirrored(roughness * roughness, rays) };
            let texel = |index: usize| -> [f32; 3] {
                let d = direction([(index % side) as f64 / last, (index / side) as f64 / last]);
                if lobe.is_empty() {
                    // The mean over what is nearest to this texel.
                    return panorama.radiance(d, (4.0 * PI).sqrt() / last).map(single);
                }
                let axes = frame(d);
                let mut sum = [0.0; 3];
                for ray in &lobe {
                    let radiance = panorama.radiance(placed(&axes, ray.light), ray.angle);
                    sum.iter_mut().zip(radiance).for_each(|(sum, channel)| *sum += ray.weight * channel);
                }
                sum.map(single)
            };
            texels.par_extend((0..side * side).into_par_iter().map(texel));
        }
        Self { side, levels, texels }
    }

    /// Width and height of the picture.
    pub fn size(&self) -> [usize; 2] {
        [self.side, self.side * self.levels]
    }

    /// The picture as an OpenEXR file.
    ///
    /// # Errors
    /// It cannot be encoded.
    pub fn exr(&self) -> Result<Vec<u8>, ImageError> {
        let rows: Vec<[f32; 3]> = self.texels.chunks(self.side).rev().flatten().copied().collect();
        exr_of_colors(self.side as u32, (self.side * self.levels) as u32, &rows)
    }

    /// The radiance that `environmentRadiance()` finds, in f64.
    pub(super) fn radiance(&self, d: V, roughness: f64) -> V {
        let at = roughness.clamp(0.0, 1.0) * (self.levels - 1) as f64;
        let [low, high] = [at.floor() as usize, (at.floor() as usize + 1).min(self.levels - 1)];
        let (fine, coarse, t) = (self.of_level(d, low), self.of_level(d, high), at.fract());
        std::array::from_fn(|k| (1.0 - t) * fine[k] + t * coarse[k])
    }

    fn of_level(&self, d: V, level: usize) -> V {
        let last = self.side - 1;
        let [x, y] = place(d).map(|at| at * last as f64);
        let (column, row, u, v) = (x.floor() as usize, y.floor() as usize, x.fract(), y.fract());
        let texel = |column: usize, row: usize| {
            let index = (level * self.side + row.min(last)) * self.side + column.min(last);
            self.texels.get(index).copied().unwrap_or_default().map(f64::from)
        };
        let [a, b, c, d] =
            [texel(column, row), texel(column + 1, row), texel(column, row + 1), texel(column + 1, row + 1)];
        std::array::from_fn(|k| (1.0 - v) * ((1.0 - u) * a[k] + u * b[k]) + v * ((1.0 - u) * c[k] + u * d[k]))
    }
}

fn single(value: f64) -> f32 {
    (value as f32).min(MOST)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glisten_scene::picture::Image;

    #[test]
    fn places_and_directions_are_inverse_and_edges_meet() {
        for k in 0..400 {
            let (a, b) = (f64::from(k) * 0.37, f64::from(k) * 1.71);
            let d = unit([a.sin() * b.cos(), a.cos(), a.sin() * b.sin()]);
            let back = direction(place(d));
            assert!((0..3).all(|axis| (back[axis] - d[axis]).abs() < 1e-12), "{d:?} {back:?}");
        }
        for k in 0..=8 {
            let t = f64::from(k) / 8.0;
            let (a, b) = (direction([0.0, t]), direction([0.0, 1.0 - t]));
            assert!((0..3).all(|axis| (a[axis] - b[axis]).abs() < 1e-12), "{a:?} {b:?}");
        }
    }

    #[test]
    fn a_white_panorama_is_white_at_every_roughness() {
        let white = Image { width: 32, height: 16, pixels: vec![[1.0; 4]; 512] };
        let panorama = Panorama::new(&white).expect("twice as wide");
        let maps = Prefiltered::new(&panorama, 5, 3, 64);
        assert_eq!(maps.size(), [5, 15]);
        assert!(maps.texels.iter().flatten().all(|channel| (channel - 1.0).abs() < 1e-6));
        let image = Image::read(&maps.exr().expect("it is encoded"), 64, 4096).expect("it can be read");
        assert_eq!((image.width, image.height), (5, 15));
    }
}
