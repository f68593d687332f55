//! Emission over all fixtures: external judges have to accept the output.
//!
//! The judges are naga's own front end and validator and Tint (through Dawn's null backend, the npm package `webgpu`)
//! for WGSL, and `spirv-val` for SPIR-V. If an external judge is missing, the test says so; if `CI` is set, it fails.

use crate::support::{compile_files, compiler, files_under, root, stage_of};
use glisten::library::{Embedded, programs};
use glisten_emit::{ClipZ, Conventions, Emitted, SpirvEnv, Target, WindowOrigin, emit, notes};
use glisten_front::Source;
use glisten_front::hir::Stage;
use glisten_front::link::Program;
use glisten_library::shader;
use std::collections::BTreeMap;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The errors with which a target may reject a valid program: a stage or feature that it lacks.
const REFUSALS: [&str; 2] = ["E0801", "E0802"];

/// All shaders in a folder of the fixtures, grouped into programs by folder and stem.
pub(crate) fn fixtures(folder: &str) -> BTreeMap<PathBuf, Vec<PathBuf>> {
    let mut programs: BTreeMap<PathBuf, Vec<PathBuf>> = BTreeMap::new();
    for path in files_under(&root().join("fixtures").join(folder)).into_iter().filter(|path| stage_of(path).is_some()) {
        programs.entry(path.with_extension("")).or_default().push(path);
    }
    programs.values_mut().for_each(|files| files.sort_by_key(|path| stage_of(path)));
    programs
}

/// All emitted code, on disk for the external judges.
pub(crate) struct Collected {
    folder: tempfile::TempDir,
    /// Files of WGSL with the names of their sources.
    wgsl: Vec<(PathBuf, String)>,
    /// Files of SPIR-V with the names of their sources.
    spirv: Vec<(PathBuf, String)>,
    failures: Vec<String>,
}

impl Collected {
    pub(crate) fn new() -> Self {
        let folder = tempfile::tempdir().expect("a temporary folder");
        Self { folder, wgsl: Vec::new(), spirv: Vec::new(), failures: Vec::new() }
    }

    pub(crate) fn add(&mut self, name: &str, emitted: Emitted) {
        let list = match emitted {
            Emitted::Text(_) => &mut self.wgsl,
            Emitted::Words(_) => &mut self.spirv,
        };
        let extension = if matches!(emitted, Emitted::Text(_)) { "wgsl" } else { "spv" };
        let path = self.folder.path().join(format!("{}.{extension}", list.len()));
        fs::write(&path, emitted.into_bytes()).expect("the temporary folder can be written to");
        list.push((path, name.to_owned()));
    }

    /// Emits all stages of a program for a target.
    fn program(&mut self, files: &[PathBuf], target: Target, conventions: &Conventions) {
        let compilation = compile_files(files);
        let name = format!("{} as {}", files[0].with_extension("").display(), target.name());
        let Some(program) = &compilation.program else {
            // Fixtures that are not programs (a single file with an unmatched input) are left to other tests.
            return;
        };
        self.linked(&name, program, target, conventions);
    }

    /// Emits all stages of a program that is already linked.
    fn linked(&mut self, name: &str, program: &Program, target: Target, conventions: &Conventions) {
        for shader in &program.stages {
            let first = emit(program, shader.stage, target, conventions);
            assert_eq!(first, emit(program, shader.stage, target, conventions), "{name}: emission is deterministic");
            match first {
                Ok(emitted) => {
                    if let Emitted::Text(text) = &emitted {
                        self.failures.extend(reparse(text).err().map(|error| format!("{name}: {error}\n{text}")));
                    }
                    self.add(&format!("{name}, {}", shader.stage.name()), emitted);
                }
                Err(diagnostics) => {
                    let refused = diagnostics.iter().filter(|diagnostic| !REFUSALS.contains(&diagnostic.code.id));
                    self.failures.extend(
                        refused.map(|diagnostic| format!("{name}: {} {}", diagnostic.code, diagnostic.message)),
                    );
                }
            }
        }
    }

