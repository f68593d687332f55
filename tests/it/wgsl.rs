//! WGSL that one would keep, and what the reflection says of it, from the outside.

use crate::cli::{Folder, code, err, out};
use serde_json::Value;
use std::fs;

const VERTEX: &str = "#version 150\n// SPDX-License-Identifier: MIT\n/* Water,\n   as of old */\n\n\
    in vec4 p;\nvoid main() { gl_Position = p; }\n";

/// The WGSL of a fragment shader.
fn wgsl(fragment: &str) -> String {
    let folder = Folder::new(&[("a.frag", fragment.as_bytes())]);
    let output = folder.run(&["compile", "a.frag", "-o", "-", "--target", "wgsl"]);
    assert_eq!(code(&output), 0, "{}", err(&output));
    out(&output)
}

fn with_version(body: &str) -> String {
    format!("#version 150\n{body}")
}

#[test]
fn a_header_says_where_it_comes_from_and_licenses_are_carried_over() {
    let folder = Folder::new(&[("water.vert", VERTEX.as_bytes())]);
    for (target, extension, comment) in [
        ("wgsl", "wgsl", "// water.vert, translated by glisten "),
        ("msl", "metal", "// water.vert, translated by glisten "),
        ("hlsl", "hlsl", "// water.vert, translated by glisten "),
        ("glsl", "glsl", "#version 330\n// water.vert, translated by glisten "),
    ] {
        let output = folder.run(&["compile", "water.vert", "-o", "out", "--target", target]);
        assert_eq!(code(&output), 0, "{}", err(&output));
        let text = fs::read_to_string(folder.path(&format!("out/water.vert.{extension}"))).expect("it was written");
        assert!(text.starts_with(comment), "{text}");
        assert!(text.contains("\n// SPDX-License-Identifier: MIT\n/* Water,\n   as of old */\n"), "{text}");
    }
}

#[test]
fn the_hash_of_the_header_is_that_of_the_content() {
    let first = |text: &str| wgsl(text).lines().next().unwrap_or_default().to_owned();
    let one = "#version 150\nout vec4 c;\nvoid main() { c = vec4(1.0); }\n";
    assert_eq!(first(one), first(one));
    assert_ne!(first(one), first(&one.replace("1.0", "2.0")));
}

#[test]
fn comments_stay_beside_what_they_belong_to() {
    let text = wgsl(
        "#version 150\n// Some lights.\n\n// A light.\nstruct Light {\n    vec3 color;  // linear\n    float power;\n};\n\n\
         // All of them.\nuniform Light lights[2];\nuniform float gain;  // 0 to 1\nout vec4 c;\n\n\
         // Adds /* up */ everything.\nvec3 total(float x) { return lights[0].color * x; }\n\n\
         /* The entry /* of it. */\nvoid main() { c = vec4(total(gain), lights[1].power); }\n",
    );
    for part in [
        "// A light.\nstruct Light {\n    color: vec3<f32>,  // linear\n",
        "    // All of them.\n    lights: ",
        "    gain: f32,  // 0 to 1\n",
        "everything.\nfn total(",
        "of it.\n@fragment\nfn main(",
    ] {
        assert!(text.contains(part), "no {part:?} in\n{text}");
    }
    assert_eq!(text.matches("// A light.").count(), 1, "{text}");
    // A comment that nests in WGSL alone would swallow the rest.
    assert_eq!(text.matches("/*").count(), text.matches("*/").count(), "{text}");
    naga::front::wgsl::parse_str(&text).unwrap_or_else(|error| panic!("{}", error.emit_to_string(&text)));
}

#[test]
fn a_license_above_the_first_declaration_is_written_once() {
    let text = wgsl("#version 150\n// Licensed.\nuniform float k;\nout vec4 c;\nvoid main() { c = vec4(k); }\n");
    assert_eq!(text.matches("// Licensed.").count(), 1, "{text}");
    let unused = wgsl("#version 150\n// Licensed.\nuniform float k;\nout vec4 c;\nvoid main() { c = vec4(1.0); }\n");
    assert_eq!(unused.matches("// Licensed.").count(), 1, "{unused}");
}

#[test]
fn hostile_comments_do_not_become_code() {
    let text = wgsl(
        "#version 150\n// one\u{2028}fn evil() {}\n/* two */ /* /* */\nout vec4 c;\n\
         // three\u{85}struct Evil {}\nvoid main() { c = vec4(1.0); }\n",
    );
    let module = naga::front::wgsl::parse_str(&text).unwrap_or_else(|error| panic!("{}", error.emit_to_string(&text)));
    assert!(module.functions.is_empty(), "{text}");
}

