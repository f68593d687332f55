//! `glisten lint --fix`, from the outside: what it changes in files, what it leaves, and what it says.

use crate::cli::{Folder, code, err, out};
use std::fs;

/// A shader with five findings that have one reading, and two that are guesses.
const SHADER: &str = "#version 150
in vec3 n;
out vec4 color;
float twice(float x) {
    return x * 2f
}
void main() {
    vec3 l = normallize(n);
    float d = lerp(l.x, 1, 0.5);
    if (int(d)) { discard; }
    smooth float k = 1.0f; // caf\u{e9}
    color = vec4(d * twice(k));
};
";

fn read(folder: &Folder, name: &str) -> String {
    fs::read_to_string(folder.path(name)).expect(name)
}

/// A semicolon is no safe fix where the next line may go on with what is before it.
#[test]
fn a_line_that_goes_on_may_lack_an_operator() {
    let shader = |body: &str| {
        format!(
            "#version 130\nuniform sampler2D s;\nuniform float a, b, d;\nout vec4 c;\nvoid main() {{\n{body}\n    c += a;\n}}\n"
        )
    };
    let fixed = |body: &str| {
        let text = shader(body);
        let folder = Folder::new(&[("a.frag", text.as_bytes())]);
        folder.run(&["lint", "a.frag", "--fix"]);
        read(&folder, "a.frag")
    };
    for goes_on in [
        "    c.x = a * b\n        d * a;",
        "    float e = a\n        b;",
        "    c = texture(s, c.xy)\n        texture(s, c.yx);",
        "    c.x = a\n    b * d;",
        // A decimal comma.
        "    if (a < 0,5) c.x = b;",
    ] {
        assert_eq!(fixed(goes_on), shader(goes_on), "nothing is done to {goes_on}");
    }
    for (ends, mended) in [
        ("    c.x = a\n    c.y = b;", "    c.x = a;\n    c.y = b;"),
        ("    c.x = a\n    c.yz++;", "    c.x = a;\n    c.yz++;"),
        ("    c.x = a\n    float e = b;\n    c.y = e;", "    c.x = a;\n    float e = b;\n    c.y = e;"),
        ("    c.x = a\n    if (b > 1.0) { c.y = b; }", "    c.x = a;\n    if (b > 1.0) { c.y = b; }"),
        ("    { c.x = a }", "    { c.x = a; }"),
    ] {
        assert_eq!(fixed(ends), shader(mended));
    }
}

#[test]
fn safe_fixes_are_applied_until_nothing_changes_and_guesses_are_not() {
    let folder = Folder::new(&[("a.frag", SHADER.as_bytes())]);
    let shown = folder.run(&["lint", "a.frag", "--diff"]);
    assert_eq!(read(&folder, "a.frag"), SHADER, "`--diff` writes nothing");
    let diff = out(&shown);
    assert!(diff.contains("-    return x * 2f\n+    return x * 2.0;\n"), "{diff}");
    assert!(err(&shown).contains("5 fixes would change 1 file"), "{}", err(&shown));
    let fixed = folder.run(&["lint", "a.frag", "--fix"]);
    assert_eq!(code(&fixed), 1, "two names are left");
    let safe = read(&folder, "a.frag");
    let wanted = SHADER.replace("2f\n", "2.0;\n").replace("(int(d))", "(int(d) != 0)").replace("smooth ", "");
    assert_eq!(safe, wanted.replace("};\n", "}\n"));
    let again = folder.run(&["lint", "a.frag", "--fix"]);
    assert_eq!(read(&folder, "a.frag"), safe, "a second run changes nothing");
    assert!(err(&again).contains("0 fixes changed 0 files"), "{}", err(&again));
    let guessed = folder.run(&["lint", "a.frag", "--unsafe-fixes"]);
    assert_eq!(code(&guessed), 0, "{}{}", out(&guessed), err(&guessed));
    let all = read(&folder, "a.frag");
    assert_eq!(all, safe.replace("normallize", "normalize").replace("lerp", "mix"));
}

