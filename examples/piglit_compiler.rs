//! Compares glisten's verdicts with piglit's on the shaders of a folder such as `tests/spec/glsl-1.50/compiler`.
//!
//! ```text
//! cargo run --no-default-features --example piglit_compiler -- FOLDER [--all] [--show] [--raise]
//! ```
//!
//! Each file states its expected result in a comment (`[config] expect_result: pass`). The extension determines the
//! stage. Folders of the compatibility profile are skipped unless `--all` is given. `--show` prints the first
//! diagnostic of every shader that is rejected, rightly or wrongly. `--raise` replaces older versions by `#version
//! 150`, for rules that have not changed since. It exits with 1 if a verdict differs.

use glisten_front::hir::Stage;
use glisten_front::{Compiler, Options, Source};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// The settings that a file states about itself.
struct Test {
    path: PathBuf,
    stage: Stage,
    text: String,
    passes: bool,
    /// Extensions that are not implemented, on which the verdict depends.
    extensions: Vec<String>,
}

/// The extensions that glisten implements, as the files name them.
const IMPLEMENTED: [&str; 8] = [
    "GL_ARB_explicit_attrib_location",
    "GL_ARB_shading_language_420pack",
    "GL_ARB_texture_rectangle",
    "GL_ARB_uniform_buffer_object",
    "GL_ARB_draw_instanced",
    "GL_ARB_separate_shader_objects",
    "GL_ARB_fragment_coord_conventions",
    "GL_ARB_texture_multisample",
];

fn stage_of(path: &Path) -> Option<Stage> {
    match path.extension()?.to_str()? {
        "vert" => Some(Stage::Vertex),
        "geom" => Some(Stage::Geometry),
        "frag" => Some(Stage::Fragment),
        _ => None,
    }
}

/// The value of `key: value` in a line of the `[config]` comment.
fn setting<'t>(text: &'t str, key: &str) -> Option<&'t str> {
    let lines = text.lines().take_while(|line| !line.contains("[end config]"));
    let mut values = lines.filter_map(|line| line.trim_start_matches(['/', '*', ' ', '\t']).strip_prefix(key));
    Some(values.next()?.trim_start_matches(':').trim())
}

fn read(path: PathBuf) -> Option<Test> {
    let stage = stage_of(&path)?;
    let text = String::from_utf8_lossy(&std::fs::read(&path).ok()?).into_owned();
    let passes = setting(&text, "expect_result")? == "pass";
    let required = setting(&text, "require_extensions").unwrap_or("");
    let extensions =
        required.split_whitespace().filter(|name| !IMPLEMENTED.contains(name)).map(str::to_owned).collect();
    Some(Test { path, stage, text, passes, extensions })
}

/// The text with its version raised to 1.50.
fn raised(text: &str) -> String {
    let line = |line: &str| {
        let words: Vec<&str> = line.split_whitespace().collect();
        let old = matches!(words.as_slice(), ["#version", "110" | "120" | "130" | "140", ..]);
        format!("{}\n", if old { "#version 150" } else { line })
    };
    text.lines().map(line).collect()
}

/// A test that piglit's own harness would not judge in this way, and the reason.
const NOT_JUDGED: [(&str, &str); 1] =
    [("uniforms.geom", "it has no #version line, and version 1.10 (§3.3) has no geometry shaders")];

/// All files in a folder, sorted.
fn files(folder: &Path, all: bool, found: &mut Vec<PathBuf>) -> std::io::Result<()> {
    let mut entries: Vec<PathBuf> =
        std::fs::read_dir(folder)?.map(|entry| entry.map(|entry| entry.path())).collect::<Result<_, _>>()?;
    entries.sort();
    for path in entries {
        let compatibility = path.to_string_lossy().to_ascii_lowercase().contains("compatibility");
        if path.is_dir() {
            if all || !compatibility {
                files(&path, all, found)?;
            }
        } else {
            found.push(path);
        }
    }
    Ok(())
}

#[expect(clippy::print_stdout, clippy::print_stderr, reason = "this is a command")]
fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let (all, show) = (arguments.iter().any(|a| a == "--all"), arguments.iter().any(|a| a == "--show"));
    let raise = arguments.iter().any(|a| a == "--raise");
    let Some(folder) = arguments.iter().find(|argument| !argument.starts_with("--")) else {
        eprintln!("usage: piglit_compiler FOLDER [--all] [--show] [--raise]");
        return ExitCode::from(2);
    };
    let mut paths = Vec::new();
    if let Err(error) = files(Path::new(folder), all, &mut paths) {
        eprintln!("{folder}: {error}");
        return ExitCode::from(2);
    }
    let compiler = Compiler::new(Options::default());
    let (mut n_tests, mut n_wrong, mut n_other) = (0, 0, 0);
    for test in paths.into_iter().filter_map(read) {
        let name = test.path.strip_prefix(folder).unwrap_or(&test.path).display().to_string();
        let text = if raise { raised(&test.text) } else { test.text };
        let source = Source { name: name.clone(), text: text.into(), stage: test.stage };
        let compilation = compiler.compile(&[source]);
        let first = compilation.diagnostics.iter().find(|diagnostic| diagnostic.is_error());
        n_tests += 1;
        let differs = first.is_none() != test.passes;
        let known = NOT_JUDGED.iter().find(|(known, _)| *known == name);
        if let Some((_, why)) = known.filter(|_| differs) {
            n_other += 1;
            println!("{name}: not judged: {why}");
        } else if differs && !test.extensions.is_empty() {
            n_other += 1;
            println!("{name}: hangs on {}", test.extensions.join(", "));
        } else if differs {
            n_wrong += 1;
            println!("{name}: should {}", if test.passes { "pass" } else { "fail" });
        }
        if let Some(first) = first.filter(|_| differs || show) {
            let line = compilation.sources.location(first.primary.span).map_or(0, |location| location.line);
            println!("    {name}:{line}: {} {}", first.code, first.message);
        }
    }
    println!(
        "{n_tests} shaders, {n_wrong} verdicts differ, {n_other} are not judged or hang on extensions that are not implemented"
    );
    if n_wrong == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
