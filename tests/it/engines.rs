//! Sources that engines complete, end to end: profiles, preludes, assumed versions, include styles, files of several stages.
//!
//! *In:* the small examples of `fixtures/engines`, one folder for each profile, and sources in temporary folders. *Out:* every
//! example compiles to WGSL and SPIR-V, and none does without its profile; diagnostics are at the lines of the files.

use crate::cli::{Folder, code, codes, err, out};
use crate::support::root;
use serde_json::Value;
use std::process::{Command, Output};

/// The profiles, and how many stages their examples have.
const PROFILES: &[(&str, usize)] = &[
    ("minecraft", 3),
    ("optifine", 2),
    ("iris", 4),
    ("libretro", 2),
    ("isf", 2),
    ("openscenegraph", 1),
    ("three", 3),
    ("shadertoy", 1),
    ("supertuxkart", 2),
];

/// Runs the program in the folder of the package.
fn here(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_glisten")).args(arguments).current_dir(root()).output().expect("the program runs")
}

fn findings(output: &Output) -> Vec<Value> {
    let mut all: Vec<Value> =
        serde_json::from_slice(&output.stdout).unwrap_or_else(|error| panic!("{error}: {output:?}"));
    all.pop().expect("the last object tells what was checked");
    all
}

fn errors(output: &Output) -> Vec<Value> {
    findings(output).into_iter().filter(|finding| finding["severity"] == "error").collect()
}

#[test]
fn every_profile_accepts_its_example() {
    for (profile, n_stages) in PROFILES {
        let folder = format!("fixtures/engines/{profile}");
        let output = here(&["lint", &folder]);
        assert_eq!(code(&output), 0, "{profile}: {}", out(&output));
        let counted = if *n_stages == 1 { "1 file: " } else { "" };
        assert!(err(&output).contains(counted) && !err(&output).contains("not checked"), "{}", err(&output));
    }
}

/// The sources of a profile's example, copied to a place without its configuration.
fn without_configuration(profile: &str) -> Folder {
    let base = root().join("fixtures/engines").join(profile);
    let files: Vec<(String, Vec<u8>)> = crate::support::files_under(&base)
        .into_iter()
        .filter(|path| path.extension().is_some_and(|extension| extension != "toml"))
        .map(|path| {
            let name = path.strip_prefix(&base).expect("below it").to_string_lossy().into_owned();
            (name, std::fs::read(path).expect("readable"))
        })
        .collect();
    let files: Vec<(&str, &[u8])> = files.iter().map(|(name, bytes)| (name.as_str(), bytes.as_slice())).collect();
    Folder::new(&files)
}

#[test]
fn a_flag_says_the_same_as_a_table_and_without_either_it_is_an_error() {
    for (profile, sources, more) in [
        (
            "minecraft",
            &["assets/minecraft/shaders/core/portal.vsh", "assets/minecraft/shaders/core/portal.fsh"][..],
            &[][..],
        ),
        ("optifine", &["shaders/world0/final.vsh", "shaders/world0/final.fsh"], &["--assume-version", "150"]),
        ("iris", &["shaders/composite.vsh", "shaders/composite.fsh"], &[]),
        ("libretro", &["lines.glsl"], &[]),
        ("isf", &["ripple.fs", "ripple.vs"], &[]),
        ("three", &["wrapped.vert", "wrapped.frag"], &["-I", "chunks"]),
        ("shadertoy", &["waves.glsl", "--stage", "fragment"], &[]),
    ] {
        let folder = without_configuration(profile);
        let plain = folder.run(&[&["lint"], sources].concat());
        // A file of libretro says itself what its stages are, and is GLSL 1.10 without its profile.
        assert_eq!(code(&plain) == 0, profile == "libretro", "{profile} needs its profile");
        let given = folder.run(&[&["lint", "--engine", profile], sources, more].concat());
        assert_eq!(code(&given), 0, "{profile}: {}", out(&given));
    }
}

