//! kill -9 at any moment: each command that writes files leaves whole ones alone, and its next run makes all of them.
//!
//! `KILLS=500 cargo test --all-features killed` kills each command as often as that; by default it is a few times.

use crate::cache::files;
use crate::cli::{Folder, code, err};
use std::collections::BTreeMap;
use std::env;
use std::io::Write;
use std::os::unix::process::ExitStatusExt;
use std::process::Stdio;
use std::thread;
use std::time::{Duration, Instant};

type Tree = BTreeMap<String, Vec<u8>>;

const MESSY_VERTEX: &[u8] = b"#version 150\nin vec4 p;out vec2 q;void main(){q=p.xy;gl_Position=p;}\n";
const MESSY: &[u8] =
    b"#version 150\nin vec2 q;out vec4 c;uniform float k;\nvoid main(){float u=2.0;float s=pow(q.x,2.0);c=vec4(s*k);}\n";
const OLD_VERTEX: &[u8] =
    b"attribute vec4 p; varying vec2 q; void main() { q = p.xy; gl_Position = gl_ModelViewMatrix * p; }\n";
const OLD: &[u8] = b"varying vec2 q; uniform sampler2D t; void main() { gl_FragColor = texture2D(t, q); }\n";
const SCENE: &[u8] = b"[framebuffer]\nwidth = 96\nheight = 96\n[[draw]]\nvertex = \"a.vert\"\nfragment = \"a.frag\"\n\
    primitive = \"triangles\"\n[draw.attributes]\np = { size = 3, values = [-1, -1, 0, 3, -1, 0, -1, 3, 0] }\n\
    [draw.uniforms]\nk = 0.5\n";

/// Commands that write files of their own into `out`, or change those that they read.
const COMMANDS: &[&[&str]] = &[
    &["compile", "a.vert", "a.frag", "-o", "out", "--depfile", "out/d", "--manifest", "out/m.json"],
    &["compile", "a.vert", "a.frag", "-o", "out", "--cache", "kept", "--target", "wgsl", "--target", "msl"],
    &["lint", "a.vert", "a.frag", "--fix", "--no-cache"],
    &["lint", "a.frag", "--baseline", "out.json", "--update-baseline", "--no-cache"],
    &["fmt"],
    &["upgrade", "old/a.vert", "old/a.frag", "--in-place"],
    &["upgrade", "old/a.vert", "old/a.frag", "-o", "out"],
    &["port", "--for", "wgpu", "old", "-o", "out"],
    &["specialize", "a.toml", "-o", "out"],
    &["new-scene", "a.vert", "a.frag", "-o", "out.toml"],
    &["render", "a.toml", "--backend", "cpu", "-o", "out.png"],
    &["render", "a.toml", "-o", "out.exr"],
    &["verify", "a.toml", "--difference", "out.png", "--evidence", "out2.png"],
    &["stability", "a.toml", "-o", "out"],
    &["play", "--export", "out.html", "a.toml"],
    &["man", "-o", "out"],
];

fn project() -> Folder {
    Folder::new(&[
        ("a.vert", MESSY_VERTEX),
        ("a.frag", MESSY),
        ("a.toml", SCENE),
        ("old/a.vert", OLD_VERTEX),
        ("old/a.frag", OLD),
    ])
}

/// All files but those of the cache, which has tests of its own.
fn tree(folder: &Folder) -> Tree {
    files(&folder.path("")).into_iter().filter(|(name, _)| !name.starts_with("kept/")).collect()
}

/// The names of temporary files and folders begin with this.
fn is_temporary(name: &str) -> bool {
    name.split('/').any(|part| part.starts_with(".glisten-"))
}

/// Whether a file is one of a tree. A page tells how long the machine drew, so that only its end can be compared.
fn is_of(tree: &Tree, name: &str, bytes: &[u8]) -> bool {
    let end = |bytes: &[u8]| bytes.trim_ascii_end().ends_with(b"</html>");
    tree.get(name).is_some_and(|whole| whole == bytes || (end(whole) && end(bytes)))
}

