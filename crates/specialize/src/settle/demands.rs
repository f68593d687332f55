//! [`Demands`]: what is demanded of each variable, of what is stored in it, and of what functions return.
//!
//! *In:* a walked stage. *Out:* flags, raised until nothing changes. *Holds:* rounds are bounded: should they not settle,
//! everything is demanded of everything, which is always right.

use super::cancels::cancelling;
use super::{Demand, builtins, danger};
use crate::Math;
use crate::facts::Fact;
use crate::forward::Walked;
use glisten_front::hir::{BinaryOp, ExprId, ExprKind, FunctionId, ParamMode, Stmt, StmtKind, Types, VarRef};
use rustc_hash::FxHashSet;
use smallvec::SmallVec;

/// After so many rounds everything is demanded.
const ROUNDS: usize = 12;

/// Demands by variable and function.
#[derive(Debug)]
pub(crate) struct Demands {
    /// By clone and local.
    locals: Vec<Vec<Demand>>,
    /// By global.
    pub(crate) globals: Vec<Demand>,
    /// By clone: what it returns.
    results: Vec<Demand>,
    changed: bool,
    /// Under fast math nothing is demanded of anything.
    fast: bool,
    /// The differences and quotients whose operands must not become one expression.
    cancelling: FxHashSet<ExprId>,
}

impl Demands {
    /// Those of a stage, beginning with what is demanded of its globals.
    pub(crate) fn of(types: &Types, walked: &Walked, globals: Vec<Demand>) -> Self {
        let functions = &walked.shader.functions;
        let mut demands = Self {
            locals: functions.iter().map(|function| vec![Demand::NONE; function.locals.len()]).collect(),
            globals,
            results: vec![Demand::NONE; functions.len()],
            changed: false,
            fast: walked.math == Math::Fast,
            cancelling: if walked.math == Math::Fast { FxHashSet::default() } else { cancelling(walked) },
        };
        if demands.fast {
            return demands;
        }
        for _ in 0..ROUNDS {
            demands.changed = false;
            demands.round(types, walked);
            if !demands.changed {
                return demands;
            }
        }
        demands.locals.iter_mut().flatten().for_each(|demand| *demand = Demand::KEEP);
        demands.globals.fill(Demand::KEEP);
        demands.results.fill(Demand::KEEP);
        demands
    }

    /// Uses follow what is stored, mostly: so backwards.
    fn round(&mut self, types: &Types, walked: &Walked) {
        for (id, function) in walked.shader.functions() {
            if let Some(body) = &function.body {
                self.body(types, walked, id, body);
            }
        }
        for (id, global) in walked.shader.globals() {
            if let Some(initializer) = global.initializer {
                let demand = self.globals.get(id.index()).copied().unwrap_or_default();
                self.expr(types, walked, FunctionId::new(0), initializer, demand);
            }
        }
    }

    fn body(&mut self, types: &Types, walked: &Walked, function: FunctionId, body: &[Stmt]) {
        for stmt in body.iter().rev() {
            for inner in stmt.kind.bodies().into_iter().rev() {
                self.body(types, walked, function, inner);
            }
            for expr in stmt.kind.exprs() {
                let demand = self.of_statement(function, &stmt.kind);
                self.expr(types, walked, function, expr, demand);
            }
        }
    }

    /// The demand on the expression in a statement.
    pub(super) fn of_statement(&self, function: FunctionId, kind: &StmtKind) -> Demand {
        match kind {
            StmtKind::Local(local, _) => self.of_variable(function, VarRef::Local(*local)),
            StmtKind::Return(_) => self.results.get(function.index()).copied().unwrap_or_default(),
            StmtKind::Expr(_)
            | StmtKind::Block(_)
            | StmtKind::If { .. }
            | StmtKind::Switch { .. }
            | StmtKind::Loop { .. }
            | StmtKind::Break
            | StmtKind::Continue
            | StmtKind::Discard => Demand::NONE,
        }
    }

    pub(super) fn of_variable(&self, function: FunctionId, variable: VarRef) -> Demand {
        let demand = match variable {
            VarRef::Global(id) => self.globals.get(id.index()),
            VarRef::Local(id) => self.locals.get(function.index()).and_then(|locals| locals.get(id.index())),
        };
        demand.copied().unwrap_or_default()
    }

    fn raise(&mut self, function: FunctionId, variable: VarRef, demand: Demand) {
        let slot = match variable {
            VarRef::Global(id) => self.globals.get_mut(id.index()),
            VarRef::Local(id) => self.locals.get_mut(function.index()).and_then(|locals| locals.get_mut(id.index())),
        };
        if let Some(slot) = slot {
            let both = slot.and(demand);
            self.changed |= both != *slot;
            *slot = both;
        }
    }

