//! The speed of the front end: parsing alone, and parsing with analysis and link, over the fixtures and over one text
//! of growing size. `cargo bench --bench frontend`; figures are bytes per second.
//!
//! Two further figures come first: the time per byte from 10 KB to 5 MB of legal text, which must not grow with the
//! size, and the peak memory on 1 MB next to glslangValidator's, if that is installed (on Linux).
//!
//! Measured in user time on one core of a small, busy virtual machine: parsing 26 MB/s, the whole front end 15 MB/s,
//! both the same from 10 KB to 5 MB. No function takes more than a ninth of the time.

#![expect(clippy::print_stdout, reason = "a benchmark prints its figures")]

use divan::counter::BytesCount;
use divan::{Bencher, black_box};
use glisten_front::diagnostic::Diagnostics;
use glisten_front::hir::Stage;
use glisten_front::source::{NoIncludes, SourceMap};
use glisten_front::{Compiler, Options, Source, syntax};
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if let [flag, path] = arguments.as_slice()
        && flag == "--peak"
    {
        compile_once(Path::new(path));
        println!("{}", high_water(std::process::id()).unwrap_or(0));
        return;
    }
    if arguments.iter().any(|argument| argument == "--bench") {
        time_a_byte();
        peak_memory();
    }
    divan::main();
}

const SIZES: [usize; 4] = [10_000, 100_000, 1_000_000, 5_000_000];

/// The processor time of this thread in nanoseconds, which hardly depends on the machine's other load. On Linux;
/// elsewhere it is the time of the clock.
fn processor_time(since: Instant) -> f64 {
    let schedule = fs::read_to_string("/proc/thread-self/schedstat").ok();
    let own = schedule.and_then(|line| line.split_whitespace().next()?.parse().ok());
    own.unwrap_or_else(|| since.elapsed().as_secs_f64() * 1e9)
}

/// The time of a run in nanoseconds: the smallest mean of three rounds, each long enough for the scheduler's
/// accounting.
fn least(runs: usize, mut work: impl FnMut()) -> f64 {
    let since = Instant::now();
    let time = |_| {
        let start = processor_time(since);
        (0..runs).for_each(|_| work());
        (processor_time(since) - start) / runs as f64
    };
    (0..3).map(time).fold(f64::MAX, f64::min)
}

fn time_a_byte() {
    let compiler = Compiler::new(Options::default());
    let mut whole = Vec::new();
    println!("legal text: nanoseconds a byte, megabytes a second");
    for bytes in SIZES {
        let text = large(bytes);
        let length = text.len() as f64;
        let runs = (5_000_000 / bytes).max(1);
        let parsing = least(runs, || {
            black_box(parse("large.frag", &text, Stage::Fragment));
        });
        let compiling = least(runs, || {
            let source = Source { name: "large.frag".into(), text: text.as_str().into(), stage: Stage::Fragment };
            black_box(compiler.compile(&[source]));
        });
        whole.push(compiling / length);
        let line = |what: &str, time: f64| format!("{what} {:6.1} ns {:6.1} MB/s", time / length, length * 1e3 / time);
        println!("{bytes:>9} bytes: {}, {}", line("parse", parsing), line("parse, analysis and link", compiling));
    }
    let (low, high) = whole.iter().fold((f64::MAX, 0.0_f64), |(low, high), &time| (low.min(time), high.max(time)));
    println!("the dearest byte costs {:.2} times the cheapest", high / low);
}

fn compile_once(path: &Path) {
    let text = fs::read_to_string(path).expect("the text was written");
    let source = Source { name: "large.frag".into(), text: text.into(), stage: Stage::Fragment };
    black_box(Compiler::new(Options::default()).compile(&[source]));
}

/// The peak memory of a process in KiB.
fn high_water(process: u32) -> Option<u64> {
    let status = fs::read_to_string(format!("/proc/{process}/status")).ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    line.trim().strip_suffix("kB")?.trim().parse().ok()
}

fn peak_memory() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("large.frag");
    fs::write(&path, large(1_000_000)).expect("room for a megabyte");
    let own = std::env::current_exe().and_then(|program| Command::new(program).arg("--peak").arg(&path).output());
    let own: Option<u64> = own.ok().and_then(|output| String::from_utf8(output.stdout).ok()?.trim().parse().ok());
    let peer = watch(Command::new("glslangValidator").arg(&path));
    match (own, peer) {
        (Some(own), Some(peer)) if own > 0 => {
            println!(
                "peak of memory on 1 MB: {own} KiB, glslangValidator {peer} KiB, ratio {:.2}",
                own as f64 / peer as f64
            );
        }
        (Some(own), None) if own > 0 => {
            println!("peak of memory on 1 MB: {own} KiB; no glslangValidator to compare with")
        }
        _ => println!("peak of memory: only on Linux"),
    }
}

