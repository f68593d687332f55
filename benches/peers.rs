//! Compares the compiler with libglslang in process, over the same shaders in one run.
//!
//! `cargo bench --bench peers -- [FOLDER...]` runs all shaders in the folders (default: `fixtures/programs` and
//! `fixtures/lower`) that both accept. libglslang's side is `peers/glslang.cpp`, built with `c++` if Debian's
//! `glslang-dev` is installed; otherwise the bench says so and ends. Rounds of the two alternate. Each shader's time
//! is the smallest over all rounds, and the figures are means over the shaders.
//!
//! Then it compares processes: `glisten compile` of one shader with `glslangValidator` followed by `naga` (`cargo
//! install naga-cli`), if those are on the path. They run in turns, and each figure is the median over its rounds. If valgrind is there, it
//! counts their instructions. `GLISTEN=PATH` takes another program than the one that was built for the bench, such as that of the profile
//! `dist`.

#![expect(clippy::print_stdout, reason = "a benchmark prints its figures")]

use glisten_emit::{Conventions, Target, emit};
use glisten_front::hir::Stage;
use glisten_front::{Compiler, Options, Source};
use std::collections::BTreeMap;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Instant;

const ROUNDS: usize = 5;
const REPEATS: usize = 5;

/// Microseconds for the front end alone, and for the whole compilation to the target.
#[derive(Clone, Copy)]
struct Times {
    front: f64,
    whole: f64,
}

impl Times {
    fn least(self, other: Self) -> Self {
        Self { front: self.front.min(other.front), whole: self.whole.min(other.whole) }
    }
}

fn main() {
    in_process();
    processes();
}

fn in_process() {
    let folders: Vec<PathBuf> =
        std::env::args().skip(1).filter(|argument| !argument.starts_with('-')).map(Into::into).collect();
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folders =
        if folders.is_empty() { vec![root.join("fixtures/programs"), root.join("fixtures/lower")] } else { folders };
    let mut shaders = Vec::new();
    folders.iter().for_each(|folder| gather(folder, &mut shaders));
    shaders.sort();
    let Some(driver) = build_driver(root) else {
        println!("libglslang cannot be compared with: install `glslang-dev` and `g++` (Debian)");
        return;
    };
    let (mut peer, mut own) = (BTreeMap::new(), BTreeMap::new());
    for _ in 0..ROUNDS {
        merge(&mut peer, run_driver(&driver, &shaders));
        merge(&mut own, shaders.iter().filter_map(|path| Some((path.clone(), own_times(path)?))).collect());
    }
    let both: Vec<(Times, Times)> = peer.iter().filter_map(|(path, peer)| Some((*own.get(path)?, *peer))).collect();
    let mean = |figure: fn(&(Times, Times)) -> f64| both.iter().map(figure).sum::<f64>() / both.len().max(1) as f64;
    let (front, peer_front) = (mean(|(own, _)| own.front), mean(|(_, peer)| peer.front));
    let (whole, peer_whole) = (mean(|(own, _)| own.whole), mean(|(_, peer)| peer.whole));
    println!("{} shaders that both accept, of {}; microseconds a shader at the mean", both.len(), shaders.len());
    println!(
        "parse, analysis and link {front:8.1}   libglslang's parse          {peer_front:8.1}   ratio {:.3}",
        front / peer_front
    );
    println!(
        "GLSL text to WGSL text   {whole:8.1}   libglslang's GLSL to SPIR-V {peer_whole:8.1}   ratio {:.3}",
        whole / peer_whole
    );
}

/// How often each process runs.
const PROCESS_ROUNDS: usize = 31;

fn processes() {
    let built = option_env!("CARGO_BIN_EXE_glisten").map(str::to_owned);
    let Some(glisten) = std::env::var("GLISTEN").ok().or(built) else { return };
    let folder = tempfile::tempdir().expect("a temporary folder");
    let out = folder.path().display();
    let shader = concat!(env!("CARGO_MANIFEST_DIR"), "/fixtures/programs/blinn_phong.frag");
    let own = format!("{glisten} compile -q --target wgsl {shader} -o {out}");
    let first = format!("glslangValidator -V -R --auto-map-locations --auto-map-bindings {shader} -o {out}/a.spv");
    let second = format!("naga {out}/a.spv {out}/a.wgsl");
    let (mut ours, mut theirs) = (Vec::new(), Vec::new());
    for _ in 0..PROCESS_ROUNDS {
        let (Some(own), Some(first), Some(second)) = (time(&own), time(&first), time(&second)) else {
            println!("processes cannot be compared: `glslangValidator` or `naga` is not on the path");
            return;
        };
        ours.push(own);
        theirs.push(first + second);
    }
    ours.sort_by(f64::total_cmp);
    theirs.sort_by(f64::total_cmp);
    let (ours, theirs) = (ours[PROCESS_ROUNDS / 2], theirs[PROCESS_ROUNDS / 2]);
    println!(
        "glisten compile, ms      {ours:8.1}   glslangValidator and naga   {theirs:8.1}   ratio {:.3}",
        ours / theirs
    );
    let (Some(ours), Some(first), Some(second)) = (instructions(&own), instructions(&first), instructions(&second))
    else {
        println!("instructions are not counted: install `valgrind`");
        return;
    };
    let theirs = first + second;
    println!(
        "the same, million instr. {:8.1}   glslangValidator and naga   {:8.1}   ratio {:.3}",
        ours / 1e6,
        theirs / 1e6,
        ours / theirs
    );
}

