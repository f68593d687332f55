//! [`Candidates`]: the largest expressions that may move, and who needs which varyings and locals.
//!
//! *In:* a fragment stage and the degrees of its expressions. *Out:* candidates in the order of the text; equal ones are one.
//! *Holds:* a candidate computes something, or is the value of a local: a varying that is only taken apart stays where it is.

use super::affine::{self, Degrees, LocalName, Names};
use super::apply::Links;
use glisten_front::hir::{
    ExprId, ExprKind, FunctionId, GlobalId, LocalId, Scalar, Shader, Stmt, StmtKind, Storage, Type, Types, VarRef,
};
use rustc_hash::FxHashMap;
use std::collections::BTreeSet;
use std::fmt::Write;

/// An expression that may move, in all places where it is.
#[derive(Clone, Debug)]
pub(super) struct Candidate {
    /// The expressions, each with its function and the local that it is the value of.
    pub(super) places: Vec<(FunctionId, ExprId, Option<LocalName>)>,
    /// Operations on scalars that all places execute together.
    pub(super) operations: u32,
    /// Scalars of its value.
    pub(super) components: u32,
    /// The varyings and locals that it names.
    pub(super) needs: Needs,
    /// The first varying in it, or in what its locals stand for.
    pub(super) base: Option<GlobalId>,
}

/// Varyings and locals that are named somewhere.
#[derive(Clone, Debug, Default)]
pub(super) struct Needs {
    pub(super) varyings: BTreeSet<GlobalId>,
    pub(super) locals: BTreeSet<LocalName>,
}

/// Those of a stage.
pub(super) struct Candidates {
    pub(super) list: Vec<Candidate>,
    /// The varyings and locals that are named outside of all candidates.
    pub(super) open: Needs,
    /// The scalars of each varying that may be among the needs.
    pub(super) varyings: Vec<(GlobalId, u32)>,
    /// Locals that are names for one expression.
    pub(super) names: Names,
}

struct Search<'a> {
    types: &'a Types,
    shader: &'a Shader,
    degrees: Degrees<'a>,
    names: &'a Names,
    by_text: FxHashMap<String, usize>,
    list: Vec<Candidate>,
    open: Needs,
}

impl Candidates {
    /// Those of a stage.
    pub(super) fn of(types: &Types, shader: &Shader, links: &Links) -> Self {
        let names = affine::names(shader);
        let degrees = Degrees::of(types, shader, links, &names);
        let mut search = Search {
            types,
            shader,
            degrees,
            names: &names,
            by_text: FxHashMap::default(),
            list: Vec::new(),
            open: Needs::default(),
        };
        // Callers first, so that what gives a local its value is before all that names it.
        let functions = shader.main.map(|main| shader.callees_first(main)).unwrap_or_default();
        for id in functions.into_iter().rev() {
            search.body(id, shader.function(id).body.as_deref().unwrap_or(&[]));
        }
        let (list, open) = (search.list, search.open);
        let inputs = shader.globals().filter(|(_, global)| global.storage == Storage::In && global.builtin.is_none());
        let varyings = inputs.map(|(id, global)| (id, types.flat_len(global.ty))).collect();
        Self { list, open, varyings, names }
    }
}

