//! GLSL for Vulkan: glslang takes it by Vulkan's rules, and the GPU draws with it what it draws with glisten's own code.
//!
//! The judge is `glslangValidator`. If it is missing, the test says so; if `CI` is set, it fails.

use crate::cli::{Folder, code, err, out};
use crate::emit::{fixtures, missing};
use crate::support::{compile_files, compiler, root};
use glisten_emit::{Conventions, Emitted, GlslVersion, SpirvEnv, Target, WindowOrigin, emit, reflect};
use glisten_front::Source;
use glisten_front::hir::Stage;
use glisten_front::link::Program;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

fn conventions() -> Conventions {
    Conventions { glsl_version: GlslVersion::Vulkan, ..Conventions::default() }
}

fn short(stage: Stage) -> &'static str {
    match stage {
        Stage::Vertex => "vert",
        Stage::Geometry => "geom",
        Stage::Fragment => "frag",
    }
}

/// The texts of a program; none if Vulkan lacks something, which has a help then.
fn texts(name: &str, program: &Program, conventions: &Conventions) -> Option<Vec<(Stage, String)>> {
    let mut all = Vec::new();
    for shader in program.stages.iter().filter(|shader| shader.main.is_some()) {
        match emit(program, shader.stage, Target::Glsl, conventions) {
            Ok(Emitted::Text(text)) => all.push((shader.stage, text)),
            Ok(Emitted::Words(_)) => panic!("{name}: words instead of text"),
            Err(errors) => {
                let is_told = |error: &glisten_front::Diagnostic| error.code.id == "E0802" && error.help.is_some();
                assert!(errors.iter().all(is_told), "{name}: {errors:?}");
                return None;
            }
        }
    }
    Some(all)
}

/// The complaint of glslang about a program by Vulkan's rules, all stages together; none if it takes it, or is missing.
pub(crate) fn complaint(folder: &Path, texts: &[(Stage, String)]) -> Option<String> {
    let path = |stage: Stage| folder.join(format!("a.{}", short(stage)));
    for (stage, text) in texts {
        fs::write(path(*stage), text).expect("the temporary folder can be written to");
    }
    let mut command = Command::new("glslangValidator");
    command.arg(format!("-I{}", folder.display()));
    command.args(["-l", "-V", "--target-env", "vulkan1.1"]).args(texts.iter().map(|(stage, _)| path(*stage)));
    let Ok(output) = command.current_dir(folder).output() else {
        missing("glslangValidator", "Debian has it in the package glslang-tools");
        return None;
    };
    (!output.status.success()).then(|| String::from_utf8_lossy(&output.stdout).into_owned())
}

#[test]
fn glslang_takes_it_by_the_rules_of_vulkan() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let folders = ["programs", "lower", "valid"];
    let files = || folders.iter().flat_map(|folder| fixtures(folder).into_values());
    let origins = [(WindowOrigin::UpperLeft, SpirvEnv::Webgpu), (WindowOrigin::LowerLeft, SpirvEnv::Vulkan)];
    let (mut taken, mut wrong, mut refused) = (0, Vec::new(), Vec::new());
    for (window_origin, spirv_env) in origins {
        let conventions = Conventions { window_origin, spirv_env, ..conventions() };
        // The flags change coordinates alone, so fewer programs will do the second time.
        let least = if spirv_env == SpirvEnv::Vulkan { "programs" } else { "" };
        for files in files().filter(|files| files.iter().all(|file| file.display().to_string().contains(least))) {
            let name = files.first().map(|file| file.display().to_string()).unwrap_or_default();
            let Some(program) = compile_files(&files).program else { continue };
            let Some(texts) = texts(&name, &program, &conventions) else {
                refused.push(name);
                continue;
            };
            match complaint(folder.path(), &texts) {
                None => taken += 1,
                Some(said) => wrong.push(format!("{name}: {said}\n{texts:#?}")),
            }
        }
    }
    assert!(wrong.is_empty(), "{} of {}: {}", wrong.len(), taken + wrong.len(), wrong.join("\n\n"));
    assert!(taken > 50 && refused.len() * 8 < taken, "{taken} taken, refused: {refused:?}");
}

