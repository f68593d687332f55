//! Tests of the lint rules: their pages' examples, their fixtures, and no warnings on ordinary programs.

use crate::cli::{Folder, codes};
use crate::support::{Settings, Shader, library_compiler, root, shaders_under};
use glisten::{Compiler, Options, Source};
use glisten_front::diagnostic::{Code, Example, Level, Levels, Severity};
use glisten_front::hir::Stage;
use glisten_front::lint;
use std::collections::BTreeMap;
use std::path::Path;

/// The codes that the rules raise, with the severity of each, without rules that are off but for `rule`. A diagnostic of the front
/// end is a failure.
fn lints(shaders: &[Shader], rule: Option<&'static Code>) -> Vec<(&'static str, Severity)> {
    let settings = Settings::default();
    let options = Options { defines: settings.defines, strict: settings.strict, ..Options::default() };
    let sources: Vec<Source> = shaders
        .iter()
        .map(|shader| Source { name: shader.name.clone(), text: shader.text.as_str().into(), stage: shader.stage })
        .collect();
    let compilation = library_compiler().with_options(options).compile(&sources);
    let names: Vec<&str> = shaders.iter().map(|shader| shader.name.as_str()).collect();
    let messages: Vec<&str> = compilation.diagnostics.iter().map(|found| found.message.as_str()).collect();
    let program = compilation.program.unwrap_or_else(|| panic!("{names:?} give no program: {messages:?}"));
    let mut levels = Levels::default();
    if let Some(rule) = rule.filter(|rule| rule.is_off()) {
        levels.set(rule, Level::Warn);
    }
    let mut found = lint::check(&program, &compilation.sources);
    found.retain_mut(|finding| levels.apply(&compilation.sources, finding));
    found.iter().map(|found| (found.code.id, found.severity)).collect()
}

fn example(example: Example) -> Vec<Shader> {
    let shader = |text: &str, stage: Stage| Shader {
        name: format!("example.{}", stage.name()),
        text: if text.contains("#version") { text.to_owned() } else { format!("#version 150\n{text}") },
        stage,
    };
    match example {
        Example::Vertex(text) => vec![shader(text, Stage::Vertex)],
        Example::Fragment(text) => vec![shader(text, Stage::Fragment)],
        Example::Program(vertex, fragment) => vec![shader(vertex, Stage::Vertex), shader(fragment, Stage::Fragment)],
        other => panic!("a lint's page has examples that run, not {other:?}"),
    }
}

#[test]
fn every_rules_page_shows_what_it_finds() {
    for rule in lint::rules() {
        let id = rule.code.id;
        assert!(
            lints(&example(rule.code.bad), Some(rule.code)).iter().any(|(found, _)| *found == id),
            "{id}: the bad example is silent"
        );
        assert_eq!(lints(&example(rule.code.good), Some(rule.code)), [], "{id}: the good example");
    }
}

/// `fixtures/lint/CODE/bad*` raise the code, `good*` raise no warning and not the code.
#[test]
fn every_rule_has_fixtures_that_raise_it_and_fixtures_that_do_not() {
    for rule in lint::rules() {
        let id = rule.code.id;
        let mut programs: BTreeMap<String, Vec<Shader>> = BTreeMap::new();
        for shader in shaders_under(&format!("fixtures/lint/{id}")) {
            let stem =
                Path::new(&shader.name).file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into());
            programs.entry(stem).or_default().push(shader);
        }
        let count = |kind: &str| programs.keys().filter(|stem| stem.starts_with(kind)).count();
        assert!(count("bad") > 0 && count("good") > 0, "{id} lacks fixtures");
        for (stem, mut shaders) in programs {
            shaders.sort_by_key(|shader| shader.stage);
            let found = lints(&shaders, Some(rule.code));
            let raised = found.iter().any(|(code, _)| *code == id);
            assert_eq!(raised, stem.starts_with("bad"), "{id}/{stem}: {found:?}");
            let warns = found.iter().any(|(_, severity)| *severity > Severity::Note);
            assert!(stem.starts_with("bad") || !warns, "{id}/{stem}: {found:?}");
        }
    }
}

