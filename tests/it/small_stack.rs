//! A host's thread may have a small stack: what recurses gets more of it by itself.

use crate::support::compiler;
use glisten::emit::{Conventions, Target, emit, reflect};
use glisten::lint;
use glisten_front::Source;
use glisten_front::hir::Stage;
use std::fmt::Write as _;

/// The stack of the thread: half of what macOS gives one, of which some is in use before a host calls.
const STACK: usize = 256 << 10;
/// As deep as the parser allows, less what the texts around it have.
const DEEP: usize = 240;
/// The length of chains, which do not nest.
const LONG: usize = 5000;

/// A fragment shader with `main` of this body.
fn main_of(body: &str) -> String {
    format!(
        "#version 150\nout vec4 c;\nuniform float u;\nuniform int k;\nfloat f(float x) {{ return x; }}\nvoid main() {{ float a = 0.0; {body} }}\n"
    )
}

/// `per` is the number of levels that each repetition nests.
fn around(per: usize, open: &str, inner: &str, close: &str) -> String {
    main_of(&(open.repeat(DEEP / per) + inner + &close.repeat(DEEP / per)))
}

fn in_value(per: usize, open: &str, close: &str) -> String {
    let count = DEEP / per;
    main_of(&format!("c = vec4({}u{});", open.repeat(count), close.repeat(count)))
}

/// Each way to nest, and each chain.
fn texts() -> Vec<(&'static str, String)> {
    let mut loops = String::new();
    for index in 0..DEEP / 2 {
        let _ = write!(loops, "for (int i{index} = 0; i{index} < k; i{index}++) {{ ");
    }
    let calls: String = (1..LONG / 5).fold("float f0(float x) { return x; }\n".to_owned(), |mut text, index| {
        let _ = writeln!(text, "float f{index}(float x) {{ return f{}(x) + 1.0; }}", index - 1);
        text
    });
    let last = LONG / 5 - 1;
    vec![
        ("flat", main_of("c = vec4(u);")),
        ("parentheses", in_value(1, "(", ")")),
        ("calls", in_value(1, "f(", ")")),
        ("built-ins", in_value(1, "sin(", ")")),
        ("right operands", in_value(2, "(u + ", ")")),
        ("selections", in_value(2, "(u > 0.0 ? u : ", ")")),
        ("assignments", main_of(&format!("{}u{}; c = vec4(a);", "a = (".repeat(DEEP / 2), ")".repeat(DEEP / 2)))),
        ("blocks", around(1, "{ ", "c = vec4(u);", " }")),
        ("ifs", around(2, "if (u > 0.0) { ", "c = vec4(u);", " }")),
        ("switches", around(1, "switch (k) { case 0: ", "c = vec4(u);", " }")),
        ("loops", main_of(&(loops + "c = vec4(u);" + &" }".repeat(DEEP / 2)))),
        ("else", main_of(&("if (u > 0.0) c = vec4(u); else ".repeat(LONG) + "c = vec4(u);"))),
        ("a sum", main_of(&format!("c = vec4(u{});", " + u".repeat(LONG)))),
        ("signs", main_of(&format!("c = vec4({}u);", "- ".repeat(DEEP - 40)))),
        (
            "functions",
            format!("#version 150\nout vec4 c;\nuniform float u;\n{calls}void main() {{ c = vec4(f{last}(u)); }}\n"),
        ),
        ("an error", around(1, "{ ", "c = vec4(v);", " }")),
    ]
}

/// All that a host asks of a text.
fn used(name: &str, text: String) {
    let source = Source { name: "a.frag".into(), text: text.into(), stage: Stage::Fragment };
    let compilation = compiler().compile(&[source]);
    let Some(program) = &compilation.program else {
        let codes: Vec<_> = compilation.diagnostics.iter().map(|found| found.code.id).collect();
        assert_eq!((name, codes.contains(&"E0301")), ("an error", true), "{codes:?}");
        return;
    };
    let optimized = glisten::emit::optimize(program);
    for &target in Target::ALL {
        for program in [program, &optimized] {
            if let Err(found) = emit(program, Stage::Fragment, target, &Conventions::default()) {
                let codes: Vec<_> = found.iter().map(|found| found.code.id).collect();
                assert!(!codes.contains(&"E0002"), "{name}: {codes:?}");
            }
        }
    }
    let _ = lint::check(program, &compilation.sources);
    let _ = reflect(program, &Conventions::default());
}

#[test]
fn no_nesting_needs_the_stack_of_the_host() {
    for (name, text) in texts() {
        let thread = std::thread::Builder::new().name(name.to_owned()).stack_size(STACK);
        let ended = thread.spawn(move || used(name, text)).expect("a thread starts").join();
        assert!(ended.is_ok(), "{name}");
    }
}
