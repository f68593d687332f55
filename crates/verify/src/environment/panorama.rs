//! [`Panorama`]: light from all around, as a picture of longitude and latitude.
//!
//! *In:* a picture twice as wide as high; +y is up, and its middle is +x. *Out:* the radiance of a direction, of the panorama itself or of
//! means over its parts. *Holds:* texels have the solid angles of their rows, so that means keep the light. Radiance is finite and at
//! least 0.

use crate::measure::vector::V;
use glisten_scene::picture::Image;
use std::f64::consts::{PI, TAU};

/// The most radiance of a texel: what the maps, of 16-bit floats, hold.
pub(super) const MOST: f32 = 65504.0;

/// Light from all around.
#[derive(Clone, Debug)]
pub struct Panorama {
    /// The picture, and pictures of half of its size each.
    levels: Vec<Level>,
    /// The texels that were limited: negative, not finite, or brighter than the maps hold.
    pub n_limited: usize,
}

#[derive(Clone, Debug)]
struct Level {
    width: usize,
    height: usize,
    texels: Vec<[f32; 3]>,
}

/// The direction of a place in a panorama: 0 to 1 from left to right, and from top to bottom.
fn direction(s: f64, t: f64) -> V {
    let ((sin_s, cos_s), (sin_t, cos_t)) = ((TAU * (s - 0.5)).sin_cos(), (PI * t).sin_cos());
    [sin_t * cos_s, cos_t, sin_t * sin_s]
}

impl Level {
    /// The solid angle of a texel of a row, over 2 pi.
    fn share(&self, row: usize) -> f64 {
        let edge = |row: usize| (PI * row as f64 / self.height as f64).cos();
        (edge(row) - edge(row + 1)) / self.width as f64
    }

    fn texel(&self, column: usize, row: usize) -> [f32; 3] {
        self.texels.get(row * self.width + column).copied().unwrap_or_default()
    }

    /// Linear between the centers of texels.
    fn radiance(&self, d: V) -> V {
        let s = d[2].atan2(d[0]) / TAU + 0.5;
        let t = d[1].clamp(-1.0, 1.0).acos() / PI;
        let (x, y) = (s * self.width as f64 - 0.5, (t * self.height as f64 - 0.5).clamp(0.0, self.height as f64 - 1.0));
        let (left, top) = (x.floor(), y.floor());
        let column = |step: f64| (left + step).rem_euclid(self.width as f64) as usize;
        let row = |step: usize| (top as usize + step).min(self.height - 1);
        let (u, v) = (x - left, y - top);
        let corners = [
            (column(0.0), row(0), (1.0 - u) * (1.0 - v)),
            (column(1.0), row(0), u * (1.0 - v)),
            (column(0.0), row(1), (1.0 - u) * v),
            (column(1.0), row(1), u * v),
        ];
        let mut sum = [0.0; 3];
        for (column, row, weight) in corners {
            let texel = self.texel(column, row);
            sum.iter_mut().zip(texel).for_each(|(sum, channel)| *sum += weight * f64::from(channel));
        }
        sum
    }

    /// A level of half of the size, if both sides can be halved.
    fn halved(&self) -> Option<Self> {
        if !self.width.is_multiple_of(2) || !self.height.is_multiple_of(2) || self.height < 4 {
            return None;
        }
        let (width, height) = (self.width / 2, self.height / 2);
        let mut texels = Vec::with_capacity(width * height);
        for row in 0..height {
            let [upper, lower] = [self.share(2 * row), self.share(2 * row + 1)];
            let weights = [upper, lower].map(|share| (share / (2.0 * (upper + lower))) as f32);
            for column in 0..width {
                let mut mean = [0.0_f32; 3];
                for (step, weight) in weights.into_iter().enumerate() {
                    for side in 0..2 {
                        let texel = self.texel(2 * column + side, 2 * row + step);
                        mean.iter_mut().zip(texel).for_each(|(mean, channel)| *mean += weight * channel);
                    }
                }
                texels.push(mean);
            }
        }
        Some(Self { width, height, texels })
    }
}

impl Panorama {
    /// Whether a picture of this width and height is a panorama.
    ///
    /// # Errors
    /// It is not twice as wide as high.
    pub fn check(width: u32, height: u32) -> Result<(), String> {
        if height < 2 || u64::from(width) != 2 * u64::from(height) {
            return Err(format!("it is {width} by {height}, and a panorama is twice as wide as high"));
        }
        Ok(())
    }

