//! `uninitialized-read`: reads a local, an `out` parameter, an output or another global before anything can have been assigned to it.
//!
//! The traversal follows the text. An earlier assignment on any path counts, and the assignments in a loop count from
//! its first line on. Globals count in `main`, up to the first call of a function that may assign them. An `inout` argument is read if the
//! function reads it before it assigns it. So the rule errs on the side of silence.

use super::super::{Findings, Subject, parts, running};
use crate::hir::written_by;
use crate::hir::{
    ExprId, ExprKind, Function, FunctionId, Global, GlobalId, LocalId, LocalKind, ParamMode, Shader, Stmt, StmtKind,
    Storage, VarRef,
};
use rustc_hash::{FxHashMap, FxHashSet};

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    let program = subject.program;
    for shader in &program.stages {
        let callees = callees(shader);
        for (function, body) in running(shader) {
            let assigned = given(function, &[ParamMode::Out]);
            let is_main = function.name == "main";
            let is_unset = |global: &Global| {
                matches!(global.storage, Storage::Out | Storage::Private) && global.initializer.is_none()
            };
            let globals = shader.globals.iter().map(|global| !(is_main && is_unset(global)));
            let globals = globals.collect();
            let mut walk = Walk { shader, function, callees: &callees, assigned, globals, reads: Vec::new() };
            walk.body(body);
            tell_components(subject, findings, (shader, function, body), &walk.reads);
            for (variable, read) in walk.reads {
                let (name, declared) = match variable {
                    VarRef::Local(id) => (&function.local(id).name, function.local(id).span),
                    VarRef::Global(id) => (&shader.global(id).name, shader.global(id).span),
                };
                let message = format!("`{name}` is read before anything is assigned to it");
                let finding = findings.at(shader.expr(read).span, message).here("an undefined value");
                let label = Some((declared, "declared here without a value")).filter(|(span, _)| span.is_known());
                findings.push(label.into_iter().fold(finding, |finding, (span, text)| finding.label(span, text)));
            }
        }
    }
}

/// Reports the components of locals that the function reads and nothing in it assigns, but for locals of which a read is known.
fn tell_components(
    subject: &Subject<'_>,
    findings: &mut Findings<'_>,
    (shader, function, body): (&Shader, &Function, &[Stmt]),
    known: &[(VarRef, ExprId)],
) {
    let mut unset = unset_components(subject, (shader, function, body));
    for (variable, _) in known {
        if let VarRef::Local(id) = variable {
            unset.remove(id);
        }
    }
    if unset.is_empty() {
        return;
    }
    let mut told: FxHashSet<LocalId> = FxHashSet::default();
    shader.visit_body(body, &mut |expr| {
        for read in computed_with(shader, expr) {
            let Some((VarRef::Local(id), components)) = parts::of_place(shader, read) else { continue };
            let missing = unset.get(&id).map_or(0, |unset| unset & components);
            if missing == 0 || !told.insert(id) {
                continue;
            }
            let local = function.local(id);
            let names = parts::named(missing, "xyzw");
            let message = format!("`{}.{names}` is read, and nothing is ever assigned to it", local.name);
            let finding = findings.at(shader.expr(read).span, message).here("an undefined value");
            findings.push(finding.label(local.span, "declared here without a value"));
        }
    });
}

/// The components that nothing in the function assigns, of the vectors of which something assigns others.
fn unset_components(
    subject: &Subject<'_>,
    (shader, function, body): (&Shader, &Function, &[Stmt]),
) -> FxHashMap<LocalId, u8> {
    let mut written: FxHashMap<LocalId, u8> = FxHashMap::default();
    shader.visit_statements(body, &mut |statement| {
        if let StmtKind::Local(id, Some(_)) = statement.kind {
            written.insert(id, parts::ALL);
        }
    });
    shader.visit_body(body, &mut |expr| {
        written_by(shader, expr, &mut |target| {
            if let Some((VarRef::Local(id), components)) = parts::of_place(shader, target) {
                *written.entry(id).or_default() |= components;
            }
        });
    });
    let is_variable = |id: LocalId| {
        let local = function.local(id);
        id.index() >= function.param_count && local.kind == LocalKind::Variable && !local.name.is_empty()
    };
    let unset = written.into_iter().filter(|(id, _)| is_variable(*id)).filter_map(|(id, written)| {
        let whole = parts::of_type(&subject.program.types, function.local(id).ty)?;
        Some((id, whole & !written)).filter(|(_, unset)| *unset != 0)
    });
    unset.collect()
}

