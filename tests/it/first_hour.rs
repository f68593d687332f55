//! The first hour of a new user, end to end: scenes that draw nothing, values that are missing, comments in any
//! encoding, names of files, the adapter, summaries.

use crate::cli::{Folder, code, codes, err, out};
use serde_json::Value;
use std::fs;
use std::process::Command;

const VERTEX: &str = "#version 150\nin vec3 p, n;\nuniform mat4 mc;\nuniform vec3 shift;\nuniform struct { vec4 a; float b; } \
    light;\nout vec3 v, w;\nvoid main() {\n    v = n * light.a.xyz * light.b;\n    w = n;\n    gl_Position = mc * vec4(p + \
    shift, 1.0);\n}\n";
const FRAGMENT: &str = "#version 150\nin vec3 v;\nuniform sampler2D one, two;\nout vec4 c;\nvoid main() {\n    c = vec4(v, \
    1.0) + texture(one, v.xy) + texture(two, v.xy);\n}\n";
const HEAD: &str = "[[draw]]\nvertex = \"a.vert\"\nfragment = \"a.frag\"\n";
/// A program that needs two floats a vertex.
pub(crate) const FLAT: (&str, &str) = (
    "#version 150\nin vec2 p;\nvoid main() { gl_Position = vec4(p, 0.0, 1.0); }\n",
    "#version 150\nout vec4 c;\nvoid main() { c = vec4(1.0); }\n",
);

pub(crate) fn scene(vertex: &str, fragment: &str, text: &str) -> Folder {
    Folder::new(&[("a.vert", vertex.as_bytes()), ("a.frag", fragment.as_bytes()), ("a.toml", text.as_bytes())])
}

pub(crate) fn render(folder: &Folder, arguments: &[&str]) -> (i32, String) {
    let all = [&["render", "a.toml", "-o", "a.npy", "--backend", "cpu"], arguments].concat();
    let output = folder.run(&all);
    (code(&output), err(&output))
}

/// The diagnostics of `render`: code and message of each.
fn findings(folder: &Folder) -> Vec<(String, String)> {
    let (_, text) = render(folder, &["--diagnostics", "json"]);
    let list: Vec<Value> = serde_json::from_str(&text).unwrap_or_else(|error| panic!("{error}: {text}"));
    let word = |finding: &Value, key: &str| finding[key].as_str().unwrap_or("").to_owned();
    list.iter().map(|finding| (word(finding, "code"), word(finding, "message"))).collect()
}

fn verify(folder: &Folder, arguments: &[&str]) -> (i32, Value, String) {
    let output = folder.run(&[&["verify", "a.toml", "--format", "json"], arguments].concat());
    let json = serde_json::from_str(&out(&output)).unwrap_or(Value::Null);
    (code(&output), json, err(&output))
}

#[test]
fn what_draws_nothing_never_holds() {
    let quad = "values = [-1, -1, 1, -1, 0, 1]";
    let cases = [
        ("a scene without a draw", "[framebuffer]\nwidth = 8\nheight = 8\n".to_owned(), "W0908"),
        ("a degenerate mesh", format!("{HEAD}mesh = {{ shape = \"plane\", position = \"p\" }}\n"), "W0909"),
        ("no vertex", format!("{HEAD}[draw.attributes]\np = {{ size = 2, values = [] }}\n"), "W0909"),
        ("no instance", format!("{HEAD}instances = 0\n[draw.attributes]\np = {{ size = 2, {quad} }}\n"), "W0909"),
    ];
    for (what, text, warning) in cases {
        let folder = scene(FLAT.0, FLAT.1, &text);
        let (exit, told) = render(&folder, &[]);
        assert_eq!(exit, 0, "{what}: {told}");
        assert!(told.contains(warning), "{what}: {told}");
        let (exit, json, told) = verify(&folder, &[]);
        assert_eq!(
            (exit, &json["verdict"], &json["holds"]),
            (1, &"inconclusive".into(), &false.into()),
            "{what}: {told}"
        );
        let (exit, json, _) = verify(&folder, &["--allow-inconclusive"]);
        assert_eq!((exit, &json["verdict"]), (0, &"inconclusive".into()), "{what}");
        let denied = render(&folder, &["--deny", "warnings"]);
        assert_eq!(denied.0, 1, "{what}: {}", denied.1);
    }
    let folder = scene(FLAT.0, FLAT.1, &format!("{HEAD}[draw.attributes]\np = {{ size = 2, {quad} }}\n"));
    let (exit, told) = render(&folder, &["--deny", "warnings"]);
    assert_eq!(exit, 0, "{told}");
    let (exit, json, told) = verify(&folder, &[]);
    assert_eq!((exit, &json["verdict"]), (0, &"holds".into()), "{told}");
    assert!(json["adapter"].as_str().is_some_and(|name| !name.is_empty()) && json["driver"].is_string(), "{json}");
}

