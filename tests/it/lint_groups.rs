//! Tests of the groups of lint rules: `glisten rules`, levels by group, and the fixes that the rows promise.

use crate::cli::{Folder, code, err, out};
use crate::support::{Shader, library_compiler};
use glisten::Source;
use glisten_front::diagnostic::{Applicability, Code, Example, Fixable, Group, Patch, codes, write};
use glisten_front::hir::Stage;
use glisten_front::lint;
use std::collections::BTreeSet;
use std::fs;
use std::process::Command;

#[test]
fn rules_are_listed_by_group() {
    let folder = Folder::new(&[]);
    let table = folder.run(&["rules"]);
    assert_eq!(code(&table), 0);
    let ruled = || codes::all().filter(|code| code.lint.is_some());
    assert_eq!(out(&table).lines().count(), ruled().count() + 1);
    let rows: serde_json::Value =
        serde_json::from_str(&out(&folder.run(&["rules", "--group", "Numerics", "--format", "json"]))).expect("JSON");
    let rows = rows.as_array().expect("an array");
    let wanted = ruled().filter(|code| code.group() == Some(Group::Numerics)).count();
    assert_eq!(rows.len(), wanted);
    for row in rows {
        let keys: BTreeSet<&str> = row.as_object().expect("an object").keys().map(String::as_str).collect();
        assert_eq!(keys, ["code", "fixable", "group", "level", "name", "since"].into(), "{row}");
        assert_eq!(row["group"], "numerics");
        assert!(["allow", "note", "warn"].contains(&row["level"].as_str().expect("a word")), "{row}");
    }
    let unknown = folder.run(&["rules", "--group", "numeric"]);
    assert_eq!(code(&unknown), 2);
    assert!(err(&unknown).contains("did you mean `numerics`?"), "{}", err(&unknown));
}

#[test]
fn groups_are_words_of_their_own() {
    for group in Group::ALL {
        assert!(codes::find(group.name()).is_none(), "{}", group.name());
        assert!(codes::all().any(|code| code.group() == Some(group)), "{} has no rule", group.name());
    }
    assert!(codes::all().all(|code| code.lint.is_some() == code.id.starts_with('L')), "each rule has a group");
    assert!(lint::rules().len() >= 50, "{}", lint::rules().len());
}

#[test]
fn standard_input_has_the_findings_of_a_file() {
    let shader = "#version 150\nout vec4 c;\nvoid main() { float unused = 1.0; c = vec4(1.0); }\n";
    let folder = Folder::new(&[("a.frag", shader.as_bytes())]);
    let codes = |output: &std::process::Output| {
        let rows: serde_json::Value = serde_json::from_str(&out(output)).expect("JSON");
        rows.as_array().expect("an array").iter().map(|row| row["code"].to_string()).collect::<Vec<_>>()
    };
    let file = folder.run(&["lint", "a.frag", "--warn", "style", "--format", "json"]);
    let input =
        folder.run_with_input(&["lint", "-", "--stage", "fragment", "--warn", "style", "--format", "json"], shader);
    assert!(codes(&file).len() > 1, "{}", out(&file));
    assert_eq!(codes(&file), codes(&input));
}

#[test]
fn a_file_above_has_the_settings_of_its_own_folder() {
    let shader = b"#version 150\nout vec4 c;\nvoid main() { float unused = 1.0; c = vec4(1.0); }\n" as &[u8];
    let folder = Folder::new(&[
        ("here/glisten.toml", b"[lint]\nexclude = [\"a.frag\"]\ndeny = [\"L0051\"]\n"),
        ("here/a.frag", shader),
        ("there/glisten.toml", b"[lint]\nallow = [\"L0051\"]\n"),
        ("there/a.frag", shader),
    ]);
    for (argument, from) in
        [("../there/a.frag", "here"), ("../there", "here"), ("there", "."), ("../there/a.frag", "there")]
    {
        let mut command = Command::new(env!("CARGO_BIN_EXE_glisten"));
        let output =
            command.current_dir(folder.path(from)).args(["lint", argument]).output().expect("the program runs");
        assert_eq!(code(&output), 0, "{argument} from {from}: {}{}", out(&output), err(&output));
        assert!(!err(&output).contains("no shader"), "{}", err(&output));
    }
}

const SHADER: &str = "#version 150\nin vec3 n;\nin vec3 l;\nout vec4 c;\nvoid main() {\n    float unused = 1.0;\n    \
                      c = vec4(acos(dot(normalize(n), normalize(l))));\n}\n";

