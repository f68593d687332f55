//! `glisten lsp` under random edits: what it knows afterwards is what a new server knows of the same text, and its memory stays flat.
//!
//! `GLISTEN_EDITS` says how many edits there are.

use crate::cli::Folder;
use crate::editor::Editor;
use serde_json::{Value, json};
use std::fmt::Write as _;
use std::fs;

/// The edits of a run of the tests.
const EDITS: usize = 300;
/// The edits from one comparison with a new server to the next.
const EACH: usize = 50;
/// The edits after which the text is whole again, so that it never is broken all over.
const FRESH: usize = 25;

/// Texts that are typed and pasted.
const PIECES: [&str; 32] = [
    "a",
    "x1",
    ";",
    "(",
    ")",
    "{",
    "}",
    ".",
    ",",
    "\n",
    " ",
    "+",
    "=",
    "1.0",
    "vec3 ",
    "float n = ",
    "normalize(",
    "if (",
    "for (int i = 0; i < 4; i++) ",
    "return ",
    "/*",
    "*/",
    "//",
    "#if 0\n",
    "#endif\n",
    "#define M(x) x\n",
    "é𝄞",
    "[",
    "]",
    "uniform vec4 u;\n",
    "\n#include \"common.glsl\"\n",
    "void g() { }\n",
];

struct Random(u64);

impl Random {
    fn below(&mut self, n: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 % n.max(1) as u64) as usize
    }
}

fn source() -> String {
    let mut text = "#version 150\n#extension GL_ARB_shading_language_include : require\n#include \"common.glsl\"\n\
                    in vec3 normal;\nuniform vec3 light[4];\nout vec4 color;\n"
        .to_owned();
    for n in 0..12 {
        let _ = write!(
            text,
            "vec3 f{n}(vec3 a, float b) {{\n    vec3 c = tint(a) * b; // é𝄞\n    if (dot(a, light[{}]) > 0.0) {{\n        c += a;\n    }}\n    return c;\n}}\n",
            n % 4
        );
    }
    text.push_str("void main() {\n    color = vec4(f3(normal, 1.0), 1.0);\n}\n");
    text
}

/// A position in UTF-16.
fn position(text: &str, offset: usize) -> Value {
    let start = text[..offset].rfind('\n').map_or(0, |end| end + 1);
    json!({ "line": text[..start].matches('\n').count(), "character": text[start..offset].encode_utf16().count() })
}

fn boundary(text: &str, mut offset: usize) -> usize {
    while !text.is_char_boundary(offset) {
        offset -= 1;
    }
    offset
}

/// An edit of a text, and the text after it.
fn edit(text: &str, random: &mut Random) -> (Value, String) {
    let start = boundary(text, random.below(text.len() + 1));
    let length = if random.below(3) == 0 { random.below(40) } else { 0 };
    let end = boundary(text, (start + length).min(text.len())).max(start);
    let new = match random.below(6) {
        0 if length > 0 => String::new(),
        1 => {
            let from = boundary(text, random.below(text.len() + 1));
            let to = boundary(text, (from + random.below(80)).min(text.len())).max(from);
            text[from..to].to_owned()
        }
        _ => PIECES[random.below(PIECES.len())].to_owned(),
    };
    let change = json!({ "range": { "start": position(text, start), "end": position(text, end) }, "text": new });
    (change, format!("{}{new}{}", &text[..start], &text[end..]))
}

/// The findings, symbols and colors of the document by a server.
fn state(editor: &mut Editor) -> [Value; 3] {
    let document = json!({ "textDocument": { "uri": editor.uri("a.frag") } });
    ["diagnostic", "documentSymbol", "semanticTokens/full"].map(|request| {
        let mut answer = editor.ask(&format!("textDocument/{request}"), document.clone());
        if let Some(answer) = answer.as_object_mut() {
            answer.remove("resultId");
        }
        answer
    })
}

fn memory(editor: &Editor) -> Option<u64> {
    let status = fs::read_to_string(format!("/proc/{}/status", editor.child.id())).ok()?;
    let line = status.lines().find(|line| line.starts_with("VmRSS"))?;
    line.split_whitespace().nth(1)?.parse().ok()
}

#[test]
#[expect(clippy::print_stdout, reason = "the figures of a long run are read")]
fn random_edits_leave_what_a_new_server_knows() {
    let edits = std::env::var("GLISTEN_EDITS").ok().and_then(|text| text.parse().ok()).unwrap_or(EDITS);
    let whole = source();
    let folder = Folder::new(&[
        ("common.glsl", b"vec3 tint(vec3 a) { return a * 0.5; }\n"),
        ("a.frag", whole.as_bytes()),
        (
            "a.vert",
            b"#version 150\nin vec3 p;\nout vec3 normal;\nvoid main() { normal = p; gl_Position = vec4(p, 1.0); }\n",
        ),
    ]);
    let mut editor = Editor::new(&folder, json!({}));
    editor.open("a.frag", &whole);
    let mut random = Random(0x9e37_79b9_7f4a_7c15);
    let mut text = whole.clone();
    let mut early = None;
    for number in 1..=edits {
        let change = if number % FRESH == 0 {
            text.clone_from(&whole);
            json!({ "text": whole })
        } else {
            let (change, after) = edit(&text, &mut random);
            text = after;
            change
        };
        editor.change("a.frag", number as i64 + 1, json!([change]));
        // Some edits come before the server has told anything about the last one.
        if random.below(3) > 0 {
            editor.ask("textDocument/documentSymbol", json!({ "textDocument": { "uri": editor.uri("a.frag") } }));
            editor.told.clear();
        }
        if number % EACH == EACH - 1 {
            let mut fresh = Editor::new(&folder, json!({}));
            fresh.open("a.frag", &text);
            assert_eq!(state(&mut editor), state(&mut fresh), "after {number} edits:\n{text}");
            fresh.close();
        }
        if number == (edits / 5).max(EACH) {
            early = memory(&editor);
        }
    }
    if let (Some(early), Some(late)) = (early, memory(&editor)) {
        println!("{edits} edits; {early} KiB after {}, {late} KiB at the end", (edits / 5).max(EACH));
        assert!(late < early + early / 2 + 16 * 1024, "memory grows: {early} KiB, then {late} KiB");
    }
    editor.close();
}
