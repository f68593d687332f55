//! The proof: each program in a scene that is made for it, the original drawn by OpenGL, the new one by Vulkan.
//!
//! *In:* ported programs. *Out:* for each `proved`, `inconclusive` or `failed`, with what was found. *Holds:* proved means:
//! OpenGL's picture of the original and Vulkan's of the new program are within the envelope of the original. The new texts are read with OpenGL's
//! coordinates, since glisten's own code for Vulkan turns them. A driver that crashes leaves its program inconclusive, and the rest goes on.

use super::pictures::judged;
use super::programs::Ported;
use crate::arguments::args::{LevelArgs, SourceArgs};
use crate::console::Console;
use crate::exit::{Exit, Failure};
use crate::process::journal::{self, Note};
use glisten_gpu::Gpu;
use glisten_port::Host;
use glisten_verify::verify::Conclusion;
use serde_json::json;
use std::fs;

const PROVED: &str = "proved";
const INCONCLUSIVE: &str = "inconclusive";
const FAILED: &str = "failed";

/// Proves the programs that are ported.
pub(super) fn prove(
    ported: &mut Ported,
    host: &Host,
    sources: &SourceArgs,
    levels: &LevelArgs,
    console: &Console,
) -> Result<(), Failure> {
    let machine = |error: &dyn std::fmt::Display| Failure::new(Exit::Machine, error.to_string());
    let gpu = Gpu::new(None).map_err(|error| machine(&error))?;
    journal::note(&Note::Driver(gpu.adapter().driver.clone()));
    let known = Known::read();
    let folder = tempfile::tempdir().map_err(|error| Failure::usage(format!("no temporary folder: {error}")))?;
    for index in 0..ported.programs.len() {
        let Some(one) = ported.programs.get(index).filter(|one| one.index.is_some()) else { continue };
        let work = journal::drawing(&one.report.files.join("`, `"));
        let (proof, evidence) = match known.told(index) {
            Some(told) => told,
            None => {
                let found = known.crash(&work).map(|what| (INCONCLUSIVE, what)).unwrap_or_else(|| {
                    let scene = folder.path().join(format!("{index}")).join("scene.toml");
                    let _work = journal::at_work(&work);
                    let judged = fs::create_dir_all(scene.parent().unwrap_or(folder.path()))
                        .map_err(|error| error.to_string())
                        .and_then(|()| judged(one, ported, host.dialect.as_ref(), &scene, (sources, levels), &gpu));
                    worded(judged)
                });
                journal::note(&Note::Result(json!([index, found.0, found.1])));
                console.remark(&format!("{}: {}: {}", one.report.name, found.0, found.1));
                found
            }
        };
        if let Some(one) = ported.programs.get_mut(index) {
            one.report.proof = Some(proof.to_owned());
            one.report.evidence = Some(evidence);
        }
    }
    Ok(())
}

/// The results of earlier processes, before a driver crashed.
struct Known(Vec<Note>);

impl Known {
    fn read() -> Self {
        Self(journal::notes())
    }

    /// The result for a program that an earlier process told.
    fn told(&self, index: usize) -> Option<(&'static str, String)> {
        self.0.iter().find_map(|note| {
            let Note::Result(row) = note else { return None };
            let (known, proof, evidence): (usize, String, String) = serde_json::from_value(row.clone()).ok()?;
            let proof = [PROVED, INCONCLUSIVE, FAILED].into_iter().find(|word| *word == proof)?;
            (known == index).then_some((proof, evidence))
        })
    }

    /// The sentence about a crash in a piece of work.
    fn crash(&self, at_work: &str) -> Option<String> {
        self.0.iter().find_map(|note| match note {
            Note::Crash { work, what } if work == at_work => Some(what.clone()),
            _ => None,
        })
    }
}

/// The words of a verdict, and the evidence.
fn worded(judged: Result<(Conclusion, String), String>) -> (&'static str, String) {
    match judged {
        Ok((Conclusion::Holds, evidence)) => (PROVED, evidence),
        Ok((Conclusion::Inconclusive, evidence)) => (INCONCLUSIVE, evidence),
        Ok((Conclusion::Fails, evidence)) => (FAILED, evidence),
        Err(reason) => (INCONCLUSIVE, reason),
    }
}

#[cfg(test)]
mod tests {
    use super::{FAILED, Known, Note, PROVED};
    use serde_json::json;

    #[test]
    fn results_before_a_crash_are_known_and_the_crash_is_one_of_its_program() {
        let known = Known(vec![
            Note::Begin("drawing `a`".to_owned()),
            Note::Result(json!([0, PROVED, "4 pixels"])),
            Note::Result(json!([2, FAILED, "1 outside"])),
            Note::Result(json!([3, "a word of another command", ""])),
            Note::Crash { work: "drawing `b`".to_owned(), what: "the driver crashed".to_owned() },
        ]);
        assert_eq!(known.told(0), Some((PROVED, "4 pixels".to_owned())));
        assert_eq!(known.told(2), Some((FAILED, "1 outside".to_owned())));
        assert_eq!((known.told(1), known.told(3)), (None, None));
        assert_eq!(known.crash("drawing `b`").as_deref(), Some("the driver crashed"));
        assert_eq!(known.crash("drawing `a`"), None);
    }
}
