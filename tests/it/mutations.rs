//! Faults planted in emitted SPIR-V are caught. The test needs a Vulkan software adapter and spirv-val.

use crate::mutation::{Choice, Kind, Outcome, Study};
use crate::scenes;
use crate::support::compiler;
use glisten::scene::{DiskFiles, load};

/// Scenes that use every feature of the pipeline once, and the textbook's lighting models.
const SCENES: [&str; 8] = [
    "blinn_phong",
    "phong_vertex",
    "noperspective",
    "lower_expressions",
    "texture_linear",
    "derivatives",
    "blend_alpha",
    "depth_less",
];

#[test]
fn planted_faults_are_caught() {
    let files = scenes::paths();
    let chosen = SCENES.map(|name| {
        let path = files.iter().find(|path| path.ends_with(&format!("/{name}.toml"))).expect("it is there");
        let loaded = load(path, &DiskFiles, &compiler());
        (name.to_owned(), loaded.scene.expect("another test loads it"))
    });
    let study = Study::of(&crate::drawing::gpu(), &chosen, Choice { each: Some(3), seed: 7 }, &mut |_, _| {});
    assert!(study.left_out.is_empty() && study.false_alarms.is_empty(), "{study}");
    let all = study.count(|_| true);
    assert!(all.seen >= 60 && all.refused == 0, "{study}");
    // Of all faults that change a picture, four in five must be caught, and in each kind at least as many as by
    // 1/255.
    assert!(all.caught * 5 >= all.seen * 4, "{study}");
    for kind in Kind::ALL {
        let count = study.count(|trial| trial.kind == kind);
        assert!(count.caught >= count.by_hand, "{}: {study}", kind.name());
    }
    // What passes is small: the largest allowance in these scenes is the weight of linear filtering, up to 1/256 of a
    // texel.
    let gross = study.count(
        |trial| matches!(&trial.outcome, Outcome::Seen { caught: false, change, .. } if change.absolute > 1.0 / 64.0),
    );
    assert_eq!(gross.seen, 0, "{study}");
}