#[test]
fn a_mesh_that_loses_a_component_is_noted() {
    let mesh = format!("{HEAD}mesh = {{ shape = \"quad\", position = \"p\" }}\n");
    let told = findings(&scene(FLAT.0, FLAT.1, &mesh));
    assert!(matches!(&told[..], [(code, message)] if code == "W0910" && message.contains('3')), "{told:?}");
    let whole = FLAT.0.replace("vec2 p", "vec3 p").replace("p, 0.0, 1.0", "p, 1.0");
    assert_eq!(findings(&scene(&whole, FLAT.1, &mesh)), []);
}

#[test]
fn everything_that_is_missing_is_told_once() {
    let folder = scene(VERTEX, FRAGMENT, HEAD);
    let told = findings(&folder);
    for (code, name) in [
        ("E0909", "`p`"),
        ("E0909", "`n`"),
        ("W0901", "`mc`"),
        ("W0901", "`shift`"),
        ("W0901", "`light.a`"),
        ("W0902", "`one`"),
        ("W0902", "`two`"),
    ] {
        let count = told.iter().filter(|(told, message)| told == code && message.contains(name)).count();
        assert_eq!(count, 1, "{code} {name}: {told:#?}");
    }
    assert_eq!(told.len(), 3, "one list for each kind: {told:#?}");
}

#[test]
fn what_the_helps_say_can_be_pasted() {
    let folder = scene(VERTEX, FRAGMENT, HEAD);
    let output = folder.run(&["render", "a.toml", "-o", "a.npy", "--diagnostics", "json"]);
    let list: Vec<Value> = serde_json::from_str(&err(&output)).expect("JSON");
    let mut tables: Vec<(String, Vec<String>)> = Vec::new();
    for finding in &list {
        let help = finding["help"].as_str().expect("a help");
        if let Some(line) = help.strip_prefix("add `mesh").and_then(|line| line.strip_suffix("` to the draw")) {
            tables.push(("draw.mesh".to_owned(), vec![format!("mesh{line}")]));
            continue;
        }
        let (table, lines) = match help.split_once(":\n") {
            Some((head, lines)) => (head, lines.lines().map(str::to_owned).collect()),
            None => (help, vec![help.split('`').nth(1).expect("a line to paste").to_owned()]),
        };
        let table =
            table.split_once("under [").and_then(|(_, rest)| rest.split_once(']')).expect("a table").0.to_owned();
        match tables.iter_mut().find(|(known, _)| *known == table) {
            Some((_, known)) => known.extend(lines),
            None => tables.push((table, lines)),
        }
    }
    let mut text = HEAD.to_owned();
    for (table, lines) in tables {
        let header = if table == "draw.mesh" { String::new() } else { format!("[{table}]\n") };
        text.push_str(&format!("{header}{}\n", lines.join("\n")));
    }
    fs::write(folder.path("a.toml"), &text).expect("written");
    assert_eq!(findings(&folder), [], "{text}");
}

#[test]
fn the_true_error_comes_first() {
    let values = "[1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]";
    let data = "[draw.attributes]\np = { size = 3, values = [0, 0, 0] }\nn = { size = 3, values = [0, 0, 0] }\n";
    for (uniforms, error) in [
        (format!("mcc = {values}"), "E0907"),
        ("mc = [1, 2]".to_owned(), "E0908"),
        ("mc = [true]".to_owned(), "E0908"),
        ("mc = \"x\"".to_owned(), "E0904"),
    ] {
        let folder = scene(VERTEX, FRAGMENT, &format!("{HEAD}{data}[draw.uniforms]\n{uniforms}\n"));
        let told = findings(&folder);
        assert_eq!(told[0].0, error, "{told:#?}");
        assert!(told.iter().all(|(code, message)| code == error || !message.contains("`mc`")), "{told:#?}");
        assert!(told.iter().any(|(_, message)| message.contains("`shift`")), "{told:#?}");
    }
    let folder = scene(VERTEX, FRAGMENT, &format!("{HEAD}{}", data.replace("p =", "pp =").replace("n =", "nn =")));
    let told: Vec<String> = findings(&folder).into_iter().map(|(code, _)| code).collect();
    assert_eq!(told[..2], ["E0907", "E0907"], "{told:?}");
    assert!(!told.contains(&"E0909".to_owned()) && !told.contains(&"E0906".to_owned()), "{told:?}");
    let folder = scene(VERTEX, FRAGMENT, &format!("{HEAD}[draw.meshh]\nshape = \"quad\"\n"));
    assert_eq!(findings(&folder)[0].0, "E0903");
    let folder = scene(VERTEX, FRAGMENT, &format!("{HEAD}[draw.mesh]\nshape = \"quad\"\n"));
    let (_, told) = render(&folder, &[]);
    assert!(
        told.contains("add under [draw.mesh]:") && told.contains("position = \"p\"") && told.contains("normal = \"n\""),
        "{told}"
    );
}

