//! [`Figures`]: how exact the functions are that a scene shows, and what a fragment of it costs.
//!
//! *In:* an entry. *Out:* for each function that it shows, the error that `glisten lib measure` finds and the bound
//! that its comment states; and the operations of its dearest fragment, as `glisten cost` counts them. *Holds:* the same figures on every
//! run. Functions that read uniforms have no error of their own.

use super::entry::{Entry, source};
use glisten_cost::{Assumptions, Counts, Ranges, cost};
use glisten_front::hir::ScalarValue;
use glisten_front::source::SourceMap;
use glisten_library::{FunctionEntry, Module};
use glisten_reference::Precision;
use glisten_scene::values::{LeafShape, of_leaf};
use glisten_specialize::optimize;
use glisten_verify::measure::{Form, Trial, forms};
use glisten_verify::scene::{Draw, Scene};

/// The number of inputs of each function.
pub(super) const ROWS: usize = 1024;

/// A function that a scene shows.
#[derive(Clone, Debug)]
pub(super) struct Shown {
    pub(super) name: String,
    /// The largest error in f32, relative to the scale of the result.
    pub(super) error: f64,
    /// The bound for stiff and extreme inputs, with its unit.
    pub(super) bound: String,
    /// The weight of a call.
    pub(super) weight: u32,
}

/// The figures of a scene.
#[derive(Clone, Debug)]
pub(super) struct Figures {
    /// The functions, the least exact one first.
    pub(super) functions: Vec<Shown>,
    /// The operations of the longest path of the dearest fragment stage.
    pub(super) fragment: Counts,
}

impl Figures {
    pub(super) fn of(entry: &Entry) -> Result<Self, String> {
        let mut functions = Vec::new();
        for (function, form) in called(entry) {
            functions.push(shown(&function, form).map_err(|error| format!("the scene `{}`: {error}", entry.name))?);
        }
        functions.sort_by(|a, b| b.error.total_cmp(&a.error));
        Ok(Self { functions, fragment: dearest(entry.scene()) })
    }
}

/// The functions of an entry's modules that the other texts call by name which it shows.
fn called(entry: &Entry) -> Vec<(FunctionEntry, &'static Form)> {
    let texts: Vec<(&str, &str)> =
        entry.meta.sources.iter().filter_map(|name| Some((name.as_str(), source(name)?))).collect();
    let mut found = Vec::new();
    for (own, _) in &texts {
        let Some(module) = own.strip_suffix(".glsl").and_then(module) else { continue };
        for function in glisten_library::entry(module).functions {
            let is_called = texts.iter().any(|(name, text)| name != own && calls(text, &function.name));
            let is_form = |form: &&Form| form.module == module.name && form.signature == function.signature;
            found.extend(forms().find(is_form).filter(|_| is_called).map(|form| (function, form)));
        }
    }
    found
}

/// The module of a name.
fn module(name: &str) -> Option<&'static Module> {
    glisten_library::modules().iter().find(|module| module.name == name)
}

/// Whether a text calls a function.
fn calls(text: &str, name: &str) -> bool {
    let is_word = |letter: char| letter.is_ascii_alphanumeric() || letter == '_';
    text.match_indices(name).any(|(at, _)| {
        let before = text.get(..at).and_then(|before| before.chars().next_back());
        let after = text.get(at + name.len()..).unwrap_or_default();
        !before.is_some_and(is_word) && after.starts_with('(')
    })
}

fn shown(function: &FunctionEntry, form: &'static Form) -> Result<Shown, String> {
    let trial = Trial::new(form, ROWS).map_err(|error| error.to_string())?;
    let figures = trial.reference(Precision::F32).map_err(|error| error.to_string())?;
    let bound = function.bound.as_deref().unwrap_or_default();
    let bound = bound.split(',').next().unwrap_or_default().to_owned();
    Ok(Shown { name: function.name.clone(), error: figures.error, bound, weight: function.cost.weight() })
}

/// The longest path of the draw's fragment stage that has the most weight.
fn dearest(scene: &Scene) -> Counts {
    scene.draws.iter().map(of_draw).max_by_key(Counts::weight).unwrap_or_default()
}

fn of_draw(draw: &Draw) -> Counts {
    let assumptions = Assumptions { ranges: ranges(draw), ..Assumptions::default() };
    let cost = cost(&optimize(&draw.program), &SourceMap::default(), &assumptions);
    let fragment = cost.stages.iter().find(|stage| stage.stage == "fragment");
    fragment.map_or_else(Counts::default, |stage| stage.longest)
}

/// The values of a draw's uniforms, as ranges.
pub fn ranges(draw: &Draw) -> Ranges {
    let mut ranges = Ranges::default();
    for leaf in &draw.program.interface.uniforms {
        let Some(shape) = LeafShape::of(&draw.program.types, leaf) else { continue };
        for value in of_leaf(&draw.uniforms, leaf, shape) {
            let number = match *value {
                ScalarValue::Bool(value) => f64::from(u8::from(value)),
                ScalarValue::Int(value) => f64::from(value),
                ScalarValue::Uint(value) => f64::from(value),
                ScalarValue::Float(value) => f64::from(value),
            };
            ranges.add(&leaf.name, [number, number]);
        }
    }
    ranges
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gallery::entries;

    #[test]
    fn a_call_is_a_whole_name_before_a_parenthesis() {
        assert!(calls("x = ggx(N);", "ggx"));
        for text in ["x = ggxFactor(N);", "x = myggx(N);", "ggx", "// ggx, (85)"] {
            assert!(!calls(text, "ggx"), "{text}");
        }
    }

    /// The figures are those that the measure gives, and every scene of today has some.
    #[test]
    fn every_scene_of_today_has_figures() {
        let entries = entries().expect("the library's scenes are good");
        let today: Vec<_> = entries.iter().filter(|entry| entry.meta.chapter == "today").collect();
        assert!(today.len() > 12, "{}", today.len());
        for entry in today {
            let figures = Figures::of(entry).expect("its functions can be measured");
            assert!(figures.fragment.weight() > 10, "{}: {:?}", entry.name, figures.fragment);
            assert!(!figures.functions.is_empty(), "{}", entry.name);
            for shown in &figures.functions {
                assert!(shown.error.is_finite() && !shown.bound.is_empty(), "{}: {shown:?}", entry.name);
            }
        }
        let dial = entries.iter().find(|entry| entry.name == "dial").expect("it is there");
        let figures = Figures::of(dial).expect("its functions can be measured");
        let names: Vec<&str> = figures.functions.iter().map(|shown| shown.name.as_str()).collect();
        for name in ["sdfCircle", "sdfSegment", "sdfBlend", "sdfCoverage"] {
            assert!(names.contains(&name), "{name}: {names:?}");
        }
    }
}
