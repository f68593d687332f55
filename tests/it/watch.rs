//! `glisten watch`: the command runs again after a change, and not after what it writes itself.

use std::fs;
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::Duration;

/// Ends the program when the test ends, however it does.
struct Running(Child);

impl Drop for Running {
    fn drop(&mut self) {
        // It may have ended on its own.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// Starts a command; its lines of both streams arrive as they are written.
fn start(folder: &Path, arguments: &[&str]) -> (Running, Receiver<String>) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_glisten"));
    command.current_dir(folder).arg("watch").args(arguments).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().expect("the program starts");
    let (sender, lines) = channel();
    let output = child.stdout.take().expect("it is piped");
    let messages = child.stderr.take().expect("it is piped");
    let other = sender.clone();
    std::thread::spawn(move || {
        BufReader::new(output).lines().map_while(Result::ok).all(|line| sender.send(line).is_ok())
    });
    std::thread::spawn(move || {
        BufReader::new(messages).lines().map_while(Result::ok).all(|line| other.send(line).is_ok())
    });
    (Running(child), lines)
}

/// Waits for a line with a text.
fn wait_for(lines: &Receiver<String>, text: &str) {
    let mut seen = Vec::new();
    loop {
        match lines.recv_timeout(Duration::from_secs(60)) {
            Ok(line) if line.contains(text) => return,
            Ok(line) => seen.push(line),
            Err(_) => panic!("no line with `{text}`: {seen:#?}"),
        }
    }
}

#[test]
fn a_command_runs_again_after_a_change() {
    let folder = tempfile::tempdir().expect("a folder");
    let shader = folder.path().join("a.frag");
    let good = "#version 150\nout vec4 c;\nvoid main() { c = vec4(1.0); }\n";
    fs::write(&shader, good).expect("the folder can be written to");
    let (running, lines) = start(folder.path(), &["compile", "a.frag", "-o", "out", "--target", "wgsl"]);
    wait_for(&lines, "OK. Watching `.`");
    assert!(folder.path().join("out/a.frag.wgsl").is_file());
    // What it has just written starts nothing.
    assert!(lines.recv_timeout(Duration::from_millis(400)).is_err());
    fs::write(&shader, good.replace("1.0", "missing")).expect("the folder can be written to");
    wait_for(&lines, "a.frag changed");
    wait_for(&lines, "`missing` is not declared");
    wait_for(&lines, "Errors. Watching `.`");
    fs::write(&shader, good).expect("the folder can be written to");
    wait_for(&lines, "OK. Watching `.`");
    drop(running);
}

/// The file that the output is redirected to is in the folder that is watched.
#[cfg(unix)]
#[test]
fn a_redirected_output_starts_nothing() {
    let folder = tempfile::tempdir().expect("a folder");
    let shader = folder.path().join("a.frag");
    fs::write(&shader, "#version 150\nvoid main() {}\n").expect("the folder can be written to");
    let log = folder.path().join("log.txt");
    let (output, messages) = (fs::File::create(&log), fs::OpenOptions::new().append(true).open(&log));
    let mut command = Command::new(env!("CARGO_BIN_EXE_glisten"));
    command.current_dir(folder.path()).args(["watch", "lint", "."]);
    command.stdout(output.expect("a file")).stderr(messages.expect("a file"));
    let running = Running(command.spawn().expect("the program starts"));
    let runs = || fs::read_to_string(&log).expect("it is there").matches("Watching").count();
    let wait = |count: usize| {
        let start = std::time::Instant::now();
        while runs() < count {
            assert!(start.elapsed() < Duration::from_secs(60), "{:?}", fs::read_to_string(&log));
            std::thread::sleep(Duration::from_millis(50));
        }
    };
    wait(1);
    std::thread::sleep(Duration::from_millis(1000));
    assert_eq!(runs(), 1, "{:?}", fs::read_to_string(&log));
    fs::write(&shader, "#version 150\nvoid main() { }\n").expect("the folder can be written to");
    wait(2);
    drop(running);
}

/// Files that a command reads need not be in the folders that it names.
#[test]
fn files_elsewhere_are_watched() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name);
    let write = |name: &str, text: &str| {
        fs::create_dir_all(path(name).parent().expect("it is in the folder")).expect("a folder");
        fs::write(path(name), text).expect("the folder can be written to");
    };
    let shader = "#version 150\n#include \"../common/.own/h.glsl\"\nout vec4 c;\nvoid main() { c = vec4(gray()); }\n";
    write("p/sub/a.frag", shader);
    let (running, lines) = start(&path("p"), &["lint", "sub"]);
    wait_for(&lines, "Errors. Watching `sub`");
    write("p/sub/other.txt", "");
    wait_for(&lines, "Errors. Watching `sub`");
    // The include comes into being, with its folder; the search of it ends at a folder that is there.
    write("p/common/.own/h.glsl", "float gray() { return 0.5; }\n");
    write("p/sub/a.frag", &format!("{shader}\n"));
    wait_for(&lines, "OK. Watching `sub` and 1 file elsewhere");
    for (name, text, seen, ended) in [
        ("p/common/.own/h.glsl", "float gray() { return missing; }\n", "h.glsl changed", "Errors."),
        ("p/common/.own/h.glsl", "float gray() { return 1.0; }\n", "h.glsl changed", "OK."),
        // Above the folder of the command, and new.
        (
            "glisten.toml",
            "[lint]\ndeny = [\"L0013\"]\n",
            "glisten.toml changed",
            "Watching `sub` and 2 files elsewhere",
        ),
        ("p/glisten.toml", "[lint]\nwrong = 1\n", "glisten.toml changed", "Errors."),
    ] {
        write(name, text);
        wait_for(&lines, seen);
        wait_for(&lines, ended);
    }
    write("p/common/.own/unread.glsl", "");
    write("p/common/.own/h.glsl~", "");
    assert!(lines.recv_timeout(Duration::from_millis(400)).is_err(), "nothing reads them");
    drop(running);
}