impl Search<'_> {
    fn body(&mut self, function: FunctionId, body: &[Stmt]) {
        let mut roots: Vec<(ExprId, Option<LocalName>)> = Vec::new();
        self.shader.visit_statements(body, &mut |stmt| {
            let local = if let StmtKind::Local(local, _) = stmt.kind { Some((function, local)) } else { None };
            roots.extend(stmt.kind.exprs().into_iter().map(|expr| (expr, local)));
        });
        for (root, local) in roots {
            self.expr(function, root, local.filter(|local| self.names.contains_key(local)));
        }
    }

    fn expr(&mut self, function: FunctionId, root: ExprId, local: Option<LocalName>) {
        let mut pending = vec![(root, local)];
        while let Some((id, local)) = pending.pop() {
            if self.may_move(id, local.is_some()) {
                self.candidate(function, id, local);
                continue;
            }
            match &self.shader.expr(id).kind {
                ExprKind::Var(VarRef::Global(global)) => {
                    self.open.varyings.insert(*global);
                }
                ExprKind::Var(VarRef::Local(named)) => {
                    self.open.locals.insert((function, *named));
                }
                ExprKind::Call(callee, arguments) => {
                    let params = arguments.iter().enumerate().rev();
                    pending.extend(params.map(|(index, argument)| {
                        let param = (*callee, LocalId::new(index));
                        (*argument, Some(param).filter(|param| self.names.contains_key(param)))
                    }));
                }
                kind => pending.extend(kind.children().into_iter().rev().map(|child| (child, None))),
            }
        }
    }

    /// The value of a local may move even if it computes nothing: then it only says what the local needs.
    fn may_move(&self, id: ExprId, of_local: bool) -> bool {
        let vector = match self.types.get(self.shader.expr(id).ty) {
            Type::Scalar(scalar) | Type::Vector(scalar, _) => scalar == Scalar::Float,
            _ => false,
        };
        vector
            && self.degrees.get(id).is_some_and(|affine| affine.kind.is_some() && (of_local || affine.operations > 0))
    }

    fn candidate(&mut self, function: FunctionId, id: ExprId, local: Option<LocalName>) {
        let Some(affine) = self.degrees.get(id) else { return };
        let mut text = String::new();
        text_of(self.shader, self.names, function, id, &mut text);
        let place = (function, id, local);
        if let Some(known) = self.by_text.get(&text).and_then(|index| self.list.get_mut(*index)) {
            known.places.push(place);
            known.operations = known.operations.saturating_add(affine.operations);
            known.needs.add(self.shader, function, id);
            return;
        }
        let mut needs = Needs::default();
        needs.add(self.shader, function, id);
        self.by_text.insert(text, self.list.len());
        let components = self.types.flat_len(self.shader.expr(id).ty);
        let base = self.base(function, id);
        self.list.push(Candidate { places: vec![place], operations: affine.operations, components, needs, base });
    }
}

impl Search<'_> {
    fn base(&self, function: FunctionId, root: ExprId) -> Option<GlobalId> {
        let mut pending = vec![(function, root)];
        while let Some((function, id)) = pending.pop() {
            match &self.shader.expr(id).kind {
                ExprKind::Var(VarRef::Global(global)) if self.shader.global(*global).storage == Storage::In => {
                    return Some(*global);
                }
                ExprKind::Var(VarRef::Local(local)) => pending.extend(self.names.get(&(function, *local))),
                kind => pending.extend(kind.children().into_iter().rev().map(|child| (function, child))),
            }
        }
        None
    }
}

impl Needs {
    fn add(&mut self, shader: &Shader, function: FunctionId, root: ExprId) {
        shader.visit_expr(root, &mut |id| match shader.expr(id).kind {
            ExprKind::Var(VarRef::Global(global)) if shader.global(global).storage == Storage::In => {
                self.varyings.insert(global);
            }
            ExprKind::Var(VarRef::Local(local)) => {
                self.locals.insert((function, local));
            }
            _ => {}
        });
    }
}

/// All that an expression is, with what its locals stand for in their place.
fn text_of(shader: &Shader, names: &Names, function: FunctionId, id: ExprId, text: &mut String) {
    let expr = shader.expr(id);
    let _ = match &expr.kind {
        ExprKind::Var(VarRef::Local(local)) => {
            if let Some((function, value)) = names.get(&(function, *local)) {
                text_of(shader, names, *function, *value, text);
                return;
            }
            write!(text, "{function:?} {local:?}")
        }
        ExprKind::Literal(value) => write!(text, "{value:?}"),
        ExprKind::Var(variable) => write!(text, "{variable:?}"),
        ExprKind::Member(_, member) => write!(text, ".{member}"),
        ExprKind::Swizzle(_, swizzle) => write!(text, "{:?}", swizzle.as_slice()),
        ExprKind::Construct(kind, _) => write!(text, "{:?} {kind:?}", expr.ty),
        ExprKind::Unary(op, _) => write!(text, "{op:?}"),
        ExprKind::Binary(op, ..) => write!(text, "{op:?}"),
        ExprKind::BuiltinCall(function, _) => write!(text, "{function:?}"),
        ExprKind::Convert(_) => write!(text, "{:?}", expr.ty),
        _ => write!(text, "#"),
    };
    text.push('(');
    for child in expr.kind.children() {
        text_of(shader, names, function, child, text);
        text.push(',');
    }
    text.push(')');
}
