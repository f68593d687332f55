//! [`Uses`]: how often each variable, member and function of a stage is read and named.
//!
//! *In:* a stage. *Out:* counts, over what `main` reaches. *Holds:* a store does not read what it stores to, nor does
//! `x = f(x)` read `x`: nobody else may want it. It does if `f` acts, since what it does may depend on `x`. Of components, columns and
//! elements with known numbers only `v.x = f(v.x)` is such a store.

use crate::forward::Effects;
use glisten_front::hir::{
    BinaryOp, ExprId, ExprKind, FunctionId, GlobalId, LocalId, ParamMode, ScalarValue, Shader, Stmt, StmtKind, Storage,
    StructId, Type, TypeId, Types, VarRef, may_act,
};
use rustc_hash::FxHashMap;

/// Counts by variable.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Count {
    /// How often its value is wanted.
    pub(super) reads: i32,
    /// How often it is named at all.
    pub(super) named: i32,
    /// How often it is read as a whole, or at a place that is open.
    pub(super) whole: i32,
    /// How often each of its first components, columns or elements is read by its number.
    parts: [i32; FIRST_PARTS],
}

impl Count {
    /// Of a variable that is not known.
    const ANY: Self = Self { reads: 1, named: 1, whole: 1, parts: [1; FIRST_PARTS] };
}

/// The parts of vectors and matrices; those of arrays may be more.
const FIRST_PARTS: usize = 4;

/// A set of numbered parts of a variable: components, columns or elements. Those past the last number are never in one.
pub(super) type Parts = u64;

/// The target of a store.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Stored {
    pub(super) variable: VarRef,
    /// The outermost member of the struct that the variable is.
    pub(super) member: Option<(StructId, u32)>,
    /// The parts of the variable that it stores to; `None` if all, or if they are open.
    pub(super) parts: Option<Parts>,
}

impl Stored {
    /// All of a variable.
    pub(super) const fn whole(variable: VarRef) -> Self {
        Self { variable, member: None, parts: None }
    }
}

/// An argument for an `out` or `inout` parameter.
#[derive(Clone, Copy, Debug)]
pub(super) struct Given {
    /// The function that calls.
    pub(super) caller: FunctionId,
    /// The argument, an l-value of it.
    pub(super) argument: ExprId,
}

/// Counts of a stage.
#[derive(Debug)]
pub(super) struct Uses {
    locals: Vec<Vec<Count>>,
    globals: Vec<Count>,
    pub(super) members: FxHashMap<(StructId, u32), i32>,
    pub(super) calls: Vec<i32>,
    /// How many calls give a value that somebody wants, by function.
    pub(super) wanted: Vec<i32>,
    /// The elements of arrays past the first that are read by their numbers, by function, if it is a local, and variable.
    elements: FxHashMap<(Option<FunctionId>, usize, u32), i32>,
    /// The arguments of `out` and `inout` parameters, by function and parameter. Calls that went are still among them.
    pub(super) given: FxHashMap<(FunctionId, usize), Vec<Given>>,
    /// The function that is being counted.
    pub(super) function: FunctionId,
    /// The functions that `main` and the initializers of globals reach.
    pub(super) functions: Vec<FunctionId>,
    /// Whether each function is one of them.
    reached: Vec<bool>,
    /// What functions did when the counting began.
    pub(super) effects: Effects,
}

