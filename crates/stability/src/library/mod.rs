//! Every function of the library over its stiff and extreme inputs.
//!
//! *In:* the functions of all modules, with the bounds that their comments state. *Out:* a [`FunctionFound`] for each: the
//! error of a GPU's f32, what explains it, and the same for the naive form.
//!
//! ```text
//!  form ──► inputs   a few thousand calls: ordinary ones, and those at which the model is stiff
//!       ──► calls    the calls in f32, f64 and 192 bits, and in f64 with the inputs moved by an ULP
//!       ──► compare  the error beyond what moving the inputs explains, against the bound
//! ```
//!
//! *Holds:* inputs and figures are the same on every run. The literal transcriptions (module `naive`) are not judged: they
//! are what the others are compared with. Functions that read uniforms are those of the standard programs, which are drawn with
//! the values of scenes.

mod bound;
mod calls;
mod compare;
mod drawn;
mod inputs;
mod literal;

pub use bound::{Bound, BoundUnit, ROUNDING};
pub use compare::{Figures, Naive};

use calls::{Calls, extreme_inputs, stiff_inputs};
use compare::{compare, compare_naive};
use glisten_library::{Entry, FunctionEntry, entries};
use glisten_verify::evaluate::EvaluateError;
use glisten_verify::measure::{Form, forms};
use serde::Serialize;
use std::collections::BTreeMap;

/// The verdict over a function.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Verdict {
    /// The error is rounding: at most [`ROUNDING`] beyond what the inputs explain.
    Stable,
    /// It is more than rounding.
    Degraded,
    /// A result is not finite for finite inputs, or is another one altogether: f32 takes a decision the other way, and the
    /// exact result does not jump there.
    Broken,
}

/// The findings about a function.
#[derive(Clone, Debug, Serialize)]
pub struct FunctionFound {
    /// The module.
    pub module: &'static str,
    /// The name.
    pub function: String,
    /// The name and the types of the parameters, which tell overloads apart.
    pub signature: String,
    /// The number of calls.
    pub cases: usize,
    /// The verdict.
    pub verdict: Verdict,
    /// The figures.
    #[serde(flatten)]
    pub figures: Figures,
    /// The bound that is next to the function.
    pub bound: Option<Bound>,
    /// Whether the error is within that bound.
    pub within_bound: bool,
    /// The arguments with the largest error, by name.
    pub at: BTreeMap<String, Vec<f64>>,
    /// The naive form, if it differs.
    pub naive: Option<Naive>,
    /// The operations that the function executes, as a multiple of the naive form's.
    pub cost: Option<f64>,
}

impl FunctionFound {
    /// Whether the function is as its comment promises.
    pub fn is_sound(&self) -> bool {
        self.verdict != Verdict::Broken && self.within_bound && self.bound.is_some()
    }
}

/// How to examine the library.
pub struct LibraryOptions<'a> {
    /// The number of calls of each function.
    pub cases: usize,
    /// Only functions and programs of this module, or of this name.
    pub only: Option<&'a str>,
    /// Called before each function with the number of those done and of all, and its name.
    pub progress: &'a mut dyn FnMut(usize, usize, &str),
}

/// Calls every function of the library with stiff and extreme inputs.
///
/// # Errors
/// A function cannot be called, or its bound cannot be read.
pub fn examine_library(options: &mut LibraryOptions<'_>) -> Result<Vec<FunctionFound>, EvaluateError> {
    let entries = entries();
    let judged: Vec<(&Entry, &FunctionEntry)> = entries
        .iter()
        .filter(|entry| entry.header.kind != "reference")
        .flat_map(|entry| entry.functions.iter().map(move |function| (entry, function)))
        .filter(|(entry, function)| options.only.is_none_or(|only| only == entry.module.name || only == function.name))
        .collect();
    let with_forms: Vec<(&FunctionEntry, &'static Form)> = judged
        .iter()
        .filter_map(|(entry, function)| {
            let is_form = |form: &&Form| form.module == entry.module.name && form.signature == function.signature;
            Some((*function, forms().find(is_form)?))
        })
        .collect();
    let programs = drawn::standard_programs(options.only);
    let (functions, total) = (with_forms.len(), with_forms.len() + programs.len());
    let mut found = Vec::new();
    for (done, (function, form)) in with_forms.into_iter().enumerate() {
        (options.progress)(done, total, &function.signature);
        found.push(examine_function(function, form, options.cases)?);
    }
    for (done, program) in programs.iter().enumerate() {
        (options.progress)(functions + done, total, &program.signature());
        found.push(program.examine(options.cases)?);
    }
    Ok(found)
}

fn examine_function(
    function: &FunctionEntry,
    form: &'static Form,
    cases: usize,
) -> Result<FunctionFound, EvaluateError> {
    let include = format!("#include <glisten/{}.glsl>\n", form.module);
    let calls = Calls::new(&include, form.signature, &form.wraps())?;
    let rows = if calls.width() == 0 { 1 } else { cases };
    let inputs = stiff_inputs(form, rows);
    let bound = match function.bound.as_deref().map(Bound::parse) {
        None => None,
        Some(Ok(bound)) => Some(bound),
        Some(Err(message)) => return Err(EvaluateError::new(format!("{}: {message}", form.signature))),
    };
    let raw = Calls::new(&include, form.signature, &[])?;
    let mut figures = compare(form, [&calls, &raw], &inputs, bound.as_ref())?;
    let extreme = extreme_inputs(raw.width(), if raw.width() == 0 { 1 } else { rows.div_ceil(4) });
    figures.count_non_finite(&raw, &extreme)?;
    let naive = match literal::literal(form.signature) {
        Some(body) => Some(naive_of(function, form, body, &inputs, &calls, bound.as_ref())?),
        None => None,
    };
    let least = bound.as_ref().map_or(0.0, |bound| bound.error);
    Ok(FunctionFound {
        module: form.module,
        function: function.name.clone(),
        signature: function.signature.clone(),
        cases: rows + extreme.len().checked_div(raw.width()).unwrap_or(0),
        verdict: figures.verdict(),
        within_bound: figures.unexplained <= least,
        at: figures.arguments(&function.declaration),
        figures,
        bound,
        cost: naive.as_ref().and_then(|naive| naive.ratio),
        naive,
    })
}

/// The parameters of a declaration, with their types and names.
fn parameters(declaration: &str) -> &str {
    declaration.split_once('(').map_or("", |(_, parameters)| parameters.trim_end_matches(')'))
}

fn naive_of(
    function: &FunctionEntry,
    form: &Form,
    body: &str,
    inputs: &[f32],
    stable: &Calls,
    bound: Option<&Bound>,
) -> Result<Naive, EvaluateError> {
    let returns = function.declaration.split(' ').next().unwrap_or("float");
    let types = form.signature.split_once('(').map_or(")", |(_, types)| types);
    let wraps = form.wraps();
    let calls = |body: &str, wraps: &[(usize, &str)]| {
        let text = format!(
            "#include <glisten/naive.glsl>\n#include <glisten/{}.glsl>\n{returns} literalForm({}) {{ return {body}; }}\n",
            form.module,
            parameters(&function.declaration)
        );
        Calls::new(&text, &format!("literalForm({types}"), wraps)
    };
    let (naive, raw, nothing) = (calls(body, &wraps)?, calls(body, &[])?, calls(&format!("{returns}(0.0)"), &wraps)?);
    let mut found = compare_naive(form, [&naive, &raw], inputs, bound, body)?;
    found.at = found.figures.arguments(&function.declaration);
    found.count_operations([stable, &naive, &nothing], inputs)?;
    Ok(found)
}
