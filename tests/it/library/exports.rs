//! `glisten lib export` in the languages of hosts: WGSL, and structs in Rust and C.

use super::command::{err, out, run};
use crate::cli::{Folder, code};
use crate::emit::{Collected, missing};
use glisten_emit::Emitted;
use glisten_library::{Entry, FunctionEntry, entries};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::Command;

/// The files of a form, in a folder.
fn exported(arguments: &[&str]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let target = folder.path().to_string_lossy().into_owned();
    let output = run(&[&["export"], arguments, &[target.as_str()]].concat());
    assert_eq!(output.status.code(), Some(0), "{}", err(&output));
    folder
}

fn text(folder: &Path, file: &str) -> String {
    fs::read_to_string(folder.join(file)).unwrap_or_else(|error| panic!("{file}: {error}"))
}

/// The names in WGSL that the documentation promises, for each function of the library.
fn names(all: &[Entry]) -> BTreeMap<String, String> {
    let functions = || all.iter().flat_map(|entry| &entry.functions);
    let name = |one: &FunctionEntry| {
        if functions().any(|other| other.name == one.name && other.signature != one.signature) {
            one.signature.trim_end_matches(')').replace(['(', ','], "_")
        } else {
            one.name.clone()
        }
    };
    functions().map(|one| (one.signature.clone(), name(one))).collect()
}

#[test]
fn every_module_is_wgsl_with_all_of_its_functions_and_their_comments() {
    let folder = exported(&["--wgsl"]);
    let all = entries();
    let names = names(&all);
    let mut collected = Collected::new();
    for entry in &all {
        let file = format!("{}.wgsl", entry.module.name);
        let text = text(folder.path(), &file);
        let module =
            naga::front::wgsl::parse_str(&text).unwrap_or_else(|error| panic!("{}", error.emit_to_string(&text)));
        assert!(module.entry_points.is_empty(), "{file}");
        for function in &entry.functions {
            let name = &names[&function.signature];
            let (above, _) = text.split_once(&format!("\nfn {name}(")).unwrap_or_else(|| panic!("{file} lacks {name}"));
            let comment: Vec<&str> = above.lines().rev().take_while(|line| line.starts_with("//")).collect();
            let first = function.documentation.split_whitespace().next().expect("every function is documented");
            assert!(comment.iter().any(|line| line.contains(first)), "{name} in {file}: {comment:?}");
        }
        collected.add(&file, Emitted::Text(text));
    }
    let whole = text(folder.path(), "glisten.wgsl");
    let lacking: Vec<&String> = names.values().filter(|name| !whole.contains(&format!("\nfn {name}("))).collect();
    assert!(lacking.is_empty(), "{lacking:?}");
    collected.add("glisten.wgsl", Emitted::Text(whole));
    collected.validate();
}

#[test]
fn wgsl_has_the_constants_and_the_uniforms_of_a_module() {
    let folder = exported(&["--wgsl"]);
    let lights = text(folder.path(), "lights.wgsl");
    for part in ["// The values of Light.kind.\nconst LIGHT_DIRECTIONAL: i32 = 0;\n", "\nconst LIGHT_POINT: i32 = 1;\n"]
    {
        assert!(lights.contains(part), "{part:?} in {lights}");
    }
    let scene = text(folder.path(), "scene.wgsl");
    for part in ["    light: array<Light, 8>,\n", "    material: Material,\n", "@group(0) @binding(0) var<uniform> "] {
        assert!(scene.contains(part), "{part:?} in {scene}");
    }
    let folder = exported(&["--wgsl", "-D", "GLISTEN_LIGHTS=16", "-D", "GLISTEN_CONES"]);
    let scene = text(folder.path(), "scene.wgsl");
    assert!(scene.contains("light: array<Light, 16>,") && scene.contains("    range: f32,"), "{scene}");
}

/// Files of WGSL as one, in which everything is once.
fn joined(texts: &[String]) -> String {
    let directive = "diagnostic(off, derivative_uniformity);";
    let mut parts = vec![directive];
    for part in texts.iter().flat_map(|text| text.split("\n\n")).map(str::trim) {
        if !parts.contains(&part) {
            parts.push(part);
        }
    }
    parts.join("\n\n") + "\n"
}