/// The milliseconds that a command takes, if it succeeds.
fn time(line: &str) -> Option<f64> {
    let mut words = line.split(' ');
    let start = Instant::now();
    let run = Command::new(words.next()?).args(words).stdout(Stdio::null()).stderr(Stdio::null()).status();
    run.is_ok_and(|status| status.success()).then(|| start.elapsed().as_secs_f64() * 1e3)
}

/// The instructions of a command, by callgrind: unlike times, they do not depend on what else the machine does.
fn instructions(line: &str) -> Option<f64> {
    let count = ["--tool=callgrind", "--callgrind-out-file=/dev/null"];
    let run = Command::new("valgrind").args(count).args(line.split(' ')).stdout(Stdio::null()).output().ok()?;
    let said = String::from_utf8_lossy(&run.stderr).into_owned();
    let collected = said.lines().find_map(|line| line.split_once("Collected : "))?;
    collected.1.trim().parse().ok().filter(|_| run.status.success())
}

fn stage_of(path: &Path) -> Option<Stage> {
    match path.extension()?.to_str()? {
        "vert" => Some(Stage::Vertex),
        "frag" => Some(Stage::Fragment),
        _ => None,
    }
}

fn gather(folder: &Path, shaders: &mut Vec<PathBuf>) {
    let Ok(entries) = std::fs::read_dir(folder) else { return };
    for path in entries.flatten().map(|entry| entry.path()) {
        if path.is_dir() {
            gather(&path, shaders);
        } else if stage_of(&path).is_some() {
            shaders.push(path);
        }
    }
}

fn merge(all: &mut BTreeMap<PathBuf, Times>, round: BTreeMap<PathBuf, Times>) {
    for (path, times) in round {
        all.entry(path).and_modify(|least| *least = least.least(times)).or_insert(times);
    }
}

/// Times one shader; `None` if it is rejected or its target cannot represent it.
fn own_times(path: &Path) -> Option<Times> {
    let text: std::sync::Arc<str> = std::fs::read_to_string(path).ok()?.into();
    let stage = stage_of(path)?;
    let source = Source { name: path.display().to_string(), text, stage };
    let compiler = Compiler::new(Options::default());
    let mut least = Times { front: f64::MAX, whole: f64::MAX };
    for _ in 0..REPEATS {
        let start = Instant::now();
        let compilation = compiler.compile(std::slice::from_ref(&source));
        let front = start.elapsed().as_secs_f64() * 1e6;
        emit(compilation.program.as_ref()?, stage, Target::Wgsl, &Conventions::default()).ok()?;
        least = least.least(Times { front, whole: start.elapsed().as_secs_f64() * 1e6 });
    }
    Some(least)
}

/// Builds libglslang's side; `None` where its library or a C++ compiler is missing.
fn build_driver(root: &Path) -> Option<PathBuf> {
    let driver = root.join("target/peers-glslang");
    std::fs::create_dir_all(root.join("target")).ok()?;
    let libraries = [
        "glslang",
        "MachineIndependent",
        "GenericCodeGen",
        "OSDependent",
        "OGLCompiler",
        "HLSL",
        "glslang-default-resource-limits",
        "SPIRV",
        "SPIRV-Tools-opt",
        "SPIRV-Tools",
        "pthread",
    ];
    let built = Command::new("c++")
        .args(["-O2", "-std=c++17"])
        .arg(root.join("benches/peers/glslang.cpp"))
        .arg("-o")
        .arg(&driver)
        .args(libraries.map(|library| format!("-l{library}")))
        .stderr(Stdio::null())
        .status()
        .is_ok_and(|status| status.success());
    built.then_some(driver)
}

fn run_driver(driver: &Path, shaders: &[PathBuf]) -> BTreeMap<PathBuf, Times> {
    let mut child = Command::new(driver)
        .arg(REPEATS.to_string())
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .expect("the driver was built");
    let list: String = shaders.iter().map(|path| format!("{}\n", path.display())).collect();
    let mut input = child.stdin.take().expect("a pipe");
    let writer = std::thread::spawn(move || input.write_all(list.as_bytes()));
    let output = child.wait_with_output().expect("the driver runs");
    writer.join().expect("the writer ends").expect("the driver reads");
    String::from_utf8_lossy(&output.stdout)
        .lines()
        .filter_map(|line| {
            let mut fields = line.split('\t');
            let path = PathBuf::from(fields.next()?);
            Some((path, Times { front: fields.next()?.parse().ok()?, whole: fields.next()?.parse().ok()? }))
        })
        .collect()
}
