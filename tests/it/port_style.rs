//! `glisten port`: the new texts are as somebody would write them who has to keep them.
//!
//! Each case is one that a reader of ported packs and engines complained about.

use crate::cli::{Folder, code, err, out};
use serde_json::Value;
use std::fs;

/// A folder with files in `in`, ported for a host to `out`.
fn ported(files: &[(&str, &str)], host: &str) -> Folder {
    let folder = Folder::new(&[]);
    for (name, text) in files {
        let path = folder.path(&format!("in/{name}"));
        fs::create_dir_all(path.parent().expect("a folder")).expect("writable");
        fs::write(path, text).expect("writable");
    }
    let output = folder.run(&["port", "in", "--for", host, "-o", "out"]);
    assert_eq!(code(&output), 0, "{}", err(&output));
    folder
}

fn read(folder: &Folder, name: &str) -> String {
    fs::read_to_string(folder.path(&format!("out/{name}"))).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// A fragment shader's new text.
fn fragment(text: &str) -> String {
    read(&ported(&[("a.frag", text)], "vulkan"), "a.frag")
}

#[track_caller]
fn has(text: &str, part: &str) {
    assert!(text.contains(part), "no `{part}` in:\n{text}");
}

const BODY: &str = "out vec4 c;\n\nvoid main() {\n    c = tint + offset;\n}\n";

#[test]
fn comments_go_with_what_they_explain() {
    let text = format!(
        "#version 330\n\n/* of the surface */\nuniform vec4\n    tint,   // multiplied\n    offset; // added\n\n// from the vertex stage\nin vec2 uv;\n{BODY}"
    );
    has(
        &fragment(&text),
        "uniform Uniforms {\n    /* of the surface */\n    layout(offset = 0) vec4 tint;     // multiplied\n    \
         layout(offset = 16) vec4 offset;  // added\n};\n\n// from the vertex stage\nlayout(location = 0) in vec2 uv;\n",
    );
    // A block comment behind a declaration goes, too, and a license stays at the top.
    let text = format!(
        "#version 330\n// Copyright by somebody.\nuniform vec4 tint; /* bright */\nuniform vec4 offset;\n{BODY}"
    );
    has(&fragment(&text), "#version 450\n// Copyright by somebody.\nlayout(std140, set = 0");
    has(
        &fragment(&text),
        "vec4 tint;  /* bright */\n    layout(offset = 16) vec4 offset;\n};\nlayout(location = 0) out",
    );
    // One column of comments stays one.
    let text = format!("#version 330\nuniform vec4 tint;     // a\nuniform vec4 offset;   // b\n{BODY}");
    has(&fragment(&text), "vec4 tint;     // a\n    layout(offset = 16) vec4 offset;  // b\n");
}

#[test]
fn samplers_leave_a_struct_with_their_comments() {
    let text = "#version 330\nstruct Material {\n    sampler2D diffuse; // of the surface\n    float shininess;\n    // optional\n    \
                sampler2D gloss;\n};\nuniform Material material; // one for each mesh\nin vec2 uv;\nout vec4 c;\nvoid main() {\n    \
                c = texture(material.diffuse, uv) * material.shininess + texture(material.gloss, uv);\n}\n";
    let new = fragment(text);
    has(&new, "struct Material {\n    float shininess;\n};\n");
    has(&new, "Material material;  // one for each mesh\n");
    has(
        &new,
        "uniform sampler2D material_diffuse; // of the surface\n// optional\nlayout(set = 1, binding = 2) uniform sampler2D",
    );
}

#[test]
fn the_layout_of_a_text_stays() {
    // Ends of lines, no end of the last one, tabs, braces below, and a layout that is right already.
    let vertex = "#version 330\r\nuniform vec4 tint;\r\nlayout(location=0) in vec4 p;\r\n\r\nvoid main()\r\n{\r\n\tgl_Position = p + tint;\r\n}";
    let new = read(&ported(&[("a.vert", vertex)], "vulkan"), "a.vert");
    assert_eq!(new.matches('\n').count(), new.matches("\r\n").count(), "{new:?}");
    assert!(new.ends_with("\r\n}"), "{new:?}");
    has(&new, "{\r\n\tlayout(offset = 0) vec4 tint;\r\n};\r\nlayout(location=0) in vec4 p;\r\n");
    has(&new, "void main()\r\n{\r\n\topenglMain();\r\n");
    // Where declarations leave, no gap stays, and no condition around nothing.
    let text = format!(
        "#version 330\n\n// a\nuniform vec4 tint;\n\n// b\nuniform vec4 offset;\n\n#ifdef FOG\nuniform vec4 fog;\n#endif\n\nin vec2 uv;\n{BODY}"
    );
    let new = fragment(&text);
    assert!(!new.contains("\n\n\n") && !new.contains("#endif\n\n#") && !new.contains("#ifdef FOG\n#endif"), "{new}");
    has(&new, "};\n\nlayout(location = 0) in vec2 uv;\n");
    // A mark of the byte order stays in front.
    let new = fragment(&format!("\u{feff}#version 330\nuniform vec4 tint, offset;\n{BODY}"));
    assert!(new.starts_with("\u{feff}#version 450\n"), "{new:?}");
    assert_eq!(new.matches("#version").count(), 1, "{new}");
}

#[test]
fn added_declarations_do_not_part_a_comment_from_its_line() {
    let text = "#version 120\n// from the vertex stage\nvarying vec2 uv;\nvoid main() {\n    gl_FragColor = vec4(uv, 0.0, 1.0);\n}\n";
    has(
        &fragment(text),
        "layout(location = 0) out vec4 fragColor;\n\n// from the vertex stage\nlayout(location = 0) in vec2 uv;\n",
    );
    let text = "#version 120\n#extension GL_ARB_texture_rectangle : enable\n\nvarying vec2 uv;\nvoid main() {\n    gl_FragColor = vec4(uv, 0.0, 1.0);\n}\n";
    let new = fragment(&text.replace("GL_ARB_texture_rectangle", "GL_EXT_gpu_shader4"));
    has(&new, "#version 450\n\nlayout(location = 0) out vec4 fragColor;\n");
}

#[test]
fn values_that_uniforms_begin_with_are_told() {
    let folder = ported(
        &[("a.frag", &format!("#version 330\nuniform vec4 tint = vec4(0.5);\nuniform vec4 offset;\n{BODY}"))],
        "vulkan",
    );
    has(&read(&folder, "a.frag"), "vec4 tint;  // initially vec4(0.5)\n");
    let account: Value = serde_json::from_str(&read(&folder, "port.json")).expect("JSON");
    assert_eq!(
        account["files"][0]["notes"][0],
        "line 2: `tint` begins with `vec4(0.5)` in OpenGL; a member of a block has the value that the host sets"
    );
}

#[test]
fn what_is_ported_is_not_ported_again() {
    let folder = ported(&[("a.vert", "#version 330\nin vec4 p;\nvoid main() {\n    gl_Position = p;\n}\n")], "vulkan");
    let check = folder.run(&["port", "out", "--for", "vulkan", "--check"]);
    assert_eq!((code(&check), out(&check)), (0, String::new()), "{}", err(&check));
}

#[test]
fn header_and_reflection_have_the_numbers_of_the_text() {
    let text = "#version 330\nuniform vec2 size;\nout vec4 c;\nvoid main() {\n    c = vec4(gl_FragCoord.xy / size, 0.0, 1.0);\n}\n";
    let folder = ported(&[("a.frag", text)], "vulkan");
    has(
        &read(&folder, "a.frag"),
        "binding = 0) uniform Uniforms {\n    layout(offset = 0) vec2 size;\n    layout(offset = 8) float framebufferHeight;\n",
    );
    has(&read(&folder, "include/a.h"), "float framebufferHeight; // float\n");
    let reflection: Value = serde_json::from_str(&read(&folder, "reflection/a.json")).expect("JSON");
    assert_eq!((&reflection["blocks"][0]["binding"], &reflection["loose_block"]), (&0.into(), &Value::Null));
    assert_eq!(reflection["conventions"]["framebuffer_height"]["offset"], 8);
    assert_eq!(reflection["uniforms"][1]["name"], "framebufferHeight");
    // A host of wgpu reads WGSL, and all that describes it.
    let vertex = "#version 330\nin vec2 p;\nvoid main() {\n    gl_Position = vec4(p, 0.0, 1.0);\n}\n";
    let folder = ported(&[("a.frag", text), ("a.vert", vertex)], "wgpu");
    let reflection: Value = serde_json::from_str(&read(&folder, "reflection/a.json")).expect("JSON");
    assert_eq!(reflection["loose_block"]["binding"], 0);
    has(&read(&folder, "wgsl/a.frag.wgsl"), "@group(0) @binding(0) var<uniform>");
    has(&read(&folder, "shaders.rs"), "/// The program of `a.vert` and `a.frag`.\n");
}

#[test]
fn an_input_that_nothing_writes_is_no_input() {
    let vertex = "#version 330\nin vec4 p;\nout vec2 uv;\nvoid main() {\n    uv = p.xy;\n    gl_Position = p;\n}\n";
    let fragment = "#version 330\nin vec2 uv, debug;\nout vec4 c;\nvoid main() {\n    c = vec4(uv, 0.0, 1.0);\n}\n";
    let folder = ported(&[("a.vert", vertex), ("a.frag", fragment)], "vulkan");
    has(&read(&folder, "a.frag"), "layout(location = 0) in vec2 uv; vec2 debug;\n");
}

#[test]
fn a_location_without_a_partner_goes_with_its_qualifiers() {
    let vertex = "#version 410\nlayout(location = 0) in vec4 p;\nlayout(location = 3) out vec4 color;\nlayout(location = 4) out vec2 spare;\n\
                  void main() {\n    color = p;\n    gl_Position = p;\n}\n";
    let fragment = "#version 410\nlayout(location = 3) in vec4 shade;\nlayout(location = 0) out vec4 c;\nvoid main() {\n    c = shade;\n}\n";
    let folder = ported(&[("a.vert", vertex), ("a.frag", fragment)], "vulkan");
    let new = read(&folder, "a.vert");
    has(&new, "out vec4 color;\nvec2 spare;\n");
    // A geometry stage matches by locations, too.
    let geometry = "#version 410\nlayout(triangles) in;\nlayout(triangle_strip, max_vertices = 3) out;\nlayout(location = 3) in vec4 tint[];\n\
                    layout(location = 3) out vec4 color;\nvoid main() {\n    for (int i = 0; i < 3; ++i) {\n        \
                    gl_Position = gl_in[i].gl_Position;\n        color = tint[i];\n        EmitVertex();\n    }\n}\n";
    let folder = ported(&[("a.vert", vertex), ("a.geom", geometry), ("a.frag", fragment)], "vulkan");
    let number = |text: &str, end: &str| {
        let line = text.lines().find(|line| line.ends_with(end)).unwrap_or_else(|| panic!("no `{end}` in:\n{text}"));
        line.trim_end_matches(end).to_owned()
    };
    let (vertex, geometry) = (read(&folder, "a.vert"), read(&folder, "a.geom"));
    assert_eq!(number(&vertex, " out vec4 color;"), number(&geometry, " in vec4 tint[];"));
}

#[test]
fn a_macro_of_another_program_does_not_matter() {
    let shared = "#version 330\n#define IN in\nIN vec2 uv;\nIN vec2 spare;\nout vec4 c;\nvoid main() {\n    c = vec4(uv, 0.0, 1.0);\n}\n";
    let vertex = "#version 330\nin vec4 p;\nout vec2 uv;\nvoid main() {\n    uv = p.xy;\n    gl_Position = p;\n}\n";
    let other = "#version 330\n#define IN params\nstruct Params { float gain; };\nout vec4 c;\nvoid main() {\n    Params IN = Params(1.0);\n    \
                 c = vec4(IN.gain);\n}\n";
    let folder = ported(&[("a.vert", vertex), ("a.frag", shared), ("b.frag", other)], "vulkan");
    has(&read(&folder, "a.frag"), "layout(location = 0) IN vec2 uv;\nvec2 spare;\n");
}

#[test]
fn a_struct_between_uniforms_is_before_the_block() {
    // A constant of a uniform's name, in a branch that is not taken, is no size of it.
    let text = "#version 330\n#define RUNTIME\n#ifdef RUNTIME\nuniform float gain;\nuniform float gamma;\n#else\nconst float gain = 1.0;\n\
                const float gamma = 2.2;\n#endif\nfloat lifted(float x) {\n    return x * gain;\n}\nuniform vec2 size;\nout vec4 c;\n\
                void main() {\n    c = vec4(lifted(size.x), gamma, 0.0, 1.0);\n}\n";
    has(&fragment(text), "uniform FragmentUniforms {\n");
    // A function between the uniforms uses none of them.
    let text = "#version 330\nuniform float gain;\nfloat squared(float x) {\n    return x * x;\n}\nstruct Light {\n    vec4 color;\n};\n\
                uniform Light light;\nout vec4 c;\nvoid main() {\n    c = light.color * squared(gain);\n}\n";
    let new = fragment(text);
    has(&new, "struct Light {\n    vec4 color;\n};\n");
    let of = |part: &str| new.find(part).unwrap_or_else(|| panic!("no `{part}` in {new}"));
    assert!(of("struct Light") < of("uniform Uniforms"), "{new}");
    // One that uses one of them is in the way.
    let folder = Folder::new(&[("a.frag", text.replace("return x * x", "return x * gain").as_bytes())]);
    let output = folder.run(&["upgrade", "--to", "vulkan", "a.frag"]);
    has(&err(&output), "a struct of a uniform comes after a function that uses other uniforms");
}

#[test]
fn a_pack_says_what_nobody_fills() {
    let vertex = "#version 150\nin vec4 Position;\nuniform mat4 ProjMat;\nuniform vec2 HistorySize;\nvoid main() {\n    \
                  gl_Position = ProjMat * vec4(Position.xy * HistorySize, 0.2, 1.0);\n}\n";
    let fragment = "#version 150\nuniform float Gain;\nout vec4 c;\nvoid main() {\n    c = vec4(Gain);\n}\n";
    let passes = "{\n  \"passes\": [\n    {\n      \"vertex_shader\": \"minecraft:post/a\",\n      \"fragment_shader\": \"minecraft:post/a\",\n      \
                  \"output\": \"minecraft:main\"\n    }\n  ]\n}\n";
    let core = "#version 150\nin vec3 Position;\nuniform float FogShape;\nvoid main() {\n    gl_Position = vec4(Position, FogShape);\n}\n";
    let files = [
        ("pack.mcmeta", "{\"pack\":{\"pack_format\":64,\"description\":\"\"}}"),
        (".gitignore", "*.zip\n"),
        ("assets/minecraft/post_effect/a.json", passes),
        ("assets/minecraft/shaders/post/a.vsh", vertex),
        ("assets/minecraft/shaders/post/a.fsh", fragment),
        ("assets/minecraft/shaders/core/b.vsh", core),
        ("assets/minecraft/shaders/core/b.fsh", "#version 150\nout vec4 c;\nvoid main() {\n    c = vec4(1.0);\n}\n"),
    ];
    let folder = ported(&files, "minecraft-26.2");
    let passes: Value = serde_json::from_str(&read(&folder, "assets/minecraft/post_effect/a.json")).expect("JSON");
    assert_eq!(passes["passes"][0]["uniforms"]["Uniforms"][1]["value"], 0.0, "{passes}");
    let account = read(&folder, "port.json");
    has(&account, "a pass has no value for `HistorySize`, `Gain`, which are 0");
    has(&account, "neither the game nor a pass has a value for `FogShape`");
    assert_eq!(read(&folder, ".gitignore"), "*.zip\n");
    let again = folder.run(&["port", "in", "--for", "minecraft-26.2", "-o", "out"]);
    has(&err(&again), "wrote 0 files");
}

#[test]
fn a_struct_without_a_name_gets_that_of_its_variable() {
    let text = "#version 330\nuniform struct {\n    vec4 color; // of the lamp\n    float power;\n} light;\nout vec4 c;\n\nvoid main() {\n    \
                c = light.color * light.power;\n}\n";
    let new = fragment(text);
    has(&new, "struct Light {\n    vec4 color; // of the lamp\n    float power;\n};\n");
    has(&new, "layout(offset = 0) Light light;");
}
