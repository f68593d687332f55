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
pub(crate) fn has(text: &str, parts: &[&str]) {
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
fn a_pack_for_an_older_game_brings_its_files_along() {
    let folder = Folder::new(&[]);
    let game = root().join("fixtures/port/older/game").to_string_lossy().into_owned();
    let output = port(&folder, "older/pack", "minecraft-26.2", &["-I", &game, "-o", "new"]);
    assert_eq!(code(&output), 0, "{}", err(&output));
    has(&err(&output), &["3 programs: 3 ported"]);
    let shaders = "new/assets/minecraft/shaders";
    let vertex = read(&folder, &format!("{shaders}/core/torch.vsh"));
    has(
        &vertex,
        &[
            "#version 330\n\n#moj_import <minecraft:older/light.glsl>\n#moj_import <older/fog.glsl>\n#moj_import <older/matrix.glsl>\n",
            // Functions of the host's own files could be those of the older ones.
            "#moj_import <minecraft:blocks/projection.glsl>\n#moj_import <minecraft:blocks/light.glsl>\n",
            "#moj_import <minecraft:dynamictransforms.glsl>\n",
        ],
    );
    // `sampler` is a type of GLSL for Vulkan; lines go on by an extension.
    let fragment = read(&folder, &format!("{shaders}/core/torch.fsh"));
    has(
        &fragment,
        &["#extension GL_ARB_shading_language_420pack : enable\n", "vec4 flame(sampler2D sampler_, vec2 at)"],
    );
    has(&read(&folder, &format!("{shaders}/include/older/fog.glsl")), &["#version 150\n", "float fog_depth("]);
    has(
        &read(&folder, &format!("{shaders}/include/blocks/fog.glsl")),
        &["layout(std140) uniform Fog {\n    vec4 FogColor;"],
    );
    // What would hide the host's files has gone, whether a program reads it or not.
    for name in ["light", "projection"] {
        assert!(!folder.path(&format!("{shaders}/include/{name}.glsl")).exists(), "{name}");
        assert!(folder.path(&format!("{shaders}/include/older/{name}.glsl")).exists(), "{name}");
    }
    // A file in the folder of included ones is no program, and an overlay has what its pack has.
    has(&read(&folder, &format!("{shaders}/include/parts/wave.vsh")), &["Position.y + HEIGHT"]);
    has(&read(&folder, "new/newer/assets/minecraft/shaders/core/torch.vsh"), &["<minecraft:older/light.glsl>"]);
    let names = ["assets/minecraft/shaders/core/torch", "newer/assets/minecraft/shaders/core/torch"];
    for name in names {
        assert!(folder.path(&format!("new/reflection/{name}.json")).exists(), "{name}");
    }
    let again = port(&folder, "older/pack", "minecraft-26.2", &["-I", &game, "-o", "new", "--check"]);
    assert_eq!((code(&again), out(&again)), (0, String::new()), "{}", err(&again));
    let second = folder.run(&["port", "new", "--for", "minecraft-26.2", "--check"]);
    assert_eq!((code(&second), out(&second)), (0, String::new()), "{}", err(&second));
    // Without the game, the reason says what is missing.
    let alone = port(&folder, "older/pack", "minecraft-26.2", &["-o", "alone"]);
    assert_eq!(code(&alone), 1);
    has(&err(&alone), &["`torch` stays as it was", "`-I GAME` names the assets of the version"]);
}

#[test]
fn a_pack_below_a_folder_of_includes_has_programs() {
    let shader = "include/pack/assets/minecraft/shaders/core/a.fsh";
    let folder = Folder::new(&[(shader, b"#version 150\nout vec4 c;\nvoid main() { c = vec4(1.0); }\n")]);
    let output = folder.run(&["port", "include/pack", "--for", "minecraft-26.2", "-o", "out"]);
    assert_eq!(code(&output), 0);
    has(&err(&output), &["1 program: 1 ported"]);
}

#[test]
fn names_that_are_types_for_vulkan_change() {
    let folder = Folder::new(&[
        ("a.frag", b"#version 150\nuniform sampler2D s;\nout vec4 c;\nvec4 at(sampler2D sampler) { return texture(sampler, vec2(0.5)); }\nvoid main() { c = at(s); }\n"),
        (
            "in/assets/minecraft/shaders/core/b.fsh",
            b"#version 420\n#moj_import <at.glsl>\nuniform sampler2D s;\nout vec4 c;\nvec4 mix(vec4 a) { return a; } // texture2D\n\
              void main() { c = mix(at(s)); }\n",
        ),
        (
            "in/assets/minecraft/shaders/include/at.glsl",
            b"vec4 at(sampler2D sampler) { // the sampler\n    return texture(sampler, vec2(0.5));\n}\n",
        ),
    ]);
    assert_eq!(code(&folder.run(&["upgrade", "a.frag", "--to", "vulkan", "-o", "new"])), 0);
    has(&read(&folder, "new/a.frag"), &["at(sampler2D sampler_) { return texture(sampler_, "]);
    let said = complaint(&folder.path("new/a.frag"), "frag", &folder.path("new"));
    assert!(said.is_none(), "{said:?}");
    // A text that is newer than the host's language keeps all else.
    let output = folder.run(&["port", "in", "--for", "minecraft-26.2", "-o", "out"]);
    assert_eq!((code(&output), err(&output).contains("1 program: 1 ported")), (0, true), "{}", err(&output));
    let new = read(&folder, "out/assets/minecraft/shaders/core/b.fsh");
    has(&new, &["#version 420\n", "vec4 mix_(vec4 a) { return a; } // texture2D\n", "c = mix_(at(s));"]);
    let include = read(&folder, "out/assets/minecraft/shaders/include/at.glsl");
    assert_eq!(include, "vec4 at(sampler2D sampler_) { // the sampler\n    return texture(sampler_, vec2(0.5));\n}\n");
    let again = folder.run(&["port", "in", "--for", "minecraft-26.2", "-o", "out", "--check"]);
    assert_eq!(code(&again), 0, "{}", err(&again));
}

/// As real trees showed: each program by itself was ported, and not among the others.
#[test]
fn programs_of_one_tree_do_not_refuse_each_other() {
    let vertex = b"#version 150\nin vec4 p;\nvoid main() { gl_Position = p; }\n";
    let folder = Folder::new(&[
        // Names that one program has are no names of another.
        ("in/old.vert", b"#version 120\nvoid main() { gl_ClipVertex = gl_Vertex; gl_Position = ftransform(); }\n"),
        ("in/plain.vert", vertex),
        // A redeclared block lacks the size of points, which Vulkan wants.
        (
            "in/block.vert",
            b"#version 410\nlayout(location = 0) in vec4 p;\nout gl_PerVertex { vec4 gl_Position; };\nvoid main() { gl_Position = p; }\n",
        ),
        ("in/place.vert", vertex),
        (
            "in/place.frag",
            b"#version 150\nuniform vec4 tint;\nin vec4 gl_FragCoord;\nout vec4 c;\nvoid main() { c = tint * gl_FragCoord.y; }\n",
        ),
        // A constant after the first uniform; an input that nothing writes and nothing reads.
        (
            "in/bones.vert",
            b"#version 330 core\nlayout(location = 0) in vec4 p;\nuniform mat4 m;\nconst int MAX = 4;\nuniform mat4 bones[MAX];\nvoid main() { gl_Position = m * bones[1] * p; }\n",
        ),
        ("in/bones.frag", b"#version 330 core\nin vec2 nobody;\nout vec4 c;\nvoid main() { c = vec4(1.0); }\n"),
        // A function of its own, which later versions have built in; a call of `texture2D` stays one.
        (
            "in/own.frag",
            b"#version 130\n#define UNIT normalize(vec2(1.0))\nuniform sampler2D s;\nout vec4 c;\nmat2 inverse(mat2 m) { return m; }\nvoid main() { c = texture2D(s, inverse(mat2(1.0))[0] * UNIT); }\n",
        ),
        // Samplers in a struct.
        (
            "in/lit.frag",
            b"#version 330 core\nstruct Material {\n    sampler2D diffuse;\n    float shininess;\n};\nuniform vec3 eye;\nuniform Material material;\nout vec4 c;\nvoid main() { c = texture(material.diffuse, eye.xy) * material.shininess; }\n",
        ),
        (
            "in/rect.frag",
            b"#version 150\nuniform sampler2DRect s;\nout vec4 c;\nvoid main() { c = texture(s, vec2(1.0)); }\n",
        ),
    ]);
    let output = folder.run(&["port", "in", "--for", "vulkan", "-o", "out", "--format", "json"]);
    let account: Value = serde_json::from_str(&out(&output)).expect("JSON");
    let refused: Vec<&str> = account["programs"]
        .as_array()
        .into_iter()
        .flatten()
        .filter(|program| program["result"] == "refused")
        .filter_map(|program| program["name"].as_str())
        .collect();
    assert_eq!(refused, ["old", "rect"], "{account:#}");
    has(
        &err(&output),
        &["`s` is a rectangle texture, which Vulkan does not have", "`gl_ClipVertex` has no counterpart"],
    );
    has(
        &read(&folder, "out/own.frag"),
        &["mat2 inverse_(mat2 m)", "texture(s, inverse_(mat2(1.0))[0] * UNIT)", "UNIT normalize(vec2(1.0))"],
    );
    has(
        &read(&folder, "out/lit.frag"),
        &[
            "struct Material {\n    float shininess;\n};\n",
            "layout(set = 1, binding = 0) uniform sampler2D material_diffuse;",
            "texture(material_diffuse, eye.xy) * material.shininess",
        ],
    );
    assert!(account["files"].to_string().contains("`material.diffuse` is `material_diffuse`"), "{account:#}");
    has(&read(&folder, "out/block.vert"), &["float gl_PointSize;", "gl_PointSize = 1.0;"]);
    let names =
        ["plain.vert", "block.vert", "place.vert", "place.frag", "bones.vert", "bones.frag", "own.frag", "lit.frag"];
    for name in names {
        let stage = name.rsplit('.').next().unwrap_or("");
        let said = complaint(&folder.path(&format!("out/{name}")), stage, &folder.path("out"));
        assert!(said.is_none(), "{name}: {said:?}\n{}", read(&folder, &format!("out/{name}")));
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
fn a_program_that_wgsl_lacks_stays_and_the_others_are_ported() {
    let folder = Folder::new(&[
        ("in/ok.vert", b"#version 150\nin vec4 p;\nvoid main() { gl_Position = p; }\n"),
        ("in/ok.frag", b"#version 150\nuniform vec4 tint;\nout vec4 c;\nvoid main() { c = tint; }\n"),
        ("in/point.vert", b"#version 150\nin vec4 p;\nvoid main() { gl_Position = p; gl_PointSize = 8.0; }\n"),
        ("in/point.frag", b"#version 150\nout vec4 c;\nvoid main() { c = vec4(gl_PointCoord, 0.0, 1.0); }\n"),
    ]);
    for host in ["wgpu", "bevy"] {
        let output = folder.run(&["port", "in", "--for", host, "-o", host, "--format", "json"]);
        assert_eq!(code(&output), 1, "{}", err(&output));
        let account: Value = serde_json::from_str(&out(&output)).expect("JSON");
        assert_eq!((&account["summary"]["ported"], &account["summary"]["refused"]), (&1.into(), &1.into()));
        has(&err(&output), &["`point` stays as it was", "gl_PointCoord"]);
        assert_eq!(read(&folder, &format!("{host}/point.frag")), read(&folder, "in/point.frag"));
    }
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

/// `examples/port` keeps what the command writes, but for the account, most of which is the page's own code.
#[test]
fn the_example_is_as_the_command_writes_it() {
    let folder = Folder::new(&[]);
    let example = root().join("examples/port");
    let [shaders, ported] = ["shaders", "ported"].map(|name| example.join(name).to_string_lossy().into_owned());
    let output = folder.run(&["port", &shaders, "--for", "wgpu", "-o", &ported, "--check"]);
    let printed = out(&output);
    let names: Vec<&str> = printed.lines().filter_map(|line| line.rsplit('/').next()).collect();
    assert_eq!(names, ["port.html", "port.json"], "{}", err(&output));
}

#[test]
fn a_geometry_stage_converts_the_depth_and_has_locations_of_its_own() {
    let folder = Folder::new(&[]);
    let output = port(&folder, "geometry", "vulkan", &["-o", "new"]);
    assert_eq!(code(&output), 0, "{}", err(&output));
    let text = |stage: &str| read(&folder, &format!("new/normals.{stage}"));
    let (vertex, geometry) = (text("vert"), text("geom"));
    has(&vertex, &["layout(location = 0) out Vertex {", "layout(location = 3) out float weight;", "void main()\n"]);
    assert!(!vertex.contains("gl_Position.z"), "{vertex}");
    has(
        &geometry,
        &[
            "layout(location = 0) in Vertex {",
            "layout(location = 3) in float weight[];",
            "layout(location = 0) out vec3 tint;",
            "// Vulkan's depth: [0, w] in clip space.\nvoid emitVulkanVertex()\n{\n    gl_Position.z = (gl_Position.z + gl_Position.w) * \
             0.5;\n    EmitVertex();\n}\n\n// One line.\nvoid line(int i)\n",
            "    emitVulkanVertex();\n    EndPrimitive();\n",
        ],
    );
    // glslang links the three stages.
    let mut command = Command::new("glslangValidator");
    command.args(["-V", "-l", "--target-env", "vulkan1.1"]);
    ["vert", "geom", "frag"].iter().for_each(|stage| {
        command.arg(folder.path(&format!("new/normals.{stage}")));
    });
    match command.current_dir(folder.path("new")).output() {
        Ok(output) => assert!(output.status.success(), "{}\n{geometry}", String::from_utf8_lossy(&output.stdout)),
        Err(_) => missing("glslangValidator", "Debian has it in the package glslang-tools"),
    }
    let again = port(&folder, "geometry", "vulkan", &["-o", "new", "--check"]);
    assert_eq!((code(&again), out(&again)), (0, String::new()), "{}", err(&again));
    // WebGPU has no geometry stages.
    let output = port(&folder, "geometry", "wgpu", &["-o", "other"]);
    assert_eq!(code(&output), 1);
    has(&err(&output), &["the host has no geometry stages"]);
}

/// Each stage gets a file without what conditions keep for the other, and is proved by the picture of the old file.
#[test]
fn a_file_with_several_stages_becomes_a_file_for_each() {
    let folder = Folder::new(&[]);
    let more = ["--engine", "libretro", "--prove", "-o", "out"];
    let output = port(&folder, "stages", "vulkan", &more);
    assert_eq!(code(&output), 1, "{}", err(&output));
    has(
        &err(&output),
        &[
            "`taken` stays as it was: `taken.vert` is there already, and its file has several stages",
            "3 programs: 2 ported, 0 unchanged, 0 for it already, 1 left as it was; 3 files change, 2 are copied; 2 proved",
        ],
    );
    let [vertex, fragment] = ["vert", "frag"].map(|stage| read(&folder, &format!("out/bloom.{stage}")));
    has(
        &vertex,
        &["\nvec4 COL0; // nobody reads it\n", "layout(location = 0) VARYING vec2 Coord;", "#define offset_ 0.25\n"],
    );
    has(
        &fragment,
        &[
            "layout(location = 0) out vec4 FragColor;",
            "#define FragColor gl_FragColor",
            "#ifndef PARAMETER_UNIFORM\n#define STRENGTH 0.5\n#endif\n",
            "// Half a texel to the right.",
        ],
    );
    assert!(!vertex.contains("FRAGMENT") && !fragment.contains("VERTEX"), "{vertex}{fragment}");
    assert!(!folder.path("out/bloom.glsl").exists() && folder.path("out/taken.glsl").exists());
    for stage in ["vert", "frag"] {
        let said = complaint(&folder.path(&format!("out/bloom.{stage}")), stage, &folder.path("out"));
        assert!(said.is_none(), "{said:?}");
    }
    let account: Value = serde_json::from_str(&read(&folder, "out/port.json")).expect("JSON");
    let bloom = &account["programs"][0];
    assert_eq!(bloom["files"], serde_json::json!(["bloom.glsl", "bloom.glsl"]));
    assert_eq!(bloom["new"], serde_json::json!(["bloom.vert", "bloom.frag"]));
    assert_eq!(bloom["proof"], "proved", "{account:#}");
    has(&err(&port(&folder, "stages", "vulkan", &more)), &["wrote 0 files"]);
    let output = port(&folder, "stages", "wgpu", &["--engine", "libretro", "-o", "wgpu"]);
    assert_eq!(code(&output), 1, "{}", err(&output));
    has(&read(&folder, "wgpu/shaders.rs"), &["pub mod bloom {"]);
}

/// A fragment shader of OpenGL ES alone is proved with a vertex shader that was made for it, in the new language, too.
#[test]
fn a_lone_stage_of_es_is_proved() {
    let shader = b"#version 100\nprecision highp float;\nvarying vec2 uv;\nuniform vec4 tint;\nvoid main() { gl_FragColor = vec4(uv, 0.5, 1.0) * tint; }\n";
    let folder = Folder::new(&[("in/a.frag", shader)]);
    let output = folder.run(&["port", "in", "--for", "vulkan", "--prove", "-o", "out"]);
    let said = err(&output);
    assert_eq!(code(&output), 0, "{said}");
    // `gl_FragColor` is `mediump`, which some drivers compute with fewer bits; Vulkan's picture is judged in any case.
    assert!(said.contains("1 proved") || said.contains("OpenGL ES computes `mediump`"), "{said}");
    has(&said, &["the reference draws the same bytes", "100 % of them judged, 0 outside\n", " 0 failed"]);
}

/// The stage that is made for a lone one has the locations of the new text.
#[test]
fn a_lone_stage_of_opengl_is_proved() {
    let shader =
        b"#version 150\nin vec2 uv;\nuniform vec4 tint;\nout vec4 c;\nvoid main() { c = vec4(uv, 0.5, 1.0) * tint; }\n";
    let folder = Folder::new(&[("in/a.frag", shader)]);
    let output = folder.run(&["port", "in", "--for", "vulkan", "--prove", "-o", "out"]);
    assert_eq!(code(&output), 0, "{}", err(&output));
    has(&err(&output), &["1 proved", " 0 failed"]);
}

/// Mesa's OpenGL clips by distances that are not enabled: both scenes enable what the original writes.
#[test]
fn clip_distances_cut_both_pictures() {
    let vertex = "#version 150\nuniform mat4 MVP;\nin vec3 Position;\nin vec2 Texcoord;\nout vec2 uv;\nout float gl_ClipDistance[1];\n\
                  void main() {\n    uv = Texcoord;\n    gl_Position = MVP * vec4(Position, 1.0);\n    gl_ClipDistance[0] = Texcoord.x - 0.3;\n}\n";
    let fragment = "#version 150\nin vec2 uv;\nout vec4 c;\nvoid main() {\n    c = vec4(uv, 0.0, 1.0);\n}\n";
    let folder = Folder::new(&[("clipped/a.vert", vertex.as_bytes()), ("clipped/a.frag", fragment.as_bytes())]);
    let output = folder.run(&["port", "clipped", "--for", "vulkan", "--prove", "-o", "out"]);
    assert_eq!(code(&output), 0, "{}", err(&output));
    assert!(err(&output).contains("a: proved: "), "{}", err(&output));
}
