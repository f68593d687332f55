//! Expressions: evaluated with what is known, written down as they are.

use super::{Forward, Val};
use crate::Math;
use crate::facts::{self, Call, Fact, Facts, Operation, What, at};
use crate::fast;
use crate::known::Input;
use glisten_front::builtin::BuiltinFunction;
use glisten_front::builtin::operations::{Class, Lookup};
use glisten_front::hir::{
    BinaryOp, ConstructKind, Expr, ExprId, ExprKind, IncDec, LogicalOp, SamplerDim, Scalar, ScalarValue, Type, TypeId,
};
use glisten_front::source::Span;

/// What an expression is and where it stands.
type Own = (TypeId, Span);

impl Forward<'_> {
    /// Evaluates an expression for its value.
    pub(super) fn eval(&mut self, id: ExprId) -> Val {
        match self.shader.expr(id).kind {
            ExprKind::Var(_) | ExprKind::Member(..) | ExprKind::Index(..) | ExprKind::Swizzle(..) => {
                let (mut value, place) = self.path(id);
                if let Some(place) = place.filter(|_| value.facts.is_empty())
                    && self.types.flat_len(self.shader.expr(id).ty) <= super::FOLLOWED
                {
                    value.facts = self.read(&place);
                }
                value
            }
            _ => self.eval_value(id),
        }
    }

    /// The same for what names no variable.
    pub(super) fn eval_value(&mut self, id: ExprId) -> Val {
        let Expr { kind, ty, span } = self.shader.expr(id).clone();
        let own = (ty, span);
        match kind {
            ExprKind::Literal(value) => {
                self.give(ExprKind::Literal(value), own, Facts::from_slice(&[Fact::literal(value)]))
            }
            ExprKind::Convert(a) => {
                let a = self.eval(a);
                let operand = (a.facts.as_slice(), self.out.expr(a.id).ty);
                let [from, to] = [operand.1, ty].map(|ty| self.types.scalar_of(ty).unwrap_or(Scalar::Float));
                let facts = self.improved(Operation::Convert, &[operand], ty, facts::convert(&a.facts, from, to));
                self.give(ExprKind::Convert(a.id), own, facts)
            }
            ExprKind::Construct(kind, arguments) => self.construct(kind, &arguments, own),
            ExprKind::Unary(op, a) => {
                let a = self.eval(a);
                let operand = (a.facts.as_slice(), self.out.expr(a.id).ty);
                let facts = self.improved(Operation::Unary(op), &[operand], ty, facts::unary(op, &a.facts));
                self.give(ExprKind::Unary(op, a.id), own, facts)
            }
            ExprKind::IncDec(op, target) => self.inc_dec(op, target, own),
            ExprKind::Binary(op, left, right) => self.binary(op, left, right, own),
            ExprKind::Logical(op, left, right) => self.logical(op, left, right, own),
            ExprKind::Ternary(condition, yes, no) => self.ternary(condition, yes, no, own),
            ExprKind::Assign(op, target, value) => self.assign(op, target, value, own),
            ExprKind::Comma(left, right) => {
                let left = self.eval(left);
                let right = self.eval(right);
                if self.is_pure(left.id) {
                    return right;
                }
                self.give(ExprKind::Comma(left.id, right.id), own, right.facts)
            }
            ExprKind::Call(function, arguments) => self.call(function, &arguments, own),
            ExprKind::BuiltinCall(function, arguments) => self.builtin_call(function, &arguments, own),
            ExprKind::Error => self.give(ExprKind::Error, own, Facts::new()),
            ExprKind::Var(_) | ExprKind::Member(..) | ExprKind::Index(..) | ExprKind::Swizzle(..) => self.path(id).0,
        }
    }

    /// Better facts of an operation's result: by the reference's arithmetic, under fast math by algebra instead.
    fn improved(&self, operation: Operation, operands: &[(&[Fact], TypeId)], ty: TypeId, facts: Facts) -> Facts {
        if self.math == Math::Fast {
            return fast::improved(self.types, self.shader, operation, operands, ty, facts);
        }
        let facts = facts::by_reference(self.types, self.shader, operation, operands, ty, facts);
        fast::finite(self.math, self.types, ty, facts)
    }

    /// Writes an expression down that has these facts.
    pub(super) fn give(&mut self, kind: ExprKind, (ty, span): Own, facts: Facts) -> Val {
        let id = self.push(kind, ty, span, &facts);
        Val { id, facts }
    }

    fn evaluated(&mut self, list: &[ExprId]) -> (Vec<ExprId>, Vec<(Facts, TypeId)>) {
        let mut ids = Vec::with_capacity(list.len());
        let mut facts = Vec::with_capacity(list.len());
        for argument in list {
            let value = self.eval(*argument);
            ids.push(value.id);
            facts.push((value.facts, self.shader.expr(*argument).ty));
        }
        (ids, facts)
    }

    fn construct(&mut self, kind: ConstructKind, arguments: &[ExprId], own: Own) -> Val {
        let (ids, facts) = self.evaluated(arguments);
        let len = self.types.flat_len(own.0) as usize;
        let facts =
            if len > super::FOLLOWED as usize { Facts::new() } else { self.constructed(kind, own.0, &facts, len) };
        let facts = fast::finite(self.math, self.types, own.0, facts);
        self.give(ExprKind::Construct(kind, ids), own, facts)
    }

    fn constructed(&self, kind: ConstructKind, ty: TypeId, arguments: &[(Facts, TypeId)], len: usize) -> Facts {
        let first = arguments.first().map_or(&[][..], |(facts, _)| facts);
        match kind {
            ConstructKind::Splat => Facts::from_elem(at(first, 0), len),
            ConstructKind::Compose | ConstructKind::Array | ConstructKind::Struct => {
                let all = arguments
                    .iter()
                    .flat_map(|(facts, ty)| (0..self.types.flat_len(*ty) as usize).map(|index| at(facts, index)));
                let is_mixed = kind == ConstructKind::Compose && arguments.len() > 1;
                all.take(len).map(|fact| if is_mixed { fact.apart() } else { fact }).collect()
            }
            ConstructKind::Diagonal | ConstructKind::Resize => {
                let Type::Matrix(columns, rows) = self.types.get(ty) else { return Facts::new() };
                let inner = match arguments.first().map(|(_, ty)| self.types.get(*ty)) {
                    Some(Type::Matrix(columns, rows)) => (usize::from(columns), usize::from(rows)),
                    _ => (0, 0),
                };
                let component = |column: usize, row: usize| {
                    let literal = |value| Fact::literal(ScalarValue::Float(value));
                    match kind {
                        ConstructKind::Diagonal if column == row => at(first, 0),
                        ConstructKind::Resize if column < inner.0 && row < inner.1 => at(first, column * inner.1 + row),
                        _ => literal(if column == row { 1.0 } else { 0.0 }),
                    }
                };
                let (columns, rows) = (usize::from(columns), usize::from(rows));
                (0..columns).flat_map(|column| (0..rows).map(move |row| component(column, row))).collect()
            }
        }
    }

    fn binary(&mut self, op: BinaryOp, left: ExprId, right: ExprId, own: Own) -> Val {
        let types = (self.shader.expr(left).ty, self.shader.expr(right).ty);
        let (a, b) = (self.eval(left), self.eval(right));
        let facts = self.operated(op, (&a.facts, types.0), (&b.facts, types.1), own.0);
        self.give(ExprKind::Binary(op, a.id, b.id), own, facts)
    }

    /// The facts of `a op b`.
    fn operated(&self, op: BinaryOp, a: (&[Fact], TypeId), b: (&[Fact], TypeId), ty: TypeId) -> Facts {
        let scalar = self.types.scalar_of(a.1).unwrap_or(Scalar::Bool);
        if matches!(op, BinaryOp::Equal | BinaryOp::NotEqual) && self.types.scalar_of(a.1).is_none() {
            return Facts::new();
        }
        let facts = match op {
            BinaryOp::MatMul => facts::mat_mul(self.types, a, b),
            _ => facts::binary(op, scalar, self.types.flat_len(ty) as usize, a.0, b.0),
        };
        self.improved(Operation::Binary(op), &[a, b], ty, facts)
    }

    /// Notes whether a condition is decided.
    pub(super) fn tell_truth(&mut self, condition: ExprId, truth: Option<bool>) {
        let reason = truth.map_or(super::Reason::Open, super::Reason::Condition);
        self.tell(self.shader.expr(condition).span, reason);
    }

    fn logical(&mut self, op: LogicalOp, left: ExprId, right: ExprId, own: Own) -> Val {
        let a = self.eval(left);
        let decided = op == LogicalOp::Or;
        let truth = at(&a.facts, 0).truth();
        self.tell_truth(left, truth);
        match truth {
            Some(truth) if truth == decided => a,
            Some(_) => {
                let b = self.eval(right);
                if self.is_pure(a.id) { b } else { self.give(ExprKind::Logical(op, a.id, b.id), own, b.facts) }
            }
            None => {
                let mark = self.store.mark();
                self.forks += 1;
                self.refine(left, a.id, op == LogicalOp::And);
                let b = self.eval(right);
                self.forks -= 1;
                let changes = self.store.changes(mark);
                self.store.roll_back(mark);
                self.store.meet(&changes, mark);
                let fact = match at(&b.facts, 0).truth() {
                    Some(truth) if truth == decided => Fact::of(What::Value(ScalarValue::Bool(truth)), false, true),
                    _ => Fact::of(What::Any, at(&a.facts, 0).constant && at(&b.facts, 0).constant, true),
                };
                self.give(ExprKind::Logical(op, a.id, b.id), own, Facts::from_slice(&[fact]))
            }
        }
    }

    fn ternary(&mut self, condition: ExprId, yes: ExprId, no: ExprId, own: Own) -> Val {
        let c = self.eval(condition);
        let truth = at(&c.facts, 0).truth();
        self.tell_truth(condition, truth);
        if let Some(truth) = truth {
            let chosen = self.eval(if truth { yes } else { no });
            if self.is_pure(c.id) {
                return chosen;
            }
            return self.give(ExprKind::Comma(c.id, chosen.id), own, chosen.facts);
        }
        self.forks += 1;
        let mark = self.store.mark();
        self.refine(condition, c.id, true);
        let a = self.eval(yes);
        let changes = self.store.changes(mark);
        self.store.roll_back(mark);
        self.refine(condition, c.id, false);
        let b = self.eval(no);
        self.forks -= 1;
        self.store.meet(&changes, mark);
        let facts = if a.facts.len() == b.facts.len() { facts::join(&a.facts, &b.facts) } else { Facts::new() };
        let constant = at(&c.facts, 0).constant;
        let facts = facts.into_iter().map(|fact| Fact { constant: fact.constant && constant, ..fact }).collect();
        self.give(ExprKind::Ternary(c.id, a.id, b.id), own, facts)
    }

    fn assign(&mut self, op: Option<BinaryOp>, target: ExprId, value: ExprId, own: Own) -> Val {
        let types = (self.shader.expr(target).ty, self.shader.expr(value).ty);
        let (to, place) = self.path(target);
        let from = self.eval(value);
        let old = match (&place, self.is_pure(from.id)) {
            (Some(place), true) if op.is_some() => self.read(place),
            _ => Facts::new(),
        };
        let facts = match op {
            Some(op) => self.operated(op, (&old, types.0), (&from.facts, types.1), types.0),
            None => from.facts,
        };
        if let Some(place) = &place {
            self.write(place, &facts);
        }
        let value = self.give(ExprKind::Assign(op, to.id, from.id), own, facts);
        if op.is_some() && !old.is_empty() {
            self.before.insert(value.id, old);
        }
        value
    }

    fn inc_dec(&mut self, op: IncDec, target: ExprId, own: Own) -> Val {
        let (to, place) = self.path(target);
        let old = place.as_ref().map_or_else(Facts::new, |place| self.read(place));
        let scalar = self.types.scalar_of(own.0).unwrap_or(Scalar::Int);
        let one = Fact::literal(match scalar {
            Scalar::Uint => ScalarValue::Uint(1),
            Scalar::Float => ScalarValue::Float(1.0),
            Scalar::Int | Scalar::Bool => ScalarValue::Int(1),
        });
        let up = matches!(op, IncDec::PreIncrement | IncDec::PostIncrement);
        let len = self.types.flat_len(own.0) as usize;
        let new = facts::binary(if up { BinaryOp::Add } else { BinaryOp::Sub }, scalar, len, &old, &[one]);
        if let Some(place) = &place {
            self.write(place, &new);
        }
        let post = matches!(op, IncDec::PostIncrement | IncDec::PostDecrement);
        let value = self.give(ExprKind::IncDec(op, to.id), own, if post { old } else { new.clone() });
        // What the target holds afterwards, for a statement of its own.
        self.before.insert(value.id, new);
        value
    }

    fn builtin_call(&mut self, function: BuiltinFunction, arguments: &[ExprId], own: Own) -> Val {
        if let Some(index) = function.written_argument() {
            return self.writing_call(function, index, arguments, own);
        }
        let (ids, facts) = self.evaluated(arguments);
        let sampler = facts.first().map(|(_, ty)| self.types.get(*ty));
        let result = match sampler {
            Some(Type::Sampler(sampler)) => self.texture(function, sampler.dim, &facts, own.0),
            _ => {
                let twice = matches!(arguments, [a, b] if self.same_variable(*a, *b));
                let result = facts::builtin(&Call { types: self.types, function, arguments: &facts, ty: own.0, twice });
                let operands: Vec<(&[Fact], TypeId)> =
                    facts.iter().map(|(facts, ty)| (facts.as_slice(), *ty)).collect();
                self.improved(Operation::Call(function), &operands, own.0, result)
            }
        };
        self.give(ExprKind::BuiltinCall(function, ids), own, result)
    }

    /// Whether two expressions name the same variable.
    fn same_variable(&self, a: ExprId, b: ExprId) -> bool {
        match (&self.shader.expr(a).kind, &self.shader.expr(b).kind) {
            (ExprKind::Var(a), ExprKind::Var(b)) => a == b,
            _ => false,
        }
    }

    /// A call that writes one of its arguments: nothing is known of what it gives and writes.
    fn writing_call(&mut self, function: BuiltinFunction, written: usize, arguments: &[ExprId], own: Own) -> Val {
        let mut ids = Vec::with_capacity(arguments.len());
        let mut target = None;
        for (index, argument) in arguments.iter().enumerate() {
            if index == written {
                let (value, place) = self.path(*argument);
                ids.push(value.id);
                target = place.map(|place| (place, self.shader.expr(*argument).ty));
            } else {
                ids.push(self.eval(*argument).id);
            }
        }
        if let Some((place, ty)) = target {
            let unknown = vec![Fact::ANY; self.types.flat_len(ty) as usize];
            self.write(&place, &unknown);
        }
        self.give(ExprKind::BuiltinCall(function, ids), own, Facts::new())
    }

    /// What is known of a lookup, by the sampler that the first argument is.
    fn texture(&self, function: BuiltinFunction, dim: SamplerDim, arguments: &[(Facts, TypeId)], ty: TypeId) -> Facts {
        let Some(ScalarValue::Int(slot)) = arguments.first().and_then(|(facts, _)| at(facts, 0).value()) else {
            return Facts::new();
        };
        let Some(Some(texture)) = self.textures.get(slot as usize) else { return Facts::new() };
        let len = self.types.flat_len(ty) as usize;
        let Class::Texture(form) = function.class() else { return Facts::new() };
        match form.lookup {
            Lookup::Size => {
                let level = match arguments.get(1).map(|(facts, _)| at(facts, 0).value()) {
                    None => 0,
                    Some(Some(ScalarValue::Int(level))) => level,
                    Some(_) => -1,
                };
                let size = usize::try_from(level).ok().and_then(|level| texture.sizes.get(level));
                size.map_or_else(Facts::new, |size| {
                    size.iter().take(len).map(|n| Fact::bound(ScalarValue::Int(*n as i32))).collect()
                })
            }
            Lookup::Fetch => {
                // Past the edges there is 0, or anything that the texture holds.
                let zero = Fact::in_range(facts::Range::point(0.0));
                texture.channels.iter().take(len).map(|channel| fetched(*channel).join(zero)).collect()
            }
            // The channels of these are no colors, or not one texel's.
            Lookup::Gather | Lookup::QueryLod | Lookup::Levels => Facts::new(),
            Lookup::Implicit | Lookup::Lod | Lookup::Grad if dim == SamplerDim::Buffer => Facts::new(),
            Lookup::Implicit | Lookup::Lod | Lookup::Grad => {
                texture.channels.iter().take(len).map(|channel| looked_up(*channel)).collect()
            }
        }
    }
}

/// What a channel of a lookup is.
fn looked_up(channel: Input) -> Fact {
    match channel {
        Input::Value(value) => Fact::bound(value),
        Input::Between(low, high) => Fact::in_range(facts::Range::between(f64::from(low), f64::from(high))),
        Input::Unsigned(low, high) => crate::inputs::unsigned(low, high),
        Input::Open => Fact::ANY,
    }
}

/// What a channel of a texel is; integers and what is open stay so.
fn fetched(channel: Input) -> Fact {
    match channel {
        Input::Value(ScalarValue::Float(value)) => Fact::in_range(facts::Range::point(value)),
        Input::Value(_) | Input::Open => Fact::ANY,
        Input::Between(..) | Input::Unsigned(..) => looked_up(channel),
    }
}
