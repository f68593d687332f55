//! [`Tile`]: a picture of the gallery with 8 bits per channel, and the sheet of many of them.
//!
//! *Holds:* colors are clamped to [0, 1], averaged over the samples of a pixel as linear light, encoded for sRGB, and
//! rounded to 8 bits, as in `glisten render` of a scene with `encode = "srgb"`. Non-finite colors are magenta.

use super::entry::supersampling;
use glisten_scene::picture::{Effort, Encoding, NOT_FINITE, Picture, Transfer, png_rgb};
use rayon::prelude::*;

/// The background of the sheet.
const GROUND: [u8; 3] = [24, 25, 30];

/// An RGB picture with 8 bits per channel.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Tile {
    width: u32,
    height: u32,
    /// The pixels, top row first.
    pixels: Vec<[u8; 3]>,
}

impl Tile {
    /// The tile of pixels, `width * height`, top row first.
    pub(super) fn of_bytes(width: u32, height: u32, pixels: Vec<[u8; 3]>) -> Self {
        Self { width, height, pixels }
    }

    /// The first attachment of a supersampled picture, averaged. `by` gives the exposure and the tone curve; the page always shows sRGB.
    pub fn new(picture: &Picture, by: Encoding) -> Self {
        let samples = picture.attachments.first().map(Vec::as_slice).unwrap_or_default();
        let color = |x: u32, y: u32| {
            let sample = samples.get(y as usize * picture.width as usize + x as usize);
            sample.filter(|rgba| rgba.iter().all(|channel| channel.is_finite())).map_or(
                shown(NOT_FINITE),
                |[r, g, b, _]| {
                    let [r, g, b, _] = by.expose([*r, *g, *b, 1.0]);
                    [r, g, b].map(|channel| channel.clamp(0.0, 1.0))
                },
            )
        };
        let n = supersampling();
        box_filter(picture.width / n, picture.height / n, picture.width, picture.height, color)
    }

    /// The tile with `side` pixels along its longer side; each pixel is the mean of the area that it covers.
    fn resized(&self, side: u32) -> Self {
        let color = |x: u32, y: u32| {
            let pixel = self.pixels.get(y as usize * self.width as usize + x as usize);
            shown(pixel.copied().unwrap_or(NOT_FINITE))
        };
        let longer = u64::from(self.width.max(self.height).max(1));
        let scaled = |length: u32| (u64::from(side) * u64::from(length) / longer).clamp(1, u64::from(side)) as u32;
        box_filter(scaled(self.width), scaled(self.height), self.width, self.height, color)
    }

    /// The tile as a PNG file.
    ///
    /// # Errors
    /// The encoder's message.
    pub fn png(&self) -> Result<Vec<u8>, String> {
        png_rgb(self.width, self.height, &self.pixels, Effort::Best).map_err(|error| error.to_string())
    }

    /// The width and height in pixels.
    pub fn size(&self) -> (u32, u32) {
        (self.width, self.height)
    }
}

/// The linear light, in [0, 1], of encoded bytes.
fn shown(pixel: [u8; 3]) -> [f64; 3] {
    pixel.map(|channel| Transfer::Srgb.decode(f64::from(channel) / 255.0))
}

/// Scales a picture down: each pixel is the area-weighted mean of the pixels that it covers.
fn box_filter(
    width: u32,
    height: u32,
    from_width: u32,
    from_height: u32,
    color: impl Fn(u32, u32) -> [f64; 3] + Sync,
) -> Tile {
    let columns = spans(width, from_width);
    let rows = spans(height, from_height);
    let pixel = |row: &[(u32, f64)], column: &[(u32, f64)]| {
        let (mut sum, mut area) = ([0.0; 3], 0.0);
        for (y, high) in row {
            for (x, wide) in column {
                let weight = high * wide;
                area += weight;
                for (total, channel) in sum.iter_mut().zip(color(*x, *y)) {
                    *total += weight * channel;
                }
            }
        }
        sum.map(|total| (255.0 * Transfer::Srgb.encode(total / area)).round() as u8)
    };
    let row = |row: &Vec<(u32, f64)>| columns.iter().map(|column| pixel(row, column)).collect::<Vec<[u8; 3]>>();
    let pixels = rows.par_iter().map(row).collect::<Vec<_>>().concat();
    Tile { width, height, pixels }
}

