//! The programs of a scene in another language, and which of its lines come from which of the source's.
//!
//! *In:* programs, and the texts that they were read from. *Out:* JSON. *Holds:* a line of WGSL that begins a statement or a function knows
//! the lines of the source that this is on; the numbers of files are those of the answer's `files`.

use super::criteria::{Criteria, told};
use glisten_emit::{Conventions, Emitted, Origin, Target, Traced, emit_traced, reflect};
use glisten_front::link::Program;
use glisten_front::source::{SourceMap, Span};
use glisten_specialize::optimize;
use serde_json::{Value, json};
use std::sync::Arc;

/// Each program in the language, with its reflection.
pub(super) fn translations(
    criteria: &impl Criteria,
    sources: &SourceMap,
    programs: &[Arc<Program>],
    target: Target,
) -> Vec<Value> {
    programs.iter().map(|program| translation(criteria, sources, program, target)).collect()
}

fn translation(criteria: &impl Criteria, sources: &SourceMap, program: &Program, target: Target) -> Value {
    let conventions = Conventions::default();
    let made = criteria.guarded(|| {
        let optimized = optimize(program);
        let mut reflection = reflect(&optimized, &conventions);
        let stage = |stage| match emit_traced(&optimized, stage, target, &conventions, None) {
            Ok(Traced { emitted: Emitted::Text(text), origins }) => {
                json!({ "stage": stage.name(), "text": text, "lines": lines(sources, &origins) })
            }
            Ok(Traced { emitted: Emitted::Words(words), .. }) => {
                json!({ "stage": stage.name(), "n_words": words.len() })
            }
            Err(errors) => json!({ "stage": stage.name(), "error": told(&errors) }),
        };
        let stages: Vec<Value> = optimized.stages.iter().map(|shader| stage(shader.stage)).collect();
        reflection.compact();
        json!({ "name": program.name, "stages": stages, "reflection": reflection })
    });
    made.unwrap_or_else(
        |panic| json!({ "name": program.name, "stages": [], "error": format!("internal error: {panic}") }),
    )
}

/// For each origin: the line of the text, the number of the file, and the first and last line there.
fn lines(sources: &SourceMap, origins: &[Origin]) -> Vec<[u32; 4]> {
    let mut lines: Vec<[u32; 4]> = Vec::with_capacity(origins.len());
    for Origin { line, span } in origins {
        let Some(file) = sources.file_of(*span) else { continue };
        let Some(number) = sources.files().position(|(id, _)| id == file) else { continue };
        let of = |at: u32| sources.line(Span::new(at, at));
        let Some((from, to)) = of(span.start).zip(of(span.end.saturating_sub(1).max(span.start))) else { continue };
        let row = [*line, number as u32, from, to.max(from)];
        if lines.last() != Some(&row) {
            lines.push(row);
        }
    }
    lines
}