    /// Passes everything to the external judges.
    pub(crate) fn validate(mut self) {
        self.tint();
        self.spirv_val();
        assert!(self.failures.is_empty(), "{}", self.failures.join("\n\n"));
    }

    fn tint(&mut self) {
        let root = root();
        let package = root.join("target/tint/node_modules/webgpu");
        let script = root.join("tests/it/tint.mjs");
        let files: Vec<&Path> = self.wgsl.iter().map(|(path, _)| path.as_path()).collect();
        let output = package.is_dir().then(|| Command::new("node").arg(&script).arg(&package).args(&files).output());
        let Some(Ok(output)) = output else {
            missing("Tint", "npm install --prefix target/tint webgpu (and node) brings it");
            return;
        };
        let lines = String::from_utf8_lossy(&output.stdout);
        let checked = lines.lines().last().is_some_and(|line| line.contains("\"checked\""));
        if !checked {
            self.failures.push(format!("Tint did not run: {}", String::from_utf8_lossy(&output.stderr)));
        }
        for line in lines.lines().filter(|line| line.contains("\"file\"")) {
            let source = self.wgsl.iter().find(|(path, _)| line.contains(&path.display().to_string()));
            let (path, name) = source.expect("Tint names a file that it was given");
            let text = fs::read_to_string(path).unwrap_or_default();
            self.failures.push(format!("{name}: Tint says {line}\n{text}"));
        }
    }

    fn spirv_val(&mut self) {
        for (path, name) in &self.spirv {
            let output = Command::new("spirv-val").args(["--target-env", "vulkan1.1"]).arg(path).output();
            let Ok(output) = output else {
                missing("spirv-val", "Debian has it in the package spirv-tools");
                return;
            };
            if !output.status.success() {
                self.failures.push(format!("{name}: spirv-val says {}", String::from_utf8_lossy(&output.stderr)));
            }
        }
    }
}

/// Reports that a judge is missing; where it is required, that is a failure.
pub(crate) fn missing(judge: &str, way: &str) {
    let message = format!("{judge} is missing, so nothing was shown to it: {way}");
    assert!(std::env::var_os("CI").is_none(), "{message}");
    // The test harness does not capture this: a missing judge must be visible.
    writeln!(std::io::stderr(), "\n{message}").expect("standard error can be written to");
}

fn reparse(text: &str) -> Result<(), String> {
    let module = naga::front::wgsl::parse_str(text).map_err(|error| error.emit_to_string(text))?;
    let flags = naga::valid::ValidationFlags::all();
    let mut validator = naga::valid::Validator::new(flags, naga::valid::Capabilities::all());
    validator.validate(&module).map(|_| ()).map_err(|error| error.emit_to_string(text))
}

fn all(folder: &str, conventions: &Conventions) {
    let mut collected = Collected::new();
    for files in fixtures(folder).values() {
        for target in [Target::Wgsl, Target::Spirv] {
            collected.program(files, target, conventions);
        }
    }
    collected.validate();
}

#[test]
fn the_programs_are_accepted_everywhere() {
    all("programs", &Conventions::default());
}

#[test]
fn the_librarys_programs_are_accepted_everywhere() {
    let mut collected = Collected::new();
    for program in programs() {
        let source = |file: &str, stage| Source {
            name: format!("shader_lib/programs/{file}"),
            text: shader(file).expect("it is embedded").into(),
            stage,
        };
        let sources = [source(program.vertex, Stage::Vertex), source(program.fragment, Stage::Fragment)];
        let compilation = compiler().with_includes(Embedded).compile(&sources);
        let found: Vec<_> = compilation.diagnostics.iter().map(|found| &found.message).collect();
        assert!(found.is_empty(), "{}: {found:?}", program.name);
        let linked = compilation.program.expect("without findings there is a program");
        for target in [Target::Wgsl, Target::Spirv] {
            let name = format!("{} as {}", program.name, target.name());
            collected.linked(&name, &linked, target, &Conventions::default());
        }
    }
    collected.validate();
}

