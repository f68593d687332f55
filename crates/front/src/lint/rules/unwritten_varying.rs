//! `unwritten-varying`: a varying, or a part of one, that the fragment stage reads and the vertex stage does not write:
//! never, or not on every way.
//!
//! Only components that the fragment stage reads count. That some ways write nothing is said only if the fragment stage
//! reads the varying on every way, for else the same condition may rule both.

use super::super::assigned::{Components, assigned, components_of, moderate_len, suffix};
use super::super::{Findings, Subject, running};
use crate::hir::{ExprId, ExprKind, GlobalId, Shader, Stage, Stmt, StmtKind, VarRef};
use crate::link::Program;
use crate::link::usage::first_use;
use std::collections::BTreeSet;

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    let program = subject.program;
    let [vertex, fragment] = program.stages.as_slice() else { return };
    if (vertex.stage, fragment.stage) != (Stage::Vertex, Stage::Fragment) {
        return;
    }
    let mut seen = BTreeSet::new();
    for varying in &program.interface.varyings {
        let (Some(from), Some(to)) = (varying.from, varying.to) else { continue };
        let is_builtin = vertex.global(from.global).builtin.is_some();
        if varying.active && !is_builtin && seen.insert(from.global.index()) {
            compare(program, (vertex, from.global), (fragment, to.global), findings);
        }
    }
}

fn compare(
    program: &Program,
    (vertex, output): (&Shader, GlobalId),
    (fragment, input): (&Shader, GlobalId),
    findings: &mut Findings<'_>,
) {
    let types = &program.types;
    let (from, to) = (vertex.global(output), fragment.global(input));
    if moderate_len(types, from.ty) != moderate_len(types, to.ty) || moderate_len(types, from.ty).is_none() {
        return;
    }
    let read = components_read(program, fragment, input);
    let written = assigned(types, vertex, output);
    let never: Components = read.difference(&written.ever).copied().collect();
    let sometimes: Components = read.difference(&written.always).copied().filter(|at| !never.contains(at)).collect();
    let (lost, how) = if !never.is_empty() {
        (never, "never writes")
    } else if !sometimes.is_empty() && is_read_on_every_way(fragment, input) {
        (sometimes, "does not write on every path")
    } else {
        return;
    };
    let name = to.match_name();
    let part = match suffix(types, to.ty, &lost) {
        Some(part) => format!("`{name}{part}`"),
        None if lost.len() < types.flat_len(to.ty) as usize => format!("a part of `{name}`"),
        None => format!("`{name}`"),
    };
    let message = format!("the fragment stage reads {part}, which the vertex stage {how}");
    let mut finding = findings.at(to.span, message).here("its value is undefined");
    finding = finding.label(from.span, "declared here in the vertex stage");
    if let Some(place) = first_use(fragment, input) {
        finding = finding.label(place, "read here");
    }
    findings.push(finding);
}

/// The components of an input that the functions which `main` reaches read.
fn components_read(program: &Program, fragment: &Shader, input: GlobalId) -> Components {
    let mut read = Components::new();
    for (_, body) in running(fragment) {
        let mut pending = fragment.roots(body);
        while let Some(expr) = pending.pop() {
            match components_of(&program.types, fragment, expr) {
                Some((root, components)) => {
                    if root == VarRef::Global(input) {
                        read.extend(components);
                    }
                    pending.extend(fragment.indices_of_place(expr));
                }
                None => pending.extend(fragment.children(expr)),
            }
        }
    }
    read
}

/// Whether `main` or a function that it calls without a condition reads the input without one.
fn is_read_on_every_way(fragment: &Shader, input: GlobalId) -> bool {
    let mut functions: Vec<_> = fragment.main.into_iter().collect();
    let mut seen = BTreeSet::new();
    while let Some(id) = functions.pop() {
        if !seen.insert(id.index()) {
            continue;
        }
        let mut pending = Vec::new();
        unconditional(fragment.function(id).body.as_deref().unwrap_or(&[]), &mut pending);
        while let Some(expr) = pending.pop() {
            match &fragment.expr(expr).kind {
                ExprKind::Var(VarRef::Global(named)) if *named == input => return true,
                ExprKind::Logical(_, first, _) | ExprKind::Ternary(first, ..) => pending.push(*first),
                ExprKind::Call(callee, arguments) => {
                    functions.push(*callee);
                    pending.extend(arguments);
                }
                kind => pending.extend(kind.children()),
            }
        }
    }
    false
}

/// The expressions of a body up to its first way out that are evaluated in any case.
fn unconditional(body: &[Stmt], found: &mut Vec<ExprId>) {
    for statement in body {
        match &statement.kind {
            StmtKind::If { arms, .. } => found.extend(arms.first().map(|(condition, _)| *condition)),
            StmtKind::Switch { selector, .. } => found.push(*selector),
            StmtKind::Block(inner) => unconditional(inner, found),
            StmtKind::Loop { condition, .. } => found.extend(condition.as_ref().map(|condition| condition.expr)),
            kind => found.extend(kind.exprs()),
        }
        let leaves = |statement: &Stmt| matches!(statement.kind, StmtKind::Return(_) | StmtKind::Discard);
        let mut may_leave = false;
        let mut inner: Vec<&Stmt> = vec![statement];
        while let Some(one) = inner.pop() {
            may_leave |= leaves(one);
            inner.extend(one.kind.bodies().into_iter().flatten());
        }
        if may_leave {
            return;
        }
    }
}
