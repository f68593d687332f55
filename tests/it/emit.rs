//! Emission over all fixtures: what comes out has to be accepted by judges that are not ours.
//!
//! WGSL by naga's own front-end and validator and by Tint (through Dawn's null backend, the npm package `webgpu`),
//! SPIR-V by `spirv-val`. On a machine that lacks one of the outside judges the test says so; where `CI` is set, it fails.

use glisten::emit::{ClipZ, Conventions, Emitted, SpirvEnv, Target, WindowOrigin, emit};
use glisten::hir::Stage;
use glisten::{Compiler, Options, Source};
use std::collections::BTreeMap;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Command;

/// What a target may refuse of a valid program: a stage or feature that it lacks.
const REFUSALS: [&str; 2] = ["E0801", "E0802"];

/// All shaders below a folder, grouped into programs by folder and stem.
fn programs(folder: &str) -> BTreeMap<PathBuf, Vec<PathBuf>> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures").join(folder);
    let mut programs: BTreeMap<PathBuf, Vec<PathBuf>> = BTreeMap::new();
    let mut folders = vec![root];
    while let Some(folder) = folders.pop() {
        let Ok(entries) = fs::read_dir(&folder) else { continue };
        for path in entries.map(|entry| entry.expect("an entry of the folder").path()) {
            if path.is_dir() {
                folders.push(path);
            } else if stage(&path).is_some() {
                programs.entry(path.with_extension("")).or_default().push(path);
            }
        }
    }
    programs.values_mut().for_each(|files| files.sort_by_key(|path| stage(path)));
    programs
}

fn stage(path: &Path) -> Option<Stage> {
    match path.extension()?.to_str()? {
        "vert" => Some(Stage::Vertex),
        "frag" => Some(Stage::Fragment),
        "geom" => Some(Stage::Geometry),
        _ => None,
    }
}

fn compile(files: &[PathBuf]) -> glisten::Compilation {
    let sources: Vec<Source> = files
        .iter()
        .map(|path| Source {
            name: path.display().to_string(),
            text: String::from_utf8_lossy(&fs::read(path).expect("a fixture can be read")).into(),
            stage: stage(path).expect("only shaders were collected"),
        })
        .collect();
    Compiler::new(Options::default()).compile(&sources)
}

/// Everything that is emitted, on disk for the outside judges.
struct Collected {
    folder: tempfile::TempDir,
    /// Files of WGSL with the names of their sources.
    wgsl: Vec<(PathBuf, String)>,
    /// Files of SPIR-V, likewise.
    spirv: Vec<(PathBuf, String)>,
    failures: Vec<String>,
}

impl Collected {
    fn new() -> Self {
        let folder = tempfile::tempdir().expect("a temporary folder");
        Self { folder, wgsl: Vec::new(), spirv: Vec::new(), failures: Vec::new() }
    }

    fn add(&mut self, name: &str, emitted: Emitted) {
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
        let compilation = compile(files);
        let name = format!("{} as {}", files[0].with_extension("").display(), target.name());
        let Some(program) = &compilation.program else {
            // Fixtures that are not programs (a lone file with an unmatched input) are the business of other tests.
            return;
        };
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

    /// Hands all to the outside judges.
    fn judge(mut self) {
        self.tint();
        self.spirv_val();
        assert!(self.failures.is_empty(), "{}", self.failures.join("\n\n"));
    }

    fn tint(&mut self) {
        let root = Path::new(env!("CARGO_MANIFEST_DIR"));
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

/// Says that a judge is not there; where it has to be, that is a failure.
fn missing(judge: &str, way: &str) {
    let message = format!("{judge} is missing, so nothing was shown to it: {way}");
    assert!(std::env::var_os("CI").is_none(), "{message}");
    // Not captured by the test harness: a judge that is left out must be seen.
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
    for files in programs(folder).values() {
        for target in [Target::Wgsl, Target::Spirv] {
            collected.program(files, target, conventions);
        }
    }
    collected.judge();
}

#[test]
fn the_programs_are_accepted_everywhere() {
    all("programs", &Conventions::default());
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
        debug_lines: false,
    };
    all("lower", &conventions);
}

#[test]
fn the_fixtures_of_lowering_are_programs() {
    for folder in ["programs", "lower"] {
        for files in programs(folder).values() {
            let compilation = compile(files);
            let program = compilation.program.as_ref().unwrap_or_else(|| {
                let found: Vec<_> = compilation.diagnostics.iter().map(|found| &found.message).collect();
                panic!("{}: {found:?}", files[0].display())
            });
            assert_eq!(program.stages.len(), 2, "{}", files[0].display());
        }
    }
}

#[test]
fn a_judge_refuses_what_is_wrong() {
    let mut collected = Collected::new();
    collected.add("a call of nothing", Emitted::Text("fn f() -> f32 { return g(); }".into()));
    collected.add("a lone word", Emitted::Words(vec![0x0723_0203]));
    let mut failures = 0;
    if Path::new(env!("CARGO_MANIFEST_DIR")).join("target/tint/node_modules/webgpu").is_dir() {
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