/// The operands of an expression whose components all count: not what is copied as a whole, or given to a function, which may use less.
fn computed_with(shader: &Shader, expr: ExprId) -> Vec<ExprId> {
    match &shader.expr(expr).kind {
        ExprKind::Binary(_, a, b) => vec![*a, *b],
        ExprKind::Unary(_, a) => vec![*a],
        ExprKind::BuiltinCall(function, arguments) => {
            let written = function.written_argument();
            arguments.iter().enumerate().filter(|(at, _)| Some(*at) != written).map(|(_, argument)| *argument).collect()
        }
        // The last argument may have more components than are used.
        ExprKind::Construct(_, arguments) => arguments.split_last().map_or_else(Vec::new, |(_, rest)| rest.to_vec()),
        ExprKind::Assign(None, target, value) => match shader.root_variable(*target) {
            Some(VarRef::Global(id)) if shader.global(id).storage == Storage::Out => vec![*value],
            _ => Vec::new(),
        },
        _ => Vec::new(),
    }
}

/// For each local, whether it has a value where the function begins: a constant, and a parameter that has none of these modes.
fn given(function: &Function, without: &[ParamMode]) -> Vec<bool> {
    let has_none = |kind| matches!(kind, LocalKind::Param(mode) if without.contains(&mode));
    let given =
        function.locals.iter().enumerate().map(|(index, local)| {
            index < function.param_count && !has_none(local.kind) || local.kind == LocalKind::Const
        });
    given.collect()
}

/// The largest number of globals that are told apart in a call.
const MAX_GLOBALS: usize = 64;

/// The effects of a call on the variables of its caller.
#[derive(Default)]
struct Callee {
    /// The parameters that are read before they are assigned, by their places.
    reads: FxHashSet<usize>,
    /// The globals that it may assign; any, if there is no list.
    assigns: Option<FxHashSet<GlobalId>>,
}

/// The functions that `main` reaches and that have a body.
fn callees(shader: &Shader) -> FxHashMap<FunctionId, Callee> {
    let mut callees: FxHashMap<FunctionId, Callee> = FxHashMap::default();
    for id in shader.main.map(|main| shader.callees_first(main)).unwrap_or_default() {
        let function = shader.function(id);
        let Some(body) = &function.body else { continue };
        let assigned = given(function, &[ParamMode::Out, ParamMode::Inout]);
        let globals = vec![true; shader.globals.len()];
        let mut walk = Walk { shader, function, callees: &callees, assigned, globals, reads: Vec::new() };
        walk.body(body);
        let parameter = |(variable, _): &(VarRef, ExprId)| match variable {
            VarRef::Local(id) => Some(id.index()),
            VarRef::Global(_) => None,
        };
        let callee = Callee {
            reads: walk.reads.iter().filter_map(parameter).collect(),
            assigns: globals_of(shader, body, &callees),
        };
        callees.insert(id, callee);
    }
    callees
}

/// The globals that statements may assign.
fn globals_of(shader: &Shader, body: &[Stmt], callees: &FxHashMap<FunctionId, Callee>) -> Option<FxHashSet<GlobalId>> {
    let mut found: Option<FxHashSet<GlobalId>> = Some(FxHashSet::default());
    shader.visit_body(body, &mut |expr| {
        let Some(all) = &mut found else { return };
        written_by(shader, expr, &mut |target| {
            if let Some(VarRef::Global(id)) = shader.root_variable(target) {
                all.insert(id);
            }
        });
        if let ExprKind::Call(callee, _) = shader.expr(expr).kind {
            match callees.get(&callee).and_then(|callee| callee.assigns.as_ref()) {
                Some(more) => all.extend(more),
                None => found = None,
            }
        }
        if found.as_ref().is_some_and(|all| all.len() > MAX_GLOBALS) {
            found = None;
        }
    });
    found
}

struct Walk<'a> {
    shader: &'a Shader,
    function: &'a Function,
    callees: &'a FxHashMap<FunctionId, Callee>,
    /// Whether each local is assigned.
    assigned: Vec<bool>,
    /// Whether each global is assigned.
    globals: Vec<bool>,
    reads: Vec<(VarRef, ExprId)>,
}

