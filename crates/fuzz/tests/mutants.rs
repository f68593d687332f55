//! Mutants of the fixtures: each has a verdict, and most errors are where the change is.

use glisten_front::Stage;
use glisten_fuzz::mutants::{Chance, Verdict, mutant, verdict};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// A mutant that takes longer has no end.
const LIMIT: Duration = Duration::from_secs(60);

fn sources() -> Vec<(Stage, String)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures");
    let mut folders = vec![root.join("valid"), root.join("programs")];
    let mut files: Vec<PathBuf> = Vec::new();
    while let Some(folder) = folders.pop() {
        for entry in
            std::fs::read_dir(folder).expect("a folder of fixtures").map(|entry| entry.expect("an entry").path())
        {
            if entry.is_dir() { folders.push(entry) } else { files.push(entry) }
        }
    }
    files.sort();
    let stage = |path: &Path| match path.extension()?.to_str()? {
        "vert" => Some(Stage::Vertex),
        "frag" => Some(Stage::Fragment),
        "geom" => Some(Stage::Geometry),
        _ => None,
    };
    let read = |path: &PathBuf| Some((stage(path)?, std::fs::read_to_string(path).ok()?));
    files.iter().filter_map(read).collect()
}

#[test]
fn mutants_have_a_verdict_near_their_change() {
    let sources = sources();
    assert!(sources.len() > 30, "{} sources", sources.len());
    let mut chance = Chance::new(20_261_127);
    let (mut made, mut refused, mut near) = (0, 0, 0);
    while made < 1500 {
        let Some((stage, text)) = chance.one(&sources) else { break };
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
