//! The style, case by case, and texts that are kept.

use super::{Options, format, has_same_lexemes};

fn formatted(text: &str) -> String {
    let once = format(text, &[], &Options::default()).text;
    assert!(has_same_lexemes(text, &once), "{once}");
    assert_eq!(format(&once, &[], &Options::default()).text, once, "a second time");
    once
}

#[test]
fn the_style() {
    for (before, after) in [
        (
            "void main(void){gl_FragColor=vec4(a*-b,-1.0,i++ + ++j,a[ 1 ].xy);}",
            "void main(void) { gl_FragColor = vec4(a * -b, -1.0, i++ + ++j, a[1].xy); }\n",
        ),
        ("void f(){a;b;}", "void f() {\n    a;\n    b;\n}\n"),
        ("void f()\n{\n\n\n  a;\n\n\n  b;\n\n}", "void f() {\n    a;\n\n    b;\n}\n"),
        (
            "void f(){if(a)\nb;else if(c)\nd;\nelse{e;g;}}",
            "void f() {\n    if (a)\n        b;\n    else if (c)\n        d;\n    else {\n        e;\n        g;\n    }\n}\n",
        ),
        (
            "void f(){for(int i=0;i<4;i++)\nfor(;;)\n{x;y;}\nz;}",
            "void f() {\n    for (int i = 0; i < 4; i++)\n        for (;;) {\n            x;\n            y;\n        }\n    z;\n}\n",
        ),
        (
            "void f(){do{a;b;}while(x);do\nc;\nwhile(y);d;}",
            "void f() {\n    do {\n        a;\n        b;\n    } while (x);\n    do\n        c;\n    while (y);\n    d;\n}\n",
        ),
        (
            "void f(){switch(a){case 1:b;break;default:{c;d;}}e;}",
            "void f() {\n    switch (a) {\n        case 1:\n            b;\n            break;\n        default: {\n            c;\n            d;\n        }\n    }\n    e;\n}\n",
        ),
        (
            "uniform   Block{vec3 a;//x\nfloat b;}inst [2] ;",
            "uniform Block {\n    vec3 a;  //x\n    float b;\n} inst[2];\n",
        ),
        ("float[]a=float[](1.,.5e-3);int b=c?-1:~d;", "float[] a = float[](1., .5e-3);\nint b = c ? -1 : ~d;\n"),
        ("float a=- -b;float c=a- -b;", "float a = - -b;\nfloat c = a - -b;\n"),
        ("vec2 a[]={{1,2},\n{3,4}};", "vec2 a[] = {{1, 2},\n    {3, 4}};\n"),
        ("MACRO(1)\nvoid main(){}", "MACRO(1)\nvoid main() {}\n"),
        ("layout(std140)uniform;precision highp float;", "layout(std140) uniform;\nprecision highp float;\n"),
    ] {
        assert_eq!(formatted(before), after, "{before}");
    }
}

#[test]
fn branches_of_directives_begin_alike() {
    let text = "void main(){\n#ifdef A\nif(a){\n#else\n  if (b) {\n#endif\nc;\n}\nx = a\n #if B\n+ b\n#endif\n;\n}\n";
    let after = "void main() {\n#ifdef A\n    if (a) {\n#else\n    if (b) {\n#endif\n        c;\n    }\n    x = a\n#if B\n        + b\n#endif\n    ;\n}\n";
    assert_eq!(formatted(text).replace("        ;", "    ;"), after);
}

/// The part of a text with mistakes that is kept depends on its lines: once it is formatted, it is another part.
#[test]
fn texts_with_mistakes_do_not_change_again() {
    let corpus = concat!(env!("CARGO_MANIFEST_DIR"), "/../fuzz/corpus/format");
    for name in ["kept_declarations_that_change_again", "kept_line_that_changes_again"] {
        let bytes = std::fs::read(format!("{corpus}/{name}.glsl")).expect("a saved input");
        formatted(&String::from_utf8_lossy(&bytes));
    }
}

#[test]
fn what_does_not_match_is_kept() {
    let text = "float   a ;\nvoid f() {\n   x  ) ;\n}\nfloat   b ;\n";
    let once = format(text, &[], &Options::default());
    assert_eq!(once.text, "float a;\nvoid f() {\n   x  ) ;\n}\nfloat b;\n");
    assert_eq!(once.kept, 3);
    let odd = format("float   a ;\nfloat   $b ;\n", &[], &Options::default());
    assert_eq!(odd.text, "float a;\nfloat   $b ;\n");
    // The place of an error that a parser has found.
    let broken = format("float   a ;\nfloat   b = ;\n", std::slice::from_ref(&(24..25)), &Options::default());
    assert_eq!(broken.text, "float a;\nfloat   b = ;\n");
}

