//! Lint rules: legal programs that will cause trouble, with one file for each rule. Rules read and never change a
//! program.
//!
//! *In:* a linked [`Program`]. *Out:* warnings and notes, each with a code of its own
//! ([`crate::diagnostic::codes::lints`]), in the order of the rules. *Holds:* an ordinary good program raises nothing
//! but notes; a rule that cannot be sure says nothing. *Not done here:* levels and comments that silence a rule.
//! Whoever prints the diagnostics applies them.

mod assigned;
mod divergence;
mod rules;

use crate::diagnostic::{Code, Diagnostic};
use crate::hir::Shader;
use crate::link::Program;
use crate::stack::with_stack;

/// A lint rule.
pub struct Rule {
    /// The code: name, level, page and examples.
    pub code: &'static Code,
    check: fn(&Program, &mut Findings<'_>),
}

/// Collects the diagnostics of a rule.
struct Findings<'a> {
    code: &'static Code,
    list: &'a mut Vec<Diagnostic>,
}

impl Findings<'_> {
    /// A diagnostic with the rule's code.
    fn at(&self, span: crate::source::Span, message: impl Into<String>) -> Diagnostic {
        Diagnostic::new(self.code, span, message)
    }

    fn push(&mut self, finding: Diagnostic) {
        self.list.push(finding);
    }
}

/// All rules.
pub fn rules() -> &'static [Rule] {
    rules::RULES
}

/// Checks a program against all rules.
pub fn check(program: &Program) -> Vec<Diagnostic> {
    let depth = program.stages.iter().map(|shader| shader.expr_depth).max().unwrap_or(0);
    with_stack(depth, || {
        let mut list = Vec::new();
        for rule in rules() {
            (rule.check)(program, &mut Findings { code: rule.code, list: &mut list });
        }
        list
    })
}

/// The functions of a shader that `main` reaches, with their bodies.
fn running(shader: &Shader) -> impl Iterator<Item = (&crate::hir::Function, &[crate::hir::Stmt])> {
    let reachable = shader.functions.iter().filter(|function| function.reachable);
    reachable.filter_map(|function| Some((function, function.body.as_deref()?)))
}