    fn expr(&mut self, types: &Types, walked: &Walked, function: FunctionId, root: ExprId, demand: Demand) {
        let mut pending = vec![(root, demand)];
        while let Some((id, demand)) = pending.pop() {
            let kind = &walked.shader.expr(id).kind;
            if walked.literal(id, demand).is_some() {
                continue;
            }
            if let ExprKind::Var(variable) = kind {
                if demand.is_some() {
                    self.raise(function, *variable, demand);
                }
                continue;
            }
            if let ExprKind::Call(callee, arguments) = kind {
                self.call(walked, function, *callee, arguments, demand);
            }
            let demands = self.of_operands(types, walked, function, id, demand);
            pending.extend(kind.children().into_iter().zip(demands));
        }
    }

    /// The demands that go through parameters and results.
    fn call(
        &mut self,
        walked: &Walked,
        function: FunctionId,
        callee: FunctionId,
        arguments: &[ExprId],
        demand: Demand,
    ) {
        if let Some(result) = self.results.get_mut(callee.index()) {
            let both = result.and(demand);
            self.changed |= both != *result;
            *result = both;
        }
        for (index, argument) in arguments.iter().enumerate() {
            let mode = walked.shader.function(callee).param_mode(index);
            let param = VarRef::Local(glisten_front::hir::LocalId::new(index));
            if matches!(mode, ParamMode::Out | ParamMode::Inout)
                && let Some(variable) = walked.shader.root_variable(*argument)
            {
                let (outside, inside) = (self.of_variable(function, variable), self.of_variable(callee, param));
                self.raise(callee, param, outside);
                if mode == ParamMode::Inout {
                    self.raise(function, variable, inside);
                }
            }
        }
    }

    /// The demands of an expression on its operands, given the demand on itself.
    pub(super) fn of_operands(
        &self,
        types: &Types,
        walked: &Walked,
        function: FunctionId,
        id: ExprId,
        demand: Demand,
    ) -> SmallVec<[Demand; 4]> {
        let kind = &walked.shader.expr(id).kind;
        if self.fast {
            return SmallVec::from_elem(Demand::NONE, kind.children().len());
        }
        let mut demands = danger::own(types, walked, id);
        if self.cancelling.contains(&id) {
            demands.iter_mut().for_each(|slot| *slot = Demand::APART);
        }
        let through = self.through(walked, id, demand);
        match kind {
            ExprKind::Index(..) => demands[0] = demand,
            ExprKind::Ternary(..) => {
                demands[1] = demand;
                demands[2] = demand;
            }
            ExprKind::Comma(..) => demands[1] = demand,
            ExprKind::Assign(op, target, _) => {
                let variable = walked.shader.root_variable(*target);
                let stored = variable.map_or(Demand::NONE, |variable| self.of_variable(function, variable));
                let of_value = if op.is_none() || transparent_op(*op) { stored.and(demand) } else { Demand::NONE };
                demands[1] = demands[1].and(of_value);
            }
            ExprKind::Call(callee, _) => {
                for (index, slot) in demands.iter_mut().enumerate() {
                    *slot = self.of_variable(*callee, VarRef::Local(glisten_front::hir::LocalId::new(index)));
                }
            }
            ExprKind::Logical(..) => {}
            _ => demands.iter_mut().for_each(|slot| *slot = slot.and(through)),
        }
        demands
    }

    /// The demand that is handed on to all operands alike.
    fn through(&self, walked: &Walked, id: ExprId, demand: Demand) -> Demand {
        if !demand.is_some() {
            return Demand::NONE;
        }
        let transparent = match &walked.shader.expr(id).kind {
            ExprKind::Member(..)
            | ExprKind::Swizzle(..)
            | ExprKind::Convert(_)
            | ExprKind::Construct(..)
            | ExprKind::Unary(..) => true,
            ExprKind::Binary(op, ..) => transparent_op(Some(*op)) || demand.is_apart(),
            ExprKind::BuiltinCall(function, arguments) => {
                let literal = |fact: &Fact| fact.value().is_some();
                builtins::hands_on(*function)
                    || arguments.iter().all(|argument| walked.facts(*argument).iter().any(literal))
            }
            // These have no operands, or what goes through them is found in `of_operands`.
            ExprKind::Literal(_)
            | ExprKind::Var(_)
            | ExprKind::Index(..)
            | ExprKind::Logical(..)
            | ExprKind::Ternary(..)
            | ExprKind::Comma(..)
            | ExprKind::Assign(..)
            | ExprKind::IncDec(..)
            | ExprKind::Call(..)
            | ExprKind::Error => false,
        };
        let facts = walked.facts(id);
        let constant = !facts.is_empty() && facts.iter().all(|fact| fact.constant);
        if constant && demand == Demand::NO_ZERO && facts.iter().all(|fact| !fact.range().has_zero()) {
            return Demand::NONE;
        }
        match (constant, transparent) {
            // A driver could compute it from literals, whatever it comes to.
            (true, _) => demand.and(Demand::KEEP),
            (false, true) => demand,
            // What is known of the result a driver may find as well.
            (false, false) if demand.concerns(facts) => demand,
            (false, false) => Demand::NONE,
        }
    }
}

/// Whether a 0 among the operands makes a 0, or constants are joined through it.
fn transparent_op(op: Option<BinaryOp>) -> bool {
    matches!(op, Some(BinaryOp::Mul | BinaryOp::Div | BinaryOp::MatMul))
}
