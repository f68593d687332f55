//! `glisten_build`: what it writes compiles without warnings, puts every value where the reflection says, and is not written
//! again without need; what it refuses.

use crate::support::{files_under, root, stage_of};
use glisten::Stage;
use glisten::build::{Build, BuildError};
use glisten::emit::Target;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Runs rustc on a text that contains the module, and gives the program's output if there is one.
fn rustc(folder: &Path, text: &str, kind: &str) -> String {
    let source = folder.join("host.rs");
    fs::write(&source, text).expect("the folder can be written to");
    let mut command = Command::new(std::env::var_os("RUSTC").unwrap_or("rustc".into()));
    command.args(["--edition", "2024", "-D", "warnings", "--crate-type", kind, "--out-dir"]).arg(folder).arg(&source);
    let run = command.output().expect("rustc is there, since Cargo runs this");
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    if kind != "bin" {
        return String::new();
    }
    let run = Command::new(folder.join("host")).output().expect("the host runs");
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    String::from_utf8_lossy(&run.stdout).into_owned()
}

/// Lints that a crate may deny besides all warnings.
const STRICT: [&str; 12] = [
    "elided-lifetimes-in-paths",
    "missing-copy-implementations",
    "missing-debug-implementations",
    "missing-docs",
    "single-use-lifetimes",
    "trivial-numeric-casts",
    "unit-bindings",
    "unnameable-types",
    "unreachable-pub",
    "unsafe-code",
    "unused-qualifications",
    "unused-results",
];

/// Checks a module with all features in a crate that denies every lint. The crates that it needs are those of this test.
fn check_strictly(folder: &Path, text: &str) {
    let source = folder.join("host.rs");
    fs::write(&source, format!("//! Shaders.\n{text}")).expect("the folder can be written to");
    let dependencies = std::env::current_exe().expect("a test has a file").parent().expect("a folder").to_owned();
    let mut command = Command::new(std::env::var_os("RUSTC").unwrap_or("rustc".into()));
    command.args(["--edition", "2024", "--crate-type", "lib", "--emit", "metadata", "-D", "warnings"]);
    command.args(STRICT.iter().flat_map(|lint| ["-D", lint]));
    command.arg("-L").arg(format!("dependency={}", dependencies.display()));
    command.arg("--extern").arg(format!("bytemuck={}", bytemuck_with_derive(&dependencies).display()));
    for name in ["glam", "wgpu"] {
        command.arg("--extern").arg(format!("{name}={}", newest(&dependencies, name).display()));
    }
    let run =
        command.arg("--out-dir").arg(folder).arg(&source).output().expect("rustc is there, since Cargo runs this");
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
}

/// The library of a crate that was built last.
pub(crate) fn newest(folder: &Path, name: &str) -> PathBuf {
    let prefix = format!("lib{name}-");
    let paths = fs::read_dir(folder).expect("a folder").filter_map(Result::ok).map(|entry| entry.path());
    let is_one = |path: &PathBuf| {
        let own = path.file_name().unwrap_or_default().to_string_lossy();
        own.starts_with(&prefix) && own.ends_with(".rlib")
    };
    let built = |path: &PathBuf| fs::metadata(path).and_then(|found| found.modified()).ok();
    paths.filter(is_one).max_by_key(built).unwrap_or_else(|| panic!("{name} is built for the tests"))
}