fn pair(vertex: &str, fragment: &str) -> Program {
    let sources = [("a.vert", vertex, Stage::Vertex), ("a.frag", fragment, Stage::Fragment)]
        .map(|(name, text, stage)| Source { name: name.into(), text: format!("#version 150\n{text}").into(), stage });
    let compilation = compiler().compile(&sources);
    let messages: Vec<&str> = compilation.diagnostics.iter().map(|found| found.message.as_str()).collect();
    compilation.program.unwrap_or_else(|| panic!("{messages:?}"))
}

/// The texts of a program that glslang takes.
fn taken(vertex: &str, fragment: &str) -> [String; 2] {
    let program = pair(vertex, fragment);
    let texts = texts("pair", &program, &conventions()).expect("Vulkan has it");
    let folder = tempfile::tempdir().expect("a temporary folder");
    let said = complaint(folder.path(), &texts);
    assert!(said.is_none(), "{said:?}\n{texts:#?}");
    let mut texts = texts.into_iter().map(|(_, text)| text);
    [texts.next().unwrap_or_default(), texts.next().unwrap_or_default()]
}

#[track_caller]
fn has(text: &str, parts: &[&str]) {
    for part in parts {
        assert!(text.contains(part), "no `{part}` in:\n{text}");
    }
}

#[test]
fn loose_uniforms_are_members_of_one_block() {
    let [vertex, fragment] = taken(
        "in vec4 p; uniform mat4 mvp; uniform float time = 2.0; out vec2 uv;\n         void main() { uv = p.xy * time; gl_Position = mvp * p; }",
        "in vec2 uv; uniform vec3 tint; uniform float time; out vec4 c;\n         void main() { c = vec4(tint, uv.x + time) + gl_FragCoord.y; }",
    );
    for text in [&vertex, &fragment] {
        has(
            text,
            &[
                "layout(std140, set = 0, binding = 0) uniform Uniforms {",
                "    layout(offset = 0) mat4 mvp;",
                "    layout(offset = 64) float time;",
                "    layout(offset = 80) vec3 tint;",
                "    layout(offset = 92) float framebufferHeight;",
            ],
        );
        assert!(!text.contains("2.0;"), "{text}");
    }
    has(&vertex, &["gl_Position = mvp * p;", "layout(location = 0) out vec2 uv;", "openglMain();"]);
    has(&fragment, &["layout(location = 0) in vec2 uv;", "framebufferHeight - gl_FragCoord.y"]);
}

#[test]
fn names_that_mean_something_else_in_the_other_stage() {
    let [vertex, fragment] = taken(
        "in vec4 p; uniform vec4 color; uniform float distance; uniform float k; out float d;\n\
         void main() { d = distance * k; gl_Position = p + color; }",
        "in float d; uniform float k; out vec4 color; void main() { color = vec4(k * distance(vec2(d), vec2(1.0))); }",
    );
    has(&vertex, &["uniform Uniforms {", "vec4 color;", "float distance_;", "layout(offset = 20) float k;"]);
    has(
        &fragment,
        &["uniform FragmentUniforms {\n    layout(offset = 20) float k;\n} uniforms;", "uniforms.k * distance"],
    );
}

