//! The programs that are kept busy: `watch lint`, `play`, `lsp`, and two compilations at once on one cache.
//!
//! *In:* the program. *Out:* [`Subject`]s, each in a folder of its own. *Holds:* [`Subject::edit`] fails unless the answer is about that edit.

use crate::process::Sample;
use serde_json::{Value, json};
use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{self, Receiver};
use std::time::{Duration, Instant};
use tempfile::TempDir;

const SCENE: &str = "[framebuffer]\nwidth = 64\nheight = 64\n\n[[draw]]\nvertex = \"a.vert\"\nfragment = \"a.frag\"\nvertex_count = 3\n\n\
    [draw.uniforms]\nshade = 0.25\n";
const VERTEX: &str = "#version 150\nvoid main() {\n    vec2 p = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);\n\
    \x20   gl_Position = vec4(p, 0.0, 1.0);\n}\n";
/// How long an answer may take.
const PATIENCE: Duration = Duration::from_secs(60);

/// A program that is kept busy.
pub(crate) trait Subject {
    fn name(&self) -> &'static str;
    /// Makes an edit, waits for what the program says about it, and takes it back.
    fn edit(&mut self, number: u64) -> Result<(), String>;
    fn sample(&self) -> Sample;
}

/// Starts a subject.
pub(crate) type Make = fn(&Path) -> Result<Box<dyn Subject>, String>;

/// All of them.
pub(crate) const ALL: [Make; 4] = [
    |program| Ok(Box::new(Watch::new(program)?)),
    |program| Ok(Box::new(Play::new(program)?)),
    |program| Ok(Box::new(Lsp::new(program)?)),
    |program| Ok(Box::new(Cache::new(program)?)),
];

/// A mistake that no other edit has.
fn mistake(number: u64) -> String {
    format!("missing_{number}_")
}

fn fragment(color: &str) -> String {
    format!(
        "#version 150\nuniform float shade;\nout vec4 color;\nvoid main() {{\n    color = vec4({color}, 0.5, 1.0, 1.0);\n}}\n"
    )
}

fn told(error: impl std::fmt::Display) -> String {
    error.to_string()
}

fn folder() -> Result<TempDir, String> {
    let folder = tempfile::tempdir().map_err(told)?;
    for (name, text) in [("a.toml", SCENE), ("a.vert", VERTEX), ("a.frag", &fragment("shade"))] {
        fs::write(folder.path().join(name), text).map_err(told)?;
    }
    Ok(folder)
}

/// A process that ends with its owner.
struct Running(Child);

impl Drop for Running {
    fn drop(&mut self) {
        // It may have ended on its own.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// The lines of outputs, each read by a thread.
fn lines(outputs: Vec<Box<dyn Read + Send>>) -> Receiver<String> {
    let (sender, lines) = mpsc::channel();
    for output in outputs {
        let sender = sender.clone();
        std::thread::spawn(move || {
            for line in BufReader::new(output).lines().map_while(Result::ok) {
                if sender.send(line).is_err() {
                    break;
                }
            }
        });
    }
    lines
}

/// Waits for a line with this text.
fn wait_for(lines: &Receiver<String>, text: &str) -> Result<(), String> {
    let begun = Instant::now();
    while let Some(left) = PATIENCE.checked_sub(begun.elapsed()) {
        match lines.recv_timeout(left) {
            Ok(line) if line.contains(text) => return Ok(()),
            Ok(_) => {}
            Err(_) => break,
        }
    }
    Err(format!("nothing was said about `{text}`"))
}

/// `glisten watch lint .`
struct Watch {
    running: Running,
    lines: Receiver<String>,
    folder: TempDir,
}

impl Watch {
    fn new(program: &Path) -> Result<Self, String> {
        let folder = folder()?;
        let mut command = Command::new(program);
        command.current_dir(folder.path()).args(["watch", "lint", "."]).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn().map_err(told)?;
        let outputs: [Option<Box<dyn Read + Send>>; 2] =
            [child.stdout.take().map(|pipe| Box::new(pipe) as _), child.stderr.take().map(|pipe| Box::new(pipe) as _)];
        let lines = lines(outputs.into_iter().flatten().collect());
        std::thread::sleep(Duration::from_secs(1));
        Ok(Self { running: Running(child), lines, folder })
    }
}

impl Subject for Watch {
    fn name(&self) -> &'static str {
        "`watch lint`"
    }

    fn edit(&mut self, number: u64) -> Result<(), String> {
        let (file, mistake) = (self.folder.path().join("a.frag"), mistake(number));
        fs::write(&file, fragment(&mistake)).map_err(told)?;
        let said = wait_for(&self.lines, &mistake);
        fs::write(&file, fragment("shade")).map_err(told)?;
        said
    }

    fn sample(&self) -> Sample {
        Sample::of(self.running.0.id())
    }
}

/// `glisten play .`, asked as its page asks.
struct Play {
    running: Running,
    port: u16,
    token: String,
    _folder: TempDir,
}

impl Play {
    fn new(program: &Path) -> Result<Self, String> {
        let folder = folder()?;
        let mut command = Command::new(program);
        command.current_dir(folder.path()).args(["play", "."]).stdout(Stdio::piped()).stderr(Stdio::null());
        let mut child = command.spawn().map_err(told)?;
        let mut line = String::new();
        BufReader::new(child.stdout.take().ok_or("no output")?).read_line(&mut line).map_err(told)?;
        let address = line.trim().strip_prefix("http://127.0.0.1:").and_then(|rest| rest.split_once("/?token="));
        let (port, token) = address.ok_or("it tells no address")?;
        Ok(Self {
            running: Running(child),
            port: port.parse().map_err(told)?,
            token: token.to_owned(),
            _folder: folder,
        })
    }

