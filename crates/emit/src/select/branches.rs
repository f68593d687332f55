//! The functions with a branch for each element: lookups (§8.7) through a chosen sampler, and reads of a chosen uniform block
//! (§4.3.7).
//!
//! *In:* an expression that chooses. *Out:* in its place, the call of a function. *Holds:* arguments that must be constant are
//! part of the function.

use super::chain::Chain;
use super::signature::{Argument, Inner, Key, Signature, What};
use super::{Selection, Try};
use glisten_front::builtin::operations::{Class, Lookup, TextureArgument};
use glisten_front::hir::{
    Case, CaseLabel, ExprId, ExprKind, Function, FunctionId, Local, LocalId, LocalKind, Stage, Stmt, StmtKind, Type,
    TypeId, VarRef,
};
use glisten_front::source::Span;

/// An argument of a lookup in the function that is made.
enum Given {
    Parameter(LocalId, TypeId),
    Constant(TypeId, Vec<u32>),
}

impl Selection<'_> {
    /// A call of a texture function.
    pub(super) fn lookup(&mut self, function: Option<FunctionId>, id: ExprId) -> Try<()> {
        let expr = self.shader.expr(id).clone();
        let ExprKind::BuiltinCall(builtin, arguments) = expr.kind else { return Ok(()) };
        let (Class::Texture(form), Some((sampler, rest))) = (builtin.class(), arguments.split_first()) else {
            return Ok(());
        };
        let Type::Sampler(ty) = self.types.get(self.shader.expr(*sampler).ty) else { return Ok(()) };
        let Some(chain) = self.chain(function, *sampler).filter(Chain::is_chosen) else { return Ok(()) };
        let name = format!("{}_of_{}", builtin.name(), self.name_of(chain.root, function));
        let mut signature = Signature::default();
        let inner = signature.chain(self, "samplers", chain);
        let mut given = Vec::new();
        for (role, &argument) in form.arguments(ty).into_iter().zip(rest) {
            use TextureArgument::{Component, Offset, Offsets};
            let fixed = matches!(role, Component | Offset | Offsets).then(|| self.evaluated(function, argument));
            given.push(match fixed.flatten().map(|value| Argument::constant(&value)) {
                Some(Argument::Constant(ty, bits)) => {
                    signature.arguments.push(Argument::Constant(ty, bits.clone()));
                    Given::Constant(ty, bits)
                }
                _ => {
                    let local = signature.value(self, word(role), argument);
                    Given::Parameter(local, self.shader.expr(argument).ty)
                }
            });
        }
        let what = What::Lookup(builtin);
        let all_first =
            self.shader.stage == Stage::Fragment && matches!(form.lookup, Lookup::Implicit | Lookup::QueryLod);
        let one = |this: &mut Self, sampler| {
            let mut arguments = vec![sampler];
            for given in &given {
                arguments.push(match given {
                    Given::Parameter(local, ty) => this.local(*local, *ty, expr.span),
                    Given::Constant(ty, bits) => this.spelled(*ty, bits, expr.span),
                });
            }
            this.push(ExprKind::BuiltinCall(builtin, arguments), expr.ty, expr.span)
        };
        self.chosen(id, (what, &name, all_first), signature, &inner, &one)
    }

    /// A part of an array of uniform blocks.
    pub(super) fn read(&mut self, function: Option<FunctionId>, id: ExprId) -> Try<()> {
        let Some(chain) = self.chain(function, id).filter(Chain::is_chosen) else { return Ok(()) };
        let name = format!("part_of_{}", self.name_of(chain.root, function));
        let mut signature = Signature::default();
        let inner = signature.chain(self, "blocks", chain);
        self.chosen(id, (What::Read, &name, false), signature, &inner, &|_, part| part)
    }

    /// Replaces an expression by a call of the function that has a branch for each element.
    fn chosen(
        &mut self,
        id: ExprId,
        (what, name, all_first): (What, &str, bool),
        signature: Signature,
        inner: &Inner,
        one: &dyn Fn(&mut Self, ExprId) -> ExprId,
    ) -> Try<()> {
        let (result, span) = (self.shader.expr(id).ty, self.shader.expr(id).span);
        let Signature { parameters, passed, arguments } = signature;
        let per_branch = inner.chain.steps.len().saturating_mul(2) + 2 + arguments.len() + 16;
        let key = Key { what, arguments, result };
        let made = match self.made.get(&key) {
            Some(made) => *made,
            None => {
                let branches = inner.chain.lengths().fold(1, |all: usize, len| all.saturating_mul(len as usize));
                self.afford(branches.saturating_mul(per_branch), span)?;
                let mut values = Vec::with_capacity(branches);
                for elements in elements(inner) {
                    let part = self.denoted(inner, Some(&elements), span);
                    values.push(one(self, part));
                }
                let selector = self.branch(inner, span);
                let mut function = Function {
                    name: self.unused(name),
                    ret: result,
                    param_count: parameters.len(),
                    locals: parameters,
                    body: None,
                    reachable: true,
                    span: Span::default(),
                };
                let first = if all_first { self.early(&mut function, &mut values) } else { Vec::new() };
                function.body = Some(branch_statements(first, selector, &values));
                let made = FunctionId::new(self.shader.functions.len());
                self.shader.functions.push(function);
                self.made.insert(key, made);
                made
            }
        };
        self.replace(id, made, passed);
        Ok(())
    }

    /// Computes all values before the branches; what the branches return are the results.
    fn early(&mut self, function: &mut Function, values: &mut [ExprId]) -> Vec<Stmt> {
        let mut first = Vec::with_capacity(values.len());
        for (index, value) in values.iter_mut().enumerate() {
            let (ty, span) = (self.shader.expr(*value).ty, self.shader.expr(*value).span);
            let local = LocalId::new(function.locals.len());
            let name = format!("from_{index}");
            function.locals.push(Local { name, ty, kind: LocalKind::Variable, value: None, span: Span::default() });
            first.push(statement(StmtKind::Local(local, Some(*value))));
            *value = self.local(local, ty, span);
        }
        first
    }

    /// The name of a variable, for the name of a function.
    pub(super) fn name_of(&self, var: VarRef, function: Option<FunctionId>) -> String {
        match (var, function) {
            (VarRef::Global(global), _) => {
                let global = self.shader.global(global);
                let instance = global.block.as_ref().and_then(|block| block.instance.as_ref());
                instance.unwrap_or(&global.name).clone()
            }
            (VarRef::Local(local), Some(function)) => self.shader.function(function).local(local).name.clone(),
            (VarRef::Local(_), None) => "local".to_owned(),
        }
    }
}

