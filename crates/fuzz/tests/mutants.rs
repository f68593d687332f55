//! Mutants of the fixtures: each has a verdict, and most errors are where the change is.

use glisten_fuzz::mutants::{Chance, Verdict, Whole, mutant, sources, verdict};
use std::path::Path;
use std::time::Duration;

/// A mutant that takes longer has no end.
const LIMIT: Duration = Duration::from_secs(60);

#[test]
fn mutants_have_a_verdict_near_their_change() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures");
    let sources = sources(&["valid", "programs", "lower"].map(|folder| root.join(folder)));
    assert!(sources.len() > 30, "{} sources", sources.len());
    let mut chance = Chance::new(20_261_127);
    let (mut made, mut refused, mut near) = (0, 0, 0);
    while made < 1500 {
        let Some(Whole { stage, text, .. }) = chance.one(&sources) else { break };
        let Some(mutant) = mutant(text, &mut chance) else { continue };
        made += 1;
        match verdict(&mutant.text, *stage, LIMIT).0 {
            Verdict::Accepted => {}
            Verdict::Refused { line, .. } => {
                refused += 1;
                near += usize::from(line.abs_diff(mutant.line) <= 1);
            }
            bad => panic!("{bad:?}: {}\n{}", mutant.change, mutant.text),
        }
    }
    assert!(refused > made / 2 && near * 10 > refused * 7, "{near} of {refused} of {made} are near the change");
}
