//! The messages of an editor over standard input and output (LSP 3.17, "Base Protocol").
//!
//! *In:* bytes. *Out:* the connection of a server. *Holds:* what is no message is passed over, and answered as JSON-RPC says if it has the
//! form of one; the end of the input ends the connection. Nothing but messages is written to standard output. Of headers that are none,
//! a line on standard error and `window/logMessage` tell, once until the next message.

use lsp_server::{Connection, ErrorCode, Message};
use serde_json::{Value, json};
use std::io::{self, BufRead, BufReader, Read, Write};
use std::thread::{self, JoinHandle};
use std::time::Duration;

/// The largest message.
const MAX_BYTES: usize = 256 << 20;
/// The longest line of a header.
const MAX_LINE: u64 = 4096;

/// How long an editor that has ended the connection may take to read what is left: in steps of the second number.
const PATIENCE: (u32, Duration) = (200, Duration::from_millis(10));

/// The thread that writes.
pub(crate) struct Channel {
    writer: JoinHandle<io::Result<()>>,
}

/// The connection over standard input and output.
pub(crate) fn connect() -> (Connection, Channel) {
    let (server, editor) = Connection::memory();
    let Connection { sender, receiver } = editor;
    // It ends with the input, or with the program.
    thread::spawn(move || {
        let mut input = BufReader::new(io::stdin().lock());
        while let Some(body) = body(&mut input, &mut tell) {
            match message(&body) {
                Ok(message) => {
                    if sender.send(message).is_err() {
                        return;
                    }
                }
                Err(failure) => {
                    // Somebody who reads nothing needs no answer.
                    let _ = write(&failure);
                }
            }
        }
    });
    let writer = thread::spawn(move || {
        for message in receiver {
            write(&serde_json::to_value(message).map_err(io::Error::other)?)?;
        }
        Ok(())
    });
    (server, Channel { writer })
}

impl Channel {
    /// Waits until everything is written, if the editor reads it. The connection has to be gone.
    pub(crate) fn finish(self) {
        let (steps, step) = PATIENCE;
        for _ in 0..steps {
            if self.writer.is_finished() {
                return;
            }
            thread::sleep(step);
        }
    }
}

fn write(message: &Value) -> io::Result<()> {
    let mut message = message.clone();
    if let Some(object) = message.as_object_mut() {
        object.insert("jsonrpc".to_owned(), json!("2.0"));
    }
    let text = message.to_string();
    // Whole messages, whoever writes.
    let mut output = io::stdout().lock();
    write!(output, "Content-Length: {}\r\n\r\n{text}", text.len())?;
    output.flush()
}

/// Tells the person who looks after the editor. Whoever reads nothing is told nothing.
fn tell(what: &str) {
    let _ = writeln!(io::stderr(), "glisten lsp: {what}");
    let warning = json!({ "type": 2, "message": format!("glisten: {what}") });
    let _ = write(&json!({ "method": "window/logMessage", "params": warning }));
}

/// The number of bytes that a line of a header tells, if it does; the reason if it is no header.
fn length_of(line: &str) -> Result<Option<usize>, String> {
    // A header may follow what is none on its line.
    let name = "content-length:";
    let lower = line.to_ascii_lowercase();
    let Some(text) = lower.rfind(name).and_then(|at| line.get(at + name.len()..)) else {
        let is_header = lower.starts_with("content-type:");
        return if is_header { Ok(None) } else { Err(format!("this is no header: `{}`", shown(line))) };
    };
    match text.trim().parse::<usize>() {
        Ok(length) if length <= MAX_BYTES => Ok(Some(length)),
        Ok(_) => Err(format!("a message has more than {} MiB: `{}`", MAX_BYTES >> 20, shown(line))),
        Err(_) => Err(format!("the length of a message is no number: `{}`", shown(line))),
    }
}

fn shown(line: &str) -> String {
    let plain = line.chars().map(|letter| if letter.is_control() { ' ' } else { letter });
    plain.take(80).collect()
}

/// The next body. Lines that are no header are passed over, and the first of them is told.
fn body(input: &mut impl BufRead, tell: &mut impl FnMut(&str)) -> Option<Vec<u8>> {
    let mut length = None;
    let mut is_told = false;
    loop {
        let mut line = Vec::new();
        if input.by_ref().take(MAX_LINE).read_until(b'\n', &mut line).ok()? == 0 {
            return None;
        }
        let text = String::from_utf8_lossy(&line);
        let text = text.trim();
        match (text.is_empty(), length) {
            (true, Some(length)) => {
                let mut bytes = Vec::new();
                let read = input.by_ref().take(length as u64).read_to_end(&mut bytes).ok()?;
                if read < length {
                    tell(&format!("the input ends after {read} of {length} bytes of a message"));
                }
                return (read == length).then_some(bytes);
            }
            (true, None) => {}
            (false, _) => match length_of(text) {
                Ok(found) => length = found.or(length),
                Err(why) if !is_told => {
                    tell(&why);
                    is_told = true;
                }
                Err(_) => {}
            },
        }
    }
}

/// The message of a body, or the answer to what is none.
fn message(body: &[u8]) -> Result<Message, Value> {
    let failure =
        |id: Value, code: ErrorCode, why: String| json!({ "id": id, "error": { "code": code as i32, "message": why } });
    let value: Value = serde_json::from_slice(body)
        .map_err(|error| failure(Value::Null, ErrorCode::ParseError, format!("this is no JSON: {error}")))?;
    let id = value.get("id").cloned().unwrap_or(Value::Null);
    serde_json::from_value(value)
        .map_err(|_| failure(id, ErrorCode::InvalidRequest, "this is no message of JSON-RPC 2.0".to_owned()))
}

#[cfg(test)]
mod tests {
    use super::{body, length_of, message};
    use lsp_server::Message;
    use std::io::BufReader;

    #[test]
    fn garbage_is_passed_over() {
        let text = b"\xff\xfe garbage\r\n\r\n:::\nContent-Length: 99999999999999999999\r\n\r\nx Content-Length: 2\r\nContent-Type: a\r\n\r\n{}\
            content-length: 37\r\n\r\n{\"jsonrpc\":\"2.0\",\"method\":\"a\",\"id\":7}Content-Length: 50\r\n\r\n{}";
        let mut input = BufReader::new(&text[..]);
        let mut told = Vec::new();
        let mut tell = |what: &str| told.push(what.to_owned());
        assert_eq!(body(&mut input, &mut tell).as_deref(), Some(&b"{}"[..]));
        let second = body(&mut input, &mut tell).expect("a body");
        assert!(matches!(message(&second), Ok(Message::Request(request)) if request.method == "a"));
        assert_eq!(body(&mut input, &mut tell), None, "the input ends inside of it");
        assert_eq!(
            told,
            ["this is no header: `\u{fffd}\u{fffd} garbage`", "the input ends after 2 of 50 bytes of a message"]
        );
        assert_eq!((length_of("Content-Length: 7"), length_of("Content-Type: a")), (Ok(Some(7)), Ok(None)));
        for bad in ["Content-Length: abc", "Content-Length: 99999999999999", "Content-Length: -1", "a: b"] {
            assert!(length_of(bad).is_err_and(|why| why.contains(bad)), "{bad}");
        }
        for (text, code) in [("{", -32700), ("[]", -32600), ("{\"id\": 3}", -32600)] {
            let failure = message(text.as_bytes()).expect_err("no message");
            assert_eq!(failure["error"]["code"], code, "{text}: {failure}");
        }
    }
}
