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
