//! The cache of `compile`: a hit gives the same files and the same diagnostics; whatever a result depends on makes it a miss;
//! a server is used by Bazel's protocol; the same bytes come out wherever and however it runs.

use crate::cli::{Folder, code, err, out};
use std::collections::BTreeMap;
use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::{TcpListener, TcpStream};
use std::path::Path;
use std::sync::{Arc, Mutex};

const VERTEX: &str = "#version 150\n#include <shape.glsl>\n\
    in vec4 p;\nout float v;\nvoid main() { gl_Position = p; v = shape(p.x); }\n";
const FRAGMENT: &str = "#version 150\n#extension GL_NOT_known : enable\nin float v;\nout vec4 c;\nuniform float unused;\n\
    void main() { c = vec4(v, SCALE, 1, 1); if (v == 0.5) c = vec4(0.0); }\n";

pub(crate) fn project() -> Folder {
    let shape = b"float shape(float x) { return x * 2.0; }\n";
    Folder::new(&[("a.vert", VERTEX.as_bytes()), ("a.frag", FRAGMENT.as_bytes()), ("late/shape.glsl", shape)])
}

/// All files below a folder.
pub(crate) fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut files = BTreeMap::new();
    for entry in fs::read_dir(folder).into_iter().flatten().filter_map(Result::ok) {
        let name = entry.file_name().to_string_lossy().into_owned();
        if entry.path().is_dir() {
            let below = self::files(&entry.path());
            files.extend(below.into_iter().map(|(inner, bytes)| (format!("{name}/{inner}"), bytes)));
        } else {
            files.insert(name, fs::read(entry.path()).expect("readable"));
        }
    }
    files
}

/// Compiles with the cache. Returns whether it was a hit, and what was reported.
fn compile(folder: &Folder, more: &[&str]) -> (bool, String) {
    compile_in(folder, more, &[])
}

/// Compiles with the cache and with variables of the environment.
pub(crate) fn compile_in(folder: &Folder, more: &[&str], variables: &[(&str, &Path)]) -> (bool, String) {
    let words =
        ["compile", "a.vert", "a.frag", "-o", "out", "-I", "early", "-I", "late", "-DSCALE=0.5", "--cache", "kept"];
    let run = folder.command(&[&words, more].concat()).envs(variables.iter().copied()).output().expect("it runs");
    assert_eq!(code(&run), 0, "{}", err(&run));
    let text = err(&run);
    let (is_hit, is_miss) = (text.contains("1 of 1 from the cache\n"), text.contains("0 of 1 from the cache\n"));
    assert!(is_hit != is_miss, "{text}");
    (is_hit, text.lines().filter(|line| !line.ends_with("from the cache")).map(|line| format!("{line}\n")).collect())
}

#[test]
fn a_hit_gives_the_same_files_and_diagnostics() {
    let folder = project();
    let more = ["--depfile", "d", "--manifest", "m.json"];
    let (is_hit, told) = compile(&folder, &more);
    assert!(!is_hit && told.contains("warning["), "{told}");
    let rest = || {
        (
            files(&folder.path("out")),
            fs::read(folder.path("d")).expect("d"),
            fs::read(folder.path("m.json")).expect("m"),
        )
    };
    let first = rest();
    fs::remove_dir_all(folder.path("out")).expect("removed");
    assert_eq!(compile(&folder, &more), (true, told));
    assert!(first == rest(), "the files differ");
    let manifest: serde_json::Value = serde_json::from_slice(&first.2).expect("JSON");
    let outputs = manifest["outputs"].as_array().expect("a list");
    assert_eq!(outputs.len(), 5);
    assert_eq!(outputs[0]["file"], "out/a.vert.wgsl");
    let names: Vec<&str> =
        outputs[0]["sources"].as_array().expect("a list").iter().filter_map(|one| one["file"].as_str()).collect();
    assert_eq!(names, ["a.vert", "late/shape.glsl", "a.frag"]);
    // Levels apply to what is recalled, too; JSON is written from it.
    let denied = [
        "compile",
        "a.vert",
        "a.frag",
        "-o",
        "x",
        "-I",
        "early",
        "-I",
        "late",
        "-DSCALE=0.5",
        "--cache",
        "kept",
        "--deny",
        "warnings",
    ];
    let run = folder.run(&denied);
    assert_eq!(code(&run), 1, "{}", err(&run));
    assert!(err(&run).contains("1 of 1 from the cache") && !folder.path("x").exists());
    let json = |more: &[&str]| {
        let words = [
            "compile",
            "a.vert",
            "a.frag",
            "-o",
            "y",
            "-I",
            "early",
            "-I",
            "late",
            "-DSCALE=0.5",
            "-q",
            "--diagnostics",
            "json",
        ];
        err(&folder.run(&[&words, more].concat()))
    };
    assert_eq!(json(&["--cache", "kept"]), json(&["--no-cache"]));
}

