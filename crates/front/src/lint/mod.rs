//! Lint rules: legal programs that will cause trouble, with one file for each rule. Rules read and never change a
//! program.
//!
//! *In:* a linked [`Program`] and the texts that it was made from. *Out:* warnings and notes, each with a code of its own
//! ([`crate::diagnostic::codes::lints`]), in the order of the rules, but for the one that reads what the others found. *Holds:* an ordinary good program raises nothing
//! but notes; a rule that cannot be sure says nothing; a fix is a change of text that is written in place, never of a macro's
//! body. *Not done here:* levels and comments that silence a rule. Whoever prints the diagnostics applies them, and drops what
//! rules find that are off.

mod assigned;
mod divergence;
mod domain;
mod interval;
#[cfg(test)]
mod listed;
mod loop_invariant;
mod parts;
mod range;
mod rate;
mod rules;
mod subject;
mod texts;
mod unused;
mod uses;

use crate::diagnostic::codes::lints::UNUSED_ALLOW;
use crate::diagnostic::{Code, Diagnostic};
use crate::hir::Shader;
use crate::link::Program;
use crate::source::SourceMap;
use crate::stack::with_stack;
use subject::{Place, Subject};

/// A lint rule.
pub struct Rule {
    /// The code: name, level, page and examples.
    pub code: &'static Code,
    check: fn(&Subject<'_>, &mut Findings<'_>),
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

/// Checks a program against all rules, those that are off included. `sources` are the texts that it was compiled from.
pub fn check(program: &Program, sources: &SourceMap) -> Vec<Diagnostic> {
    check_some(program, sources, |_| true)
}

/// Checks a program against those rules whose codes are wanted, which need not run all.
pub fn check_some(program: &Program, sources: &SourceMap, wanted: impl Fn(&Code) -> bool) -> Vec<Diagnostic> {
    let depth = program.stages.iter().map(|shader| shader.depth).max().unwrap_or(0);
    with_stack(depth, || {
        let subject = Subject::new(program, sources);
        let mut list = Vec::new();
        for last in [false, true] {
            for rule in rules().iter().filter(|rule| runs_last(rule) == last && wanted(rule.code)) {
                (rule.check)(&subject, &mut Findings { code: rule.code, list: &mut list });
            }
        }
        list
    })
}

/// Whether a rule judges what all others found, so that it runs behind them, wherever the list has it.
fn runs_last(rule: &Rule) -> bool {
    *rule.code == UNUSED_ALLOW
}

/// The functions of a shader that `main` reaches, with their bodies.
fn running(shader: &Shader) -> impl Iterator<Item = (&crate::hir::Function, &[crate::hir::Stmt])> {
    let reachable = shader.functions.iter().filter(|function| function.reachable);
    reachable.filter_map(|function| Some((function, function.body.as_deref()?)))
}
