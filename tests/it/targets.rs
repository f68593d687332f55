//! MSL, HLSL and GLSL over all fixtures that compile: real compilers of HLSL and GLSL accept the output, MSL has an index
//! for every resource, and the reflection says what is in the text.
//!
//! The judge of HLSL and GLSL is `glslangValidator`. If it is missing, the test says so; if `CI` is set, it fails.
//! OpenGL draws the GLSL in `opengl/emitted.rs`.

use crate::emit::{fixtures, missing};
use crate::support::{compile_files, compiler};
use glisten_emit::{Conventions, Emitted, GlslVersion, Reflection, Target, WindowOrigin, emit, reflect};
use glisten_front::Source;
use glisten_front::hir::Stage;
use glisten_front::link::Program;
use std::fs;
use std::path::PathBuf;
use std::process::Command;

/// The errors with which a target may reject a valid program.
const REFUSALS: [&str; 2] = ["E0801", "E0802"];

/// All programs of the fixtures that compile, with the names of their files.
fn programs() -> Vec<(String, Program)> {
    let folders = ["programs", "lower", "valid"];
    let files = folders.iter().flat_map(|folder| fixtures(folder).into_values());
    let program = |files: Vec<PathBuf>| {
        let name = files.first()?.with_extension("").display().to_string();
        Some((name, compile_files(&files).program?))
    };
    let programs: Vec<(String, Program)> = files.filter_map(program).collect();
    assert!(programs.len() > 40, "only {} programs", programs.len());
    programs
}

/// The text of a stage; none if the target refuses it with a code.
fn text(name: &str, program: &Program, stage: Stage, target: Target, conventions: &Conventions) -> Option<String> {
    match emit(program, stage, target, conventions) {
        Ok(Emitted::Text(text)) => Some(text),
        Ok(Emitted::Words(_)) => panic!("{name}: words instead of text"),
        Err(errors) => {
            for error in &errors {
                assert!(REFUSALS.contains(&error.code.id), "{name} as {}: {}", target.name(), error.message);
                assert!(error.help.is_some() || error.code.id == "E0801", "{name}: {} has no help", error.message);
            }
            assert!(!errors.is_empty(), "{name}: refused without a word");
            None
        }
    }
}

/// All stages of all programs for a target.
fn emitted(target: Target, conventions: &Conventions) -> Vec<(String, Stage, String)> {
    let mut all = Vec::new();
    for (name, program) in programs() {
        for shader in program.stages.iter().filter(|shader| shader.main.is_some()) {
            let text = text(&name, &program, shader.stage, target, conventions);
            all.extend(text.map(|text| (name.clone(), shader.stage, text)));
        }
    }
    all
}

fn short(stage: Stage) -> &'static str {
    match stage {
        Stage::Vertex => "vert",
        Stage::Geometry => "geom",
        Stage::Fragment => "frag",
    }
}

/// Shows every text to glslang. Returns what it refuses; none if there is no glslang.
fn rejected(texts: &[(String, Stage, String)], extension: &str, flags: &[&str]) -> Option<Vec<String>> {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut wrong = Vec::new();
    for (index, (name, stage, text)) in texts.iter().enumerate() {
        let path = folder.path().join(format!("{index}.{extension}"));
        fs::write(&path, text).expect("the temporary folder can be written to");
        let mut command = Command::new("glslangValidator");
        command.args(flags).args(["-S", short(*stage)]).arg(&path).current_dir(folder.path());
        let Ok(output) = command.output() else {
            missing("glslangValidator", "Debian has it in the package glslang-tools");
            return None;
        };
        if !output.status.success() {
            let said = String::from_utf8_lossy(&output.stdout);
            wrong.push(format!("{name}, {}: glslang says {said}\n{text}", stage.name()));
        }
    }
    Some(wrong)
}

/// Asserts that glslang accepts every text, and that there are enough of them.
fn validate(texts: &[(String, Stage, String)], extension: &str, flags: &[&str], least: usize) {
    assert!(texts.len() >= least, "only {} texts", texts.len());
    let wrong = rejected(texts, extension, flags).unwrap_or_default();
    assert!(wrong.is_empty(), "{} of {}: {}", wrong.len(), texts.len(), wrong.join("\n\n"));
}

