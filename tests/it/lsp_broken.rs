//! `glisten lsp` on half-typed text: errors stay on their line, and the rest keeps its symbols, findings and completion.

use crate::cli::Folder;
use crate::editor::{Editor, labels, places};
use serde_json::{Value, json};
use std::collections::BTreeSet;

const BEFORE: &str = "#version 150\nstruct Light { vec3 direction; float power; };\nuniform Light lamp;\nin vec3 normal;\n\
    out vec4 color;\nvec3 shade(vec3 n, float amount) {\n    return n * amount;\n}\nvoid main() {\n    vec3 first = normal;\n";
const AFTER: &str = "    float last = lamp.power;\n    float wrong = first;\n    color = vec4(shade(first, last), 1.0);\n}\n\
    float after(vec3 a) {\n    return a.x;\n}\n";

/// Lines that a person has not finished yet.
const HALF: [&str; 25] = [
    "    vec3 n = normalize(",
    "    vec3 n = normalize(first",
    "    vec3 n = shade(first,",
    "    vec3 n = shade(first, lamp.",
    "    vec3 n = shade(first, lamp.power",
    "    vec3 n = first +",
    "    vec3 n = first * (lamp.direction",
    "    vec3 n =",
    "    vec3 n",
    "    float n = lamp.",
    "    float n = first[",
    "    const float n = 1.0 +",
    "    lamp.",
    "    shade(",
    "    shade(first,",
    "    if (",
    "    if (first.x <",
    "    if (first.x < 1.0",
    "    for (",
    "    for (int i = 0",
    "    for (int i = 0; i <",
    "    while (first.x",
    "    return",
    "    color = vec4(first, 1.0",
    "    first = mix(first, lamp.direction, 0.5",
];

fn symbols(editor: &mut Editor) -> BTreeSet<String> {
    let uri = editor.uri("a.frag");
    let answer = editor.ask("textDocument/documentSymbol", json!({ "textDocument": { "uri": uri } }));
    let list = answer.as_array().expect("a list");
    list.iter().map(|one| one["name"].as_str().expect("a name").to_owned()).collect()
}

fn line_of(one: &Value) -> u64 {
    one["range"]["start"]["line"].as_u64().expect("a line")
}

/// One server sees all half-typed lines one after the other.
#[test]
fn the_rest_of_a_file_stays_what_it_is() {
    let whole = format!("{BEFORE}    // nothing yet\n{AFTER}");
    let folder = Folder::new(&[("a.frag", whole.as_bytes())]);
    let mut editor = Editor::new(&folder, json!({}));
    editor.open("a.frag", &whole);
    let line = BEFORE.matches('\n').count() as u64;
    let is_below = |one: &Value| line_of(one) > line && one["severity"] == 1;
    let mut of_rest: Vec<Value> = editor.diagnostics("a.frag");
    of_rest.retain(|one| is_below(one));
    assert_eq!(of_rest.len(), 1, "the wrong type of `wrong`: {of_rest:?}");
    let known = symbols(&mut editor);
    for (number, half) in HALF.iter().enumerate() {
        let text = format!("{BEFORE}{half}\n{AFTER}");
        editor.change("a.frag", number as i64 + 2, json!([{ "text": text }]));
        let found = editor.diagnostics("a.frag");
        let errors: Vec<&Value> = found.iter().filter(|one| one["severity"] == 1).collect();
        let below: Vec<&Value> = errors.iter().copied().filter(|one| line_of(one) > line).collect();
        assert_eq!(below, of_rest.iter().collect::<Vec<_>>(), "{half}");
        if !half.ends_with(')') {
            assert!(errors.iter().any(|one| line_of(one) == line), "{half}: {errors:?}");
        }
        assert!(errors.iter().all(|one| line_of(one) >= line), "{half}: {errors:?}");
        assert_eq!(symbols(&mut editor), known, "{half}");
        // Completion at the cursor, and in the lines below.
        let column = half.encode_utf16().count();
        let there = json!({ "textDocument": { "uri": editor.uri("a.frag") }, "position": { "line": line, "character": column } });
        let is_part = |letter: char| letter.is_ascii_alphanumeric() || letter == '_';
        let word = half.rsplit(|letter| !is_part(letter)).next().unwrap_or("");
        let is_number = word.starts_with(|letter: char| letter.is_ascii_digit());
        if !is_number && !half.ends_with("vec3 n") {
            let offered = labels(&editor.ask("textDocument/completion", there));
            let after_dot = half.trim_end_matches(is_part).ends_with('.');
            let wanted = match (after_dot, half.contains("first.x")) {
                (true, true) => "xy",
                (true, false) => "power",
                (false, _) => "first",
            };
            assert!(offered.iter().any(|one| one == wanted), "{half}: {offered:?}");
        }
        let member = editor.on("a.frag", &text, "power;\n    float wrong");
        let hover = editor.ask("textDocument/hover", member)["contents"]["value"].to_string();
        assert!(hover.contains("float Light.power"), "{half}: {hover}");
        let member = editor.on("a.frag", &text, "ower;\n    float wrong");
        assert!(labels(&editor.ask("textDocument/completion", member)).contains(&"direction".to_owned()), "{half}");
    }
    editor.close();
}

