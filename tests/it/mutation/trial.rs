//! [`Trial`]: the outcome of one fault planted in a scene.
//!
//! *In:* pictures. *Out:* whether the fault is seen and caught, and how far the picture moved.

use super::scenery::Scenery;
use super::{Form, Kind};
use glisten::verify::Conclusion;
use glisten_front::hir::Stage;
use glisten_scene::compare::evidence::Ruler;
use glisten_scene::compare::{Class, ulp_f32};
use glisten_scene::picture::Picture;
use std::fmt;

/// How a mutant's picture differs from the one without the fault, at the channel that moves most.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Change {
    /// The difference.
    pub(crate) absolute: f64,
    /// The difference in ULP of the reference.
    pub(crate) ulps: f64,
    /// The width of the envelope of that channel.
    pub(crate) width: f64,
    /// The class of its pixel; `None` if it is not covered.
    pub(crate) class: Option<Class>,
    /// The number of pixels that differ at all.
    pub(crate) pixels: u64,
    /// Whether some channel differs by more than conforming GPUs may for no reason ([`Ruler::unit`]), or in coverage.
    pub(crate) is_beyond_rounding: bool,
}

/// The outcome of a mutant.
#[derive(Clone, Debug)]
pub(crate) enum Outcome {
    /// A validator rejects it.
    Invalid,
    /// The driver rejects it, or does not finish.
    Refused(String),
    /// The picture is the same bit for bit: for this scene it is not a fault.
    Unseen,
    /// The picture differs. If it does so by no more than rounding, it is counted apart: any GPU may draw it.
    Seen(Seen),
}

/// The outcome of a mutant whose picture differs.
#[derive(Clone, Debug)]
pub(crate) struct Seen {
    /// The conclusion of `verify`.
    pub(crate) conclusion: Conclusion,
    /// Whether the envelope alone fails it.
    pub(crate) by_envelope: bool,
    /// Whether the picture without the fault is inconclusive already.
    pub(crate) was_open: bool,
    /// Whether `verify --tolerance` with 1/255 fails; `None` if it also fails without a fault.
    pub(crate) by_hand: Option<bool>,
    /// The number of pixels that are far from what the population of simulated GPUs drew.
    pub(crate) suspect: u64,
    pub(crate) change: Change,
}

impl Seen {
    /// Whether the picture moves by no more than rounding, so that for this scene it is not a fault either.
    pub(crate) fn is_rounding(&self) -> bool {
        !self.change.is_beyond_rounding
    }

    /// Whether `verify` fails.
    pub(crate) fn is_caught(&self) -> bool {
        self.conclusion == Conclusion::Fails
    }
}

/// One fault.
#[derive(Clone, Debug)]
pub(crate) struct Trial {
    pub(crate) scene: String,
    pub(crate) scenery: Scenery,
    pub(crate) form: Form,
    pub(crate) stage: Stage,
    pub(crate) kind: Kind,
    pub(crate) name: String,
    pub(crate) outcome: Outcome,
}

impl Trial {
    pub(crate) fn seen(&self) -> Option<&Seen> {
        match &self.outcome {
            Outcome::Seen(seen) => Some(seen),
            Outcome::Invalid | Outcome::Refused(_) | Outcome::Unseen => None,
        }
    }

    /// Whether the picture without the fault is inconclusive already.
    pub(crate) fn is_open(&self) -> bool {
        self.seen().is_some_and(|seen| seen.was_open)
    }
}

impl fmt::Display for Trial {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (form, stage, kind) = (self.form.name(), self.stage.name(), self.kind.name());
        write!(f, "{}, {form} {stage}, {kind}: {}: ", self.scene, self.name)?;
        match &self.outcome {
            Outcome::Invalid => f.write_str("invalid"),
            Outcome::Refused(why) => write!(f, "refused: {}", why.lines().next().unwrap_or_default()),
            Outcome::Unseen => f.write_str("the picture is the same"),
            Outcome::Seen(seen) => {
                let Change { absolute, ulps, width, class, pixels, .. } = seen.change;
                let verdict = match (seen.conclusion, seen.by_envelope) {
                    (Conclusion::Fails, true) => "caught",
                    (Conclusion::Fails, false) => "caught by the population",
                    (Conclusion::Inconclusive, _) => "missed (inconclusive)",
                    (Conclusion::Holds, _) => "missed",
                };
                let class = class.map_or("not covered", Class::name);
                write!(f, "{verdict}: {pixels} pixels, up to {absolute:.1e} ({ulps:.1} ulp), in an envelope ")?;
                write!(f, "{width:.1e} wide, {class}, {} suspect", seen.suspect)?;
                f.write_str(if seen.by_hand == Some(true) { "; 1/255 catches it" } else { "" })
            }
        }
    }
}

/// Where a picture differs from the one without the fault, and by how much.
pub(super) fn difference(
    [picture, plain, reference]: [&Picture; 3],
    ruler: &Ruler<'_>,
    classes: &[Option<Class>],
) -> Change {
    let mut change = Change::default();
    for pixel in 0..picture.covered.len() {
        let is_covered_alike = picture.covered[pixel] == plain.covered[pixel];
        let pairs = picture.attachments.iter().zip(&plain.attachments).enumerate();
        let channels = pairs.flat_map(|(number, (ours, plain))| {
            (0..4).map(move |channel| (number, channel, ours[pixel][channel], plain[pixel][channel]))
        });
        let mut is_changed = !is_covered_alike;
        change.is_beyond_rounding |= !is_covered_alike;
        for (number, channel, ours, plain) in channels.filter(|(_, _, a, b)| a.to_bits() != b.to_bits()) {
            is_changed = true;
            let difference = (ours - plain).abs();
            // A number that is not finite on one side is the largest difference.
            let difference = if difference.is_nan() { f64::INFINITY } else { difference };
            let value = reference.attachments[number][pixel][channel];
            change.is_beyond_rounding |= difference > ruler.unit(value);
            if difference > change.absolute {
                let interval = reference.intervals.as_ref().and_then(|all| all.get(number)?.get(pixel));
                change.absolute = difference;
                change.ulps = difference / ulp_f32(value);
                change.width = interval.map_or(0.0, |interval| interval[channel].width());
                change.class = classes.get(pixel).copied().flatten();
            }
        }
        change.pixels += u64::from(is_changed);
    }
    change
}
