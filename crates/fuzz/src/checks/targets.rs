//! Front ends of the targets, which must accept what is written.
//!
//! *In:* a program that has been drawn. *Out:* a sentence where what is written is refused. *Holds:* a target may lack something, and says so.

use super::drawn::Drawn;
use glisten_emit::{Conventions, Emitted, Target, emit};
use glisten_front::diagnostic::Diagnostic;
use glisten_front::diagnostic::codes::general::INTERNAL;
use glisten_front::hir::{Shader, Stage};
use naga::valid::{Capabilities, ValidationFlags, Validator};

type Held = Result<(), String>;

/// Limits of naga's front end for SPIR-V: indices that are clamped without a sign, logic of vectors, the layers of a size.
const LIMITS: [&str; 4] = [
    "builtin Min has incorrect or ambiguous arguments",
    "Incompatible operands: LogicalAnd(vec",
    "Incompatible operands: LogicalOr(vec",
    "Index 2 is out of bounds for expression",
];

/// The vertex and the fragment stage.
pub(super) fn stages(program: &glisten_front::Program) -> [Option<&Shader>; 2] {
    [Stage::Vertex, Stage::Fragment].map(|stage| program.stage(stage))
}

/// Whether a target says what it lacks, which is no fault.
pub(super) fn is_refusal(errors: &[Diagnostic]) -> Held {
    match errors.iter().find(|one| one.code.id == INTERNAL.id) {
        Some(internal) => Err(format!("an internal error: {}", internal.message)),
        None if errors.is_empty() => Err("a refusal without a reason".to_owned()),
        None => Ok(()),
    }
}

/// Each stage as a target has it.
fn all(drawn: &Drawn<'_>, target: Target, accepted: &dyn Fn(Emitted) -> Held) -> Held {
    let Some(draw) = drawn.scene.draws.first() else { return Ok(()) };
    for shader in stages(&draw.program).into_iter().flatten() {
        match emit(&draw.program, shader.stage, target, &Conventions::default()) {
            Ok(written) => accepted(written)?,
            Err(errors) => is_refusal(&errors)?,
        }
    }
    Ok(())
}

fn valid(module: &naga::Module) -> Held {
    let mut validator = Validator::new(ValidationFlags::all(), Capabilities::all());
    validator.validate(module).map(|_| ()).map_err(|error| error.emit_to_string(""))
}

/// WGSL, which naga reads.
pub(super) fn wgsl(drawn: &Drawn<'_>) -> Held {
    all(drawn, Target::Wgsl, &|written| {
        let Emitted::Text(text) = written else { return Err("no text".to_owned()) };
        let module = naga::front::wgsl::parse_str(&text).map_err(|error| error.emit_to_string(&text))?;
        valid(&module).map_err(|message| format!("{message}\n{text}"))
    })
}

/// SPIR-V, which naga reads.
pub(super) fn spirv(drawn: &Drawn<'_>) -> Held {
    all(drawn, Target::Spirv, &|written| {
        let Emitted::Words(words) = written else { return Err("no words".to_owned()) };
        let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
        let options = naga::front::spv::Options::default();
        let module = naga::front::spv::parse_u8_slice(&bytes, &options).map_err(|error| error.emit_to_string(""))?;
        let is_limit = |message: &String| LIMITS.iter().any(|limit| message.contains(limit));
        valid(&module).or_else(|message| if is_limit(&message) { Ok(()) } else { Err(message) })
    })
}

/// MSL and HLSL, which are written or refused.
pub(super) fn others(drawn: &Drawn<'_>) -> Held {
    for target in [Target::Msl, Target::Hlsl] {
        all(drawn, target, &|_| Ok(()))?;
    }
    Ok(())
}