#[test]
fn an_attribute_needs_data_only_where_it_reaches_an_output() {
    let text = format!("{HEAD}[draw.attributes]\np = {{ size = 2, values = [-1, -1, 1, -1, 0, 1] }}\n");
    let vertex = |body: &str| {
        format!(
            "#version 150\nin vec2 p;\nin vec3 t;\nout vec3 v;\nout vec3 unread;\nvoid main() {{\n    v = vec3(0.0); \
             unread = vec3(0.0);\n    gl_Position = vec4(p, 0.0, 1.0);\n    {body}\n}}\n"
        )
    };
    let fragment = "#version 150\nin vec3 v;\nout vec4 c;\nvoid main() { c = vec4(v, 1.0); }\n";
    for (body, expected) in [
        ("unread = t;", "W0906"),
        ("vec3 local = t * 2.0;", "W0906"),
        ("v = t;", "E0909"),
        ("if (t.x > 0.5) gl_Position = vec4(0.0);", "E0909"),
    ] {
        let folder = scene(&vertex(body), fragment, &text);
        let told = findings(&folder);
        assert!(matches!(&told[..], [(code, _)] if code == expected), "{body}: {told:?}");
        assert_eq!(render(&folder, &[]).0, i32::from(expected.starts_with('E')), "{body}");
    }
    let folder = scene(&vertex("unread = t;"), fragment, &text);
    assert_eq!(verify(&folder, &[]).0, 0);
}

/// The picture of a scene on a backend.
fn picture(folder: &Folder, backend: &str) -> Vec<u8> {
    let output = folder.run(&["render", "a.toml", "-o", "p.npy", "--backend", backend]);
    assert_eq!(code(&output), 0, "{backend}: {}", err(&output));
    fs::read(folder.path("p.npy")).expect("written")
}

#[test]
fn sizes_and_counts_mean_the_same_on_both_sides() {
    let triangle = |size: u32, values: &str| {
        scene(FLAT.0, FLAT.1, &format!("{HEAD}[draw.attributes]\np = {{ size = {size}, values = [{values}] }}\n"))
    };
    let plain = triangle(2, "-1, -1, 1, -1, 0, 1");
    let excess = triangle(4, "-1, -1, 7, 7, 1, -1, 7, 7, 0, 1, 7, 7");
    for backend in ["gpu", "cpu"] {
        assert!(picture(&plain, backend) == picture(&excess, backend), "{backend}");
    }
    let indexed = |keys: &str| {
        let data = "[draw.attributes]\np = { size = 2, values = [-1, -1, 1, -1, 1, 1, -1, 1] }\n";
        scene(FLAT.0, FLAT.1, &format!("{HEAD}indices = [0, 1, 2, 0, 2, 3]\n{keys}{data}"))
    };
    let (all, counted) = (indexed(""), indexed("vertex_count = 4\n"));
    for backend in ["gpu", "cpu"] {
        assert!(picture(&all, backend) == picture(&counted, backend), "{backend}: all indices are drawn");
    }
    assert!(picture(&all, "gpu") == picture(&all, "cpu"));
    for (keys, place) in [("vertex_count = 6\n", "data for 4"), ("vertex_count = 3\n", "past the last vertex")] {
        let (exit, told) = render(&indexed(keys), &[]);
        assert!(exit == 1 && told.contains("E0908") && told.contains(place), "{told}");
    }
}