#[test]
fn only_the_row_of_a_fragment_needs_the_height() {
    let height = |body: &str| {
        let folder = Folder::new(&[("a.frag", with_version(body).as_bytes())]);
        let output = folder.run(&["reflect", "a.frag", "--format", "json"]);
        let reflection: Value = serde_json::from_str(&out(&output)).expect("JSON");
        let text = wgsl(&with_version(body));
        let needed = !reflection["conventions"]["framebuffer_height"].is_null();
        assert_eq!(text.contains("framebuffer_height"), needed, "{text}");
        needed
    };
    assert!(!height("out vec4 c; void main() { c = vec4(gl_FragCoord.z); }"));
    assert!(!height("out vec4 c; void main() { c = vec4(gl_FragCoord.xz, gl_FragCoord[3], 1.0); }"));
    assert!(height("out vec4 c; void main() { c = vec4(gl_FragCoord.xy, 0.0, 1.0); }"));
    assert!(height("out vec4 c; void main() { vec4 f = gl_FragCoord; c = vec4(f.z); c.x += f.y; }"));
    assert!(height("uniform int i; out vec4 c; void main() { c = vec4(gl_FragCoord[i]); }"));
}

#[test]
fn a_flag_is_tested_only_where_a_discard_may_have_happened() {
    let guards = |body: &str| wgsl(&with_version(body)).matches("if discarded {").count();
    let endless = "while (x > 0.0) x *= k;";
    let head = "uniform float k; in float v; out vec4 c;";
    assert_eq!(guards(&format!("{head} void main() {{ float x = v; {endless} c = vec4(x); if (x < k) discard; }}")), 0);
    assert_eq!(guards(&format!("{head} void main() {{ float x = v; if (x < k) discard; {endless} c = vec4(x); }}")), 1);
    let called = format!("{head} float f(float x) {{ {endless} return x; }}");
    assert_eq!(guards(&format!("{called} void main() {{ c = vec4(f(v)); if (v < k) discard; }}")), 0);
    assert_eq!(guards(&format!("{called} void main() {{ if (v < k) discard; c = vec4(f(v)); }}")), 1);
    let inside = "while (x > 0.0) { if (x < v) discard; x *= k; }";
    assert_eq!(guards(&format!("{head} void main() {{ float x = v; {inside} c = vec4(x); }}")), 1);
    let around = format!("for (int i = 0; i < 4; i++) {{ {endless} if (x < v) discard; }}");
    assert_eq!(guards(&format!("{head} void main() {{ float x = v; {around} c = vec4(x); }}")), 1);
    let cases = format!("switch (int(v)) {{ case 0: discard; case 1: {endless} break; }}");
    assert_eq!(guards(&format!("{head} void main() {{ float x = v; {cases} c = vec4(x); }}")), 1);
}

#[test]
fn a_block_without_an_instance_name_has_a_variable_of_its_own_name() {
    let text = wgsl(
        "#version 150\nlayout(std140) uniform FormulaParams { vec4 a; };\nlayout(std140) uniform fog { vec4 b; };\n\
         out vec4 c;\nvoid main() { c = a + b; }\n",
    );
    assert!(text.contains("var<uniform> formula_params: FormulaParams;"), "{text}");
    assert!(text.contains("var<uniform> fog_block: fog;"), "{text}");
    assert!(!text.contains("_1"), "{text}");
}

const MAP: &str = "#version 150\nstruct Tile { vec4 color; float height; };\nuniform Tile tiles[100]; uniform Tile few[2];\n\
    layout(std140) uniform Camera { mat4 view; } camera;\nuniform sampler2D image; uniform int which; out vec4 c;\n\
    void main() { c = tiles[which].color * few[1].height * texture(image, camera.view[0].xy); }\n";

fn reflection(arguments: &[&str]) -> Value {
    let folder = Folder::new(&[("map.frag", MAP.as_bytes())]);
    let output = folder.run(&[&["reflect", "map.frag", "--format", "json"], arguments].concat());
    serde_json::from_str(&out(&output)).unwrap_or_else(|error| panic!("{error}: {}", err(&output)))
}