/// A `bytemuck` of a folder whose feature `derive` is on: another build of the workspace may have left one without it.
fn bytemuck_with_derive(folder: &Path) -> PathBuf {
    static DERIVES: &str =
        "#[repr(C)]\n#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]\npub struct One(pub u32);\n";
    let probe = tempfile::tempdir().expect("a folder");
    let source = probe.path().join("probe.rs");
    fs::write(&source, DERIVES).expect("the folder can be written to");
    let entries = fs::read_dir(folder).expect("a folder").filter_map(Result::ok).map(|entry| entry.path());
    let is_one = |path: &PathBuf| {
        let own = path.file_name().unwrap_or_default().to_string_lossy();
        own.starts_with("libbytemuck-") && own.ends_with(".rlib")
    };
    let derives = |path: &PathBuf| {
        let mut command = Command::new(std::env::var_os("RUSTC").unwrap_or("rustc".into()));
        command.args(["--edition", "2024", "--crate-type", "lib", "--emit", "metadata", "--out-dir"]).arg(probe.path());
        command.arg("-L").arg(format!("dependency={}", folder.display()));
        command.arg("--extern").arg(format!("bytemuck={}", path.display())).arg(&source);
        command.output().is_ok_and(|run| run.status.success())
    };
    let found = entries.filter(is_one).find(derives);
    found.unwrap_or_else(|| panic!("bytemuck with `derive` is built for the tests"))
}

#[test]
fn odd_programs_are_modules_without_warnings() {
    let folder = tempfile::tempdir().expect("a folder");
    let write = |name: &str, text: &str| {
        let path = folder.path().join(name);
        fs::write(&path, format!("#version 330\n{text}")).expect("the folder can be written to");
        path
    };
    let mut build = Build::new().bytemuck().glam().wgpu().instanced("Self");
    let color = "out vec4 c;\nvoid main() { c = vec4(1.0); }\n";
    let mut add = |name: &str, vertex: &str, fragment: &str| {
        let files = [write(&format!("{name}.vert"), vertex), write(&format!("{name}.frag"), fragment)];
        build = build.clone().named_program(name, &files[0], &files[1]);
    };
    add("nothing", "void main() { gl_Position = vec4(gl_VertexID); }\n", color);
    add(
        "attributes",
        "in float self; in float Self; in float selF; in float x1; in float x_1; in float X1; in float fn;\n\
         void main() { gl_Position = vec4(self + Self + selF, x1 + x_1, X1, fn); }\n",
        color,
    );
    add(
        "samplers",
        "void main() { gl_Position = vec4(0.0); }\n",
        "uniform sampler2D source[3]; uniform sampler2D source_0_; uniform sampler2D Source_sampler; uniform sampler2D source_;\n\
         uniform sampler2DShadow shadow[2]; uniform isampler2D Self; out vec4 c;\n\
         void main() { c = texture(source[0], vec2(0.5)) + texture(source[1], vec2(0.5)) + texture(source_0_, vec2(0.5)) \
         + texture(Source_sampler, vec2(0.5)) + texture(source_, vec2(0.5)) \
         + texture(shadow[1], vec3(0.5)) + vec4(texture(Self, vec2(0.5))); }\n",
    );
    add(
        "uniforms",
        "uniform float value; uniform float value_; uniform float _value; uniform float VALUE; uniform float padding_28;\n\
         uniform float type; uniform float Type; uniform vec3 wide; uniform mat3 turns[2]; uniform bool on[2];\n\
         void main() { gl_Position = vec4(value + value_ + _value, VALUE + padding_28, type + Type, wide.x + turns[1][2].x \
         + float(on[1])); }\n",
        "struct Option { vec4 x; };\nuniform Option one;\nuniform self { vec4 a; }; uniform Self { vec4 b; }; uniform vec_ { vec4 d; };\n\
         uniform Vec { vec4 e; }; uniform Default { vec4 f; }; uniform light { vec4 g; }; uniform Light { vec4 h; };\n\
         uniform Light2 { vec4 i; }; uniform PipelineState { vec4 j; }; uniform uniforms { vec4 k; };\n\
         out vec4 c;\nvoid main() { c = a + b + d + e + f + g + h + i + j + k + one.x; }\n",
    );
    let text = build.text().unwrap_or_else(|error| panic!("{error}")).text;
    check_strictly(folder.path(), &text);
    for name in ["self_2", "source_0_sampler", "set_value_2", "pub struct Light2"] {
        assert!(text.contains(name), "{name} is not in {text}");
    }
    let [vertex, fragment] = ["vert", "frag"].map(|end| folder.path().join(format!("nothing.{end}")));
    let taken = Build::new().named_program("glisten_memory", vertex, fragment).text().expect_err("a name of its own");
    assert!(matches!(taken, BuildError::SameName(_)), "{taken}");
}