const HLSL: &[&str] = &["-D", "-e", "main", "-V", "-o", "out.spv"];

#[test]
fn hlsl_is_accepted_by_a_compiler_of_hlsl() {
    for window_origin in [WindowOrigin::UpperLeft, WindowOrigin::LowerLeft] {
        let conventions = Conventions { window_origin, ..Conventions::default() };
        let texts = emitted(Target::Hlsl, &conventions);
        for (name, _, text) in &texts {
            for word in ["nagaSamplerHeap", "SamplerIndexArray", "space255"] {
                assert!(!text.contains(word), "{name} needs a root signature of wgpu's: {text}");
            }
        }
        validate(&texts, "hlsl", HLSL, 60);
    }
}

#[test]
fn glsl_is_accepted_in_each_version() {
    for (glsl_version, least) in
        [(GlslVersion::Desktop330, 60), (GlslVersion::Desktop450, 60), (GlslVersion::Es300, 50)]
    {
        let conventions = Conventions { glsl_version, ..Conventions::default() };
        let texts = emitted(Target::Glsl, &conventions);
        validate(&texts, "glsl", &[], least);
    }
}

#[test]
fn glslang_refuses_what_is_wrong() {
    let wrong = |text: &str| [("wrong".to_owned(), Stage::Fragment, text.to_owned())];
    let counts = [
        rejected(&wrong("float4 main() : SV_Target { return nothing; }"), "hlsl", HLSL),
        rejected(&wrong("#version 330\nvoid main() { x = 1.0; }\n"), "glsl", &[]),
    ];
    assert!(counts.iter().flatten().all(|complaints| complaints.len() == 1), "{counts:?}");
}

/// The numbers of an attribute in MSL: `[[buffer(0)]]`.
fn numbers(text: &str, word: &str) -> Vec<u32> {
    let head = format!("[[{word}(");
    let after = text.split(&head).skip(1);
    let mut found: Vec<u32> = after.filter_map(|rest| rest.split_once(')')?.0.parse().ok()).collect();
    found.sort_unstable();
    found
}

/// The indices or registers that the reflection gives to the resources that a stage sees.
fn reflected(reflection: &Reflection, stage: Stage) -> [Vec<u32>; 3] {
    let sees = |visibility: &[String]| visibility.iter().any(|name| name == stage.name());
    let mut buffers: Vec<u32> =
        reflection.loose_block.iter().filter(|row| sees(&row.visibility)).map(|row| row.msl.buffer).collect();
    for block in reflection.blocks.iter().filter(|row| sees(&row.visibility)) {
        buffers.extend((0..block.array_size.unwrap_or(1)).map(|index| block.msl.buffer + index));
    }
    let samplers = || reflection.samplers.iter().filter(|row| sees(&row.visibility));
    let mut all = [
        buffers,
        samplers().map(|row| row.msl.texture).collect(),
        samplers().filter_map(|row| row.msl.sampler).collect(),
    ];
    all.iter_mut().for_each(|numbers| numbers.sort_unstable());
    all
}

fn is_subset(some: &[u32], all: &[u32]) -> bool {
    some.iter().all(|one| all.contains(one))
}

#[test]
fn metal_has_an_index_for_everything_and_the_reflection_tells_it() {
    let conventions = Conventions::default();
    let mut with_resources = 0;
    for (name, program) in programs() {
        let reflection = reflect(&program, &conventions);
        for shader in program.stages.iter().filter(|shader| shader.main.is_some()) {
            let stage = shader.stage;
            let Some(text) = text(&name, &program, stage, Target::Msl, &conventions) else { continue };
            assert!(!text.contains("fake"), "{name}: {text}");
            let entry = match stage {
                Stage::Vertex => reflection.targets.msl.entry_points.vertex.as_deref(),
                _ => reflection.targets.msl.entry_points.fragment.as_deref(),
            };
            let entry = entry.expect("the stage has an entry point");
            assert!(text.contains(&format!(" {entry}(")), "{name} has no {entry}: {text}");
            let [buffers, textures, samplers] = reflected(&reflection, stage);
            let own = ["buffer", "texture", "sampler"].map(|word| numbers(&text, word));
            for ((own, all), what) in
                own.iter().zip([&buffers, &textures, &samplers]).zip(["buffer", "texture", "sampler"])
            {
                assert!(is_subset(own, all), "{name}: {what} {own:?} of {all:?}\n{text}");
                assert!(own.windows(2).all(|pair| pair[0] < pair[1]), "{name}: {what} {own:?} twice");
            }
            with_resources += usize::from(own.iter().any(|own| !own.is_empty()));
            if stage == Stage::Vertex {
                let locations = reflection
                    .attributes
                    .iter()
                    .flat_map(|row| row.location..row.location + row.columns)
                    .collect::<Vec<_>>();
                assert!(is_subset(&numbers(&text, "attribute"), &locations), "{name}: {text}");
            }
        }
    }
    assert!(with_resources > 20, "only {with_resources} stages have resources");
}

