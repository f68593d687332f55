//! Emitted code as GLSL that spirv-cross writes, where this tool is installed.
//!
//! *In:* the words of a stage, or naga's module, which naga writes as words. *Out:* a text of GLSL 4.50 whose blocks and textures have their
//! bindings in the text. *Holds:* a process ends within a time; names of both stages are different.

use super::super::drawn::{Emission, Origin, Read};
use super::super::tool::SPIRV_CROSS;
use super::{Failed, Frame, Way, Written, limits, source};
use glisten_front::Stage;
use naga::back::spv;

/// The arguments: GLSL of OpenGL, from the standard input.
const ARGUMENTS: [&str; 6] =
    ["--version", "450", "--no-es", "--combined-samplers-inherit-bindings", "--remove-unused-variables", "-"];

/// A stage as GLSL.
pub(super) fn written(stage: &Emission, frame: Frame, way: Way) -> Result<Written<'_>, Failed> {
    if !SPIRV_CROSS.is_installed() {
        return Err(Failed::Limit("naga has a limit, and spirv-cross is not installed"));
    }
    let words = match (&stage.words, &stage.read) {
        (Some(words), _) => words.clone(),
        (None, Some(read)) => words_of(read).ok_or(Failed::Limit("naga cannot write a stage as SPIR-V"))?,
        (None, None) => return Err(Failed::Limit("naga does not read a stage")),
    };
    let text = run(&words, stage.origin, way).map_err(|message| match limits::of_tool(stage.origin, &message) {
        Some(why) => Failed::Limit(why),
        None => Failed::Fault(format!("spirv-cross does not read it: {message}")),
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

/// The text that the tool prints for words; its complaint if there is one.
fn run(words: &[u32], origin: Origin, way: Way) -> Result<String, String> {
    let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
    let mut arguments = ARGUMENTS.to_vec();
    arguments.extend((origin == Origin::Glisten).then_some("--fixup-clipspace"));
    arguments.extend((way == Way::Plain).then_some("--force-temporary"));
    let printed = SPIRV_CROSS.run(&arguments, &bytes)?;
    String::from_utf8(printed).map_err(|error| error.to_string())
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
