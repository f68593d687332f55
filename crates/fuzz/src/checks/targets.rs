//! Front ends of the targets, which must accept what is written.
//!
//! *In:* a program that has been drawn. *Out:* a sentence where what is written is refused. *Holds:* a target may lack something, and says so.

use super::again;
use super::drawn::{Drawn, Emission, Origin, Read};
use glisten_emit::{Conventions, Emitted, FloatWidth, Target, emit};
use glisten_front::Program;
use glisten_front::diagnostic::Diagnostic;
use glisten_front::diagnostic::codes::general::INTERNAL;
use glisten_front::hir::{Shader, Stage};
use naga::Module;
use naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};

type Held = Result<(), String>;

/// Limits of naga's front end for SPIR-V: indices that are clamped without a sign, logic of vectors, the layers of a size.
const LIMITS: [&str; 4] = [
    "builtin Min has incorrect or ambiguous arguments",
    "Incompatible operands: LogicalAnd(vec",
    "Incompatible operands: LogicalOr(vec",
    "Index 2 is out of bounds for expression",
];

/// The stages in the order of the texts.
pub(super) fn stages(program: &Program) -> impl Iterator<Item = &Shader> {
    [Stage::Vertex, Stage::Geometry, Stage::Fragment].into_iter().filter_map(|stage| program.stage(stage))
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
    for shader in stages(&draw.program) {
        match emit(&draw.program, shader.stage, target, &Conventions::default()) {
            Ok(written) => accepted(written)?,
            Err(errors) => {
                is_refusal(&errors)?;
                drawn.leave_out(target.name());
            }
        }
    }
    Ok(())
}

fn valid(module: &Module) -> Result<ModuleInfo, String> {
    let mut validator = Validator::new(ValidationFlags::all(), Capabilities::all());
    validator.validate(module).map_err(|error| error.emit_to_string(""))
}

/// The stages that are emitted, as far as they are.
fn read(
    program: &Program,
    (target, conventions): (Target, &Conventions),
    reads: &Reads<'_>,
) -> Result<Vec<Emission>, String> {
    let mut stages_of = Vec::new();
    for shader in stages(program) {
        match emit(program, shader.stage, target, conventions) {
            Ok(written) => {
                let read = reads(&written)?;
                let words = if let Emitted::Words(words) = written { Some(words) } else { None };
                stages_of.push(Emission { stage: shader.stage, read, words, origin: Origin::Glisten });
            }
            Err(errors) => is_refusal(&errors)?,
        }
    }
    Ok(stages_of)
}

/// Reads a stage; none where naga has a limit.
type Reads<'r> = dyn Fn(&Emitted) -> Result<Option<Read>, String> + 'r;

/// The stages of the emitted WGSL, which naga has read.
pub(super) fn wgsl_stages<'d>(drawn: &'d Drawn<'_>) -> Result<&'d [Emission], String> {
    let stages = drawn.wgsl.get_or_init(|| match drawn.scene.draws.first() {
        Some(draw) => read(&draw.program, (Target::Wgsl, &Conventions::default()), &read_wgsl),
        None => Ok(Vec::new()),
    });
    stages.as_deref().map_err(Clone::clone)
}

fn read_wgsl(written: &Emitted) -> Result<Option<Read>, String> {
    let Emitted::Text(text) = written else { return Err("no text".to_owned()) };
    let module = naga::front::wgsl::parse_str(text).map_err(|error| error.emit_to_string(text))?;
    let info = valid(&module).map_err(|message| format!("{message}\n{text}"))?;
    Ok(Some(Read { module, info }))
}

fn read_spirv(written: &Emitted) -> Result<Option<Read>, String> {
    let Emitted::Words(words) = written else { return Err("no words".to_owned()) };
    let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
    let options = naga::front::spv::Options { adjust_coordinate_space: false, ..Default::default() };
    let module = naga::front::spv::parse_u8_slice(&bytes, &options).map_err(|error| error.emit_to_string(""))?;
    let is_limit = |message: &String| LIMITS.iter().any(|limit| message.contains(limit));
    match valid(&module) {
        Ok(info) => Ok(Some(Read { module, info })),
        Err(message) if is_limit(&message) => Ok(None),
        Err(message) => Err(message),
    }
}

/// WGSL, which naga reads.
pub(super) fn wgsl(drawn: &Drawn<'_>) -> Held {
    again::same(drawn, wgsl_stages(drawn)?)
}

/// SPIR-V, which spirv-cross reads where it is installed, and naga with limits.
pub(super) fn spirv(drawn: &Drawn<'_>) -> Held {
    let Some(draw) = drawn.scene.draws.first() else { return Ok(()) };
    again::same(drawn, &read(&draw.program, (Target::Spirv, &Conventions::default()), &read_spirv)?)
}

/// The rest after `-O`, with the lines of the source, as WGSL or as SPIR-V; and 16-bit floats, which naga accepts.
pub(super) fn options(drawn: &Drawn<'_>) -> Held {
    let Some(draw) = drawn.scene.draws.first() else { return Ok(()) };
    let left = glisten_specialize::optimize(&draw.program);
    let lines = Conventions { debug_lines: true, ..Conventions::default() };
    let half = Conventions { floats: FloatWidth::Half, ..Conventions::default() };
    let is_even = drawn.program.is_none_or(|program| program.seed.is_multiple_of(2));
    let (target, reads): (Target, &Reads<'_>) =
        if is_even { (Target::Wgsl, &read_wgsl) } else { (Target::Spirv, &read_spirv) };
    // Of SPIR-V's capabilities, naga's front end does not know those of 16 bits.
    if is_even {
        read(&draw.program, (target, &half), reads).map_err(|message| format!("in 16 bits: {message}"))?;
    }
    again::same(drawn, &read(&left, (target, &lines), reads)?)
}

/// MSL and HLSL, which are written or refused.
pub(super) fn others(drawn: &Drawn<'_>) -> Held {
    for target in [Target::Msl, Target::Hlsl] {
        all(drawn, target, &|_| Ok(()))?;
    }
    Ok(())
}
