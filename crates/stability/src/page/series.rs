//! [`Series`]: drawings of a scene with other inputs, and the pictures of some of them.
//!
//! *In:* the points of a sweep, or the two ends of a search. *Out:* the points with pictures, which are drawn again.
//! *Holds:* at most [`MOST_PICTURES`] points have pictures; the worst one and the soundest one are among them. A large picture
//! is made smaller: of several pixels the one with the largest error is kept.

use super::super::sweep::{Parameter, SweepPoint};
use glisten_front::diagnostic::Diagnostic;
use glisten_reference::stability::{ErrorMap, Pair, pictures_of};
use glisten_scene::Scene;
use glisten_scene::picture::Picture;

/// The number of points with pictures, at most.
const MOST_PICTURES: usize = 16;

/// The longest side of a picture.
const LONGEST: u32 = 256;

/// A drawing.
pub struct Point {
    /// The inputs that differ from the scene's own: names and values.
    pub inputs: Vec<(String, String)>,
    /// The value of the only parameter, if there is one.
    pub at: Option<f64>,
    /// The largest finite difference of a channel.
    pub max_abs: f64,
    /// The number of pixels that are not finite in f32.
    pub non_finite_pixels: u64,
    /// The pictures.
    pub(super) pictures: Option<Pair>,
}

/// Drawings in order.
pub struct Series {
    /// All of them.
    pub points: Vec<Point>,
    /// The one that was examined.
    pub worst: usize,
    /// The one with the least error.
    pub soundest: usize,
    /// The number of pictures that were drawn to find the worst.
    pub drawings: usize,
    /// The title of the one with the least error.
    pub(super) sound_name: &'static str,
}

impl Series {
    /// The points of a sweep over these parameters.
    ///
    /// # Errors
    /// The errors of drawing.
    pub fn of_sweep(
        scene: &Scene,
        parameters: &[Parameter],
        points: &[SweepPoint],
        worst: &SweepPoint,
    ) -> Result<Self, Vec<Diagnostic>> {
        let position = points.iter().position(|point| point.values == worst.values).unwrap_or(0);
        let soundest = (0..points.len()).reduce(|best, at| {
            let is_worse = points.get(best).zip(points.get(at)).is_some_and(|(best, it)| best.is_worse_than(it));
            if is_worse { at } else { best }
        });
        let (soundest, drawings) = (soundest.unwrap_or(0), points.len());
        let shown = chosen(points.len(), [position, soundest]);
        let drawn = points.iter().enumerate().map(|(at, point)| {
            let mut changed = scene.clone();
            let mut inputs = Vec::new();
            for parameter in parameters {
                let Some(value) = point.values.get(parameter.name()) else { continue };
                parameter.set(&mut changed, *value);
                inputs.push((parameter.name().to_owned(), super::words::value(*value)));
            }
            let at_value = point.values.values().next().copied().filter(|_| parameters.len() == 1);
            let pictures = if shown.contains(&at) { Some(shrunk(pictures_of(&changed)?)) } else { None };
            let (max_abs, non_finite_pixels) = (point.max_abs, point.non_finite_pixels);
            Ok(Point { inputs, at: at_value, max_abs, non_finite_pixels, pictures })
        });
        Ok(Self {
            points: drawn.collect::<Result<_, Vec<Diagnostic>>>()?,
            worst: position,
            soundest,
            drawings,
            sound_name: "The soundest",
        })
    }

    /// A scene as it is, and the worst one that a search found, with the inputs that differ.
    ///
    /// # Errors
    /// The errors of drawing.
    pub fn of_search(
        own: &Scene,
        worst: &Scene,
        changed: Vec<(String, String)>,
        drawings: usize,
    ) -> Result<Self, Vec<Diagnostic>> {
        let point = |scene: &Scene, inputs: Vec<(String, String)>| -> Result<Point, Vec<Diagnostic>> {
            let pair = pictures_of(scene)?;
            let max_abs = pair.errors.worst().map_or(0.0, |(_, error)| error);
            let non_finite_pixels = pair.errors.not_finite();
            Ok(Point { inputs, at: None, max_abs, non_finite_pixels, pictures: Some(shrunk(pair)) })
        };
        let mut points = vec![point(own, Vec::new())?];
        if !changed.is_empty() {
            points.push(point(worst, changed)?);
        }
        Ok(Self { worst: points.len() - 1, points, soundest: 0, drawings, sound_name: "The scene\u{2019}s own inputs" })
    }
}