/// For each of `count` equal parts of a line of `from` units: the units that it covers, and the weight of each.
fn spans(count: u32, from: u32) -> Vec<Vec<(u32, f64)>> {
    let step = f64::from(from) / f64::from(count);
    (0..count)
        .map(|index| {
            let (start, end) = (f64::from(index) * step, f64::from(index + 1) * step);
            let last = (end.ceil() as u32).min(from);
            (start as u32..last)
                .map(|unit| (unit, end.min(f64::from(unit + 1)) - start.max(f64::from(unit))))
                .filter(|(_, length)| *length > 1e-9)
                .collect()
        })
        .collect()
}

/// All tiles on one sheet with `columns` columns, each in the middle of a square of `side` pixels, `gap` apart.
pub fn contact_sheet(tiles: &[&Tile], columns: u32, side: u32, gap: u32) -> Tile {
    let columns = columns.max(1);
    let rows = (tiles.len() as u32).div_ceil(columns);
    let (width, height) = (columns * (side + gap) + gap, rows * (side + gap) + gap);
    let mut pixels = vec![GROUND; width as usize * height as usize];
    for (index, tile) in tiles.iter().enumerate() {
        let index = index as u32;
        let (left, top) = (gap + index % columns * (side + gap), gap + index / columns * (side + gap));
        let small = tile.resized(side);
        let (left, top) = (left + (side - small.width) / 2, top + (side - small.height) / 2);
        for (row, line) in (top..).zip(small.pixels.chunks(small.width.max(1) as usize)) {
            let start = row as usize * width as usize + left as usize;
            if let Some(place) = pixels.get_mut(start..start + line.len()) {
                place.copy_from_slice(line);
            }
        }
    }
    Tile { width, height, pixels }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glisten_scene::picture::Image;

    #[test]
    fn samples_are_clamped_and_averaged() {
        let row = [[9.0, 0.0, 0.5, 1.0], [0.0, -1.0, 0.5, 1.0]];
        let tile = Tile::new(&Picture::of_colors(2, 2, [row, row].concat()), Encoding::default());
        assert_eq!((tile.size(), tile.pixels.as_slice()), ((1, 1), &[[188, 0, 188]][..]));
    }

    #[test]
    fn what_is_not_finite_is_seen() {
        let tile = Tile::new(&Picture::of_colors(2, 2, vec![[f64::NAN, 0.0, 0.0, 1.0]; 4]), Encoding::default());
        assert_eq!(tile.pixels, [[255, 0, 255]]);
    }

    #[test]
    fn parts_of_a_line_cover_it_once() {
        for (count, from) in [(3, 7), (96, 320), (5, 5), (2, 640)] {
            let parts = spans(count, from);
            let mut covered = vec![0.0; from as usize];
            for (unit, length) in parts.iter().flatten() {
                covered[*unit as usize] += length;
            }
            assert!(covered.iter().all(|length: &f64| (length - 1.0).abs() < 1e-9), "{count} of {from}");
        }
    }

    #[test]
    fn a_sheet_has_every_tile_in_its_place() {
        let colors = [[1, 2, 3], [4, 5, 6], [7, 8, 9]];
        let tiles: Vec<Tile> =
            colors.iter().map(|color| Tile { width: 4, height: 4, pixels: vec![*color; 16] }).collect();
        let sheet = contact_sheet(&tiles.iter().collect::<Vec<_>>(), 2, 2, 1);
        assert_eq!(sheet.size(), (7, 7));
        let at = |x: usize, y: usize| sheet.pixels[y * 7 + x];
        assert_eq!(
            [at(1, 1), at(4, 2), at(2, 5), at(5, 5), at(0, 0)],
            [colors[0], colors[1], colors[2], GROUND, GROUND]
        );
    }

    #[test]
    fn a_sheet_keeps_the_shape_of_a_tile() {
        let wide = Tile { width: 8, height: 4, pixels: vec![[1, 2, 3]; 32] };
        let sheet = contact_sheet(&[&wide], 1, 4, 1);
        let row = |y: usize| sheet.pixels[y * 6 + 1];
        assert_eq!([row(1), row(2), row(3), row(4)], [GROUND, [1, 2, 3], [1, 2, 3], GROUND]);
    }

    #[test]
    fn a_tile_is_a_png() {
        let tile = Tile { width: 2, height: 1, pixels: vec![[1, 2, 3], [250, 0, 9]] };
        let read = Image::read(&tile.png().expect("it encodes"), 9, 9).expect("a PNG");
        let bytes: Vec<f32> = read.pixels.iter().flatten().map(|value| (value * 255.0).round()).collect();
        assert_eq!(bytes, [1.0, 2.0, 3.0, 255.0, 250.0, 0.0, 9.0, 255.0]);
    }
}