/// The shaders of a scene, its pictures, and what a changed scene reads instead.
#[test]
fn files_of_scenes_are_watched() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name);
    for name in ["scenes", "shaders", "more"] {
        fs::create_dir(path(name)).expect("a folder");
    }
    let fragment = "#version 150\nout vec4 c;\nvoid main() { c = vec4(1.0); }\n";
    fs::write(path("shaders/a.frag"), fragment).expect("written");
    fs::write(path("more/a.frag"), fragment).expect("written");
    let vertex = "#version 150\nin vec4 p;\nvoid main() { gl_Position = p; }\n";
    fs::write(path("scenes/a.vert"), vertex).expect("written");
    let scene = "[framebuffer]\nwidth = 4\nheight = 4\n[[draw]]\nvertex = \"a.vert\"\nfragment = \"../shaders/a.frag\"\n\
                 [draw.attributes]\np = { size = 2, values = [-1, -1, 3, -1, -1, 3] }\n";
    fs::write(path("scenes/s.toml"), scene).expect("written");
    let arguments = ["render", "scenes/s.toml", "--backend", "cpu", "-o", "out.png"];
    let (running, lines) = start(folder.path(), &arguments);
    wait_for(&lines, "OK. Watching `scenes` and 1 file elsewhere");
    fs::write(path("shaders/a.frag"), fragment.replace("1.0", "0.5")).expect("written");
    wait_for(&lines, "a.frag changed");
    wait_for(&lines, "OK. Watching");
    fs::write(path("scenes/s.toml"), scene.replace("shaders", "more")).expect("written");
    wait_for(&lines, "s.toml changed");
    wait_for(&lines, "OK. Watching");
    fs::write(path("shaders/a.frag"), fragment).expect("written");
    assert!(lines.recv_timeout(Duration::from_millis(400)).is_err(), "it is read no more");
    fs::write(path("more/a.frag"), "#version 150\n").expect("written");
    wait_for(&lines, "a.frag changed");
    wait_for(&lines, "Errors. Watching");
    drop(running);
}

#[test]
fn only_commands_are_watched() {
    let run = |arguments: &[&str]| {
        let run = Command::new(env!("CARGO_BIN_EXE_glisten")).arg("watch").args(arguments).output().expect("it starts");
        (run.status.code(), String::from_utf8_lossy(&run.stderr).into_owned())
    };
    let (code, told) = run(&["lnit", "."]);
    assert!(code == Some(2) && told.contains("did you mean `lint`?"), "{told}");
    assert_eq!(run(&["watch", "lint"]).0, Some(2));
    assert_eq!(run(&[]).0, Some(2));
    let (code, told) = run(&["compile", "nowhere.vert"]);
    assert!(code == Some(2) && told.contains("--output"), "{told}");
    for arguments in [
        &["lint", "nowhere"][..],
        &["render", "nowhere.toml", "-o", "a.png"],
        &["verify", "nowhere.toml"],
        &["test", "nowhere"],
    ] {
        let (code, told) = run(arguments);
        assert!(code == Some(2) && told.contains("it does not exist"), "{arguments:?}: {told}");
    }
}