/// All choices, the last varying fastest.
fn elements(inner: &Inner) -> Vec<Vec<u32>> {
    let mut all = vec![Vec::new()];
    for len in inner.chain.lengths() {
        let longer = |before: Vec<u32>| (0..len).map(move |index| [before.as_slice(), &[index]].concat());
        all = all.into_iter().flat_map(longer).collect();
    }
    all
}

/// `switch (selector) { case 0: return a; .. } return z;`
fn branch_statements(mut body: Vec<Stmt>, selector: ExprId, values: &[ExprId]) -> Vec<Stmt> {
    let Some((last, others)) = values.split_last() else { return body };
    if !others.is_empty() {
        let branch = |(index, value): (usize, &ExprId)| Case {
            labels: vec![CaseLabel::Value(index as u32)],
            body: vec![statement(StmtKind::Return(Some(*value)))],
        };
        let mut cases: Vec<Case> = others.iter().enumerate().map(branch).collect();
        cases.push(Case { labels: vec![CaseLabel::Default], body: vec![statement(StmtKind::Break)] });
        body.push(statement(StmtKind::Switch { selector, cases }));
    }
    body.push(statement(StmtKind::Return(Some(*last))));
    body
}

fn statement(kind: StmtKind) -> Stmt {
    Stmt { kind, span: Span::default() }
}

/// The name of a parameter.
fn word(role: TextureArgument) -> &'static str {
    match role {
        TextureArgument::Coordinate => "p",
        TextureArgument::Level => "lod",
        TextureArgument::Sample => "number",
        TextureArgument::GradientX => "d_pdx",
        TextureArgument::GradientY => "d_pdy",
        TextureArgument::Offset => "offset",
        TextureArgument::Offsets => "offsets",
        TextureArgument::Reference => "reference",
        TextureArgument::Component => "component",
        TextureArgument::Bias => "bias",
    }
}
