//! The widths of envelopes over the fixtures: none may grow by more than a tenth unnoticed.
//!
//! `widths.txt` has the median width of each scene's envelopes, over the channels with a finite one, and the share of
//! channels without. `UPDATE_WIDTHS=1 cargo test --test it -- widths` writes it again.

use crate::drawing::{from_disk, reference};
use crate::support::root;
use glisten_reference::Precision;
use std::collections::BTreeMap;
use std::fmt::Write;

/// Larger scenes would cost more time than they show.
const MOST_PIXELS: u32 = 20_000;
/// By how much a width, and the number of channels without one, may grow.
const GROWTH: f64 = 1.1;

/// The median of the finite widths, and the share of channels that have none.
fn measured(path: &str) -> Option<(f64, f64)> {
    let scene = from_disk(path);
    if scene.framebuffer.width * scene.framebuffer.height > MOST_PIXELS {
        return None;
    }
    let picture = reference(&scene, Precision::Envelope);
    let intervals = picture.intervals.as_ref()?.first()?;
    let covered = intervals.iter().zip(&picture.covered).filter(|(_, covered)| **covered);
    let widths: Vec<f64> = covered
        .flat_map(|(channels, _)| channels)
        .map(|channel| if channel.may_be_nan { f64::INFINITY } else { channel.width() })
        .collect();
    let mut finite: Vec<f64> = widths.iter().copied().filter(|width| width.is_finite()).collect();
    finite.sort_by(f64::total_cmp);
    // Exact channels say nothing about rounding: the median of the others.
    let rounded = finite.iter().skip_while(|width| **width == 0.0).collect::<Vec<_>>();
    let median = rounded.get(rounded.len() / 2).map_or(0.0, |width| **width);
    let without = (widths.len() - finite.len()) as f64 / widths.len().max(1) as f64;
    Some((median, without))
}

fn all() -> BTreeMap<String, (f64, f64)> {
    let mut found = BTreeMap::new();
    for folder in ["fixtures/scenes", "fixtures/scenes/core"] {
        let entries = std::fs::read_dir(root().join(folder)).expect("the folder of the fixtures");
        let names = entries.filter_map(|entry| entry.ok()?.file_name().into_string().ok());
        for name in names.filter(|name| name.ends_with(".toml")) {
            let path = format!("{folder}/{name}");
            if let Some(measured) = measured(&path) {
                found.insert(path, measured);
            }
        }
    }
    found
}

#[test]
fn no_envelope_of_the_fixtures_grew() {
    let file = root().join("tests/it/widths.txt");
    let found = all();
    let mut text = String::new();
    for (path, (median, without)) in &found {
        let _ = writeln!(text, "{path} {median:.3e} {without:.4}");
    }
    if std::env::var_os("UPDATE_WIDTHS").is_some() {
        std::fs::write(&file, &text).expect("the file can be written");
        return;
    }
    let known = std::fs::read_to_string(&file).expect("UPDATE_WIDTHS=1 writes it");
    let mut grown = Vec::new();
    for line in known.lines() {
        let mut words = line.split(' ');
        let (Some(path), Some(median), Some(without)) = (words.next(), words.next(), words.next()) else {
            panic!("not a line of widths: {line}")
        };
        let limit = |text: &str| text.parse::<f64>().expect("a number") * GROWTH;
        let Some((now, without_now)) = found.get(path) else {
            grown.push(format!("{path} is gone"));
            continue;
        };
        if *now > limit(median) + 1e-12 || *without_now > limit(without) + 1e-3 {
            grown.push(format!("{path}: {now:.3e}, {without_now:.4} without a bound; it was {median}, {without}"));
        }
    }
    assert!(grown.is_empty(), "UPDATE_WIDTHS=1 accepts it:\n{}", grown.join("\n"));
    assert_eq!(known.lines().count(), found.len(), "UPDATE_WIDTHS=1 adds new scenes");
}