#[test]
fn the_findings_of_a_run_carry_their_edits() {
    let folder = Folder::new(&[("a.frag", SHADER.as_bytes())]);
    let found = folder.run(&["lint", "a.frag", "--format", "json"]);
    let rows: Vec<serde_json::Value> = serde_json::from_slice(&found.stdout).expect("JSON");
    let of = |code: &str| rows.iter().find(|row| row["code"] == code).map(|row| row["fixes"][0].clone());
    let fix = of("E0207").expect("a suffix");
    assert_eq!(fix["applicability"], "safe");
    let edit = serde_json::json!({
        "file": "a.frag", "start": { "line": 5, "column": 16 }, "end": { "line": 5, "column": 18 }, "text": "2.0",
    });
    assert_eq!(fix["edits"], serde_json::json!([edit]));
    let guess = of("E0304").expect("a name");
    assert_eq!((guess["applicability"].as_str(), guess["title"].as_str()), (Some("unsafe"), Some("write `normalize`")));
    let removal = of("E0603").expect("a qualifier");
    assert_eq!(removal["edits"][0]["end"], serde_json::json!({ "line": 11, "column": 12 }), "with the blank behind it");
    let sarif = folder.run(&["lint", "a.frag", "--format", "sarif"]);
    let log: serde_json::Value = serde_json::from_slice(&sarif.stdout).expect("JSON");
    let results = log["runs"][0]["results"].as_array().expect("results");
    let fixes = results.iter().filter(|result| !result["fixes"].is_null()).count();
    assert_eq!(fixes, results.len(), "{log:#}");
}

#[test]
fn includes_are_fixed_once_and_macros_not_at_all() {
    let main =
        |name: &str| format!("#version 150\n#include \"common.glsl\"\nout vec4 c;\nvoid main() {{ c = {name}; }}\n");
    let (a, b) = (main("twice(ONE)"), main("twice(2.0f) + ONE"));
    let common = "#define ONE (1f)\nvec4 twice(float x) { return vec4(x * 2f) }\n";
    let folder = Folder::new(&[("a.frag", a.as_bytes()), ("b.frag", b.as_bytes()), ("common.glsl", common.as_bytes())]);
    let fixed = folder.run(&["lint", ".", "--fix"]);
    assert_eq!(code(&fixed), 1, "the number in the macro is left: {}", out(&fixed));
    let wanted = "#define ONE (1f)\nvec4 twice(float x) { return vec4(x * 2.0); }\n";
    assert_eq!(read(&folder, "common.glsl"), wanted);
    assert_eq!(read(&folder, "a.frag"), main("twice(ONE)"));
    assert!(err(&fixed).contains("changed 1 file"), "{}", err(&fixed));
}

/// In the arguments of a macro, the text between the ends of an expression is another one, or none at all.
#[test]
fn what_a_macro_puts_together_is_left() {
    const HEAD: &str = "#version 330
uniform vec3 u;
uniform int n;
out vec4 c;
#define ADD(a, b) a + b
#define REV(a, b) b - a
#define SQ(x) x * x
#define SUM u.x + 1.0
#define ADDTO(a, b) a += b; b
#define ARG(type, word, name) type word name
";
    for line in [
        "if (REV(n, 1)) { c = vec4(u, 1.0); }",
        "c = vec4(SQ(u.x + 1.0));",
        "c = vec4(SUM * u.x, SUM * SUM, u);",
        "int i = ADD(1, 2.0); c = vec4(i);",
        "float z[3] = float[3](1.0, 1.0, 1.0); c = vec4(z[ADD(u.x, 1.0)]);",
    ] {
        let text = format!("{HEAD}void main() {{ {line} }}\n");
        let folder = Folder::new(&[("a.frag", text.as_bytes())]);
        let fixed = folder.run(&["lint", "a.frag", "--unsafe-fixes", "--warn", "style"]);
        let shown = out(&fixed);
        assert_eq!(read(&folder, "a.frag"), text, "{shown}");
        assert!(!shown.contains("int(1, 2.0)"), "{shown}");
    }
    // Whole uses are text as any other.
    for (old, new) in [
        ("int f = ADD(u.x, u.y) + u.z; c = vec4(f);", "int f = int(ADD(u.x, u.y) + u.z); c = vec4(f);"),
        ("int f = SUM * 2.0; c = vec4(f);", "int f = int(SUM * 2.0); c = vec4(f);"),
    ] {
        let whole = |line: &str| format!("{HEAD}void main() {{ {line} }}\n");
        let folder = Folder::new(&[("a.frag", whole(old).as_bytes())]);
        let fixed = folder.run(&["lint", "a.frag", "--unsafe-fixes"]);
        assert_eq!(read(&folder, "a.frag"), whole(new), "{}", out(&fixed));
    }
    let behind = |line: &str| format!("{HEAD}void main() {{\n float s = 0.0;\n {line}\n c = vec4(s);\n}}\n");
    let text = behind("ADDTO(s, s++)");
    let folder = Folder::new(&[("a.frag", text.as_bytes())]);
    let fixed = folder.run(&["lint", "a.frag", "--fix"]);
    assert_eq!(read(&folder, "a.frag"), behind("ADDTO(s, s++);"), "{}", out(&fixed));
    let text = format!("{HEAD}void f(ARG(vec3, in, v)) {{ c.xyz = v; }}\nvoid main() {{ f(u); }}\n");
    let folder = Folder::new(&[("a.frag", text.as_bytes())]);
    folder.run(&["lint", "a.frag", "--fix"]);
    assert_eq!(read(&folder, "a.frag"), text);
}

