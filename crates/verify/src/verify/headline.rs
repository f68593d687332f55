//! The first line of a verdict that does not hold: what is wrong, where, and what to do next.
//!
//! *In:* a [`Verification`]. *Out:* a sentence, and the place in the text that it is about.

use crate::verify::{Conclusion, UndefinedAt, Verification};
use glisten_scene::compare::{Contributed, Verdict};

/// The next step, and the reason.
pub struct Headline {
    /// The sentence.
    pub text: String,
    /// The file, line and column that it is about.
    pub place: Option<(String, u32, u32)>,
}

impl Headline {
    /// The sentence for the worst verdict of a verification; `None` if it holds and something was checked.
    pub fn of(verification: &Verification, worst: &Verdict) -> Option<Self> {
        match verification.conclusion() {
            Conclusion::Holds => unchecked(worst),
            Conclusion::Inconclusive => Some(inconclusive(verification, worst)),
            Conclusion::Fails => Some(fails(worst)),
        }
    }
}

fn of_contribution(one: &Contributed) -> (String, u32, u32) {
    (one.file.clone(), one.line, one.column)
}

/// `file:line:column`
fn told((file, line, column): &(String, u32, u32)) -> String {
    format!("{file}:{line}:{column}")
}

/// The warning for a picture that holds although none of its pixels was compared with anything.
fn unchecked(verdict: &Verdict) -> Option<Headline> {
    if verdict.largest_error().is_some() {
        return None;
    }
    let excused = match verdict.known_faults.as_slice() {
        [] => String::new(),
        faults => {
            let names: Vec<&str> = faults.iter().map(|count| count.fault).collect();
            format!(
                ": known faults of the driver excuse {} of {} covered pixels ({}); --no-known-faults judges them",
                verdict.evidence.excused,
                verdict.covered,
                names.join(", ")
            )
        }
    };
    Some(Headline { text: format!("nothing was checked{excused}"), place: None })
}

/// Why a picture is inconclusive.
fn inconclusive(verification: &Verification, verdict: &Verdict) -> Headline {
    const ACCEPT: &str = "--allow-inconclusive accepts it";
    if is_empty(verdict) {
        let text = "inconclusive: no pixel is covered, so there is nothing to judge: look for triangles without area, a mesh \
                    outside the view, culled faces, a depth test that never passes, or a `discard` that always runs; \
                    --allow-inconclusive accepts it";
        return Headline { text: text.to_owned(), place: None };
    }
    let demands = &verification.demands;
    let share = verdict.share_judged(demands);
    let undefined = verdict.evidence.undefined;
    let told_share = match share < demands.evidence_share {
        true => format!(
            "only {:.1} % of the covered pixels can be judged; {:.1} % are required",
            100.0 * share,
            100.0 * demands.evidence_share
        ),
        false => format!(
            "{:.1} % of the covered pixels are undefined",
            100.0 * undefined as f64 / verdict.covered.max(1) as f64
        ),
    };
    let is_mostly = is_mostly_undefined(verdict) || share >= demands.evidence_share;
    if let Some(first) = verification.undefined.first().filter(|_| is_mostly) {
        let UndefinedAt { what, file, line, column, .. } = first;
        let place = (file.clone(), *line, *column);
        let text = format!(
            "inconclusive: {told_share}; {undefined} pixels depend on what GLSL leaves undefined: {what}, at {}: change that, or \
             {ACCEPT}",
            told(&place)
        );
        return Headline { text, place: Some(place) };
    }
    let place = verification.weakness.as_ref().and_then(|weakness| weakness.contributions.first());
    let because = match (&verification.weakness, place) {
        (Some(weakness), Some(one)) => {
            let at = told(&of_contribution(one));
            format!("; {} pixels are {}, because of `{}` at {at}", weakness.pixels, weakness.class, one.operation)
        }
        (Some(weakness), None) => {
            let (x, y) = (weakness.x, weakness.y);
            format!("; {} pixels are {}, such as ({x}, {y}) in {}", weakness.pixels, weakness.class, weakness.channel)
        }
        (None, _) => String::new(),
    };
    let least = (100.0 * verdict.share_judged(demands)).floor() / 100.0;
    let text = format!(
        "inconclusive: {told_share}{because}: judge it by --tolerance 1e-3, or by less (--evidence-share {least}), or {ACCEPT}"
    );
    Headline { text, place: place.map(of_contribution) }
}

/// Which attachment a pixel is of, unless it is the first, which is the picture.
pub fn of_attachment(attachment: u32) -> String {
    if attachment == 0 { String::new() } else { format!(" of attachment {attachment}") }
}

/// The sentence for a picture that is wrong.
fn fails(verdict: &Verdict) -> Headline {
    let counts = [
        (verdict.outside, "pixel", "outside of what a GPU may draw"),
        (verdict.coverage_mismatch, "pixel", "covered by one side alone"),
        (verdict.finiteness_mismatch, "channel", "finite on one side alone"),
        (verdict.outside_likely, "pixel", "outside of what GPUs are likely to draw"),
        (verdict.suspect.unwrap_or(0), "pixel", "far from what simulated GPUs draw"),
    ];
    let parts: Vec<String> = counts
        .iter()
        .filter(|(count, ..)| *count > 0)
        .map(|(count, thing, what)| match count {
            1 => format!("1 {thing} is {what}"),
            count => format!("{count} {thing}s are {what}"),
        })
        .collect();
    let mut text = format!("does not hold: {}", parts.join(", "));
    let mut place = None;
    if let Some(worst) = &verdict.worst {
        let channel = worst.channel as usize % 4;
        let (gpu, cpu) = (worst.gpu[channel], worst.cpu[channel]);
        let name = ["red", "green", "blue", "alpha"][channel];
        let (x, y, of) = (worst.x, worst.y, of_attachment(worst.attachment));
        text.push_str(&format!("; the worst is ({x}, {y}){of}: {name} is {gpu:.6}, exactly {cpu:.6}"));
        if let Some(one) = worst.contributions.first() {
            place = Some(of_contribution(one));
            text.push_str(&format!(
                ", which `{}` at {} makes most uncertain",
                one.operation,
                told(&of_contribution(one))
            ));
        }
    }
    if verdict.non_finite_gpu > 0 && verdict.non_finite_cpu == 0 {
        text.push_str(&format!(
            "; the driver makes NaN or infinities of finite numbers at {} pixels",
            verdict.non_finite_gpu
        ));
    }
    text.push_str(": --difference FILE.png shows where; --tolerance X accepts a difference");
    Headline { text, place }
}

/// Whether there is nothing that figures could be about.
pub fn is_empty(verdict: &Verdict) -> bool {
    verdict.covered == 0 && verdict.undecided == 0 && verdict.edge_pixels == 0 && !verdict.needs_excuse()
}

/// Whether more pixels are undefined than are of any other class without evidence.
fn is_mostly_undefined(verdict: &Verdict) -> bool {
    let evidence = &verdict.evidence;
    evidence.undefined > evidence.weak.max(evidence.unlimited).max(evidence.undecided)
}
