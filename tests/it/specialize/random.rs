//! Random programs by random scenes: specialized, they draw the same bytes.
//!
//! `RANDOM_PROGRAMS=0..10000 cargo test --test it -- specialize::random` runs ten thousand. A program that fails is shrunk: lines
//! and whole bodies go as long as it still fails.

use super::difference;
use crate::random::{scene, seeds, text};
use glisten::specialize::specialize_scene;
use glisten_front::source::SourceMap;
use glisten_verify::specialize::{Contract, Math, specialize_scene_by};

/// Seeds of programs that were once specialized wrongly: initializers of globals that assign to others, and a loop that was
/// written out although a `continue` in it was open, an argument that does something for a call that does nothing.
const ONCE_WRONG: [u64; 5] = [101, 103, 152, 1177, 3052];

/// What is wrong with a program, if anything.
fn fault(fragment: &str, dynamic: &[String]) -> Option<String> {
    let scene = scene(fragment).ok()?;
    let specialized = specialize_scene(&scene, &SourceMap::default(), dynamic);
    if let Some(fault) = specialized.draws.iter().find_map(|draw| draw.fault.clone()) {
        return Some(format!("does not read back: {fault}"));
    }
    difference(&scene, &specialized)
}

/// The program without what its fault does not need.
fn shrunk(fragment: &str, dynamic: &[String]) -> String {
    let mut lines: Vec<String> = fragment.lines().map(str::to_owned).collect();
    let mut width = (lines.len() / 2).max(1);
    loop {
        let mut place = 0;
        let mut changed = false;
        while place < lines.len() {
            let mut candidate = lines.clone();
            candidate.drain(place..(place + width).min(candidate.len()));
            if fault(&candidate.join("\n"), dynamic).is_some() {
                lines = candidate;
                changed = true;
            } else {
                place += width;
            }
        }
        match (width, changed) {
            (1, false) => return lines.join("\n"),
            (1, true) => {}
            _ => width /= 2,
        }
    }
}

#[test]
fn random_programs_draw_the_same_bytes() {
    let mut wrong = Vec::new();
    for seed in seeds().chain(ONCE_WRONG) {
        let fragment = text::fragment(seed);
        // What the scene fixes is another part of the block for each seed.
        let names = ["Block.w", "Block.x", "Block.y"];
        let dynamic: Vec<String> = names
            .iter()
            .enumerate()
            .filter(|(bit, _)| seed >> bit & 1 == 1)
            .map(|(_, name)| (*name).to_owned())
            .collect();
        if fault(&fragment, &dynamic).is_some() {
            let small = shrunk(&fragment, &dynamic);
            let what = fault(&small, &dynamic).unwrap_or_default();
            wrong.push(format!("seed {seed}, dynamic {dynamic:?}:\n{small}\n{what}"));
            if wrong.len() >= 3 {
                break;
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n\n"));
}

/// Fast math and moves change numbers, but what is left is always a program, and it is drawn.
#[test]
fn random_programs_read_back_under_contracts_that_change_rounding() {
    let contract = Contract { math: Math::Fast, move_to_vertex: true };
    let mut wrong = Vec::new();
    for seed in seeds() {
        let fragment = text::fragment(seed);
        let Ok(scene) = scene(&fragment) else { continue };
        let specialized = specialize_scene_by(contract, &scene, &SourceMap::default(), &[]);
        for draw in &specialized.draws {
            wrong.extend(draw.fault.as_ref().map(|fault| format!("seed {seed}: {fault}")));
        }
        if super::bits(&scene).is_ok() && super::bits(&specialized.scene).is_err() {
            wrong.push(format!("seed {seed}: the residual cannot be drawn"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n\n"));
}
