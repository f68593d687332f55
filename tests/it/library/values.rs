//! Compares every function with its closed form, on the reference and on the GPU, and checks that its results are
//! finite for all inputs.

use glisten::library::modules;
use glisten_gpu::Via;
use glisten_library::{Entry, entries};
use glisten_reference::Precision;
use glisten_verify::measure::{Form, Trial, forms};
use std::collections::BTreeSet;

const ROWS: usize = 1024;

fn trial(form: &'static Form) -> Trial {
    Trial::new(form, ROWS).unwrap_or_else(|error| panic!("{}: {error}", form.signature))
}

/// Whether the form promises to be stable: the transcriptions are literal.
fn is_stable(form: &Form) -> bool {
    form.module != "naive"
}

/// Whether a module or what it includes declares uniforms.
fn reads_uniforms(entry: &Entry) -> bool {
    let included =
        entry.module.text.lines().filter_map(|line| line.strip_prefix("#include \"")?.strip_suffix(".glsl\""));
    let module = |name: &str| modules().iter().find(|module| module.name == name).map(|module| module.text);
    let texts = included.filter_map(module).chain([entry.module.text]);
    texts.into_iter().any(|text| text.lines().any(|line| line.starts_with("uniform ")))
}

#[test]
fn every_function_of_every_module_has_a_closed_form() {
    let tested: BTreeSet<(&str, &str)> = forms().map(|form| (form.module, form.signature)).collect();
    let entries = entries();
    // A function that reads uniforms depends on more than its arguments; scenes test it.
    let there: BTreeSet<(&str, &str)> = entries
        .iter()
        .filter(|entry| !reads_uniforms(entry))
        .flat_map(|entry| entry.functions.iter().map(|function| (entry.module.name, function.signature.as_str())))
        .collect();
    assert_eq!(tested, there);
    assert_eq!(tested.len(), forms().count(), "no function has two rows");
}

#[test]
fn every_function_is_its_closed_form_to_a_few_ulps_of_f64() {
    let mut wrong = Vec::new();
    for form in forms() {
        let figures =
            trial(form).reference(Precision::F64).unwrap_or_else(|error| panic!("{}: {error}", form.signature));
        let finite = figures.non_finite == 0 || !is_stable(form);
        if figures.ulps > 8.0 || figures.counted < 3 * figures.undecided || !finite {
            wrong.push(format!("{}: {figures:?}", form.signature));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// The error in f32 ULPs that a stable form may have, relative to its condition number: twice the largest that was
/// observed, that of `safeLogOneMinus` and of the fourth power.
const F32_ULPS: f64 = 8.0;

#[test]
fn every_stable_function_is_right_in_f32() {
    let mut wrong = Vec::new();
    for form in forms().filter(|form| is_stable(form)) {
        let figures =
            trial(form).reference(Precision::F32).unwrap_or_else(|error| panic!("{}: {error}", form.signature));
        if figures.ulps > F32_ULPS || figures.non_finite > 0 {
            wrong.push(format!("{}: {figures:?}", form.signature));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn every_stable_function_is_finite_for_every_finite_input() {
    let mut wrong = Vec::new();
    for form in forms().filter(|form| is_stable(form)) {
        let trial = Trial::extreme(form, 2 * ROWS).unwrap_or_else(|error| panic!("{}: {error}", form.signature));
        for precision in [Precision::F64, Precision::F32] {
            let figures = trial.reference(precision).unwrap_or_else(|error| panic!("{}: {error}", form.signature));
            if figures.non_finite > 0 {
                wrong.push(format!("{} in {precision:?}: {} of {}", form.signature, figures.non_finite, 2 * ROWS));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn every_stable_function_is_right_and_finite_on_the_gpu() {
    let gpu = crate::drawing::gpu();
    let mut wrong = Vec::new();
    for form in forms().filter(|form| is_stable(form)) {
        let ordinary = trial(form);
        let extreme = Trial::extreme(form, ROWS).unwrap_or_else(|error| panic!("{}: {error}", form.signature));
        let draw = |trial: &Trial| {
            let scene = trial.scene().expect("it has rows");
            let rendered = gpu.render(&scene, Via::Spirv).unwrap_or_else(|error| panic!("{}: {error}", form.signature));
            trial.picture(&rendered.picture)
        };
        let (figures, edges) = (draw(&ordinary), draw(&extreme));
        if figures.ulps > F32_ULPS || figures.non_finite > 0 || edges.non_finite > 0 {
            wrong.push(format!("{}: {figures:?}, at the edges {edges:?}", form.signature));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