    fn ask(&self, job: &Value) -> Result<String, String> {
        let Self { port, token, .. } = self;
        let body = job.to_string();
        let mut stream = TcpStream::connect(("127.0.0.1", *port)).map_err(told)?;
        stream.set_read_timeout(Some(PATIENCE)).map_err(told)?;
        let length = body.len();
        let head = format!("Host: 127.0.0.1:{port}\r\nX-Glisten-Token: {token}\r\nContent-Length: {length}");
        write!(stream, "POST /api/ask HTTP/1.0\r\n{head}\r\n\r\n{body}").map_err(told)?;
        let mut answer = String::new();
        stream.read_to_string(&mut answer).map_err(told)?;
        Ok(answer)
    }
}

impl Subject for Play {
    fn name(&self) -> &'static str {
        "`play`"
    }

    fn edit(&mut self, number: u64) -> Result<(), String> {
        let mistake = mistake(number);
        let texts = json!({ "a.frag": fragment(&mistake) });
        let looked = self.ask(&json!({ "ask": "look", "target": "wgsl", "scene": "a.toml", "texts": texts }))?;
        if !looked.contains(&mistake) {
            return Err(format!("`look` says nothing about `{mistake}`"));
        }
        let shade = number % 100;
        let texts = json!({ "a.toml": SCENE.replace("0.25", &format!("0.{shade:02}")) });
        let job = |ask: &str| json!({ "ask": ask, "scene": "a.toml", "texts": texts, "x": 3, "y": 4 });
        let drawn = self.ask(&job("draw"))?;
        let told = self.ask(&job("pixel"))?;
        let value = format!("0.{shade:02}00000");
        if drawn.contains("image/png") && told.contains(&value) {
            Ok(())
        } else {
            Err(format!("the pixel is not {value}: {told}"))
        }
    }

    fn sample(&self) -> Sample {
        Sample::of(self.running.0.id())
    }
}

/// `glisten lsp`, asked as an editor asks.
struct Lsp {
    running: Running,
    input: ChildStdin,
    messages: Receiver<String>,
    uri: String,
    _folder: TempDir,
}

impl Lsp {
    fn new(program: &Path) -> Result<Self, String> {
        let folder = folder()?;
        let mut command = Command::new(program);
        command
            .current_dir(folder.path())
            .arg("lsp")
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::null());
        let mut child = command.spawn().map_err(told)?;
        let (input, output) = (child.stdin.take().ok_or("no input")?, child.stdout.take().ok_or("no output")?);
        let (sender, messages) = mpsc::channel();
        std::thread::spawn(move || {
            let mut output = BufReader::new(output);
            while let Some(message) = message(&mut output) {
                if sender.send(message).is_err() {
                    break;
                }
            }
        });
        let uri = format!("file://{}/a.frag", folder.path().display());
        let mut lsp = Self { running: Running(child), input, messages, uri, _folder: folder };
        lsp.send("initialize", Some(1), &json!({ "capabilities": {}, "rootUri": Value::Null }))?;
        wait_for(&lsp.messages, "\"id\":1")?;
        lsp.send("initialized", None, &json!({}))?;
        let document = json!({ "uri": lsp.uri, "languageId": "glsl", "version": 0, "text": fragment("shade") });
        lsp.send("textDocument/didOpen", None, &json!({ "textDocument": document }))?;
        Ok(lsp)
    }

    fn send(&mut self, method: &str, id: Option<u64>, parameters: &Value) -> Result<(), String> {
        let mut message = json!({ "jsonrpc": "2.0", "method": method, "params": parameters });
        if let Some(id) = id {
            message["id"] = id.into();
        }
        let text = message.to_string();
        write!(self.input, "Content-Length: {}\r\n\r\n{text}", text.len())
            .and_then(|()| self.input.flush())
            .map_err(told)
    }

    fn change(&mut self, version: u64, text: &str) -> Result<(), String> {
        let document = json!({ "uri": self.uri, "version": version });
        let changes = json!([{ "text": text }]);
        self.send("textDocument/didChange", None, &json!({ "textDocument": document, "contentChanges": changes }))
    }
}