#[test]
fn whatever_a_result_depends_on_makes_it_a_miss() {
    let folder = project();
    assert!(!compile(&folder, &[]).0 && compile(&folder, &[]).0);
    let miss = |what: &str, more: &[&str]| {
        assert!(!compile(&folder, more).0, "{what} was taken from the cache");
        assert!(compile(&folder, more).0, "{what} was not kept");
    };
    let old = fs::read_to_string(folder.path("late/shape.glsl")).expect("readable");
    fs::write(folder.path("late/shape.glsl"), old.replace("2.0", "3.0")).expect("written");
    miss("a changed include", &[]);
    fs::create_dir_all(folder.path("early")).expect("made");
    fs::write(folder.path("early/shape.glsl"), old.replace("2.0", "4.0")).expect("written");
    miss("an include that comes first", &[]);
    assert!(fs::read_to_string(folder.path("out/a.vert.wgsl")).expect("written").contains("4.0"));
    fs::remove_file(folder.path("early/shape.glsl")).expect("removed");
    assert!(compile(&folder, &[]).0, "as it was before");
    for more in
        [&["-DMORE"][..], &["-g"], &["--target", "msl"], &["--clip-z", "minus-one-to-one"], &["-O0"], &["--flat"]]
    {
        miss(&format!("{more:?}"), more);
    }
    fs::write(folder.path("p.glsl"), "#define A 1\n").expect("written");
    miss("a prelude", &["--prelude", "p.glsl"]);
    fs::write(folder.path("p.glsl"), "#define A 2\n").expect("written");
    miss("a changed prelude", &["--prelude", "p.glsl"]);
    fs::write(folder.path("glisten.toml"), "[[source]]\ndefines = [\"FROM_TABLE=1\"]\n").expect("written");
    miss("a table of glisten.toml", &[]);
    fs::write(folder.path("glisten.toml"), "[[source]]\ndefines = [\"FROM_TABLE=2\"]\n").expect("written");
    miss("a changed table", &[]);
    fs::remove_file(folder.path("glisten.toml")).expect("removed");
    assert!(compile(&folder, &[]).0, "as it was before");
    fs::write(folder.path("a.frag"), FRAGMENT.replace("0.5", "0.25")).expect("written");
    miss("a changed source", &[]);
}

#[test]
fn errors_are_not_kept_and_stay_errors() {
    let folder = project();
    fs::write(folder.path("a.frag"), "#version 150\nvoid main() { x = 1; }\n").expect("written");
    for _ in 0..2 {
        let run = folder.run(&["compile", "a.vert", "a.frag", "-o", "out", "-I", "late", "--cache", "kept"]);
        assert_eq!(code(&run), 1, "{}", err(&run));
        assert!(err(&run).contains("E0301") && err(&run).contains("0 of 1 from the cache"), "{}", err(&run));
    }
    assert!(!folder.path("out").exists());
}

#[test]
fn the_environment_names_a_cache_and_stats_and_clean_know_it() {
    let folder = project();
    let run = |words: &[&str]| {
        let run = folder.command(words).env("GLISTEN_CACHE", "kept").env("GLISTEN_CACHE_LIMIT", "2M").output();
        run.expect("it runs")
    };
    let compiled = run(&["compile", "a.vert", "a.frag", "-o", "out", "-I", "late", "-DSCALE=1"]);
    assert!(err(&compiled).contains("0 of 1 from the cache"), "{}", err(&compiled));
    let stats: serde_json::Value =
        serde_json::from_str(&out(&run(&["cache", "stats", "--format", "json"]))).expect("JSON");
    assert_eq!(
        (stats["results"].as_u64(), stats["outputs"].as_u64(), stats["limit"].as_u64()),
        (Some(2), Some(5), Some(2 << 20))
    );
    assert!(out(&run(&["cache", "stats"])).contains("of 2.0 MiB"));
    assert_eq!(code(&run(&["cache", "clean"])), 0);
    let stats = out(&run(&["cache", "stats", "--format", "json"]));
    assert!(stats.contains("\"bytes\": 0"), "{stats}");
    // What is no cache is not cleaned.
    fs::create_dir_all(folder.path("other/cas/ab")).expect("made");
    fs::write(folder.path("other/cas/ab/mine"), "mine").expect("written");
    assert_eq!(code(&folder.run(&["cache", "clean", "--cache", "other"])), 2);
    assert!(folder.path("other/cas/ab/mine").exists());
    assert_eq!(code(&folder.command(&["cache", "stats"]).env_remove("GLISTEN_CACHE").output().expect("it runs")), 2);
}