#[test]
fn modules_of_all_fixtures_compile_without_warnings() {
    let mut build = Build::new();
    let mut count = 0;
    for folder in ["programs", "build", "lower", "readme", "tutorial"] {
        for vertex in files_under(&root().join("fixtures").join(folder)) {
            let fragment = vertex.with_extension("frag");
            if stage_of(&vertex) == Some(Stage::Vertex) && fragment.is_file() {
                let single = Build::new().program(&vertex, &fragment);
                if single.text().is_ok() {
                    count += 1;
                    build = build.named_program(format!("program {count}"), vertex, fragment);
                }
            }
        }
    }
    assert!(count > 12, "only {count} programs");
    let text = build.text().expect("each of them builds").text;
    assert_eq!(text, build.text().expect("again").text, "the text is the same on every run");
    let folder = tempfile::tempdir().expect("a folder");
    rustc(folder.path(), &text, "lib");
    check_strictly(folder.path(), &build.bytemuck().glam().wgpu().text().expect("with all features").text);
}

const HOST: &str = r#"
mod shaders { include!("shaders.rs"); }
use shaders::everything as one;
use shaders::glisten_memory::Bytes;
fn main() {
    let mut loose = one::Uniforms::new();
    loose.set_normal_matrix([[1.0, 2.0, 3.0], [4.0, 5.0, 6.0], [7.0, 8.0, 9.0]]).set_eye([10.0, 11.0, 12.0]).set_time(13.0);
    loose.set_flags([[false, true], [true, false]]).set_cells([-1, 2, -3]);
    loose.lights[2].set_power(14.0).set_turn([[15.0, 16.0], [17.0, 18.0]]);
    loose.grid.set_type(19.0);
    let mut camera = one::Camera::default();
    camera.set_slanted([[1.0, 2.0], [3.0, 4.0], [5.0, 6.0]]).set_fn(7.0).set_is_flipped(true);
    camera.key.set_color([8.0, 9.0, 10.0]);
    let vertex = one::Vertex { position: [1.0; 3], color: [2.0; 4], ids: [3, 4], skew: [[5.0, 6.0], [7.0, 8.0]], self_: 9.0 };
    for bytes in [loose.to_bytes(), camera.to_bytes(), vertex.to_bytes(), one::Bones::new().to_bytes()] {
        println!("{}", bytes.iter().map(u8::to_string).collect::<Vec<_>>().join(" "));
    }
}
"#;

