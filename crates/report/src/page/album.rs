//! [`Album`]: the pictures of a page, each embedded once.
//!
//! *In:* the references and variants of a report. *Out:* PNG data URIs, and which of them each reference and variant has.
//!
//! *Holds:* pictures that are equal in the 8 bits of a screen are one. If all pictures together are too large for a page, they
//! are made smaller by a whole number: colors by their mean, differences and bands by their largest.

use super::super::model::{Report, Way};
use super::bands::{self, Luminance};
use super::differences::Scale;
pub(super) use glisten_page::raster::{colors, data_uri};
use glisten_scene::picture::{Effort, Encoding, Picture};
use std::collections::BTreeMap;

/// The bytes that all pictures of a page may have together.
const MOST_BYTES: usize = 8 << 20;
/// The pixels beyond which no page is tried.
const MOST_PIXELS: u64 = 40_000_000;

/// The pictures of a page.
#[derive(Default)]
pub(super) struct Album {
    /// Data URIs, each once.
    pub(super) uris: Vec<String>,
    /// By how much width and height are reduced.
    pub(super) factor: u32,
    /// Those of the references.
    pub(super) truths: Vec<OfTruth>,
    /// Those of the variants.
    pub(super) ways: Vec<OfWay>,
    known: BTreeMap<String, usize>,
}

/// The pictures of a reference, by their numbers, and its profile.
pub(super) struct OfTruth {
    pub(super) picture: usize,
    pub(super) bands: usize,
    /// The second difference that is shown as black or white.
    pub(super) bound: f64,
    /// The row of the profiles of the model.
    pub(super) row: usize,
    pub(super) profile: Vec<Option<f64>>,
}

/// The pictures of a variant, by their numbers, and its profile.
pub(super) struct OfWay {
    pub(super) picture: usize,
    pub(super) difference: usize,
    pub(super) bands: usize,
    pub(super) profile: Vec<Option<f64>>,
}

/// The second difference of a luminance, and its profile.
type OfLuminance = (Vec<Option<f64>>, Vec<Option<f64>>);

/// The second differences and profiles of a model.
struct Model {
    truth: OfLuminance,
    bound: f64,
    row: usize,
    /// By the number of the variant.
    ways: BTreeMap<usize, OfLuminance>,
}

impl Album {
    /// All pictures of a report, small enough.
    pub(super) fn of(report: &Report, scale: Scale) -> Self {
        let models: Vec<Model> = (0..report.truths.len()).map(|index| model(report, index)).collect();
        let pixels = |factor: u32| {
            let count = 3 * (report.ways.len() + report.truths.len()) as u64;
            report.size.iter().map(|side| u64::from(side.div_ceil(factor))).product::<u64>() * count
        };
        let mut factor = (1..16).find(|factor| pixels(*factor) <= MOST_PIXELS).unwrap_or(16);
        loop {
            let album = Self::reduced(report, scale, &models, factor);
            if factor >= 16 || album.uris.iter().map(String::len).sum::<usize>() <= MOST_BYTES {
                return album;
            }
            factor += 1;
        }
    }

    fn reduced(report: &Report, scale: Scale, models: &[Model], factor: u32) -> Self {
        let mut album = Self { factor, ..Self::default() };
        let size = report.size;
        for (truth, model) in report.truths.iter().zip(models) {
            let picture = album.picture(&truth.picture, report.encode);
            let bands = album.bands(&model.truth.0, size, model.bound);
            let (bound, row, profile) = (model.bound, model.row, model.truth.1.clone());
            album.truths.push(OfTruth { picture, bands, bound, row, profile });
        }
        for (number, way) in report.ways.iter().enumerate() {
            let picture = album.picture(&way.picture, report.encode);
            let difference = album.difference(way, size, scale);
            let of_model = models.iter().find_map(|model| Some((model.ways.get(&number)?, model.bound)));
            let (bands, profile) = match of_model {
                Some(((second, profile), bound)) => (album.bands(second, size, bound), profile.clone()),
                // A report that was ended may lack the reference of a variant.
                None => (picture, Vec::new()),
            };
            album.ways.push(OfWay { picture, difference, bands, profile });
        }
        album
    }

    fn add(&mut self, uri: String) -> usize {
        let next = self.uris.len();
        let index = *self.known.entry(uri.clone()).or_insert(next);
        if index == next {
            self.uris.push(uri);
        }
        index
    }

    fn picture(&mut self, picture: &Picture, by: impl Into<Encoding>) -> usize {
        let picture = smaller(picture, self.factor);
        self.add(data_uri(&colors(&picture, by), picture.width, picture.height, Effort::Best))
    }