impl Uses {
    /// The counts of what `main` reaches.
    pub(super) fn of(types: &Types, shader: &Shader) -> Self {
        let mut uses = Self {
            locals: shader.functions.iter().map(|function| vec![Count::default(); function.locals.len()]).collect(),
            globals: vec![Count::default(); shader.globals.len()],
            members: FxHashMap::default(),
            calls: vec![0; shader.functions.len()],
            wanted: vec![0; shader.functions.len()],
            elements: FxHashMap::default(),
            given: FxHashMap::default(),
            function: FunctionId::new(0),
            functions: Vec::new(),
            reached: vec![false; shader.functions.len()],
            effects: Effects::of(shader, entries(shader)),
        };
        shader.main.into_iter().for_each(|main| uses.reach(main));
        for (id, global) in shader.globals() {
            if let Some(initializer) = global.initializer {
                uses.stored_value(types, shader, initializer, 1, Some(Stored::whole(VarRef::Global(id))));
            }
            if global.storage == Storage::Out {
                // The next stage may read any member, also of a struct that is stored as a whole.
                uses.all_members(types, global.ty, 1);
            }
        }
        // Counting a body finds the functions that it calls.
        let mut next = 0;
        while let Some(id) = uses.functions.get(next).copied() {
            uses.function = id;
            if let Some(body) = &shader.function(id).body {
                uses.body(types, shader, body, 1);
            }
            next += 1;
        }
        uses.functions.sort_unstable();
        uses
    }

    fn reach(&mut self, function: FunctionId) {
        if let Some(reached) = self.reached.get_mut(function.index()).filter(|reached| !**reached) {
            *reached = true;
            self.functions.push(function);
        }
    }

    /// The count of a variable of the present function.
    pub(super) fn get(&self, variable: VarRef) -> Count {
        let count = match variable {
            VarRef::Global(id) => self.globals.get(id.index()),
            VarRef::Local(id) => self.locals.get(self.function.index()).and_then(|locals| locals.get(id.index())),
        };
        count.copied().unwrap_or(Count::ANY)
    }

    /// The count of a function's local.
    pub(super) fn local(&self, function: FunctionId, id: LocalId) -> Count {
        let count = self.locals.get(function.index()).and_then(|locals| locals.get(id.index()));
        count.copied().unwrap_or_default()
    }

    /// The count of a global.
    pub(super) fn global(&self, id: GlobalId) -> Count {
        self.globals.get(id.index()).copied().unwrap_or_default()
    }

    fn slot(&mut self, variable: VarRef) -> Option<&mut Count> {
        match variable {
            VarRef::Global(id) => self.globals.get_mut(id.index()),
            VarRef::Local(id) => {
                let function = self.function.index();
                self.locals.get_mut(function).and_then(|locals| locals.get_mut(id.index()))
            }
        }
    }

    /// Counts a variable that is named as a whole.
    fn add(&mut self, variable: VarRef, reads: i32, named: i32) {
        if let Some(count) = self.slot(variable) {
            count.reads += reads;
            count.whole += reads;
            count.named += named;
        }
    }

    /// Counts a variable of which parts are read, by what is stored to `within`.
    fn add_parts(&mut self, variable: VarRef, parts: Parts, by: i32, within: Option<Stored>) {
        let stored = within.filter(|stored| stored.member.is_none() && stored.variable == variable);
        let own_part = parts.count_ones() == 1 && stored.is_some_and(|stored| stored.parts == Some(parts));
        let key = self.element_key(variable);
        let Some(count) = self.slot(variable) else { return };
        count.reads += if stored.is_some() { 0 } else { by };
        count.named += by;
        if own_part {
            return;
        }
        for (part, reads) in count.parts.iter_mut().enumerate() {
            *reads += if parts >> part & 1 == 1 { by } else { 0 };
        }
        let mut rest = parts >> FIRST_PARTS << FIRST_PARTS;
        while rest != 0 {
            *self.elements.entry((key.0, key.1, rest.trailing_zeros())).or_default() += by;
            rest &= rest - 1;
        }
    }

    fn element_key(&self, variable: VarRef) -> (Option<FunctionId>, usize) {
        match variable {
            VarRef::Global(id) => (None, id.index()),
            VarRef::Local(id) => (Some(self.function), id.index()),
        }
    }

    /// Whether somebody reads one of these parts of a variable of the present function.
    pub(super) fn reads_any(&self, variable: VarRef, parts: Parts) -> bool {
        let count = self.get(variable);
        let (function, index) = self.element_key(variable);
        let read = |part: u32| match count.parts.get(part as usize) {
            Some(reads) => *reads > 0,
            None => self.elements.get(&(function, index, part)).is_some_and(|reads| *reads > 0),
        };
        count.whole > 0 || (0..Parts::BITS).any(|part| parts >> part & 1 == 1 && read(part))
    }

