//! Counts how many programs each translator brings to WGSL: glisten, naga's own GLSL front end, and glslang with naga.
//!
//! ```sh
//! cargo run -p glisten-studies --bin peers -- fixtures/programs
//! ```
//!
//! A program is a `.vert` and a `.frag` of one name. glisten's WGSL counts if naga validates it; the others count if `naga`
//! (`cargo install naga-cli`) writes WGSL. glslang is `glslangValidator`, with the flags that help it with old sources
//! (`--auto-map-locations --auto-map-bindings -R`). Without these programs on the path, their rows are left
//! out. Those two translate each stage alone, so their stages need not fit together; glisten links them first.

#![expect(clippy::print_stdout, reason = "an example prints")]

use glisten::emit::{Conventions, Emitted, Target, emit};
use glisten::{Compiler, Options, Source, Stage};
use naga::valid::{Capabilities, ValidationFlags, Validator};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// The files of a program: vertex and fragment.
type Pair = [PathBuf; 2];

/// A translator: its name, whether it is installed, and whether it brings a program to WGSL.
type Row<'a> = (&'static str, bool, &'a dyn Fn(&Pair) -> bool);

fn main() {
    let folders: Vec<String> = std::env::args().skip(1).collect();
    let pairs: Vec<Pair> = folders.iter().flat_map(|folder| pairs(Path::new(folder))).collect();
    let is_there = |program: &str| Command::new(program).arg("--version").stdout(Stdio::null()).status().is_ok();
    let naga = is_there("naga");
    let glslang = naga && is_there("glslangValidator");
    println!("{} programs", pairs.len());
    let rows: [Row<'_>; 3] = [
        ("glisten", true, &by_glisten),
        ("naga (GLSL front end)", naga, &|pair| by_stage(pair, by_naga)),
        ("glslang, then naga", glslang, &|pair| by_stage(pair, by_glslang)),
    ];
    for (name, _, accepts) in rows.iter().filter(|(_, there, _)| *there) {
        let count = pairs.iter().filter(|pair| accepts(pair)).count();
        println!("{name:24} {count:4} to WGSL");
    }
}

/// The programs in a folder and below it.
fn pairs(folder: &Path) -> Vec<Pair> {
    let mut by_stem: BTreeMap<PathBuf, [Option<PathBuf>; 2]> = BTreeMap::new();
    for entry in ignore::WalkBuilder::new(folder).build().filter_map(Result::ok) {
        let path = entry.path();
        let stage = match path.extension().and_then(|extension| extension.to_str()) {
            Some("vert") => 0,
            Some("frag") => 1,
            _ => continue,
        };
        by_stem.entry(path.with_extension("")).or_default()[stage] = Some(path.to_owned());
    }
    by_stem.into_values().filter_map(|[vertex, fragment]| Some([vertex?, fragment?])).collect()
}

fn text(path: &Path) -> String {
    String::from_utf8_lossy(&std::fs::read(path).unwrap_or_default()).into_owned()
}

fn by_glisten(pair: &Pair) -> bool {
    let source = |path: &Path, stage| Source { name: path.display().to_string(), text: text(path).into(), stage };
    let [vertex, fragment] = pair;
    let sources = [source(vertex, Stage::Vertex), source(fragment, Stage::Fragment)];
    let Some(program) = Compiler::new(Options::default()).compile(&sources).program else { return false };
    [Stage::Vertex, Stage::Fragment].into_iter().all(|stage| {
        match emit(&program, stage, Target::Wgsl, &Conventions::default()) {
            Ok(Emitted::Text(text)) => naga::front::wgsl::parse_str(&text).is_ok_and(|module| is_valid(&module)),
            _ => false,
        }
    })
}

fn by_stage(pair: &Pair, accepts: fn(&Path, Stage) -> bool) -> bool {
    accepts(&pair[0], Stage::Vertex) && accepts(&pair[1], Stage::Fragment)
}

fn by_naga(path: &Path, stage: Stage) -> bool {
    let Ok(folder) = tempfile::tempdir() else { return false };
    // The program tells the stage by the ending.
    let input = folder.path().join(if stage == Stage::Vertex { "in.vert" } else { "in.frag" });
    std::fs::copy(path, &input).is_ok() && naga_to_wgsl(&input, folder.path())
}

fn by_glslang(path: &Path, stage: Stage) -> bool {
    let Ok(folder) = tempfile::tempdir() else { return false };
    let output = folder.path().join("out.spv");
    let run = Command::new("glslangValidator")
        .args(["-V", "-R", "--auto-map-locations", "--auto-map-bindings", "-S"])
        .arg(if stage == Stage::Vertex { "vert" } else { "frag" })
        .arg("-o")
        .args([&output, path])
        .stdout(Stdio::null())
        .status();
    run.is_ok_and(|status| status.success()) && naga_to_wgsl(&output, folder.path())
}

fn naga_to_wgsl(input: &Path, folder: &Path) -> bool {
    let output = folder.join("out.wgsl");
    let run = Command::new("naga").args([input, &output]).stdout(Stdio::null()).stderr(Stdio::null()).status();
    run.is_ok_and(|status| status.success()) && output.exists()
}

fn is_valid(module: &naga::Module) -> bool {
    Validator::new(ValidationFlags::all(), Capabilities::all()).validate(module).is_ok()
}
