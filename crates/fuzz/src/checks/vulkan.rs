//! GLSL for Vulkan, drawn without a GPU: glslang reads it where it is installed, and spirv-cross what glslang writes.
//!
//! *In:* a program that has been drawn. *Out:* a sentence where what is written is refused, or draws another picture. *Holds:* geometry stages
//! are drawn, too. *Not done here:* programs for which glslang is known to be wrong.

use super::again;
use super::drawn::{Drawn, Emission, Origin};
use super::targets::{is_refusal, stages};
use super::tool::GLSLANG;
use glisten_emit::{ClipZ, Conventions, Emitted, GlslVersion, Target, emit};
use glisten_front::hir::{ExprId, ExprKind, Shader, Stage, Storage, VarRef};

type Held = Result<(), String>;

/// GLSL for Vulkan, which glslang reads where it is installed. Since that takes long, it is done for one program of eight, as the seed
/// chooses, and for half of those with a geometry stage.
pub(super) fn check(drawn: &Drawn<'_>) -> Held {
    let Some(draw) = drawn.scene.draws.first() else { return Ok(()) };
    let one_in = if draw.program.stage(Stage::Geometry).is_some() { 2 } else { 8 };
    if drawn.program.is_some_and(|program| !program.seed.is_multiple_of(one_in)) {
        drawn.leave_out("it is done for some programs");
        return Ok(());
    }
    if !GLSLANG.is_installed() {
        drawn.leave_out("glslangValidator is not installed");
        return Ok(());
    }
    if draw.program.stages.iter().any(reads_before_change) {
        drawn.leave_out("glslang reads a variable after a later operand has changed it");
        return Ok(());
    }
    if draw.program.stages.iter().any(takes_bits_of_a_constant) {
        drawn.leave_out("glslang evaluates a constant with more digits than a float has, and takes its bits");
        return Ok(());
    }
    let (glsl_version, clip_z) = (GlslVersion::Vulkan, ClipZ::MinusOneToOne);
    let conventions = Conventions { glsl_version, clip_z, ..Conventions::default() };
    let mut emissions = Vec::new();
    for shader in stages(&draw.program) {
        match emit(&draw.program, shader.stage, Target::Glsl, &conventions) {
            Ok(Emitted::Text(text)) => {
                let words = Some(words_of(shader.stage, &text)?);
                emissions.push(Emission { stage: shader.stage, read: None, words, origin: Origin::Glslang });
            }
            Ok(Emitted::Words(_)) => return Err("words instead of text".to_owned()),
            Err(errors) => is_refusal(&errors)?,
        }
    }
    if emissions.len() != draw.program.stages.len() {
        drawn.leave_out("GLSL for Vulkan lacks something in a stage");
        return Ok(());
    }
    again::same(drawn, &emissions)
}

/// The words that glslang writes for GLSL for Vulkan.
fn words_of(stage: Stage, text: &str) -> Result<Vec<u32>, String> {
    let word = match stage {
        Stage::Vertex => "vert",
        Stage::Geometry => "geom",
        Stage::Fragment => "frag",
    };
    let arguments = ["--stdin", "-V", "--target-env", "vulkan1.1", "--quiet", "-S", word, "-o", "/dev/stdout"];
    let told = GLSLANG.run(&arguments, text.as_bytes());
    let bytes = told.map_err(|message| format!("glslang does not accept it: {message}\n{text}"))?;
    Ok(bytes.chunks_exact(4).filter_map(|four| four.try_into().ok()).map(u32::from_le_bytes).collect())
}

/// Whether a variable is read that a later part of the expression may change, in one of two places. GLSL evaluates arguments in their order
/// (4.50 §6.1.1); glslang 12 reads a variable among them last: seed 210224 of commit 0d7f9e0f. For `a += b`, GLSL leaves open whether `a` is
/// read first; glslang reads it last: seed 800808 of commit 0d7f9e0f.
fn reads_before_change(shader: &Shader) -> bool {
    let changed = |one: ExprId, later: &[ExprId]| {
        shader.root_variable(one).is_some_and(|variable| later.iter().any(|one| may_change(shader, *one, variable)))
    };
    shader.exprs.iter().any(|expr| match &expr.kind {
        ExprKind::Call(_, arguments) => arguments
            .iter()
            .enumerate()
            .any(|(index, argument)| changed(*argument, arguments.get(index + 1..).unwrap_or_default())),
        ExprKind::Assign(Some(_), target, value) => changed(*target, &[*value]),
        _ => false,
    })
}

/// Whether bits are taken of an expression that glslang evaluates: it does so in f64, from the digits of the text. In `floatBitsToInt(fract(
/// 2.22104))`, those below a float's last are not zero: seed 805270 of commit ee37c35c.
fn takes_bits_of_a_constant(shader: &Shader) -> bool {
    let takers = ["floatBitsToInt", "floatBitsToUint"];
    shader.exprs.iter().any(|expr| match &expr.kind {
        ExprKind::BuiltinCall(function, arguments) if takers.contains(&function.name()) => {
            arguments.iter().all(|one| is_constant(shader, *one))
        }
        _ => false,
    })
}

/// Whether an expression has no variable but global constants, and calls no function of the shader.
fn is_constant(shader: &Shader, id: ExprId) -> bool {
    let mut is_constant = true;
    shader.visit_expr(id, &mut |inner| {
        is_constant &= match &shader.expr(inner).kind {
            ExprKind::Var(VarRef::Global(global)) => shader.global(*global).storage == Storage::Const,
            kind => !matches!(kind, ExprKind::Var(_) | ExprKind::Call(..)),
        };
    });
    is_constant
}

/// Whether an expression may change a variable: it assigns to it, or calls a function.
fn may_change(shader: &Shader, id: ExprId, variable: VarRef) -> bool {
    let mut found = false;
    shader.visit_expr(id, &mut |inner| match &shader.expr(inner).kind {
        ExprKind::Assign(_, target, _) | ExprKind::IncDec(_, target) => {
            found |= shader.root_variable(*target) == Some(variable);
        }
        ExprKind::Call(..) | ExprKind::BuiltinCall(..) => found |= takes(shader, inner, variable),
        _ => {}
    });
    found
}

/// Whether a call may change a variable: it has it as an argument, or the variable is a global.
fn takes(shader: &Shader, id: ExprId, variable: VarRef) -> bool {
    match &shader.expr(id).kind {
        ExprKind::Call(_, arguments) => {
            matches!(variable, VarRef::Global(_))
                || arguments.iter().any(|one| shader.root_variable(*one) == Some(variable))
        }
        ExprKind::BuiltinCall(function, arguments) => {
            let writes = ["modf", "frexp", "uaddCarry", "usubBorrow", "umulExtended", "imulExtended"];
            writes.contains(&function.name())
                && arguments.iter().any(|one| shader.root_variable(*one) == Some(variable))
        }
        _ => false,
    }
}
