//! An editor that talks to `glisten lsp` over pipes, for all tests of the server.

use super::cli::Folder;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::process::{Child, ChildStdin, ChildStdout, Stdio};

/// An editor.
pub(super) struct Editor {
    pub(super) child: Child,
    pub(super) input: Option<ChildStdin>,
    output: BufReader<ChildStdout>,
    folder: String,
    id: i64,
    pub(super) told: Vec<Value>,
    utf8: bool,
}

impl Drop for Editor {
    fn drop(&mut self) {
        let _ = self.child.kill();
    }
}

impl Editor {
    pub(super) fn new(folder: &Folder, capabilities: Value) -> Self {
        Self::with(folder, capabilities, &[])
    }

    /// An editor whose server has further arguments.
    pub(super) fn with(folder: &Folder, capabilities: Value, arguments: &[&str]) -> Self {
        let mut child = folder
            .command(&[&["lsp"], arguments].concat())
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .expect("the program runs");
        let output = BufReader::new(child.stdout.take().expect("it is piped"));
        let input = child.stdin.take();
        let folder = folder.path("").canonicalize().expect("it is there").to_string_lossy().into_owned();
        let utf8 = capabilities["general"]["positionEncodings"][0] == "utf-8";
        let mut editor = Self { child, input, output, folder, id: 0, told: Vec::new(), utf8 };
        let root = editor.uri("");
        let answer =
            editor.ask("initialize", json!({ "processId": null, "rootUri": root, "capabilities": capabilities }));
        let encoding = if utf8 { "utf-8" } else { "utf-16" };
        assert_eq!(answer["capabilities"]["positionEncoding"], encoding, "{answer}");
        editor.tell("initialized", json!({}));
        editor
    }

    pub(super) fn uri(&self, name: &str) -> String {
        format!("file://{}/{name}", self.folder.trim_end_matches('/')).trim_end_matches('/').to_owned()
    }

    pub(super) fn send(&mut self, message: &Value) {
        let text = message.to_string();
        let input = self.input.as_mut().expect("it is open");
        write!(input, "Content-Length: {}\r\n\r\n{text}", text.len()).and_then(|()| input.flush()).expect("it reads");
    }

    pub(super) fn read(&mut self) -> Value {
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

    pub(super) fn tell(&mut self, method: &str, params: Value) {
        self.send(&json!({ "jsonrpc": "2.0", "method": method, "params": params }));
    }

    /// The answer to a request, with `error` if it is refused.
    pub(super) fn answer(&mut self, method: &str, params: Value) -> Value {
        self.id += 1;
        let id = self.id;
        self.send(&json!({ "jsonrpc": "2.0", "id": id, "method": method, "params": params }));
        loop {
            let message = self.read();
            if message["id"] == id && message.get("method").is_none() {
                return message;
            }
            self.told.push(message);
        }
    }

    pub(super) fn ask(&mut self, method: &str, params: Value) -> Value {
        let answer = self.answer(method, params);
        assert!(answer.get("error").is_none(), "{method}: {answer}");
        answer["result"].clone()
    }

    pub(super) fn open(&mut self, name: &str, text: &str) {
        let uri = self.uri(name);
        let document = json!({ "uri": uri, "languageId": "glsl", "version": 1, "text": text });
        self.tell("textDocument/didOpen", json!({ "textDocument": document }));
    }

    pub(super) fn change(&mut self, name: &str, version: i64, changes: Value) {
        let uri = self.uri(name);
        let document = json!({ "uri": uri, "version": version });
        self.tell("textDocument/didChange", json!({ "textDocument": document, "contentChanges": changes }));
    }

    /// The next diagnostics of a document.
    pub(super) fn diagnostics(&mut self, name: &str) -> Vec<Value> {
        let uri = self.uri(name);
        let is_it = |message: &Value| {
            message["method"] == "textDocument/publishDiagnostics" && message["params"]["uri"] == uri.as_str()
        };
        let message = match self.told.iter().position(is_it) {
            Some(place) => self.told.remove(place),
            None => loop {
                let message = self.read();
                if is_it(&message) {
                    break message;
                }
                self.told.push(message);
            },
        };
        message["params"]["diagnostics"].as_array().expect("a list").clone()
    }

    /// The position of a word in a text, in the encoding of this editor.
    pub(super) fn at(&self, text: &str, word: &str) -> Value {
        let offset = text.find(word).unwrap_or_else(|| panic!("`{word}` is there"));
        let start = text[..offset].rfind('\n').map_or(0, |end| end + 1);
        let before = &text[start..offset];
        let character = if self.utf8 { before.len() } else { before.encode_utf16().count() };
        json!({ "line": text[..offset].matches('\n').count(), "character": character })
    }

    pub(super) fn on(&self, name: &str, text: &str, word: &str) -> Value {
        json!({ "textDocument": { "uri": self.uri(name) }, "position": self.at(text, word) })
    }

    pub(super) fn close(mut self) {
        assert_eq!(self.ask("shutdown", Value::Null), Value::Null);
        self.tell("exit", Value::Null);
        self.input = None;
        assert_eq!(self.child.wait().expect("it ends").code(), Some(0));
    }
}

/// Names of an answer's files with lines and columns, shortened.
pub(super) fn places(answer: &Value) -> Vec<String> {
    let list = answer.as_array().cloned().unwrap_or_else(|| vec![answer.clone()]);
    let mut places: Vec<String> = list
        .iter()
        .map(|place| {
            let name = place["uri"].as_str().unwrap_or("").rsplit('/').next().unwrap_or("").to_owned();
            let start = &place["range"]["start"];
            format!("{name}:{}:{}", start["line"], start["character"])
        })
        .collect();
    places.sort();
    places
}

pub(super) fn labels(answer: &Value) -> Vec<String> {
    let items = answer["items"].as_array().expect("a list");
    items.iter().map(|item| item["label"].as_str().expect("a text").to_owned()).collect()
}

/// The texts after the edits of an answer.
pub(super) fn edited(folder: &Folder, answer: &Value) -> BTreeMap<String, String> {
    let mut texts = BTreeMap::new();
    for (uri, edits) in answer["changes"].as_object().expect("changes") {
        let name = uri.rsplit('/').next().expect("a name").to_owned();
        let text = fs::read_to_string(folder.path(&name)).expect("a file");
        texts.insert(name, applied(&text, edits.as_array().expect("a list"), false));
    }
    texts
}

pub(super) fn applied(text: &str, edits: &[Value], utf8: bool) -> String {
    let offset = |position: &Value| {
        let line = position["line"].as_u64().expect("a line") as usize;
        let start: usize = text.split_inclusive('\n').take(line).map(str::len).sum();
        let wanted = position["character"].as_u64().expect("a column") as usize;
        let mut units = 0;
        for (at, letter) in text[start..].char_indices() {
            if units >= wanted {
                return start + at;
            }
            units += if utf8 { letter.len_utf8() } else { letter.len_utf16() };
        }
        text.len()
    };
    let mut ranges: Vec<(usize, usize, &str)> = edits
        .iter()
        .map(|edit| {
            let range = &edit["range"];
            (offset(&range["start"]), offset(&range["end"]), edit["newText"].as_str().expect("a text"))
        })
        .collect();
    ranges.sort();
    let mut text = text.to_owned();
    for (start, end, new) in ranges.into_iter().rev() {
        text.replace_range(start..end, new);
    }
    text
}