/// The points of `count` that have pictures: evenly spaced, and these two.
fn chosen(count: usize, always: [usize; 2]) -> Vec<usize> {
    if count <= MOST_PICTURES {
        return (0..count).collect();
    }
    let even = MOST_PICTURES - always.len();
    let mut shown: Vec<usize> = (0..even).map(|step| step * (count - 1) / (even - 1)).chain(always).collect();
    shown.sort_unstable();
    shown.dedup();
    shown
}

/// Pictures of [`LONGEST`] pixels at most.
fn shrunk(pair: Pair) -> Pair {
    let (width, height) = (pair.exact.width, pair.exact.height);
    let step = width.max(height).div_ceil(LONGEST).max(1);
    if step == 1 {
        return pair;
    }
    let (columns, rows) = (width.div_ceil(step), height.div_ceil(step));
    let error = |at: &usize| pair.errors.errors.get(*at).copied().unwrap_or(0.0);
    let worst_of = |column: u32, row: u32| {
        let xs = column * step..((column + 1) * step).min(width);
        let ys = row * step..((row + 1) * step).min(height);
        let all = ys.flat_map(|y| xs.clone().map(move |x| y as usize * width as usize + x as usize));
        all.reduce(|worst, at| if error(&at) > error(&worst) { at } else { worst }).unwrap_or(0)
    };
    let kept: Vec<usize> = (0..rows)
        .flat_map(|row| (0..columns).map(move |column| (column, row)))
        .map(|(column, row)| worst_of(column, row))
        .collect();
    let picture = |picture: &Picture| {
        let colors = picture.attachments.first().map_or(&[][..], Vec::as_slice);
        let colors = kept.iter().map(|at| colors.get(*at).copied().unwrap_or_default());
        Picture::of_colors(columns, rows, colors.collect())
    };
    let errors = ErrorMap {
        width: columns,
        errors: kept.iter().map(error).collect(),
        counted: kept.iter().map(|at| pair.errors.counted.get(*at).copied().unwrap_or(false)).collect(),
    };
    Pair { single: picture(&pair.single), exact: picture(&pair.exact), errors }
}

#[cfg(test)]
mod tests {
    use super::{ErrorMap, MOST_PICTURES, Pair, Picture, chosen, shrunk};

    #[test]
    fn the_ends_and_the_two_that_matter_have_pictures() {
        assert_eq!(chosen(3, [0, 2]), [0, 1, 2]);
        for (count, always) in [(17, [3, 9]), (4096, [1, 4094]), (100, [0, 99])] {
            let shown = chosen(count, always);
            assert!(shown.len() <= MOST_PICTURES && shown.is_sorted(), "{shown:?}");
            assert!([always[0], always[1], 0, count - 1].iter().all(|at| shown.contains(at)), "{shown:?}");
        }
    }

    #[test]
    fn a_small_picture_of_a_large_one_keeps_the_worst_pixel() {
        let (width, height) = (600, 3);
        let mut errors = vec![0.0; width * height];
        errors[width + 4] = 0.5;
        let colors = (0..width * height).map(|at| [at as f64; 4]).collect();
        let picture = Picture::of_colors(width as u32, height as u32, colors);
        let errors = ErrorMap { width: width as u32, errors, counted: vec![true; width * height] };
        let small = shrunk(Pair { single: picture.clone(), exact: picture, errors });
        assert_eq!((small.exact.width, small.exact.height, small.errors.width), (200, 1, 200));
        assert_eq!((small.errors.errors[1], small.single.attachments[0][1][0]), (0.5, (width + 4) as f64));
    }
}
