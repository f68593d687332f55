//! `glisten port`: whole folders for other hosts, which glslang takes.
//!
//! The judge is `glslangValidator`. If it is missing, the test says so; if `CI` is set, it fails.

use crate::cli::{Folder, code, err, out};
use crate::emit::missing;
use crate::support::root;
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

fn port(folder: &Folder, pack: &str, host: &str, more: &[&str]) -> Output {
    let pack = root().join("fixtures/port").join(pack).to_string_lossy().into_owned();
    let mut arguments = vec!["port", &pack, "--for", host];
    arguments.extend(more);
    folder.run(&arguments)
}

fn read(folder: &Folder, name: &str) -> String {
    fs::read_to_string(folder.path(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

#[track_caller]
fn has(text: &str, parts: &[&str]) {
    for part in parts {
        assert!(text.contains(part), "no `{part}` in:\n{text}");
    }
}

/// The complaint of glslang about a file by Vulkan's rules, if there is one; glslang gives the numbers.
fn complaint(file: &Path, stage: &str, includes: &Path) -> Option<String> {
    let mut command = Command::new("glslangValidator");
    command.arg(format!("-I{}", includes.display()));
    command.args(["-V", "--amb", "--aml", "--target-env", "vulkan1.1", "-S", stage, "-o", "/dev/null"]).arg(file);
    let Ok(output) = command.output() else {
        missing("glslangValidator", "Debian has it in the package glslang-tools");
        return None;
    };
    (!output.status.success()).then(|| String::from_utf8_lossy(&output.stdout).into_owned())
}

#[test]
fn an_engine_for_vulkan_and_wgpu() {
    let folder = Folder::new(&[]);
    for host in ["vulkan", "wgpu"] {
        let output = port(&folder, "engine", host, &["-o", host]);
        assert_eq!(code(&output), 0, "{}", err(&output));
        has(&err(&output), &["3 programs: 3 ported, 0 unchanged, 0 for it already, 0 left as they were"]);
        let light = read(&folder, &format!("{host}/parts/light.glsl"));
        has(
            &light,
            &[
                "uniform LightUniforms {\n    layout(offset = 0) vec3 lightDirection;  // toward the light\n    layout(offset = 16) vec3 ambient;\n};",
                "    sum += color * ambient;",
            ],
        );
        has(
            &read(&folder, &format!("{host}/plain.frag")),
            &["    layout(offset = 64) vec3 albedo;", "  // without light\n"],
        );
        for name in ["plain", "soft", "old"] {
            for stage in ["vert", "frag"] {
                let said = complaint(&folder.path(&format!("{host}/{name}.{stage}")), stage, &folder.path(host));
                assert!(
                    said.is_none(),
                    "{name}.{stage}: {said:?}\n{}",
                    read(&folder, &format!("{host}/{name}.{stage}"))
                );
            }
        }
        let account: Value = serde_json::from_str(&read(&folder, &format!("{host}/port.json"))).expect("JSON");
        assert_eq!(account["summary"]["ported"], 3);
        assert_eq!(account["programs"][0]["result"], "ported");
        has(&read(&folder, &format!("{host}/port.html")), &["LightUniforms", "<h1>engine for "]);
        assert_eq!(read(&folder, &format!("{host}/README.txt")), "A file that is no shader.\n");
        // Once more, and nothing is written; nor is there anything left to do.
        let again = port(&folder, "engine", host, &["-o", host]);
        has(&err(&again), &["wrote 0 files"]);
        let check = port(&folder, "engine", host, &["-o", host, "--check"]);
        assert_eq!((code(&check), out(&check)), (0, String::new()), "{}", err(&check));
        // The new folder is for the host already.
        let new = folder.path(host).to_string_lossy().into_owned();
        let second = folder.run(&["port", &new, "--for", host, "--check"]);
        assert_eq!((code(&second), out(&second)), (0, String::new()), "{}", err(&second));
        fs::write(folder.path(&format!("{host}/plain.vert")), "changed").expect("writable");
        let check = port(&folder, "engine", host, &["-o", host, "--check"]);
        assert_eq!(code(&check), 1);
        has(&out(&check), &["plain.vert\n"]);
    }
    has(&read(&folder, "wgpu/wgsl/soft.frag.wgsl"), &["@fragment"]);
    has(&read(&folder, "wgpu/shaders.rs"), &["pub mod plain", "wgpu::BindGroupLayout"]);
    let header = read(&folder, "vulkan/include/plain.h");
    has(
        &header,
        &[
            "#define PLAIN_LOCATION_POSITION 0u",
            "float viewProjection[16];",
            "_Static_assert(offsetof(plain_Uniforms, albedo) == 64",
        ],
    );
    let compiled = Command::new("cc")
        .args(["-std=c11", "-fsyntax-only", "-x", "c"])
        .arg(folder.path("vulkan/include/plain.h"))
        .output();
    match compiled {
        Ok(output) => assert!(output.status.success(), "{}\n{header}", String::from_utf8_lossy(&output.stderr)),
        Err(_) => missing("cc", "Debian has it in the package gcc"),
    }
}

#[test]
fn a_pack_for_minecraft() {
    let folder = Folder::new(&[]);
    for (host, directive) in [("minecraft-26.2", "moj_import"), ("minecraft-26.3", "include")] {
        let output = port(&folder, "pack", host, &["-o", host]);
        assert_eq!(code(&output), 0, "{}", err(&output));
        let shaders = format!("{host}/assets/minecraft/shaders");
        let haze = read(&folder, &format!("{shaders}/include/haze.glsl"));
        has(
            &haze,
            &[
                &format!("#{directive} <minecraft:fog.glsl>\n"),
                "smoothstep(FogRenderDistanceStart, FogRenderDistanceEnd, far)",
            ],
        );
        assert!(!haze.contains("uniform"), "{haze}");
        let vertex = read(&folder, &format!("{shaders}/core/lantern.vsh"));
        has(
            &vertex,
            &[
                "#version 330",
                &format!("#{directive} <haze.glsl>"),
                &format!("#{directive} <minecraft:dynamictransforms.glsl>\n"),
                &format!("#{directive} <minecraft:projection.glsl>\n"),
                "Position + ModelOffset",
            ],
        );
        let fragment = read(&folder, &format!("{shaders}/core/lantern.fsh"));
        has(&fragment, &[&format!("#{directive} <minecraft:globals.glsl>\n"), "    // The flame moves.\n"]);
        let warm = read(&folder, &format!("{shaders}/post/warm.fsh"));
        has(
            &warm,
            &[
                "layout(std140) uniform SamplerInfo {\n    vec2 OutSize;\n    vec2 InSize;\n};",
                "    vec3 Tint;  // of the evening\n    float Amount;\n",
            ],
        );
        assert_eq!(
            fragment.contains("layout(location = 0) out vec4 fragColor;"),
            host == "minecraft-26.3",
            "{fragment}"
        );
        let passes: Value =
            serde_json::from_str(&read(&folder, &format!("{host}/assets/minecraft/post_effect/warm.json")))
                .expect("JSON");
        let uniforms = passes["passes"][0]["uniforms"].as_object().expect("blocks");
        let (block, values) = uniforms.iter().next().expect("one");
        assert!(warm.contains(&format!("uniform {block} {{")), "{block}: {warm}");
        assert_eq!(values[1]["value"], 0.5);
        let said = complaint(&folder.path(&format!("{shaders}/post/warm.fsh")), "frag", &folder.path(host));
        assert!(said.is_none(), "{said:?}\n{warm}");
        let again = port(&folder, "pack", host, &["-o", host, "--check"]);
        assert_eq!((code(&again), out(&again)), (0, String::new()), "{}", err(&again));
        let new = folder.path(host).to_string_lossy().into_owned();
        let second = folder.run(&["port", &new, "--for", host, "--check"]);
        assert_eq!((code(&second), out(&second)), (0, String::new()), "{}", err(&second));
    }
}

#[test]
fn what_cannot_be_ported_stays() {
    let folder = Folder::new(&[
        ("in/good.frag", b"#version 150\nuniform vec4 tint;\nout vec4 c;\nvoid main() { c = tint; }\n"),
        ("in/bad.frag", b"#version 150\nout vec4 c;\nvoid main() { c = missing; }\n"),
        ("in/macro.frag", b"#version 150\n#define U uniform vec4 u;\nU\nout vec4 c;\nvoid main() { c = u; }\n"),
    ]);
    let output = folder.run(&["port", "in", "--for", "vulkan", "-o", "out", "--format", "json"]);
    assert_eq!(code(&output), 1, "{}", err(&output));
    let account: Value = serde_json::from_str(&out(&output)).expect("JSON");
    assert_eq!((&account["summary"]["ported"], &account["summary"]["refused"]), (&1.into(), &2.into()));
    has(&err(&output), &["`bad` stays as it was", "(E0301)", "inside of a macro"]);
    assert_eq!(read(&folder, "out/bad.frag"), read(&folder, "in/bad.frag"));
    assert_eq!(read(&folder, "out/macro.frag"), read(&folder, "in/macro.frag"));
    has(&read(&folder, "out/good.frag"), &["layout(offset = 0) vec4 tint;"]);
    assert_eq!(code(&folder.run(&["port", "in", "--for", "vulkan", "-o", "in/out"])), 2);
    assert_eq!(code(&folder.run(&["port", "nowhere", "--for", "vulkan", "-o", "x"])), 2);
    assert_eq!(code(&folder.run(&["port", "in", "--for", "dreamcast", "-o", "x"])), 2);
}

#[test]
fn pictures_prove_a_port() {
    let folder = Folder::new(&[]);
    for (pack, host) in [("engine", "vulkan"), ("pack", "minecraft-26.2")] {
        let output = port(&folder, pack, host, &["-o", host, "--prove", "--format", "json"]);
        assert_eq!(code(&output), 0, "{}", err(&output));
        let account: Value = serde_json::from_str(&out(&output)).expect("JSON");
        assert_eq!(account["summary"]["failed"], 0, "{account:#}");
        assert!(account["summary"]["proved"].as_u64() >= Some(1), "{account:#}");
    }
}