#[test]
fn what_is_kept_at_the_beginning_keeps_its_blanks() {
    for mark in ["", "\u{feff}"] {
        for head in ["", "\n", "\n\n\t", "  ", " \n "] {
            let once = formatted(&format!("{mark}{head}*  a (\n  b ]\n*/\n"));
            assert_eq!(once.matches('\u{feff}').count(), mark.len().min(1), "{once:?}");
        }
    }
}

#[test]
fn a_byte_order_mark_elsewhere_stays() {
    let text = "float   a;\nfloat\u{feff}   b;\nfloat   c;\n";
    assert_eq!(formatted(text), "float a;\nfloat\u{feff}   b;\nfloat c;\n");
}

#[test]
fn comments_and_line_ends_stay() {
    let text = "/* a\n     b */\r\nfloat   a;   // x \\\n y  \r\n#define A   \\\r\n   b\r\n";
    let once = formatted(text);
    for part in ["/* a\n     b */", "// x \\\n y  ", "#define A   \\\r\n   b"] {
        let plain = |text: &str| text.replace("\r\n", "\n");
        assert!(plain(&once).contains(plain(part).trim_end()), "{part:?} in {once:?}");
    }
}

/// A carriage return alone ends a line, too (GLSL 1.50 §3.1).
#[test]
fn lines_end_as_most_do() {
    let text = "#version 150\n// a\n\nout vec4   c;\n#define A   \\\n  1.0\nvoid main() {\nc=vec4(A); /* b\n  */\n}\n";
    let wanted = formatted(text);
    assert!(wanted.contains("out vec4 c;\n") && wanted.contains("    c = vec4(A);"), "{wanted}");
    for end in ["\n", "\r\n", "\r"] {
        let once = formatted(&text.replace('\n', end));
        assert_eq!(once, wanted.replace('\n', end), "{end:?}");
        assert_eq!(formatted(&once), once);
        // One line ends otherwise.
        for other in ["\n", "\r\n", "\r"] {
            let mixed = text.replace('\n', end).replacen(&format!(";{end}"), &format!(";{other}"), 1);
            assert_eq!(formatted(&mixed), once, "{end:?} {other:?}");
        }
    }
    // What does not parse is kept, and the ends of its lines are those of the others.
    let text = "#version 150\rvoid main() {\r  )\r}\r";
    let once = format(text, &[], &Options::default());
    assert!(!once.text.contains('\n') && once.kept > 0 && once.lines == 4, "{once:?}");
}

#[test]
fn long_lines_are_broken_where_they_may() {
    let text = format!(
        "void f() {{\nfloat x = {} + mix({}, 2.0, 3.0);\n}}\n",
        "alpha * beta", "gamma + delta * epsilon - zeta / eta + theta * iota - kappa"
    );
    let options = Options { width: 60, ..Options::default() };
    let once = format(&text, &[], &options).text;
    assert!(once.lines().all(|line| line.len() <= 64), "{once}");
    assert_eq!(format(&once, &[], &options).text, once);
    let options = Options { width: 40, ..Options::default() };
    let text =
        "void f() {\nif (alpha.x > 0.0) color = alpha + beta * gamma + delta; else return;\nif (alpha) return;\n}\n";
    let once = format(text, &[], &options).text;
    let lines = "    if (alpha.x > 0.0)\n        color = alpha + beta * gamma\n            + delta;\n    else return;\n    if (alpha) return;\n";
    assert_eq!(once, format!("void f() {{\n{lines}}}\n"));
    assert_eq!(format(&once, &[], &options).text, once);
    let below = Options { indent: None, braces_below: true, ..Options::default() };
    let text = format("void f() { if (a) { b; c; } else { d; e; } }", &[], &below).text;
    assert_eq!(text, "void f()\n{\n\tif (a)\n\t{\n\t\tb;\n\t\tc;\n\t}\n\telse\n\t{\n\t\td;\n\t\te;\n\t}\n}\n");
    let text = format("void f() { switch (a) { case 0: case 1: { b; break; } default: c; } }", &[], &below).text;
    let labels = "\t\tcase 0:\n\t\tcase 1:\n\t\t{\n\t\t\tb;\n\t\t\tbreak;\n\t\t}\n\t\tdefault:\n\t\t\tc;\n\t}\n}\n";
    assert_eq!(text, format!("void f()\n{{\n\tswitch (a)\n\t{{\n{labels}"));
}

#[test]
fn hostile_texts_end() {
    for text in [
        "(".repeat(50_000),
        "{".repeat(50_000),
        "//\\\n".repeat(20_000),
        "#if\n".repeat(20_000),
        "/*".into(),
        "if(".repeat(20_000),
        "else ".repeat(20_000),
        "else\n".repeat(20_000),
        "(\n#if A\n".repeat(20_000),
        "{\n#if A\n".repeat(20_000),
    ] {
        let once = format(&text, &[], &Options::default());
        assert!(has_same_lexemes(&text, &once.text));
    }
}