#[test]
fn registers_are_those_of_the_reflection() {
    let conventions = Conventions::default();
    for (name, program) in programs() {
        let reflection = reflect(&program, &conventions);
        let mut known: Vec<String> = reflection.loose_block.iter().map(|row| row.hlsl.register.clone()).collect();
        for block in &reflection.blocks {
            known.extend((0..block.array_size.unwrap_or(1)).map(|index| format!("b{}", block.msl.buffer + index)));
        }
        for row in &reflection.samplers {
            known.push(row.hlsl.texture.clone());
            known.extend(row.hlsl.sampler.clone());
        }
        for shader in program.stages.iter().filter(|shader| shader.main.is_some()) {
            let Some(text) = text(&name, &program, shader.stage, Target::Hlsl, &conventions) else { continue };
            for register in text.split("register(").skip(1).filter_map(|rest| rest.split_once(')')) {
                assert!(known.iter().any(|known| known == register.0), "{name}: {} of {known:?}", register.0);
            }
        }
    }
}

/// The program of a vertex and a fragment shader.
fn pair(vertex: &str, fragment: &str) -> Program {
    pair_of(150, vertex, fragment)
}

fn pair_of(version: u16, vertex: &str, fragment: &str) -> Program {
    let sources =
        [("a.vert", vertex, Stage::Vertex), ("a.frag", fragment, Stage::Fragment)].map(|(name, text, stage)| Source {
            name: name.into(),
            text: format!("#version {version}\n{text}").into(),
            stage,
        });
    let compilation = compiler().compile(&sources);
    let messages: Vec<&str> = compilation.diagnostics.iter().map(|found| found.message.as_str()).collect();
    compilation.program.unwrap_or_else(|| panic!("{messages:?}"))
}

fn glsl(program: &Program, stage: Stage, glsl_version: GlslVersion) -> String {
    let conventions = Conventions { glsl_version, ..Conventions::default() };
    text("pair", program, stage, Target::Glsl, &conventions).expect("the version has it")
}

#[test]
fn glsl_keeps_the_names_of_the_source() {
    let program = pair(
        "in vec4 a_position; in vec2 a_uv; uniform mat4 u_matrix; uniform Camera { vec3 eye; } camera;\n\
         out vec2 v_uv; out vec3 v_eye;\n\
         void main() { v_uv = a_uv; v_eye = camera.eye; gl_Position = u_matrix * a_position; }",
        "in vec2 v_uv; in vec3 v_eye; uniform sampler2D u_tex; struct Light { vec3 color; }; uniform Light u_light[2];\n\
         void main() { gl_FragColor = texture2D(u_tex, v_uv) * vec4(u_light[1].color * v_eye, 1.0); }",
    );
    for version in VERSIONS {
        let (vertex, fragment) = (glsl(&program, Stage::Vertex, version), glsl(&program, Stage::Fragment, version));
        for line in [
            "layout(location = 0) in vec4 a_position;",
            "layout(location = 1) in vec2 a_uv;",
            "uniform mat4 u_matrix;",
            "uniform Camera {",
            "} camera;",
            "out vec2 v_uv;",
        ] {
            assert!(vertex.contains(line), "no `{line}` in {}:\n{vertex}", version.word());
        }
        for line in ["in vec2 v_uv;", "uniform sampler2D u_tex;", "uniform Light[2] u_light;", "texture(u_tex, v_uv)"] {
            assert!(fragment.contains(line), "no `{line}` in {}:\n{fragment}", version.word());
        }
        assert!(fragment.contains("layout(location = 0) out vec4 fragColor;"), "{fragment}");
    }
    let es = glsl(&program, Stage::Fragment, GlslVersion::Es300);
    assert!(es.starts_with("#version 300 es\nprecision highp float;\n"), "{es}");
}