    /// The panorama of a picture.
    ///
    /// # Errors
    /// It is not twice as wide as high.
    pub fn new(image: &Image) -> Result<Self, String> {
        Self::check(image.width, image.height)?;
        let (width, height) = (image.width as usize, image.height as usize);
        let mut n_limited = 0;
        let limited = |value: f32| if value > 0.0 { value.min(MOST) } else { 0.0 };
        let texel = |[r, g, b, _]: &[f32; 4]| {
            let texel = [*r, *g, *b].map(limited);
            n_limited += usize::from(texel != [*r, *g, *b]);
            texel
        };
        let mut levels = vec![Level { width, height, texels: image.pixels.iter().map(texel).collect() }];
        while let Some(next) = levels.last().and_then(Level::halved) {
            levels.push(next);
        }
        Ok(Self { levels, n_limited })
    }

    /// The mean radiance about a direction, over about this angle in radians; 0 for the panorama itself.
    pub(super) fn radiance(&self, d: V, angle: f64) -> V {
        let Some(first) = self.levels.first() else { return [0.0; 3] };
        let last = self.levels.len() - 1;
        let level = (angle * first.height as f64 / PI).log2().clamp(0.0, last as f64);
        let at = |level: usize| self.levels.get(level.min(last)).map_or([0.0; 3], |level| level.radiance(d));
        let (low, t) = (level.floor() as usize, level.fract());
        if t == 0.0 {
            return at(low);
        }
        let (fine, coarse) = (at(low), at(low + 1));
        std::array::from_fn(|k| (1.0 - t) * fine[k] + t * coarse[k])
    }

    /// Directions, their solid angles and their radiance, which cover everything: those of the finest level of at most this height.
    pub(super) fn parts(&self, height: usize) -> impl Iterator<Item = (V, f64, V)> + '_ {
        let level = self.levels.iter().find(|level| level.height <= height).or(self.levels.last());
        level.into_iter().flat_map(|level| {
            (0..level.height * level.width).map(|index| {
                let (column, row) = (index % level.width, index / level.width);
                let place = |at: usize, of: usize| (at as f64 + 0.5) / of as f64;
                let d = direction(place(column, level.width), place(row, level.height));
                (d, TAU * level.share(row), level.texel(column, row).map(f64::from))
            })
        })
    }

    /// The mean of all radiance over the three channels.
    pub(super) fn mean(&self) -> f64 {
        let sum: f64 = self.parts(256).map(|(_, solid, radiance)| solid * radiance.iter().sum::<f64>()).sum();
        sum / (3.0 * 2.0 * TAU)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panorama_keeps_its_light() {
        let (width, height) = (64_u32, 32_u32);
        let pixels =
            (0..width * height).map(|k| [(k % 7) as f32, (k / 64) as f32, if k == 70 { f32::NAN } else { 2.0 }, 1.0]);
        let panorama = Panorama::new(&Image { width, height, pixels: pixels.collect() }).expect("twice as wide");
        assert_eq!(panorama.n_limited, 1);
        let total = |height: usize| -> (f64, f64) {
            panorama.parts(height).fold((0.0, 0.0), |(all, light), (_, solid, l)| (all + solid, light + solid * l[0]))
        };
        let (fine, coarse) = (total(32), total(2));
        assert!((fine.0 - 2.0 * TAU).abs() < 1e-12 && (coarse.0 - fine.0).abs() < 1e-12);
        assert!((fine.1 - coarse.1).abs() < 1e-5 * fine.1, "{fine:?} {coarse:?}");
        // A place's direction leads back to its texel.
        let level = &panorama.levels[0];
        for (column, row) in [(0, 3), (63, 16), (17, 31), (32, 0)] {
            let d = direction((f64::from(column) + 0.5) / 64.0, (f64::from(row) + 0.5) / 32.0);
            let wanted = level.texel(column as usize, row as usize).map(f64::from);
            let found = panorama.radiance(d, 0.0);
            assert!((0..3).all(|k| (found[k] - wanted[k]).abs() < 1e-9), "{found:?} {wanted:?}");
        }
        let narrow = Image { width: 3, height: 3, pixels: vec![[0.0; 4]; 9] };
        assert!(Panorama::new(&narrow).is_err());
    }
}
