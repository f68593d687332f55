//! The verdict on a driver's picture, for the page.
//!
//! *In:* a verification. *Out:* the word, what to do next, the figures, and the pictures as data URIs.

use glisten_scene::picture::{Encoding, Picture, color_uri};
use glisten_verify::scene::Scene;
use glisten_verify::verify::{self, Conclusion, Headline, Verification};
use serde_json::{Value, json};

/// A verdict with the pictures that led to it; `by` drew what was judged.
pub fn judged(verification: &Verification, scene: &Scene, by: &str) -> Value {
    let encode = scene.framebuffer.encode;
    let uri = |picture: &Picture, by: Encoding| color_uri(picture, by);
    let word = match verification.conclusion() {
        Conclusion::Holds => "holds",
        Conclusion::Inconclusive => "inconclusive",
        Conclusion::Fails => "fails",
    };
    json!({
        "verdict": word,
        "says": says(verification),
        "by": by,
        "width": verification.reference.width,
        "height": verification.reference.height,
        "reference": uri(&verification.reference, encode),
        "driver": verification.runs.first().map(|run| uri(&run.picture, encode)),
        "difference": uri(&verification.difference(), Encoding::default()),
        "difference_legend": verify::DIFFERENCE_LEGEND,
        "evidence": uri(&verification.evidence(), Encoding::default()),
        "evidence_legend": verify::EVIDENCE_LEGEND,
    })
}

/// The verdict in words: what to do next, and the figures of each form of the code.
fn says(verification: &Verification) -> String {
    let worst = verification.runs.iter().map(|run| run.verdict.clone()).reduce(|worse, other| worse.worse(&other));
    let next = worst.as_ref().and_then(|worst| Headline::of(verification, worst));
    let next = next.map(|headline| match headline.place {
        Some((file, line, column)) => format!("{file}:{line}:{column}: {}", headline.text),
        None => headline.text,
    });
    let figures = verification.runs.iter().map(|run| {
        let verdict = &run.verdict;
        let largest = verdict.worst.as_ref().map(|worst| {
            let from = worst.contributions.first();
            let from = from.map(|one| format!(", most of it from `{}` in {}:{}", one.operation, one.file, one.line));
            format!("; nearest to its bound at pixel {}, {}{}", worst.x, worst.y, from.unwrap_or_default())
        });
        format!(
            "{}: {}, {} of {} pixels covered, {:.1} % of them {}, {} outside; {}{}",
            run.runner,
            verify::mark(verdict.conclusion(&verification.demands)),
            verdict.covered,
            verdict.pixels,
            100.0 * verdict.share_judged(&verification.demands),
            verdict.judged_word(),
            verdict.outside,
            match verdict.largest_error() {
                Some(error) => format!("largest error {error:.2e}"),
                None => "no pixel was compared".to_owned(),
            },
            largest.unwrap_or_default(),
        )
    });
    next.into_iter().chain(figures).collect::<Vec<_>>().join("\n")
}
