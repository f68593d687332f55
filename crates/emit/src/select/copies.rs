//! Copies of functions that get a chosen sampler (§6.1): the copy gets the array and the index instead.
//!
//! *In:* a call. *Out:* in its place, the call of a copy. *Holds:* in the copy, the chain is in the place of the parameter, so
//! what the copy does with it is a choice of its own.

use super::chain::Chain;
use super::signature::{Argument, Inner, Key, Signature, What};
use super::{Selection, Try};
use glisten_front::diagnostic::Diagnostic;
use glisten_front::diagnostic::codes::general;
use glisten_front::hir::{
    Case, Condition, ExprId, ExprKind, Function, FunctionId, LocalId, Stmt, StmtKind, Type, TypeId, VarRef, written_by,
};
use glisten_front::source::Span;
use rustc_hash::FxHashMap;

/// A local of a function as the copy has it.
#[derive(Clone)]
enum Mapped {
    Local(LocalId),
    Chain(Box<Inner>),
}

/// How deep statements nest at most.
const NESTING: u32 = 512;

impl Selection<'_> {
    /// A call of a function of the shader.
    pub(super) fn call(&mut self, function: Option<FunctionId>, id: ExprId) -> Try<()> {
        let expr = self.shader.expr(id);
        let (span, result) = (expr.span, expr.ty);
        let ExprKind::Call(callee, arguments) = &expr.kind else { return Ok(()) };
        let (callee, arguments) = (*callee, arguments.clone());
        let chain = |id: &ExprId| {
            let has_sampler = self.types.contains_sampler(self.shader.expr(*id).ty);
            has_sampler.then(|| self.chain(function, *id)).flatten().filter(Chain::is_chosen)
        };
        let chains: Vec<Option<Chain>> = arguments.iter().map(chain).collect();
        if chains.iter().all(Option::is_none) || self.shader.function(callee).body.is_none() {
            return Ok(());
        }
        let mut signature = Signature::default();
        let mut mapped = Vec::new();
        for (index, (argument, chain)) in arguments.iter().zip(chains).enumerate() {
            let Some(parameter) = self.shader.function(callee).params().get(index).cloned() else { continue };
            mapped.push(match chain {
                None => {
                    signature.arguments.push(Argument::Value(parameter.ty));
                    Mapped::Local(signature.parameter(parameter, *argument))
                }
                Some(chain) => {
                    self.check_unchanged(callee, LocalId::new(index), span)?;
                    Mapped::Chain(Box::new(signature.chain(self, &parameter.name, chain)))
                }
            });
        }
        let Signature { parameters, passed, arguments } = signature;
        let key = Key { what: What::Copy(callee), arguments, result };
        let copy = match self.made.get(&key) {
            Some(copy) => *copy,
            None => {
                let copy = self.copied(callee, parameters, mapped, span)?;
                self.made.insert(key, copy);
                copy
            }
        };
        self.replace(id, copy, passed);
        Ok(())
    }

    /// Adds a copy of a function with other parameters.
    fn copied(
        &mut self,
        id: FunctionId,
        parameters: Vec<glisten_front::hir::Local>,
        mut mapped: Vec<Mapped>,
        span: Span,
    ) -> Try<FunctionId> {
        let original = self.shader.function(id);
        let (name, ret, reachable) = (original.name.clone(), original.ret, original.reachable);
        let own = original.locals.get(original.param_count..).unwrap_or(&[]).to_vec();
        let body = original.body.clone().unwrap_or_default();
        let param_count = parameters.len();
        let mut locals = parameters;
        for local in own {
            mapped.push(Mapped::Local(LocalId::new(locals.len())));
            locals.push(local);
        }
        let exprs = self.copied_expressions(&body, &mapped, span)?;
        let body = glisten_front::stack::with_stack(NESTING, || copied_statements(&body, &exprs, &mapped));
        let copy = FunctionId::new(self.shader.functions.len());
        let span = Span::default();
        let name = self.unused(&name);
        let copied = Function { name, ret, param_count, locals, body: Some(body), reachable, span };
        self.shader.functions.push(copied);
        Ok(copy)
    }

    /// Copies all expressions of a body; operands precede what they belong to.
    fn copied_expressions(&mut self, body: &[Stmt], mapped: &[Mapped], span: Span) -> Try<FxHashMap<ExprId, ExprId>> {
        let mut ids = Vec::new();
        self.shader.visit_body(body, &mut |id| ids.push(id));
        ids.sort_unstable();
        ids.dedup();
        let longest = mapped.iter().map(|mapped| match mapped {
            Mapped::Local(_) => 1,
            Mapped::Chain(inner) => inner.chain.steps.len().saturating_mul(2) + 1,
        });
        self.afford(ids.len().saturating_mul(longest.max().unwrap_or(1)), span)?;
        let mut copies = FxHashMap::default();
        for id in ids {
            let expr = self.shader.expr(id).clone();
            let copy = match expr.kind {
                ExprKind::Var(VarRef::Local(local)) => match mapped.get(local.index()).cloned() {
                    Some(Mapped::Local(local)) => self.local(local, expr.ty, expr.span),
                    Some(Mapped::Chain(inner)) => self.denoted(&inner, None, expr.span),
                    None => self.local(local, expr.ty, expr.span),
                },
                mut kind => {
                    kind.for_each_operand(&mut |id| *id = copies.get(id).copied().unwrap_or(*id));
                    self.push(kind, expr.ty, expr.span)
                }
            };
            copies.insert(id, copy);
        }
        Ok(copies)
    }

    /// Refuses a function that writes to a parameter: the copy has no variable of its own for it.
    fn check_unchanged(&self, callee: FunctionId, parameter: LocalId, span: Span) -> Try<()> {
        let shader = &self.shader;
        let function = shader.function(callee);
        let is_it = |id: ExprId| shader.root_variable(id) == Some(VarRef::Local(parameter));
        let mut changed = false;
        let body = function.body.as_deref().unwrap_or(&[]);
        let plain = |ty: TypeId| !matches!(self.types.get(ty), Type::Struct(_) | Type::Array(..));
        if plain(function.local(parameter).ty) {
            return Ok(());
        }
        shader.visit_body(body, &mut |id| written_by(shader, id, &mut |target| changed |= is_it(target)));
        if !changed {
            return Ok(());
        }
        let name = &function.local(parameter).name;
        let message = format!("`{}` changes `{name}`, which an index that is not constant chooses", function.name);
        Err(Box::new(
            Diagnostic::new(&general::NOT_SUPPORTED_YET, span, message)
                .help("copy the members that change to variables first"),
        ))
    }
}