#[test]
fn ordinary_programs_raise_no_warning() {
    let mut programs: BTreeMap<String, Vec<Shader>> = BTreeMap::new();
    for shader in shaders_under("fixtures/programs") {
        let stem = Path::new(&shader.name).with_extension("").to_string_lossy().into_owned();
        programs.entry(stem).or_default().push(shader);
    }
    assert!(!programs.is_empty(), "no programs under {}", root().display());
    for (stem, shaders) in programs {
        let warnings: Vec<_> =
            lints(&shaders, None).into_iter().filter(|(_, severity)| *severity > Severity::Note).collect();
        assert_eq!(warnings, [], "{stem}");
    }
}

#[test]
fn every_way_through_a_function_is_followed_to_its_return() {
    let cases = [
        ("if (x > 0.0) return 1.0; else return 2.0;", true),
        ("if (x > 0.0) return 1.0; else if (x < 0.0) return 2.0;", false),
        ("if (x > 0.0) return 1.0; else if (x < 0.0) return 2.0; else discard;", true),
        ("if (true) return 1.0;", true),
        ("if (false) return 1.0;", false),
        ("{ { return 1.0; } }", true),
        ("for (int i = 0; i < n; i++) { if (i == 3) return 1.0; }", false),
        ("for (int i = 0; ; i++) { if (i == n) return 1.0; }", true),
        ("while (true) { if (x > 0.0) return 1.0; break; }", false),
        ("while (true) { switch (n) { case 0: return 1.0; default: break; } }", true),
        ("do { return 1.0; } while (x > 0.0);", true),
        ("do { if (x > 0.0) continue; return 1.0; } while (x > 1.0);", false),
        ("switch (n) { case 0: return 1.0; default: return 2.0; }", true),
        ("switch (n) { case 0: return 1.0; case 1: return 2.0; }", false),
        ("switch (n) { case 0: x; default: return 2.0; }", true),
        ("switch (n) { default: return 2.0; case 0: x; }", false),
        ("switch (n) { case 0: if (x > 0.0) break; return 1.0; default: return 2.0; }", false),
    ];
    for (body, is_whole) in cases {
        let text = format!(
            "#version 150\nuniform int n; in float x; out vec4 c; float f() {{ {body} }} void main() {{ c = vec4(f()); }}"
        );
        let found = lints(&[Shader { name: "a.frag".to_owned(), text, stage: Stage::Fragment }], None);
        assert_eq!(!found.iter().any(|(code, _)| *code == "L0013"), is_whole, "{body}: {found:?}");
    }
}

/// The messages of `unwritten-varying` for the body of a vertex shader and of a fragment shader.
fn unwritten(vertex: &str, fragment: &str) -> Vec<String> {
    let texts = [
        ("a.vert", format!("in vec4 p; uniform bool u; uniform int n; {vertex}"), Stage::Vertex),
        ("a.frag", format!("uniform bool u; out vec4 c; {fragment}"), Stage::Fragment),
    ];
    let sources = texts.map(|(name, text, stage)| Source {
        name: name.to_owned(),
        text: format!("#version 150\n{text}\n").into(),
        stage,
    });
    let compilation = Compiler::new(Options::default()).compile(&sources);
    let told: Vec<&str> = compilation.diagnostics.iter().map(|found| found.message.as_str()).collect();
    let program = compilation.program.unwrap_or_else(|| panic!("{told:?}"));
    let found = lint::check(&program, &compilation.sources);
    let found = found.iter().filter(|found| found.code.id == "L0014");
    found
        .map(|found| found.message.replace("the fragment stage reads ", "").replace("which the vertex stage ", ""))
        .collect()
}