#[test]
fn examples_compile_to_every_target() {
    let folder = Folder::new(&[]);
    let into = folder.path("out").to_string_lossy().into_owned();
    let base = "fixtures/engines";
    let files = [
        "minecraft/assets/minecraft/shaders/core/portal.vsh",
        "minecraft/assets/minecraft/shaders/core/portal.fsh",
        "libretro/lines.glsl",
        "isf/ripple.vs",
        "isf/ripple.fs",
        "three/wrapped.vert",
        "three/wrapped.frag",
        "combined/marked.shader",
        "combined/several.glsl",
    ];
    let files: Vec<String> = files.iter().map(|file| format!("{base}/{file}")).collect();
    let files: Vec<&str> = files.iter().map(String::as_str).collect();
    let targets = ["--target", "wgsl", "--target", "spirv", "--target", "glsl"];
    let output = here(&[&["compile", "-q", "-o", &into], &targets[..], &files].concat());
    assert_eq!(code(&output), 0, "{}", err(&output));
    let written = folder.names("out");
    for name in
        ["lines.vert.wgsl", "lines.frag.spv", "lines.json", "plain.vert.wgsl", "shaded.frag.glsl", "marked.json"]
    {
        assert!(written.iter().any(|other| other == name), "{name} is not in {written:?}");
    }
}

#[test]
fn a_prelude_has_lines_of_its_own() {
    let folder = Folder::new(&[
        ("lib/p.glsl", b"#define K 2.0\nuniform float u;\nfloat f() { return wrong; }\n"),
        ("a.frag", b"#version 150\nout vec4 c;\nvoid main() {\n    c = vec4(u * K + missing);\n}\n"),
    ]);
    let (found, exit) = folder.lint(&["a.frag", "--prelude", "lib/p.glsl"]);
    assert_eq!((codes(&found), exit), (vec!["E0301", "E0301"], 1));
    let place = |finding: &Value| (finding["file"].as_str().unwrap_or("").to_owned(), finding["line"].as_u64());
    let mut places: Vec<_> = found.iter().map(place).collect();
    places.sort();
    assert_eq!(places, [("a.frag".to_owned(), Some(4)), ("lib/p.glsl".to_owned(), Some(3))]);
    let missing = folder.run(&["lint", "a.frag", "--prelude", "nowhere.glsl"]);
    assert_eq!(code(&missing), 2);
    assert!(err(&missing).contains("nowhere.glsl"));
}

#[test]
fn one_version_line_counts() {
    let prelude = b"#version 150\n#if __VERSION__ != 150\n#error version\n#endif\nuniform float u;\n" as &[u8];
    let without = b"out vec4 c;\nvoid main() { c = vec4(u); }\n" as &[u8];
    let with = b"// first\n#version 150 core\nout vec4 c;\nvoid main() { c = vec4(u); }\n" as &[u8];
    let folder =
        Folder::new(&[("p.glsl", prelude), ("q.glsl", b"uniform float u;\n"), ("a.frag", without), ("b.frag", with)]);
    for arguments in [
        &["a.frag", "--prelude", "p.glsl"][..],
        // The source's own line comes first, and the prelude after it.
        &["b.frag", "--prelude", "p.glsl"],
        &["b.frag", "--prelude", "q.glsl", "--prelude", "p.glsl", "--assume-version", "110"],
        &["a.frag", "--prelude", "q.glsl", "--assume-version", "150 core"],
        // The prelude with the version comes before the others.
        &["a.frag", "--prelude", "p.glsl", "--assume-version", "110"],
    ] {
        let (found, exit) = folder.lint(arguments);
        let twice = arguments.iter().filter(|argument| **argument == "--prelude").count() == 2;
        // Two preludes that declare the same uniform are no error of GLSL.
        assert_eq!(exit, i32::from(twice && !found.is_empty()), "{arguments:?}: {found:?}");
    }
    for version in ["999", "fast"] {
        let wrong = folder.run(&["lint", "a.frag", "--prelude", "q.glsl", "--assume-version", version]);
        assert_eq!(code(&wrong), 2);
        assert!(err(&wrong).contains(version), "{}", err(&wrong));
    }
}

#[test]
fn an_import_of_another_engine_says_who_reads_it() {
    let folder = without_configuration("minecraft");
    let (found, _) = folder.lint(&["assets/minecraft/shaders/core/portal.vsh"]);
    assert!(found[0]["help"].as_str().is_some_and(|help| help.contains("--include-style moj")), "{found:?}");
    let path = "assets/minecraft/shaders/core/portal.vsh";
    let styled = folder.run(&["lint", path, "--include-style", "moj", "-D", "PORTAL_LAYERS=15"]);
    assert_eq!(code(&styled), 0, "{}", out(&styled));
}