#[test]
fn comments_hold_any_encoding_and_binaries_are_refused() {
    let source = |comment: &[u8], value: &str| {
        let body = format!("\nout vec4 c;\nvoid main() {{ c = vec4({value}); }}\n");
        [b"#version 150 // ", comment, b"\n/* ", comment, b" */ /* x */ //", comment, body.as_bytes()].concat()
    };
    let encodings: [(&str, &[u8]); 5] = [
        ("Shift_JIS", b"\x83e\x83N\x83X\x83`\x83\x83\x8d\xc0\x95W\x95\\"),
        ("EUC-JP", b"\xa5\xc6\xa5\xaf\xa5\xb9\xa5\xc1\xa5\xe3\xba\xc2\xc9\xb8"),
        ("Latin-1", b"caf\xe9 na\xefve \xa9"),
        ("GB18030", b"\xce\xc6\xc0\xed\xd7\xf8\xb1\xea \x81\x30\x84\x36"),
        ("UTF-8", "座標 — é".as_bytes()),
    ];
    for (name, comment) in encodings {
        let folder = Folder::new(&[("a.frag", &source(comment, "undeclared"))]);
        let (list, exit) = folder.lint(&["a.frag"]);
        assert_eq!((codes(&list), exit), (vec!["E0301"], 1), "{name}");
        assert_eq!((list[0]["line"].as_u64(), list[0]["column"].as_u64()), (Some(4), Some(24)), "{name}");
        for format in ["human", "github"] {
            assert!(out(&folder.run(&["lint", "a.frag", "--format", format])).contains("undeclared"), "{name}");
        }
        let sarif = out(&folder.run(&["lint", "a.frag", "--format", "sarif"]));
        let sarif: Value = serde_json::from_str(&sarif).expect("JSON");
        let region = &sarif["runs"][0]["results"][0]["locations"][0]["physicalLocation"]["region"];
        assert_eq!((region["startLine"].as_u64(), region["startColumn"].as_u64()), (Some(4), Some(24)), "{name}");
        fs::write(folder.path("a.frag"), source(comment, "1.0")).expect("written");
        let compiled = folder.run(&["compile", "a.frag", "-o", "out"]);
        assert_eq!(code(&compiled), 0, "{name}: {}", err(&compiled));
    }
    for bytes in [&b"#version 150\n\0"[..], b"\x7fELF\x02\x01\x01", b"\x89PNG\r\n\x1a\n"] {
        let folder = Folder::new(&[("a.frag", bytes)]);
        let (list, exit) = folder.lint(&["a.frag"]);
        assert_eq!((codes(&list), exit), (vec!["E0014"], 1), "{bytes:?}");
    }
}

/// Checks files with spirv-val, if it is there; on the machines of the tests it must be.
fn spirv_val(folder: &Folder, files: &[&str]) {
    for file in files {
        match Command::new("spirv-val").args(["--target-env", "vulkan1.1"]).arg(folder.path(file)).output() {
            Ok(output) => assert!(output.status.success(), "{file}: {}", out(&output)),
            Err(_) => assert!(std::env::var_os("CI").is_none(), "spirv-val is missing"),
        }
    }
}

#[test]
fn vectors_of_named_constants_are_valid() {
    for body in [
        "vec3 m = k; o = vec4(m, 0.0);",
        "vec2 m = two; o = vec4(m, m);",
        "vec3 m = k; o = vec4(0.5, m);",
        "vec2 m = two; const vec2 n = vec2(0.25); o = vec4(m, n);",
        "vec2 m = vec2(0.5); o = vec4(m, two);",
        "vec2 m = two; mat2 r = mat2(m, m); o = vec4(r[0], r[1]);",
        "vec3 m = k; vec3 n = m; o = vec4(n, two.x) + vec4(two, m.xy);",
    ] {
        let text = format!(
            "#version 150\nout vec4 o;\nconst vec3 k = vec3(0.1, 0.2, 0.3);\nconst vec2 two = vec2(0.5, 0.25);\n\
             void main() {{ {body} }}\n"
        );
        let folder = Folder::new(&[("a.frag", text.as_bytes())]);
        let output = folder.run(&["compile", "a.frag", "-o", "out", "-O0"]);
        assert_eq!(code(&output), 0, "{body}: {}", err(&output));
        spirv_val(&folder, &["out/a.frag.spv"]);
    }
}

#[test]
fn initializers_of_globals_may_call_functions() {
    let vertex = "#version 150\nin vec2 p;\nuniform vec2 a;\nvec2 h = vec2(0.5);\nvec2 g(vec2 x) { h.y = 1.0; return x * h; }\n\
        vec2 f(vec2 x) { return g(x) + p * 0.0; }\nvec2 k = f(a);\nvec2 unused = g(a);\nout vec2 v;\n\
        void main() { v = k; gl_Position = vec4(p, 0.0, 1.0); }\n";
    let fragment = "#version 150\nin vec2 v;\nuniform float s;\nfloat f(float x) { return x * 2.0; }\nfloat g = f(s);\n\
        out vec4 c;\nvoid main() { c = vec4(v, g, 1.0); }\n";
    let text = format!(
        "[framebuffer]\nwidth = 4\nheight = 4\n{HEAD}[draw.attributes]\np = {{ values = [-1, -1, 3, -1, -1, 3] }}\n\
         [draw.uniforms]\na = [0.5, 0.25]\ns = 0.125\n"
    );
    let folder = scene(vertex, fragment, &text);
    let output = folder.run(&["compile", "a.vert", "a.frag", "-o", "out", "-O0"]);
    assert_eq!(code(&output), 0, "{}", err(&output));
    spirv_val(&folder, &["out/a.vert.spv", "out/a.frag.spv"]);
    let (exit, json, told) = verify(&folder, &[]);
    assert_eq!((exit, &json["verdict"]), (0, &"holds".into()), "{told}");
    let worst = picture(&folder, "cpu");
    let last: Vec<f32> = worst[worst.len() - 16..]
        .chunks(4)
        .filter_map(|four| Some(f32::from_le_bytes(four.try_into().ok()?)))
        .collect();
    assert_eq!(last, [0.25, 0.25, 0.25, 1.0]);
}