/// Four functions by the reference, and by the exported texts on a GPU: one of its name alone, two overloads, one with a sampler.
#[test]
fn exported_wgsl_computes_what_the_modules_do() {
    let folder = Folder::new(&[
        (
            "a.vert",
            b"#version 150\nin vec2 p;\nout vec2 q;\nvoid main() {\n    q = p * 0.5 + 0.5;\n    gl_Position = vec4(p, 0.0, 1.0);\n}\n",
        ),
        (
            "a.frag",
            b"#version 150\n#extension GL_ARB_shading_language_include : require\n#include <glisten/blinn_phong.glsl>\n\
              #include <glisten/lut.glsl>\n#include <glisten/sdf.glsl>\n#include <glisten/srgb.glsl>\nin vec2 q;\n\
              uniform sampler2D table;\nout vec4 c;\nvoid main() {\n    vec3 N = safeNormalize(vec3(q - 0.5, 0.6));\n    \
              c = vec4(blinnPhongFactor(N, vec3(0.0, 0.6, 0.8), vec3(0.0, 0.0, 1.0), 20.0),\n             \
              sdfCoverage(sdfBox(q - 0.5, vec2(0.3, 0.2)), 0.25), srgbEncode(q.x), lutColor(table, q.y).g);\n}\n",
        ),
        (
            "a.toml",
            b"[framebuffer]\nwidth = 32\nheight = 32\n[[draw]]\nvertex = \"a.vert\"\nfragment = \"a.frag\"\nvertex_count = 3\n\
              [draw.attributes]\np = { size = 2, values = [-1, -1, 3, -1, -1, 3] }\n[draw.textures]\ntable = { width = 2, height = 1, filter = \"linear\", wrap = \"clamp\", \
              values = [0.1, 0.2, 0.3, 1.0, 0.9, 0.8, 0.7, 1.0] }\n",
        ),
    ]);
    assert_eq!(code(&folder.run(&["compile", "a.vert", "a.frag", "-o", "out", "-q"])), 0);
    let compiled = text(&folder.path("out"), "a.frag.wgsl");
    let bindings: String =
        compiled.lines().filter(|line| line.starts_with("@group")).map(|line| format!("{line}\n")).collect();
    let files = exported(&["--wgsl"]);
    let library =
        joined(&["blinn_phong", "lut", "sdf", "srgb"].map(|name| text(files.path(), &format!("{name}.wgsl"))));
    let main = "@fragment\nfn main(@location(0) q: vec2<f32>) -> @location(0) vec4<f32> {\n    \
                let N = safeNormalize(vec3(q - 0.5, 0.6));\n    \
                return vec4(blinnPhongFactor(N, vec3(0.0, 0.6, 0.8), vec3(0.0, 0.0, 1.0), 20.0),\n        \
                sdfCoverage(sdfBox_vec2_vec2(q - 0.5, vec2(0.3, 0.2)), 0.25), srgbEncode_float(q.x),\n        \
                lutColor(table, table_sampler, q.y).g);\n}\n";
    let verify = |main: &str| {
        fs::write(folder.path("w.wgsl"), format!("{library}\n{bindings}\n{main}")).expect("written");
        folder.run(&["verify", "a.toml", "--with", "fragment=w.wgsl"])
    };
    let output = verify(main);
    assert_eq!(code(&output), 0, "{}{}", out(&output), err(&output));
    for (right, wrong) in
        [("20.0", "20.1"), ("(0.3, 0.2)", "(0.3, 0.201)"), ("Encode_float", "Decode_float"), ("q.y", "q.x")]
    {
        let output = verify(&main.replace(right, wrong));
        assert_eq!(code(&output), 1, "{wrong}: {}{}", out(&output), err(&output));
    }
}

#[test]
fn structs_in_rust_have_the_offsets_that_they_assert() {
    let folder = exported(&["--rust"]);
    let text = text(folder.path(), "programs.rs");
    for part in ["    pub mod standard {", "pub light: [Light; 8],", "pub material: Material,"] {
        assert!(text.contains(part.trim_start()), "{part}");
    }
    let rustc = |text: &str| {
        let file = folder.path().join("host.rs");
        fs::write(&file, text).expect("written");
        let mut command = Command::new(std::env::var_os("RUSTC").unwrap_or("rustc".into()));
        command.args(["--edition", "2024", "--crate-type", "lib", "--emit", "metadata", "-D", "warnings", "--out-dir"]);
        command.arg(folder.path()).arg(&file).output().expect("rustc is there, since Cargo runs this")
    };
    let output = rustc(&text);
    assert!(output.status.success(), "{}", err(&output));
    let wrong = text.replacen("(Light, position) == 16", "(Light, position) == 12", 1);
    assert!(wrong != text && !rustc(&wrong).status.success(), "the compiler checks offsets");
}

#[test]
fn headers_in_c_have_the_offsets_that_they_assert() {
    let folder = exported(&["--c", "-D", "GLISTEN_LIGHTS=3"]);
    let standard = text(folder.path(), "standard.h");
    for part in [
        "typedef struct StandardLight {",
        "    StandardLight light[3];",
        "    StandardMaterial material;",
        "    float model_normal[3][4];",
    ] {
        assert!(standard.contains(part), "{part} in {standard}");
    }
    let every: String =
        glisten::library::programs().iter().map(|one| format!("#include \"{}.h\"\n", one.name)).collect();
    fs::write(folder.path().join("all.c"), every).expect("written");
    let compiles = |language: &str| {
        let mut command = Command::new("cc");
        command.args(["-fsyntax-only", "-Wall", "-Wextra", "-Werror", "-x"]).args(language.split(' '));
        command.arg(folder.path().join("all.c")).output()
    };
    let Ok(output) = compiles("c -std=c11") else {
        missing("cc", "Debian has it in the package gcc");
        return;
    };
    assert!(output.status.success(), "{}", err(&output));
    let wrong = standard.replacen("(StandardLight, position) == 16", "(StandardLight, position) == 12", 1);
    fs::write(folder.path().join("standard.h"), &wrong).expect("written");
    let output = compiles("c -std=c11").expect("it ran before");
    assert!(wrong != standard && !output.status.success(), "the compiler checks offsets");
}

#[test]
fn an_export_has_one_form_and_macros_are_for_some() {
    for arguments in
        [&["--wgsl", "--rust"][..], &["--flat", "--c"], &["-D", "A"], &["--flat", "-D", "A"], &["--wgsl", "-D", "1"]]
    {
        let output = run(&[&["export"], arguments, &["nowhere"]].concat());
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
    }
    let folder = tempfile::tempdir().expect("a temporary folder");
    let target = folder.path().to_string_lossy().into_owned();
    for form in ["--wgsl", "--rust", "--c"] {
        let output = run(&["export", form, "-D", "safeNormalize=1", &target]);
        assert_eq!(output.status.code(), Some(1), "{form}: {}", err(&output));
        assert!(err(&output).contains("error[") && err(&output).contains("a macro of `-D`"), "{}", err(&output));
    }
}
