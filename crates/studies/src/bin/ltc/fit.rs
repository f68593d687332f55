//! The tables of linearly transformed cosines: for each angle of the eye and each roughness, the matrix that makes a cosine look most like
//! the reflection (Heitz et al. 2016, section 3).
//!
//! *In:* the place in the table. *Out:* an [`Entry`]. *Holds:* an entry depends on nothing but its place, so that one can be fitted again
//! alone.

use super::ggx::{Ggx, Sample, V, dot, scale, spread, unit};
use std::f64::consts::{PI, TAU};

/// The number of angles and of roughnesses.
pub(crate) const SIZE: u32 = 32;

/// The number of directions that an entry is fitted to, and as many of the fitted cosine.
const SAMPLES: u32 = 1024;

/// The smallest width: the row of a roughness of 0.
const SHARPEST: f64 = 1e-4;

/// A texel of both tables.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Entry {
    /// The numbers of the inverse matrix that are not 0 or 1, divided by the one in its middle: the first row, then the last.
    pub(crate) matrix: [f64; 4],
    /// The light that a white mirror reflects of white surroundings, and the part of that which Schlick's term keeps for F_0 = 0.
    pub(crate) albedo: [f64; 2],
}

/// The entry for a column and a row.
pub(crate) fn entry(column: u32, row: u32) -> Entry {
    let (x, y) = (f64::from(column) / f64::from(SIZE - 1), f64::from(row) / f64::from(SIZE - 1));
    // At the horizon itself, nothing is reflected.
    let ggx = Ggx::new((1.0 - x * x).max(1e-3), (y * y).max(SHARPEST));
    let samples: Vec<Sample> = (0..SAMPLES).map(|index| ggx.sample(spread(index))).collect();
    // The albedo's columns are denser towards the horizon.
    let seen = Ggx::new((x * x).max(1e-6), ggx.alpha);
    let many = (0..16 * SAMPLES).map(|index| seen.sample(spread(index)));
    let albedo = many.fold([0.0; 2], |[all, grazing], sample| {
        let weight = sample.weight / f64::from(16 * SAMPLES);
        [all + weight, grazing + weight * (1.0 - sample.half).max(0.0).powi(5)]
    });
    let mean = |value: &dyn Fn(&Sample) -> f64| samples.iter().map(value).sum::<f64>() / f64::from(SAMPLES);
    let all = mean(&|sample| sample.weight);
    let axis = unit([mean(&|s| s.weight * s.light[0]), 0.0, mean(&|s| s.weight * s.light[2])]);
    let axis = if column == 0 { [0.0, 0.0, 1.0] } else { axis };
    let error = |shape: V| Cosine::new(axis, shape).error(ggx, all, &samples);
    let shape = if column == 0 {
        // The same along both axes.
        let best = least(|[a, _, _]| error([a, a, 0.0]), [ggx.alpha.ln(), 0.0, 0.0]);
        [best[0], best[0], 0.0]
    } else {
        let starts = [1.0, ggx.eye[2]].map(|narrow| [(ggx.alpha * narrow).ln(), ggx.alpha.ln(), 0.0]);
        let found = starts.map(|start| least(error, start));
        if error(found[0]) <= error(found[1]) { found[0] } else { found[1] }
    };
    Entry { matrix: Cosine::new(axis, shape).inverse(), albedo }
}

/// A cosine under a matrix: the columns of the matrix, in the plane of the eye and across it.
struct Cosine {
    x: V,
    y: f64,
    z: V,
}

impl Cosine {
    /// The logarithms of the widths in the plane of the eye and across it, and the skew by the first.
    fn new(axis: V, [along, across, skew]: V) -> Self {
        let (along, across) = (along.exp(), across.exp());
        let side = [axis[2], 0.0, -axis[0]];
        let z = [axis[0] + skew * along * side[0], 0.0, axis[2] + skew * along * side[2]];
        Self { x: scale(along, side), y: across, z }
    }

    fn determinant(&self) -> f64 {
        self.x[0] * self.z[2] - self.z[0] * self.x[2]
    }

