//! piglit's folders `compiler`, `preprocessor` and `linker` of the versions of GLSL, each in its own version.
//!
//! *In:* the folder of piglit. *Out:* a finding for each test. A shader alone states its result in a comment (`[config]
//! expect_result: pass`), a `.shader_test` in its `[test]` section: `link error`, or else it must link.

use super::judge::{compile, files, first_error, missing, stage_of, text_of};
use super::{Finding, Outcome};
use glisten_front::Stage;
use std::io;
use std::path::Path;

const VERSIONS: [&str; 6] = ["1.10", "1.20", "1.30", "1.40", "1.50", "3.30"];
const FOLDERS: [&str; 3] = ["compiler", "preprocessor", "linker"];

/// A test: shaders, and whether they must compile and link.
#[derive(Default)]
struct Test {
    shaders: Vec<(Stage, String)>,
    must_pass: bool,
}

/// All tests of the folders that exist.
pub(crate) fn run(root: &Path) -> io::Result<Vec<Finding>> {
    let mut findings = Vec::new();
    let spec = root.join("tests/spec");
    for group in VERSIONS.iter().flat_map(|version| FOLDERS.map(|folder| format!("glsl-{version}/{folder}"))) {
        let folder = spec.join(&group);
        if !folder.is_dir() {
            continue;
        }
        for path in files(&folder)? {
            let name = path.strip_prefix(&spec).unwrap_or(&path).display().to_string();
            if let Some(test) = read(&path)? {
                findings.push(Finding { group: group.clone(), name, outcome: outcome(&test) });
            }
        }
    }
    Ok(findings)
}

fn outcome(test: &Test) -> Outcome {
    let compilation = compile(&test.shaders);
    let error = first_error(&compilation);
    if error.is_none() == test.must_pass {
        return Outcome::Agrees;
    }
    match (missing(&compilation), error) {
        (Some(missing), _) => Outcome::Omitted(missing),
        (None, Some(error)) => Outcome::Differs(format!("must pass: {error}")),
        (None, None) => Outcome::Differs("must fail".to_owned()),
    }
}

/// The test in a file; `None` if there is none.
fn read(path: &Path) -> io::Result<Option<Test>> {
    if path.extension().is_some_and(|extension| extension == "shader_test") {
        return Ok(shader_test(&text_of(path)?));
    }
    let Some(stage) = stage_of(path) else { return Ok(None) };
    let text = text_of(path)?;
    let expected = setting(&text, "expect_result").map(|result| result == "pass");
    Ok(expected.map(|must_pass| Test { shaders: vec![(stage, text)], must_pass }))
}

/// The value of `key: value` in a line of the `[config]` comment.
fn setting<'t>(text: &'t str, key: &str) -> Option<&'t str> {
    let lines = text.lines().take_while(|line| !line.contains("[end config]"));
    let mut values = lines.filter_map(|line| line.trim_start_matches(['/', '*', ' ', '\t']).strip_prefix(key));
    Some(values.next()?.trim_start_matches(':').trim())
}

fn shader_test(text: &str) -> Option<Test> {
    let mut test = Test { must_pass: true, ..Test::default() };
    let (mut section, mut version) = ("", "110".to_owned());
    for line in text.lines() {
        if let Some(name) = line.strip_prefix('[').and_then(|rest| rest.split(']').next()) {
            section = name;
            if let Some(shader) = opened(name) {
                test.shaders.push(shader);
            }
        } else if let ("require", Some(wanted)) = (section, line.strip_prefix("GLSL >= ")) {
            version = wanted.replace('.', "");
        } else if section == "test" && line.trim() == "link error" {
            test.must_pass = false;
        } else if let ("vertex shader" | "geometry shader" | "fragment shader", Some((_, shader))) =
            (section, test.shaders.last_mut())
        {
            shader.push_str(line);
            shader.push('\n');
        }
    }
    for (_, shader) in &mut test.shaders {
        *shader = with_version(shader, &version);
    }
    (!test.shaders.is_empty()).then_some(test)
}

/// The shader that a section begins.
fn opened(section: &str) -> Option<(Stage, String)> {
    match section {
        "vertex shader" => Some((Stage::Vertex, String::new())),
        "geometry shader" => Some((Stage::Geometry, String::new())),
        "fragment shader" => Some((Stage::Fragment, String::new())),
        "vertex shader passthrough" => {
            let text = "in vec4 piglit_vertex;\nvoid main() { gl_Position = piglit_vertex; }\n";
            Some((Stage::Vertex, text.replacen("in", "attribute", 1)))
        }
        _ => None,
    }
}

/// A shader without a `#version` line gets the version that the test requires, as in the runner of such tests.
fn with_version(shader: &str, version: &str) -> String {
    if shader.lines().any(|line| line.trim_start().starts_with("#version")) {
        return shader.trim_start().to_owned();
    }
    format!("#version {}\n{shader}", version.trim())
}