#[test]
fn values_are_where_the_reflection_says() {
    let folder = tempfile::tempdir().expect("a folder");
    let files = ["vert", "frag"].map(|extension| root().join(format!("fixtures/build/everything.{extension}")));
    let build = Build::new().program(&files[0], &files[1]).output_folder(folder.path());
    build.build().expect("it builds");
    let output = rustc(folder.path(), HOST, "bin");
    let buffers: Vec<Vec<u8>> =
        output.lines().map(|line| line.split(' ').filter_map(|byte| byte.parse().ok()).collect()).collect();
    let compilation = crate::support::compile_files(&files);
    let program = compilation.program.expect("it compiles");
    let reflection = glisten::emit::reflect(&program, &glisten::emit::Conventions::default());
    assert_eq!(buffers[0].len() as u32, reflection.loose_block.as_ref().map_or(0, |block| block.size));
    assert_eq!(buffers[1].len() as u32, reflection.blocks[0].size);
    assert_eq!(buffers[3].len() as u32, reflection.blocks[1].size);
    let word = |buffer: usize, name: &str, more: u32| {
        let leaf = reflection.uniforms.iter().find(|leaf| leaf.name == name);
        let at = (leaf.unwrap_or_else(|| panic!("no uniform `{name}`")).offset + more) as usize;
        buffers[buffer][at..at + 4].try_into().map(u32::from_le_bytes).expect("four bytes")
    };
    let number = |buffer, name: &str, more| f32::from_bits(word(buffer, name, more));
    // Values that setters set, columns of a matrix 16 bytes apart.
    assert_eq!([0, 4, 16, 40].map(|more| number(0, "normalMatrix", more)), [1.0, 2.0, 4.0, 9.0]);
    assert_eq!((number(0, "eye", 8), number(0, "time", 0)), (12.0, 13.0));
    assert_eq!([0, 4, 16].map(|more| word(0, "flags", more)), [0, 1, 1]);
    assert_eq!(word(0, "cells", 8), u32::from_le_bytes((-3i32).to_le_bytes()));
    assert_eq!((number(0, "lights[2].power", 0), number(0, "lights[2].turn", 20)), (14.0, 18.0));
    assert_eq!(number(0, "grid.type", 0), 19.0);
    // Initial values.
    assert_eq!([0, 16, 32].map(|more| number(0, "weights", more)), [0.25, 0.5, 0.25]);
    assert_eq!((word(0, "isOn", 0), number(0, "turns", 36), number(0, "turns", 48)), (1, 1.0, -1.0));
    // Rows of a matrix that is stored by rows.
    assert_eq!([0, 4, 16, 24].map(|more| number(1, "Camera.slanted", more)), [1.0, 3.0, 2.0, 6.0]);
    assert_eq!((number(1, "Camera.fn", 0), word(1, "Camera.isFlipped", 0)), (7.0, 1));
    assert_eq!(number(1, "Camera.key.color", 8), 10.0);
    assert_eq!(buffers[2].len(), 4 * (3 + 4 + 2 + 4 + 1));
}

#[test]
fn nothing_is_written_without_need() {
    let folder = tempfile::tempdir().expect("a folder");
    let shaders = folder.path().join("shaders");
    fs::create_dir_all(shaders.join("include")).expect("a folder");
    let write = |name: &str, text: &str| fs::write(shaders.join(name), text).expect("the folder can be written to");
    write("a.vert", "#version 150\nin vec4 p;\nvoid main() { gl_Position = p; }\n");
    write("a.frag", "#version 150\n#include \"tint.glsl\"\nout vec4 c;\nvoid main() { c = tint(vec4(1.0)); }\n");
    write("include/tint.glsl", "vec4 tint(vec4 c) { return c * 0.5; }\n");
    let build = Build::new().folder(&shaders).include(shaders.join("include")).output_folder(folder.path());
    let first = build.build().expect("it builds");
    let names: Vec<String> =
        first.read.iter().map(|path| path.file_name().unwrap_or_default().to_string_lossy().into()).collect();
    for name in ["shaders", "a.vert", "a.frag", "tint.glsl"] {
        assert!(names.iter().any(|known| known == name), "{name} is not among {names:?}");
    }
    let written = || fs::metadata(&first.module).and_then(|data| data.modified()).expect("the module is there");
    let before = written();
    build.build().expect("it builds again");
    assert_eq!(written(), before);
    assert_eq!(fs::read_dir(folder.path()).expect("the folder").count(), 2, "nothing else is left");
    write("include/tint.glsl", "vec4 tint(vec4 c) { return c * 0.25; }\n");
    assert!(build.build().expect("it builds").text.contains("0.25"));
    // One warning, in a line.
    assert_eq!(first.warnings.len(), 1);
    assert!(first.warnings[0].contains("a.frag:2:1: `#include` without"), "{:?}", first.warnings);
}

