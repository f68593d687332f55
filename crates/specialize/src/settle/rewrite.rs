//! Writes the settled stage.
//!
//! *In:* a walked stage and its demands. *Out:* a shader of its own. *Holds:* a uniform that is known and used as a whole
//! becomes a `const` of its name where that reads better than its numbers; statements that do nothing are gone.

use super::{Demand, Demands, identities};
use crate::facts::{Fact, Facts};
use crate::forward::Walked;
use glisten_front::hir::{
    BinaryOp, Case, Condition, ConstructKind, Expr, ExprId, ExprKind, FunctionId, GlobalId, Scalar, ScalarValue,
    Shader, Stmt, StmtKind, Storage, Swizzle, Type, TypeId, Types, UnaryOp, Value, VarRef, may_act,
};
use glisten_front::link::SamplerSlot;
use glisten_front::source::Span;
use glisten_front::stack::with_stack;
use smallvec::SmallVec;
use std::collections::BTreeMap;

/// A settled stage.
pub(crate) struct Settled {
    /// The stage that is left.
    pub(crate) shader: Shader,
    /// For each function of it the one that it comes from.
    pub(crate) origins: Vec<FunctionId>,
    /// How many elements of an array open indices may reach, by the name of the global.
    pub(crate) reach: BTreeMap<String, u32>,
}

struct Writer<'a> {
    types: &'a Types,
    walked: &'a Walked,
    demands: &'a Demands,
    samplers: &'a [SamplerSlot],
    out: Shader,
    function: FunctionId,
    /// Globals that are read as they are.
    read: Vec<bool>,
    reach: BTreeMap<String, u32>,
}

/// Settles a stage.
pub(crate) fn settle(types: &Types, walked: &Walked, demands: &Demands, samplers: &[SamplerSlot]) -> Settled {
    with_stack(walked.shader.depth.saturating_mul(2).saturating_add(1024), move || {
        let mut out = walked.shader.clone();
        out.exprs.clear();
        let n_globals = out.globals.len();
        let mut writer = Writer {
            types,
            walked,
            demands,
            samplers,
            out,
            function: FunctionId::new(0),
            read: vec![false; n_globals],
            reach: BTreeMap::new(),
        };
        writer.run();
        Settled { shader: writer.out, origins: walked.origins.clone(), reach: writer.reach }
    })
}