#[test]
fn a_pack_comes_before_the_game() {
    let [x, y] = ["#moj_import <who.glsl>", "#include <minecraft:who.glsl>"].map(|line| {
        format!(
            "#version 150\n#extension GL_MC_moj_import : enable\n{line}\nout vec4 c;\nvoid main() {{ c = own(); }}\n"
        )
    });
    let folder = Folder::new(&[
        ("game/assets/minecraft/shaders/include/who.glsl", b"vec4 game() { return vec4(0.0); }\n" as &[u8]),
        ("game/assets/minecraft/shaders/include/more.glsl", b"vec4 more() { return vec4(0.0); }\n"),
        ("pack/assets/minecraft/shaders/include/who.glsl", b"#moj_import <more.glsl>\nvec4 own() { return more(); }\n"),
        // Another namespace of the pack has a file of this name, too.
        ("pack/assets/other/shaders/include/who.glsl", b"vec4 other() { return vec4(0.0); }\n"),
        ("pack/assets/minecraft/shaders/core/x.fsh", x.as_bytes()),
        ("pack/assets/minecraft/shaders/core/y.fsh", y.as_bytes()),
        ("pack/assets/other/shaders/core/z.fsh", x.as_bytes()),
    ]);
    for (name, place) in [("x", "minecraft"), ("y", "minecraft"), ("z", "other")] {
        let path = format!("pack/assets/{place}/shaders/core/{name}.fsh");
        let (found, exit) = folder.lint(&["--engine", "minecraft", "-I", "game", &path]);
        assert_eq!((codes(&found), exit), (vec![], 0), "{path}: {found:?}");
    }
}

#[test]
fn a_version_by_name_is_assumed() {
    let text =
        |version: &str| format!("#version {version}\nin float x;\nout vec4 c;\nvoid main() {{ c = vec4(x); }}\n");
    for version in ["ogre_glsl_ver_330", "__CONTEXT__", "%(version)s", "${version}", "@version@"] {
        let folder = Folder::new(&[("s/a.frag", text(version).as_bytes())]);
        assert_eq!(folder.lint(&["s/a.frag", "--assume-version", "330"]).1, 0, "{version}");
        let (found, exit) = folder.lint(&["s/a.frag"]);
        assert_eq!((codes(&found), exit), (vec!["E0120"], 1), "{version}");
        assert_eq!(found[0]["line"], 1);
        assert!(found[0]["help"].as_str().is_some_and(|help| help.contains("--assume-version")), "{found:?}");
        // A search counts it as not checked.
        let (found, exit) = folder.lint(&["s"]);
        assert_eq!((codes(&found), exit), (vec![], 0), "{version}");
    }
    let folder = Folder::new(&[("a.frag", text("3.30").as_bytes())]);
    assert_eq!(codes(&folder.lint(&["a.frag", "--assume-version", "330"]).0).first(), Some(&"E0106"));
}

#[test]
fn iris_lets_a_sampler_have_the_name_of_a_lookup() {
    let text = "#version 130\nuniform sampler2D texture, noisetex;\nvarying vec2 p;\n\
                void main() { gl_FragColor = texture2D(texture, p) + texture(noisetex, p); }\n";
    let folder = Folder::new(&[("a.fsh", text.as_bytes())]);
    assert_eq!(codes(&folder.lint(&["a.fsh", "--engine", "optifine"]).0), ["E0312"]);
    assert_eq!(folder.lint(&["a.fsh", "--engine", "iris"]).1, 0);
    let compiled = folder.run(&["compile", "a.fsh", "--engine", "iris", "--target", "glsl", "-o", "out"]);
    assert_eq!(code(&compiled), 0, "{}", err(&compiled));
    let glsl = std::fs::read_to_string(folder.path("out/a.fsh.glsl")).expect("it was written");
    assert!(glsl.contains("texture(texture_, "), "{glsl}");
    let other = text
        .replace("sampler2D texture,", "float texture; uniform sampler2D")
        .replace("texture2D(texture", "texture2D(noisetex");
    let folder = Folder::new(&[("a.fsh", other.as_bytes())]);
    assert_eq!(codes(&folder.lint(&["a.fsh", "--engine", "iris"]).0), ["E0312"]);
}