#[test]
fn levels_name_groups_and_the_more_specific_one_counts() {
    let folder = Folder::new(&[("a.frag", SHADER.as_bytes())]);
    let found = |arguments: &[&str]| {
        let (findings, exit) = folder.lint(&[&["a.frag"], arguments].concat());
        let found: Vec<String> = findings
            .iter()
            .filter_map(|one| Some((one["code"].as_str()?, one["severity"].as_str()?)))
            .filter(|(code, _)| code.starts_with('L'))
            .map(|(code, severity)| format!("{code} {severity}"))
            .collect();
        (found.join(", "), exit)
    };
    let both = |first: &str, second: &str| format!("L0051 {first}, L0030 {second}");
    assert_eq!(found(&[]), (both("note", "warning"), 0));
    assert_eq!(found(&["--allow", "numerics"]).0, "L0051 note");
    assert_eq!(found(&["--deny", "style"]), (both("error", "warning"), 1));
    assert_eq!(found(&["--deny", "numerics", "--warn", "acos-beyond-one"]), (both("note", "warning"), 0));
    assert_eq!(found(&["--deny", "warnings", "--warn", "numerics"]), (both("note", "warning"), 0));
    fs::write(folder.path("glisten.toml"), "[lint]\nallow = [\"L0030\"]\ndeny = [\"style\"]\n").expect("written");
    assert_eq!(found(&["--deny", "numerics"]), ("L0051 error".to_owned(), 1));
    assert_eq!(found(&["--warn", "style"]), ("L0051 warning".to_owned(), 0));
    fs::remove_file(folder.path("glisten.toml")).expect("removed");
    let silenced = SHADER.replace("(l))));", "(l)))); // glisten: allow(numerics)");
    fs::write(folder.path("a.frag"), silenced).expect("written");
    assert_eq!(found(&["--deny", "numerics"]).0, "L0051 note");
    let idle = SHADER.replace("(l))));", "(l)))); // glisten: allow(numerics, legacy)");
    fs::write(folder.path("a.frag"), idle).expect("written");
    assert!(found(&[]).0.contains("L0073 note"), "{}", found(&[]).0);
}

fn examples(example: Example, name: &str) -> Vec<Shader> {
    let shader = |text: &str, stage: Stage| Shader {
        name: format!("{name}.{}", stage.name()),
        text: if text.contains("#version") { text.to_owned() } else { format!("#version 150\n{text}") },
        stage,
    };
    match example {
        Example::Vertex(text) => vec![shader(text, Stage::Vertex)],
        Example::Fragment(text) => vec![shader(text, Stage::Fragment)],
        Example::Program(vertex, fragment) => vec![shader(vertex, Stage::Vertex), shader(fragment, Stage::Fragment)],
        other => panic!("a rule has examples that run, not {other:?}"),
    }
}

/// The findings of a rule, and whether there is an error.
fn findings(shaders: &[Shader], rule: &Code) -> (Vec<write::Finding>, bool) {
    let source =
        |shader: &Shader| Source { name: shader.name.clone(), text: shader.text.as_str().into(), stage: shader.stage };
    let done = library_compiler().compile(&shaders.iter().map(source).collect::<Vec<Source>>());
    let found = done.program.iter().flat_map(|program| lint::check(program, &done.sources));
    let found: Vec<_> = found.filter(|found| found.code == rule).collect();
    (write::findings(&done.sources, &found), done.diagnostics.has_errors())
}

/// All fixes of a rule's bad example, as often as there are any, leave a program without its findings that has no more fixes.
#[test]
fn the_fixes_of_a_rule_are_those_of_its_row_and_come_to_an_end() {
    for rule in lint::rules() {
        let (id, lint) = (rule.code.id, rule.code.lint.expect("a rule has a group"));
        let mut shaders = examples(rule.code.bad, id);
        let mut seen: BTreeSet<Applicability> = BTreeSet::new();
        for round in 0.. {
            assert!(round < 4, "{id}: fixes come again and again");
            let (found, has_errors) = findings(&shaders, rule.code);
            assert!(!has_errors, "{id}: after {round} rounds:\n{}", shaders[0].text);
            assert!(!found.is_empty() || round > 0, "{id}: nothing is found");
            let mut patch = Patch::default();
            for fix in found.iter().flat_map(|found| found.fixes.iter().take(1)) {
                seen.insert(fix.applicability);
                patch.add(fix);
            }
            if patch.files().count() == 0 {
                assert!(found.is_empty() || round == 0, "{id}: a finding is left:\n{}", shaders[0].text);
                break;
            }
            for shader in &mut shaders {
                shader.text = patch.applied(&shader.name, &shader.text).expect("the edits are in the text");
            }
        }
        let promised = match lint.fixable {
            Fixable::No => None,
            Fixable::Safe => Some(Applicability::Safe),
            Fixable::Unsafe => Some(Applicability::Unsafe),
        };
        assert_eq!(seen.into_iter().collect::<Vec<_>>(), promised.into_iter().collect::<Vec<_>>(), "{id}");
    }
}