/// A number keeps its value, whatever it is written in.
#[test]
fn numbers_keep_their_values() {
    const ES: &str = "#version 300 es\nprecision highp float;\nout vec4 c;\n";
    const OLD: &str = "#version 110\n#define c gl_FragColor\nuniform sampler2D t;\nuniform samplerCube q;\n";
    for (head, option, old, new) in [
        (ES, "--fix", "float f = 010;", "float f = float(010);"),
        (ES, "--fix", "float f = 1.0 * 0777;", "float f = 1.0 * float(0777);"),
        (ES, "--fix", "float f = 2147483648;", "float f = float(2147483648);"),
        (ES, "--fix", "float f = 10;", "float f = 10.0;"),
        (
            ES,
            "--unsafe-fixes",
            "int i = 3000000000.0; float f = float(i);",
            "int i = int(3000000000.0); float f = float(i);",
        ),
        (ES, "--fix", "uint i = 3000000000.0; float f = float(i);", "uint i = 3000000000u; float f = float(i);"),
        (OLD, "--fix", "float f = pow(2, 3.0);", "float f = pow(2.0, 3.0);"),
        (OLD, "--unsafe-fixes", "float f = tex2D(t, vec2(1.0)).x;", "float f = texture2D(t, vec2(1.0)).x;"),
        (OLD, "--unsafe-fixes", "float f = texCUBE(q, vec3(1.0)).x;", "float f = textureCube(q, vec3(1.0)).x;"),
    ] {
        let whole = |line: &str| format!("{head}void main() {{ {line} c = vec4(f); }}\n");
        let text = whole(old);
        let folder = Folder::new(&[("a.frag", text.as_bytes())]);
        let fixed = folder.run(&["lint", "a.frag", option]);
        assert_eq!(read(&folder, "a.frag"), whole(new), "{}", out(&fixed));
    }
}

/// A brace on the next line tells that its head is no declaration.
#[test]
fn a_head_is_no_declaration_without_a_semicolon() {
    for head in ["varing Block", "interface Block", "static Block", "cbuffer Block", "float f"] {
        let text = format!("#version 330\n{head}\n{{\n vec4 a;\n}};\nout vec4 c;\nvoid main() {{ c = vec4(1.0); }}\n");
        let folder = Folder::new(&[("a.frag", text.as_bytes())]);
        let fixed = folder.run(&["lint", "a.frag", "--fix"]);
        let left = text.replace("float f\n{\n vec4 a;\n};", "float f\n{\n vec4 a;\n}");
        assert_eq!(read(&folder, "a.frag"), left, "{}", out(&fixed));
    }
}

#[test]
fn bytes_and_line_ends_stay_as_they_are() {
    let old = b"#version 150\r\n// caf\xe9\r\nout vec4 c;\r\n#define A 1\r\n#define A 2\r\nvoid main() {\r\n    c = vec4(A) // \xe9\r\n}\r\n";
    let folder = Folder::new(&[("a.frag", old)]);
    folder.run(&["lint", "a.frag", "--fix"]);
    let safe = fs::read(folder.path("a.frag")).expect("read");
    assert!(!String::from_utf8_lossy(&safe).contains("#undef"), "which definition was meant is not known");
    let fixed = folder.run(&["lint", "a.frag", "--unsafe-fixes"]);
    let new = fs::read(folder.path("a.frag")).expect("read");
    let wanted = b"#version 150\r\n// caf\xe9\r\nout vec4 c;\r\n#define A 1\r\n#undef A\r\n#define A 2\r\nvoid main() {\r\n    c = vec4(A); // \xe9\r\n}\r\n";
    assert_eq!(String::from_utf8_lossy(&new), String::from_utf8_lossy(wanted), "{}", out(&fixed));
    assert_eq!(new, wanted);
}