#[test]
fn iris_lets_the_color_stand_beside_outputs() {
    let text = "#version 330 compatibility\nlayout(location = 1) out vec4 o;\nvoid main() { gl_FragColor = vec4(1.0); o = vec4(0.5); }\n";
    let folder = Folder::new(&[("a.fsh", text.as_bytes())]);
    assert_eq!(codes(&folder.lint(&["a.fsh"]).0), ["E0615"]);
    assert_eq!(folder.lint(&["a.fsh", "--engine", "iris"]).1, 0);
    let compiled = folder.run(&["compile", "a.fsh", "--engine", "iris", "-o", "out"]);
    assert_eq!(code(&compiled), 0, "{}", err(&compiled));
    let wgsl = std::fs::read_to_string(folder.path("out/a.fsh.wgsl")).expect("it was written");
    assert!(wgsl.contains("@location(0)") && wgsl.contains("@location(1)"), "{wgsl}");
    let clash = text.replace("location = 1", "location = 0");
    let folder = Folder::new(&[("a.fsh", clash.as_bytes())]);
    assert_eq!(folder.lint(&["a.fsh", "--engine", "iris"]).1, 1, "two outputs have one location");
}

#[test]
fn styles_find_includes() {
    let base = "fixtures/engines/ogre";
    let plain = here(&["lint", &format!("{base}/Tone_fp.glsl"), "-I", &format!("{base}/media")]);
    assert_eq!(code(&plain), 2, "{}", out(&plain));
    let ogre =
        here(&["lint", &format!("{base}/Tone_fp.glsl"), "-I", &format!("{base}/media"), "--include-style", "ogre"]);
    assert_eq!(code(&ogre), 0, "{}", out(&ogre));
}

#[test]
fn a_pragma_may_be_an_include() {
    let folder = Folder::new(&[
        ("lib/f.glsl", b"float f() { return 1.0; }\n"),
        ("g.glsl", b"float g() { return f(); }\n"),
        ("a.frag", b"#version 150\n#pragma include \"lib/f.glsl\"\n# pragma include : \"g.glsl\"\nout vec4 c;\nvoid main() { c = vec4(g()); }\n"),
        ("b.frag", b"#version 150\n#pragma include \"none.glsl\"\nout vec4 c;\nvoid main() { c = vec4(1.0); }\n"),
    ]);
    assert_eq!(folder.lint(&["a.frag", "--include-style", "quote"]).1, 0);
    assert_eq!(folder.lint(&["a.frag"]).1, 1, "without an engine it is any pragma");
    let (found, exit) = folder.lint(&["b.frag", "--include-style", "quote"]);
    assert_eq!((codes(&found), exit), (vec!["E0127"], 2));
    assert_eq!(folder.lint(&["b.frag"]).1, 0);
}

#[test]
fn a_picture_of_shadertoy_becomes_a_scene() {
    let folder = Folder::new(&[
        ("waves.glsl", include_bytes!("../../fixtures/engines/shadertoy/waves.glsl")),
        ("glisten.toml", include_bytes!("../../fixtures/engines/shadertoy/glisten.toml")),
    ]);
    let made = folder.run(&["new-scene", "waves.glsl", "-o", "scene.toml"]);
    assert_eq!(code(&made), 0, "{}", err(&made));
    let drawn = folder.run(&["render", "scene.toml", "--backend", "cpu", "-o", "a.npy"]);
    assert_eq!(code(&drawn), 0, "{}", err(&drawn));
}

#[test]
fn parts_of_a_file_keep_its_lines() {
    let output = here(&["lint", "--format", "json", "fixtures/engines/combined/wrong.glsl"]);
    let errors = errors(&output);
    assert_eq!(errors.len(), 1, "{errors:?}");
    assert_eq!((errors[0]["line"].as_u64(), errors[0]["column"].as_u64()), (Some(10), Some(23)));
    let folder = Folder::new(&[(
        "a.glsl",
        b"#shader vertex\n#version 150\nout vec3 v;\nvoid main() { v = vec3(1.0); gl_Position = vec4(0.0); }\n#shader fragment\n\
          #version 150\nin vec4 v;\nout vec4 c;\nvoid main() { c = v; }\n",
    )]);
    let (found, exit) = folder.lint(&["a.glsl"]);
    assert_eq!((codes(&found), exit), (vec!["E0703"], 1), "the stages form a program");
    let labels = found[0]["labels"].as_array().expect("a list");
    assert_eq!(found[0]["line"], 7);
    assert!(labels.iter().any(|label| label["line"] == 3 && label["file"] == "a.glsl"), "{labels:?}");
    let (_, exit) = folder.lint(&["a.glsl", "--stage", "vertex"]);
    assert_eq!(exit, 0, "one stage alone");
}