/// A variable whose value is not finished has its type, and the names in the broken text are known.
#[test]
fn what_is_broken_is_understood_as_far_as_it_goes() {
    let text =
        format!("{BEFORE}    vec3 n = normalize(first, lamp.direction +\n    float l = n;\n    n.x = 1.0;\n{AFTER}");
    let folder = Folder::new(&[("a.frag", text.as_bytes())]);
    let mut editor = Editor::new(&folder, json!({}));
    editor.open("a.frag", &text);
    let line = BEFORE.matches('\n').count() as u64;
    let errors = editor.diagnostics("a.frag");
    assert!(errors.iter().any(|one| line_of(one) == line + 1), "a `vec3` is no `float`: {errors:?}");
    for (word, part) in
        [("n = normalize", "vec3 n"), ("first, lamp", "vec3 first"), ("direction +", "vec3 Light.direction")]
    {
        let there = editor.on("a.frag", &text, word);
        let hover = editor.ask("textDocument/hover", there)["contents"]["value"].to_string();
        assert!(hover.contains(part), "{word}: {hover}");
    }
    let mut there = editor.on("a.frag", &text, "first = normal");
    there["context"] = json!({ "includeDeclaration": false });
    let uses = editor.ask("textDocument/references", there);
    assert_eq!(uses.as_array().map(Vec::len), Some(3), "the broken use is one of them: {uses}");
    editor.close();
}

/// A function whose header is not finished keeps its name and its body; nothing follows from the error elsewhere.
#[test]
fn functions_with_broken_headers_are_known() {
    for header in
        ["vec3 tone(vec3 n, float {", "vec3 tone(vec3 n float b {", "vec3 tone(vec3 n, 2 {", "vec3 tone(vec3 n, in"]
    {
        let text = format!(
            "#version 150\nout vec4 color;\n{header}\n{}    vec3 sum = n;\n    return sum * b;\n}}\n\
             void main() {{ color = vec4(tone(vec3(1.0), 2.0), 1.0); }}\n",
            if header.ends_with('{') { "" } else { ") {\n" }
        );
        let folder = Folder::new(&[("a.frag", text.as_bytes())]);
        let mut editor = Editor::new(&folder, json!({}));
        editor.open("a.frag", &text);
        let errors = editor.diagnostics("a.frag");
        assert!(!errors.is_empty() && errors.iter().all(|one| line_of(one) <= 3), "{header}: {errors:?}");
        assert_eq!(symbols(&mut editor), ["color", "main", "tone"].map(str::to_owned).into(), "{header}");
        let there = editor.on("a.frag", &text, "tone(vec3(1.0)");
        assert_eq!(places(&editor.ask("textDocument/definition", there)), ["a.frag:2:5"], "{header}");
        let there = editor.on("a.frag", &text, "sum * b");
        let hover = editor.ask("textDocument/hover", there)["contents"]["value"].to_string();
        assert!(hover.contains("vec3 sum"), "{header}: {hover}");
        editor.close();
    }
}

