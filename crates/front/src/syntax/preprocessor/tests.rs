//! Tests of the preprocessor, on its output as text.

use super::{Preprocessor, predefined};
use crate::diagnostic::Diagnostics;
use crate::source::{IncludeForm, IncludeResolver, Included, SourceMap};
use crate::syntax::session::{ExtensionSets, ParseSession, TokenSource};
use crate::syntax::token::TokenKind;

/// Files by name.
struct Files(&'static [(&'static str, &'static str)]);

impl IncludeResolver for Files {
    fn resolve(&self, path: &str, _: IncludeForm, _: &str) -> Result<Included, String> {
        let found = self.0.iter().find(|file| file.0 == path);
        found.map(|file| Included { name: file.0.into(), text: file.1.into() }).ok_or_else(|| "not there".to_owned())
    }
}

fn run(text: &str, files: &'static [(&'static str, &'static str)]) -> (String, Vec<&'static str>, SourceMap) {
    run_whole(format!("#version 150\n{text}"), files)
}

fn run_whole(text: String, files: &'static [(&'static str, &'static str)]) -> (String, Vec<&'static str>, SourceMap) {
    let mut sources = SourceMap::default();
    let mut diagnostics = Diagnostics::default();
    let file = sources.add("main", text).expect("room");
    let mut session = ParseSession {
        version: super::version::UNWRITTEN,
        sources: &mut sources,
        diagnostics: &mut diagnostics,
        names: predefined::names(),
        extension_sets: ExtensionSets::default(),
    };
    let files = Files(files);
    let defines = [("FROM".to_owned(), "outside".to_owned())];
    let mut preprocessor = Preprocessor::new(&mut session, file, &defines, false, &files);
    let mut words = Vec::new();
    loop {
        let token = preprocessor.next(&mut session);
        words.push(match token.kind {
            TokenKind::Eof => break,
            TokenKind::Ident | TokenKind::Type | TokenKind::Reserved => session.spelling(token).to_owned(),
            TokenKind::Int => token.payload.to_string(),
            TokenKind::Float => format!("{:?}", f32::from_bits(token.payload)),
            kind => kind.spelling().to_owned(),
        });
    }
    let codes = diagnostics.iter().map(|diagnostic| diagnostic.code.id).collect();
    (words.join(" "), codes, sources)
}

#[track_caller]
fn check(text: &str, expected: &str) {
    let (words, codes, _) = run(text, &[]);
    assert_eq!((words.as_str(), codes), (expected, Vec::new()));
}

#[track_caller]
fn check_codes(text: &str, expected: &[&str]) {
    assert_eq!(run(text, &[]).1, expected);
}

#[test]
fn object_macros() {
    check("#define A 1\n#define B A + A\nB FROM", "1 + 1 outside");
    check("#define A B\n#define B A\nA B", "A B");
    check("#define EMPTY\nEMPTY a EMPTY b", "a b");
    check("#define A 1\n#undef A\nA\n#define A 2\nA", "A 2");
    check("#define float vec4\nfloat a;", "vec4 a ;");
}

#[test]
fn function_macros() {
    check("#define F(x) [x]\nF(1) F (2) F(\n3\n) F", "[ 1 ] [ 2 ] [ 3 ] F");
    check("#define F(x, y) x y\nF((1, 2), 3) F(, 4) F(a[1], F(5, 6))", "( 1 , 2 ) 3 4 a [ 1 ] 5 6");
    check("#define F() 7\nF() F(  )", "7 7");
    check("#define F(x) x\nF() a", "a");
    check("#define F (1)\nF", "( 1 )");
    // The examples of the C standard, 6.10.3.5.
    check(
        "#define x 3\n#define f(a) f(x * (a))\n#undef x\n#define x 2\n#define g f\n#define z z[0]\n#define h g(~\n\
         #define m(a) a(w)\n#define w 0,1\n#define t(a) a\n#define p() int\n#define q(x) x\n#define r(x,y) x ## y\n\
         f(y+1) + f(f(z)) % t(t(g)(0) + t)(1);\ng(x+(3,4)-w) | h 5) & m\n(f)^m(m);\n\
         p() i[q()] = { q(1), r(2,3), r(4,), r(,5), r(,) };",
        "f ( 2 * ( y + 1 ) ) + f ( 2 * ( f ( 2 * ( z [ 0 ] ) ) ) ) % f ( 2 * ( 0 ) ) + t ( 1 ) ; \
         f ( 2 * ( 2 + ( 3 , 4 ) - 0 , 1 ) ) | f ( 2 * ( ~ 5 ) ) & f ( 2 * ( 0 , 1 ) ) ^ m ( 0 , 1 ) ; \
         int i [ ] = { 1 , 23 , 4 , 5 , } ;",
    );
}

#[test]
fn pasting() {
    check("#define J(a, b) a ## b\nJ(x, 1) J(1, .5) J(+, =) J(, y) J(z, )", "x1 1.5 += y z");
    check("#define AB 3\n#define J(a, b) a ## b\n#define A x\nJ(A, B)", "3");
    check("#define J a ## b ## c\nJ", "abc");
    check_codes("#define J(a, b) a ## b\nJ(x, +)", &["E0116"]);
    check_codes("#define J ## b\n", &["E0116"]);
}

#[test]
fn conditions() {
    let cases = [
        ("1 + 2 * 3 == 7", true),
        ("(1 + 2) * 3 == 9", true),
        ("-1 < 0 && !0 && ~0 == -1", true),
        ("1 << 4 == 16 && 17 % 5 == 2 && 7 / 2 == 3", true),
        ("0x10 == 16 && 010 == 8 && 5u == 5", true),
        ("defined FROM && defined(FROM) && !defined(NOWHERE)", true),
        ("0 && 1 / 0", false),
        ("1 || NOWHERE", true),
        ("__VERSION__ == 150 && GL_core_profile == 1 && GL_ARB_uniform_buffer_object", true),
        ("(6 & 3) == 2 && (6 | 3) == 7 && (6 ^ 3) == 5", true),
        ("2 - 1 - 1 == 0", true),
    ];
    for (condition, expected) in cases {
        let (words, codes, _) = run(&format!("#if {condition}\nyes\n#else\nno\n#endif"), &[]);
        assert_eq!((words.as_str(), codes), (if expected { "yes" } else { "no" }, Vec::new()), "{condition}");
    }
    check("#define HAS defined(FROM)\n#if HAS\nyes\n#endif", "yes");
}

#[test]
fn comments_over_several_lines() {
    let whole = |version: &str, text: &str| {
        let (words, codes, _) = run_whole(format!("#version {version}\n{text}"), &[]);
        (words, codes)
    };
    let text = "#define A /* x\n*/ 1 /*\n*/ + 2\n#if /*\n#if */ A /* y\n */\nA\n#endif /*\n*/";
    assert_eq!(whole("440", text), ("1 + 2".to_owned(), Vec::new()));
    assert_eq!(whole("300 es", text), ("1 + 2".to_owned(), Vec::new()));
    assert_eq!(whole("430", text), ("1 + 2".to_owned(), vec!["W0118"; 3]));
    assert_eq!(whole("100", text), ("1 + 2".to_owned(), vec!["W0118"; 3]));
}

#[test]
fn names_that_are_too_long() {
    let text = |version: &str, length: usize| {
        let name = "a".repeat(length);
        run_whole(format!("#version {version}\n#define M{name}\n#undef M{name}\n{name} {name}"), &[]).1
    };
    assert_eq!(text("300 es", 1023), Vec::<&str>::new());
    assert_eq!(text("300 es", 1024), ["E0132"]);
    assert_eq!(text("320 es", 1025), ["E0132"; 2]);
    assert!(text("100", 1025).is_empty() && text("460", 1025).is_empty());
}

#[test]
fn lines_above_the_version_are_joined() {
    let of = |text: &str| run_whole(text.to_owned(), &[]);
    let (words, codes, _) = of("// a \\\r\nb\r\n/* */ // c \\\r\nd\r\n#version 420\r\ne");
    assert_eq!((words.as_str(), codes), ("e", Vec::new()));
    let (words, codes, _) = of("// a \\\n#version 420\ne");
    assert_eq!((words.as_str(), codes), ("e", vec!["W0101"]));
    assert_eq!(of("// a \\\n#define B\n#version 410\ne").1, ["W0101", "W0103"]);
}

#[test]
fn groups() {
    let text = "#ifdef A\na\n#elif 1\nb\n#if 0\nc\n#else\nd\n#endif\n#elif 1\ne\n#else\nf\n#endif\ng";
    check(text, "b d g");
    check("#if 0\n#if 1\n#else\n#endif\n#nonsense ' \" \\ @\n#elif 0\n#else\na\n#endif", "a");
    check("#if 0\n/*\n#endif\n*/\n#endif // x\na", "a");
    check("#\n # \na", "a");
    check_codes("#else\n#endif\na", &["E0107", "E0107"]);
    check_codes("#if 1\n#else\n#else\n#endif\na", &["E0107"]);
    check_codes("#if 0\n#else\n#elif 1\n#endif\na", &["E0107"]);
}

#[test]
fn lines() {
    check("__LINE__\n__LINE__ __FILE__", "2 3 0");
    check("#line 41\n__LINE__\n#line 9 3\n__LINE__ __FILE__", "42 10 3");
    check("#define L __LINE__\n\nL", "4");
    let (_, _, sources) = run("#line 99\nfloat x;\n", &[]);
    let place = |line: u32| {
        let (_, file) = sources.files().find(|(_, file)| file.name() == "main").expect("the file");
        let offset: usize = file.text().split_inclusive('\n').take(line as usize - 1).map(str::len).sum();
        sources.presented_line(crate::source::Span::new(file.base() + offset as u32, file.base() + offset as u32))
    };
    assert_eq!([place(1), place(2), place(3)], [None, None, Some(100)]);
}

#[test]
fn includes_are_loaded_once() {
    let files =
        &[("a", "#ifndef A\n#define A\n#include \"b\"\n#include \"a\"\n#endif\n"), ("b", "in b\n#pragma once\n")];
    let text = "#extension GL_GOOGLE_include_directive : enable\n#include \"a\"\n#include <b>\n__FILE__";
    let (words, codes, sources) = run(text, files);
    assert_eq!((words.as_str(), codes), ("in b 0", Vec::new()));
    assert_eq!(sources.files().count(), 4, "main, the command line and two files");
    assert_eq!(run("#extension GL_GOOGLE_include_directive : enable\n#include \"c\"\na", files).1, ["E0127"]);
}

#[test]
fn a_use_of_a_macro_is_traced() {
    let mut sources = SourceMap::default();
    let mut diagnostics = Diagnostics::default();
    let text = "#version 150\n#define ONE 1\n#define TWO ONE + x\nTWO";
    let file = sources.add("main", text).expect("room");
    let mut session = ParseSession {
        version: super::version::UNWRITTEN,
        sources: &mut sources,
        diagnostics: &mut diagnostics,
        names: predefined::names(),
        extension_sets: ExtensionSets::default(),
    };
    let mut preprocessor = Preprocessor::new(&mut session, file, &[], false, &Files(&[]));
    let token = preprocessor.next(&mut session);
    assert_eq!(session.sources.snippet(token.span), "1");
    let inner = session.sources.expansion(token.span.expansion).expect("an expansion");
    assert_eq!((&*inner.name, session.sources.snippet(inner.call)), ("ONE", "ONE"));
    let outer = session.sources.expansion(inner.call.expansion).expect("another");
    assert_eq!((&*outer.name, session.sources.location(outer.call).map(|at| at.line)), ("TWO", Some(4)));
}
