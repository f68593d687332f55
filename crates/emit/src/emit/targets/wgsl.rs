//! WGSL, with the names of the source.

use super::Job;
use crate::emit::emitted::{Emitted, Traced};
use crate::emit::naga_repairs::nesting;
use crate::emit::wgsl::{self, Notes, Style};
use glisten_front::diagnostic::Diagnostic;
use glisten_front::hir::Stage;

/// The diagnostic for nesting that no parser of WGSL accepts.
pub(super) fn limit(module: &naga::Module) -> Option<Diagnostic> {
    nesting::too_deep(module)
}

/// Writes WGSL, with the comments of the source.
pub(super) fn write(job: &Job<'_>) -> Result<Traced, String> {
    let Job { module, info, .. } = job;
    let notes = Notes::of(job.types, &job.shaders, job.sources);
    let (text, origins) = wgsl::write(module, info, Style::Full, &notes)?;
    let traced = Traced { emitted: Emitted::Text(text), origins };
    // GLSL allows derivatives in any control flow (§8.8 calls them undefined in some). WGSL rejects them where it
    // cannot prove that control flow is uniform, unless a directive disables that. naga has the directive in its IR
    // but never writes it.
    if job.has(Stage::Fragment) && takes_derivatives(module) {
        return Ok(traced.behind("diagnostic(off, derivative_uniformity);\n\n"));
    }
    Ok(traced)
}

/// Whether the module takes any derivatives, explicit or implicit.
fn takes_derivatives(module: &naga::Module) -> bool {
    let takes = |function: &naga::Function| {
        function.expressions.iter().any(|(_, expression)| match expression {
            naga::Expression::Derivative { .. } => true,
            naga::Expression::ImageSample { level, .. } => {
                matches!(level, naga::SampleLevel::Auto | naga::SampleLevel::Bias(_))
            }
            _ => false,
        })
    };
    module.functions.iter().any(|(_, function)| takes(function))
        || module.entry_points.iter().any(|entry| takes(&entry.function))
}