#[test]
fn large_arrays_of_structs_are_listed_once() {
    let rows = |reflection: &Value, prefix: &str| {
        let rows = reflection["uniforms"].as_array().expect("a list").iter();
        rows.filter(|row| row["name"].as_str().is_some_and(|name| name.starts_with(prefix))).count()
    };
    let (once, flat) = (reflection(&[]), reflection(&["--flat"]));
    assert_eq!((rows(&once, "tiles"), rows(&flat, "tiles")), (0, 200));
    assert_eq!((rows(&once, "few"), rows(&flat, "few")), (4, 4));
    let array = &once["struct_arrays"][0];
    assert_eq!((&array["name"], &array["type"]), (&Value::from("tiles"), &Value::from("Tile")));
    assert_eq!((&array["array_size"], &array["array_stride"]), (&Value::from(100), &Value::from(32)));
    assert_eq!(array["members"][1]["name"], "height");
    // What is listed once and what is listed one by one agree.
    for row in flat["uniforms"].as_array().expect("a list") {
        let Some((index, member)) = row["name"].as_str().and_then(|name| name.strip_prefix("tiles[")?.split_once("]."))
        else {
            continue;
        };
        let index: u64 = index.parse().expect("a number");
        let inner = array["members"].as_array().expect("a list").iter().find(|inner| inner["name"] == member);
        let offset = |value: &Value| value["offset"].as_u64().expect("a number");
        let expected = offset(array) + index * 32 + offset(inner.expect("the member is there"));
        assert_eq!(offset(row), expected, "{row}");
    }
}

#[test]
fn the_reflection_has_what_a_host_of_webgpu_writes() {
    let found = reflection(&[]);
    let camera = &found["blocks"][0];
    assert_eq!(camera["visibility"], Value::from(vec!["fragment"]));
    assert_eq!(camera["wgsl"]["name"], "camera");
    assert_eq!(camera["wgsl"]["type"], "Camera");
    assert_eq!(found["samplers"][0]["wgsl"]["texture"]["type"], "texture_2d<f32>");
    assert_eq!(found["samplers"][0]["wgsl"]["sampler"]["name"], "image_sampler");
    assert_eq!(found["loose_block"]["wgsl"]["type"], "Uniforms");
    assert_eq!(found["files"]["fragment"]["sources"][0], "map.frag");
    assert!(found["generator"].as_str().is_some_and(|name| name.starts_with("glisten ")), "{found}");
    let view = found["uniforms"].as_array().and_then(|rows| rows.iter().find(|row| row["name"] == "Camera.view"));
    let view = view.expect("it is there");
    assert_eq!((&view["wgsl_type"], &view["size"]), (&Value::from("mat4x4<f32>"), &Value::from(64)));
}

#[test]
fn stages_see_only_what_they_read() {
    let vertex = "#version 150\nin vec4 p; uniform mat4 m; uniform sampler2D both;\n\
        void main() { gl_Position = m * p * textureLod(both, p.xy, 0.0); }\n";
    let fragment = "#version 150\nuniform sampler2D both; uniform sampler2D own; out vec4 c;\n\
        void main() { c = texture(both, vec2(0.5)) + texture(own, vec2(0.5)); }\n";
    let folder = Folder::new(&[("a.vert", vertex.as_bytes()), ("a.frag", fragment.as_bytes())]);
    let output = folder.run(&["reflect", "a.vert", "a.frag", "--format", "json"]);
    let found: Value = serde_json::from_str(&out(&output)).expect("JSON");
    let stages = |value: &Value| value["visibility"].as_array().expect("a list").len();
    assert_eq!(found["loose_block"]["visibility"], Value::from(vec!["vertex"]));
    let samplers = found["samplers"].as_array().expect("a list").iter();
    let seen: Vec<(&str, usize)> = samplers.map(|row| (row["name"].as_str().unwrap_or(""), stages(row))).collect();
    assert_eq!(seen, [("both", 2), ("own", 1)]);
}

#[test]
fn find_answers_in_json_if_asked() {
    let found = reflection(&["--find", "imgae"]);
    assert_eq!(found[0]["found"], Value::Array(Vec::new()), "{found}");
    assert_eq!(found[0]["nearest"], "image");
    let found = reflection(&["--find", "image"]);
    assert_eq!(found[0]["program"], "map");
    assert_eq!(found[0]["found"][0]["kind"], "sampler");
    assert_eq!(found[0]["found"][0]["row"]["texture"]["group"], 1);
}