impl Walk<'_> {
    fn assign(&mut self, variable: VarRef) {
        let assigned = match variable {
            VarRef::Local(id) => self.assigned.get_mut(id.index()),
            VarRef::Global(id) => self.globals.get_mut(id.index()),
        };
        assigned.into_iter().for_each(|assigned| *assigned = true);
    }

    /// Notes the first read of a variable.
    fn read(&mut self, variable: VarRef, expr: ExprId) {
        let (assigned, is_named) = match variable {
            VarRef::Local(id) => (self.assigned.get(id.index()), !self.function.local(id).name.is_empty()),
            VarRef::Global(id) => (self.globals.get(id.index()), true),
        };
        if assigned == Some(&false) && is_named {
            self.reads.push((variable, expr));
            self.assign(variable);
        }
    }

    /// Recurses into blocks, which nest at most as deep as the parser allows.
    fn body(&mut self, body: &[Stmt]) {
        for statement in body {
            self.statement(statement);
        }
    }

    fn statement(&mut self, statement: &Stmt) {
        match &statement.kind {
            StmtKind::Local(id, Some(initializer)) => {
                self.expr(*initializer);
                self.assign(VarRef::Local(*id));
            }
            StmtKind::Loop { condition, step, body, .. } => {
                self.assign_all(body);
                for expr in condition.iter().map(|condition| condition.expr).chain(*step) {
                    self.assign_in(expr);
                }
                if let Some(condition) = condition {
                    self.expr(condition.expr);
                    condition.local.into_iter().for_each(|id| self.assign(VarRef::Local(id)));
                }
                self.body(body);
                step.iter().for_each(|step| self.expr(*step));
            }
            StmtKind::If { arms, otherwise } => {
                for (condition, body) in arms {
                    self.expr(*condition);
                    self.body(body);
                }
                self.body(otherwise);
            }
            kind => {
                for expr in kind.exprs() {
                    self.expr(expr);
                }
                for body in kind.bodies() {
                    self.body(body);
                }
            }
        }
    }

    /// Marks everything that a loop's body assigns as assigned.
    fn assign_all(&mut self, body: &[Stmt]) {
        let shader = self.shader;
        shader.visit_statements(body, &mut |statement| {
            if let StmtKind::Local(id, Some(_)) = statement.kind {
                self.assign(VarRef::Local(id));
            }
            for expr in statement.kind.exprs() {
                self.assign_in(expr);
            }
        });
    }

    fn assign_in(&mut self, root: ExprId) {
        let shader = self.shader;
        shader.visit_expr(root, &mut |expr| {
            written_by(shader, expr, &mut |target| {
                shader.root_variable(target).into_iter().for_each(|variable| self.assign(variable));
            });
            if let ExprKind::Call(callee, _) = shader.expr(expr).kind {
                match self.callees.get(&callee).and_then(|callee| callee.assigns.as_ref()) {
                    Some(globals) => globals.iter().for_each(|id| self.assign(VarRef::Global(*id))),
                    None => self.globals.fill(true),
                }
            }
        });
    }

    /// Handles the reads in evaluation order, then the writes.
    fn expr(&mut self, id: ExprId) {
        let shader = self.shader;
        match &shader.expr(id).kind {
            ExprKind::Var(variable) => self.read(*variable, id),
            ExprKind::Assign(None, target, value) => {
                self.indices(*target);
                self.expr(*value);
                self.assign_in(id);
            }
            ExprKind::Call(function, arguments) => {
                let reads = self.callees.get(function).map(|callee| &callee.reads);
                let function = shader.function(*function);
                for (index, &argument) in arguments.iter().enumerate() {
                    let is_read = match function.param_mode(index) {
                        ParamMode::Out => false,
                        ParamMode::Inout => reads.is_some_and(|reads| reads.contains(&index)),
                        _ => true,
                    };
                    if !is_read { self.indices(argument) } else { self.expr(argument) }
                }
                self.assign_in(id);
            }
            ExprKind::BuiltinCall(function, arguments) if function.written_argument().is_some() => {
                for (index, &argument) in arguments.iter().enumerate() {
                    if function.written_argument() == Some(index) {
                        self.indices(argument)
                    } else {
                        self.expr(argument)
                    }
                }
                self.assign_in(id);
            }
            kind => {
                for child in kind.children() {
                    self.expr(child);
                }
            }
        }
    }

    /// The reads of an l-value that is written: its indices.
    fn indices(&mut self, mut target: ExprId) {
        loop {
            match self.shader.expr(target).kind {
                ExprKind::Index(base, index) => {
                    self.expr(index);
                    target = base;
                }
                ExprKind::Member(base, _) | ExprKind::Swizzle(base, _) => target = base,
                _ => return,
            }
        }
    }
}
