//! `fixtures/library/stiff.toml`: each case with the literal equation and with the library, on the reference in f64
//! and f32 and on the GPU.

use super::function;
use crate::support::root;
use glisten::evaluate::Evaluator;
use glisten_gpu::{Gpu, Via};
use glisten_reference::Precision;
use std::fs;
use toml::{Table, Value};

/// A sum of decimals and powers of two: `1-2^-24`.
fn number(text: &str) -> f64 {
    if let Ok(number) = text.parse() {
        return number;
    }
    let bytes = text.as_bytes();
    let is_break = |at: usize| matches!(bytes[at], b'+' | b'-') && !matches!(bytes[at - 1], b'^' | b'e');
    if let Some(at) = (1..text.len()).rev().find(|at| is_break(*at)) {
        let (left, right) = (number(&text[..at]), number(&text[at + 1..]));
        return if bytes[at] == b'-' { left - right } else { left + right };
    }
    let exponent = text.strip_prefix("2^").unwrap_or_else(|| panic!("`{text}` is no number"));
    exponent.parse::<f64>().unwrap_or_else(|_| panic!("`{text}` is no number")).exp2()
}

fn numbers(value: &Value) -> Vec<f64> {
    let list = value.as_array().expect("a list of numbers");
    list.iter().map(|number_text| number(number_text.as_str().expect("numbers are text"))).collect()
}

/// A case: the expected results of the literal equation and of the library.
struct Case {
    title: String,
    letter: Evaluator,
    letter_inputs: Vec<f32>,
    letter_value: Vec<f64>,
    stable: Evaluator,
    stable_inputs: Vec<f32>,
    stable_value: Vec<f64>,
    flushed: Option<Vec<f64>>,
}

impl Case {
    fn new(table: &Table) -> Self {
        let text = |table: &Table, key: &str| table[key].as_str().expect("a text").to_owned();
        let title = format!("{} {}", table["number"], text(table, "title"));
        let (letter, stable) = (&table["letter"], &table["stable"]);
        let (letter, stable) = (letter.as_table().expect("a table"), stable.as_table().expect("a table"));
        let called = |module: &str, call: &Table| {
            let wrap = call.get("wrap").and_then(Value::as_str);
            let wraps: Vec<(usize, &str)> = wrap.into_iter().map(|wrap| (0, wrap)).collect();
            // The plain `normalize` is always available; the library's own comes with each module.
            function(module, &text(call, "function"), &wraps)
        };
        let floats = |numbers: Vec<f64>| numbers.into_iter().map(|number| number as f32).collect();
        let inputs = |call: &Table| call.get("inputs").or(letter.get("inputs")).map(numbers).expect("inputs");
        let letter_value = numbers(&letter["value"]);
        assert_eq!(table.contains_key("choice"), table.contains_key("why"), "{title}");
        Self {
            title,
            letter: called("naive", letter),
            letter_inputs: floats(inputs(letter)),
            stable: called(&text(stable, "module"), stable),
            stable_inputs: floats(inputs(stable)),
            stable_value: table.get("choice").map_or(letter_value.clone(), numbers),
            letter_value,
            flushed: table.get("flushed").map(numbers),
        }
    }

    fn stable(&self, precision: Precision) -> Vec<f64> {
        let results = self.stable.reference(&self.stable_inputs, &[], precision);
        results.unwrap_or_else(|error| panic!("{}: {error}", self.title)).remove(0)
    }

    fn drawn(&self, gpu: &Gpu) -> Vec<f64> {
        let scene = self.stable.scene(&self.stable_inputs, &[]).expect("it has a row");
        let rendered = gpu.render(&scene, Via::Spirv).unwrap_or_else(|error| panic!("{}: {error}", self.title));
        self.stable.read(&rendered.picture, 1).remove(0)
    }
}

fn cases() -> Vec<Case> {
    let path = root().join("fixtures/library/stiff.toml");
    let table: Table = fs::read_to_string(path).expect("the file is there").parse().expect("it is TOML");
    let list = table["case"].as_array().expect("a list of cases");
    list.iter().map(|case| Case::new(case.as_table().expect("a table"))).collect()
}

/// Whether each number is equal to the expected one up to the relative error `relative`, or up to the smallest normal
/// float. Further values are not stated if the case is only about the first.
fn agrees(found: &[f64], wanted: &[f64], relative: f64) -> bool {
    found.iter().zip(wanted).all(|(found, wanted)| {
        (found.is_nan() && wanted.is_nan())
            || found == wanted
            || (found - wanted).abs() <= relative * wanted.abs() + f64::from(f32::MIN_POSITIVE)
    })
}

#[test]
fn there_are_55_cases() {
    assert_eq!(cases().len(), 55);
}

#[test]
fn the_letter_gives_what_the_table_states() {
    for case in cases() {
        let results = case.letter.reference(&case.letter_inputs, &[], Precision::F64);
        let found = results.unwrap_or_else(|error| panic!("{}: {error}", case.title)).remove(0);
        assert_eq!(found.len(), case.letter_value.len(), "{}", case.title);
        // The table has nine digits.
        assert!(agrees(&found, &case.letter_value, 6e-9), "{}: {found:?}, not {:?}", case.title, case.letter_value);
    }
}

#[test]
fn the_library_is_finite_and_right_or_gives_the_choice_that_is_stated() {
    for case in cases() {
        for (precision, relative) in [(Precision::F64, 1e-8), (Precision::F32, 2e-6)] {
            let found = case.stable(precision);
            assert!(found.iter().all(|number| number.is_finite()), "{} in {precision:?}: {found:?}", case.title);
            let wanted = &case.stable_value;
            let right = agrees(&found, wanted, relative);
            assert!(right, "{} in {precision:?}: {found:?}, not {wanted:?}", case.title);
        }
    }
}

#[test]
fn the_library_is_finite_and_right_on_the_gpu() {
    let gpu = crate::drawing::gpu();
    for case in cases() {
        let found = case.drawn(&gpu);
        assert!(found.iter().all(|number| number.is_finite()), "{}: {found:?}", case.title);
        let wanted = &case.stable_value;
        let flushed = case.flushed.as_ref().is_some_and(|flushed| agrees(&found, flushed, 0.0));
        assert!(agrees(&found, wanted, 2e-5) || flushed, "{}: {found:?}, not {wanted:?}", case.title);
    }
}
