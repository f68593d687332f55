//! Latency of `glisten lsp`: from an edit in a source of 2,000 lines to its diagnostics, of requests after it, and of the opening of a
//! workspace of 5,000 files.
//!
//! ```sh
//! cargo bench --bench lsp
//! ```
//!
//! *Out:* the median, the 95th percentile and the greatest time of 300 edits, in milliseconds, and the memory of the server before and
//! after.

#![expect(clippy::print_stdout, reason = "a bench prints")]

use serde_json::{Value, json};
use std::fmt::Write as _;
use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::time::Instant;

const EDITS: usize = 300;
const FUNCTIONS: usize = 222;

struct Server {
    child: Child,
    input: ChildStdin,
    output: BufReader<ChildStdout>,
    id: i64,
}

impl Server {
    fn start(root: Option<&str>) -> Self {
        let mut child = Command::new(env!("CARGO_BIN_EXE_glisten"))
            .arg("lsp")
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .expect("the program runs");
        let input = child.stdin.take().expect("it is piped");
        let output = BufReader::new(child.stdout.take().expect("it is piped"));
        let mut server = Self { child, input, output, id: 0 };
        server.ask("initialize", json!({ "processId": null, "rootUri": root, "capabilities": {} }));
        server.tell("initialized", json!({}));
        server
    }

    fn send(&mut self, message: &Value) {
        let text = message.to_string();
        write!(self.input, "Content-Length: {}\r\n\r\n{text}", text.len()).expect("it reads");
        self.input.flush().expect("it reads");
    }

    fn read(&mut self) -> Value {
        let mut length = 0;
        loop {
            let mut line = String::new();
            assert!(self.output.read_line(&mut line).expect("it writes") > 0, "the server is gone");
            if line.trim().is_empty() {
                break;
            }
            if let Some(value) = line.to_ascii_lowercase().strip_prefix("content-length:") {
                length = value.trim().parse().expect("a number");
            }
        }
        let mut bytes = vec![0; length];
        self.output.read_exact(&mut bytes).expect("it writes");
        serde_json::from_slice(&bytes).expect("JSON")
    }

    fn tell(&mut self, method: &str, params: Value) {
        self.send(&json!({ "jsonrpc": "2.0", "method": method, "params": params }));
    }

    fn ask(&mut self, method: &str, params: Value) -> Value {
        self.id += 1;
        let id = self.id;
        self.send(&json!({ "jsonrpc": "2.0", "id": id, "method": method, "params": params }));
        loop {
            let message = self.read();
            if message["id"] == id {
                return message;
            }
        }
    }

    fn wait(&mut self, method: &str, uri: &str) {
        while {
            let message = self.read();
            message["method"] != method || message["params"]["uri"] != uri
        } {}
    }

    /// The resident memory in KiB.
    fn memory(&self) -> Option<u64> {
        let status = fs::read_to_string(format!("/proc/{}/status", self.child.id())).ok()?;
        let line = status.lines().find(|line| line.starts_with("VmRSS"))?;
        line.split_whitespace().nth(1)?.parse().ok()
    }
}

/// A fragment shader of about 2,000 lines.
fn source() -> String {
    let mut text = "#version 150\nin vec3 normal;\nuniform vec3 light[8];\nout vec4 color;\n".to_owned();
    for n in 0..FUNCTIONS {
        let before = if n == 0 { "normal".to_owned() } else { format!("f{}(a, b * 0.5)", n - 1) };
        let _ = write!(
            text,
            "// Function {n}.\nvec3 f{n}(vec3 a, float b) {{\n    vec3 c = {before};\n    float d = dot(a, light[{}]);\n    \
             if (d > 0.0) {{\n        c += max(d, b) * vec3(0.5, 0.25, 0.125);\n    }}\n    return normalize(c);\n}}\n",
            n % 8
        );
        if n % 2 == 1 {
            // Chains of calls stay short.
            text = text.replace(&format!("vec3 c = f{}(a, b * 0.5);", n - 1), "vec3 c = a * b;");
        }
    }
    let _ = write!(text, "void main() {{\n    color = vec4(f{}(normal, 1.0), 1.0);\n}}\n", FUNCTIONS - 1);
    text
}

fn report(what: &str, times: &mut [f64]) {
    times.sort_by(f64::total_cmp);
    let at = |share: f64| times[((times.len() - 1) as f64 * share) as usize];
    println!("{what:<28} median {:7.2} ms   95 % {:7.2} ms   most {:7.2} ms", at(0.5), at(0.95), at(1.0));
}

