//! The precisions of uniforms, which are the same in all stages (GLSL ES 1.00 §4.3.4; 3.00 §4.3.5, §4.5.3).
//!
//! *In:* the shaders of a program. *Out:* an error for each uniform, and each member of a struct or a uniform block, that has another
//! precision in another stage, by a qualifier or by the default of the stage. From ES 3.10 on, those of blocks may differ (§9.2.1).
//! *Holds:* the desktop's language has no precisions; what is declared with another type is reported elsewhere.

use super::Linker;
use crate::diagnostic::{Diagnostic, codes};
use crate::hir::Shader;
use rustc_hash::FxHashMap;

/// Checks the shaders of a program.
pub(super) fn check(ctx: &mut Linker<'_>, shaders: &[Shader]) {
    let mut known = FxHashMap::default();
    for shader in shaders {
        for (name, precision, here) in &shader.precisions {
            let (first, other, there) = *known.entry(name.as_str()).or_insert((shader, *precision, *here));
            if other == *precision || first.stage == shader.stage {
                continue;
            }
            let message = format!("the uniform `{name}` has another precision in each stage");
            let word = other.word();
            ctx.report(
                Diagnostic::new(&codes::link::UNIFORM_PRECISION_MISMATCH, *here, message)
                    .here(format!("`{}` in the {} stage", precision.word(), shader.stage.name()))
                    .label(there, format!("`{word}` in the {} stage", first.stage.name()))
                    .help(format!("write `{word}` before its type here, or the same qualifier in both stages")),
            );
        }
    }
}