    fn difference(&mut self, way: &Way, size: [u32; 2], scale: Scale) -> usize {
        let largest = |block: &[Option<f64>]| block.iter().try_fold(0.0, |most: f64, one| one.map(|one| most.max(one)));
        let (values, size) = reduce(&way.difference, size, self.factor, largest);
        let colors: Vec<[u8; 3]> = values.into_iter().map(|difference| scale.color(difference)).collect();
        self.add(data_uri(&colors, size[0], size[1], Effort::Best))
    }

    fn bands(&mut self, second: &[Option<f64>], size: [u32; 2], bound: f64) -> usize {
        let largest = |block: &[Option<f64>]| {
            let values = block.iter().flatten().copied();
            values.reduce(|most, value| if value.abs() > most.abs() { value } else { most })
        };
        let (values, size) = reduce(second, size, self.factor, largest);
        let colors: Vec<[u8; 3]> = values.into_iter().map(|second| bands::color(second, bound)).collect();
        self.add(data_uri(&colors, size[0], size[1], Effort::Best))
    }
}

fn model(report: &Report, index: usize) -> Model {
    let truth = &report.truths[index];
    let luminance = Luminance::of(&truth.picture);
    let row = luminance.brightest_row();
    let of = |luminance: &Luminance| (luminance.second_difference(), luminance.profile(row));
    let members = report.ways.iter().enumerate().filter(|(_, way)| way.model == truth.model);
    let ways: BTreeMap<usize, _> = members.map(|(number, way)| (number, of(&Luminance::of(&way.picture)))).collect();
    let truth = of(&luminance);
    let all = ways.values().map(|(second, _)| second.as_slice()).chain([truth.0.as_slice()]);
    Model { bound: bands::bound(all), truth, row, ways }
}

/// The first attachment, smaller: each pixel is the mean of a block.
fn smaller(picture: &Picture, factor: u32) -> Picture {
    if factor == 1 {
        return picture.clone();
    }
    let mean = |block: &[[f64; 4]]| {
        let sum = |channel: usize| block.iter().map(|pixel| pixel[channel]).sum::<f64>();
        std::array::from_fn(|channel| sum(channel) / block.len() as f64)
    };
    let pixels = picture.attachments.first().map_or(&[][..], Vec::as_slice);
    let (pixels, [width, height]) = reduce(pixels, [picture.width, picture.height], factor, mean);
    Picture::of_colors(width, height, pixels)
}

/// One value for each block of `factor` by `factor`; blocks at the right and at the bottom may be smaller.
fn reduce<T: Copy>(
    values: &[T],
    [width, height]: [u32; 2],
    factor: u32,
    one: impl Fn(&[T]) -> T,
) -> (Vec<T>, [u32; 2]) {
    if factor == 1 {
        return (values.to_vec(), [width, height]);
    }
    let size = [width.div_ceil(factor), height.div_ceil(factor)];
    let mut result = Vec::new();
    for (y, x) in (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| (y * factor, x * factor))) {
        let rows = y..(y + factor).min(height);
        let block: Vec<T> = rows
            .flat_map(|row| {
                (x..(x + factor).min(width)).map(move |column| (row as usize) * width as usize + column as usize)
            })
            .filter_map(|index| values.get(index).copied())
            .collect();
        if !block.is_empty() {
            result.push(one(&block));
        }
    }
    (result, size)
}

#[cfg(test)]
mod tests {
    use super::super::tests::example;
    use super::*;

    #[test]
    fn a_picture_is_embedded_once() {
        let mut report = example();
        let scale = Scale::of([0.1].into_iter());
        let before = Album::of(&report, scale);
        let twin = report.ways[0].clone();
        report.ways.push(twin);
        let album = Album::of(&report, scale);
        assert_eq!(album.uris.len(), before.uris.len());
        let (first, last) = (&album.ways[0], &album.ways[report.ways.len() - 1]);
        assert_eq!((first.picture, first.difference, first.bands), (last.picture, last.difference, last.bands));
        assert_eq!(album.factor, 1);
    }

    #[test]
    fn blocks_at_the_border_are_smaller() {
        let (sums, size) = reduce(&[1, 2, 3, 4, 5, 6], [3, 2], 2, |block| block.iter().sum());
        assert_eq!((sums, size), (vec![12, 9], [2, 1]));
    }

    #[test]
    fn a_way_without_a_truth_has_pictures() {
        let mut report = example();
        report.truths.clear();
        let album = Album::of(&report, Scale::of([].into_iter()));
        assert_eq!(album.ways.len(), report.ways.len());
        assert!(album.ways.iter().all(|way| way.profile.is_empty() && way.picture < album.uris.len()));
    }
}
