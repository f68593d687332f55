//! Runs a stage with many rows of inputs, and finds one row that makes a number that is not finite.
//!
//! *In:* a stand, inputs. *Out:* the places at which such numbers were born, and a row for each. *Holds:* rows are halved until one is left,
//! and its numbers are made plain as long as the place stays.

use super::inputs::Inputs;
use super::samples::{Others, rows};
use super::stand::{POINTS, Stand};
use super::{Place, place};
use crate::cli::guard;
use crate::scene::Scene;
use glisten_reference::RenderOptions;
use glisten_reference::stability::trace;
use std::collections::BTreeSet;

/// The most draws of a trial.
pub(super) const DRAWS: usize = 16;
/// The plain numbers that are tried for each number of a row.
const PLAIN: [f32; 4] = [0.0, 1.0, -1.0, 0.5];
/// The most runs that make a row plain.
const MOST_RUNS: usize = 48;

/// A trial that was run.
pub(super) struct Trial<'a> {
    stand: &'a Stand,
    inputs: &'a Inputs,
    others: Others,
    rows: Vec<Vec<Vec<f32>>>,
    born: BTreeSet<Place>,
}

impl<'a> Trial<'a> {
    /// Runs all rows; nothing if the reference cannot.
    pub(super) fn run(stand: &'a Stand, inputs: &'a Inputs, (others, draws): (Others, usize)) -> Option<Self> {
        let rows: Vec<Vec<Vec<f32>>> = (0..draws).map(|draw| rows(inputs, others, draw, POINTS)).collect();
        let mut trial = Self { stand, inputs, others, rows, born: BTreeSet::new() };
        let all: Vec<Vec<&[f32]>> = trial.rows.iter().map(|rows| rows.iter().map(Vec::as_slice).collect()).collect();
        let born = trial.births(&all)?;
        trial.born = born;
        Some(trial)
    }

    /// The places at which numbers that are not finite were born.
    pub(super) fn places(&self) -> impl Iterator<Item = Place> {
        self.born.iter().cloned()
    }

    /// Those of some rows, draw by draw.
    fn births(&self, draws: &[Vec<&[f32]>]) -> Option<BTreeSet<Place>> {
        let draws = draws.iter().filter_map(|rows| self.stand.draw(self.inputs, rows)).collect();
        let scene = Scene { draws, ..self.stand.scene.clone() };
        let options = RenderOptions { mark_edges: false, ..RenderOptions::default() };
        let traced = guard::guarded(|| trace(&scene, &options)).ok()?.ok()?;
        let born = traced.spans.iter().filter(|span| span.births > 0);
        Some(born.filter_map(|span| place(&self.stand.sources, span.span)).collect())
    }

    fn shows(&self, draws: &[Vec<&[f32]>], at: &Place) -> bool {
        self.births(draws).is_some_and(|born| born.contains(at))
    }

    /// A row of inputs for which a number is born at a place.
    pub(super) fn row_of(&self, at: &Place) -> Option<Vec<f32>> {
        if !self.born.contains(at) {
            return None;
        }
        let mut draws: Vec<Vec<&[f32]>> =
            self.rows.iter().map(|rows| rows.iter().map(Vec::as_slice).collect()).collect();
        while draws.len() > 1 {
            let rest = draws.split_off(draws.len() / 2);
            if !self.shows(&draws, at) {
                draws = rest;
            }
        }
        let mut rows = draws.pop()?;
        while rows.len() > 1 {
            let rest = rows.split_off(rows.len() / 2);
            if !self.shows(&[rows.clone()], at) {
                rows = rest;
            }
        }
        let row = rows.pop()?.to_vec();
        self.shows(&[vec![row.as_slice()]], at).then(|| self.plain(row, at))
    }

    /// The row with plain numbers where they show the same. What is stated about inputs holds for them, too.
    fn plain(&self, mut row: Vec<f32>, at: &Place) -> Vec<f32> {
        let mut runs = 0;
        let mut start = 0;
        for input in &self.inputs.all {
            let own = start..start + input.size();
            start = own.end;
            let is_free = input.stated.is_none() && self.others == Others::Any;
            if !is_free || input.size() > 4 {
                continue;
            }
            let mut candidates: Vec<Vec<f32>> = PLAIN.iter().map(|number| vec![*number; input.size()]).collect();
            let rounded = |digits: f32| {
                row.get(own.clone()).map(|own| own.iter().map(|n| (n * digits).round() / digits).collect())
            };
            candidates.extend([10.0, 100.0, 1000.0].into_iter().filter_map(rounded));
            for candidate in candidates {
                runs += 1;
                if runs > MOST_RUNS {
                    return row;
                }
                let mut changed = row.clone();
                changed.splice(own.clone(), candidate);
                if changed == row || self.shows(&[vec![changed.as_slice()]], at) {
                    row = changed;
                    break;
                }
            }
        }
        row
    }
}
