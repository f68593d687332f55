//! The figures of a verification for people: three lines if all is well, one before them if it is inconclusive, and a line and
//! a table for each form if it fails.
//!
//! *In:* a [`Verification`] and its runs. *Out:* text.

use super::{Run, Skip, worst_of};
use glisten_scene::compare::Verdict;
use glisten_verify::verify::{Conclusion, Verification, mark};
use glisten_verify::verify::{Headline, POPULATION_SEED, is_empty, of_attachment};

/// The text for people.
pub(super) fn told(verification: &Verification, runs: &[Run], skipped: &[Skip], bit_unequal: Option<u64>) -> String {
    let mut text = String::new();
    let worst = worst_of(runs);
    if let Some(headline) = worst.as_ref().and_then(|worst| Headline::of(verification, &worst.verdict)) {
        text.push_str(&headline.text);
        text.push('\n');
    }
    match (verification.conclusion(), &worst) {
        (Conclusion::Inconclusive, Some(worst)) if is_empty(&worst.verdict) => {}
        (Conclusion::Holds | Conclusion::Inconclusive, Some(worst)) => {
            text.push_str(&summary(verification, runs, worst, bit_unequal));
        }
        _ => {
            text.extend(runs.iter().map(|run| table(run, verification)));
            if let Some(count) = bit_unequal {
                text.push_str(&format!("spirv and wgsl: {count} pixels are not bit-equal\n"));
            }
        }
    }
    if verification.share < 1.0 {
        text.push_str("--whole judges all of the picture and takes longer\n");
    }
    for skip in skipped {
        text.push_str(&format!("{}: not run: {}\n", skip.via, skip.reason));
    }
    text
}

/// Three lines: how much was judged, how far the pictures are apart, how long it took.
fn summary(verification: &Verification, runs: &[Run], worst: &Run, bit_unequal: Option<u64>) -> String {
    let verdict = &worst.verdict;
    let vias: Vec<&str> = runs.iter().map(|run| run.via).collect();
    let times: Vec<String> = runs.iter().map(|run| format!("{} {:.3} ms", run.via, run.gpu_ms)).collect();
    let equal = match bit_unequal {
        Some(0) => ", bit-equal".to_owned(),
        Some(count) => format!(", {count} pixels not bit-equal"),
        None => String::new(),
    };
    let share = 100.0 * verdict.share_judged(&verification.demands);
    let blocks = match verification.share {
        whole if whole >= 1.0 => String::new(),
        part => format!(" in blocks of {:.1} % of the picture", 100.0 * part),
    };
    format!(
        "{}: {}: {} of {} covered pixels{blocks} {} ({share:.1} %){}\n\
         {}, flip {:.3e}; {}\n\
         {}{equal}, reference {:.3} ms{}\n",
        vias.join(" and "),
        mark(verification.conclusion()),
        verdict.evidence.good(),
        verdict.covered,
        verdict.judged_word(),
        parts(verdict),
        errors(verdict),
        worst.flip,
        by(verdict),
        times.join(", "),
        worst.cpu_ms,
        population(verification).map_or(String::new(), |population| format!("; {population}")),
    )
}

/// The population that was drawn, with its seed.
fn population(verification: &Verification) -> Option<String> {
    verification.demands.likely.then(|| format!("simulated GPUs of seed {POPULATION_SEED}"))
}

/// In place of errors.
const NONE_COMPARED: &str = "no pixel was compared";

/// The errors, if any pixel was compared.
fn errors(verdict: &Verdict) -> String {
    match verdict.largest_error() {
        Some(error) => {
            format!("largest error {error:.3e} ({} ulp), rmse {:.3e}", ulps(verdict.max_ulp), verdict.rmse)
        }
        None => NONE_COMPARED.to_owned(),
    }
}

/// A number of ULP. Those of a number near 0 are very many.
fn ulps(count: f64) -> String {
    if count < 1e12 { format!("{count:.1}") } else { format!("{count:.1e}") }
}