#[test]
fn a_search_finds_files_of_several_stages() {
    let folder = Folder::new(&[
        ("a.glsl", include_bytes!("../../fixtures/engines/combined/chosen.glsl")),
        ("lib.glsl", b"float f() { return 1.0; }\n"),
        ("toy/image.glsl", include_bytes!("../../fixtures/engines/shadertoy/waves.glsl")),
        ("toy/glisten.toml", b"[[source]]\nglob = \"*.glsl\"\nprofile = \"shadertoy\"\n"),
        ("old.vp", b"!!ARBvp1.0\nEND\n"),
    ]);
    let output = folder.run(&["lint", "."]);
    assert_eq!(code(&output), 0, "{}", out(&output));
    assert!(err(&output).contains("2 files, 1 program"), "{}", err(&output));
}

#[test]
fn scenes_draw_files_of_several_stages() {
    let scene = "fixtures/engines/libretro/lines.toml";
    let folder = Folder::new(&[]);
    let picture = folder.path("lines.npy").to_string_lossy().into_owned();
    let output = here(&["render", scene, "-o", &picture, "--backend", "cpu"]);
    assert_eq!(code(&output), 0, "{}", err(&output));
    let bytes = std::fs::read(folder.path("lines.npy")).expect("it was written");
    let floats: Vec<f32> = bytes[bytes.len() - 16 * 16 * 16..]
        .chunks_exact(4)
        .map(|bytes| f32::from_le_bytes(bytes.try_into().expect("four")))
        .collect();
    // Every other pair of rows is darker by DARKNESS.
    let reds: Vec<f32> = floats.iter().step_by(4 * 16).copied().collect();
    assert!(reds.contains(&0.25) && reds.contains(&0.0625) && reds.len() == 16, "{reds:?}");
    let made = here(&["new-scene", "fixtures/engines/libretro/lines.glsl"]);
    assert_eq!(code(&made), 0, "{}", err(&made));
    assert!(out(&made).contains("MVPMatrix") && out(&made).contains("VertexCoord"), "{}", out(&made));
    let into = folder.path("out").to_string_lossy().into_owned();
    let special = here(&["specialize", "-q", scene, "-o", &into]);
    assert_eq!(code(&special), 0, "{}", err(&special));
}

#[test]
fn tables_add_up_and_are_checked() {
    let source = b"out vec4 c;\nvoid main() { c = vec4(A + B); }\n" as &[u8];
    let folder = Folder::new(&[
        ("a/x.frag", source),
        ("b/x.frag", source),
        ("glisten.toml", b"[[source]]\nversion = \"150\"\ndefines = { A = 1.0, B = 1.0 }\n[[source]]\nglob = \"b/\"\ndefines = \"B=wrong\"\n"),
        ("bad/x.frag", source),
        ("bad/glisten.toml", b"[[source]]\nprofile = \"minecraf\"\nversion = \"new\"\nprelude = \"none.glsl\"\nincludes = [\"none\"]\ninclude-style = \"moi\"\nstage = \"tess\"\ndefines = [\"1\"]\n"),
        ("key/x.frag", source),
        ("key/glisten.toml", b"[[source]]\nprofle = \"iris\"\n"),
    ]);
    assert_eq!(folder.lint(&["a/x.frag"]).1, 0);
    let (found, exit) = folder.lint(&["b/x.frag"]);
    assert_eq!((codes(&found), exit), (vec!["E0301"], 1), "the later table counts");
    assert_eq!(folder.lint(&["b/x.frag", "-D", "B=2.0"]).1, 0, "a flag takes precedence");
    let (found, exit) = folder.lint(&["bad/x.frag"]);
    let wrong: Vec<(u64, &str)> = found
        .iter()
        .filter(|finding| finding["file"].as_str().is_some_and(|file| file.ends_with("glisten.toml")))
        .map(|finding| (finding["line"].as_u64().unwrap_or(0), finding["code"].as_str().unwrap_or("")))
        .collect();
    assert_eq!(exit, 2, "a file that is missing");
    let mut lines: Vec<u64> = wrong.iter().map(|(line, _)| *line).collect();
    lines.sort_unstable();
    assert_eq!(lines, [2, 3, 4, 5, 6, 7, 8], "{wrong:?}");
    let help = found.iter().find_map(|finding| finding["help"].as_str().filter(|help| help.contains("minecraft")));
    assert!(help.is_some(), "{found:?}");
    assert!(codes(&folder.lint(&["key/x.frag"]).0).contains(&"E0015"));
}