#[test]
fn what_lowering_has_to_know_is_accepted_everywhere() {
    all("lower", &Conventions::default());
}

#[test]
fn every_valid_fixture_is_accepted_everywhere() {
    all("valid", &Conventions::default());
}

#[test]
fn the_other_conventions_are_accepted_everywhere() {
    let conventions = Conventions {
        clip_z: ClipZ::MinusOneToOne,
        window_origin: WindowOrigin::LowerLeft,
        spirv_env: SpirvEnv::Vulkan,
        clip_distances: Some(1),
        program_point_size: false,
        ..Conventions::default()
    };
    all("lower", &conventions);
}

#[test]
fn the_fixtures_of_lowering_are_programs_and_every_target_takes_or_refuses_them() {
    for folder in ["programs", "lower"] {
        for files in fixtures(folder).values() {
            let name = files[0].display();
            let compilation = compile_files(files);
            let found: Vec<_> = compilation.diagnostics.iter().map(|found| &found.message).collect();
            let program = compilation.program.as_ref().unwrap_or_else(|| panic!("{name}: {found:?}"));
            assert_eq!(program.stages.len(), 2, "{name}");
            for &target in Target::ALL {
                let emitted = emit(program, Stage::Fragment, target, &Conventions::default());
                for diagnostic in emitted.err().into_iter().flatten() {
                    assert!(REFUSALS.contains(&diagnostic.code.id), "{name}: {}", diagnostic.message);
                }
            }
        }
    }
}

/// The codes of emitting a single shader.
fn codes(stage: Stage, text: &str, target: Target, conventions: &Conventions) -> Vec<&'static str> {
    let source = Source { name: "shader".into(), text: format!("#version 150\n{text}").into(), stage };
    let compilation = compiler().compile(&[source]);
    let program = compilation.program.expect("the shader is valid");
    let errors = emit(&program, stage, target, conventions).err().into_iter().flatten();
    errors.chain(notes(&program, conventions)).map(|diagnostic| diagnostic.code.id).collect()
}

#[test]
fn what_a_target_lacks_has_a_code() {
    let plain = Conventions::default();
    let sized = Conventions { program_point_size: true, ..plain };
    let geometry = "layout(points) in; layout(points, max_vertices = 1) out; void main() { EmitVertex(); }";
    let size = "void main() { gl_Position = vec4(0.0); gl_PointSize = 2.0; }";
    let coordinate = "out vec4 c; void main() { c = gl_PointCoord.xyxy; }";
    let shadow = |lookup: &str| {
        format!("uniform sampler2DShadow s; in vec4 v; out vec4 c; void main() {{ c = vec4({lookup}); }}")
    };
    let (biased, graded) = (&shadow("textureProj(s, v, -0.00005)"), &shadow("textureGrad(s, v.xyz, v.xy, v.zw)"));
    let unbiased = &shadow("texture(s, v.xyz, 0.0) + textureLod(s, v.xyz, 0.0)");
    // The reference of the comparison is no level.
    let cubes = "#extension GL_ARB_texture_cube_map_array : enable\nuniform samplerCubeArrayShadow s; in vec4 v; out vec4 c;\n\
                 void main() { c = vec4(texture(s, v, 0.4)); }";
    let shared = |one: &str, other: &str| {
        format!(
            "#extension GL_ARB_explicit_attrib_location : enable\nlayout(location = 0) in {one} a;\n\
             layout(location = 0) in {other} b; uniform int n;\n\
             void main() {{ if (n > 0) gl_Position = vec4(a.x); else gl_Position = vec4(b.y); }}"
        )
    };
    let rows = [
        (Stage::Geometry, geometry, Target::Wgsl, plain, vec!["E0801"]),
        (Stage::Vertex, size, Target::Wgsl, plain, vec!["W0801"]),
        (Stage::Vertex, size, Target::Wgsl, sized, vec!["E0802"]),
        (Stage::Vertex, size, Target::Spirv, sized, vec![]),
        (Stage::Fragment, coordinate, Target::Wgsl, plain, vec!["E0802"]),
        (Stage::Fragment, coordinate, Target::Spirv, plain, vec![]),
        (Stage::Fragment, biased, Target::Wgsl, plain, vec!["W0802"]),
        (Stage::Fragment, graded, Target::Spirv, plain, vec!["W0802"]),
        (Stage::Fragment, unbiased, Target::Wgsl, plain, vec![]),
        (Stage::Fragment, cubes, Target::Wgsl, plain, vec![]),
        (Stage::Vertex, &shared("vec2", "vec4"), Target::Wgsl, plain, vec![]),
        (Stage::Vertex, &shared("vec2", "ivec4"), Target::Spirv, plain, vec!["E0802"]),
    ];
    for (stage, text, target, conventions, expected) in rows {
        assert_eq!(codes(stage, text, target, &conventions), expected, "{} for {}", text, target.name());
    }
}