    /// Counts a body, or with -1 takes it out of the count.
    pub(super) fn body(&mut self, types: &Types, shader: &Shader, body: &[Stmt], by: i32) {
        let mut statements: Vec<&Stmt> = Vec::new();
        shader.visit_statements(body, &mut |stmt| statements.push(stmt));
        for stmt in statements {
            self.statement(types, shader, &stmt.kind, by);
        }
    }

    /// Counts the expressions directly in a statement.
    pub(super) fn statement(&mut self, types: &Types, shader: &Shader, kind: &StmtKind, by: i32) {
        if let StmtKind::Local(local, initializer) = kind {
            if let Some(initializer) = initializer {
                self.stored_value(types, shader, *initializer, by, Some(Stored::whole(VarRef::Local(*local))));
            }
            return;
        }
        let step = match kind {
            StmtKind::Loop { step, .. } => *step,
            StmtKind::Expr(expr) => Some(*expr),
            _ => None,
        };
        for expr in kind.exprs() {
            if step == Some(expr) {
                self.effect(types, shader, expr, by);
            } else {
                self.value(types, shader, expr, by, None);
            }
        }
        if let StmtKind::Loop { condition: Some(condition), .. } = kind
            && let Some(local) = condition.local
        {
            self.add(VarRef::Local(local), by, by);
        }
    }

    /// Counts an expression whose value is nobody's.
    pub(super) fn effect(&mut self, types: &Types, shader: &Shader, expr: ExprId, by: i32) {
        match &shader.expr(expr).kind {
            ExprKind::Assign(_, target, value) => {
                self.target(types, shader, *target, by);
                self.stored_value(types, shader, *value, by, stored(types, shader, *target));
            }
            ExprKind::IncDec(_, target) => self.target(types, shader, *target, by),
            ExprKind::Call(callee, arguments) => {
                for (argument, within) in self.call(types, shader, (*callee, arguments), by, None) {
                    self.value(types, shader, argument, by, within);
                }
            }
            _ => self.value(types, shader, expr, by, None),
        }
    }

    /// Counts a call; the arguments whose values are wanted, and what they are stored to.
    fn call(
        &mut self,
        types: &Types,
        shader: &Shader,
        (callee, arguments): (FunctionId, &[ExprId]),
        by: i32,
        within: Option<Stored>,
    ) -> Vec<(ExprId, Option<Stored>)> {
        if let Some(calls) = self.calls.get_mut(callee.index()) {
            *calls += by;
        }
        self.reach(callee);
        let mut wanted = Vec::new();
        for (index, argument) in arguments.iter().enumerate() {
            let mode = shader.function(callee).param_mode(index);
            if matches!(mode, ParamMode::Out | ParamMode::Inout) && by > 0 {
                let given = Given { caller: self.function, argument: *argument };
                self.given.entry((callee, index)).or_default().push(given);
            }
            match mode {
                ParamMode::In | ParamMode::ConstIn => wanted.push((*argument, within)),
                // What goes in comes out again, and may overwrite what another argument gave the same variable.
                ParamMode::Inout => wanted.push((*argument, None)),
                ParamMode::Out => self.target(types, shader, *argument, by),
            }
        }
        wanted
    }

    /// Counts a value that is stored to `within`.
    pub(super) fn stored_value(
        &mut self,
        types: &Types,
        shader: &Shader,
        value: ExprId,
        by: i32,
        within: Option<Stored>,
    ) {
        self.value(types, shader, value, by, within.filter(|_| !self.acts(shader, value)));
    }

    /// Whether evaluating an expression may do more than give a value.
    pub(super) fn acts(&self, shader: &Shader, root: ExprId) -> bool {
        let mut acts = false;
        shader.visit_expr(root, &mut |expr| {
            acts |= match &shader.expr(expr).kind {
                ExprKind::Call(callee, _) => {
                    let (effect, function) = (self.effects.function(*callee), shader.function(*callee));
                    let gives = |index| matches!(function.param_mode(index), ParamMode::Out | ParamMode::Inout);
                    effect.ends || !effect.writes.is_empty() || (0..function.param_count).any(gives)
                }
                kind => may_act(kind),
            };
        });
        acts
    }