#[test]
fn a_wrong_header_is_told_at_its_place() {
    let folder = Folder::new(&[("a.fs", b"/*{\n  \"INPUTS\": [ } }*/\nvoid main() { gl_FragColor = vec4(1.0); }\n")]);
    let (found, exit) = folder.lint(&["a.fs", "--engine", "isf"]);
    assert_eq!((codes(&found), exit), (vec!["E0016"], 1));
    assert_eq!((found[0]["file"].as_str(), found[0]["line"].as_u64()), (Some("a.fs"), Some(2)));
}

/// The names that the header would declare are not known then; functions and types are.
#[test]
fn names_are_no_errors_where_a_header_cannot_be_read() {
    let text = "/*{\"INPUTS\": [{\"NAME\": \"speed\", \"TYPE\": \"float\"},]}*/\n\
                void main() { gl_FragColor = vec4(speed * TIME, spede, f(1.0), 1.0); }\n";
    let folder = Folder::new(&[("a.fs", text.as_bytes())]);
    let (found, exit) = folder.lint(&["a.fs", "--engine", "isf"]);
    assert_eq!((codes(&found), exit), (vec!["E0016", "E0304"], 1), "{found:?}");
    assert!(found[0].to_string().contains("names that nothing declares are no errors here"), "{}", found[0]);
}

/// The profile chooses the version, and not the author, who writes what the format prescribes.
#[test]
fn a_version_that_an_engine_adds_makes_no_word_old() {
    let source = "/*{\"INPUTS\": []}*/\nvarying vec2 t;\nvoid main() { gl_FragColor = vec4(t, TIME, 1.0); }\n";
    let own = format!("#version 150\n{}", source.replace("TIME", "0.0"));
    let folder = Folder::new(&[("a.fs", source.as_bytes()), ("own.frag", own.as_bytes())]);
    assert_eq!(folder.lint(&["a.fs", "--engine", "isf", "--warn", "L0071", "--warn", "L0072"]).0.len(), 0);
    let (found, _) = folder.lint(&["own.frag"]);
    assert!(["L0071", "L0072"].iter().all(|code| codes(&found).contains(code)), "{found:?}");
}

/// Declarations of the shader's own take the place of the engine's, and parameters do not.
#[test]
fn an_engine_declares_what_a_shader_does_not() {
    let image = "{\"NAME\": \"env\", \"TYPE\": \"cube\", \"PATH\": [\"0.jpg\"]}";
    let source = format!(
        "/*{{\"INPUTS\": [], \"IMPORTED\": [{image}]}}*/\nfloat f(in float TIME) {{ return TIME; }}\n\
         void main() {{ gl_FragColor = f(TIME) * textureCube(env, vec3(isf_FragNormCoord, 1.0)); }}\n"
    );
    let vertex = "out vec2 isf_FragNormCoord;\nvoid main() { isf_vertShaderInit(); }\n";
    let folder = Folder::new(&[("a.fs", source.as_bytes()), ("b.vs", vertex.as_bytes())]);
    let (found, exit) = folder.lint(&["a.fs", "b.vs", "--engine", "isf"]);
    assert_eq!((codes(&found), exit), (vec![], 0), "{found:?}");
}