impl Writer<'_> {
    fn run(&mut self) {
        let walked = self.walked;
        for (id, global) in walked.shader.globals() {
            if let Some(initializer) = global.initializer {
                let demand = self.demands.of_variable(FunctionId::new(0), VarRef::Global(id));
                let initializer = self.expr(initializer, demand);
                if let Some(global) = self.out.globals.get_mut(id.index()) {
                    global.initializer = Some(initializer);
                }
            }
        }
        for (id, function) in walked.shader.functions() {
            self.function = id;
            if let Some(body) = &function.body {
                let body = self.body(body);
                if let Some(function) = self.out.functions.get_mut(id.index()) {
                    function.body = Some(body);
                }
            }
        }
        self.name_constants();
    }

    /// Uniforms whose every use is known become constants of their name.
    fn name_constants(&mut self) {
        for index in 0..self.out.globals.len() {
            let id = GlobalId::new(index);
            let read = self.read.get(index).copied().unwrap_or(true);
            let Some(value) = self.known_whole(id).filter(|_| !read) else { continue };
            if let Some(global) = self.out.globals.get_mut(index) {
                global.storage = Storage::Const;
                global.value = Some(value);
                global.initializer = None;
                (global.location, global.binding) = (None, None);
            }
        }
    }

    /// The value of a uniform that is worth a name of its own: of a matrix, or of a vector that is used twice.
    fn known_whole(&self, id: GlobalId) -> Option<Value> {
        let global = self.out.globals.get(id.index())?;
        let (first, uses) = *self.walked.named.get(&id)?;
        let worth = match self.types.get(global.ty) {
            Type::Matrix(..) => true,
            Type::Vector(..) => uses > 1,
            _ => false,
        };
        if global.storage != Storage::Uniform || global.block.is_some() || global.builtin.is_some() || !worth {
            return None;
        }
        let scalars = self.walked.literal(first, Demand::NONE)?;
        Some(Value { ty: global.ty, scalars: scalars.into_vec() })
    }

    fn push(&mut self, kind: ExprKind, ty: TypeId, span: Span) -> ExprId {
        self.out.push(kind, ty, span)
    }

    /// Numbers in the place of an expression.
    fn literal(&mut self, values: &[ScalarValue], ty: TypeId, span: Span) -> ExprId {
        let Some(first) = values.first().copied() else { return self.push(ExprKind::Error, ty, span) };
        let scalar_ty = TypeId::vector(first.scalar(), 1);
        let one = |this: &mut Self, value| this.push(ExprKind::Literal(value), scalar_ty, span);
        match self.types.get(ty) {
            Type::Vector(..) if values.iter().all(|value| value.is_same(first)) => {
                let value = one(self, first);
                self.push(ExprKind::Construct(ConstructKind::Splat, vec![value]), ty, span)
            }
            Type::Matrix(columns, rows) if is_diagonal(values, columns, rows) => {
                let value = one(self, first);
                self.push(ExprKind::Construct(ConstructKind::Diagonal, vec![value]), ty, span)
            }
            Type::Vector(..) | Type::Matrix(..) => {
                let values = values.iter().map(|value| one(self, *value)).collect();
                self.push(ExprKind::Construct(ConstructKind::Compose, values), ty, span)
            }
            _ => one(self, first),
        }
    }

    /// Writes an expression of which this is demanded.
    fn expr(&mut self, id: ExprId, demand: Demand) -> ExprId {
        let Expr { kind, ty, span } = self.walked.shader.expr(id).clone();
        if let Some(values) = self.walked.literal(id, demand) {
            return self.known(&kind, &values, ty, span);
        }
        if let Some(given) = self.given_back(id, demand) {
            return given;
        }
        let demands = self.demands.of_operands(self.types, self.walked, self.function, id, demand);
        let of = |index: usize| demands.get(index).copied().unwrap_or(Demand::KEEP);
        let kind = match kind {
            ExprKind::Var(variable) => return self.variable(id, variable, ty, span),
            ExprKind::Assign(op, target, value) => return self.assign(id, (op, target, value), of(1), (ty, span)),
            ExprKind::IncDec(op, target) => ExprKind::IncDec(op, self.place(target)),
            ExprKind::Literal(_) | ExprKind::Error => kind,
            ExprKind::Member(base, member) => ExprKind::Member(self.expr(base, of(0)), member),
            ExprKind::Index(base, index) => {
                let count = self.elements(base);
                self.reaches(base, index, count);
                let base = self.expr(base, of(0));
                ExprKind::Index(base, self.index(index, count))
            }
            ExprKind::Swizzle(base, swizzle) => ExprKind::Swizzle(self.expr(base, of(0)), swizzle),
            ExprKind::Convert(a) => ExprKind::Convert(self.expr(a, of(0))),
            ExprKind::Construct(kind, list) => ExprKind::Construct(kind, self.list(&list, &of)),
            ExprKind::Unary(op, a) => ExprKind::Unary(op, self.expr(a, of(0))),
            ExprKind::Binary(op, a, b) => {
                let (left, right) = (self.expr(a, of(0)), self.expr(b, of(1)));
                let scalar = self.narrowed(op, a, left, b);
                let other = if scalar == left { self.narrowed(op, b, right, a) } else { right };
                ExprKind::Binary(op, scalar, other)
            }
            ExprKind::Logical(op, a, b) => ExprKind::Logical(op, self.expr(a, of(0)), self.expr(b, of(1))),
            ExprKind::Ternary(c, a, b) => {
                ExprKind::Ternary(self.expr(c, of(0)), self.expr(a, of(1)), self.expr(b, of(2)))
            }
            ExprKind::Comma(a, b) => ExprKind::Comma(self.expr(a, of(0)), self.expr(b, of(1))),
            ExprKind::Call(callee, list) => ExprKind::Call(callee, self.arguments(callee, &list, &of)),
            ExprKind::BuiltinCall(function, list) => {
                let written = function.written_argument();
                let list = list.iter().enumerate();
                let list = list.map(|(index, argument)| {
                    if written == Some(index) { self.place(*argument) } else { self.expr(*argument, of(index)) }
                });
                ExprKind::BuiltinCall(function, list.collect())
            }
        };
        self.push(kind, ty, span)
    }

    /// What an operation gives back of one of its operands alone.
    fn given_back(&mut self, id: ExprId, demand: Demand) -> Option<ExprId> {
        if demand.is_apart() {
            return None;
        }
        let walked = self.walked;
        if let Some((operand, part)) = identities::part(walked, id) {
            return self.part_of(id, (operand, part), demand);
        }
        let whole = identities::operand(walked, id);
        let spread = whole.is_none().then(|| identities::spread_operand(walked, id)).flatten();
        let negated = whole.is_none().then(|| identities::negated_operand(walked, id)).flatten();
        let operand = whole.or(spread).or(negated)?;
        let Expr { kind, ty, span } = walked.shader.expr(id);
        let child = kind.children().get(operand).copied()?;
        let own = self.demands.of_operands(self.types, walked, self.function, id, demand);
        let own = own.get(operand).copied().unwrap_or(Demand::KEEP);
        let given = self.expr(child, own.and(demand));
        Some(if spread.is_some() {
            self.push(ExprKind::Construct(ConstructKind::Splat, vec![given]), *ty, *span)
        } else if negated.is_some() {
            self.push(ExprKind::Unary(UnaryOp::Not, given), *ty, *span)
        } else {
            given
        })
    }

    /// A component or a column of an operand.
    fn part_of(&mut self, id: ExprId, (operand, part): (usize, u8), demand: Demand) -> Option<ExprId> {
        let walked = self.walked;
        let Expr { kind, ty, span } = walked.shader.expr(id);
        let child = kind.children().get(operand).copied()?;
        let of = &walked.shader.expr(child);
        let own = self.demands.of_operands(self.types, walked, self.function, id, demand);
        let demand = own.get(operand).copied().unwrap_or(Demand::KEEP).and(demand);
        if let Type::Vector(..) = self.types.get(of.ty) {
            let given = self.expr(child, demand);
            let component = Swizzle { len: 1, components: [part, 0, 0, 0] };
            return Some(self.push(ExprKind::Swizzle(given, component), *ty, *span));
        }
        if let ExprKind::Construct(ConstructKind::Compose, columns) = &of.kind
            && columns.iter().all(|column| walked.shader.expr(*column).ty == *ty)
            && columns.iter().all(|column| walked.notes.get(column.index()).is_some_and(|note| note.pure))
        {
            return columns.get(usize::from(part)).map(|column| self.expr(*column, demand));
        }
        let given = self.expr(child, demand);
        let index = self.literal(&[ScalarValue::Int(i32::from(part))], TypeId::INT, *span);
        Some(self.push(ExprKind::Index(given, index), *ty, *span))
    }

    /// An operand that became a scalar in every component: next to a vector the scalar will do.
    fn narrowed(&self, op: BinaryOp, from: ExprId, operand: ExprId, other: ExprId) -> ExprId {
        let takes_scalars = matches!(op, BinaryOp::Add | BinaryOp::Sub | BinaryOp::Mul | BinaryOp::Div);
        let same = self.walked.shader.expr(other).ty == self.walked.shader.expr(from).ty;
        let written = matches!(self.walked.shader.expr(from).kind, ExprKind::Construct(..));
        match &self.out.expr(operand).kind {
            ExprKind::Construct(ConstructKind::Splat, parts) if takes_scalars && same && !written => {
                let open = |part: &&ExprId| !matches!(self.out.expr(**part).kind, ExprKind::Literal(_));
                parts.first().filter(open).copied().unwrap_or(operand)
            }
            _ => operand,
        }
    }

    fn list(&mut self, list: &[ExprId], of: &dyn Fn(usize) -> Demand) -> Vec<ExprId> {
        list.iter().enumerate().map(|(index, argument)| self.expr(*argument, of(index))).collect()
    }

    fn arguments(&mut self, callee: FunctionId, list: &[ExprId], of: &dyn Fn(usize) -> Demand) -> Vec<ExprId> {
        let walked = self.walked;
        let function = walked.shader.function(callee);
        let each = list.iter().enumerate();
        each.map(|(index, argument)| {
            if crate::forward::is_in(function.param_mode(index)) {
                self.expr(*argument, of(index))
            } else {
                self.place(*argument)
            }
        })
        .collect()
    }

    /// A value that is known: its name if it has one that stays, else its numbers.
    fn known(&mut self, kind: &ExprKind, values: &[ScalarValue], ty: TypeId, span: Span) -> ExprId {
        let keeps_its_name = match kind {
            ExprKind::Var(VarRef::Global(id)) => {
                self.walked.shader.global(*id).storage == Storage::Const || self.known_whole(*id).is_some()
            }
            ExprKind::Var(VarRef::Local(id)) => {
                let function = self.walked.shader.function(self.function);
                function.local(*id).kind == glisten_front::hir::LocalKind::Const
            }
            _ => false,
        };
        if keeps_its_name {
            return self.push(kind.clone(), ty, span);
        }
        self.literal(values, ty, span)
    }

    fn variable(&mut self, id: ExprId, variable: VarRef, ty: TypeId, span: Span) -> ExprId {
        if let (VarRef::Local(_), Type::Sampler(_)) = (variable, self.types.get(ty))
            && let Some(sampler) = self.sampler(id, ty, span)
        {
            return sampler;
        }
        if let VarRef::Global(id) = variable
            && let Some(read) = self.read.get_mut(id.index())
        {
            *read = true;
        }
        self.push(ExprKind::Var(variable), ty, span)
    }

    /// The uniform that a sampler parameter stands for.
    fn sampler(&mut self, id: ExprId, ty: TypeId, span: Span) -> Option<ExprId> {
        let Some(ScalarValue::Int(slot)) = self.walked.facts(id).first()?.value() else { return None };
        let slot = self.samplers.get(slot as usize)?;
        let stage = self.walked.shader.stage;
        let (_, global) = slot.globals.iter().find(|(of, _)| *of == stage)?;
        let global_ty = self.walked.shader.global(*global).ty;
        let base = self.push(ExprKind::Var(VarRef::Global(*global)), global_ty, span);
        match self.types.get(global_ty) {
            Type::Sampler(_) => Some(base),
            Type::Array(element, _) if element == ty => {
                let index = self.literal(&[ScalarValue::Int(slot.flat_offset as i32)], TypeId::INT, span);
                Some(self.push(ExprKind::Index(base, index), ty, span))
            }
            _ => None,
        }
    }

    fn elements(&self, base: ExprId) -> u32 {
        match self.types.get(self.walked.shader.expr(base).ty) {
            Type::Array(_, glisten_front::hir::ArraySize::Sized(size)) => size,
            Type::Matrix(columns, _) => u32::from(columns),
            Type::Vector(_, size) => u32::from(size),
            _ => 1,
        }
    }

    /// Notes how far an open index goes into a global. An index is limited into range, so a shorter array gives the same
    /// element for every index that it has.
    fn reaches(&mut self, base: ExprId, index: ExprId, count: u32) {
        let ExprKind::Var(VarRef::Global(global)) = self.walked.shader.expr(base).kind else { return };
        let fact = self.walked.facts(index).first().copied().unwrap_or(Fact::ANY);
        let scalar = self.types.scalar_of(self.walked.shader.expr(index).ty).unwrap_or(Scalar::Int);
        let (low, high) = fact.integers(scalar);
        let last = i64::from(count.max(1)) - 1;
        let n_elements = if low < 0 { count } else { high.min(last) as u32 + 1 };
        let name = &self.walked.shader.global(global).name;
        match self.reach.get_mut(name) {
            Some(known) => *known = n_elements.max(*known),
            None => {
                self.reach.insert(name.clone(), n_elements);
            }
        }
    }

    /// An index; one that is known is limited into range, as the reference does.
    fn index(&mut self, index: ExprId, count: u32) -> ExprId {
        let Expr { ty, span, .. } = self.walked.shader.expr(index).clone();
        let last = i64::from(count.max(1)) - 1;
        let known = self.walked.literal(index, Demand::NONE).and_then(|values| values.first().copied());
        match known {
            Some(ScalarValue::Int(value)) if i64::from(value) < 0 || i64::from(value) > last => {
                let value = i64::from(value).clamp(0, last) as i32;
                self.literal(&[ScalarValue::Int(value)], ty, span)
            }
            Some(ScalarValue::Uint(value)) if i64::from(value) > last => {
                self.literal(&[ScalarValue::Uint(last as u32)], ty, span)
            }
            _ => self.expr(index, Demand::NONE),
        }
    }

    /// An l-value stays what it is; its indices are settled.
    fn place(&mut self, id: ExprId) -> ExprId {
        let Expr { kind, ty, span } = self.walked.shader.expr(id).clone();
        let kind = match kind {
            ExprKind::Member(base, member) => ExprKind::Member(self.place(base), member),
            ExprKind::Swizzle(base, swizzle) => ExprKind::Swizzle(self.place(base), swizzle),
            ExprKind::Index(base, index) => {
                let count = self.elements(base);
                let base = self.place(base);
                ExprKind::Index(base, self.index(index, count))
            }
            ExprKind::Var(variable) => return self.push(ExprKind::Var(variable), ty, span),
            _ => return self.expr(id, Demand::NONE),
        };
        self.push(kind, ty, span)
    }

    fn assign(
        &mut self,
        id: ExprId,
        (op, target, value): (Option<BinaryOp>, ExprId, ExprId),
        demand: Demand,
        (ty, span): (TypeId, Span),
    ) -> ExprId {
        let pure = self.walked.notes.get(value.index()).is_some_and(|note| note.pure);
        if let Some(compound) = op
            && pure
        {
            let variable = self.walked.shader.root_variable(target);
            let stored = variable.map_or(Demand::KEEP, |variable| self.demands.of_variable(self.function, variable));
            if let Some(values) = self.settled_values(self.walked.facts(id), stored) {
                let to = self.place(target);
                let value = self.literal(&values, ty, span);
                return self.push(ExprKind::Assign(None, to, value), ty, span);
            }
            let before = self.walked.before.get(&id);
            let known = before.map_or(&[][..], |before| before);
            let walked = self.walked;
            let seen = |facts: &[Fact]| identities::as_seen(walked, id, facts).into_owned();
            let given = seen(self.walked.facts(value));
            let neutral = identities::keeps(compound, self.walked.math, &seen(known), &given);
            if neutral && !stored.is_apart() && !self.acts(target) {
                // As a statement that does nothing it goes later.
                let to = self.place(target);
                let same = self.place(target);
                return self.push(ExprKind::Assign(None, to, same), ty, span);
            }
            let of_value = self.walked.shader.expr(value).ty;
            let spread = identities::is_vector_of(ty, of_value);
            let starts = |before: &Facts| identities::starts(compound, &seen(before), &given);
            if (of_value == ty || spread) && before.is_some_and(starts) {
                let to = self.place(target);
                let value = self.expr(value, demand.and(stored));
                let splat = ExprKind::Construct(ConstructKind::Splat, vec![value]);
                let value = if spread { self.push(splat, ty, span) } else { value };
                return self.push(ExprKind::Assign(None, to, value), ty, span);
            }
        }
        let to = self.place(target);
        let written = self.expr(value, demand);
        let written = op.map_or(written, |op| self.narrowed(op, value, written, target));
        self.push(ExprKind::Assign(op, to, written), ty, span)
    }

    /// Whether evaluating a place does something.
    fn acts(&self, target: ExprId) -> bool {
        let mut acts = false;
        self.walked.shader.visit_expr(target, &mut |expr| acts |= may_act(&self.walked.shader.expr(expr).kind));
        acts
    }

    /// Values that may be written as numbers.
    fn settled_values(&self, facts: &[Fact], demand: Demand) -> Option<SmallVec<[ScalarValue; 4]>> {
        let values = super::facts::values(facts)?;
        let plain =
            |value: &ScalarValue| !matches!(value, ScalarValue::Float(value) if !value.is_normal() && *value != 0.0);
        (values.iter().all(plain) && !demand.hits(facts) && values.len() <= 16).then_some(values)
    }

    fn body(&mut self, body: &[Stmt]) -> Vec<Stmt> {
        let mut out = Vec::with_capacity(body.len());
        for stmt in body {
            if let Some(kind) = self.statement(stmt) {
                out.push(Stmt { kind, span: stmt.span });
            }
        }
        out
    }

    fn statement(&mut self, stmt: &Stmt) -> Option<StmtKind> {
        let demand = self.demands.of_statement(self.function, &stmt.kind);
        Some(match &stmt.kind {
            StmtKind::Expr(expr) => {
                if self.walked.notes.get(expr.index()).is_some_and(|note| note.pure) {
                    return None;
                }
                StmtKind::Expr(self.root(*expr))
            }
            StmtKind::Local(local, initializer) => {
                StmtKind::Local(*local, initializer.map(|initializer| self.expr(initializer, demand)))
            }
            StmtKind::Block(body) => StmtKind::Block(self.body(body)),
            StmtKind::If { arms, otherwise } => {
                let arms = arms.iter().map(|(condition, body)| (self.expr(*condition, Demand::NONE), self.body(body)));
                let arms = arms.collect();
                StmtKind::If { arms, otherwise: self.body(otherwise) }
            }
            StmtKind::Switch { selector, cases } => {
                let selector = self.expr(*selector, Demand::NONE);
                let cases = cases.iter().map(|case| Case { labels: case.labels.clone(), body: self.body(&case.body) });
                StmtKind::Switch { selector, cases: cases.collect() }
            }
            StmtKind::Loop { kind, condition, step, body } => {
                let condition = condition.as_ref().map(|condition| Condition {
                    local: condition.local,
                    expr: self.expr(condition.expr, Demand::NONE),
                });
                let step = step.map(|step| self.root(step));
                StmtKind::Loop { kind: *kind, condition, step, body: self.body(body) }
            }
            StmtKind::Return(value) => StmtKind::Return(value.map(|value| self.expr(value, demand))),
            StmtKind::Break => StmtKind::Break,
            StmtKind::Continue => StmtKind::Continue,
            StmtKind::Discard => StmtKind::Discard,
        })
    }

    /// An expression for its effects alone: `i++` whose result is known becomes `i = 5`.
    fn root(&mut self, id: ExprId) -> ExprId {
        let Expr { kind, ty, span } = self.walked.shader.expr(id).clone();
        if let ExprKind::IncDec(_, target) = kind
            && let Some(after) = self.walked.before.get(&id)
        {
            let variable = self.walked.shader.root_variable(target);
            let stored = variable.map_or(Demand::KEEP, |variable| self.demands.of_variable(self.function, variable));
            if let Some(values) = self.settled_values(after, stored) {
                let to = self.place(target);
                let value = self.literal(&values, ty, span);
                return self.push(ExprKind::Assign(None, to, value), ty, span);
            }
        }
        self.expr(id, Demand::NONE)
    }
}

/// Whether a matrix has one number on its diagonal and 0 elsewhere.
fn is_diagonal(values: &[ScalarValue], columns: u8, rows: u8) -> bool {
    let zero = ScalarValue::Float(0.0);
    let first = values.first().copied().unwrap_or(zero);
    (0..columns).all(|column| {
        (0..rows).all(|row| {
            let value = values.get(usize::from(column) * usize::from(rows) + usize::from(row)).copied().unwrap_or(zero);
            value.is_same(if column == row { first } else { zero })
        })
    })
}
