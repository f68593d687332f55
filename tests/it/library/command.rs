//! `glisten lib`, end to end.

use crate::emit::missing;
use crate::support::root;
use serde_json::Value;
use std::fs;
use std::process::{Command, Output, Stdio};

pub(super) fn run(arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_glisten"));
    command.arg("lib").args(arguments).env("NO_COLOR", "1").stdin(Stdio::null()).output().expect("the program runs")
}

pub(super) fn out(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned()
}

pub(super) fn err(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

#[test]
fn list_names_all_modules() {
    let output = run(&["list"]);
    assert_eq!(output.status.code(), Some(0), "{}", err(&output));
    let text = out(&output);
    for module in glisten::library::modules() {
        assert!(text.lines().any(|line| line.starts_with(&format!("{} ", module.name))), "{}:\n{text}", module.name);
    }
    let output = run(&["list", "--format", "json"]);
    let list: Value = serde_json::from_str(&out(&output)).expect("it is JSON");
    let list = list.as_array().expect("a list");
    assert_eq!(list.len(), glisten::library::modules().len());
    for module in list {
        for key in ["name", "kind", "equation", "source", "stability"] {
            assert!(module[key].as_str().is_some_and(|text| !text.is_empty()), "{key} of {module}");
        }
        assert!(module["functions"].as_array().is_some_and(|functions| functions.iter().all(Value::is_string)));
        assert!(module["cost"]["arithmetic"].is_u64() || module["kind"] == "interface", "{module}");
    }
    let phong = list.iter().find(|module| module["name"] == "phong").expect("it is there");
    assert_eq!(phong["functions"], serde_json::json!(["mirrorDirection", "phongFactor", "phong"]));
}

#[test]
fn show_documents_a_module_and_what_it_costs() {
    let output = run(&["show", "blinn_phong"]);
    assert_eq!(output.status.code(), Some(0), "{}", err(&output));
    let text = out(&output);
    for part in [
        "(89)",
        "section 10.1.3",
        "<glisten/blinn_phong.glsl>",
        "float blinnPhongFactor(vec3 N, vec3 L",
        "Cost: ",
        "ULP",
    ] {
        assert!(text.contains(part), "`{part}` is not in\n{text}");
    }
    // By a function's name, as a file's name, as text, as JSON.
    assert_eq!(out(&run(&["show", "blinnPhongFactor"])), text);
    assert_eq!(out(&run(&["show", "glisten/blinn_phong.glsl"])), text);
    let source =
        glisten::library::modules().iter().find(|module| module.name == "blinn_phong").expect("it is there").text;
    assert_eq!(out(&run(&["show", "blinn_phong", "--source"])), source);
    let json: Value = serde_json::from_str(&out(&run(&["show", "blinn_phong", "--format", "json"]))).expect("JSON");
    assert_eq!(json["function_entries"][1]["signature"], "blinnPhongFactor(vec3,vec3,vec3,float)");
}

#[test]
fn an_unknown_module_is_wrong_usage_and_names_the_nearest() {
    let output = run(&["show", "blin_phong"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(out(&output).is_empty() && err(&output).contains("did you mean `blinn_phong`?"), "{}", err(&output));
    let output = run(&["show", "phongFaktor"]);
    assert!(output.status.code() == Some(2) && err(&output).contains("`phongFactor`"), "{}", err(&output));
    for arguments in [&[][..], &["list", "extra"], &["export"], &["measure", "nothing_like_it"]] {
        assert_eq!(run(arguments).status.code(), Some(2), "{arguments:?}");
    }
}

/// Flat files need no include mechanism: each module alone, all modules in one shader, and the programs.
#[test]
fn flat_files_are_whole() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let target = folder.path().join("flat");
    let output = run(&["export", "--flat", &target.to_string_lossy()]);
    assert_eq!(output.status.code(), Some(0), "{}", err(&output));
    let shaders = folder.path().join("shaders");
    fs::create_dir(&shaders).expect("made");
    let mut whole = "#version 150\n".to_owned();
    for module in glisten::library::modules() {
        let written = fs::read_to_string(target.join(format!("{}.glsl", module.name))).expect("it is written");
        assert!(!written.contains("#include"), "{written}");
        let shader = format!("#version 150\n{written}void main() {{}}\n");
        fs::write(shaders.join(format!("{}.frag", module.name)), shader).expect("written");
        whole += &written;
    }
    fs::write(shaders.join("whole.frag"), whole + "void main() {}\n").expect("written");
    for entry in fs::read_dir(target.join("programs")).expect("it is written") {
        let path = entry.expect("an entry").path();
        let text = fs::read_to_string(&path).expect("readable");
        assert!(!text.contains("#include") && !text.contains("shading_language_include"), "{text}");
        fs::copy(&path, shaders.join(path.file_name().expect("a name"))).expect("copied");
    }
    let lint = Command::new(env!("CARGO_BIN_EXE_glisten")).args(["lint", "-q"]).arg(&shaders).output();
    let lint = lint.expect("the program runs");
    assert_eq!(lint.status.code(), Some(0), "{}{}", out(&lint), err(&lint));
    let files = fs::read_dir(&shaders).expect("it is there").map(|one| one.expect("an entry").path());
    let files: Vec<_> = files.collect();
    assert!(files.len() > 80, "only {} files", files.len());
    match Command::new("glslangValidator").args(&files).output() {
        Ok(judged) => assert!(judged.status.success(), "{}", out(&judged)),
        Err(_) => missing("glslangValidator", "Debian has it in the package glslang-tools"),
    }
}

#[test]
fn exported_modules_include_each_other_from_disk() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let target = folder.path().join("deep/lib");
    let output = run(&["export", &target.to_string_lossy()]);
    assert_eq!(output.status.code(), Some(0), "{}", err(&output));
    for module in glisten::library::modules() {
        let written = fs::read_to_string(target.join(format!("{}.glsl", module.name))).expect("it is written");
        assert_eq!(written, module.text);
    }
    let shader = "#version 150\n#extension GL_ARB_shading_language_include : require\n#include \"lib/lights.glsl\"\n\
        out vec4 c;\nvoid main() { c = vec4(spotFactor(vec3(0.0), vec3(1.0), 2.0)); }\n";
    fs::write(folder.path().join("deep/a.frag"), shader).expect("written");
    let lint = Command::new(env!("CARGO_BIN_EXE_glisten"))
        .args(["lint", "--deny", "warnings", "a.frag"])
        .current_dir(folder.path().join("deep"))
        .output()
        .expect("the program runs");
    assert_eq!(lint.status.code(), Some(0), "{}{}", out(&lint), err(&lint));
    // The programs include the modules next to them.
    let lint = Command::new(env!("CARGO_BIN_EXE_glisten")).arg("lint").arg(target.join("programs")).output();
    let lint = lint.expect("the program runs");
    assert_eq!(lint.status.code(), Some(0), "{}{}", out(&lint), err(&lint));
    let written = fs::read_to_string(target.join("programs/phong.frag")).expect("it is written");
    assert!(written.contains("#include \"../phong.glsl\"") && !written.contains("<glisten/"), "{written}");
    // A file in place of the folder.
    let file = folder.path().join("file");
    fs::write(&file, "").expect("written");
    assert_eq!(run(&["export", &file.to_string_lossy()]).status.code(), Some(2));
}

#[test]
fn measure_prints_a_row_a_function() {
    let output = run(&["measure", "lambert", "spot", "--backend", "cpu", "--rows", "64"]);
    assert_eq!(output.status.code(), Some(0), "{}", err(&output));
    let text = out(&output);
    assert_eq!(text.lines().count(), 2 + 4, "{text}");
    assert!(text.lines().all(|line| line.starts_with('|') && line.ends_with('|')), "{text}");
    let output = run(&["measure", "spot", "--rows", "64", "--format", "json"]);
    let rows: Value = serde_json::from_str(&out(&output)).unwrap_or_else(|error| panic!("{error}: {}", err(&output)));
    assert_eq!(rows[0]["function"], "spotFactor(vec3,vec3,float)");
    assert!(rows[0]["gpu_error"].as_f64().is_some_and(|error| error < 1e-4), "{rows}");
}

#[test]
fn the_docs_have_a_row_for_every_function() {
    let path = root().join("docs/library.md");
    let page = fs::read_to_string(path).expect("the page is there");
    let missing: Vec<&str> = glisten_verify::measure::forms()
        .map(|form| form.signature)
        .filter(|signature| !page.contains(&format!("| `{signature}` ")))
        .collect();
    assert!(missing.is_empty(), "`glisten lib measure` prints the table of docs/library.md anew: {missing:#?}");
}