#[test]
fn absolute_includes_start_at_the_folders_of_the_search_path() {
    let text = b"#version 150\n#extension GL_ARB_shading_language_include : require\n#include \"/lib/x.glsl\"\n\
        #include </lib/y.glsl>\nout vec4 c;\nvoid main() { c = vec4(x() + y()); }\n";
    let folder = Folder::new(&[
        ("a.frag", text),
        ("shaders/lib/x.glsl", b"#include \"/lib/z.glsl\"\nfloat x() { return z(); }\n"),
        ("shaders/lib/y.glsl", b"float y() { return 1.0; }\n"),
        ("shaders/lib/z.glsl", b"#extension GL_ARB_shading_language_include : require\nfloat z() { return 1.0; }\n"),
    ]);
    let found = folder.lint(&["a.frag", "-I", "shaders"]);
    assert!(found.1 == 0, "{:#?}", found.0);
    let (list, exit) = folder.lint(&["a.frag", "-I", "."]);
    assert!(exit == 2 && codes(&list).contains(&"E0127"), "{list:#?}");
}

/// A file that is found and is no text was not looked for in vain.
#[test]
fn a_binary_include_is_told_as_that() {
    let text =
        b"#version 150\n#extension GL_ARB_shading_language_include : require\n#include \"b.glsl\"\nout vec4 c;\n\
        void main() { c = vec4(x()); }\n";
    let folder = Folder::new(&[("a.frag", text), ("b.glsl", b"\xff\xfe\0")]);
    let (list, exit) = folder.lint(&["a.frag"]);
    assert_eq!((codes(&list), exit), (vec!["E0014"], 1), "{list:#?}");
}

#[test]
fn stages_are_known_by_more_names() {
    let (vertex, fragment) = (FLAT.0.as_bytes(), FLAT.1.as_bytes());
    let folder = Folder::new(&[
        ("a_vs.glsl", vertex),
        ("a_fs.glsl", fragment),
        ("b.vert.glsl", vertex),
        ("b.frag.glsl", fragment),
        ("vs_c.glsl", vertex),
        ("fs_c.glsl", fragment),
        ("d/vertex.glsl", vertex),
        ("d/fragment.glsl", fragment),
        ("common_fs.glsl", b"float half_of(float x) { return 0.5 * x; }\n"),
        ("plain.glsl", fragment),
    ]);
    let output = folder.run(&["lint", "."]);
    assert_eq!((code(&output), out(&output)), (0, String::new()), "{}", err(&output));
    assert!(err(&output).contains("8 files, 4 programs: nothing found"), "{}", err(&output));
    let output = folder.run(&["compile", "a_vs.glsl", "a_fs.glsl", "-o", "out"]);
    assert_eq!(code(&output), 0, "{}", err(&output));
    assert_eq!(folder.names("out"), ["a.json", "a_fs.glsl.spv", "a_fs.glsl.wgsl", "a_vs.glsl.spv", "a_vs.glsl.wgsl"]);
    assert_eq!(code(&folder.run(&["lint", "plain.glsl"])), 2);
    assert_eq!(code(&folder.run(&["lint", "plain.glsl", "--stage", "fragment"])), 0);
}

#[test]
fn a_clean_run_says_so() {
    let folder = Folder::triangle();
    for (arguments, said) in [
        (&["lint", "tri.vert", "tri.frag"][..], "2 files, 1 program: nothing found\n"),
        (&["lint", "tri.vert"], "1 file: nothing found\n"),
        (&["lint", "tri.vert", "tri.frag", "-q"], ""),
        (&["lint", "tri.vert", "tri.frag", "--format", "json"], ""),
    ] {
        let output = folder.run(arguments);
        assert_eq!((code(&output), err(&output).as_str()), (0, said), "{arguments:?}");
    }
    fs::write(folder.path("tri.frag"), "#version 150\nvoid main() { x; }\n").expect("written");
    assert!(!err(&folder.run(&["lint", "."])).contains("nothing found"));
}

#[test]
fn code_goes_to_standard_output_on_request() {
    let folder = Folder::triangle();
    let written = folder.run(&["compile", "tri.frag", "-o", "out", "--target", "wgsl", "--target", "spirv"]);
    assert_eq!(code(&written), 0, "{}", err(&written));
    for (target, extension) in [("wgsl", "wgsl"), ("spirv", "spv")] {
        let output = folder.run(&["compile", "tri.frag", "-o", "-", "--target", target]);
        assert_eq!(code(&output), 0, "{}", err(&output));
        let file = fs::read(folder.path(&format!("out/tri.frag.{extension}"))).expect("written");
        assert!(output.stdout == file, "{target}");
    }
    for arguments in [
        &["tri.frag"][..],
        &["tri.frag", "--target", "wgsl", "--target", "spirv"],
        &["tri.vert", "tri.frag", "--target", "wgsl"],
        &["tri.frag", "--target", "wgsl", "--depfile", "d"],
    ] {
        let output = folder.run(&[&["compile", "-o", "-"], arguments].concat());
        assert_eq!((code(&output), out(&output)), (2, String::new()), "{arguments:?}: {}", err(&output));
    }
    assert_eq!(folder.names("."), ["out", "tri.frag", "tri.vert"]);
}