#[test]
fn constructors_have_signatures() {
    let text = "#version 150\nout vec4 color;\nvoid main() {\n    vec3 n = vec3(1.0, \n    mat2 m = mat2(\n}\n";
    let folder = Folder::new(&[("a.frag", text.as_bytes())]);
    let mut editor = Editor::new(&folder, json!({}));
    editor.open("a.frag", text);
    for (word, label, parameter) in
        [(" \n    mat2", "vec3(float x, float y, float z)", 1), ("\n}", "mat2(vec2 column0, vec2 column1)", 0)]
    {
        let there = editor.on("a.frag", text, word);
        let help = editor.ask("textDocument/signatureHelp", there);
        assert_eq!(help["signatures"][0]["label"], label, "{help}");
        assert_eq!((help["activeSignature"].as_u64(), help["activeParameter"].as_u64()), (Some(0), Some(parameter)));
        assert!(help["signatures"].as_array().is_some_and(|all| all.len() > 3), "{help}");
    }
    editor.close();
}

/// The overload that the arguments fit, through parentheses that only group, in constructors of arrays, and of macros.
#[test]
fn the_active_signature_is_the_one_that_fits() {
    let text = "#version 150\nin vec3 passed;\nuniform sampler2D tex;\nuniform samplerCube cube;\nuniform isampler2DArray layers;\nstruct P { vec3 o; float r; };\n\
        vec3 blend(vec3 a, vec3 b, float k) { return mix(a, b, k); }\n\
        float helper(vec3 a, float b) { return b; }\nfloat helper(float a) { return a; }\nfloat helper(P p, int b) { return p.r; }\n\
        #define TWO(p, q) blend(p, q, 0.5)\nout vec4 color;\nvoid main() {\n    vec3 nrm = passed;\n    P ball;\n@@\n    color = vec4(nrm, 1.0);\n}\n";
    let folder = Folder::new(&[("a.frag", text.replace("@@", "").as_bytes())]);
    let mut editor = Editor::new(&folder, json!({}));
    editor.open("a.frag", &text.replace("@@", ""));
    for (number, (line, label, parameter)) in [
        ("texture(cube, |", "gvec4 texture(gsamplerCube sampler, vec3 P [, float bias])", 1),
        ("texture(layers, |", "gvec4 texture(gsampler2DArray sampler, vec3 P [, float bias])", 1),
        ("float f = helper(1.0|)", "float helper(float a)", 0),
        ("float f = helper(nrm|", "float helper(vec3 a, float b)", 0),
        ("float f = helper(ball, |", "float helper(P p, int b)", 1),
        ("float f = helper(blend(nrm, nrm, 1.0), |", "float helper(vec3 a, float b)", 1),
        ("blend(nrm, (nrm.x > 0.0 ? |", "vec3 blend(vec3 a, vec3 b, float k)", 1),
        ("blend(((nrm + |", "vec3 blend(vec3 a, vec3 b, float k)", 0),
        ("blend(nrm, nrm * (2.0), |", "vec3 blend(vec3 a, vec3 b, float k)", 2),
        ("float a[3] = float[3](1.0, |", "float[3](float element0, float element1, float element2)", 1),
        ("float a[2] = float[](1.0, |", "float[](float element0, float element1, ...)", 1),
        ("P all[2] = P[2](|", "P[2](P element0, P element1)", 0),
        ("vec2 a[2] = vec2[2](vec2(1.0), vec2(|", "vec2(float x, float y)", 0),
        ("nrm = vec3(nrm.xy, |", "vec3(vec2 xy, float z)", 1),
        ("nrm = vec3(nrm.x, nrm.xy|", "vec3(float x, vec2 yz)", 1),
        ("P q = P(nrm, |", "P(vec3 o, float r)", 1),
        ("nrm = TWO(nrm, |", "#define TWO(p, q)", 1),
        ("float d = dot(nrm.xy, |", "float dot(genType x, genType y)", 1),
        ("nrm = mix(nrm, nrm, 0.5|", "genType mix(genType x, genType y, float a)", 2),
    ]
    .into_iter()
    .enumerate()
    {
        let marked = text.replace("@@", line);
        let place = editor.at(&marked, "|");
        editor.change("a.frag", number as i64 + 2, json!([{ "text": marked.replacen('|', "", 1) }]));
        let uri = editor.uri("a.frag");
        let help =
            editor.ask("textDocument/signatureHelp", json!({ "textDocument": { "uri": uri }, "position": place }));
        let active = help["activeSignature"].as_u64().unwrap_or(99) as usize;
        assert_eq!(help["signatures"][active]["label"], label, "{line}: {help:#}");
        assert_eq!(help["activeParameter"], parameter, "{line}");
    }
    for (number, line) in ["if (|", "(|", "nrm[|", "unknown(|", "color[0](|"].into_iter().enumerate() {
        let marked = text.replace("@@", line);
        let place = editor.at(&marked, "|");
        editor.change("a.frag", number as i64 + 50, json!([{ "text": marked.replacen('|', "", 1) }]));
        let uri = editor.uri("a.frag");
        let help =
            editor.ask("textDocument/signatureHelp", json!({ "textDocument": { "uri": uri }, "position": place }));
        assert!(help.is_null(), "{line}: {help}");
    }
    editor.close();
}

