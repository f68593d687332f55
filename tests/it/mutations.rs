//! Faults planted in emitted code are caught, and legal changes of it are not. The test needs a Vulkan software adapter
//! and spirv-val.

use crate::mutation::{Choice, Parts, Study};
use crate::scenes;
use crate::support::compiler;
use glisten::scene::{DiskFiles, load};
use glisten::verify::Conclusion;

/// Scenes of the hard classes, and the textbook's lighting models.
const SCENES: [&str; 9] = [
    "sphere_trace",
    "normal_map",
    "noise_cells",
    "texture_shadow",
    "places",
    "blinn_phong",
    "phong_vertex",
    "lower_switches",
    "depth_less",
];

/// The fewest pixels outside of what is likely for which `verify` fails.
const FEWEST: u64 = 8;

/// The share of the faults that `verify` must catch, in percent.
const CAUGHT: f64 = 97.0;

fn study(choice: Choice, parts: Parts) -> Study {
    let files = scenes::paths();
    let chosen = SCENES.map(|name| {
        let path = files.iter().find(|path| path.ends_with(&format!("/{name}.toml"))).expect("it is there");
        let loaded = load(path, &DiskFiles, &compiler());
        (name.to_owned(), loaded.scene.expect("another test loads it"))
    });
    Study::of(&crate::drawing::gpu(), &chosen, (choice, parts), &mut |_, _| {})
}

#[test]
fn planted_faults_are_caught() {
    let study = study(Choice { each: Some(1), seed: 7 }, Parts { faults: true, legal: false });
    assert!(study.left_out.is_empty() && study.false_alarms.is_empty(), "{study}");
    let all = study.count(|_| true);
    assert!(all.seen >= 60 && all.refused == 0, "{study}");
    assert!(all.percent() >= CAUGHT && !all.is_worse_than_by_hand(), "{study}");
    // What passes is small, or has fewer pixels than `verify` asks for before it fails likely ones.
    let gross = study.count(|trial| {
        let is_gross = |absolute: f64, pixels: u64| absolute > 1.0 / 64.0 && pixels >= FEWEST;
        let seen = trial.seen().filter(|seen| seen.conclusion == Conclusion::Holds);
        seen.is_some_and(|seen| is_gross(seen.change.absolute, seen.change.pixels))
    });
    assert_eq!(gross.seen, 0, "{study}");
}

#[test]
fn legal_changes_hold() {
    let study = study(Choice { each: None, seed: 7 }, Parts { faults: false, legal: true });
    assert!(study.legal.len() >= 40 && study.legal.iter().all(|one| one.conclusion.is_ok()), "{study}");
    assert!(study.wrongly_failed().is_empty(), "{study}");
}