fn main() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let text = source();
    fs::write(folder.path().join("big.frag"), &text).expect("written");
    let vertex = "#version 150\nin vec3 position;\nout vec3 normal;\nvoid main() { normal = position; gl_Position = vec4(position, 1.0); }\n";
    fs::write(folder.path().join("big.vert"), vertex).expect("written");
    let uri = format!("file://{}/big.frag", folder.path().display());
    let mut server = Server::start(None);
    let document = json!({ "uri": uri, "languageId": "glsl", "version": 1, "text": text });
    server.tell("textDocument/didOpen", json!({ "textDocument": document }));
    server.wait("textDocument/publishDiagnostics", &uri);
    println!("{} lines, {} bytes", text.lines().count(), text.len());
    let line = text[..text.find("vec3 f100(").expect("it is there")].matches('\n').count() + 2;
    let before = server.memory();
    let requests = [
        "textDocument/completion",
        "textDocument/hover",
        "textDocument/documentSymbol",
        "textDocument/semanticTokens/full",
    ];
    let (mut edits, mut times) = (Vec::new(), vec![Vec::new(); requests.len()]);
    for n in 0..EDITS {
        // A letter is typed, and taken back.
        let (end, letter) = if n % 2 == 0 { (4, "q") } else { (5, "") };
        let range = json!({ "start": { "line": line, "character": 4 }, "end": { "line": line, "character": end } });
        let start = Instant::now();
        let changes = json!([{ "range": range, "text": letter }]);
        let changed = json!({ "uri": uri, "version": n + 2 });
        server.tell("textDocument/didChange", json!({ "textDocument": changed, "contentChanges": changes }));
        server.wait("textDocument/publishDiagnostics", &uri);
        edits.push(start.elapsed().as_secs_f64() * 1e3);
        if n % 10 == 0 {
            for (request, times) in requests.iter().zip(&mut times) {
                let start = Instant::now();
                let place = json!({ "line": line, "character": 5 });
                server.ask(request, json!({ "textDocument": { "uri": uri }, "position": place }));
                times.push(start.elapsed().as_secs_f64() * 1e3);
            }
        }
    }
    report("edit to diagnostics", &mut edits);
    for (request, times) in requests.iter().zip(&mut times) {
        report(request.trim_start_matches("textDocument/"), times);
    }
    if let (Some(before), Some(after)) = (before, server.memory()) {
        println!("memory {before} KiB before, {after} KiB after");
    }
    let _ = server.child.kill();
    workspace();
}

/// Opens a file of a workspace: 1,000 headers, 2,000 programs of two stages that include them.
fn workspace() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let write = |name: String, text: &str| fs::write(folder.path().join(name), text).expect("written");
    for n in 0..100 {
        fs::create_dir(folder.path().join(format!("d{n}"))).expect("made");
    }
    for n in 0..1000 {
        write(format!("d{}/h{n}.glsl", n % 100), &format!("vec3 tint{n}(vec3 a) {{\n    return a * {n}.0;\n}}\n"));
    }
    let version = "#version 150\n#extension GL_ARB_shading_language_include : require\n";
    for n in 0..2000 {
        let (at, header) = (n % 100, n % 1000);
        write(
            format!("d{at}/p{n}.vert"),
            "#version 150\nin vec3 p;\nout vec3 v;\nvoid main() {\n    v = p;\n    gl_Position = vec4(p, 1.0);\n}\n",
        );
        let text = format!(
            "{version}#include \"h{header}.glsl\"\nin vec3 v;\nout vec4 color;\nvoid main() {{\n    color = vec4(tint{header}(v), 1.0);\n}}\n"
        );
        write(format!("d{at}/p{n}.frag"), &text);
    }
    let root = format!("file://{}", folder.path().display());
    let uri = format!("{root}/d7/p7.frag");
    let text = fs::read_to_string(folder.path().join("d7/p7.frag")).expect("written");
    let start = Instant::now();
    let mut server = Server::start(Some(&root));
    let document = json!({ "uri": uri, "languageId": "glsl", "version": 1, "text": text });
    server.tell("textDocument/didOpen", json!({ "textDocument": document }));
    server.wait("textDocument/publishDiagnostics", &uri);
    println!("5,000 files: {:.2} s to the diagnostics of one", start.elapsed().as_secs_f64());
    let found = server.ask("workspace/symbol", json!({ "query": "tint7" }));
    let count = found["result"].as_array().map_or(0, Vec::len);
    println!("5,000 files: {:.2} s until a name is found in all ({count} times)", start.elapsed().as_secs_f64());
    let header = format!("{root}/d7/h7.glsl");
    let text = fs::read_to_string(folder.path().join("d7/h7.glsl")).expect("written");
    let document = json!({ "uri": header, "languageId": "glsl", "version": 1, "text": text });
    let start = Instant::now();
    server.tell("textDocument/didOpen", json!({ "textDocument": document }));
    server.wait("textDocument/publishDiagnostics", &header);
    println!("5,000 files: {:.2} s to the diagnostics of a header", start.elapsed().as_secs_f64());
    let _ = server.child.kill();
}
