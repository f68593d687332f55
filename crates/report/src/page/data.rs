//! The data that the page's script reads: the report as in `report.json`, and what only the page needs.
//!
//! *In:* a report and its album. *Out:* JSON that may be embedded in HTML. *Holds:* no text of it ends the element that it is
//! in. Programs are listed once each, however many variants have them.

use super::super::front::{is_faster, unfit};
use super::super::model::{Report, Way};
use super::album::Album;
use super::differences::Scale;
use serde::Serialize;

/// Everything.
#[derive(Serialize)]
struct Data<'a> {
    report: &'a Report,
    page: Page,
}

/// The part that only the page needs.
#[derive(Serialize)]
struct Page {
    /// The colors of the codes of differences; code 1 is the low decade, the last before 255 the high one.
    palette: Vec<String>,
    coded: [i32; 2],
    seen: [i32; 2],
    /// By how much the pictures on the page are smaller than they were drawn.
    factor: u32,
    models: Vec<Model>,
    ways: Vec<OnPage>,
    /// Texts of shaders.
    texts: Vec<String>,
}

#[derive(Serialize)]
struct Model {
    picture: usize,
    bands: usize,
    bound: f64,
    row: usize,
    profile: Vec<Option<f64>>,
}

/// A variant on the page.
#[derive(Serialize)]
struct OnPage {
    title: String,
    /// The number of the model; null in a report that was ended before its reference was drawn.
    model: Option<usize>,
    picture: usize,
    difference: usize,
    bands: usize,
    profile: Vec<Option<f64>>,
    /// On no front, because its figures leave out what is wrong with it.
    unfit: bool,
    /// The variants of the model that clearly take more time.
    faster_than: Vec<usize>,
    /// Names of shaders, and the numbers of their texts.
    programs: Vec<(String, usize)>,
}

/// The JSON for a page.
pub(super) fn data(report: &Report, album: &Album, scale: Scale) -> String {
    let truths = album.truths.iter();
    let models = truths
        .map(|truth| Model {
            picture: truth.picture,
            bands: truth.bands,
            bound: truth.bound,
            row: truth.row,
            profile: truth.profile.clone(),
        })
        .collect();
    let mut texts = Vec::new();
    let ways = ways(report, album, &mut texts);
    let page = Page {
        palette: scale.palette(),
        coded: scale.coded(),
        seen: scale.seen(),
        factor: album.factor,
        models,
        ways,
        texts,
    };
    // Numbers, texts and lists only: serialization has nothing to reject.
    let json = serde_json::to_string(&Data { report, page }).unwrap_or_default();
    // Within strings, the only place where these are, JSON reads both alike.
    json.replace('<', "\\u003c").replace('>', "\\u003e").replace('&', "\\u0026")
}

fn ways(report: &Report, album: &Album, texts: &mut Vec<String>) -> Vec<OnPage> {
    let unfit = unfit(&report.ways, &report.truths);
    let all = report.ways.iter().zip(&album.ways).zip(unfit);
    all.map(|((way, pictures), unfit)| OnPage {
        title: way.title(),
        model: report.truths.iter().position(|truth| truth.model == way.model),
        picture: pictures.picture,
        difference: pictures.difference,
        bands: pictures.bands,
        profile: pictures.profile.clone(),
        unfit,
        faster_than: faster_than(report, way),
        programs: programs(way, texts),
    })
    .collect()
}

fn faster_than(report: &Report, way: &Way) -> Vec<usize> {
    let slower = |other: &Way| {
        let is_other = !std::ptr::eq(other, way) && other.model == way.model;
        is_other && is_faster(&way.times, &other.times, report.timing.margin)
    };
    report.ways.iter().enumerate().filter(|(_, other)| slower(other)).map(|(number, _)| number).collect()
}

fn programs(way: &Way, texts: &mut Vec<String>) -> Vec<(String, usize)> {
    let shaders = way.files("program").shaders;
    shaders
        .into_iter()
        .map(|(name, text)| {
            let known = texts.iter().position(|known| *known == text);
            let number = known.unwrap_or_else(|| {
                texts.push(text);
                texts.len() - 1
            });
            (name, number)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::super::tests::example;
    use super::*;
    use serde_json::Value;

    #[test]
    fn the_data_are_json_that_ends_no_element() {
        let mut report = example();
        report.ways[1].about = "</script><!-- & 'quotes'".into();
        let scale = Scale::of([].into_iter());
        let text = data(&report, &Album::of(&report, scale), scale);
        assert!(!text.contains(['<', '>', '&']));
        let data: Value = serde_json::from_str(&text).expect("it is JSON");
        assert_eq!(data["report"]["ways"][1]["about"], report.ways[1].about);
        assert_eq!(data["report"], serde_json::from_str::<Value>(&report.json()).expect("it is JSON"));
        assert_eq!(data["page"]["ways"].as_array().map(Vec::len), Some(report.ways.len()));
        assert_eq!(data["page"]["ways"][6]["model"], 1);
    }
}
