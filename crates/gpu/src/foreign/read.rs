//! Reads a module: limits on its size, then naga's front end.
//!
//! *In:* bytes, or emitted code. *Out:* the code as it will run, and naga's module, from which the interface is read.

use super::{blocks, spirv};
use crate::Via;
use glisten_emit::Emitted;
use glisten_front::hir::Stage;
use naga::front::{spv, wgsl};
use naga::{Module, ShaderStage};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// The largest size of a module in bytes.
const MAX_BYTES: usize = 4 << 20;

/// The stack of the thread that parses: naga's front ends recurse over nested blocks.
const STACK_BYTES: usize = 256 << 20;

/// The largest length of a message of naga.
const MAX_MESSAGE: usize = 600;

/// Reads a module that has one entry point for the stage.
pub(super) fn read(bytes: &[u8], stage: Stage, via: Via) -> Result<(Emitted, Module), String> {
    if bytes.is_empty() {
        return Err("the file is empty".to_owned());
    }
    if bytes.len() > MAX_BYTES {
        return Err(format!("the file has {} bytes; at most {MAX_BYTES} are read", bytes.len()));
    }
    let code = match via {
        Via::Wgsl => Emitted::Text(text(bytes)?),
        Via::Spirv => Emitted::Words(spirv::words(bytes)?),
    };
    let module = parse(&code)?;
    check_entry_points(&module, stage, via)?;
    Ok((code, module))
}

fn text(bytes: &[u8]) -> Result<String, String> {
    let text = std::str::from_utf8(bytes)
        .map_err(|error| format!("it is no WGSL: not UTF-8 from byte {} on", error.valid_up_to()))?;
    if text.contains('\0') {
        return Err("it is no WGSL: it has a zero byte".to_owned());
    }
    Ok(text.to_owned())
}

/// The module of emitted code.
pub(super) fn parse(code: &Emitted) -> Result<Module, String> {
    let parsed = std::thread::scope(|scope| {
        let work = || catch_unwind(AssertUnwindSafe(|| front_end(code)));
        let thread = std::thread::Builder::new().stack_size(STACK_BYTES).spawn_scoped(scope, work);
        thread.map_err(|error| format!("the system gives no thread: {error}"))?.join().map_err(|_| gave_up())
    })?;
    parsed.map_err(|_| gave_up())?
}

fn gave_up() -> String {
    "naga, which reads the interface, gave up on it".to_owned()
}

fn front_end(code: &Emitted) -> Result<Module, String> {
    match code {
        Emitted::Text(text) => wgsl::parse_str(text)
            .map_err(|error| format!("it is no valid WGSL: {}", short(&error.emit_to_string(text)))),
        Emitted::Words(words) => {
            let options = spv::Options {
                adjust_coordinate_space: false,
                strict_capabilities: false,
                block_ctx_dump_prefix: None,
            };
            let words = blocks::with_locations(words);
            let parsed = spv::Frontend::new(words.into_iter(), &options).parse();
            parsed.map_err(|error| {
                format!("naga, which reads the interface, cannot read it: {}", short(&error.to_string()))
            })
        }
    }
}

/// A message that is not longer than people read.
fn short(message: &str) -> String {
    let message = message.trim_end();
    match message.char_indices().nth(MAX_MESSAGE) {
        Some((end, _)) => format!("{}...", message.get(..end).unwrap_or_default()),
        None => message.to_owned(),
    }
}

/// naga's name of a stage.
pub(super) fn naga_stage(stage: Stage) -> Option<ShaderStage> {
    match stage {
        Stage::Vertex => Some(ShaderStage::Vertex),
        Stage::Fragment => Some(ShaderStage::Fragment),
        Stage::Geometry => None,
    }
}

fn check_entry_points(module: &Module, stage: Stage, via: Via) -> Result<(), String> {
    let wanted = naga_stage(stage).ok_or("a geometry stage cannot be drawn")?;
    let found: Vec<_> = module.entry_points.iter().filter(|entry| entry.stage == wanted).collect();
    match &found[..] {
        [] => Err(format!("it has no entry point for the {} stage", stage.name())),
        // The driver is told this name.
        [entry] if via == Via::Spirv && entry.name != "main" => {
            Err(format!("its entry point is called `{}`; the pipeline calls `main`", short(&entry.name)))
        }
        [_] => Ok(()),
        _ => Err(format!("it has {} entry points for the {} stage; write one", found.len(), stage.name())),
    }
}