    /// Counts an expression whose value is wanted; `within` is what it is stored to, if it does nothing else.
    pub(super) fn value(&mut self, types: &Types, shader: &Shader, root: ExprId, by: i32, within: Option<Stored>) {
        let mut pending = vec![(root, within)];
        while let Some((id, within)) = pending.pop() {
            match &shader.expr(id).kind {
                ExprKind::Var(variable) => {
                    let own = within.is_some_and(|stored| stored.member.is_none() && stored.variable == *variable);
                    self.add(*variable, if own { 0 } else { by }, by);
                    // `v.y = dot(v, v)` and `m = inverse(m)` want all parts, if any of the result is wanted.
                    if own && let Some(count) = self.slot(*variable) {
                        count.whole += by;
                    }
                }
                ExprKind::Member(base, member) => {
                    let place = member_of(types, shader, *base, *member);
                    let own = within.is_some_and(|stored| {
                        stored.member.is_some() && stored.member == place && is_variable(shader, *base, stored.variable)
                    });
                    if let Some(place) = place {
                        *self.members.entry(place).or_default() += if own { 0 } else { by };
                    }
                    match shader.expr(*base).kind {
                        ExprKind::Var(variable) if own => self.add(variable, 0, by),
                        _ => pending.push((*base, within)),
                    }
                }
                ExprKind::Swizzle(..) | ExprKind::Index(..) if part_of(shader, id).is_some() => {
                    if let Some((variable, parts)) = part_of(shader, id) {
                        self.add_parts(variable, parts, by, within);
                    }
                }
                // Their own values are wanted, too.
                ExprKind::Assign(Some(_), target, value) => pending.extend([(*target, None), (*value, None)]),
                ExprKind::Assign(None, target, value) => {
                    self.target(types, shader, *target, by);
                    pending.push((*value, None));
                }
                ExprKind::IncDec(_, target) => pending.push((*target, None)),
                ExprKind::Call(callee, arguments) => {
                    if let Some(wanted) = self.wanted.get_mut(callee.index()) {
                        *wanted += by;
                    }
                    pending.extend(self.call(types, shader, (*callee, arguments), by, within));
                }
                ExprKind::BuiltinCall(function, arguments) => {
                    for (index, argument) in arguments.iter().enumerate() {
                        if function.written_argument() == Some(index) {
                            self.target(types, shader, *argument, by);
                        } else {
                            pending.push((*argument, within));
                        }
                    }
                }
                ExprKind::Binary(BinaryOp::Equal | BinaryOp::NotEqual, a, b) => {
                    self.all_members(types, shader.expr(*a).ty, by);
                    pending.extend([(*a, within), (*b, within)]);
                }
                kind => pending.extend(kind.children().into_iter().map(|child| (child, within))),
            }
        }
    }

    /// Counts what is assigned to: its indices are read, it is only named.
    fn target(&mut self, types: &Types, shader: &Shader, target: ExprId, by: i32) {
        let mut at = target;
        loop {
            match &shader.expr(at).kind {
                ExprKind::Var(variable) => {
                    self.add(*variable, 0, by);
                    return;
                }
                ExprKind::Member(base, _) | ExprKind::Swizzle(base, _) => at = *base,
                ExprKind::Index(base, index) => {
                    self.value(types, shader, *index, by, None);
                    at = *base;
                }
                _ => {
                    self.value(types, shader, at, by, None);
                    return;
                }
            }
        }
    }

