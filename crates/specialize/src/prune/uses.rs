//! [`Uses`]: how often each variable, member and function of a stage is read and named.
//!
//! *In:* a stage. *Out:* counts, over what `main` reaches. *Holds:* a store does not read what it stores to, nor does
//! `x = f(x)` read `x`: nobody else may want it.

use glisten_front::hir::{
    BinaryOp, ExprId, ExprKind, FunctionId, GlobalId, LocalId, ParamMode, Shader, Stmt, StmtKind, StructId, Type,
    TypeId, Types, VarRef,
};
use rustc_hash::FxHashMap;

/// Counts by variable.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Count {
    /// How often its value is wanted.
    pub(super) reads: i32,
    /// How often it is named at all.
    pub(super) named: i32,
}

/// The target of a store.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Stored {
    pub(super) variable: VarRef,
    /// The outermost member of the struct that the variable is.
    pub(super) member: Option<(StructId, u32)>,
}

/// Counts of a stage.
#[derive(Clone, Debug)]
pub(super) struct Uses {
    locals: Vec<Vec<Count>>,
    globals: Vec<Count>,
    pub(super) members: FxHashMap<(StructId, u32), i32>,
    pub(super) calls: Vec<i32>,
    /// The function that is being counted.
    pub(super) function: FunctionId,
    /// The functions that `main` and the initializers of globals reach.
    pub(super) functions: Vec<FunctionId>,
    /// Whether each function is one of them.
    reached: Vec<bool>,
}

impl Uses {
    /// The counts of what `main` reaches.
    pub(super) fn of(types: &Types, shader: &Shader) -> Self {
        let mut uses = Self {
            locals: shader.functions.iter().map(|function| vec![Count::default(); function.locals.len()]).collect(),
            globals: vec![Count::default(); shader.globals.len()],
            members: FxHashMap::default(),
            calls: vec![0; shader.functions.len()],
            function: FunctionId::new(0),
            functions: Vec::new(),
            reached: vec![false; shader.functions.len()],
        };
        shader.main.into_iter().for_each(|main| uses.reach(main));
        for (id, global) in shader.globals() {
            if let Some(initializer) = global.initializer {
                let stored = Stored { variable: VarRef::Global(id), member: None };
                uses.value(types, shader, initializer, 1, Some(stored));
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
        count.copied().unwrap_or(Count { reads: 1, named: 1 })
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

    fn add(&mut self, variable: VarRef, reads: i32, named: i32) {
        let slot = match variable {
            VarRef::Global(id) => self.globals.get_mut(id.index()),
            VarRef::Local(id) => {
                let function = self.function.index();
                self.locals.get_mut(function).and_then(|locals| locals.get_mut(id.index()))
            }
        };
        if let Some(count) = slot {
            count.reads += reads;
            count.named += named;
        }
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
            let variable = VarRef::Local(*local);
            if let Some(initializer) = initializer {
                self.value(types, shader, *initializer, by, Some(Stored { variable, member: None }));
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
                self.value(types, shader, *value, by, stored(types, shader, *target));
            }
            ExprKind::IncDec(_, target) => self.target(types, shader, *target, by),
            _ => self.value(types, shader, expr, by, None),
        }
    }

    /// Counts an expression whose value is wanted; `within` is what it is stored to.
    pub(super) fn value(&mut self, types: &Types, shader: &Shader, root: ExprId, by: i32, within: Option<Stored>) {
        let mut pending = vec![(root, within)];
        while let Some((id, within)) = pending.pop() {
            match &shader.expr(id).kind {
                ExprKind::Var(variable) => {
                    let own = within.is_some_and(|stored| stored.member.is_none() && stored.variable == *variable);
                    self.add(*variable, if own { 0 } else { by }, by);
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
                // Their own values are wanted, too.
                ExprKind::Assign(Some(_), target, value) => pending.extend([(*target, None), (*value, None)]),
                ExprKind::Assign(None, target, value) => {
                    self.target(types, shader, *target, by);
                    pending.push((*value, None));
                }
                ExprKind::IncDec(_, target) => pending.push((*target, None)),
                ExprKind::Call(callee, arguments) => {
                    if let Some(calls) = self.calls.get_mut(callee.index()) {
                        *calls += by;
                    }
                    self.reach(*callee);
                    for (index, argument) in arguments.iter().enumerate() {
                        match shader.function(*callee).param_mode(index) {
                            ParamMode::In | ParamMode::ConstIn => pending.push((*argument, within)),
                            ParamMode::Out => self.target(types, shader, *argument, by),
                            ParamMode::Inout => pending.push((*argument, None)),
                        }
                    }
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
    let mut member = None;
    loop {
        match &shader.expr(at).kind {
            ExprKind::Member(base, index) => {
                if matches!(shader.expr(*base).kind, ExprKind::Var(_)) {
                    member = member_of(types, shader, *base, *index);
                }
                at = *base;
            }
            ExprKind::Swizzle(base, _) | ExprKind::Index(base, _) => at = *base,
            _ => return Some(Stored { variable, member }),
        }
    }
}
