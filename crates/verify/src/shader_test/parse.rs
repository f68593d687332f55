//! Splits a test into its sections.

use super::known::{self, SECTIONS};
use super::words::Line;
use super::{TestResult, fail, skip};
use glisten_front::hir::Stage;

/// A shader's text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct ShaderText {
    pub(super) stage: Stage,
    /// The text.
    pub(super) text: String,
    /// The line of the section's header.
    pub(super) header: u32,
    /// Whether it is the predefined pass-through shader, whose text follows from the version.
    pub(super) passthrough: bool,
}

/// The sections of a test.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct TestFile {
    pub(super) requirements: Vec<Line>,
    pub(super) shaders: Vec<ShaderText>,
    pub(super) vertex_data: Vec<Line>,
    pub(super) commands: Vec<Line>,
}

/// The section that a line belongs to.
enum Section {
    Nothing,
    Requirements,
    Shader,
    VertexData,
    Commands,
    Ignored,
}

/// Splits a test into its sections.
pub(super) fn parse(text: &str) -> Result<TestFile, TestResult> {
    let mut file = TestFile::default();
    let mut section = Section::Nothing;
    let mut commented = false;
    let mut unsupported = Ok(());
    for (number, raw) in (1..).zip(text.lines()) {
        if let Some(name) = header(raw) {
            check_header(raw, name, number)?;
            section = open(&mut file, name, number).unwrap_or_else(|| {
                unsupported = unsupported.clone().and(skip(number, format_args!("[{name}] is not supported")));
                Section::Ignored
            });
            continue;
        }
        // Some tests contain C comments.
        let bare = if matches!(section, Section::Shader) { String::new() } else { uncommented(raw, &mut commented) };
        let line = || Line { number, text: bare.split('#').next().unwrap_or("").trim().to_owned() };
        let list = match section {
            Section::Requirements => &mut file.requirements,
            Section::VertexData => &mut file.vertex_data,
            Section::Commands => &mut file.commands,
            Section::Shader => {
                if let Some(shader) = file.shaders.last_mut() {
                    shader.text.push_str(raw);
                    shader.text.push('\n');
                }
                continue;
            }
            Section::Nothing | Section::Ignored => continue,
        };
        let line = line();
        if !line.text.is_empty() {
            list.push(line);
        }
    }
    unsupported?;
    if file.commands.is_empty() && file.shaders.is_empty() {
        return fail(1, "this is not a shader test: it has neither a shader nor a [test] section");
    }
    Ok(file)
}

/// A line without its `/*` to `*/` comments, which may span lines.
fn uncommented(raw: &str, inside: &mut bool) -> String {
    let mut text = String::new();
    let mut rest = raw;
    loop {
        let mark = if *inside { "*/" } else { "/*" };
        match rest.split_once(mark) {
            Some((before, behind)) => {
                if !*inside {
                    text.push_str(before);
                }
                *inside = !*inside;
                rest = behind;
            }
            None => {
                if !*inside {
                    text.push_str(rest);
                }
                return text;
            }
        }
    }
}

/// The name in a section's header.
fn header(raw: &str) -> Option<&str> {
    let name = raw.strip_prefix('[')?.split(']').next()?.trim_end();
    let is_name =
        |name: &str| name.starts_with(char::is_alphabetic) && name.chars().all(|c| c.is_alphabetic() || c == ' ');
    is_name(name).then_some(name)
}

/// Fails if shader_runner has no section of this name, or if the bracket is missing.
fn check_header(raw: &str, name: &str, number: u32) -> Result<(), TestResult> {
    if !SECTIONS.contains(&name) {
        return known::mistake(number, name, "a section", SECTIONS.iter().copied());
    }
    match raw.contains(']') {
        true => Ok(()),
        false => fail(number, format_args!("`]` is missing after `[{name}`")),
    }
}

/// Begins a section, or returns `None` for one that is not supported.
fn open(file: &mut TestFile, name: &str, number: u32) -> Option<Section> {
    let shader = |stage, passthrough| ShaderText { stage, text: String::new(), header: number, passthrough };
    Some(match name {
        "require" => Section::Requirements,
        "vertex shader passthrough" => {
            file.shaders.push(shader(Stage::Vertex, true));
            Section::Ignored
        }
        "vertex shader" | "geometry shader" | "fragment shader" => {
            let word = name.split(' ').next();
            let stage = Stage::ALL.into_iter().find(|stage| Some(stage.name()) == word).unwrap_or(Stage::Fragment);
            file.shaders.push(shader(stage, false));
            Section::Shader
        }
        "vertex data" => Section::VertexData,
        "test" => Section::Commands,
        "description" | "comment" => Section::Ignored,
        _ => return None,
    })
}

#[cfg(test)]
mod unit {
    use super::*;

    #[test]
    fn sections_and_comments() {
        let file = parse(
            "# head\n[require]\nGLSL >= 1.50 # comment\n\n[fragment shader]\n#version 150\nint a[2];\n[test]\nclear\n",
        )
        .expect("a test");
        assert_eq!(file.requirements, [Line { number: 3, text: "GLSL >= 1.50".into() }]);
        assert_eq!((file.shaders[0].text.as_str(), file.shaders[0].header), ("#version 150\nint a[2];\n", 5));
        assert_eq!(file.commands, [Line { number: 9, text: "clear".into() }]);
    }

    #[test]
    fn comments_of_c_are_passed_over() {
        let file = parse("[require]\n/* why\n * so */ GLSL >= 1.50 /* 150 */\n[test]\nclear\n").expect("a test");
        assert_eq!(file.requirements, [Line { number: 3, text: "GLSL >= 1.50".into() }]);
    }

    #[test]
    fn what_is_unknown_is_skipped_by_name() {
        let outcome = parse("[compute shader]\n").expect_err("unsupported");
        assert_eq!(outcome, TestResult::Skip("line 1: [compute shader] is not supported".into()));
        assert!(matches!(parse("hello"), Err(TestResult::Fail(_))));
    }

    #[test]
    fn a_mistyped_section_fails() {
        for (text, reason) in [
            ("[compute shader]\n[tests]\n", "line 2: `tests` is not a section; did you mean `test`?"),
            ("[fragmnt shader]\n", "line 1: `fragmnt shader` is not a section; did you mean `fragment shader`?"),
            ("[fragment shader\n", "line 1: `]` is missing after `[fragment shader`"),
        ] {
            assert_eq!(parse(text), Err(TestResult::Fail(reason.into())));
        }
    }
}