/// The interface packs parts of variables next to each other; a whole variable has one location.
#[test]
fn varyings_that_are_packed_have_locations_as_wholes() {
    let shared = |way: &str| format!("{way} S s; {way} vec3 q[2]; {way} mat3 m; {way} float f[3]; {way} vec4 pad[7];");
    let [vertex, fragment] = taken(
        &format!(
            "struct S {{ float a; float b; float c; float d; }}; in vec4 p; {}\n\
             void main() {{ gl_Position = p; s = S(1.0, 2.0, 3.0, 4.0); q[0] = q[1] = p.xyz; m = mat3(1.0); f[0] = f[1] = f[2] = 1.0;\n\
             for (int i = 0; i < 7; i++) pad[i] = p; }}",
            shared("out")
        ),
        &format!(
            "struct S {{ float a; float b; float c; float d; }}; {} out vec4 o;\n\
             void main() {{ o = vec4(s.a, s.b, s.c, s.d) + q[0].x + q[1].y + m[2].z + f[1] + pad[6]; }}",
            shared("in")
        ),
    );
    // Both stages have the same.
    let places = |text: &str, way: &str| {
        let lines =
            text.lines().filter(|line| line.starts_with("layout(location") && line.contains(&format!(") {way} ")));
        let mut places: Vec<String> = lines.map(|line| line.replace(&format!(") {way} "), ") ")).collect();
        places.retain(|line| !line.contains("vec4 p;") && !line.contains("vec4 o;"));
        places.sort();
        places
    };
    assert_eq!(places(&vertex, "out"), places(&fragment, "in"), "{vertex}\n{fragment}");
    assert_eq!(places(&vertex, "out").len(), 5, "{vertex}");
}

#[test]
fn functions_that_glslang_knows_get_other_names() {
    let [vertex, fragment] = taken(
        "in vec4 p; uniform float k; float sin(float a) { return a; } void main() { gl_Position = p * sin(k); }",
        "uniform float k; out vec4 color; float max3(float a, float b) { return a + b; }\n\
         void main() { color = vec4(max3(1.0, 2.0)); }",
    );
    has(&vertex, &["float k;", "sin_(k)"]);
    has(&fragment, &["max3_(1.0, 2.0)"]);
    assert!(!fragment.contains("uniform"), "nothing of the block is used: {fragment}");
}

#[test]
fn samplers_of_structs_are_variables() {
    let [_, fragment] = taken(
        "in vec4 p; out vec2 uv; void main() { uv = p.xy; gl_Position = p; }",
        "struct Map { sampler2D map; float scale; }; struct Light { vec3 color; Map shadow; sampler2D beam[2]; };\n         struct Only { sampler2D s; };\n         in vec2 uv; uniform Light light[3]; uniform Only only; out vec4 c;\n         vec4 look(sampler2D s, float k) { return texture(s, uv * k); }\n         void main() { c = look(light[1].shadow.map, light[0].shadow.scale) + texture(only.s, uv);\n         c += texture(light[2].beam[1], uv) * vec4(light[2].color, 1.0); }",
    );
    has(
        &fragment,
        &[
            "uniform sampler2D[3] light_shadow_map;",
            "uniform sampler2D only_s;",
            "light_beam[2][1]",
            "light[0].shadow.scale",
        ],
    );
}

#[test]
fn what_vulkan_lacks_has_a_way_out() {
    let rows = [
        ("uniform sampler2DRect s; out vec4 c; void main() { c = texture(s, vec2(0.5)); }", "rectangle"),
        (
            "struct M { sampler2D s; float k; }; uniform M m; out vec4 c;\n             vec4 f(M m) { return texture(m.s, vec2(m.k)); } void main() { c = f(m); }",
            "as a whole",
        ),
    ];
    for (body, what) in rows {
        let text = format!("#version 150\n{body}");
        let source = Source { name: "a.frag".into(), text: text.into(), stage: Stage::Fragment };
        let program = compiler().compile(&[source]).program.expect("it compiles");
        let errors = emit(&program, Stage::Fragment, Target::Glsl, &conventions()).expect_err(body);
        assert!(errors.iter().any(|error| error.message.contains(what)), "{errors:?}");
        assert!(errors.iter().all(|error| error.help.is_some()), "{errors:?}");
    }
}

#[test]
fn the_reflection_names_the_version() {
    let program =
        pair("in vec4 p; void main() { gl_Position = p; }", "out vec4 sampler; void main() { sampler = vec4(1.0); }");
    let glsl = reflect(&program, &conventions()).targets.glsl;
    assert_eq!(glsl.version, "vulkan");
    assert_eq!(glsl.renamed.get("sampler").map(String::as_str), Some("sampler_"));
}

