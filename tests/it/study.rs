//! Scenes of the study of `verify` (`fixtures/study/verify`) with their rewritings and faults, a few of each kind.
//! `cargo run --release -p glisten-studies --bin study -- fixtures/study/verify` judges all of them. These tests need a Vulkan software
//! adapter.

use crate::drawing::{gpu, loaded};
use crate::support::{compiler, root};
use glisten::scene::{DiskFiles, FileError, FileSource, Scene, load};
use glisten::verify::{Conclusion, Options};
use glisten_gpu::Via;
use glisten_scene::compare::Verdict;
use glisten_verify::verify::Expected;
use std::path::Path;

/// The files of the disk with the edits of a case.
struct Edited(Vec<[String; 3]>);

impl FileSource for Edited {
    fn read(&self, path: &str) -> Result<Vec<u8>, FileError> {
        let bytes = DiskFiles.read(path)?;
        let name = Path::new(path).file_name().unwrap_or_default();
        let mut text = String::from_utf8_lossy(&bytes).into_owned();
        for [_, find, replace] in self.0.iter().filter(|[file, ..]| name == file.as_str()) {
            assert_eq!(text.matches(find).count(), 1, "{path}: {find}");
            text = text.replacen(find, replace, 1);
        }
        Ok(text.into_bytes())
    }
}

/// The edits of the case with this title; none for the scene as it is.
fn edits(folder: &str, what: &str) -> Vec<[String; 3]> {
    let text = std::fs::read_to_string(root().join(folder).join("cases.toml")).expect("a scene of the study");
    let table: toml::Table = text.parse().expect("it is TOML");
    let cases =
        ["legal", "fault"].into_iter().flat_map(|key| table.get(key).and_then(|list| list.as_array()).into_iter());
    let mut titled = cases.flatten().filter(|case| case["what"].as_str() == Some(what));
    let case = titled.next().unwrap_or_else(|| panic!("{folder} has no case {what}"));
    let of = |edit: &toml::Value| ["file", "find", "replace"].map(|key| edit[key].as_str().expect("text").to_owned());
    case["edits"].as_array().into_iter().flatten().map(of).collect()
}

fn scene(folder: &str, edits: Vec<[String; 3]>) -> Scene {
    let path = root().join(folder).join("scene.toml");
    let name = path.to_string_lossy();
    loaded(&name, load(&name, &Edited(edits), &compiler()))
}

/// The verdicts on the scene of a folder as it is, and on cases of it.
fn verdicts(folder: &str, cases: &[&str]) -> Vec<(Conclusion, Verdict)> {
    let folder = format!("fixtures/study/verify/{folder}");
    let gpu = gpu();
    let options = Options::default();
    let original = scene(&folder, Vec::new());
    let mut expected = Expected::new(&original, &options).expect("the reference draws it");
    let of_cases = cases.iter().map(|what| scene(&folder, edits(&folder, what)));
    let scenes: Vec<Scene> = [original.clone()].into_iter().chain(of_cases).collect();
    let judged = scenes.iter().map(|scene| {
        let drawn = gpu.render(scene, Via::Spirv).expect("it can be drawn").picture;
        let verdict = expected.compare(&drawn).expect("the reference draws it");
        (verdict.conclusion(&options.demands), verdict)
    });
    judged.collect()
}

#[test]
fn derivatives_are_judged_by_what_is_likely() {
    let found = verdicts("derivatives/bump_height", &["coarse derivatives", "sine within 2^-11", "wrong sign of dFdy"]);
    let conclusions: Vec<Conclusion> = found.iter().map(|(conclusion, _)| *conclusion).collect();
    use Conclusion::{Fails, Holds};
    assert_eq!(conclusions, [Holds, Holds, Holds, Fails], "{found:?}");
    // A fault of another sign is across jumps here and there, where nothing is likely.
    assert!(found.iter().take(3).all(|(_, verdict)| verdict.evidence.likely > 3900), "{found:?}");
}

#[test]
fn a_fault_that_envelopes_allow_is_outside_of_what_is_likely() {
    let found = verdicts("filtering/grad_aniso", &["sine within 2^-11", "level of the sum"]);
    let [(sound, _), (legal, _), (fault, verdict)] = found.as_slice() else { panic!("{found:?}") };
    assert_eq!([*sound, *legal, *fault], [Conclusion::Holds, Conclusion::Holds, Conclusion::Fails], "{found:?}");
    assert!(verdict.outside == 0 && verdict.outside_likely >= 8, "{verdict:?}");
}

#[test]
fn what_is_empty_or_undefined_never_holds() {
    let (conclusion, verdict) = verdicts("empty/degenerate", &[]).remove(0);
    assert_eq!((conclusion, verdict.covered), (Conclusion::Inconclusive, 0), "{verdict:?}");
    for (folder, pixels) in [
        ("undefined/atan_zero", 100),
        ("undefined/normalize_zero", 600),
        ("undefined/mipmap_in_branch", 50),
        ("undefined/derivative_in_branch", 50),
    ] {
        let (conclusion, verdict) = verdicts(folder, &[]).remove(0);
        assert_eq!(conclusion, Conclusion::Inconclusive, "{folder}: {verdict:?}");
        assert!(verdict.evidence.undefined >= pixels, "{folder}: {verdict:?}");
    }
}
