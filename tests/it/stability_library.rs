//! `glisten stability --library`, from outside: every function of the library holds the bound that is next to it.

use crate::support::root;
use serde_json::Value;
use std::collections::BTreeSet;
use std::process::Command;

fn output(arguments: &[&str]) -> (Option<i32>, String, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_glisten"))
        .args(["stability"])
        .args(arguments)
        .current_dir(root())
        .output()
        .expect("the program runs");
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    (output.status.code(), text(&output.stdout), text(&output.stderr))
}

fn functions(arguments: &[&str]) -> (Option<i32>, Vec<Value>) {
    let arguments: Vec<&str> = arguments.iter().copied().chain(["--format", "json"]).collect();
    let (code, text, errors) = output(&arguments);
    let value: Value = serde_json::from_str(&text).unwrap_or_else(|error| panic!("{error}: {text}{errors}"));
    (code, value["functions"].as_array().expect("a list").clone())
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is not a number"))
}

#[test]
fn every_function_holds_its_bound_and_every_naive_form_is_told() {
    let (code, found) = functions(&["--library"]);
    let wrong: Vec<String> = found
        .iter()
        .filter(|function| {
            let bound = &function["bound"];
            let reason = bound["reason"].as_str().unwrap_or_default();
            function["verdict"] == "broken"
                || bound.is_null()
                || number(&function["unexplained"]) > number(&bound["error"])
                || (function["verdict"] == "degraded" && reason.is_empty())
        })
        .map(ToString::to_string)
        .collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert_eq!(code, Some(0));
    let is_program = |function: &&Value| function["module"] == "standard";
    let judged = found.iter().filter(|function| !is_program(function));
    let judged: BTreeSet<String> =
        judged.map(|function| function["signature"].as_str().unwrap_or_default().to_owned()).collect();
    let forms = glisten_verify::measure::forms().filter(|form| form.module != "naive");
    let expected: BTreeSet<String> = forms.map(|form| form.signature.to_owned()).collect();
    assert_eq!(judged, expected, "every function is called");
    let programs: Vec<&Value> = found.iter().filter(is_program).collect();
    assert!(programs.len() >= 12, "the scenes of the standard programs: {programs:?}");
    for program in programs {
        assert!(number(&program["cases"]) >= 16.0 && number(&program["max_abs"]) > 0.0, "it is drawn: {program}");
        assert!(program["at"]["pixel"].is_array(), "{program}");
    }
}

#[test]
fn the_naive_forms_show_what_the_stable_ones_avoid() {
    let (_, found) = functions(&["--library=phongFactor", "--cases", "1024"]);
    let [phong] = found.as_slice() else { panic!("one function: {found:?}") };
    let (ours, naive) = (number(&phong["unexplained"]), number(&phong["naive"]["unexplained"]));
    assert!(naive > 1e-3 && ours < 1e-6, "the power of a rounded cosine: {naive} against {ours}");
    assert_eq!(phong["naive"]["form"], "naivePhong(N, L, V, shininess)");
    assert!(number(&phong["cost"]) > 1.0, "stability has a price: {phong}");
    let (_, found) = functions(&["--library=thresholdStep", "--cases", "512"]);
    assert_eq!(found[0]["naive"]["range"], serde_json::json!([-1.0, 1.0]), "(91) as printed gives -1");
    let (_, found) = functions(&["--library=safeNormalize", "--cases", "512"]);
    assert_eq!(found[0]["naive"]["verdict"], "broken", "{found:?}");
    assert!(number(&found[0]["naive"]["non_finite"]) > 0.0);
    let (_, found) = functions(&["--library=halfVector", "--cases", "512"]);
    assert!(number(&found[0]["naive"]["undefined"]) > 0.0, "L = -V is among the inputs: {found:?}");
}

#[test]
fn figures_are_the_same_on_every_run() {
    let run = || output(&["--library=schlick", "--cases", "256", "--format", "json"]).1;
    assert_eq!(run(), run());
}

#[test]
fn what_is_not_in_the_library_is_an_error() {
    let (code, _, errors) = output(&["--library=nosuch"]);
    assert_eq!(code, Some(2), "{errors}");
    assert!(errors.contains("no `nosuch`"), "{errors}");
    let (code, _, _) = output(&["--library", "scene.toml"]);
    assert_eq!(code, Some(2), "a scene and the library at once");
}

/// A table for people: the verdicts, the naive forms, and the meaning of the columns.
#[test]
fn the_table_names_each_function() {
    let (code, text, _) = output(&["--library=attenuation", "--cases", "64"]);
    assert_eq!(code, Some(0), "{text}");
    for word in ["lightDistance", "attenuationInverseSquare", "stable", "condition", "naive", "cost"] {
        assert!(text.contains(word), "{word}: {text}");
    }
}
