//! Hostile sources: each ends in an error within a stack of 1 MiB, and long legal ones are accepted.

use crate::support::compiler;
use glisten_front::Source;
use glisten_front::diagnostic::Diagnostics;
use glisten_front::hir::Stage;
use glisten_front::source::{Completion, IncludeForm, IncludeResolver, Included, SourceMap};
use glisten_front::syntax::{ParseOptions, parse};
use std::fmt::Write as _;

/// A resolver in which every include finds a file that includes itself.
struct Endless;

impl IncludeResolver for Endless {
    fn resolve(&self, path: &str, _: IncludeForm, _: &str) -> Result<Included, String> {
        Ok(Included { name: path.to_owned(), text: format!("#include \"{path}\"\n#include \"{path}\"\n").into() })
    }
}

/// The stack size for each source.
const STACK: usize = 1 << 20;

/// The codes of all diagnostics of a whole compilation on a small stack.
fn compiled(text: String) -> Vec<&'static str> {
    let run = move || {
        let source = Source { name: "hostile.vert".into(), text: text.into(), stage: Stage::Vertex };
        let compilation = compiler().with_includes(Endless).compile(&[source]);
        compilation.diagnostics.iter().map(|diagnostic| diagnostic.code.id).collect()
    };
    let thread = std::thread::Builder::new().stack_size(STACK).spawn(run);
    thread.expect("a thread").join().expect("no panic and no overflow")
}

/// The codes of all diagnostics of the parse on a small stack.
fn codes(text: String) -> Vec<&'static str> {
    let run = move || {
        let mut sources = SourceMap::default();
        let mut diagnostics = Diagnostics::default();
        let file = sources.add("hostile.vert", text).expect("room for the text");
        let completion = Completion::default();
        let options = ParseOptions { stage: Stage::Vertex, defines: Vec::new(), strict: false, completion };
        parse(&mut sources, file, &options, &Endless, &mut diagnostics);
        diagnostics.iter().map(|diagnostic| diagnostic.code.id).collect()
    };
    let thread = std::thread::Builder::new().stack_size(STACK).spawn(run);
    thread.expect("a thread").join().expect("no panic and no overflow")
}

fn in_main(body: &str) -> String {
    format!("#version 150\nvoid main() {{ {body} }}\n")
}

const MANY: usize = 100_000;

#[test]
fn nesting_is_bounded() {
    let deep = [
        in_main(&format!("float a = {}1.0{};", "(".repeat(MANY), ")".repeat(MANY))),
        in_main(&format!("float a = {}", "(".repeat(MANY))),
        in_main(&format!("{}{}", "{".repeat(MANY), "}".repeat(MANY))),
        in_main(&"{".repeat(MANY)),
        in_main(&format!("float a = {}1.0;", "-".repeat(MANY))),
        in_main(&format!("float a = {}1.0;", "- ".repeat(MANY))),
        in_main(&format!("float a = {}true;", "!".repeat(MANY))),
        in_main(&format!("a{}0{};", "[a".repeat(MANY), "]".repeat(MANY))),
        in_main(&format!("float a = {}1.0;", "x = ".repeat(MANY))),
        in_main(&format!("float a = {}1.0;", "x ? y : ".repeat(MANY))),
        in_main(&format!("float a = {}1.0{};", "x ? ".repeat(MANY), " : y".repeat(MANY))),
        in_main(&format!("float a = {}1.0{};", "f(".repeat(MANY), ")".repeat(MANY))),
        in_main(&format!(
            "float a = {}1.0{};",
            "x || y ^^ z && a | b ^ c & d == e < f << g + h * (".repeat(MANY / 16),
            ")".repeat(MANY / 16)
        )),
        in_main(&format!("float a = x{};", ".x".repeat(MANY))),
        in_main(&format!("float a = x{};", "[0]".repeat(MANY))),
        in_main(&format!("float a{};", "[1]".repeat(MANY))),
        in_main(&format!("{};", "if (a) ".repeat(MANY))),
        in_main(&format!("{};", "for (;;) ".repeat(MANY))),
        in_main(&format!("{};", "do ".repeat(MANY))),
        in_main(&"switch (a) { case 1: ".repeat(MANY)),
        in_main(&format!("float a[] = {}1.0{};", "{".repeat(MANY), "}".repeat(MANY))),
        format!("#version 150\n{}", "struct S { ".repeat(MANY)),
        format!("#version 150\n{}float x;{}", "struct S { ".repeat(MANY), "} s;".repeat(MANY)),
    ];
    for text in deep {
        let head: String = text.chars().skip(13).take(40).collect();
        assert!(compiled(text.clone()).contains(&"E0003"), "{head}");
        let codes = codes(text);
        assert!(codes.contains(&"E0003"), "{head}: {codes:?}");
        assert!(codes.len() < 5, "{head}: {codes:?}");
    }
}