/// A message of the server.
fn message(output: &mut impl BufRead) -> Option<String> {
    let mut length = 0;
    loop {
        let mut line = String::new();
        if output.read_line(&mut line).ok()? == 0 {
            return None;
        }
        match line.trim() {
            "" => break,
            head => {
                length = head.strip_prefix("Content-Length: ").map_or(Some(length), |number| number.parse().ok())?
            }
        }
    }
    let mut bytes = vec![0; length];
    output.read_exact(&mut bytes).ok()?;
    Some(String::from_utf8_lossy(&bytes).into_owned())
}

impl Subject for Lsp {
    fn name(&self) -> &'static str {
        "`lsp`"
    }

    fn edit(&mut self, number: u64) -> Result<(), String> {
        let mistake = mistake(number);
        self.change(2 * number, &fragment(&mistake))?;
        wait_for(&self.messages, &mistake)?;
        self.change(2 * number + 1, &fragment("shade"))?;
        let place = json!({ "textDocument": { "uri": self.uri }, "position": { "line": 4, "character": 17 } });
        self.send("textDocument/hover", Some(2 * number), &place)?;
        wait_for(&self.messages, "uniform float shade")?;
        let document = json!({ "textDocument": { "uri": self.uri } });
        self.send("textDocument/semanticTokens/full", Some(2 * number + 1), &document)?;
        wait_for(&self.messages, &format!("\"id\":{}", 2 * number + 1))
    }

    fn sample(&self) -> Sample {
        Sample::of(self.running.0.id())
    }
}

/// Two compilations at once, whose results are in one cache.
struct Cache {
    program: PathBuf,
    folder: TempDir,
}

impl Cache {
    /// The size that the cache is kept below, in MiB.
    const LIMIT: u64 = 1;

    fn new(program: &Path) -> Result<Self, String> {
        Ok(Self { program: program.to_owned(), folder: folder()? })
    }

    fn compile(&self, output: &str) -> Result<Child, String> {
        let limit = format!("{}M", Self::LIMIT);
        let mut command = Command::new(&self.program);
        command
            .current_dir(self.folder.path())
            .args(["compile", "a.vert", "a.frag", "--target", "wgsl", "--cache", "cache"]);
        command.args(["--cache-limit", &limit, "-o", output]).stdout(Stdio::null()).stderr(Stdio::null());
        command.spawn().map_err(told)
    }
}

impl Subject for Cache {
    fn name(&self) -> &'static str {
        "two `compile --cache`"
    }

    fn edit(&mut self, number: u64) -> Result<(), String> {
        // Every third text was there before, so that entries are read, too.
        let constant = format!("{}.0 * shade", if number.is_multiple_of(3) { number / 2 } else { number });
        fs::write(self.folder.path().join("a.frag"), fragment(&constant)).map_err(told)?;
        let mut both = [self.compile("one")?, self.compile("two")?];
        for child in &mut both {
            let status = child.wait().map_err(told)?;
            if !status.success() {
                return Err(format!("a compilation ended with {status}"));
            }
        }
        let [one, two] = ["one", "two"]
            .map(|output| fs::read_to_string(self.folder.path().join(output).join("a.frag.wgsl")).unwrap_or_default());
        if one != two {
            return Err("the two results differ".to_owned());
        }
        let is_new = one.contains(constant.split(' ').next().unwrap_or_default());
        is_new.then_some(()).ok_or_else(|| "the result is an older one".to_owned())
    }

    /// The cache on the disk.
    fn sample(&self) -> Sample {
        let mut sample = Sample::default();
        let mut folders = vec![self.folder.path().join("cache")];
        while let Some(folder) = folders.pop() {
            for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
                match entry.metadata() {
                    Ok(known) if known.is_dir() => folders.push(entry.path()),
                    Ok(known) => sample.bytes += known.len(),
                    Err(_) => {}
                }
            }
        }
        sample
    }
}