#[test]
fn a_program_with_a_geometry_stage_is_refused_once_for_each_stage_before_it() {
    let source = |stage: Stage, text: &str| Source {
        name: format!("a.{}", stage.name()),
        text: format!("#version 150\n{text}").into(),
        stage,
    };
    let program = compiler().compile(&[
        source(Stage::Vertex, "out vec3 tint; void main() { tint = vec3(1.0); gl_Position = vec4(0.0); }"),
        source(
            Stage::Geometry,
            "layout(points) in; layout(points, max_vertices = 1) out; in vec3 tint[]; out vec3 shade;\n\
             void main() { shade = tint[0]; gl_Position = gl_in[0].gl_Position; EmitVertex(); }",
        ),
        source(Stage::Fragment, "in vec3 shade; out vec4 c; void main() { c = vec4(shade, 1.0); }"),
    ]);
    let program = program.program.expect("the program is valid");
    for target in [Target::Wgsl, Target::Spirv] {
        for (stage, expected) in
            [(Stage::Vertex, Some("E0801")), (Stage::Geometry, Some("E0801")), (Stage::Fragment, None)]
        {
            let errors = emit(&program, stage, target, &Conventions::default()).err().unwrap_or_default();
            let codes: Vec<&str> = errors.iter().map(|error| error.code.id).collect();
            assert_eq!(codes, Vec::from_iter(expected), "{} for {}", stage.name(), target.name());
        }
    }
}

#[test]
fn long_chains_become_flat_text() {
    let arms: String = (0..1000).map(|arm| format!("if (n == {arm}) x = {arm}.0; else ")).collect();
    let sum = vec!["v.x"; 10_000].join(" + ");
    let choice: String = (0..200).map(|arm| format!("n == {arm} ? v.x * {arm}.0 : ")).collect();
    let text = format!(
        "uniform int n; uniform vec4 v; out vec4 c;\n\
         void main() {{ float x; {arms} x = -1.0; float y = {choice} 1.0; c = vec4(x + y, {sum}, 0.0, 1.0); }}"
    );
    let source =
        Source { name: "chain.frag".into(), text: format!("#version 150\n{text}").into(), stage: Stage::Fragment };
    let program = compiler().compile(&[source]).program.expect("the shader is valid");
    let emitted = emit(&program, Stage::Fragment, Target::Wgsl, &Conventions::default());
    let Ok(Emitted::Text(wgsl)) = emitted else { panic!("WGSL comes out: {emitted:?}") };
    assert!(wgsl.len() < 20 * text.len(), "{} bytes of GLSL became {} of WGSL", text.len(), wgsl.len());
    let deepest = wgsl.lines().map(|line| line.len() - line.trim_start().len()).max();
    assert!(deepest < Some(100), "the text nests {deepest:?} columns deep");
    reparse(&wgsl).expect("naga reads its own text");
}

/// The WGSL of a single fragment shader.
fn wgsl(text: &str) -> String {
    let source = Source { name: "shader".into(), text: format!("#version 150\n{text}").into(), stage: Stage::Fragment };
    let program = compiler().compile(&[source]).program.expect("the shader is valid");
    match emit(&program, Stage::Fragment, Target::Wgsl, &Conventions::default()) {
        Ok(Emitted::Text(text)) => text,
        other => panic!("WGSL comes out: {other:?}"),
    }
}

