//! Means that the authors' code found for pictures that are made by formulas.
//!
//! A program of `nv-flip` 0.1.2, which wraps their code in C++, painted the same pairs in 8 bits, called `flip` with
//! `DEFAULT_PIXELS_PER_DEGREE`, and took the mean of the map of errors in f64. (The mean of its pool adds up in f32, and is up to
//! 8e-6 off.) The program is not kept, so that no build needs a compiler of C++.

use super::flip;
use crate::picture::Picture;
use crate::random::mixed;

/// A color of 8 bits at a pixel.
type Paint = fn(u64, u64) -> [u8; 3];

/// A name, a size, two pictures, and the mean error by the authors' code.
type Pair = (&'static str, [u32; 2], Paint, Paint, f64);

/// How far from theirs a mean may be; the largest distance found is 8.5e-6. Both compute in f32: where pictures are flat, the
/// derivatives are not quite 0, and the feature difference is the root of that. The same in f64 is up to 4.3e-5 from both.
const TOLERANCE: f64 = 2e-5;

const PAIRS: &[Pair] = &[
    ("noise", [64, 64], |x, y| noise(x, y, 1), |x, y| noise(x, y, 2), 0.455_724_560),
    (
        "small noise on a gradient",
        [96, 80],
        ramp,
        |x, y| ramp(x, y).map(|value| value ^ noise(x, y, 3)[0] & 1),
        0.031_444_657,
    ),
    ("a brighter gradient", [96, 64], |x, _| gray(2 * x), |x, _| gray(2 * x + 20), 0.278_466_937),
    (
        "an edge, moved",
        [64, 48],
        |x, _| gray(if x < 30 { 40 } else { 200 }),
        |x, _| gray(if x < 32 { 40 } else { 200 }),
        0.061_394_658,
    ),
    (
        "an edge in color",
        [48, 64],
        |x, y| if x < y { [220, 30, 40] } else { [20, 60, 210] },
        |x, y| if x < y { [200, 50, 40] } else { [20, 90, 210] },
        0.302_410_442,
    ),
    ("one pixel", [33, 33], |_, _| gray(128), |x, y| gray(if (x, y) == (16, 16) { 255 } else { 128 }), 0.003_950_310),
    (
        "a corner pixel by one step",
        [33, 33],
        ramp,
        |x, y| if (x, y) == (0, 0) { [1, 255, 0] } else { ramp(x, y) },
        0.000_014_500,
    ),
    ("equal", [40, 30], |x, y| noise(x, y, 4), |x, y| noise(x, y, 4), 0.0),
    ("black against white", [32, 32], |_, _| gray(0), |_, _| gray(255), 0.967_391_849),
    ("green against blue", [20, 20], |_, _| [0, 255, 0], |_, _| [0, 0, 255], 1.0),
    ("1x1", [1, 1], |_, _| [10, 200, 90], |_, _| [60, 180, 30], 0.432_134_628),
    ("3x1", [3, 1], |x, _| gray(100 * x), |x, _| gray(90 * x + 5), 0.222_952_863),
    ("7x200", [7, 200], |x, y| noise(x / 2, y / 5, 5), |x, y| noise(x / 2, y / 6, 5), 0.747_647_554),
    ("200x7", [200, 7], ramp, |x, y| ramp(x, 3 * y), 0.145_687_720),
    (
        "lines and points on black",
        [61, 59],
        |x, y| gray(if x % 12 == 0 || (x * y) % 37 == 5 { 255 } else { 0 }),
        |x, y| gray(if x % 12 == 1 || (x * y) % 37 == 6 { 255 } else { 0 }),
        0.536_381_927,
    ),
];

fn gray(value: u64) -> [u8; 3] {
    [value.min(255) as u8; 3]
}

fn noise(x: u64, y: u64, seed: u64) -> [u8; 3] {
    let bits = mixed(1 + x + 1000 * y + 1_000_000 * seed).to_le_bytes();
    [bits[0], bits[1], bits[2]]
}

fn ramp(x: u64, y: u64) -> [u8; 3] {
    [2 * x, 255_u64.saturating_sub(2 * x), 3 * y].map(|value| value.min(255) as u8)
}

fn picture([width, height]: [u32; 2], paint: Paint) -> Picture {
    let places = (0..height).flat_map(|y| (0..width).map(move |x| (u64::from(x), u64::from(y))));
    let color = |[red, green, blue]: [u8; 3]| [red, green, blue, 255].map(|byte| f64::from(byte) / 255.0);
    Picture::of_colors(width, height, places.map(|(x, y)| color(paint(x, y))).collect())
}

#[test]
fn means_are_those_of_the_authors_code() {
    for (name, size, reference, test, mean) in PAIRS {
        let found = flip(&picture(*size, *reference), &picture(*size, *test));
        assert!((found - mean).abs() <= TOLERANCE, "{name}: {found}, not {mean}");
    }
}

#[test]
fn sizes_may_be_anything() {
    let of = |size| picture(size, |x, y| noise(x, y, 1));
    assert_eq!(flip(&of([0, 5]), &of([0, 5])), 0.0);
    assert_eq!(flip(&of([3, 2]), &of([2, 3])), 1.0);
    let none = Picture { attachments: Vec::new(), ..of([2, 2]) };
    assert_eq!([flip(&none, &none), flip(&none, &of([2, 2]))], [0.0, 1.0]);
}

#[test]
fn numbers_that_are_none_are_black() {
    let of = |value| Picture::of_colors(2, 1, vec![[value; 4], [0.5; 4]]);
    assert_eq!(flip(&of(f64::NAN), &of(-1.0)), 0.0);
    assert_eq!(flip(&of(f64::INFINITY), &of(1.0)), 0.0);
}