/// The versions of GLSL that are written for OpenGL and WebGL.
const VERSIONS: [GlslVersion; 3] = [GlslVersion::Desktop330, GlslVersion::Desktop450, GlslVersion::Es300];

#[test]
fn varyings_that_match_by_location_have_one_name() {
    let vertex = "layout(location=0) in vec4 p; layout(location=1) out vec4 x; layout(location=2) out vec4 y;\n\
                  void main() { gl_Position = p; x = p; y = p.yxwz; }";
    let swapped = "layout(location=2) in vec4 x; layout(location=1) in vec4 y; uniform vec4 z; out vec4 o;\n\
                   void main() { o = x - 2.0 * y + z; }";
    let taken = "layout(location=2) in vec4 b; layout(location=1) in vec4 a; uniform vec4 x; out vec4 o;\n\
                 void main() { o = b - 2.0 * a + x; }";
    for version in VERSIONS {
        let program = pair_of(410, vertex, swapped);
        let text = glsl(&program, Stage::Fragment, version);
        assert!(text.contains("o = y - 2.0 * x + z"), "{text}");
        let program = pair_of(410, vertex, taken);
        let (written, read) = (glsl(&program, Stage::Vertex, version), glsl(&program, Stage::Fragment, version));
        assert!(written.contains("out vec4 x_2;") && written.contains("out vec4 y;"), "{written}");
        assert!(read.contains("uniform vec4 x;") && read.contains("o = y - 2.0 * x_2 + x"), "{read}");
    }
}

#[test]
fn structs_of_both_stages_have_one_name() {
    let light = "struct Light { vec4 pos; vec4 col; }; uniform struct { vec4 a; } tint;";
    let program = pair(
        &format!(
            "uniform struct {{ float b; }} one; {light} layout(std140) uniform Sun {{ Light sun; }}; in vec4 p; out vec4 v;\n\
             void main() {{ gl_Position = p * one.b; Light l = sun; v = l.pos + tint.a; }}"
        ),
        &format!(
            "{light} layout(std140) uniform Points {{ Light points[4]; }}; in vec4 v; out vec4 c;\n\
             vec4 shade(Light l) {{ return l.pos * l.col; }}\n\
             void main() {{ c = v + tint.a; for (int i = 0; i < 4; i++) {{ Light l = points[i]; c += shade(l); }} }}"
        ),
    );
    for version in VERSIONS {
        let texts = [Stage::Vertex, Stage::Fragment].map(|stage| {
            let text = glsl(&program, stage, version);
            assert_eq!(text.matches("struct Light").count(), 1, "{text}");
            assert!(text.contains("uniform Unnamed_2 tint;"), "{text}");
            ("structs".to_owned(), stage, text)
        });
        validate(&texts, "glsl", &[], 2);
    }
}

#[test]
fn a_global_gives_way_to_a_function_that_a_version_needs() {
    let program = pair_of(
        400,
        "in vec4 p; out vec2 uv; void main() { uv = p.xy; gl_Position = p; }",
        "in vec2 uv; uniform sampler2D maps[2]; uniform int chosen; uniform float clamp; uniform float dot; out vec4 c;\n\
         void main() { c = texture(maps[chosen], uv) * clamp * dot; }",
    );
    let renamed = |glsl_version| {
        let conventions = Conventions { glsl_version, ..Conventions::default() };
        reflect(&program, &conventions).targets.glsl.renamed.into_keys().collect::<Vec<_>>()
    };
    // 4.50 has samplers that are chosen, so nothing is clamped there.
    assert!(renamed(GlslVersion::Desktop450).is_empty());
    assert_eq!(renamed(GlslVersion::Desktop330), ["clamp"]);
    let text = glsl(&program, Stage::Fragment, GlslVersion::Desktop330);
    assert!(text.contains("uniform float clamp_;") && text.contains("clamp(index, 0, 1)"), "{text}");
    validate(&[("clamp".to_owned(), Stage::Fragment, text)], "glsl", &[], 1);
}