/// Sources that are rewritten, and stay what people wrote.
#[test]
fn sources_are_rewritten_and_glslang_takes_them() {
    let folder = Folder::new(&[]);
    let (mut taken, mut refused, mut wrong) = (0, Vec::new(), Vec::new());
    let programs = ["programs", "upgrade", "lower", "valid"].iter().flat_map(|folder| fixtures(folder).into_values());
    for files in programs {
        let names: Vec<String> = files.iter().map(|file| file.display().to_string()).collect();
        // Texts that glslang does not read as OpenGL's either.
        let is_odd = |name: &String| ["/valid/preprocess/", "/valid/syntax/"].iter().any(|part| name.contains(part));
        if names.iter().any(is_odd) {
            continue;
        }
        let mut arguments: Vec<&str> = vec!["upgrade", "-q", "--to", "vulkan", "-o", "new"];
        arguments.extend(names.iter().map(String::as_str));
        let output = folder.run(&arguments);
        if code(&output) != 0 {
            refused.push(format!("{names:?}: {}", err(&output).lines().next().unwrap_or_default()));
            continue;
        }
        let texts: Vec<(Stage, String)> = files
            .iter()
            .map(|file| {
                let stage = crate::support::stage_of(file).expect("a shader");
                let name = file.file_name().expect("a file").to_string_lossy().into_owned();
                (stage, fs::read_to_string(folder.path(&format!("new/{name}"))).expect("written"))
            })
            .collect();
        for (file, (_, text)) in files.iter().zip(&texts) {
            let old = fs::read_to_string(file).expect("readable");
            for comment in old.lines().filter_map(|line| Some(line[line.find("//")?..].trim())) {
                assert!(text.contains(comment), "{comment} is not in {text}");
            }
        }
        match complaint(&folder.path("new"), &texts) {
            None => taken += 1,
            Some(said) => wrong.push(format!("{names:?}: {said}\n{texts:#?}")),
        }
    }
    assert!(wrong.is_empty(), "{} of {}: {}", wrong.len(), taken + wrong.len(), wrong.join("\n\n"));
    assert!(taken > 35 && refused.len() < taken, "{taken} taken, refused: {refused:#?}");
}

/// The new text of a fragment shader, which glslang takes.
fn rewritten(source: &str) -> String {
    rewritten_stage(source, Stage::Fragment)
}

/// The new text of a shader, which glslang takes.
#[track_caller]
pub(crate) fn rewritten_stage(source: &str, stage: Stage) -> String {
    let name = format!("a.{}", short(stage));
    let folder = Folder::new(&[(&name, source.as_bytes())]);
    let output = folder.run(&["upgrade", "-q", "--to", "vulkan", "-o", "new", &name]);
    assert_eq!(code(&output), 0, "{}", err(&output));
    let text = fs::read_to_string(folder.path(&format!("new/{name}"))).expect("written");
    let said = complaint(&folder.path("new"), &[(stage, text.clone())]);
    assert!(said.is_none(), "{said:?}\n{text}");
    text
}

#[test]
fn a_uniform_may_follow_its_struct_on_a_line() {
    let text = rewritten(
        "#version 150\nin vec4 v; struct L { vec4 d; }; uniform L l; out vec4 c; void main() { c = v + l.d; }\n",
    );
    has(&text, &["struct L { vec4 d; };", "L l;\n};", "void main() { c = v + l.d; }"]);
    has(
        &rewritten(
            "#version 150\nstruct L {\n    vec4 d;\n}; uniform L l[2];\nout vec4 c;\nvoid main() { c = l[0].d; }\n",
        ),
        &["L l[2];\n};"],
    );
}