#[test]
fn unwritten_varyings_are_told_by_component_and_way() {
    let whole = "in vec4 v; void main() { c = v; }";
    for (vertex, fragment, wanted) in [
        ("out vec4 v; void main() { gl_Position = p; }", whole, &["`v`, never writes"][..]),
        ("out vec4 v; void main() { v.xy = p.xy; }", whole, &["`v.zw`, never writes"]),
        ("out vec4 v; void main() { v.xy = p.xy; v.wz = p.xy; }", whole, &[]),
        ("out vec4 v; void main() { v.xy = p.xy; }", "in vec4 v; void main() { c = v.yyxx; }", &[]),
        ("out vec4 v; void main() { if (u) v = p; }", whole, &["`v`, does not write on every path"]),
        ("out vec4 v; void main() { v = p; if (u) return; v = 2.0 * p; }", whole, &[]),
        ("out vec4 v; void main() { if (u) return; v = p; }", whole, &["`v`, does not write on every path"]),
        ("out vec4 v; void main() { if (u) { gl_Position = vec4(0.0); return; } v = p; }", whole, &[]),
        ("out vec4 v; void main() { if (u) v = p; }", "in vec4 v; void main() { c = u ? v : vec4(1.0); }", &[]),
        ("out vec4 v; void main() { switch (n) { case 0: v = p; break; default: v = -p; } }", whole, &[]),
        ("out vec4 v; void main() { switch (n) { case 0: v = p; } }", whole, &["`v`, does not write on every path"]),
        (
            "out vec4 v; void main() { switch (n) { case 0: case 1: v = p; break; default: break; } }",
            whole,
            &["`v`, does not write on every path"],
        ),
        (
            "out vec4 v; void main() { while (true) { if (u) break; v = p; } }",
            whole,
            &["`v`, does not write on every path"],
        ),
        (
            "out vec4 v; void main() { for (int i = 0; i < n; ++i) { if (u) continue; v = p; } }",
            whole,
            &["`v`, does not write on every path"],
        ),
        ("out vec4 v; void f() { v = p; } void main() { f(); }", whole, &[]),
        (
            "out vec4 v; void f() { if (u) return; v = p; } void main() { f(); }",
            whole,
            &["`v`, does not write on every path"],
        ),
        (
            "out vec4 v; bool f() { v = p; return u; } void main() { if (u && f()) gl_Position = p; }",
            whole,
            &["`v`, does not write on every path"],
        ),
        ("out vec4 v; void f(inout vec4 x) { x = p; } void main() { f(v); }", whole, &[]),
        (
            "out mat2 m; void main() { m[0] = p.xy; }",
            "in mat2 m; void main() { c = vec4(m[0], m[1]); }",
            &["a part of `m`, never writes"],
        ),
        ("out mat2 m; void main() { m[0] = p.xy; }", "in mat2 m; void main() { c = vec4(m[0].xyxy); }", &[]),
        ("out vec2 a[4]; void main() { a[n] = p.xy; }", "in vec2 a[4]; void main() { c = vec4(a[3], a[0]); }", &[]),
        (
            "out B { vec4 x; vec4 y; } b; void main() { b.x = p; }",
            "in B { vec4 x; vec4 y; } b; void main() { c = b.x + b.y; }",
            &["a part of `B`, never writes"],
        ),
        ("out B { vec4 x; vec4 y; }; void main() { x = p; }", "in B { vec4 x; vec4 y; }; void main() { c = x; }", &[]),
        ("out vec4 v; void main() { }", "in vec4 v; void main() { c = vec4(1.0); }", &[]),
    ] {
        assert_eq!(unwritten(vertex, fragment), wanted, "{vertex}\n{fragment}");
    }
}

