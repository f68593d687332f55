//! Faults planted in emitted SPIR-V are caught. Needs a Vulkan software adapter and spirv-val.

use crate::mutation::{Choice, Kind, Outcome, Study};
use crate::{gpu, scenes};
use glisten::scene::{DiskFiles, load};
use glisten::{Compiler, Options};

/// Every feature of the pipeline once, and the textbook's lighting models.
const SCENES: [&str; 8] = [
    "/blinn_phong.toml",
    "/phong_vertex.toml",
    "/noperspective.toml",
    "/core/lower_expressions.toml",
    "/core/texture_linear.toml",
    "/core/derivatives.toml",
    "/core/blend_alpha.toml",
    "/core/depth_less.toml",
];

#[test]
fn planted_faults_are_caught() {
    let chosen: Vec<_> = (scenes::paths().into_iter())
        .filter(|path| SCENES.iter().any(|name| path.ends_with(name)))
        .map(|path| {
            let loaded = load(&path, &DiskFiles, &Compiler::new(Options::default()));
            (path, loaded.scene.expect("another test loads it"))
        })
        .collect();
    assert_eq!(chosen.len(), SCENES.len());
    let study = Study::of(&gpu::gpu(), &chosen, Choice { each: Some(3), seed: 7 }, &mut |_, _| {});
    assert!(study.left_out.is_empty() && study.false_alarms.is_empty(), "{study}");
    let all = study.count(|_| true);
    assert!(all.seen >= 60 && all.refused == 0, "{study}");
    // Of all faults that change a picture, four in five are caught, and in no kind fewer than by 1/255.
    assert!(all.caught * 5 >= all.seen * 4, "{study}");
    for kind in Kind::ALL {
        let count = study.count(|trial| trial.kind == kind);
        assert!(count.caught >= count.by_hand, "{}: {study}", kind.name());
    }
    // None that a person could see passes but where the reference decides nothing.
    let gross = study.count(
        |trial| matches!(&trial.outcome, Outcome::Seen { caught: false, change, .. } if change.absolute > 1.0 / 255.0),
    );
    assert_eq!(gross.seen, 0, "{study}");
}
