//! L-values (§5.8): which expressions can be written to, and why the others cannot.

use super::super::context::Analyzer;
use crate::diagnostic::Diagnostic;
use crate::diagnostic::codes::types;
use crate::hir::{ExprId, ExprKind, LocalKind, ParamMode, Storage, VarRef};
use crate::source::Span;

/// Why an l-value is needed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::analysis) enum Purpose {
    /// `a = b`
    Assign,
    /// `a++`
    Change,
    /// An argument for an `out` or `inout` parameter.
    Argument,
}

/// The reason why an expression is not an l-value.
struct Refusal {
    at: Span,
    why: String,
    declared: Option<(Span, &'static str)>,
}

impl Analyzer<'_> {
    /// Checks that an expression can be written to, and reports it otherwise. Poison passes.
    pub(in crate::analysis) fn require_lvalue(&mut self, id: ExprId, purpose: Purpose) -> bool {
        let Some(refusal) = self.refusal(id) else { return true };
        let what = self.quote(id);
        let message = match purpose {
            Purpose::Assign => format!("{what} cannot be assigned to"),
            Purpose::Change => format!("{what} cannot be changed by `++` or `--`"),
            Purpose::Argument => format!("{what} cannot be passed to an `out` or `inout` parameter"),
        };
        let mut finding = Diagnostic::new(&types::NOT_AN_LVALUE, self.span(id), message);
        if refusal.at == self.span(id) {
            finding = finding.here(refusal.why);
        } else {
            finding = finding.here("not an l-value").label(refusal.at, refusal.why);
        }
        if let Some((span, words)) = refusal.declared {
            finding = finding.label(span, words);
        }
        self.report(finding);
        false
    }

    fn refusal(&self, id: ExprId) -> Option<Refusal> {
        if self.types.contains_sampler(self.ty(id)) {
            let why = "only the application can set a sampler".to_owned();
            return Some(Refusal { at: self.span(id), why, declared: None });
        }
        if self.types.is_block(self.ty(id)) {
            let why = "a block is no variable: assign its members one by one".to_owned();
            return Some(Refusal { at: self.span(id), why, declared: None });
        }
        let mut at = id;
        loop {
            let span = self.span(at);
            let refuse = |why: &str| Some(Refusal { at: span, why: why.into(), declared: None });
            match &self.expr_at(at).kind {
                ExprKind::Error => return None,
                ExprKind::Member(inner, _) | ExprKind::Index(inner, _) => at = *inner,
                ExprKind::Swizzle(inner, swizzle) => {
                    if swizzle.has_repeats() {
                        return refuse("a component is named twice");
                    }
                    at = *inner;
                }
                ExprKind::Var(VarRef::Global(global)) => {
                    let global = self.shader.global(*global);
                    let why = match global.storage {
                        Storage::Const => "it is a constant",
                        Storage::Uniform => "it is a uniform",
                        Storage::In => "it is an input of the shader",
                        Storage::Private | Storage::Out => return None,
                    };
                    let declared = global.span.is_known().then_some((global.span, "declared here"));
                    return Some(Refusal { at: span, why: why.into(), declared });
                }
                ExprKind::Var(VarRef::Local(local)) => {
                    let local = self.local(*local)?;
                    let why = match local.kind {
                        LocalKind::Param(ParamMode::ConstIn) => "it is a `const` parameter",
                        LocalKind::Const => "it is a constant",
                        LocalKind::Param(_) | LocalKind::Variable => return None,
                    };
                    return Some(Refusal { at: span, why: why.into(), declared: Some((local.span, "declared here")) });
                }
                ExprKind::Call(..) | ExprKind::BuiltinCall(..) => return refuse("the result of a call is a value"),
                ExprKind::Ternary(..) => return refuse("the result of `?:` is a value"),
                ExprKind::Literal(_) if self.sources.snippet(span).starts_with("gl_") => {
                    return refuse("it is a built-in constant");
                }
                // `a.length()` is a number, too.
                ExprKind::Literal(_) if is_written(self.sources.snippet(span)) => {
                    return refuse("a literal is a value");
                }
                _ => return refuse("this is a value, not a variable"),
            }
        }
    }
}

/// Whether the text of a literal is one.
fn is_written(text: &str) -> bool {
    let text = text.trim_start_matches(['(', ' ']);
    text.starts_with(|first: char| first.is_ascii_digit() || first == '.')
        || text.starts_with("true")
        || text.starts_with("false")
}