#[test]
fn precise_is_kept_where_glsl_has_it() {
    let program = pair_of(
        400,
        "in vec4 p; precise out vec4 v; precise gl_Position;\n\
         precise float f(float x) { return x * x; }\n\
         void main() { precise float t = p.x * p.y + f(p.z); float u = t; v = p * u; gl_Position = v; }",
        "in vec4 v; out vec4 c; void main() { c = v; }",
    );
    let words = [
        "precise out vec4 v;",
        "precise gl_Position;",
        "precise float f(float x)",
        "precise float t = ",
        "float u = t",
    ];
    for (version, extended) in [(GlslVersion::Desktop330, true), (GlslVersion::Desktop450, false)] {
        let text = glsl(&program, Stage::Vertex, version);
        assert!(words.iter().all(|word| text.contains(word)) && !text.contains("precise float u"), "{text}");
        assert_eq!(text.contains("#extension GL_ARB_gpu_shader5 : require"), extended, "{text}");
        assert!(!glsl(&program, Stage::Fragment, version).contains("GL_ARB_gpu_shader5"));
        // glslang has no `precise` before 4.00, with the extension either.
        if version == GlslVersion::Desktop450 {
            validate(&[("precise".to_owned(), Stage::Vertex, text)], "glsl", &[], 1);
        }
    }
    let vulkan = glsl(&program, Stage::Vertex, GlslVersion::Vulkan);
    assert!(vulkan.contains("precise float t = ") && vulkan.contains("precise out vec4 v;"), "{vulkan}");
    assert!(!glsl(&program, Stage::Vertex, GlslVersion::Es300).contains("precise "));
}

#[test]
fn words_of_a_later_version_get_an_underscore_in_both_stages() {
    let program = pair(
        "in vec4 p; out vec4 sample; uniform float patch; uniform vec2 texture;\n\
         void main() { sample = p * patch; gl_Position = p + texture.xyxy; }",
        "in vec4 sample; out vec4 color; float round(float resource) { return resource; }\n\
         void main() { color = sample * round(2.0); }",
    );
    let renamed = |glsl_version| {
        let conventions = Conventions { glsl_version, ..Conventions::default() };
        reflect(&program, &conventions).targets.glsl.renamed.into_iter().collect::<Vec<_>>()
    };
    assert!(renamed(GlslVersion::Desktop330).is_empty());
    let names = |list: &[&str]| list.iter().map(|name| ((*name).to_owned(), format!("{name}_"))).collect::<Vec<_>>();
    assert_eq!(renamed(GlslVersion::Desktop450), names(&["patch", "resource", "sample"]));
    assert_eq!(renamed(GlslVersion::Es300), names(&["patch", "resource", "round", "sample", "texture"]));
    for version in [GlslVersion::Desktop450, GlslVersion::Es300] {
        let texts = [Stage::Vertex, Stage::Fragment].map(|stage| {
            let text = glsl(&program, stage, version);
            assert!(text.contains("vec4 sample_;"), "{text}");
            ("words".to_owned(), stage, text)
        });
        validate(&texts, "glsl", &[], 2);
    }
}

#[test]
fn a_label_at_the_end_of_a_switch_has_a_statement() {
    let program = pair(
        "in vec4 p; void main() { gl_Position = p; }",
        "uniform int k; out vec4 c; void main() { float r = 1.0; switch (k) { case 0: r = 2.0; case 1: ; } c = vec4(r); }",
    );
    for version in VERSIONS {
        let text = glsl(&program, Stage::Fragment, version);
        assert!(text.contains("    case 1:\n        break;\n    }\n"), "{text}");
        validate(&[("label".to_owned(), Stage::Fragment, text)], "glsl", &[], 1);
    }
}