/// Kills a command after parts of its time, each time in a new folder. Returns how many kills found it at work, and how many there were.
fn kills(words: &[&str]) -> (u32, u32) {
    let kills = env::var("KILLS").ok().and_then(|text| text.parse().ok()).unwrap_or(12_u32);
    let folder = project();
    let before = tree(&folder);
    let start = Instant::now();
    let run = folder.run(words);
    let time = start.elapsed();
    let (code_of_whole, whole) = (code(&run), tree(&folder));
    assert!(whole != before && code_of_whole < 2, "{words:?} writes nothing: {}", err(&run));
    let mut at_work = 0;
    for kill in 1..=kills {
        let folder = project();
        let delay = time * kill / (kills + 1);
        let mut child = folder.command(words).stdout(Stdio::null()).stderr(Stdio::null()).spawn().expect("it starts");
        thread::sleep(delay);
        // SIGKILL: nothing of the program runs any more.
        child.kill().expect("killed, or done");
        let ended = child.wait().expect("it has ended");
        at_work += u32::from(ended.signal() == Some(9));
        for (name, bytes) in tree(&folder) {
            let is_whole = [&before, &whole].iter().any(|tree| is_of(tree, &name, &bytes));
            assert!(is_whole || is_temporary(&name), "{words:?}: after {delay:?} `{name}` is not whole");
        }
        let run = folder.run(words);
        // What makes a new folder refuses one that is there; it was made whole then.
        let left = tree(&folder);
        let names = |tree: &Tree| tree.keys().cloned().collect::<Vec<_>>();
        assert_eq!(names(&left), names(&whole), "{words:?}: after a kill at {delay:?} and another run: {}", err(&run));
        let differs = left.iter().find(|(name, bytes)| !is_of(&whole, name, bytes));
        assert!(differs.is_none(), "{words:?}: after a kill at {delay:?} another run makes another {differs:?}");
    }
    (at_work, kills)
}

#[test]
fn killed_commands_leave_whole_files_and_the_next_run_makes_all() {
    let counts: Vec<(u32, u32)> = COMMANDS.iter().map(|words| kills(words)).collect();
    let (at_work, all) = counts.iter().fold((0, 0), |sum, one| (sum.0 + one.0, sum.1 + one.1));
    // The test harness does not capture this: how much was checked must be visible.
    writeln!(std::io::stderr(), "{at_work} of {all} kills found a command at work")
        .expect("standard error can be written to");
    assert!(at_work * 3 > all, "only {at_work} of {all} kills found a command at work");
}

/// A process that draws for a killed one ends, too.
#[cfg(target_os = "linux")]
#[test]
fn nothing_goes_on_after_a_killed_command() {
    let folder = project();
    let mut child =
        folder.command(&["verify", "a.toml"]).stdout(Stdio::null()).stderr(Stdio::null()).spawn().expect("it starts");
    let children = || {
        let id = child.id();
        let text = std::fs::read_to_string(format!("/proc/{id}/task/{id}/children")).unwrap_or_default();
        text.split_whitespace().map(str::to_owned).collect::<Vec<_>>()
    };
    let start = Instant::now();
    while children().is_empty() && start.elapsed() < Duration::from_secs(60) {
        thread::sleep(Duration::from_millis(1));
    }
    let workers = children();
    child.kill().expect("it is killed");
    child.wait().expect("it has ended");
    let lives = |worker: &String| {
        std::fs::read_to_string(format!("/proc/{worker}/stat")).is_ok_and(|stat| !stat.contains(") Z"))
    };
    let start = Instant::now();
    while workers.iter().any(lives) && start.elapsed() < Duration::from_secs(60) {
        thread::sleep(Duration::from_millis(10));
    }
    assert!(!workers.iter().any(lives), "a process still draws for one that was killed");
}