/// Statements with other expressions and locals.
fn copied_statements(body: &[Stmt], exprs: &FxHashMap<ExprId, ExprId>, mapped: &[Mapped]) -> Vec<Stmt> {
    let expr = |id: &ExprId| exprs.get(id).copied().unwrap_or(*id);
    let local = |id: &LocalId| match mapped.get(id.index()) {
        Some(Mapped::Local(local)) => *local,
        _ => *id,
    };
    let inner = |body: &[Stmt]| copied_statements(body, exprs, mapped);
    let copy = |statement: &Stmt| {
        let kind = match &statement.kind {
            StmtKind::Expr(id) => StmtKind::Expr(expr(id)),
            StmtKind::Local(id, initializer) => StmtKind::Local(local(id), initializer.as_ref().map(expr)),
            StmtKind::Block(body) => StmtKind::Block(inner(body)),
            StmtKind::If { arms, otherwise } => StmtKind::If {
                arms: arms.iter().map(|(condition, body)| (expr(condition), inner(body))).collect(),
                otherwise: inner(otherwise),
            },
            StmtKind::Switch { selector, cases } => StmtKind::Switch {
                selector: expr(selector),
                cases: cases.iter().map(|case| Case { labels: case.labels.clone(), body: inner(&case.body) }).collect(),
            },
            StmtKind::Loop { kind, condition, step, body } => StmtKind::Loop {
                kind: *kind,
                condition: condition.as_ref().map(|condition| Condition {
                    local: condition.local.as_ref().map(local),
                    expr: expr(&condition.expr),
                }),
                step: step.as_ref().map(expr),
                body: inner(body),
            },
            StmtKind::Return(value) => StmtKind::Return(value.as_ref().map(expr)),
            StmtKind::Break => StmtKind::Break,
            StmtKind::Continue => StmtKind::Continue,
            StmtKind::Discard => StmtKind::Discard,
        };
        Stmt { kind, span: statement.span }
    };
    body.iter().map(copy).collect()
}