/// Runs a program and polls its peak memory until it ends; memory allocated in its last millisecond may be missed.
fn watch(command: &mut Command) -> Option<u64> {
    let mut child = command.stdout(Stdio::null()).spawn().ok()?;
    let mut peak = None;
    while let Ok(None) = child.try_wait() {
        peak = high_water(child.id()).or(peak);
        std::thread::sleep(Duration::from_millis(1));
    }
    peak
}

/// All programs of the fixtures: name, text and stage.
fn programs() -> Vec<(String, String, Stage)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/programs");
    let mut list: Vec<_> = fs::read_dir(folder)
        .expect("the fixtures are there")
        .filter_map(|entry| {
            let path = entry.expect("a folder entry").path();
            let stage = match path.extension()?.to_str()? {
                "vert" => Stage::Vertex,
                "frag" => Stage::Fragment,
                "geom" => Stage::Geometry,
                _ => return None,
            };
            Some((path.to_string_lossy().into_owned(), fs::read_to_string(&path).expect("readable"), stage))
        })
        .collect();
    list.sort();
    list
}

/// One shader of about `bytes` bytes: many functions of ordinary statements.
fn large(bytes: usize) -> String {
    let mut text = String::from("#version 150\nuniform vec4 tint;\nout vec4 color;\n");
    let mut number = 0;
    while text.len() < bytes {
        text.push_str(&format!(
            "// Weighs the light of step {number}.\nvec3 shade{number}(vec3 normal, vec3 light, float power) {{\n    \
             vec3 h = normalize(normal + light * 0.5);\n    float s = max(dot(normal, h), 0.0);\n    \
             for (int i = 0; i < 4; i++) {{\n        if (s > 0.25 && power > 1.0) s += pow(s, power) * {number}.0e-3;\n    \
             }}\n    return tint.rgb * s + vec3(0.1, 0.2, 0.3);\n}}\n"
        ));
        number += 1;
    }
    text.push_str("void main() { color = vec4(shade0(vec3(1.0), vec3(0.0, 1.0, 0.0), 8.0), 1.0); }\n");
    text
}

fn parse(name: &str, text: &str, stage: Stage) -> usize {
    let mut sources = SourceMap::default();
    let mut diagnostics = Diagnostics::default();
    let file = sources.add(name, text).expect("room");
    let completion = glisten_front::source::Completion::default();
    let options = syntax::ParseOptions { stage, defines: Vec::new(), strict: false, completion };
    let tree = syntax::parse(&mut sources, file, &options, &NoIncludes, &mut diagnostics);
    assert!(!diagnostics.has_errors(), "{name}");
    tree.exprs.len()
}

#[divan::bench]
fn parse_programs(bencher: Bencher<'_, '_>) {
    let programs = programs();
    let bytes: usize = programs.iter().map(|(_, text, _)| text.len()).sum();
    bencher.counter(BytesCount::new(bytes)).bench_local(|| {
        for (name, text, stage) in &programs {
            black_box(parse(name, text, *stage));
        }
    });
}

#[divan::bench]
fn compile_programs(bencher: Bencher<'_, '_>) {
    let programs = programs();
    let bytes: usize = programs.iter().map(|(_, text, _)| text.len()).sum();
    let compiler = Compiler::new(Options::default());
    bencher.counter(BytesCount::new(bytes)).bench_local(|| {
        for (name, text, stage) in &programs {
            let source = Source { name: name.clone(), text: text.as_str().into(), stage: *stage };
            black_box(compiler.compile(&[source]));
        }
    });
}

#[divan::bench(args = [10_000, 100_000, 1_000_000, 5_000_000], sample_count = 10)]
fn parse_large(bencher: Bencher<'_, '_>, bytes: usize) {
    let text = large(bytes);
    bencher.counter(BytesCount::new(text.len())).bench_local(|| black_box(parse("large.frag", &text, Stage::Fragment)));
}

#[divan::bench(args = [10_000, 100_000, 1_000_000], sample_count = 10)]
fn compile_large(bencher: Bencher<'_, '_>, bytes: usize) {
    let text = large(bytes);
    let compiler = Compiler::new(Options::default());
    bencher.counter(BytesCount::new(text.len())).bench_local(|| {
        let source = Source { name: "large.frag".into(), text: text.as_str().into(), stage: Stage::Fragment };
        black_box(compiler.compile(&[source]))
    });
}
