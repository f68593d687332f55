//! Help texts that can be pasted: each is applied to the source, which is compiled again. The diagnostic must be gone, and no
//! error may have come.

mod forms;

use crate::support::{Shader, compile_text, library_compiler, shaders_under};
use glisten_front::Source;
use glisten_front::diagnostic::{Code, Diagnostic, Example, Patch, Severity, codes, write};
use glisten_front::hir::Stage;
use glisten_front::lint;
use std::collections::BTreeSet;
use std::ops::Range;

/// The text to put in place of the primary span, unless the help has another form.
fn replacement(help: &str) -> Option<&str> {
    help.strip_prefix("write `")?.strip_suffix('`').filter(|text| !text.contains('`'))
}

/// The diagnostics of a shader, with those of the rules if it has no error, and the offset of its text.
fn diagnostics(shader: &Shader) -> (Vec<Diagnostic>, usize) {
    let compilation = compile_text(&shader.name, &shader.text, shader.stage);
    let file = compilation.sources.files().find(|(_, file)| file.name() == shader.name);
    let base = file.map_or(0, |(_, file)| file.base());
    let mut all: Vec<Diagnostic> = compilation.diagnostics.iter().cloned().collect();
    if let Some(program) = &compilation.program {
        all.extend(lint::check(program, &compilation.sources));
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
        let span = diagnostic.primary.span;
        let range = (span.start as usize).wrapping_sub(base)..(span.end as usize).wrapping_sub(base);
        if shader.text.get(range.clone()).is_none() {
            continue;
        }
        for text in following(diagnostic, &shader.text, &range) {
            let pasted = Shader { name: shader.name.clone(), text, stage: shader.stage };
            let (after, _) = diagnostics(&pasted);
            tried.insert(diagnostic.code.id);
            let count = |list: &[Diagnostic]| list.iter().filter(|other| other.code == diagnostic.code).count();
            if count(&after) >= count(&before) || errors(&after) > errors(&before) {
                let messages: Vec<&str> = after.iter().map(|diagnostic| diagnostic.message.as_str()).collect();
                let help = diagnostic.help.as_deref().unwrap_or_default();
                wrong.push(format!("{} {} at {range:?}: {help}: {messages:?}", shader.name, diagnostic.code));
            }
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
    assert!(tried.len() > 25, "{tried:?}");
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
            match replacement(help) {
                Some(new) if !new.starts_with('#') => {
                    let at = diagnostic.primary.span.start as usize - start;
                    pasted.replace_range(at..at + 1, new);
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

/// Codes whose help quotes code that is not to be pasted, and the reason.
static DESCRIBING: &[(&str, &str)] = &[
    ("E0211", "the type is the author's"),
    ("E0406", "it lists the sets of names"),
    ("E0416", "the vector may be a long expression before the dot"),
    ("E0501", "what was to be left is not known"),
    ("E0514", "the value is the author's"),
    ("E0605", "the block to move it to is the author's"),
    ("E0609", "the value is the author's"),
    ("E0615", "which colors belong where is the author's"),
    ("E0619", "which output has which location is the host's"),
    ("E0710", "what fits together is the author's"),
    ("E0712", "which colors belong where is the author's"),
    ("E0713", "the number is that of the host"),
    ("E0724", "which files are a program is the author's"),
    ("E0731", "the number is that of the host"),
    ("E0732", "which precision both stages need is the author's"),
    ("L0009", "what the negative base means is the author's"),
    ("L0010", "which of the two is right depends on what the branch is for"),
    ("L0011", "the condition is the author's"),
    ("L0013", "the value is the author's"),
    ("L0025", "the test for NaN that is meant is the author's"),
    ("L0042", "it names a command"),
    ("L0044", "how the depth changes is the author's"),
    ("L0045", "it names a command"),
    ("L0049", "the host's data is not in the text"),
    ("L0076", "only the author knows the largest number of steps"),
    ("W0602", "where in `main` the value is needed is the author's"),
    ("W0707", "which files are a program is the author's"),
];

/// The shaders of the `bad` example of a code, linked if there are several.
fn bad_example(code: &'static Code) -> Vec<Shader> {
    let shader = |&(stage, text): &(Stage, &str)| {
        let text = if text.contains("#version") { text.to_owned() } else { format!("#version 150\n{text}") };
        Shader { name: format!("{}.{}", code.id, stage.name()), text, stage }
    };
    match code.bad {
        Example::Program(vertex, fragment) => {
            [(Stage::Vertex, vertex), (Stage::Fragment, fragment)].iter().map(shader).collect()
        }
        Example::Shaders(list) => list.iter().map(shader).collect(),
        _ => examples(code),
    }
}

/// A diagnostic, with the number of the shader and the place in its text.
struct Found {
    diagnostic: Diagnostic,
    place: Option<(usize, Range<usize>)>,
}

/// The diagnostics of the shaders of a program.
fn findings(shaders: &[Shader]) -> Vec<Found> {
    let source =
        |shader: &Shader| Source { name: shader.name.clone(), text: shader.text.as_str().into(), stage: shader.stage };
    let compilation = library_compiler().compile(&shaders.iter().map(source).collect::<Vec<Source>>());
    let mut all: Vec<Diagnostic> = compilation.diagnostics.iter().cloned().collect();
    all.extend(compilation.program.iter().flat_map(|program| lint::check(program, &compilation.sources)));
    let place = |diagnostic: &Diagnostic| {
        shaders.iter().enumerate().find_map(|(index, shader)| {
            let files = compilation.sources.files();
            let mut files = files.filter(|(_, file)| file.name() == shader.name && **file.text() == *shader.text);
            let base = files.next()?.1.base() as usize;
            let range = (diagnostic.primary.span.start as usize).checked_sub(base)?
                ..(diagnostic.primary.span.end as usize).checked_sub(base)?;
            shader.text.get(range.clone()).map(|_| (index, range))
        })
    };
    all.into_iter()
        .map(|diagnostic| {
            let place = place(&diagnostic);
            Found { diagnostic, place }
        })
        .collect()
}

/// The texts of a shader that follow a help. A name that another stage misses is renamed in the whole file.
fn following(diagnostic: &Diagnostic, text: &str, at: &Range<usize>) -> Vec<String> {
    let help = diagnostic.help.as_deref().unwrap_or_default();
    let near = help.strip_prefix("did you mean `").and_then(|rest| rest.strip_suffix("`?"));
    match near.filter(|near| diagnostic.code.id.starts_with("E07") && !near.contains('`')) {
        Some(near) => vec![forms::renamed(text, &text[at.clone()], near)],
        None => forms::applied(help, text, at),
    }
}

/// Each help of a page's `bad` example that quotes code is applied to it: the finding is gone, and no other code has come.
#[test]
#[expect(clippy::print_stdout, reason = "how many helps are pasted and described is worth a look")]
fn every_help_of_a_page_can_be_pasted() {
    let (mut applied, mut described, mut wrong) = (BTreeSet::new(), BTreeSet::new(), Vec::new());
    for code in codes::all() {
        let shaders = bad_example(code);
        let before = findings(&shaders);
        let known: BTreeSet<&str> = before.iter().map(|found| found.diagnostic.code.id).collect();
        let count = |list: &[Found]| list.iter().filter(|found| found.diagnostic.code == code).count();
        for Found { diagnostic, place } in before.iter().filter(|found| found.diagnostic.code == code) {
            let help = diagnostic.help.as_deref().unwrap_or_default();
            if !help.contains('`') {
                continue;
            }
            let (index, at) = place.clone().expect("the finding is in the example");
            let texts = following(diagnostic, &shaders[index].text, &at);
            if texts.is_empty() {
                described.insert(code.id);
            }
            for text in texts {
                applied.insert(code.id);
                let mut pasted: Vec<Shader> = bad_example(code);
                pasted[index].text = text;
                let after = findings(&pasted);
                let new: Vec<_> = after
                    .iter()
                    .filter(|found| {
                        !known.contains(found.diagnostic.code.id) && found.diagnostic.severity > Severity::Note
                    })
                    .map(|found| &found.diagnostic.message)
                    .collect();
                if count(&after) >= count(&before) || !new.is_empty() {
                    wrong.push(format!("{}: {help}: {new:?} in\n{}", code.id, pasted[index].text));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n\n"));
    let excused: BTreeSet<&str> = DESCRIBING.iter().map(|row| row.0).collect();
    assert_eq!(described, excused, "helps that quote code and cannot be pasted");
    println!("{} codes have helps that were pasted, {} have helps that describe", applied.len(), described.len());
    assert!(applied.len() >= 30, "{applied:?}");
}

/// The texts of the shaders after a fix of one of their findings; `None` if it changes none of them.
fn fixed(shaders: &[Shader], fix: &write::FindingFix) -> Option<Vec<Shader>> {
    let mut patch = Patch::default();
    assert!(patch.add(fix), "a fix has edits that do not meet: {fix:?}");
    let changed = |shader: &Shader| {
        let text = patch.applied(&shader.name, &shader.text).expect("the edits are in the text");
        Shader { name: shader.name.clone(), text, stage: shader.stage }
    };
    let new: Vec<Shader> = shaders.iter().map(changed).collect();
    new.iter().zip(shaders).any(|(new, old)| new.text != old.text).then_some(new)
}

/// The findings of the shaders of a program, with their fixes.
fn resolved(shaders: &[Shader]) -> Vec<write::Finding> {
    let source =
        |shader: &Shader| Source { name: shader.name.clone(), text: shader.text.as_str().into(), stage: shader.stage };
    let compilation = library_compiler().compile(&shaders.iter().map(source).collect::<Vec<Source>>());
    let mut all: Vec<Diagnostic> = compilation.diagnostics.iter().cloned().collect();
    all.extend(compilation.program.iter().flat_map(|program| lint::check(program, &compilation.sources)));
    write::findings(&compilation.sources, &all)
}

/// Each fix removes its finding and brings no error; a safe one brings nothing that was not there.
#[test]
#[expect(clippy::print_stdout, reason = "how many fixes are applied is worth a look")]
fn every_fix_removes_its_finding() {
    let folders = ["fixtures/invalid", "fixtures/valid", "fixtures/lint", "fixtures/link"];
    let files = folders.iter().flat_map(|folder| shaders_under(folder)).map(|shader| vec![shader]);
    let pages = codes::all().map(bad_example);
    let (mut tried, mut wrong, mut n_fixes) = (BTreeSet::new(), Vec::new(), 0);
    for shaders in files.chain(pages) {
        let before = resolved(&shaders);
        let errors = |list: &[write::Finding]| list.iter().filter(|one| one.severity == Severity::Error).count();
        for finding in &before {
            for fix in &finding.fixes {
                let Some(new) = fixed(&shaders, fix) else { continue };
                let after = resolved(&new);
                tried.insert(finding.code.id);
                n_fixes += 1;
                let count = |list: &[write::Finding]| list.iter().filter(|one| one.code == finding.code).count();
                if count(&after) >= count(&before) || errors(&after) > errors(&before) {
                    let messages: Vec<&str> = after.iter().map(|one| one.message.as_str()).collect();
                    wrong.push(format!("{} {}: {}: {messages:?}", finding.region.file, finding.code, fix.title));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    println!("{n_fixes} fixes of {} codes", tried.len());
    assert!(tried.len() > 25, "{tried:?}");
}
