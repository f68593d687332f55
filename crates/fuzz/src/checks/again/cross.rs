//! Emitted code as GLSL that spirv-cross writes, where this tool is installed.
//!
//! *In:* the words of a stage, or naga's module, which naga writes as words. *Out:* a text of GLSL 4.50 whose blocks and textures have their
//! bindings in the text. *Holds:* a process ends within a time; names of both stages are different.

use super::super::drawn::{Emission, Read};
use super::{Failed, Frame, Way, Written, limits, source};
use glisten_front::Stage;
use naga::back::spv;
use std::io::{Read as _, Write as _};
use std::process::{Child, Command, Stdio};
use std::sync::OnceLock;
use std::sync::mpsc::channel;
use std::time::Duration;

/// The tool.
const TOOL: &str = "spirv-cross";

/// What it is asked for: GLSL of OpenGL, with the depths of OpenGL, from the standard input.
const ARGUMENTS: [&str; 7] = [
    "--version",
    "450",
    "--no-es",
    "--fixup-clipspace",
    "--combined-samplers-inherit-bindings",
    "--remove-unused-variables",
    "-",
];

/// How long it may take.
const LIMIT: Duration = Duration::from_secs(20);

/// Whether the tool can be started.
fn is_installed() -> bool {
    static FOUND: OnceLock<bool> = OnceLock::new();
    *FOUND.get_or_init(|| {
        let mut command = Command::new(TOOL);
        command.arg("--help").stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
        command.status().is_ok()
    })
}

/// A stage as GLSL.
pub(super) fn written(stage: &Emission, frame: Frame, way: Way) -> Result<Written<'_>, Failed> {
    if !is_installed() {
        return Err(Failed::Limit("naga has a limit, and spirv-cross is not installed"));
    }
    let words = match (&stage.words, &stage.read) {
        (Some(words), _) => words.clone(),
        (None, Some(read)) => words_of(read).ok_or(Failed::Limit("naga cannot write a stage as SPIR-V"))?,
        (None, None) => return Err(Failed::Limit("naga does not read a stage")),
    };
    let text = run(&words, way).map_err(|message| match limits::of_tool(&message) {
        Some(why) => Failed::Limit(why),
        None => Failed::Fault(format!("{TOOL} does not read it: {message}")),
    })?;
    let text = apart(stage.stage, &text);
    Ok(Written { source: source(stage.stage, &text, frame)?, blocks: Vec::new(), textures: Vec::new() })
}

/// A module as words.
fn words_of(read: &Read) -> Option<Vec<u32>> {
    // Without what guards drivers: the counters of loops, and the functions for quotients.
    let options = spv::Options {
        flags: spv::WriterFlags::empty(),
        force_loop_bounding: false,
        emit_int_div_checks: false,
        ..spv::Options::default()
    };
    spv::write_vec(&read.module, &read.info, &options, None).ok()
}

/// What the tool prints for words; its complaint if there is one.
fn run(words: &[u32], way: Way) -> Result<String, String> {
    let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
    let mut command = Command::new(TOOL);
    command.args((way == Way::Plain).then_some("--force-temporary"));
    command.args(ARGUMENTS).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().map_err(|error| error.to_string())?;
    let ended = finished(&mut child, &bytes);
    // It has ended, or it never will.
    let _ = child.kill();
    let status = child.wait().map_err(|error| error.to_string())?;
    let (out, complaint) = ended.ok_or("it takes too long")?;
    if status.success() { Ok(out) } else { Err(complaint.trim().to_owned()) }
}

/// What a process prints until it closes its outputs; none if that takes too long.
fn finished(child: &mut Child, bytes: &[u8]) -> Option<(String, String)> {
    let (mut input, mut out, mut complaints) = (child.stdin.take()?, child.stdout.take()?, child.stderr.take()?);
    let (sender, receiver) = channel();
    std::thread::scope(|scope| {
        let other = sender.clone();
        std::thread::spawn(move || {
            let mut text = String::new();
            let _ = complaints.read_to_string(&mut text);
            let _ = other.send((false, text));
        });
        std::thread::spawn(move || {
            let mut text = String::new();
            let _ = out.read_to_string(&mut text);
            let _ = sender.send((true, text));
        });
        // The tool reads all of its input before it prints.
        scope.spawn(move || input.write_all(bytes));
        let (mut printed, mut complaint) = (None, None);
        while printed.is_none() || complaint.is_none() {
            match receiver.recv_timeout(LIMIT) {
                Ok((true, text)) => printed = Some(text),
                Ok((false, text)) => complaint = Some(text),
                Err(_) => {
                    let _ = child.kill();
                    return None;
                }
            }
        }
        printed.zip(complaint)
    })
}

/// The names of blocks and samplers, which are numbers, as names of one stage: OpenGL takes equal names for one variable.
fn apart(stage: Stage, text: &str) -> String {
    let word = stage.name();
    let lines = text.lines().map(|line| {
        let is_block = line.starts_with("layout(") && line.contains("std140") && line.contains(") uniform ");
        if is_block { format!("{line}_{word}\n") } else { format!("{line}\n") }
    });
    lines.collect::<String>().replace("SPIRV_Cross_Combined", &format!("{word}_combined"))
}