#[test]
fn hostile_sources_end() {
    let marks = "#shader vertex\n#shader fragment\n".repeat(20_000);
    let tags = "@vs a\n@include_block b\n@end\n@block b\n@include_block b\n@end\n@program p a a\n".repeat(5_000);
    let quotes = "*/`".repeat(400_000);
    let words = format!("void f(float iTime) {{ {} }}", "iTime ".repeat(200_000));
    let mains = "main( ".repeat(200_000);
    let cut = "/*{\"INPUTS\": [\u{e9}";
    let folder = Folder::new(&[
        ("marks.glsl", marks.as_bytes()),
        ("tags.glsl", tags.as_bytes()),
        ("cut.fs", cut.as_bytes()),
        ("quotes.glsl", quotes.as_bytes()),
        ("words.glsl", words.as_bytes()),
        ("mains.glsl", mains.as_bytes()),
        ("quote.glsl", "vertex = `\u{e9}fragment=`".as_bytes()),
    ]);
    let begun = std::time::Instant::now();
    for (file, engine) in [
        ("marks.glsl", "isf"),
        ("tags.glsl", "isf"),
        ("cut.fs", "isf"),
        ("quote.glsl", "isf"),
        ("quotes.glsl", "isf"),
        ("words.glsl", "shadertoy"),
        ("mains.glsl", "shadertoy"),
    ] {
        let (_, exit) = folder.lint(&[file, "--stage", "fragment", "--engine", engine]);
        assert_eq!(exit, 1, "{file}");
    }
    assert!(begun.elapsed().as_secs() < 60, "{:?}", begun.elapsed());
}

/// The names tell a vertex and a fragment shader alone, and a third file is between them.
#[test]
fn stages_with_an_unnamed_one_between_are_no_pair() {
    let stages: [(&str, &[u8]); 2] = [
        ("Vertexshader.glsl", b"#version 330\nin vec3 at;\nvoid main() { gl_Position = vec4(at, 1.0); }\n"),
        (
            "Fragmentshader.glsl",
            b"#version 330\nin vec3 tint;\nout vec4 color;\nvoid main() { color = vec4(tint, 1.0); }\n",
        ),
    ];
    let geometry: &[u8] = b"#version 330\nlayout(points) in;\nlayout(points, max_vertices = 1) out;\nout vec3 tint;\n\
        void main() { tint = vec3(1.0); gl_Position = gl_in[0].gl_Position; EmitVertex(); }\n";
    let part: &[u8] = b"// EmitVertex\nvec3 shade(vec3 x) { return x; }\n";
    let folder = Folder::new(&[stages[0], stages[1], ("part.glsl", part)]);
    assert_eq!(codes(&folder.lint(&["."]).0), ["E0702"]);
    let folder = Folder::new(&[stages[0], stages[1], ("Geometrieshader.glsl", geometry)]);
    let (found, exit) = folder.lint(&["."]);
    assert_eq!((exit, codes(&found)), (0, vec![]), "{found:?}");
    let named = folder.lint(&["Vertexshader.glsl", "Fragmentshader.glsl"]);
    assert_eq!(codes(&named.0), ["E0702"]);
    let files = ["a_vs.glsl", "a_fs.glsl", "b_vs.glsl", "b_fs.glsl"];
    let both: Vec<(&str, &[u8])> =
        files.iter().zip(stages.iter().cycle()).map(|(name, stage)| (*name, stage.1)).collect();
    let folder = Folder::new(&[&both[..], &[("b_mesh.glsl", geometry)]].concat());
    let (found, _) = folder.lint(&["."]);
    assert_eq!((codes(&found), found[0]["file"].as_str()), (vec!["E0702"], Some("a_fs.glsl")));
}

#[test]
fn stages_with_tessellation_between_are_no_pair() {
    let stages: [(&str, &[u8]); 2] = [
        ("hill.vert", b"#version 410\nin vec3 at;\nout vec3 patch_at;\nvoid main() { patch_at = at; gl_Position = vec4(at, 1.0); }\n"),
        ("hill.frag", b"#version 410\nin float height;\nout vec4 color;\nvoid main() { color = vec4(height); }\n"),
    ];
    let alone = Folder::new(&stages);
    assert_eq!(codes(&alone.lint(&["."]).0), ["E0702"]);
    let with = Folder::new(&[stages[0], stages[1], ("hill.tese", b"#version 410\nvoid main() {}\n")]);
    assert_eq!(with.lint(&["."]).1, 0);
}