#[test]
fn bytes_are_the_same_everywhere() {
    let build = |place: &str, words: &[&str], variables: &[(&str, &str)]| {
        let folder = project();
        fs::create_dir_all(folder.path(place)).expect("made");
        for name in ["a.vert", "a.frag", "late"] {
            fs::rename(folder.path(name), folder.path(place).join(name)).expect("moved");
        }
        fs::write(folder.path(place).join("b.frag"), FRAGMENT).expect("written");
        let all =
            ["compile", "a.vert", "a.frag", "b.frag", "-I", "late", "-DSCALE=0.5", "-o", "out", "--depfile", "out/d"];
        let mut command = folder.command(&[&all, words].concat());
        command.current_dir(folder.path(place)).envs(variables.iter().copied());
        let run = command.output().expect("it runs");
        assert_eq!(code(&run), 0, "{}", err(&run));
        (files(&folder.path(place).join("out")), err(&run))
    };
    let first = build("one", &["-j1"], &[]);
    assert_eq!(first.0.len(), 9);
    for (place, words, variables) in [
        ("one", "-j1", &[][..]),
        ("one", "-j2", &[]),
        ("another/folder with spaces", "-j2", &[]),
        ("one", "-j2", &[("LC_ALL", "tr_TR.UTF-8"), ("LANG", "tr_TR.UTF-8"), ("TZ", "Asia/Tokyo")]),
        ("one", "-j1", &[("LC_ALL", "C")]),
    ] {
        assert!(build(place, &[words], variables) == first, "{place} {words} {variables:?}");
    }
}

/// A server of Bazel's HTTP protocol, with the entries that it has been given.
struct Server {
    address: String,
    entries: Arc<Mutex<BTreeMap<String, Vec<u8>>>>,
}

impl Server {
    fn new() -> Self {
        let listener = TcpListener::bind("127.0.0.1:0").expect("a port");
        let address = format!("http://{}", listener.local_addr().expect("an address"));
        let entries = Arc::new(Mutex::new(BTreeMap::new()));
        let shared = Arc::clone(&entries);
        std::thread::spawn(move || {
            for stream in listener.incoming().map_while(Result::ok) {
                let entries = Arc::clone(&shared);
                std::thread::spawn(move || while answer(&stream, &entries).is_some() {});
            }
        });
        Self { address, entries }
    }
}

/// Answers one request of a connection; `None` at its end.
fn answer(stream: &TcpStream, entries: &Mutex<BTreeMap<String, Vec<u8>>>) -> Option<()> {
    let mut reader = BufReader::new(stream);
    let mut line = String::new();
    reader.read_line(&mut line).ok().filter(|read| *read > 0)?;
    let mut words = line.split_whitespace();
    let (method, path) = (words.next()?.to_owned(), words.next()?.to_owned());
    let mut length = 0;
    loop {
        let mut header = String::new();
        reader.read_line(&mut header).ok()?;
        let header = header.trim().to_ascii_lowercase();
        if header.is_empty() {
            break;
        }
        if let Some(value) = header.strip_prefix("content-length:") {
            length = value.trim().parse().ok()?;
        }
    }
    let mut body = vec![0; length];
    reader.read_exact(&mut body).ok()?;
    let (status, body) = match method.as_str() {
        "PUT" => {
            entries.lock().ok()?.insert(path, body);
            ("200 OK", Vec::new())
        }
        _ => match entries.lock().ok()?.get(&path) {
            Some(bytes) => ("200 OK", bytes.clone()),
            None => ("404 Not Found", Vec::new()),
        },
    };
    let mut stream = stream;
    write!(stream, "HTTP/1.1 {status}\r\nContent-Length: {}\r\n\r\n", body.len()).ok()?;
    stream.write_all(&body).ok()
}

#[test]
fn machines_share_results_through_a_server() {
    let server = Server::new();
    let here = project();
    let (is_hit, told) = compile(&here, &["--remote-cache", &server.address]);
    assert!(!is_hit);
    let paths: Vec<String> = server.entries.lock().expect("entries").keys().cloned().collect();
    assert!(paths.iter().filter(|path| path.starts_with("/ac/")).count() == 2, "{paths:?}");
    assert!(paths.iter().filter(|path| path.starts_with("/cas/")).count() == 5, "{paths:?}");
    let there = project();
    assert_eq!(compile(&there, &["--remote-cache", &server.address]), (true, told));
    assert!(files(&here.path("out")) == files(&there.path("out")), "the files differ");
    assert!(compile(&there, &[]).0, "what a server gives is kept on disk");
    // A server that gives nonsense, and one that is gone.
    for bytes in server.entries.lock().expect("entries").values_mut() {
        *bytes = b"nonsense".to_vec();
    }
    let other = project();
    assert!(!compile(&other, &["--remote-cache", &server.address]).0);
    assert!(files(&here.path("out")) == files(&other.path("out")), "the files differ");
    let gone = project();
    let (is_hit, told) = compile(&gone, &["--remote-cache", "http://127.0.0.1:9"]);
    assert!(!is_hit && told.contains("remote cache `http://127.0.0.1:9`"), "{told}");
    assert!(files(&here.path("out")) == files(&gone.path("out")), "the files differ");
    let wrong = project().run(&["compile", "a.frag", "-o", "out", "--remote-cache", "ftp://host"]);
    assert_eq!(code(&wrong), 2);
}