#[test]
fn mistakes_are_told_together() {
    let folder = tempfile::tempdir().expect("a folder");
    let write = |name: &str, text: &str| {
        let path = folder.path().join(name);
        fs::write(&path, text).expect("the folder can be written to");
        path
    };
    let good = write("good.vert", "#version 150\nvoid main() { gl_Position = vec4(0.0); }\n");
    let one = write("one.frag", "#version 150\nout vec4 c;\nvoid main() { c = vec3(1.0); }\n");
    let two = write("two.frag", "#version 150\nout vec4 c;\nvoid main() { c = missing; }\n");
    let error = Build::new().named_program("one", &good, &one).named_program("two", &good, &two).text();
    let error = error.expect_err("both have errors");
    assert_eq!(error.read().len(), 3);
    let told = error.to_string();
    assert!(
        told.contains("one.frag:3") && told.contains("two.frag:3") && told.contains("`missing` is not declared"),
        "{told}"
    );

    let lone = Build::new().folder(folder.path()).text().expect_err("three names are three programs");
    assert!(matches!(lone, BuildError::NoPartner(_)), "{lone}");
    let same = Build::new().program(&good, &one).program(&good, &two).text().expect_err("the same name");
    assert!(same.to_string().contains("the module `good`"), "{same}");
    let gone = Build::new().program(&good, folder.path().join("gone.frag")).text().expect_err("no such file");
    assert!(gone.to_string().contains("gone.frag"), "{gone}");
    fs::create_dir(folder.path().join("empty")).expect("a folder");
    let empty = Build::new().folder(folder.path().join("empty")).text().expect_err("no program");
    assert!(matches!(empty, BuildError::NoProgram(_)), "{empty}");
}

#[test]
fn scenes_give_their_programs_and_what_is_left_of_them() {
    let folder = root().join("fixtures/specialize/by_hand");
    let whole = Build::new().scene(folder.join("spot.toml")).text().expect("it builds");
    assert!(whole.text.contains("pub mod spot {") && whole.text.contains("light_count"), "{}", whole.text);
    for name in ["spot.toml", "uber.vert", "uber.frag"] {
        assert!(whole.read.iter().any(|path| path.ends_with(name)), "{name} is not among {:?}", whole.read);
    }
    let residual = Build::new().specialized_scene(folder.join("spot.toml")).text().expect("it builds");
    // The scene fixes the count of lights, and calls the matrices dynamic.
    assert!(!residual.text.contains("light_count") && residual.text.contains("model_view"), "{}", residual.text);
    assert!(residual.text.len() < whole.text.len() / 2, "{} of {}", residual.text.len(), whole.text.len());
    let both = Build::new().scene(folder.join("spot.toml")).specialized_scene(folder.join("spot.toml")).text();
    assert!(matches!(both, Err(BuildError::SameName(name)) if name == "spot"));
    let gone = Build::new().scene(folder.join("gone.toml")).text().expect_err("no such scene");
    assert!(gone.to_string().contains("gone.toml"), "{gone}");
    let host = tempfile::tempdir().expect("a folder");
    rustc(host.path(), &residual.text, "lib");
}

#[test]
fn fixed_uniforms_leave_no_trace() {
    let folder = tempfile::tempdir().expect("a folder");
    let write =
        |name: &str, text: &str| fs::write(folder.path().join(name), text).expect("the folder can be written to");
    write("a.vert", "#version 150\nin vec4 p;\nvoid main() { gl_Position = p; }\n");
    write(
        "a.frag",
        "#version 150\nuniform bool bright;\nuniform int count;\nuniform vec2 scale[2];\nuniform float time;\nout vec4 c;\n\
         void main() {\n    c = vec4(time, scale[1], 1.0);\n    if (bright) { c *= 2.0; }\n\
         for (int i = 0; i < count; i++) { c += 0.1; }\n}\n",
    );
    let build = || Build::new().folder(folder.path());
    assert!(build().text().expect("it builds").text.contains("set_count"));
    let fixed = build().fix("bright", [0.0]).fix("count", [0.0]).fix("scale", [1.0, 1.0, 0.25, 0.5]);
    let text = fixed.text().expect("it builds").text;
    assert!(text.contains("set_time") && text.contains("0.25"), "{text}");
    assert!(!text.contains("set_count") && !text.contains("bright") && !text.contains("set_scale"), "{text}");
    let few = build().fix("scale", [1.0]).text().expect_err("too few");
    assert!(few.to_string().contains("`scale` has 4 components"), "{few}");
    let unknown = build().fix("tme", [1.0]).text().expect_err("no such uniform");
    assert!(unknown.to_string().contains("did you mean `time`?"), "{unknown}");
}

