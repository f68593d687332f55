//! Work grows with the input: texts of a size at which a pass over all of it for each of its parts would take minutes.

use crate::support::compiler;
use glisten_emit::reflection::table;
use glisten_emit::{Conventions, Target, emit_traced, reflect};
use glisten_front::Source;
use glisten_front::diagnostic::write::{FindingEdit, FindingFix, Region, findings, human};
use glisten_front::diagnostic::{Applicability, Levels, Patch};
use glisten_front::hir::{Stage, print};
use glisten_front::source::{IncludeForm, IncludeResolver, Included};
use std::time::{Duration, Instant};

/// The number of parts.
const MANY: usize = 100_000;
/// Far more than each text takes on a slow machine, and far less than with a square of its parts.
const PATIENCE: Duration = Duration::from_secs(60);

fn in_main(body: &str) -> String {
    format!("#version 150\nuniform int n;\nout vec4 c;\nvoid main() {{ float x = float(n); {body} c = vec4(x); }}\n")
}

fn with_globals(globals: &str) -> String {
    globals.to_owned() + "out vec4 c;\nvoid main() { c = vec4(1.0); }\n"
}

fn each(part: impl Fn(usize) -> String) -> String {
    (0..MANY).map(part).collect()
}

/// Runs work and wants it to end soon.
fn soon(what: &str, work: impl FnOnce()) {
    let start = Instant::now();
    work();
    assert!(start.elapsed() < PATIENCE, "{what}: {:?}", start.elapsed());
}

#[test]
fn lint_is_linear() {
    let version = "#version 150\n";
    let texts = [
        ("and", in_main(&format!("bool b = {} true; if (b) x = 1.0;", "n > 1 && ".repeat(MANY)))),
        ("or", in_main(&format!("bool b = {} true; if (b) x = 1.0;", "n > 1 || ".repeat(MANY)))),
        ("variables on one line", in_main(&format!("float {} last = x;", each(|i| format!("a{i} = x, "))))),
        ("variables", in_main(&each(|i| format!("float a{i} = x;\n")))),
        ("assigned variables", in_main(&each(|i| format!("float a{i}; a{i} = x;\n")))),
        ("a chain of variables", {
            let link = |i: usize| format!("float a{} = a{i} * 1.5;\n", i + 1);
            in_main(&format!("float a0 = x; {} x = a{MANY};", each(link)))
        }),
        ("a chain of copies", {
            let link = |i: usize| format!("float a{} = a{i};\n", i + 1);
            in_main(&format!("float a0 = x; {} x = a{MANY};", each(link)))
        }),
        ("blocks with variables", in_main(&"{ float a = x; x += a; }\n".repeat(MANY / 4))),
        ("findings on one line", in_main(&"if (n > 1) ; ".repeat(MANY))),
        ("allowed findings on one line", in_main(&("if (n > 1) ; ".repeat(MANY) + "// glisten: allow(L0001)\n"))),
        ("allowed findings", in_main(&each(|i| format!("// glisten: allow(L0001)\nfloat a{i};\n")))),
        ("structs", with_globals(&format!("{version}{}", each(|i| format!("struct S{i} {{ float a; }};\n"))))),
        ("functions", with_globals(&format!("{version}{}", each(|i| format!("float f{i}() {{ return 1.0; }}\n"))))),
        ("layouts", with_globals(&format!("{version}{}out float a;\n", "layout(location = 0) ".repeat(MANY)))),
    ];
    for (what, text) in texts {
        soon(what, || {
            let source = Source { name: "long.frag".into(), text: text.into(), stage: Stage::Fragment };
            let compilation = compiler().compile(&[source]);
            let mut found = match &compilation.program {
                Some(program) => glisten_front::lint::check(program, &compilation.sources),
                None => compilation.diagnostics.iter().cloned().collect(),
            };
            found.retain_mut(|one| Levels::default().apply(&compilation.sources, one));
            // What a person or a program sees of it.
            let shown = found.iter().step_by(found.len() / 2_000 + 1);
            human(&compilation.sources, shown, false);
            findings(&compilation.sources, &found);
        });
    }
}

/// The table has each width once, however many rows it has.
#[test]
fn reflection_is_linear() {
    let members = |block: usize| (0..MANY / 10).map(move |i| format!("float u{block}_{i};\n")).collect::<String>();
    let blocks: String = (0..6).map(|block| format!("uniform B{block} {{\n{} }};\n", members(block))).collect();
    let text = with_globals(&format!("#version 150\n{blocks}"));
    let source = Source { name: "long.frag".into(), text: text.into(), stage: Stage::Fragment };
    let program = compiler().compile(&[source]).program.expect("it is correct");
    soon("reflection", || {
        let reflection = reflect(&program, &Conventions::default());
        assert!(table(&reflection).lines().count() > MANY / 2);
    });
}

