//! Drivers that crash: the error names the driver and the scene, a scan goes on, and signals reach the process that draws.
//!
//! A crash is made by `kill -ABRT` of the process that draws: that is how a driver ends that calls `abort`. (Rust catches the first `SEGV`.)

use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

/// The processor time, in the system's ticks (100 a second), after which the driver's threads can only be at the slow code: all else is
/// done in less.
const AT_WORK: u64 = 200;
/// How long to wait for that.
const PATIENCE: Duration = Duration::from_secs(300);

/// Code that a driver works at for a minute in a picture of a million pixels. Mesa ends all loops of an invocation after 65,535 steps.
const SLOW: &str = "#version 150\nuniform int n = 60000; out vec4 c;\nvoid main() { float k = gl_FragCoord.x; \
                    for (int i = 0; i < n; i++) k = fract(sin(k) * 1.37 + cos(k + float(i))); c = vec4(k); }\n";
const WHOLE: &str = "#version 150\nin vec4 piglit_vertex; void main() { gl_Position = piglit_vertex; }\n";

fn start(arguments: &[&str], folder: &Path) -> Child {
    let mut command = Command::new(env!("CARGO_BIN_EXE_glisten"));
    command.args(arguments).current_dir(folder).stdout(Stdio::piped()).stderr(Stdio::piped());
    command.spawn().expect("the program runs")
}

/// The process that draws for this one; it has none if that draws by itself.
fn worker(child: &Child) -> Option<String> {
    let id = child.id();
    let workers = fs::read_to_string(format!("/proc/{id}/task/{id}/children")).ok()?;
    workers.split_whitespace().next().map(str::to_owned)
}

/// The processor time of the threads of a process in which Mesa's driver runs shaders.
fn drawing_time(process: &str) -> u64 {
    let Ok(threads) = fs::read_dir(format!("/proc/{process}/task")) else { return 0 };
    let lines = threads.flatten().filter_map(|thread| fs::read_to_string(thread.path().join("stat")).ok());
    let of_driver = lines.filter(|line| line.contains("(llvmpipe-"));
    // After the name, the 12th value is the time in user mode (`man 5 proc`).
    let ticks = of_driver.filter_map(|line| line.rsplit_once(") ")?.1.split(' ').nth(11)?.parse::<u64>().ok());
    ticks.sum()
}

/// Waits until the driver is at the slow code. Returns the process that draws.
fn at_work(child: &Child) -> String {
    let start = Instant::now();
    while start.elapsed() < PATIENCE {
        if let Some(worker) = worker(child).filter(|worker| drawing_time(worker) >= AT_WORK) {
            return worker;
        }
        std::thread::sleep(Duration::from_millis(50));
    }
    panic!("the driver does not come to the slow code");
}

/// Crashes the process that draws as soon as the driver is at the slow code.
fn crashed(arguments: &[&str], folder: &Path) -> Output {
    let child = start(arguments, folder);
    let worker = at_work(&child);
    assert!(Command::new("kill").args(["-ABRT", &worker]).status().expect("kill runs").success());
    child.wait_with_output().expect("it ends")
}

fn folder_with_a_slow_scene() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).expect("the folder is ours");
    write(
        "a.vert",
        "#version 150\nvoid main() { gl_Position = vec4(gl_VertexID % 2 * 4 - 1, gl_VertexID / 2 * 4 - 1, 0, 1); }",
    );
    write("a.frag", SLOW);
    write(
        "a.toml",
        "[framebuffer]\nwidth = 1024\nheight = 1024\n[[draw]]\nvertex = \"a.vert\"\nfragment = \"a.frag\"\n\
         primitive = \"triangles\"\nvertex_count = 3\n[draw.uniforms]\nn = 60000\n",
    );
    folder
}

#[test]
fn a_crash_is_an_error_that_names_the_driver_and_the_scene() {
    let folder = folder_with_a_slow_scene();
    let arguments = ["render", "a.toml", "-o", "a.png", "--adapter", "software"];
    let run = crashed(&arguments, folder.path());
    let told = String::from_utf8_lossy(&run.stderr).into_owned();
    assert_eq!(run.status.code(), Some(3), "{told}");
    assert!(told.contains("crashed (SIGABRT) while drawing `a.toml`"), "{told}");
    assert!(told.contains("error: the driver ") && told.contains("--backend cpu"), "{told}");
    assert!(!folder.path().join("a.png").exists());
}

#[test]
fn a_scan_goes_on_after_a_crash() {
    let folder = tempfile::tempdir().expect("a folder");
    let test = |fragment: &str, rest: &str| {
        format!(
            "[require]\nGLSL >= 1.50\nSIZE 1024 1024\n[vertex shader]\n{WHOLE}[fragment shader]\n{fragment}[test]\n\
             draw rect -1 -1 2 2\n{rest}"
        )
    };
    let quick = "#version 150\nout vec4 c; void main() { c = vec4(0, 1, 0, 1); }\n";
    let probe = "probe all rgba 0.0 1.0 0.0 1.0\n";
    let files = [
        ("1.shader_test", test(quick, probe)),
        ("2.shader_test", test(SLOW, "probe rgba 1 1 0.0 0.0 0.0 0.0\n")),
        ("3.shader_test", test(quick, probe)),
    ];
    for (name, text) in files {
        fs::write(folder.path().join(name), text).expect("the folder is ours");
    }
    let arguments = ["test", ".", "--backend", "gpu", "--adapter", "software", "--timeout", "600", "--format", "json"];
    let run = crashed(&arguments, folder.path());
    let results: Vec<Value> = serde_json::from_slice(&run.stdout).expect("JSON");
    assert_eq!(run.status.code(), Some(1));
    let shown: Vec<&str> = results.iter().map(|row| row["result"].as_str().unwrap_or_default()).collect();
    assert_eq!(shown, ["pass", "fail", "pass"], "{results:?}");
    assert!(results[1]["reason"].as_str().is_some_and(|why| why.contains("crashed (SIGABRT)")), "{results:?}");
}

#[test]
fn a_signal_for_the_program_alone_ends_both_processes() {
    let folder = folder_with_a_slow_scene();
    let mut child = start(&["render", "a.toml", "-o", "a.png", "--adapter", "software"], folder.path());
    let worker = at_work(&child);
    let id = child.id().to_string();
    assert!(Command::new("kill").args(["-TERM", &id]).status().expect("kill runs").success());
    let status = child.wait().expect("it ends");
    assert_eq!(std::os::unix::process::ExitStatusExt::signal(&status), Some(15), "as if it drew by itself");
    let state = fs::read_to_string(format!("/proc/{worker}/status")).unwrap_or_default();
    assert!(state.is_empty() || state.contains("(zombie)"), "the worker outlives the program: {state}");
}
