//! Runs a stage with many rows of inputs, and finds one row that makes a number that is not finite.
//!
//! *In:* a stand, inputs. *Out:* the places at which such numbers were born, and a row for each. *Holds:* the runs end when all places that
//! are looked for were seen. The rows of a draw are halved until one is left, and its numbers are made plain as long as the place stays.

use super::inputs::Inputs;
use super::samples::{Others, rows};
use super::stand::{POINTS, Stand};
use super::{Place, place};
use crate::process::guard;
use crate::trace;
use glisten_reference::RenderOptions;
use glisten_reference::stability::births;
use glisten_verify::scene::Scene;
use std::collections::{BTreeMap, BTreeSet};
use std::time::{Duration, Instant};

/// The most draws of a trial.
pub(super) const DRAWS: usize = 16;
/// The draws after which a trial looks whether it has seen enough.
const STEPS: [usize; 3] = [1, 4, DRAWS];
/// The plain numbers that are tried for each number of a row.
const PLAIN: [f32; 4] = [0.0, 1.0, -1.0, 0.5];
/// The most runs that make a row plain.
const MOST_RUNS: usize = 16;
/// How long the runs that make rows plain may take for a stage. Longer ones are told as they are.
const MOST_TIME: Duration = Duration::from_secs(2);

/// A trial that was run.
pub(super) struct Trial<'a> {
    stand: &'a Stand,
    inputs: &'a Inputs,
    others: Others,
    rows: Vec<Vec<Vec<f32>>>,
    /// The places at which numbers were born, each with the first draw that shows it.
    born: BTreeMap<Place, usize>,
    start: Instant,
}

/// The rows of a draw.
type Rows<'r> = Vec<&'r [f32]>;

impl<'a> Trial<'a> {
    /// Runs rows until all places that are `wanted` were seen, all rows if nothing is said; nothing if the reference cannot.
    pub(super) fn run(
        stand: &'a Stand,
        inputs: &'a Inputs,
        (others, draws): (Others, usize),
        wanted: Option<&BTreeSet<Place>>,
    ) -> Option<Self> {
        let start = Instant::now();
        let mut trial = Self { stand, inputs, others, rows: Vec::new(), born: BTreeMap::new(), start };
        for step in STEPS.map(|step| if wanted.is_some() { step } else { DRAWS }) {
            let first = trial.rows.len();
            let more: Vec<Vec<Vec<f32>>> =
                (first..step.min(draws)).map(|draw| rows(inputs, others, draw, POINTS)).collect();
            if more.is_empty() {
                break;
            }
            let all: Vec<Rows<'_>> = more.iter().map(|rows| rows.iter().map(Vec::as_slice).collect()).collect();
            for (draw, at) in trial.births(&all)? {
                trial.born.entry(at).or_insert(first + draw);
            }
            trial.rows.extend(more);
            if wanted.is_some_and(|wanted| wanted.iter().all(|at| trial.born.contains_key(at))) {
                break;
            }
        }
        Some(trial)
    }

    /// The places at which numbers that are not finite were born.
    pub(super) fn places(&self) -> impl Iterator<Item = Place> {
        self.born.keys().cloned()
    }

    /// Those of some rows, each with its draw, in the order of the draws.
    fn births(&self, draws: &[Rows<'_>]) -> Option<BTreeSet<(usize, Place)>> {
        let draws = draws.iter().map(|rows| self.stand.draw(self.inputs, rows)).collect::<Option<_>>()?;
        let scene = Scene { draws, ..self.stand.scene.clone() };
        let options = RenderOptions { mark_edges: false, ..RenderOptions::default() };
        let born = guard::guarded(|| births(&scene, &options)).ok()?.ok()?;
        let at = |(draw, span)| Some((draw, place(&self.stand.sources, span)?));
        Some(born.into_iter().filter_map(at).collect())
    }

    /// The first of some draws in which a number is born at a place.
    fn first_that_shows(&self, draws: &[Rows<'_>], at: &Place) -> Option<usize> {
        self.births(draws)?.into_iter().find(|(_, place)| place == at).map(|(draw, _)| draw)
    }

    /// A row of inputs for which a number is born at a place.
    pub(super) fn row_of(&self, at: &Place) -> Option<Vec<f32>> {
        let rows = self.rows.get(*self.born.get(at)?)?;
        let mut rows: Rows<'_> = rows.iter().map(Vec::as_slice).collect();
        // The rows of a draw have the same uniforms, so each part of them is a draw, too.
        while rows.len() > 1 {
            let parts: Vec<Rows<'_>> = rows.chunks(rows.len().div_ceil(8)).map(<[_]>::to_vec).collect();
            let first = self.first_that_shows(&parts, at)?;
            rows = parts.into_iter().nth(first)?;
        }
        Some(self.plain(rows.pop()?.to_vec(), at))
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
            let mut values: Vec<Vec<f32>> = PLAIN.iter().map(|number| vec![*number; input.size()]).collect();
            let rounded = |digits: f32| {
                row.get(own.clone()).map(|own| own.iter().map(|n| (n * digits).round() / digits).collect())
            };
            values.extend([10.0, 100.0, 1000.0].into_iter().filter_map(rounded));
            let candidates: Vec<Vec<f32>> = values
                .into_iter()
                .map(|value| {
                    let mut changed = row.clone();
                    changed.splice(own.clone(), value);
                    changed
                })
                .take_while(|changed| *changed != row)
                .collect();
            if candidates.is_empty() {
                continue;
            }
            runs += 1;
            if runs > MOST_RUNS {
                return row;
            }
            if self.start.elapsed() > MOST_TIME {
                // On another machine, the numbers would be plainer.
                trace::beyond();
                return row;
            }
            // Each candidate is a draw of one row.
            let draws: Vec<Rows<'_>> = candidates.iter().map(|row| vec![row.as_slice()]).collect();
            if let Some(changed) = self.first_that_shows(&draws, at).and_then(|draw| candidates.get(draw)) {
                row.clone_from(changed);
            }
        }
        row
    }
}
