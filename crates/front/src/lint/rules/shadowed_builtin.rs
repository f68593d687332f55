//! `shadowed-builtin`: a function or a variable with the name of a built-in function, which cannot be called where the name is
//! known.

use super::super::{Findings, Subject};
use crate::builtin::functions;
use crate::hir::{Shader, TypeId};
use crate::language::Extensions;

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    for shader in &subject.program.stages {
        for function in &shader.functions {
            let types: Vec<TypeId> = function.param_types().map(|(ty, _)| ty).collect();
            let rows = || functions::named(&function.name).iter().copied();
            let has_types = || rows().any(|row| row.signatures(shader.stage).any(|one| one.has_types(&types)));
            if is_builtin(shader, &function.name) && has_types() && subject.texts.is_own(shader, function.span) {
                let message = format!("`{}` hides the built-in function of that name", function.name);
                findings.push(findings.at(function.span, message).help("give it another name"));
            }
        }
    }
    for place in &subject.places {
        let calls = |name: &str| {
            place.exprs.iter().any(|&expr| {
            matches!(place.kind(expr), crate::hir::ExprKind::BuiltinCall(function, _) if function.name() == name)
        })
        };
        for local in &place.function.locals {
            // A name that is used both ways is mistaken for the other.
            if is_builtin(place.shader, &local.name)
                && calls(&local.name)
                && subject.texts.is_own(place.shader, local.span)
            {
                let message = format!("`{}` hides the built-in function of that name", local.name);
                findings.push(findings.at(local.span, message).help("give it another name"));
            }
        }
    }
}

fn is_builtin(shader: &Shader, name: &str) -> bool {
    functions::named(name).iter().any(|row| row.availability.in_language(shader.version, Extensions::empty()))
}