#[test]
fn standard_input_is_refused_with_a_way_out() {
    let folder = Folder::new(&[]);
    let refused = folder.run(&["lint", "-", "--stage", "fragment", "--fix"]);
    assert_eq!(code(&refused), 2);
    assert!(err(&refused).contains("name the file"), "{}", err(&refused));
}

/// A file that its user may not write stays, though its folder lets replace it; the others are changed.
#[cfg(unix)]
#[test]
fn protected_files_are_not_replaced() {
    use std::os::unix::fs::{MetadataExt, PermissionsExt, symlink};
    use std::os::unix::process::CommandExt;
    let old = "#version 120\nvoid main() { gl_FragColor = vec4(1.0); }\n";
    let crooked = "#version 150\nout vec4 c;\nvoid main() {\nc=vec4( 1.0 );\n}\n";
    for (arguments, text) in [
        (&["lint", "--fix", "a.frag", "b.frag"][..], SHADER),
        (&["lint", "--unsafe-fixes", "a.frag", "b.frag"], SHADER),
        (&["fmt", "a.frag", "b.frag"], crooked),
        (&["fmt", "link.frag", "b.frag"], crooked),
        (&["upgrade", "--in-place", "--to", "330", "a.frag"], old),
        (&["compile", "c.frag", "--target", "wgsl", "-o", "."], crooked),
    ] {
        let files = [("a.frag", text), ("b.frag", text), ("c.frag", crooked), ("c.frag.wgsl", "mine")];
        let folder = Folder::new(&files.map(|(name, text)| (name, text.as_bytes())));
        symlink("a.frag", folder.path("link.frag")).expect("linked");
        let mode = |name: &str, mode: u32| {
            fs::set_permissions(folder.path(name), fs::Permissions::from_mode(mode)).expect("it is ours");
        };
        mode(".", 0o777);
        for (name, _) in files {
            mode(name, 0o666);
        }
        mode("a.frag", 0o444);
        mode("c.frag.wgsl", 0o444);
        let mut command = folder.command(arguments);
        if fs::metadata(folder.path(".")).expect("it is there").uid() == 0 {
            // The administrator may write everything.
            command.uid(65534).gid(65534);
        }
        let output = command.output().expect("the program runs");
        assert_eq!(code(&output), 2, "{arguments:?}: {}", err(&output));
        assert!(err(&output).contains("cannot write `"), "{arguments:?}: {}", err(&output));
        let told = |name: &str| out(&output).matches(name).count();
        let tells_what_stays = told("a.frag:") > told("b.frag:");
        assert!(arguments[0] != "lint" || tells_what_stays, "{arguments:?}: {}", out(&output));
        assert_eq!((read(&folder, "a.frag"), read(&folder, "c.frag.wgsl")), (text.to_owned(), "mine".to_owned()));
        assert_eq!(read(&folder, "b.frag") != text, arguments.contains(&"b.frag"), "{arguments:?}");
        assert!(fs::symlink_metadata(folder.path("link.frag")).expect("it is there").is_symlink());
        let left = fs::read_dir(folder.path(".")).expect("a folder").count();
        assert_eq!(left, files.len() + 1, "no temporary file is left");
    }
}

/// An extension of OpenGL mends nothing in OpenGL ES; and no fix is written again and again.
#[test]
fn an_include_of_es_gets_no_extension() {
    let header = b"highp float f() { return 1.0; }\n" as &[u8];
    for (version, n_lines) in [("#version 300 es", 0), ("#version 330", 1)] {
        let text = format!(
            "{version}\n#include \"b.glsl\"\nprecision mediump float;\nout vec4 c;\nvoid main() {{ c = vec4(f() * zzz); }}\n"
        );
        let folder = Folder::new(&[("a.frag", text.as_bytes()), ("b.glsl", header)]);
        folder.run(&["lint", "a.frag", "--unsafe-fixes", "--fix"]);
        assert_eq!(read(&folder, "a.frag").matches("#extension").count(), n_lines, "{version}");
    }
}