    /// The numbers of the inverse, times `y`.
    fn inverse(&self) -> [f64; 4] {
        let by = self.y / self.determinant();
        [self.z[2] * by, -self.z[0] * by, -self.x[2] * by, self.x[0] * by]
    }

    /// The density at a direction.
    fn density(&self, light: V) -> f64 {
        let [a, b, c, d] = self.inverse();
        let plain = [a * light[0] + b * light[2], light[1], c * light[0] + d * light[2]].map(|part| part / self.y);
        let square = dot(plain, plain);
        // The Jacobian is the determinant of the inverse over the cube of the length.
        let inverse = 1.0 / (self.determinant() * self.y).abs();
        plain[2].max(0.0) / PI * inverse / (square * square)
    }

    fn sample(&self, [s, t]: [f64; 2]) -> V {
        let (radius, angle) = (s.sqrt(), TAU * t);
        let (a, b, c) = (radius * angle.cos(), radius * angle.sin(), (1.0 - s).max(0.0).sqrt());
        unit([a * self.x[0] + c * self.z[0], b * self.y, a * self.x[2] + c * self.z[2]])
    }

    /// The cube of the difference to the reflection, over the directions of both.
    fn error(&self, ggx: Ggx, all: f64, samples: &[Sample]) -> f64 {
        let off = |light: V| {
            let ([value, ours], theirs) = (ggx.eval(light), self.density(light));
            let sum = ours + theirs;
            if sum > 0.0 { (value - all * theirs).abs().powi(3) / sum } else { 0.0 }
        };
        let first: f64 = samples.iter().filter(|sample| sample.weight > 0.0).map(|sample| off(sample.light)).sum();
        let second: f64 = (0..SAMPLES).map(|index| off(self.sample(spread(index)))).sum();
        first + second
    }
}

/// The place of a least value, by the simplex of Nelder and Mead.
fn least(value: impl Fn(V) -> f64, start: V) -> V {
    let mut corners: Vec<(f64, V)> = vec![(value(start), start)];
    for axis in 0..3 {
        let mut corner = start;
        corner[axis] += 0.2;
        corners.push((value(corner), corner));
    }
    let along =
        |from: V, to: V, by: f64| -> V { std::array::from_fn(|axis| from[axis] + by * (to[axis] - from[axis])) };
    for _ in 0..120 {
        corners.sort_by(|a, b| a.0.total_cmp(&b.0));
        if corners[3].0 - corners[0].0 <= 1e-7 * corners[0].0 {
            break;
        }
        let middle: V = std::array::from_fn(|axis| corners[..3].iter().map(|corner| corner.1[axis]).sum::<f64>() / 3.0);
        let worst = corners[3].1;
        let try_at = |by: f64| {
            let place = along(middle, worst, by);
            (value(place), place)
        };
        let mirrored = try_at(-1.0);
        let next = match mirrored.0 {
            found if found < corners[0].0 => {
                let far = try_at(-2.0);
                if far.0 < found { far } else { mirrored }
            }
            found if found < corners[2].0 => mirrored,
            found => {
                let near = try_at(if found < corners[3].0 { -0.5 } else { 0.5 });
                if near.0 < found.min(corners[3].0) { near } else { (f64::INFINITY, worst) }
            }
        };
        if next.0.is_finite() {
            corners[3] = next;
        } else {
            let best = corners[0].1;
            for corner in &mut corners[1..] {
                let place = along(best, corner.1, 0.5);
                *corner = (value(place), place);
            }
        }
    }
    corners.sort_by(|a, b| a.0.total_cmp(&b.0));
    corners[0].1
}

/// The text of the tables: a line for each texel, by rows, with five digits of each number.
pub(crate) fn line(entry: &Entry) -> String {
    let digits = |number: &f64| {
        let rounded: f64 = format!("{number:.4e}").parse().unwrap_or(*number);
        if rounded.abs() < 1e-7 { "0".to_owned() } else { rounded.to_string() }
    };
    entry.matrix.iter().chain(&entry.albedo).map(digits).collect::<Vec<_>>().join(" ")
}