/// Names of files form programs, and do not say that there are no more shaders of a stage (GLSL 1.50 §6.1).
#[test]
fn a_search_leaves_room_for_more_shaders_of_a_stage() {
    let vertex = "#version 150\nvoid main() { gl_Position = vec4(0.0); }\n";
    let fragment = "#version 150\nvec3 hue(float x);\nout vec4 c;\nvoid main() { c = vec4(hue(1.0), 1.0); }\n";
    let color = "#version 150\nvec3 hue(float x) { return vec3(x); }\n";
    let folder = Folder::new(&[
        ("d/edge.vs", vertex.as_bytes()),
        ("d/edge.fs", fragment.as_bytes()),
        ("d/color.glsl", color.as_bytes()),
    ]);
    for (arguments, wanted, exit) in [
        (&["d"][..], "W0707", 0),
        (&["."], "W0707", 0),
        (&["d", "d/edge.fs"], "W0707", 0),
        (&["d", "--deny", "W0707"], "W0707", 1),
        (&["d/edge.fs"], "W0707", 0),
        (&["d/edge.vs", "d/edge.fs"], "E0724", 1),
        (&["--program", "d/edge.vs,d/edge.fs"], "E0724", 1),
        (&["d", "--program", "d/edge.vs,d/edge.fs"], "E0724", 1),
    ] {
        let (found, code) = folder.lint(arguments);
        let codes: Vec<&str> = found.iter().filter_map(|one| one["code"].as_str()).collect();
        assert!(codes.contains(&wanted), "{arguments:?}: {codes:?}");
        let other = if wanted == "W0707" { "E0724" } else { "W0707" };
        assert!(code == exit && !codes.contains(&other), "{arguments:?}: {codes:?}");
    }
    let (found, code) = folder.lint(&["d", "--allow", "W0707"]);
    assert!(code == 0 && found.iter().all(|one| one["code"] != "W0707" && one["code"] != "E0724"), "{found:?}");
    // With all its shaders, it is a whole program.
    let (found, _) = folder.lint(&["--program", "d/edge.vs,d/edge.fs,d/color.glsl", "--stage", "fragment"]);
    assert!(found.iter().all(|one| one["code"] != "E0724" && one["code"] != "W0707"), "{found:?}");
    // Nothing can be emitted of it.
    let output = folder.run(&["compile", "d/edge.vs", "d/edge.fs", "-o", "out"]);
    assert!(output.status.code() == Some(1) && !folder.path("out/edge.fs.wgsl").exists());
}

/// A derivative has no level of detail, and no form that takes one.
#[test]
fn a_divergent_derivative_is_told_in_its_own_words() {
    let told = |call: &str| {
        let text = format!(
            "#version 150\nuniform sampler2D t;\nin vec2 p;\nout vec4 c;\n\
             void main() {{ c = vec4(0.0); if (p.x > 0.5) c = vec4({call}); }}\n"
        );
        let source = Source { name: "a.frag".to_owned(), text: text.into(), stage: Stage::Fragment };
        let compilation = Compiler::new(Options::default()).compile(&[source]);
        let program = compilation.program.expect("it compiles");
        let found = lint::check(&program, &compilation.sources);
        let found = found.iter().find(|found| found.code.id == "L0010").expect("it diverges");
        format!("{} {:?}", found.primary.message, found.help)
    };
    assert!(told("texture(t, p)").contains("level of detail") && told("texture(t, p)").contains("Lod"));
    let derivative = told("dFdx(p.x)");
    assert!(derivative.contains("derivative") && !derivative.contains("level") && !derivative.contains("Lod"));
}

/// A word of letters that swizzles have is a name where no dot is before it.
#[test]
fn an_include_is_used_by_names_that_look_like_swizzles() {
    let header =
        b"#define g(a) (a * 2.0)\nfloat sat(float a) { return clamp(a, 0.0, 1.0); }\nconst vec3 st = vec4(1.0).xyz;\n";
    let shader = |use_: &str| {
        format!(
            "#version 330\n#extension GL_ARB_shading_language_include : require\n#include \"xy.glsl\"\nuniform vec4 u;\nout vec4 c;\nvoid main() {{ c = vec4({use_}); }}\n"
        )
    };
    for (use_, is_used) in
        [("sat(u.x)", true), ("g(u.x)", true), ("vec4(st, 1.0)", true), ("u.st.xyxy", false), ("u.g", false)]
    {
        let folder = Folder::new(&[("xy.glsl", header), ("b.frag", shader(use_).as_bytes())]);
        let (found, _) = folder.lint(&["b.frag", "--warn", "L0059"]);
        assert_eq!(!codes(&found).contains(&"L0059"), is_used, "{use_}: {found:?}");
    }
}