/// The standard of the comparison.
fn by(verdict: &Verdict) -> String {
    match verdict.judged_by {
        "envelope" => format!("judged by envelopes up to {:.1e} wide", verdict.width),
        other => format!("judged by {other}"),
    }
}

/// The classes besides `judged` that have pixels.
fn parts(verdict: &Verdict) -> String {
    let evidence = &verdict.evidence;
    let rows = [
        (evidence.likely - verdict.as_device.min(evidence.likely), "likely"),
        (verdict.as_device, "likely by what is known of this device"),
        (evidence.edge, "at edges"),
        (evidence.excused, "excused by known faults"),
        (evidence.weak, "weak"),
        (evidence.unlimited, "unlimited"),
        (evidence.undecided, "undecided"),
        (evidence.undefined, "undefined"),
    ];
    rows.iter().filter(|(count, _)| *count > 0).map(|(count, name)| format!(", {count} {name}")).collect()
}

/// All figures of a run.
fn table(run: &Run, verification: &Verification) -> String {
    let verdict = &run.verdict;
    let psnr = verdict.psnr.map_or("equal".to_owned(), |psnr| format!("{psnr:.1} dB"));
    let errors = match verdict.largest_error() {
        Some(error) => vec![
            ("largest error", format!("{error:.3e} ({} ulp)", ulps(verdict.max_ulp))),
            ("rmse, psnr", format!("{:.3e}, {psnr}", verdict.rmse)),
        ],
        None => vec![("largest error", NONE_COMPARED.to_owned())],
    };
    let counts = [
        ("covered", format!("{} of {} pixels", verdict.covered, verdict.pixels)),
        ("judged", format!("{}{}", verdict.evidence.judged, parts(verdict))),
    ];
    let rows = [
        ("flip", format!("{:.3e}", run.flip)),
        ("outside", format!("{} ({})", verdict.outside, by(verdict))),
        ("not bit-equal", format!("{} pixels", run.bit_unequal)),
        ("undecided", verdict.undecided.to_string()),
        ("coverage mismatch", format!("{} ({} at edges)", verdict.coverage_mismatch, verdict.edge_pixels)),
        ("not finite", format!("gpu {}, cpu {}", verdict.non_finite_gpu, verdict.non_finite_cpu)),
        ("time", format!("gpu {:.3} ms, cpu {:.3} ms", run.gpu_ms, run.cpu_ms)),
    ];
    let faults: Vec<String> =
        verdict.known_faults.iter().map(|count| format!("{} ({})", count.pixels, count.fault)).collect();
    let faults = (!faults.is_empty()).then(|| ("known faults", faults.join(", ")));
    let suspect = verdict.suspect.map(|count| match population(verification) {
        Some(population) => ("suspect", format!("{count} ({population})")),
        None => ("suspect", count.to_string()),
    });
    let unlikely = (verdict.outside_likely > 0).then(|| ("outside likely", verdict.outside_likely.to_string()));
    let mut text = format!("{}: {}\n", run.via, mark(verdict.conclusion(&verification.demands)));
    for (name, value) in counts.into_iter().chain(errors).chain(rows).chain(suspect).chain(unlikely).chain(faults) {
        text.push_str(&format!("  {name:18} {value}\n"));
    }
    text + &worst_pixel(verdict)
}

fn worst_pixel(verdict: &Verdict) -> String {
    let Some(worst) = verdict.worst.as_ref().filter(|_| verdict.max_abs > 0.0 || verdict.outside > 0) else {
        return String::new();
    };
    let numbers = |color: [f64; 4]| color.map(|value| format!("{value:.7}")).join(", ");
    format!(
        "  worst pixel        ({}, {}){}\n    gpu   {}\n    cpu   {}\n    bound {}\n",
        worst.x,
        worst.y,
        of_attachment(worst.attachment),
        numbers(worst.gpu),
        numbers(worst.cpu),
        worst.bound.map(|value| format!("{value:.2e}")).join(", ")
    )
}