#[test]
fn a_loop_behind_a_discard_ends_where_the_invocation_goes_on() {
    let guarded = |text: &str| wgsl(text).matches("if discarded {").count();
    let body = "if (step <= 0.0) discard; for (float t = 0.0; t < 1.0; t += step) sum += t;";
    assert_eq!(
        guarded(&format!("uniform float step; out vec4 c; void main() {{ float sum = 0.0; {body} c = vec4(sum); }}")),
        1
    );
    let called = "in float x; out vec4 c; void f(int i) { if (float(i) > x) discard; }\n\
        void main() { int i = 0; while (true) f(i++); c = vec4(1.0); }";
    assert_eq!(guarded(called), 1);
    let counted = "uniform int n; in float x; out vec4 c; void main() { if (x < 0.0) discard; float sum = 0.0;\n\
        for (int i = 0; i < n; i++) sum += x; for (int i = 8; i >= 0; i -= 2) sum += x; c = vec4(sum); }";
    assert_eq!(guarded(counted), 0, "loops that count need no flag");
    let moved = "in float x; out vec4 c; void main() { if (x < 0.0) discard;\n\
        for (int i = 0; i < 4; i++) { if (x > 1.0) i--; } c = vec4(x); }";
    assert_eq!(guarded(moved), 1, "something else moves the counter");
}

#[test]
fn text_nests_as_deep_as_tint_reads_and_no_deeper() {
    let nested = |open: &str, depth: usize| {
        let (open, close) = (open.repeat(depth), "}".repeat(depth));
        format!(
            "uniform int n; in vec4 v; out vec4 c; void main() {{ float x = 0.0; {open} x += v.x; {close} c = vec4(x); }}"
        )
    };
    let plain = Conventions::default();
    let mut collected = Collected::new();
    for (open, deepest) in [
        ("if (v.y > 0.5) {", 62),
        ("for (int i = 0; i < n; i++) {", 61),
        ("while (x < 4.0) {", 61),
        ("switch (n) { case 0:", 41),
        ("switch (n) { case 0: x += 1.0; case 1: ", 25),
    ] {
        collected.add(open, Emitted::Text(wgsl(&nested(open, deepest))));
        let deeper = nested(open, deepest + 1);
        assert_eq!(codes(Stage::Fragment, &deeper, Target::Wgsl, &plain), ["E0803"], "{open}");
        assert!(codes(Stage::Fragment, &deeper, Target::Spirv, &plain).is_empty(), "{open}");
    }
    collected.validate();
}

#[test]
fn what_becomes_constant_on_the_way_is_kept_from_the_target() {
    let text = wgsl(
        "uniform int n; out vec4 c; int g;\n\
         void main() { uint u = (g++, 0xffffffffu) << (g++, 5u); int z = (g++, 7) / (g++, 0);\n\
         ivec2 w = ivec2(n) / ivec2(0, 1) + n % 0; c = vec4(u, z, w); }",
    );
    reparse(&text).unwrap_or_else(|error| panic!("{error}"));
    let mut collected = Collected::new();
    collected.add("constants behind effects", Emitted::Text(text));
    collected.validate();
}

#[test]
fn a_judge_refuses_what_is_wrong() {
    let mut collected = Collected::new();
    collected.add("a call of nothing", Emitted::Text("fn f() -> f32 { return g(); }".into()));
    collected.add("a lone word", Emitted::Words(vec![0x0723_0203]));
    let mut failures = 0;
    if root().join("target/tint/node_modules/webgpu").is_dir() {
        collected.tint();
        failures += 1;
    }
    if Command::new("spirv-val").arg("--version").output().is_ok() {
        collected.spirv_val();
        failures += 1;
    }
    assert_eq!(collected.failures.len(), failures, "{:?}", collected.failures);
    assert!(reparse("fn f() -> f32 { return g(); }").is_err());
}