#[test]
fn brackets_without_operands_are_no_nesting() {
    assert_eq!(codes(in_main(&format!("a{}0{};", "[".repeat(MANY), "]".repeat(MANY)))), ["E0201"]);
}

#[test]
fn long_chains_are_legal() {
    let sum = format!("x{}", " + x * 2.0".repeat(10_000));
    let arms = "if (x > 1.0) y = 1.0; else ".repeat(1_000);
    let bodies = [
        format!("y = {sum};"),
        format!("{arms} y = 2.0;"),
        format!("{arms} y = 2.0;").repeat(10),
        format!("{}y += 1.0;", "x += 1.0, ".repeat(5_000)),
        format!("y = {}1.0{};", "(".repeat(120), ")".repeat(120)),
        format!("y = {}x{};", "-(".repeat(120), ")".repeat(120)),
        format!("{}y = x;{}", "{".repeat(250), "}".repeat(250)),
        format!("{}y = x;", "if (x > 1.0) ".repeat(200)),
        "y = x;".repeat(10_000),
    ];
    for body in bodies {
        let head: String = body.chars().take(40).collect();
        let text = in_main(&format!("float x = 1.0; float y; {body} gl_Position = vec4(y);"));
        assert_eq!(compiled(text), Vec::<&str>::new(), "{head}");
    }
}

#[test]
fn macros_are_bounded() {
    let mut chain = String::from("#version 150\n#define A0 1\n");
    for n in 1..=MANY {
        let _ = writeln!(chain, "#define A{n} A{}", n - 1);
    }
    let _ = writeln!(chain, "float a = A{MANY};\nvoid main() {{}}");
    assert_eq!(codes(chain), ["E0130"]);

    let mut laughs = String::from("#version 150\n#define A0 1 +\n");
    for n in 1..=30 {
        let _ = writeln!(laughs, "#define A{n} A{0} A{0}", n - 1);
    }
    laughs.push_str("float a = A30 1;\nvoid main() {}\n");
    assert_eq!(codes(laughs), ["E0129"]);

    let mut calls = String::from("#version 150\n#define F0(x) x + x\n");
    for n in 1..=30 {
        let _ = writeln!(calls, "#define F{n}(x) F{0}(x) + F{0}(x + x)", n - 1);
    }
    calls.push_str("float a = F30(1);\nvoid main() {}\n");
    assert_eq!(codes(calls), ["E0129"]);

    let nested = |depth| {
        format!(
            "#version 150\n#define F(x) x x\nfloat a = {}1{};\nvoid main() {{}}",
            "F(".repeat(depth),
            ")".repeat(depth)
        )
    };
    assert_eq!(codes(nested(40)), ["E0129"]);
    assert_eq!(codes(nested(MANY)), ["E0129"]);
    let deep = format!("#version 150\n#define F(x) x\nfloat a = {}1{};", "F(".repeat(100), ")".repeat(100));
    assert_eq!(codes(deep), ["E0130"]);

    let wide = format!("#version 150\n#define F(x) {}\nfloat a = F({});", "x ".repeat(50_000), "y ".repeat(50_000));
    assert_eq!(codes(wide), ["E0129"]);

    // Each `##` makes a name that is longer than the previous one.
    let pasted = format!("#version 150\n#define P a{}\nfloat P;", "##a".repeat(200_000));
    assert_eq!(codes(pasted), ["E0129"]);
    let twice =
        format!("#version 150\n#define P(a) a##a\n#define Q(a) P(a)\nfloat {}a{};", "Q(".repeat(40), ")".repeat(40));
    assert_eq!(codes(twice), ["E0129"]);

    let condition = format!("#version 150\n#if {}1\n#endif\nvoid main() {{}}", "(".repeat(MANY));
    assert_eq!(codes(condition), ["E0003"]);
    let groups = format!("#version 150\n{}void main() {{}}", "#if 1\n".repeat(1_000));
    assert!(codes(groups).iter().all(|code| *code == "E0108"));
}

