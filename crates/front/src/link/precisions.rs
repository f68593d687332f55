//! The precisions of uniforms, which are the same in all stages (GLSL ES 1.00 §4.3.4; 3.00 §4.3.5, §4.5.3).
//!
//! *In:* the shaders of a program. *Out:* an error for each uniform, and each member of a uniform block, that has another
//! precision in another stage, by a qualifier or by the default of the stage. *Holds:* the desktop's language has no precisions; what
//! is declared with another type is reported elsewhere.

use super::Linker;
use crate::diagnostic::{Diagnostic, codes};
use crate::hir::{Shader, Storage};
use crate::source::Span;
use rustc_hash::FxHashMap;

/// Checks the shaders of a program.
pub(super) fn check(ctx: &mut Linker<'_>, shaders: &[Shader]) {
    let mut known = FxHashMap::default();
    for shader in shaders {
        for (name, precision) in &shader.precisions {
            let (first, other) = *known.entry(name.as_str()).or_insert((shader, *precision));
            if other == *precision || first.stage == shader.stage {
                continue;
            }
            let (Some(here), Some(there)) = (place(ctx, shader, name), place(ctx, first, name)) else { continue };
            let message = format!("the uniform `{name}` has another precision in each stage");
            let word = other.word();
            ctx.report(
                Diagnostic::new(&codes::link::UNIFORM_PRECISION_MISMATCH, here, message)
                    .here(format!("`{}` in the {} stage", precision.word(), shader.stage.name()))
                    .label(there, format!("`{word}` in the {} stage", first.stage.name()))
                    .help(format!("write `{word}` before its type here, or the same qualifier in both stages")),
            );
        }
    }
}

/// The declaration of a uniform or of a member of a block.
fn place(ctx: &Linker<'_>, shader: &Shader, name: &str) -> Option<Span> {
    let uniform = |name: &str| {
        let mut globals = shader.globals.iter().filter(|global| global.storage == Storage::Uniform);
        globals.find(|global| global.match_name() == name)
    };
    let Some((block, member)) = name.split_once('.') else { return Some(uniform(name)?.span) };
    let (id, _) = super::compatible::block_parts(ctx.types, uniform(block)?.ty)?;
    let mut members = ctx.types.structure(id).members.iter();
    Some(members.find(|other| other.name == member)?.span)
}