#[test]
fn the_code_of_each_target_is_a_constant() {
    let program = root().join("fixtures/programs");
    let mut build = Build::new().program(program.join("phong.vert"), program.join("phong.frag")).without_spirv();
    for target in [Target::Msl, Target::Hlsl, Target::Glsl, Target::Glsl] {
        build = build.target(target);
    }
    let text = build.text().expect("it builds").text;
    let constants: Vec<&str> =
        text.lines().filter_map(|line| line.trim().strip_prefix("pub const FRAGMENT_")?.split(':').next()).collect();
    assert_eq!(constants, ["WGSL", "MSL", "HLSL", "GLSL"]);
}

#[test]
fn engines_complete_the_sources_of_a_build() {
    let engines = root().join("fixtures/engines");
    let text = |build: Build| build.text().map(|built| built.text);
    let pack = engines.join("minecraft/assets/minecraft/shaders/core");
    let portal = || Build::new().program(pack.join("portal.vsh"), pack.join("portal.fsh"));
    let built = portal().engine("minecraft").include(engines.join("minecraft/assets")).text().expect("it builds");
    assert!(built.read.iter().any(|path| path.ends_with("tint.glsl")), "{:?}", built.read);
    assert!(text(portal()).is_err(), "`#moj_import` is no directive of GLSL");
    let lines = engines.join("libretro/lines.glsl");
    let both = text(Build::new().program(&lines, &lines).engine("libretro")).expect("it builds");
    assert!(both.contains("pub mod lines {") && both.contains("FRAGMENT_WGSL"), "{both}");
    let several = tempfile::tempdir().expect("a folder");
    for file in ["several.glsl", "marked.shader"] {
        fs::copy(engines.join("combined").join(file), several.path().join(file)).expect("the file is there");
    }
    let all = text(Build::new().folder(several.path())).expect("it builds");
    for name in ["plain", "shaded", "marked"] {
        assert!(all.contains(&format!("pub mod {name} {{")), "{name} is not in {all}");
    }
    let unknown = text(portal().engine("minecaft")).expect_err("no such engine");
    assert!(unknown.to_string().contains("did you mean `minecraft`?"), "{unknown}");
}

#[test]
fn preludes_and_versions_complete_the_sources_of_a_build() {
    let folder = tempfile::tempdir().expect("a folder");
    let write =
        |name: &str, text: &str| fs::write(folder.path().join(name), text).expect("the folder can be written to");
    write("shaders_vs.glsl", "layout(location = 3) in vec4 p;\nvoid main() { gl_Position = SCALE * p; }\n");
    write("shaders_fs.glsl", "out vec4 c;\nvoid main() { c = vec4(SCALE); }\n");
    write("common.txt", "#define SCALE 0.5\n");
    let build = || Build::new().folder(folder.path()).prelude(folder.path().join("common.txt"));
    let built = build().assume_version("330").text().expect("it builds");
    assert!(built.text.contains("pub mod shaders {"), "{}", built.text);
    assert!(built.read.iter().any(|path| path.ends_with("common.txt")), "{:?}", built.read);
    assert!(build().text().is_err(), "without a version it is 1.10");
    let version = build().assume_version("33").text().expect_err("no such version");
    assert!(version.to_string().contains("`33` is no version"), "{version}");
    write("shaders_gs.glsl", "void main() {}\n");
    let geometry = build().assume_version("330").text().expect_err("a stage that WGSL does not have");
    assert!(matches!(geometry, BuildError::Geometry(_)), "{geometry}");
}