/// Arrays whose sizes come from initializers, copied and compared as constants.
#[test]
fn constants_are_bounded() {
    let first = format!("#version 150\nconst float a0[] = float[]({}1.0);\n", "1.0, ".repeat(20_000));
    let many = |row: &dyn Fn(usize) -> String| format!("{first}{}", (0..20_000).map(row).collect::<String>());
    let copies = many(&|n| format!("const float a{}[] = a{n};", n + 1));
    assert!(compiled(copies).contains(&"E0422"));
    let comparisons = many(&|n| format!("const bool b{n} = a0 == a0;"));
    assert!(compiled(comparisons).contains(&"E0422"));
    let locals = many(&|n| format!("void f{n}() {{ const float b[] = a0; }}"));
    assert!(compiled(locals).contains(&"E0422"));
    let elements = many(&|n| format!("const float b{n} = a0[{n}];"));
    assert!(!compiled(format!("{elements}void main() {{ gl_Position = vec4(b7); }}")).contains(&"E0422"));
}

#[test]
fn includes_are_bounded() {
    let text = "#version 150\n#extension GL_GOOGLE_include_directive : require\n#include \"a\"\nvoid main() {}\n";
    assert_eq!(codes(text.to_owned()), ["E0128"]);
    let large = format!("#version 150\n{}", "float a;\n".repeat(1 << 20));
    assert_eq!(codes(large), ["E0004"]);
}

#[test]
fn junk_ends_in_errors() {
    assert_eq!(codes(in_main("\0")), ["E0103"]);
    assert_eq!(codes(in_main("\u{fffd}")), ["E0103"]);
    assert_eq!(codes(in_main("/* \u{fffd} */")), Vec::<&str>::new());
    assert_eq!(codes(format!("#version 150\n{}", "\0".repeat(5_000))), ["E0014"]);
    assert_eq!(codes(in_main("/* ")), ["E0104"]);
    assert_eq!(codes(in_main("a = \"text;")), ["E0103"]);
    assert_eq!(codes(in_main("a = \"text;\n")), ["E0103"]);

    // A linear congruential generator, so that the junk is the same on every machine.
    let mut state = 1_u64;
    let mut next = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize
    };
    let words = [
        "(",
        ")",
        "[",
        "]",
        "{",
        "}",
        ";",
        ",",
        ".",
        "float",
        "struct",
        "uniform",
        "if",
        "else",
        "for",
        "while",
        "do",
        "switch",
        "case",
        "a",
        "b",
        "1",
        "1.0",
        "+",
        "-",
        "=",
        "?",
        ":",
        "#",
        "##",
        "\n",
        "\n#if",
        "\n#else",
        "\n#endif",
        "\n#define A",
        "A",
        "\n#define F(x) x",
        "F",
        "layout",
        "\\",
        "\n#undef A",
        "defined",
        "__LINE__",
        "in",
        "void",
        "/*",
        "*/",
        "//",
        "\"",
        "é",
        "precision",
        "0x",
        "1e",
        "<<=",
        "struct {",
        "\n#version 150",
        "\n#line",
        "invariant",
    ];
    for _ in 0..20 {
        let mut text = String::from("#version 150\n");
        while text.len() < 20_000 {
            text.push_str(words[next() % words.len()]);
            text.push(' ');
        }
        assert!(!codes(text).is_empty());
    }
    let mut megabyte = String::from("#version 150\n");
    while megabyte.len() < 1 << 20 {
        megabyte.push_str(words[next() % words.len()]);
        megabyte.push(' ');
    }
    assert!(!codes(megabyte).is_empty());
}

/// Two stages with thousands of outputs and inputs whose names are similar and never equal.
#[test]
fn interfaces_are_matched_in_little_time() {
    const PLACES: usize = 4_000;
    let declared = |storage: &str, name: &str| -> String {
        (0..PLACES).map(|n| format!("{storage} float {name}{n};\n")).collect()
    };
    let sum: String = (0..PLACES).map(|n| format!(" + other{n}")).collect();
    let vertex = format!("#version 150\n{}void main() {{ gl_Position = vec4(0.0); }}", declared("out", "mother"));
    let fragment =
        format!("#version 150\n{}out vec4 c; void main() {{ c = vec4(0.0{sum}); }}", declared("in", "other"));
    let source = |name: &str, text: String, stage| Source { name: name.into(), text: text.into(), stage };
    let sources = [source("a.vert", vertex, Stage::Vertex), source("a.frag", fragment, Stage::Fragment)];
    let compilation = compiler().compile(&sources);
    assert!(compilation.diagnostics.iter().all(|diagnostic| diagnostic.code.id == "E0702"));
    assert_eq!(compilation.diagnostics.len(), Diagnostics::LIMIT);
}