    /// Whether no caller reads what a function leaves in an `out` or `inout` parameter. `live` says for each global whether somebody reads
    /// it when the stage has ended.
    pub(super) fn is_unread_by_callers(
        &self,
        types: &Types,
        shader: &Shader,
        live: &[bool],
        param: (FunctionId, usize),
    ) -> bool {
        let Some(given) = self.given.get(&param) else { return false };
        given.iter().all(|given| {
            let Some(stored) = stored(types, shader, given.argument) else { return false };
            let count = match stored.variable {
                VarRef::Global(id) => self.global(id),
                VarRef::Local(id) => self.local(given.caller, id),
            };
            let ends = match stored.variable {
                VarRef::Global(id) => live.get(id.index()).copied().unwrap_or(true),
                VarRef::Local(id) => {
                    let caller = shader.function(given.caller);
                    id.index() < caller.param_count
                        && matches!(caller.param_mode(id.index()), ParamMode::Out | ParamMode::Inout)
                        && !self.is_unread_by_callers(types, shader, live, (given.caller, id.index()))
                }
            };
            count.reads <= 0 && !ends
        })
    }

    /// A comparison of structs looks at all of them.
    fn all_members(&mut self, types: &Types, ty: TypeId, by: i32) {
        match types.get(ty) {
            Type::Struct(id) => {
                for (index, member) in types.structure(id).members.iter().enumerate() {
                    *self.members.entry((id, index as u32)).or_default() += by;
                    self.all_members(types, member.ty, by);
                }
            }
            Type::Array(element, _) => self.all_members(types, element, by),
            _ => {}
        }
    }
}

/// The functions that the language calls: `main`, and those that initializers of globals name.
fn entries(shader: &Shader) -> Vec<FunctionId> {
    let mut entries: Vec<FunctionId> = shader.main.into_iter().collect();
    for initializer in shader.globals.iter().filter_map(|global| global.initializer) {
        shader.visit_expr(initializer, &mut |expr| {
            if let ExprKind::Call(callee, _) = shader.expr(expr).kind {
                entries.push(callee);
            }
        });
    }
    entries
}

/// The parts of a variable that an expression names by their numbers.
pub(super) fn part_of(shader: &Shader, id: ExprId) -> Option<(VarRef, Parts)> {
    let (base, parts) = match &shader.expr(id).kind {
        ExprKind::Swizzle(base, swizzle) => {
            (*base, swizzle.as_slice().iter().fold(0, |parts, part| parts | 1 << (part & 3)))
        }
        ExprKind::Index(base, index) => {
            let number = match shader.expr(*index).kind {
                ExprKind::Literal(ScalarValue::Int(value)) => u32::try_from(value).ok()?,
                ExprKind::Literal(ScalarValue::Uint(value)) => value,
                _ => return None,
            };
            (*base, 1u64.checked_shl(number)?)
        }
        _ => return None,
    };
    match shader.expr(base).kind {
        ExprKind::Var(variable) => Some((variable, parts)),
        _ => None,
    }
}

fn is_variable(shader: &Shader, id: ExprId, variable: VarRef) -> bool {
    matches!(shader.expr(id).kind, ExprKind::Var(named) if named == variable)
}

/// The struct and the number of a member.
pub(super) fn member_of(types: &Types, shader: &Shader, base: ExprId, member: u32) -> Option<(StructId, u32)> {
    match types.get(shader.expr(base).ty) {
        Type::Struct(id) => Some((id, member)),
        _ => None,
    }
}

/// The variable, or the member of it, that an l-value stores to.
pub(super) fn stored(types: &Types, shader: &Shader, target: ExprId) -> Option<Stored> {
    let variable = shader.root_variable(target)?;
    let mut at = target;
    let (mut member, mut parts) = (None, None);
    loop {
        parts = parts.or(part_of(shader, at).map(|(_, parts)| parts));
        match &shader.expr(at).kind {
            ExprKind::Member(base, index) => {
                if matches!(shader.expr(*base).kind, ExprKind::Var(_)) {
                    member = member_of(types, shader, *base, *index);
                }
                at = *base;
            }
            ExprKind::Swizzle(base, _) | ExprKind::Index(base, _) => at = *base,
            _ => return Some(Stored { variable, member, parts }),
        }
    }
}
