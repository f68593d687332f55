//! Round trips: naga reads the tidied text of every fixture as the module that it wrote.

use super::{Style, tidied};
use crate::emit::naga_repairs::{inline, names};
use crate::target::{Conventions, Target};
use glisten_front::hir::Stage;
use glisten_front::link::Program;
use glisten_front::{Compiler, Options, Source};
use naga::back::wgsl;
use naga::valid::{Capabilities, ValidationFlags, Validator};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The text that naga writes, with the names of the source.
fn written(module: &naga::Module) -> String {
    let info = Validator::new(ValidationFlags::all(), Capabilities::all()).validate(module).expect("valid");
    wgsl::write_string(module, &info, wgsl::WriterFlags::empty()).expect("naga writes it")
}

/// The text that naga reads, written again: without spans, and with naga's own names.
fn read(text: &str) -> String {
    let text = text.replace("diagnostic(off, derivative_uniformity);", "");
    let module = naga::front::wgsl::parse_str(&text).unwrap_or_else(|error| panic!("{}", error.emit_to_string(&text)));
    flat(&written(&module))
}

/// Without the blocks that naga's front end puts around `for`, and without its numbers of values.
fn flat(text: &str) -> String {
    let mut lines: Vec<&str> = Vec::new();
    // For each open brace, whether it is a bare block.
    let mut open = Vec::new();
    for line in text.lines().map(str::trim) {
        if line == "{" {
            open.push(true);
            continue;
        }
        if line.starts_with('}') && open.pop() == Some(true) {
            continue;
        }
        if line.ends_with('{') {
            open.push(false);
        }
        if !line.is_empty() {
            lines.push(line);
        }
    }
    renumbered(&leaving(&lines))
}

/// How a loop is left, in one form: naga's front end has `if condition { } else { break; }` for `while`.
fn leaving(lines: &[&str]) -> String {
    let bare = |condition: &str| {
        let mut condition = condition;
        while let Some(inner) = condition.strip_prefix('(').and_then(|rest| rest.strip_suffix(')')) {
            condition = inner;
        }
        condition.to_owned()
    };
    let (mut text, mut at) = (String::new(), 0);
    while let Some(line) = lines.get(at) {
        let condition = line.strip_prefix("if ").and_then(|rest| rest.strip_suffix(" {"));
        let next: Vec<&str> = lines.iter().skip(at + 1).take(3).copied().collect();
        let (left, len) = match (condition, next.as_slice()) {
            (Some(condition), ["} else {", "break;", "}"]) => (Some(bare(condition)), 4),
            (Some(condition), ["break;", "}", ..]) => (condition.strip_prefix('!').map(bare), 3),
            _ => (None, 1),
        };
        match left {
            Some(condition) => text.push_str(&format!("leave unless {condition}\n")),
            None => text.push_str(&format!("{line}\n")),
        }
        at += if text.ends_with(&format!("{line}\n")) { 1 } else { len };
    }
    text
}

/// Numbers the values of each function in the order in which they appear.
fn renumbered(text: &str) -> String {
    let mut numbers: BTreeMap<String, usize> = BTreeMap::new();
    let mut result = String::new();
    for line in text.lines() {
        if line.starts_with("fn ") {
            numbers.clear();
        }
        let mut rest = line;
        while let Some(at) = rest.find("_e") {
            let digits: String = rest[at + 2..].chars().take_while(char::is_ascii_digit).collect();
            let next = numbers.len();
            let number = *numbers.entry(digits.clone()).or_insert(next);
            result.push_str(&rest[..at]);
            result.push_str(&if digits.is_empty() { "_e".to_owned() } else { format!("_v{number}") });
            rest = &rest[at + 2 + digits.len()..];
        }
        result.push_str(rest);
        result.push('\n');
    }
    result
}

/// Two pairs of parentheses around one thing.
fn doubled(text: &str) -> Option<&str> {
    let starts = text.match_indices("((").map(|(at, _)| at);
    let mut found = starts.filter(|&at| {
        let inner = super::closing(text, at + 1);
        inner.is_some() && super::closing(text, at) == inner.map(|inner| inner + 1)
    });
    found.next().map(|at| text[at..].lines().next().unwrap_or_default())
}