#[test]
fn the_wgsl_in_the_readme_is_what_is_written() {
    let root = crate::support::root();
    let readme = fs::read_to_string(root.join("README.md")).expect("the README is there");
    let shown = readme.split("```wgsl\n").nth(1).and_then(|rest| rest.split("```").next()).expect("a sample");
    let text = fs::read_to_string(root.join("fixtures/programs/phong.frag")).expect("a fixture");
    assert!(wgsl(&text).contains(shown), "the README shows\n{shown}\nand glisten writes\n{}", wgsl(&text));
}

#[test]
fn one_file_has_all_stages() {
    let vertex = "#version 150\nuniform vec4 tint;\nin vec4 p;\nout vec4 v;\n// Shared.\nvec4 shade(vec4 c) { return c * tint; }\n\
                  float own(float x) { return x + 1.0; }\nvoid main() { v = shade(p) * own(p.x); gl_Position = p; }\n";
    let fragment = "#version 150\nuniform vec4 tint;\nin vec4 v;\nout vec4 c;\nvec4 shade(vec4 c) { return c * tint; }\n\
                    float own(float x) { return x * 2.0; }\nvoid main() { c = shade(v) * own(v.x); }\n";
    let folder = Folder::new(&[("a.vert", vertex.as_bytes()), ("a.frag", fragment.as_bytes())]);
    let targets = ["--target", "wgsl", "--target", "msl", "--target", "hlsl"];
    let arguments = [&["compile", "a.vert", "a.frag", "--single-file", "-o", "out"], &targets[..]].concat();
    let output = folder.run(&arguments);
    assert_eq!(code(&output), 0, "{}", err(&output));
    let read = |name: &str| fs::read_to_string(folder.path(&format!("out/{name}"))).expect("it was written");
    for name in ["a.wgsl", "a.metal", "a.hlsl"] {
        let text = read(name);
        assert!(text.contains(" vs_main(") && text.contains(" fs_main("), "{text}");
    }
    let text = read("a.wgsl");
    for (part, count) in
        [("fn shade(", 1), ("fn own", 2), ("struct Uniforms", 1), ("var<uniform>", 1), ("// Shared.", 1)]
    {
        assert_eq!(text.matches(part).count(), count, "{part} in\n{text}");
    }
    let module = naga::front::wgsl::parse_str(&text).unwrap_or_else(|error| panic!("{}", error.emit_to_string(&text)));
    assert_eq!(module.entry_points.len(), 2);
    let reflection: Value = serde_json::from_str(&read("a.json")).expect("JSON");
    assert_eq!(reflection["entry_points"]["vertex"], "vs_main");
    assert_eq!(reflection["targets"]["msl"]["entry_points"]["fragment"], "fs_main");
    assert_eq!(reflection["files"]["fragment"]["outputs"]["wgsl"], "a.wgsl");
    let output = folder.run(&["compile", "a.vert", "a.frag", "--single-file", "-o", "-"]);
    assert_eq!(out(&output), text);
    let refused = folder.run(&["compile", "a.vert", "a.frag", "--single-file", "--target", "spirv", "-o", "out"]);
    assert_eq!(code(&refused), 2, "{}", err(&refused));
}

#[test]
fn texture_coordinates_are_as_many_as_the_program_names() {
    let vertex = "#version 120\nvoid main() { gl_Position = gl_Vertex; gl_TexCoord[0] = gl_MultiTexCoord0; }\n";
    let count = |fragment: &str| {
        let folder = Folder::new(&[("a.vert", vertex.as_bytes()), ("a.frag", fragment.as_bytes())]);
        let output = folder.run(&["compile", "a.vert", "a.frag", "--single-file", "-O0", "-o", "-"]);
        assert_eq!(code(&output), 0, "{}", err(&output));
        let text = out(&output);
        text.matches(") gl_TexCoord_").count()
    };
    assert_eq!(count("#version 120\nvoid main() { gl_FragColor = gl_TexCoord[0]; }\n"), 2);
    assert_eq!(count("#version 120\nvoid main() { gl_FragColor = gl_TexCoord[0] + gl_TexCoord[1]; }\n"), 4);
    let declared = "#version 120\nvarying vec4 gl_TexCoord[3];\nvoid main() { gl_FragColor = gl_TexCoord[0]; }\n";
    assert_eq!(count(declared), 6);
    let open = "#version 120\nuniform int n;\nvoid main() { gl_FragColor = gl_TexCoord[n]; }\n";
    assert_eq!(count(open), 16);
}
