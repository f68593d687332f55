//! `fix`: applies the fixes of findings until nothing changes.
//!
//! *Holds:* a round after which there are more errors than before is taken back, and its fixes are tried one at a time.

use crate::program::tell;
use crate::reply::Reply;
use crate::request::{Request, Text};
use glisten_binding::{Compiled, Error, FoundSeverity, Settings, Source};
use glisten_front::diagnostic::{Applicability, Patch};
use std::collections::BTreeSet;

/// How often the sources are checked again.
const MAX_ROUNDS: usize = 100;

/// Answers `fix`: the new texts of the sources, and what is left to say of them.
pub(crate) fn fix(request: &Request) -> Result<Reply, Error> {
    let (settings, asked) = request.settings()?;
    let mut texts = request.sources.clone();
    let mut compiled = checked(&settings, &texts)?;
    let mut reply = Reply::default();
    if let Some(wanted) = asked.wanted() {
        reply.set("wanted", wanted);
        return Ok(reply);
    }
    let (mut at_once, mut refused, mut applied) = (usize::MAX, BTreeSet::new(), 0);
    for _ in 0..MAX_ROUNDS {
        let (patch, taken) = chosen(&compiled, &texts, request.unsafe_fixes, at_once, &refused);
        if taken.is_empty() {
            break;
        }
        let mut next = texts.clone();
        for text in &mut next {
            if let Some(new) = patch.applied(&text.name, &text.text) {
                text.text = new;
            }
        }
        let after = checked(&settings, &next)?;
        if n_errors(&after) <= n_errors(&compiled) {
            applied += taken.len();
            (texts, compiled) = (next, after);
        } else if at_once > 1 {
            at_once = 1;
        } else {
            refused.extend(taken);
        }
    }
    tell(&mut reply, &compiled);
    reply.set("applied", applied);
    reply.set("texts", texts.into_iter().map(|text| text.text).collect::<Vec<_>>());
    Ok(reply)
}

fn checked(settings: &Settings, texts: &[Text]) -> Result<Compiled, Error> {
    let sources = texts.iter().map(Text::sources).collect::<Result<Vec<Vec<Source>>, Error>>()?.concat();
    glisten_binding::compile(settings, &sources, true)
}

fn n_errors(compiled: &Compiled) -> usize {
    compiled.findings().iter().filter(|finding| finding.severity == FoundSeverity::Error).count()
}

/// The fixes of a round, and what tells them from others.
fn chosen(
    compiled: &Compiled,
    texts: &[Text],
    with_unsafe: bool,
    at_once: usize,
    refused: &BTreeSet<String>,
) -> (Patch, Vec<String>) {
    let (mut patch, mut taken) = (Patch::default(), Vec::new());
    for finding in compiled.findings() {
        let mut fixes = finding.fixes.iter();
        // Several fixes of a finding are alternatives.
        let allowed = fixes.find(|fix| with_unsafe || fix.applicability == Applicability::Safe);
        let Some(fix) = allowed else { continue };
        let is_own = |file: &str| texts.iter().any(|text| text.name == file);
        let key = format!("{} {} {:x} {}", finding.region.file, finding.code.id, finding.fingerprint, fix.title);
        let may = fix.edits.iter().all(|edit| is_own(&edit.region.file)) && !refused.contains(&key);
        if taken.len() < at_once && may && patch.add(fix) {
            taken.push(key);
        }
    }
    (patch, taken)
}