#[test]
fn a_comparison_in_another_level_is_told_with_its_own_remedy() {
    for (call, remedy) in [
        ("texture(s, p, 1.0)", Some("leave the bias out")),
        ("textureLod(s, p, 1.0)", Some("use level 0.0, or `texture` for the implicit level")),
        ("textureGrad(s, p, p.xy, p.xy)", Some("leave the derivatives out")),
        ("texture(s, p)", None),
        ("textureLod(s, p, 0.0)", None),
    ] {
        let text = format!(
            "#version 150\nuniform sampler2DShadow s; in vec3 p; out vec4 c; void main() {{ c = vec4({call}); }}"
        );
        let source = Source { name: "a.frag".into(), text: text.into(), stage: Stage::Fragment };
        let program = compiler().compile(&[source]).program.expect("it compiles");
        let notes = glisten_emit::notes(&program, &Conventions::default());
        let found: Vec<(&str, Option<&str>)> = notes.iter().map(|note| (note.code.id, note.help.as_deref())).collect();
        let expected: Vec<_> = remedy.into_iter().map(|remedy| ("W0802", Some(remedy))).collect();
        assert_eq!(found, expected, "{call}");
    }
}

#[test]
fn webgl_2_refuses_what_it_lacks_with_a_way_out() {
    let conventions = Conventions { glsl_version: GlslVersion::Es300, ..Conventions::default() };
    let rows = [
        (Stage::Vertex, "noperspective out vec4 v; void main() { v = vec4(1.0); gl_Position = v; }", "noperspective"),
        (Stage::Vertex, "out float gl_ClipDistance[1]; void main() { gl_ClipDistance[0] = 1.0; }", "gl_ClipDistance"),
        (Stage::Fragment, "uniform sampler1D s; out vec4 c; void main() { c = texture(s, 0.5); }", "sampler1D"),
        (
            Stage::Fragment,
            "uniform samplerBuffer s; out vec4 c; void main() { c = texelFetch(s, 0); }",
            "samplerBuffer",
        ),
        (Stage::Fragment, "out vec4 c; void main() { c = vec4(gl_PrimitiveID); }", "gl_PrimitiveID"),
        (
            Stage::Vertex,
            "out B { vec4 c; } b[2]; void main() { b[1].c = gl_Position = vec4(1.0); }",
            "arrays of blocks",
        ),
        (
            Stage::Vertex,
            "struct S { float b[2]; }; out S s; void main() { s.b[0] = 1.0; gl_Position = vec4(1.0); }",
            "structs with arrays",
        ),
        (
            Stage::Vertex,
            "struct S { float b; }; out S s[2]; void main() { s[0].b = 1.0; gl_Position = vec4(1.0); }",
            "arrays of structs",
        ),
        (
            Stage::Fragment,
            "uniform int n; out vec4 c[2]; void main() { c[n] = vec4(1.0); }",
            "index of a fragment output",
        ),
        (
            Stage::Fragment,
            "void f(out int a) { a = 7; } out vec4 c; void main() { float x; f(x); c = vec4(x); }",
            "implicit conversion",
        ),
    ];
    for (stage, body, what) in rows {
        let source = Source { name: "a".into(), text: format!("#version 150\n{body}").into(), stage };
        let program = compiler().compile(&[source]).program.expect("it compiles");
        let errors = emit(&program, stage, Target::Glsl, &conventions).expect_err(body);
        assert!(errors.iter().all(|error| error.code.id == "E0802" && error.help.is_some()), "{errors:?}");
        assert!(errors.iter().any(|error| error.message.contains(what)), "{errors:?}");
        let desktop = emit(&program, stage, Target::Glsl, &Conventions::default());
        assert!(desktop.is_ok(), "{body}: {desktop:?}");
    }
}

#[test]
fn more_samplers_than_a_target_has_are_an_error() {
    let samplers: String = (0..17).map(|index| format!("uniform sampler2D s{index}; ")).collect();
    let sum: Vec<String> = (0..17).map(|index| format!("texture(s{index}, v)")).collect();
    let body = format!("{samplers} in vec2 v; out vec4 c; void main() {{ c = {}; }}", sum.join(" + "));
    let source = Source { name: "a.frag".into(), text: format!("#version 150\n{body}").into(), stage: Stage::Fragment };
    let program = compiler().compile(&[source]).program.expect("17 samplers are within OpenGL's limit");
    for target in [Target::Msl, Target::Hlsl] {
        let errors = emit(&program, Stage::Fragment, target, &Conventions::default()).expect_err("too many");
        assert_eq!(errors.first().map(|error| error.code.id), Some("E0802"), "{errors:?}");
    }
}

