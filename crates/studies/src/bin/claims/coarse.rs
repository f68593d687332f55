//! Is a table coarser? Errors, the number of shades, and the jumps that the eye sees as Mach bands.

use super::scenes::{Ball, By, Highlight, Place, errors, picture, scene};
use glisten::Picture;
use std::fmt::Write;

const BALL: Ball = Ball { size: 512, segments: 512 };
const TEXELS: [u32; 4] = [16, 64, 256, 1024];

/// The row of the picture that runs through the brightest pixel.
fn row(picture: &Picture, like: &Picture) -> Vec<f64> {
    let width = like.width as usize;
    let brightest = like.attachments.iter().flatten().enumerate().max_by(|a, b| a.1[0].total_cmp(&b.1[0]));
    let start = brightest.map_or(0, |(place, _)| place / width * width);
    let colors = picture.attachments.first().and_then(|colors| colors.get(start..start + width)).unwrap_or(&[]);
    let covered = picture.covered.get(start..start + width).unwrap_or(&[]);
    colors.iter().zip(covered).filter(|(_, covered)| **covered).map(|(color, _)| color[0]).collect()
}

/// The largest jump of a slope along a row: the second difference beyond that of the truth.
fn bands(row: &[f64], truth: &[f64]) -> f64 {
    let second = |values: &[f64], place: usize| values[place + 1] - 2.0 * values[place] + values[place - 1];
    let last = row.len().min(truth.len()).saturating_sub(1);
    (1..last).map(|place| (second(row, place) - second(truth, place)).abs()).fold(0.0, f64::max)
}

/// The number of shades of at least a thousandth, without repetitions.
fn shades(row: &[f64]) -> usize {
    let mut values: Vec<u64> = row.iter().filter(|value| **value >= 1e-3).map(|value| value.to_bits()).collect();
    values.sort_unstable();
    values.dedup();
    values.len()
}

/// The table.
pub(crate) fn table() -> Result<String, String> {
    let mut text = String::from(
        "| k | highlight at the fragments | largest error | RMSE | shades in a row | largest jump of the slope |\n\
         | --- | --- | --- | --- | --- | --- |",
    );
    for exponent in [4, 32] {
        let computed = Highlight::new(Place::Fragments, By::Squaring, exponent);
        let truth = picture(&scene(computed, BALL)?)?;
        let true_row = row(&truth, &truth);
        let _ = write!(text, "\n| {exponent} | computed | 0 | 0 | {} | 0 |", shades(&true_row));
        for linear in [false, true] {
            for texels in TEXELS {
                let way = Highlight::new(Place::Fragments, By::Table(texels, linear), exponent);
                let drawn = picture(&scene(way, BALL)?)?;
                let (largest, rmse) = errors(&drawn, &truth);
                let own = row(&drawn, &truth);
                let filter = if linear { "linear" } else { "nearest" };
                let _ = write!(
                    text,
                    "\n| {exponent} | {texels} texels, {filter} | {largest:.1e} | {rmse:.1e} | {} | {:.1e} |",
                    shades(&own),
                    bands(&own, &true_row)
                );
            }
        }
    }
    Ok(text)
}