#[test]
fn the_adapter_is_chosen_and_named() {
    let text = format!("{HEAD}[draw.attributes]\np = {{ size = 2, values = [-1, -1, 1, -1, 0, 1] }}\n");
    let folder = scene(FLAT.0, FLAT.1, &text);
    let run = |variable: &str, arguments: &[&str]| {
        let mut command = folder.command(&[&["render", "a.toml", "-o", "a.png"], arguments].concat());
        command.env("GLISTEN_ADAPTER", variable).output().expect("it runs")
    };
    for (variable, arguments) in
        [("software", &[][..]), ("", &["--adapter", "software"]), ("nonesuch", &["--adapter", "software"])]
    {
        let output = run(variable, arguments);
        assert_eq!(code(&output), 0, "{}", err(&output));
        assert!(err(&output).starts_with("drawn by ") && err(&output).contains(", driver "), "{}", err(&output));
    }
    assert_eq!(err(&run("software", &["-q"])), "");
    for (variable, arguments) in [("nonesuch", &[][..]), ("", &["--adapter", "nonesuch"])] {
        let output = run(variable, arguments);
        assert_eq!(code(&output), 3);
        let told = err(&output);
        assert!(told.contains("`nonesuch`") && told.contains("there are `"), "what was found is listed: {told}");
    }
}

/// The texts under the labels of the findings with a code, the primary one first.
fn labels(text: &str, wanted: &str) -> Vec<Vec<String>> {
    let folder = Folder::new(&[("a.frag", text.as_bytes())]);
    let (list, _) = folder.lint(&["a.frag"]);
    let lines: Vec<Vec<char>> = text.lines().map(|line| line.chars().collect()).collect();
    let under = |place: &Value| {
        let number = |key: &str| place[key].as_u64().expect("a number") as usize;
        lines[number("line") - 1][number("column") - 1..number("end_column") - 1].iter().collect::<String>()
    };
    let all = |finding: &Value| {
        let labels = finding["labels"].as_array().expect("labels");
        [finding].into_iter().chain(labels).map(under).collect()
    };
    list.iter().filter(|finding| finding["code"] == wanted).map(all).collect()
}

#[test]
fn a_divergent_branch_is_told_once_and_the_right_condition_is_blamed() {
    let shader = |body: &str| {
        format!(
            "#version 150\nuniform sampler2D t;\nin vec2 p;\nout vec4 c;\nvec4 inner() {{ return texture(t, p); }}\n\
             vec4 outer() {{ return inner(); }}\nvoid main() {{\n    c = vec4(0.0);\n    {body}\n}}\n"
        )
    };
    for (body, conditions) in [
        ("for (int i = 0; i < 4; i++) { if (c.a > 0.5) break; c += texture(t, p); }", &["c.a > 0.5"][..]),
        ("for (int i = 0; i < int(p.x); i++) { if (i > 3) break; c += texture(t, p); }", &["i < int(p.x)"]),
        ("if (p.x > 0.5) c = outer();", &["p.x > 0.5"]),
        ("if (p.x > 0.5) { c = texture(t, p) + texture(t, p.yx); c += texture(t, p * 2.0); }", &["p.x > 0.5"]),
        ("if (p.x > 0.5) c = texture(t, p); if (p.y > 0.5) c += texture(t, p);", &["p.x > 0.5", "p.y > 0.5"]),
    ] {
        let found = labels(&shader(body), "L0010");
        assert_eq!(found.len(), conditions.len(), "{body}: {found:?}");
        for (labels, condition) in found.iter().zip(conditions) {
            assert!(labels.iter().any(|label| label == condition), "{body}: {labels:?}");
            assert!(!labels.iter().any(|label| label == "i < 4"), "{body}: {labels:?}");
        }
    }
    let many = format!("if (p.x > 0.5) {{ {} }}", "c += texture(t, p); ".repeat(26));
    assert_eq!(labels(&shader(&many), "L0010").len(), 1);
}

