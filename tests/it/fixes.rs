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

#[test]
fn bytes_and_line_ends_stay_as_they_are() {
    let old = b"#version 150\r\n// caf\xe9\r\nout vec4 c;\r\n#define A 1\r\n#define A 2\r\nvoid main() {\r\n    c = vec4(A) // \xe9\r\n}\r\n";
    let folder = Folder::new(&[("a.frag", old)]);
    let fixed = folder.run(&["lint", "a.frag", "--fix"]);
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