/// Fixes are compared with their neighbors, and places of a long line are counted once.
#[test]
fn fixes_are_linear() {
    let edit = |at: usize| {
        let column = at as u32 * 2 + 1;
        let region = Region { file: "a".into(), line: 1, column, end_line: 1, end_column: column + 1 };
        FindingEdit { region, text: "b".into() }
    };
    let fix = |at| FindingFix { title: String::new(), applicability: Applicability::Safe, edits: vec![edit(at)] };
    soon("fixes", || {
        let mut patch = Patch::default();
        // In an order in which most have others on both sides.
        assert!((0..MANY).map(|at| at * 7 % MANY).all(|at| patch.add(&fix(at))));
        assert_eq!(patch.applied("a", &"ä ".repeat(MANY)), Some("b ".repeat(MANY)));
    });
}

/// A file with a guard.
struct Guarded;

impl IncludeResolver for Guarded {
    fn resolve(&self, path: &str, _: IncludeForm, _: &str) -> Result<Included, String> {
        let text = "#ifndef G\n#define G\nfloat g;\n#endif\n";
        Ok(Included { name: path.to_owned(), text: text.into() })
    }
}

#[test]
fn includes_are_linear() {
    let includes = "#include \"g.glsl\"\n".repeat(MANY);
    let text =
        format!("#version 150\n#extension GL_ARB_shading_language_include : enable\n{includes}void main() {{}}\n");
    let source = Source { name: "long.frag".into(), text: text.into(), stage: Stage::Fragment };
    soon("includes", || {
        let compilation = compiler().with_includes(Guarded).compile(&[source]);
        let program = compilation.program.expect("it is correct");
        let found = glisten_front::lint::check(&program, &compilation.sources);
        assert!(found.len() >= MANY, "{}", found.len());
    });
}

/// Writers of code walk the whole program once.
#[test]
fn emission_is_linear() {
    let many = MANY / 20;
    let few = |part: &dyn Fn(usize) -> String| (0..many).map(part).collect::<String>();
    let texts = [
        ("comments", in_main(&few(&|i| format!("// about {i}\nx += 1.0; // behind {i}\n")))),
        ("comments of statements that are gone", in_main(&few(&|i| format!("// about {i}\nfloat a{i};\n")))),
        ("names", in_main(&"{ float a = x; x += a; }\n".repeat(many))),
        ("calls", {
            let call = |i: usize| format!("float f{}(float x) {{ return f{i}(x) + 1.0; }}\n", i + 1);
            let calls = format!("float f0(float x) {{ return x; }}\n{}", few(&call));
            in_main(&format!("x = f{many}(x);")).replace("void main", &format!("{calls}void main"))
        }),
        ("uniforms", {
            let uniforms = few(&|i| format!("uniform float u{i};\n"));
            in_main(&few(&|i| format!("x += u{i};\n"))).replace("void main", &format!("{uniforms}void main"))
        }),
        (
            "conditions on one line",
            in_main(&format!("if (n == 0) x = 1.0; {}", few(&|i| format!("else if (n == {}) x = 2.0; ", i + 1)))),
        ),
    ];
    for (what, text) in texts {
        let source = Source { name: "long.frag".into(), text: text.into(), stage: Stage::Fragment };
        let compilation = compiler().compile(&[source]);
        let program = compilation.program.unwrap_or_else(|| panic!("{what}: {:?}", compilation.diagnostics));
        let sources = Some(&compilation.sources);
        for target in [Target::Wgsl, Target::Glsl] {
            soon(&format!("{what}, {target:?}"), || {
                let emitted = emit_traced(&program, Stage::Fragment, target, &Conventions::default(), sources);
                assert!(emitted.is_ok(), "{what}: {:?}", emitted.err());
            });
        }
        soon(&format!("{what}, printed"), || {
            assert!(!print(&program.types, &program.stages[0]).is_empty());
        });
        soon(&format!("{what}, cost"), || {
            glisten_cost::cost(&program, &compilation.sources, &glisten_cost::Assumptions::default());
        });
        soon(&format!("{what}, costs of functions"), || {
            glisten_library::costs(&program.types, &program.stages[0]);
        });
        soon(&format!("{what}, left out"), || {
            glisten_specialize::optimize(&program);
        });
    }
}

#[test]
fn fmt_is_linear() {
    let options = glisten_format::Options::default();
    let texts = [
        in_main(&format!("x = {} 1.0;", "x + ".repeat(MANY))),
        in_main(&format!("float {} last = x;", each(|i| format!("a{i} = x, ")))),
        in_main(&"x += 1.0; ".repeat(MANY)),
    ];
    for text in texts {
        soon("fmt", || assert!(glisten_format::format(&text, &[], &options).text.len() >= text.len()));
    }
}