/// No blank follows the comma, and none the words that come in its place.
#[test]
fn declarations_of_several_names_become_several() {
    let text = rewritten(
        "#version 150\nin vec4 a,b;\nuniform sampler2D s,t;\nout vec4 c;\n\
         void main() { c = a * texture(s, b.xy) * texture(t, b.zw); }\n",
    );
    has(
        &text,
        &["in vec4 a; layout(location = 1) in vec4 b;\n", "uniform sampler2D s; layout(", ") uniform sampler2D t;\n"],
    );
}

#[test]
fn centers_of_pixels_at_integers_become_vulkans() {
    let source = |layout: &str| {
        format!(
            "#version 150\n#extension GL_ARB_fragment_coord_conventions : require\nlayout({layout}) in vec4 gl_FragCoord;\n\
             out vec4 c;\nvoid main() {{ c = gl_FragCoord; }}\n"
        )
    };
    let text = rewritten(&source("pixel_center_integer"));
    has(
        &text,
        &["vec4(gl_FragCoord.x - 0.5, framebufferHeight - gl_FragCoord.y - 0.5, gl_FragCoord.zw)", "c = fragCoord;"],
    );
    assert!(!text.contains("pixel_center_integer"), "{text}");
    let folder = Folder::new(&[("a.frag", source("origin_upper_left, pixel_center_integer").as_bytes())]);
    let output = folder.run(&["upgrade", "a.frag", "--to", "vulkan"]);
    assert_eq!(code(&output), 1);
    has(&err(&output), &["`pixel_center_integer`", "subtract 0.5"]);
}

#[test]
fn members_of_varying_blocks_keep_their_locations() {
    let source = |direction: &str, body: &str| {
        format!(
            "#version 440\nlayout(location = 1) {direction} B {{ vec2 a; layout(location = 4) flat int k; vec3 n; }} b;\n{body}"
        )
    };
    let vertex = source("out", "in vec4 p; void main() { gl_Position = p; b.a = p.xy; b.k = 3; b.n = p.xyz; }");
    let fragment = source("in", "out vec4 c; void main() { c = vec4(b.a, b.n.xy) + float(b.k); }");
    let sources = [("a.vert", vertex, Stage::Vertex), ("a.frag", fragment, Stage::Fragment)]
        .map(|(name, text, stage)| Source { name: name.into(), text: text.into(), stage });
    let program = compiler().compile(&sources).program.expect("it compiles");
    let texts = texts("block", &program, &conventions()).expect("Vulkan has it");
    let folder = tempfile::tempdir().expect("a temporary folder");
    let said = complaint(folder.path(), &texts);
    assert!(said.is_none(), "{said:?}\n{texts:#?}");
    texts.iter().for_each(|(_, text)| has(text, &["layout(location = 1)", "layout(location = 4) flat int k;"]));
}

