//! Help texts that can be pasted: each is applied to the source, which is compiled again. The diagnostic must be gone, and no
//! error may have come.

use crate::support::{Shader, compile_text, shaders_under};
use glisten_front::diagnostic::{Code, Diagnostic, Example, codes};
use glisten_front::hir::Stage;
use glisten_front::lint;
use std::collections::BTreeSet;

/// A text that a help offers, and where it goes.
enum Fix {
    Replace(String),
    Before(String),
}

/// The text to paste, unless the help describes it or leaves something open.
fn fix(help: &str) -> Option<Fix> {
    let quoted = |rest: &str, end: &str| {
        let text = rest.strip_suffix(end)?.strip_suffix('`')?;
        (!text.contains('`') && !text.contains("..") && !text.contains("NAME")).then(|| text.to_owned())
    };
    if let Some(rest) = help.strip_prefix("did you mean `") {
        return quoted(rest, "?").map(Fix::Replace);
    }
    let rest = help.strip_prefix("write `")?;
    let before = || [" before it", " here"].into_iter().find_map(|end| quoted(rest, end)).map(Fix::Before);
    quoted(rest, "").map(Fix::Replace).or_else(before)
}

/// The diagnostics of a shader, with those of the rules if it has no error, and the offset of its text.
fn diagnostics(shader: &Shader) -> (Vec<Diagnostic>, usize) {
    let compilation = compile_text(&shader.name, &shader.text, shader.stage);
    let file = compilation.sources.files().find(|(_, file)| file.name() == shader.name);
    let base = file.map_or(0, |(_, file)| file.base());
    let mut all: Vec<Diagnostic> = compilation.diagnostics.iter().cloned().collect();
    if let Some(program) = &compilation.program {
        all.extend(lint::check(program));
    }
    (all, base as usize)
}

/// The examples of a page, as shaders.
fn examples(code: &'static Code) -> Vec<Shader> {
    let shader = |text: &str, stage: Stage| {
        let text = if text.contains("#version") { text.to_owned() } else { format!("#version 150\n{text}") };
        Shader { name: format!("{}.{}", code.id, stage.name()), text, stage }
    };
    match code.bad {
        Example::Vertex(text) => vec![shader(text, Stage::Vertex)],
        Example::Fragment(text) => vec![shader(text, Stage::Fragment)],
        Example::Geometry(text) => vec![shader(text, Stage::Geometry)],
        _ => Vec::new(),
    }
}

/// Applies every help of a shader that can be pasted. Returns the codes of those, and what went wrong.
fn try_helps(shader: &Shader, tried: &mut BTreeSet<&'static str>, wrong: &mut Vec<String>) {
    let (before, base) = diagnostics(shader);
    let errors = |list: &[Diagnostic]| list.iter().filter(|diagnostic| diagnostic.is_error()).count();
    for diagnostic in &before {
        let Some(fix) = diagnostic.help.as_deref().and_then(fix) else { continue };
        let span = diagnostic.primary.span;
        let range = (span.start as usize).wrapping_sub(base)..(span.end as usize).wrapping_sub(base);
        let Some(old) = shader.text.get(range.clone()) else { continue };
        let new = match &fix {
            Fix::Replace(new) => new.clone(),
            // A directive ends with its line.
            Fix::Before(new) if new.starts_with('#') => format!("{new}\n{old}"),
            Fix::Before(new) => format!("{new} {old}"),
        };
        let mut text = shader.text.clone();
        text.replace_range(range, &new);
        let pasted = Shader { name: shader.name.clone(), text, stage: shader.stage };
        let (after, _) = diagnostics(&pasted);
        tried.insert(diagnostic.code.id);
        let count = |list: &[Diagnostic]| list.iter().filter(|other| other.code == diagnostic.code).count();
        if count(&after) >= count(&before) || errors(&after) > errors(&before) {
            let messages: Vec<&str> = after.iter().map(|diagnostic| diagnostic.message.as_str()).collect();
            wrong.push(format!("{} {}: `{old}` -> `{new}`: {messages:?}", shader.name, diagnostic.code));
        }
    }
}

#[test]
fn helps_that_can_be_pasted_do_what_they_say() {
    let folders = ["fixtures/invalid", "fixtures/valid", "fixtures/lint"];
    let shaders = folders.iter().flat_map(|folder| shaders_under(folder));
    let pages = codes::all().flat_map(examples);
    let (mut tried, mut wrong) = (BTreeSet::new(), Vec::new());
    for shader in shaders.chain(pages) {
        try_helps(&shader, &mut tried, &mut wrong);
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(tried.len() > 15, "{tried:?}");
}

/// The value of a condition does not change by the help's text, whether the name is defined or not.
#[test]
fn the_help_for_an_undefined_name_keeps_what_the_condition_means() {
    for condition in
        ["X", "!X", "(X)", "!(X)", "X && 1", "0 || X", "X > 2", "1 + X", "(X) == 0", "!X || X > 1", "-X < 0"]
    {
        let (found, base) = diagnostics(&branch(condition, ""));
        let undefined: Vec<&Diagnostic> = found.iter().filter(|diagnostic| diagnostic.code.id == "W0102").collect();
        assert!(!undefined.is_empty(), "{condition}: {found:?}");
        let start = "#version 150\n#if ".len() + base;
        let mut pasted = condition.to_owned();
        let mut before = String::new();
        for diagnostic in undefined.iter().rev() {
            let help = diagnostic.help.as_deref().expect("a help");
            match fix(help) {
                Some(Fix::Replace(new)) => {
                    let at = diagnostic.primary.span.start as usize - start;
                    pasted.replace_range(at..at + 1, &new);
                }
                _ => before = help.split('`').skip(1).step_by(2).map(|line| format!("{line}\n")).collect(),
            }
        }
        for defined in ["", "#define X 0\n", "#define X 1\n", "#define X 3\n"] {
            let outcome = |condition: &str, before: &str| {
                let (found, _) = diagnostics(&branch(condition, &format!("{defined}{before}")));
                found
                    .iter()
                    .filter(|diagnostic| diagnostic.code.id != "W0102")
                    .map(|d| d.message.clone())
                    .collect::<Vec<_>>()
            };
            assert_eq!(outcome(condition, ""), outcome(&pasted, &before), "{condition} -> {before}{pasted}, {defined}");
        }
        let (after, _) = diagnostics(&branch(&pasted, &before));
        assert!(after.iter().all(|diagnostic| diagnostic.code.id != "W0102"), "{condition} -> {before}{pasted}");
    }
}

/// A shader with an error that tells which branch was taken.
fn branch(condition: &str, before: &str) -> Shader {
    let text =
        format!("#version 150\n{before}#if {condition}\n#error yes\n#else\n#error no\n#endif\nvoid main() {{}}\n");
    Shader { name: "a.frag".into(), text, stage: Stage::Fragment }
}