fn sources(folder: &Path, found: &mut BTreeMap<PathBuf, Vec<PathBuf>>) {
    for entry in std::fs::read_dir(folder).expect("the fixtures are there") {
        let path = entry.expect("a folder entry").path();
        if path.is_dir() {
            sources(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "vert" || extension == "frag") {
            found.entry(path.with_extension("")).or_default().push(path);
        }
    }
}

/// All programs of the fixtures that compile, with their names.
fn programs() -> Vec<(String, Program)> {
    let fixtures = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures");
    let mut files = BTreeMap::new();
    ["programs", "lower", "valid"].iter().for_each(|folder| sources(&fixtures.join(folder), &mut files));
    let mut programs = Vec::new();
    for (name, mut paths) in files {
        paths.sort_by_key(|path| path.extension() == Some("frag".as_ref()));
        let source = |path: &PathBuf| Source {
            name: path.display().to_string(),
            text: String::from_utf8_lossy(&std::fs::read(path).expect("readable")).into(),
            stage: if path.extension() == Some("vert".as_ref()) { Stage::Vertex } else { Stage::Fragment },
        };
        let compilation = Compiler::new(Options::default()).compile(&paths.iter().map(source).collect::<Vec<_>>());
        programs.extend(compilation.program.map(|program| (name.display().to_string(), program)));
    }
    assert!(programs.len() > 40, "only {} programs", programs.len());
    programs
}

/// The text of each stage of each fixture after the repairs of naga's output.
fn repaired() -> Vec<(String, String)> {
    let mut texts = Vec::new();
    for (name, program) in programs() {
        for stage in [Stage::Vertex, Stage::Fragment] {
            if program.stage(stage).is_none_or(|shader| shader.main.is_none()) {
                continue;
            }
            let lowered = crate::lower::lower(&program, stage, Target::Wgsl, &Conventions::default());
            let Ok(mut module) = lowered else { continue };
            let info = Validator::new(ValidationFlags::all(), Capabilities::all()).validate(&module).expect("valid");
            inline::inline_loads(&mut module);
            let text = wgsl::write_string(&module, &info, wgsl::WriterFlags::empty()).expect("naga writes it");
            texts.push((format!("{name}, {}", stage.name()), names::restored(&text)));
        }
    }
    texts
}

#[test]
fn naga_reads_the_same_module() {
    let mut wrong = Vec::new();
    for (name, text) in repaired() {
        let tidy = tidied(&text, Style::Same);
        let (before, after) = (read(&text), read(&tidy));
        let differs = before.lines().zip(after.lines()).find(|(before, after)| before != after);
        wrong.extend(differs.map(|(before, after)| format!("{name}:\n  {before}\n  {after}")));
        wrong.extend((before.lines().count() != after.lines().count()).then(|| format!("{name}: other lines")));
    }
    assert!(wrong.is_empty(), "{} differ: {}", wrong.len(), wrong.join("\n"));
}

#[test]
fn declarations_that_moved_leave_a_valid_module() {
    for (name, text) in repaired() {
        let tidy = tidied(&text, Style::Full);
        read(&tidy);
        assert!(!tidy.lines().any(|line| line.ends_with(' ')), "{name}: a trailing blank in\n{tidy}");
        assert_eq!(doubled(&tidy), None, "{name}: doubled parentheses");
    }
}

/// A function body with its tidied form.
fn body(text: &str) -> String {
    let text: String = text.lines().map(|line| format!("    {line}\n")).collect();
    let tidy = tidied(&format!("fn f() {{\n{text}}}\n"), Style::Full);
    tidy.strip_prefix("fn f() {\n").and_then(|rest| rest.strip_suffix("}\n")).expect("a function").replace("    ", "")
}

#[test]
fn loops_are_written_as_people_write_them() {
    let text = "var s: f32;\nvar i: i32 = 0i;\n\ns = 0f;\nloop {\nif !((i < n)) {\nbreak;\n}\ns = (s + f32(i));\n\
                continuing {\ni = (i + 1i);\n}\n}\nreturn s;";
    assert_eq!(body(text), "var s: f32 = 0f;\nfor (var i: i32 = 0i; i < n; i++) {\ns += f32(i);\n}\nreturn s;\n");
    assert_eq!(body("loop {\nif !(more) {\nbreak;\n}\nf();\n}"), "while more {\nf();\n}\n");
    let several = "loop {\nif !((i < n)) {\nbreak;\n}\ncontinuing {\ni = (i + 1i);\nj = (j - 1i);\n}\n}";
    assert!(body(several).starts_with("loop {"), "two steps are no `for`");
}

#[test]
fn a_variable_keeps_its_value_between_iterations() {
    // Declared outside of the loop, `k` counts its iterations.
    let kept = "var k: i32 = 0i;\n\nloop {\nif !(more) {\nbreak;\n}\nk = (k + 1i);\nuse_it(k);\n}";
    assert_eq!(body(kept), "var k: i32 = 0i;\nwhile more {\nk++;\nuse_it(k);\n}\n");
    let stored = "var k: i32;\n\nloop {\nif !(more) {\nbreak;\n}\nk = 1i;\nuse_it(k);\n}";
    assert_eq!(body(stored), "while more {\nvar k: i32 = 1i;\nuse_it(k);\n}\n");
    // An inner loop whose counter starts once.
    let inner = "var i: i32 = 0i;\n\nloop {\nif !(more) {\nbreak;\n}\nloop {\nif !((i < 4i)) {\nbreak;\n}\ncontinuing \
                 {\ni = (i + 1i);\n}\n}\n}";
    assert!(body(inner).starts_with("var i: i32 = 0i;\nwhile more {\nfor (; i < 4i; i++)"), "{}", body(inner));
}

#[test]
fn parentheses_stay_where_they_mean_something() {
    for (text, expected) in [
        ("x = ((a + b) * c);", "x = (a + b) * c;"),
        ("x = (a - (b - c));", "x = a - (b - c);"),
        ("x = ((a - b) - c);", "x = a - b - c;"),
        ("x = -(-(a));", "x = -(-a);"),
        ("x = !((a < b));", "x = !(a < b);"),
        ("x = ((a < b) && (c > d));", "x = a < b && c > d;"),
        ("x = (((a && b)) || c);", "x = (a && b) || c;"),
        ("x = ((a + b) << c);", "x = (a + b) << c;"),
        ("x = ((a & b) | c);", "x = (a & b) | c;"),
        ("x = f((a < b), (c > d));", "x = f((a < b), (c > d));"),
        ("x = f((a < b), (c + d));", "x = f(a < b, c + d);"),
        ("x = (a + b).xy;", "x = (a + b).xy;"),
        ("(*p).x = ((*p).x + 1f);", "(*p).x += 1f;"),
        ("(*p) = (b * c);", "*p = b * c;"),
    ] {
        assert_eq!(body(text).trim_end(), expected, "{text}");
    }
}