#[test]
fn a_rewritten_source_is_the_same_source() {
    let vertex = "#version 150\nin vec4 p, q; // data\n// The camera.\nuniform mat4 mvp, normals;  // two of them\n\
                  struct Light { vec4 color; };\n#define COUNT 2\nuniform Light light[COUNT];\nflat out vec4 tint;\nout vec4 unread;\n\
                  void main()\n{\n    unread = tint = light[1].color * float(gl_VertexID); // keep\n    gl_Position = mvp * (p + normals * q);\n}\n";
    let fragment = "#version 150\nuniform sampler2D a, b;\nlayout(row_major) uniform Block { mat4 m; } block;\nflat in vec4 tint;\n\
                    out vec4 color;\nvoid main() { color = tint + texture(a, gl_FragCoord.xy) * 1.0-dFdy(texture(b, tint.xy)) + block.m[0]; }\n";
    let folder = Folder::new(&[("a.vert", vertex.as_bytes()), ("a.frag", fragment.as_bytes())]);
    let output = folder.run(&["upgrade", "a.vert", "a.frag", "--to", "vulkan", "-o", "new"]);
    assert_eq!(code(&output), 0, "{}", err(&output));
    let read = |name: &str| fs::read_to_string(folder.path(&format!("new/{name}"))).expect("written");
    let (vertex, fragment) = (read("a.vert"), read("a.frag"));
    has(
        &vertex,
        &[
            "#version 450\n",
            "    // The camera.\n    layout(offset = 0) mat4 mvp;  // two of them\n    layout(offset = 64) mat4 normals;\n",
            "    layout(offset = 128) Light light[COUNT];\n",
            "layout(location = 0) in vec4 p; layout(location = 1) in vec4 q; // data",
            "struct Light { vec4 color; };\n#define COUNT 2\n",
            "layout(location = 0) flat out vec4 tint;\nvec4 unread;\n",
            "void openglMain()\n{\n    unread = tint = light[1].color * float(gl_VertexIndex); // keep\n",
        ],
    );
    has(
        &fragment,
        &[
            "layout(set = 1, binding = 0) uniform sampler2D a; layout(set = 1, binding = 2) uniform sampler2D b;",
            "layout(std140, set = 0, binding = 1, row_major) uniform Block { mat4 m; } block;",
            "vec4 fragCoord = vec4(gl_FragCoord.x, framebufferHeight - gl_FragCoord.y, gl_FragCoord.zw);",
            "texture(a, fragCoord.xy) * 1.0-(-dFdy(texture(b, tint.xy)))",
        ],
    );
    let said = complaint(&folder.path("new"), &[(Stage::Vertex, vertex), (Stage::Fragment, fragment)]);
    assert!(said.is_none(), "{said:?}");
}

/// Scenes whose programs have no textures, which WebGPU does not combine with samplers.
const SCENES: &[&str] = &[
    "phong",
    "blinn_phong_vertex",
    "flat",
    "noperspective",
    "core/derivatives",
    "core/clip_distances",
    "core/places",
    "core/places_upper_left",
    "core/instances",
    "core/lower_matrices",
];

/// The path of a file that a scene names.
fn named(scene: &Path, key: &str) -> PathBuf {
    let text = fs::read_to_string(scene).expect("the scene is there");
    let line = text.lines().find(|line| line.starts_with(key)).unwrap_or_else(|| panic!("{}: {key}", scene.display()));
    scene.with_file_name(line.split('"').nth(1).expect("a name in quotes"))
}

#[test]
fn the_gpu_draws_the_same_with_it() {
    let folder = Folder::new(&[]);
    for scene in SCENES {
        let scene = root().join(format!("fixtures/scenes/{scene}.toml"));
        let sources = [named(&scene, "vertex = "), named(&scene, "fragment = ")].map(|path| path.display().to_string());
        let [vertex, fragment] = &sources;
        let compiled = folder.run(&[
            "compile",
            "--program",
            &format!("{vertex},{fragment}"),
            "--target",
            "glsl",
            "--glsl-version",
            "vulkan",
            "-o",
            "out",
        ]);
        assert_eq!(code(&compiled), 0, "{vertex}: {}", err(&compiled));
        let mut with = Vec::new();
        for (source, stage) in sources.iter().zip(["vertex", "fragment"]) {
            let name = Path::new(source).file_name().expect("a file").to_string_lossy();
            let module = folder.path(&format!("out/{name}.spv"));
            let mut command = Command::new("glslangValidator");
            command
                .args(["-V", "--target-env", "vulkan1.1", "-S", if stage == "vertex" { "vert" } else { "frag" }, "-o"])
                .arg(&module);
            let Ok(output) = command.arg(folder.path(&format!("out/{name}.glsl"))).output() else {
                missing("glslangValidator", "Debian has it in the package glslang-tools");
                return;
            };
            assert!(output.status.success(), "{source}: {}", String::from_utf8_lossy(&output.stdout));
            with.extend(["--with".to_owned(), format!("{stage}={}", module.display())]);
        }
        let scene = scene.display().to_string();
        let mut arguments = vec!["verify", &scene];
        arguments.extend(with.iter().map(String::as_str));
        let judged = folder.run(&arguments);
        assert_eq!(code(&judged), 0, "{scene}: {}{}", out(&judged), err(&judged));
    }
}