/// A name that is declared twice has no type, and is described by its line, unless that has thousands of names.
#[test]
fn a_name_that_is_declared_twice_is_described_by_a_short_line() {
    let nested = json!({ "textDocument": { "documentSymbol": { "hierarchicalDocumentSymbolSupport": true } } });
    for (count, is_described) in [(3, true), (2_000, false)] {
        let text = format!("#version 150\n{}\n", "float x;".repeat(count));
        let folder = Folder::new(&[("a.frag", text.as_bytes())]);
        let mut editor = Editor::new(&folder, nested.clone());
        editor.open("a.frag", &text);
        let uri = editor.uri("a.frag");
        let answer = editor.ask("textDocument/documentSymbol", json!({ "textDocument": { "uri": uri } }));
        let list = answer.as_array().expect("a list");
        let last = list.last().expect("a symbol");
        assert_eq!((list.len(), last["detail"].is_string()), (count, is_described), "{last}");
        editor.close();
    }
}

/// A carriage return alone ends a line (GLSL 1.50 §3.1), and formatting loses no statement by it.
#[test]
fn lines_may_end_with_carriage_returns() {
    let text = "#version 150\nout vec4 c;\nvoid main() {\nfloat x=1.0; // one\nc=vec4(x);\n}\n";
    let wanted = "#version 150\nout vec4 c;\nvoid main() {\n    float x = 1.0;  // one\n    c = vec4(x);\n}\n";
    for (from, end) in [("\n", "\r"), ("one\n", "\r"), (";\nvoid", "\r"), ("\n}", "\r"), ("\n", "\r\n")] {
        let text = text.replace(from, &from.replace('\n', end));
        let folder = Folder::new(&[("a.frag", text.as_bytes())]);
        let mut editor = Editor::new(&folder, json!({}));
        editor.open("a.frag", &text);
        let uri = editor.uri("a.frag");
        let options = json!({ "tabSize": 4, "insertSpaces": true });
        let edits =
            editor.ask("textDocument/formatting", json!({ "textDocument": { "uri": uri }, "options": options }));
        // The lines of the protocol end with each of the three.
        let plain: Vec<&str> = text.split_inclusive(['\n', '\r']).collect();
        let mut lines: Vec<String> = Vec::new();
        for piece in plain {
            match lines.last_mut().filter(|last| piece == "\n" && last.ends_with('\r')) {
                Some(last) => last.push('\n'),
                None => lines.push(piece.to_owned()),
            }
        }
        let offset = |place: &Value| {
            let line = place["line"].as_u64().expect("a line") as usize;
            let before: usize = lines.iter().take(line).map(String::len).sum();
            before + place["character"].as_u64().expect("a column") as usize
        };
        let mut formatted = text.clone();
        for edit in edits.as_array().expect("edits").iter().rev() {
            let range = offset(&edit["range"]["start"])..offset(&edit["range"]["end"]);
            formatted.replace_range(range, edit["newText"].as_str().expect("a text"));
        }
        let all = if from == "\n" { wanted.replace('\n', end) } else { wanted.to_owned() };
        assert_eq!(formatted, all, "{text:?}: {edits}");
        editor.close();
    }
}
