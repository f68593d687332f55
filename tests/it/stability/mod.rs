//! `glisten stability`: the planted instabilities and their sound look-alikes, and the command from the outside.
//!
//! The scenes of `fixtures/stability` were written before the analysis and independently of it; `cases.toml` says what is
//! expected.

mod command;
mod remedies;

use crate::support::{NextTo, compiler};
use glisten::scene::{DiskFiles, load};
use glisten::stability::{ExamineOptions, find};
use glisten_stability::{BOUND, Findings};

use rayon::prelude::*;
use serde::Deserialize;
use std::path::Path;

const FOLDER: &str = "fixtures/stability";

#[derive(Deserialize)]
struct Table {
    case: Vec<Case>,
}

#[derive(Deserialize)]
#[serde(default)]
#[derive(Default)]
struct Case {
    scene: String,
    file: String,
    line: u32,
    lines: Vec<u32>,
    kind: String,
    kinds: Vec<String>,
    verdict: String,
    ill_posed: bool,
}

fn cases() -> Vec<Case> {
    let text = std::fs::read_to_string(format!("{FOLDER}/cases.toml")).expect("the table is there");
    toml::from_str::<Table>(&text).expect("the table is well-formed").case
}

fn found(scene: &str) -> Findings {
    let path = format!("{FOLDER}/{scene}");
    let loaded = load(&path, &DiskFiles, &compiler().with_includes(NextTo));
    let told: Vec<&str> = loaded.diagnostics.iter().map(|finding| finding.message.as_str()).collect();
    let scene = loaded.scene.unwrap_or_else(|| panic!("{path}: {told:?}"));
    let mut options =
        ExamineOptions { bound: BOUND, bound_relative: 0.0, all: false, figures: false, progress: &mut |_, _| true };
    let (findings, _) =
        find(&scene, &loaded.sources, &mut options, None).unwrap_or_else(|found| panic!("{path}: {found:?}"));
    findings
}

impl Case {
    fn is_sound(&self) -> bool {
        self.verdict == "stable"
    }

    fn lines(&self) -> Vec<u32> {
        if self.lines.is_empty() { vec![self.line] } else { self.lines.clone() }
    }

    fn kinds(&self) -> Vec<&str> {
        if self.kinds.is_empty() { vec![&self.kind] } else { self.kinds.iter().map(String::as_str).collect() }
    }

    /// Whether the planted line is among the first two causes, whether its kind is right, and the verdict.
    fn outcome(&self, found: &Findings) -> [bool; 3] {
        let name = |path: &str| Path::new(path).file_name().map(|name| name.to_string_lossy().into_owned());
        let hits = found.causes.iter().take(2).filter(|cause| name(&cause.file) == name(&self.file));
        let hits: Vec<&str> = hits.filter(|cause| self.lines().contains(&cause.line)).map(|cause| cause.kind).collect();
        let verdict = self.verdict == "either" && found.verdict != "stable" || self.verdict == found.verdict;
        [!hits.is_empty(), hits.iter().any(|kind| self.kinds().contains(kind)), verdict]
    }
}

/// The shares over the corpus. It is the bar of the analysis: a change that finds less fails.
#[test]
fn planted_instabilities_are_found_and_sound_look_alikes_are_not_accused() {
    let cases = cases();
    let compared: Vec<(&Case, Findings)> = cases.par_iter().map(|case| (case, found(&case.scene))).collect();
    let (sound, planted): (Vec<_>, Vec<_>) = compared.iter().partition(|(case, _)| case.is_sound());
    assert!(planted.len() >= 60 && sound.len() >= 70, "{} planted, {} sound", planted.len(), sound.len());
    let accused: Vec<&str> =
        sound.iter().filter(|(_, found)| found.verdict != "stable").map(|(case, _)| case.scene.as_str()).collect();
    assert_eq!(accused, [] as [&str; 0], "sound scenes are accused");
    let missed = |which: usize| -> Vec<&str> {
        planted
            .iter()
            .filter(|(case, found)| !case.outcome(found)[which])
            .map(|(case, _)| case.scene.as_str())
            .collect()
    };
    assert_eq!(missed(0), [] as [&str; 0], "the line is not among the first two causes");
    assert_eq!(missed(1), [] as [&str; 0], "the kind is wrong");
    // The width of a fraction's step is 0 in f32 alone, and the picture divides by it: an infinity changes pixels there.
    assert_eq!(missed(2), ["planted/39_map_grid.toml"], "the verdict is wrong");
    // A tolerance helps against the first; the second is a cancellation near the cut of `atan`.
    let told_apart =
        |(case, found): &&(&Case, Findings)| case.ill_posed == found.causes.iter().take(2).any(|cause| cause.ill_posed);
    let wrong: Vec<&str> = planted.iter().filter(|it| !told_apart(it)).map(|(case, _)| case.scene.as_str()).collect();
    assert_eq!(wrong, ["planted/14_splat_check.toml", "planted/40_wind_rose.toml"], "ill-posed or unstable");
}

#[test]
fn every_cause_has_a_help_and_its_figures_are_in_range() {
    let mut counted = 0;
    for case in cases().iter().filter(|case| !case.is_sound()).step_by(5) {
        for cause in found(&case.scene).causes {
            counted += 1;
            assert!(cause.help.len() > 20, "{}: {cause:?}", case.scene);
            assert!((0.0..=24.0).contains(&cause.lost_bits), "{}: {cause:?}", case.scene);
            assert!(cause.harm.is_none_or(|harm| harm >= BOUND), "{}: {cause:?}", case.scene);
            assert!(cause.harm.is_some() || cause.non_finite > 0, "{}: {cause:?}", case.scene);
            assert_eq!(cause.help.contains("ill-posed"), cause.ill_posed, "{}: {cause:?}", case.scene);
        }
    }
    assert!(counted >= 15, "{counted} causes");
}