#[test]
fn one_mistake_is_one_error() {
    let body = "\n    vec3 n = normalize(v);\n    if (n.x > 0.5) { n.x = 0.5; }\n    c = vec4(n, 1.0);\n}\n";
    let head = "#version 150\n#extension GL_ARB_shading_language_include : require\nin vec3 v;\nout vec4 c;\n";
    let include = "#include \"lights.glsl\"\n";
    let uses = "vec3 lit(Light l) { return l.color * float(MAX_LIGHTS) + direction(l, v); }\n#if SHADOWS > 1\n#endif\n\
        Light all[MAX_LIGHTS];\nvoid main() { c = vec4(lit(all[0]), 1.0) * TINT; for (int i = 0; i < MAX_LIGHTS; i++) c += shade(i); }\n";
    for (text, expected) in [
        (format!("{head}void main(){body}"), vec!["E0201"]),
        (format!("{head}float f(float x)\nvoid main() {{{body}"), vec!["E0202"]),
        (format!("{head}{include}{uses}"), vec!["E0127"]),
        (format!("{head}float early = unknown;\n{include}{uses}"), vec!["E0301", "E0127"]),
        (format!("{head}{include}void main() {{ c = vec4(v, 1.0) * true; }}\n"), vec!["E0127", "E0402"]),
    ] {
        let folder = Folder::new(&[("a.frag", text.as_bytes())]);
        let (list, _) = folder.lint(&["a.frag"]);
        assert_eq!(codes(&list), expected, "{text}\n{list:#?}");
    }
}

#[test]
fn a_search_passes_over_what_is_ignored() {
    let (vertex, fragment) = (FLAT.0.as_bytes(), FLAT.1.as_bytes());
    let broken = b"#version 150\nvoid main() { x; }\n";
    let folder = Folder::new(&[
        (".gitignore", b"/target\nnode_modules/\n*.tmp.frag\n!kept.tmp.frag\n"),
        ("a.vert", vertex),
        ("a.frag", fragment),
        ("kept.tmp.frag", fragment),
        ("gone.tmp.frag", broken),
        ("target/b.frag", broken),
        ("deep/node_modules/c.frag", broken),
        ("deep/.gitignore", b"d.frag\n"),
        ("deep/d.frag", broken),
        ("third/party/e.frag", broken),
        ("gen/f.gen.frag", broken),
        ("old/g.vert", b"void main() { gl_Position = ftransform(); }\n"),
        ("old/h.frag", b"out vec4 c;\nvoid main() { c = vec4(1.0); }\n"),
        ("old/i.frag", b"in vec4 a;\nvoid main() {}\n"),
        ("glisten.toml", b"[lint]\nexclude = [\"third\", \"*.gen.frag\"]\n"),
    ]);
    let output = folder.run(&["lint", "."]);
    assert_eq!((code(&output), out(&output)), (0, String::new()), "{}", err(&output));
    assert!(err(&output).contains("4 files, 1 program: nothing found\n"), "{}", err(&output));
    assert!(err(&output).contains("2 files were not checked"), "{}", err(&output));
    for arguments in [&["old/h.frag"][..], &[".", "old/h.frag"]] {
        let (list, exit) = folder.lint(arguments);
        assert_eq!((codes(&list), exit), (vec!["E0120"], 1), "{arguments:?}");
    }
    for file in ["target/b.frag", "third/party/e.frag", "gen/f.gen.frag"] {
        assert_eq!(folder.lint(&[file]).1, 1, "what is named is checked: {file}");
    }
    fs::write(folder.path("glisten.toml"), "exclude = [\"third\", \"gen\"]\n").expect("written");
    assert_eq!(folder.lint(&["."]).1, 0);
    // What a folder's pattern excludes, no pattern below it brings back, as in `.gitignore`.
    for (patterns, errors) in
        [("\"third/\", \"!third/party\", \"gen\"", 0), ("\"third/*\", \"!third/party\", \"gen\"", 1)]
    {
        fs::write(folder.path("glisten.toml"), format!("exclude = [{patterns}]\n")).expect("written");
        assert_eq!(folder.lint(&["."]).1, errors, "{patterns}");
    }
    fs::write(folder.path("x.glsl"), "void main() {}\n").expect("written");
    fs::write(folder.path("glisten.toml"), "[[source]]\nstage = \"bogus\"\n").expect("written");
    let output = folder.run(&["lint", "x.glsl"]);
    assert!(err(&output).contains("`stage = \"bogus\"` of glisten.toml is none"), "{}", err(&output));
    fs::write(folder.path("glisten.toml"), "exclude = [\"{a\"]\n").expect("written");
    let (list, _) = folder.lint(&["a.frag"]);
    assert_eq!(codes(&list), ["E0015"], "{list:#?}");
}