#[test]
fn inverse_and_clip_distances_are_in_hlsl_and_msl() {
    let program = pair(
        "in vec4 p; uniform mat4 m; out float gl_ClipDistance[5];\n\
         void main() { for (int i = 0; i < 5; i++) gl_ClipDistance[i] = p.x + float(i); gl_Position = inverse(m) * p; }",
        "uniform mat3 n; uniform mat2 k; out vec4 c;\n\
         void main() { c = vec4(inverse(n) * vec3(1.0), (inverse(k) * vec2(1.0)).x); }",
    );
    let conventions = Conventions::default();
    let texts: Vec<(String, Stage, String)> = [Stage::Vertex, Stage::Fragment]
        .map(|stage| {
            let text = text("inverse", &program, stage, Target::Hlsl, &conventions).expect("HLSL has it");
            ("inverse".to_owned(), stage, text)
        })
        .into();
    let vertex = &texts[0].2;
    assert!(vertex.contains("float4 clip_distances : SV_ClipDistance0;"), "{vertex}");
    assert!(vertex.contains("float clip_distances_1 : SV_ClipDistance1;"), "{vertex}");
    validate(&texts, "hlsl", HLSL, 2);
    let msl = text("inverse", &program, Stage::Vertex, Target::Msl, &conventions).expect("MSL has it");
    assert!(msl.contains("[[clip_distance]] [5]"), "{msl}");
}

#[test]
fn blocks_between_stages_are_varyings_in_webgl_2() {
    let program = pair(
        "in vec4 p; out V { vec2 uv; flat int n; } o; void main() { o.uv = p.xy; o.n = 2; gl_Position = p; }",
        "in V { vec2 uv; flat int n; } i; uniform samplerBuffer unused; out vec4 c;\n\
         vec4 never() { return texelFetch(unused, 0); }\n\
         void main() { c = vec4(i.uv, float(i.n), 1.0); }",
    );
    let texts = [Stage::Vertex, Stage::Fragment].map(|stage| {
        let text = glsl(&program, stage, GlslVersion::Es300);
        assert!(text.contains(" vec2 V_uv;") && text.contains("flat ") && !text.contains("unused"), "{text}");
        ("blocks".to_owned(), stage, text)
    });
    validate(&texts, "glsl", &[], 2);
}

/// Neither functions that nobody calls nor globals that nobody reads ask for anything.
#[test]
fn webgl_2_gets_nothing_of_what_nothing_uses() {
    let program = pair_of(
        430,
        "in vec4 p; void main() { gl_Position = p; }",
        "uniform float u; out vec4 c; float a = u * 2.0; float one = 1.0; float b = sin(one); float used = u * 3.0;\n\
         float never(int i) { float grid[2][2]; grid[i][0] = 1.0; c[i] = 1.0; return grid[0][i]; }\n\
         uint nowhere(uint bits) { return bitfieldReverse(bits); }\n\
         void main() { c = vec4(u + used); }",
    );
    let text = glsl(&program, Stage::Fragment, GlslVersion::Es300);
    assert!(text.contains("used = u * 3.0;") && !text.contains("sin(") && !text.contains("u * 2.0"), "{text}");
    validate(&[("unused".to_owned(), Stage::Fragment, text)], "glsl", &[], 1);
}

#[test]
fn both_sources_of_blending_are_emitted_even_if_one_is_written() {
    let head = "#version 150\n#extension GL_ARB_explicit_attrib_location : enable\n";
    for rest in [
        "layout(location = 0, index = 0) out vec4 a; layout(location = 0, index = 1) out vec4 b; void main() { a = vec4(1.0); }\n",
        "layout(location = 0, index = 1) out vec4 b; void main() { b = vec4(1.0); }\n",
        "layout(location = 0, index = 1) out vec2 b; void main() { }\n",
    ] {
        let source = Source { name: "a.frag".into(), text: format!("{head}{rest}").into(), stage: Stage::Fragment };
        let program = compiler().compile(&[source]).program.expect("it compiles");
        for target in [Target::Wgsl, Target::Hlsl, Target::Msl, Target::Spirv] {
            let emitted = emit(&program, Stage::Fragment, target, &Conventions::default());
            assert!(emitted.is_ok(), "{rest} {}: {emitted:?}", target.name());
        }
    }
}
