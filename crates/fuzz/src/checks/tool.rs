//! Other people's programs, which read from the standard input and write to the standard output.
//!
//! *In:* a name, arguments and bytes. *Out:* what the program prints, or its complaint. *Holds:* it ends within a time.

use std::io::{Read, Write};
use std::process::{Child, Command, Stdio};
use std::sync::OnceLock;
use std::sync::mpsc::channel;
use std::time::Duration;

/// How long a program may take.
const LIMIT: Duration = Duration::from_secs(20);

/// A program that may be installed.
pub(super) struct Tool {
    name: &'static str,
    found: OnceLock<bool>,
}

/// It reads SPIR-V and writes GLSL.
pub(super) static SPIRV_CROSS: Tool = Tool { name: "spirv-cross", found: OnceLock::new() };

/// It reads GLSL for Vulkan and writes SPIR-V.
pub(super) static GLSLANG: Tool = Tool { name: "glslangValidator", found: OnceLock::new() };

impl Tool {
    /// Whether it can be started.
    pub(super) fn is_installed(&self) -> bool {
        *self.found.get_or_init(|| {
            let mut command = Command::new(self.name);
            command.arg("--help").stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
            command.status().is_ok()
        })
    }

    /// The bytes that it prints for an input; its complaint if it fails.
    pub(super) fn run(&self, arguments: &[&str], input: &[u8]) -> Result<Vec<u8>, String> {
        let mut command = Command::new(self.name);
        command.args(arguments).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn().map_err(|error| error.to_string())?;
        let ended = finished(&mut child, input);
        // It has ended, or it never will.
        let _ = child.kill();
        let status = child.wait().map_err(|error| error.to_string())?;
        let [printed, complaint] = ended.ok_or("it takes too long")?;
        if status.success() {
            return Ok(printed);
        }
        // Some complain on the standard output.
        let told = [printed, complaint].concat();
        Err(String::from_utf8_lossy(&told).trim().to_owned())
    }
}

/// The bytes that a process prints until it closes its outputs, and its complaint; none if that takes too long.
fn finished(child: &mut Child, bytes: &[u8]) -> Option<[Vec<u8>; 2]> {
    let (mut input, out, complaints) = (child.stdin.take()?, child.stdout.take()?, child.stderr.take()?);
    let (sender, receiver) = channel();
    let outputs: [Box<dyn Read + Send>; 2] = [Box::new(out), Box::new(complaints)];
    for (index, mut output) in outputs.into_iter().enumerate() {
        let sender = sender.clone();
        std::thread::spawn(move || {
            let mut all = Vec::new();
            let _ = output.read_to_end(&mut all);
            let _ = sender.send((index, all));
        });
    }
    std::thread::scope(|scope| {
        // A program may print before it has read everything.
        scope.spawn(move || input.write_all(bytes));
        let mut read = [Vec::new(), Vec::new()];
        for _ in 0..2 {
            match receiver.recv_timeout(LIMIT) {
                Ok((index, all)) => read.get_mut(index).into_iter().for_each(|place| place.clone_from(&all)),
                Err(_) => {
                    let _ = child.kill();
                    return None;
                }
            }
        }
        Some(read)
    })
}