/// Sources of WebGL seldom have a `#version` line, which GLSL ES 1.00 does not ask for.
#[test]
fn a_precision_without_a_version_is_that_of_es() {
    let folder = Folder::new(&[
        ("a.vert", b"attribute vec4 p;\nvarying vec2 uv;\nvoid main() { gl_Position = p; uv = p.xy; }\n" as &[u8]),
        ("a.frag", b"precision mediump float;\nvarying vec2 uv;\nvoid main() { gl_FragColor = vec4(uv, 0.0, 1.0); }\n"),
        ("b.frag", b"precision mediump float;\nin vec2 uv;\nout vec4 c;\nvoid main() { c = vec4(uv, 0.0, 1.0); }\n"),
        ("c.frag", b"#ifdef GL_ES\nprecision mediump float;\n#endif\nvoid main() { gl_FragColor = gl_Color; }\n"),
    ]);
    let (list, exit) = folder.lint(&["."]);
    assert_eq!((codes(&list), exit), (vec!["W0116", "W0116"], 0), "{list:#?}");
    assert_eq!(list[0]["message"], "the source has no `#version` line, and is read as GLSL ES 1.00");
    assert_eq!(list[1]["message"], "the source has no `#version` line, and is read as GLSL ES 3.00");
    assert!(list[1]["help"].as_str().is_some_and(|help| help.contains("`#version 300 es`")), "{list:#?}");
    let (list, exit) = folder.lint(&["b.frag", "--assume-version", "300 es"]);
    assert_eq!((codes(&list), exit), (vec![], 0), "{list:#?}");
    assert_eq!(folder.lint(&["a.frag", "--deny", "assumed-version"]).1, 1);
}

#[test]
fn a_text_of_another_language_is_one_error() {
    let wgsl = "struct Out {\n    @builtin(position) p: vec4<f32>,\n};\n@vertex\nfn main(@location(0) p: vec4<f32>) -> Out {\n    \
        var o: Out;\n    o.p = p;\n    return o;\n}\n";
    let hlsl = "cbuffer Camera : register(b0) { float4x4 view; };\nstruct V { float4 p : SV_Position; };\nV main(float3 p : POSITION) {\n    \
        V v;\n    v.p = mul(view, float4(p, 1.0f));\n    return v;\n}\n";
    let folder = Folder::new(&[("w.vert", wgsl.as_bytes()), ("h.vert", hlsl.as_bytes())]);
    for (file, message) in [("w.vert", "this is WGSL, and"), ("h.vert", "this is HLSL, and")] {
        let (list, exit) = folder.lint(&[file]);
        assert_eq!((codes(&list), exit), (vec!["E0018"], 1), "{list:#?}");
        assert!(list[0]["message"].as_str().is_some_and(|text| text.starts_with(message)), "{list:#?}");
    }
}

#[test]
fn all_mistakes_of_a_configuration_are_told_at_their_places() {
    let folder = Folder::new(&[
        ("a.frag", b"#version 150\nout vec4 c;\nvoid main() { c = vec4(1.0); }\n"),
        (
            "glisten.toml",
            b"[lint]\nalow = [\"L0001\"]\ndeny = [\"L9999\"]\n[[source]]\nengin = \"iris\"\nversion = 77\n[stabilty]\n",
        ),
        (
            "p.toml",
            b"[[program]]\nfils = [\"a.frag\"]\n[[program]]\nfiles = [\"a.frag\"]\ndefines = { A = [0, 1] }\n[scene]\nfile = 1\n",
        ),
    ]);
    let (list, exit) = folder.lint(&["a.frag"]);
    let places: Vec<_> = list.iter().map(|one| one["line"].as_u64().unwrap_or_default()).collect();
    assert_eq!((codes(&list), places, exit), (vec!["E0015"; 5], vec![7, 2, 3, 5, 6], 1), "{list:#?}");
    let told = folder.run(&["compile", "--permutations", "p.toml", "--target", "wgsl", "-o", "out"]);
    let text = err(&told);
    for part in
        ["p.toml:2:1", "did you mean `files`?", "p.toml:5:17", "[program.values]", "p.toml:6:1", "write `[[scene]]`"]
    {
        assert!(text.contains(part), "{part}: {text}");
    }
    assert_eq!(code(&told), 1);
}

#[test]
fn a_file_with_pragma_once_is_one_file_under_all_names() {
    let folder = Folder::new(&[
        ("inc/b.glsl", b"#pragma once\nconst float K = 1.0;\n"),
        (
            "inc/a.frag",
            b"#version 150\n#extension GL_ARB_shading_language_include : require\n#include \"b.glsl\"\n\
              #include \"../inc/b.glsl\"\n#include \"./b.glsl\"\nout vec4 c;\nvoid main() { c = vec4(K); }\n",
        ),
    ]);
    for from in [".", "inc"] {
        let file = if from == "." { "inc/a.frag" } else { "a.frag" };
        let mut command = Command::new(env!("CARGO_BIN_EXE_glisten"));
        let output = command.current_dir(folder.path(from)).args(["lint", file]).output().expect("the program runs");
        assert_eq!(code(&output), 0, "from {from}: {}{}", out(&output), err(&output));
    }
}
