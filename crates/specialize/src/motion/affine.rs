//! [`Affine`]: the degree of an expression in the varyings.
//!
//! *In:* a pruned fragment stage. *Out:* for each expression whether it is the same for all fragments (degree 0) or affine in
//! varyings of one kind (degree 1), and what it costs. *Holds:* an expression of neither degree has no entry; neither has one
//! that names a local with more than one value, has effects, looks up a texture, or takes a derivative.

use super::apply::Links;
use glisten_front::builtin::BuiltinFunction as F;
use glisten_front::builtin::operations::Class;
use glisten_front::hir::written_by;
use glisten_front::hir::{
    BinaryOp, ConstructKind, ExprId, ExprKind, FunctionId, Interpolation, LocalId, LocalKind, Sampling, Scalar, Shader,
    Stmt, StmtKind, Storage, Type, Types, UnaryOp, VarRef,
};
use rustc_hash::FxHashMap;
use std::collections::BTreeSet;

/// A moved expression has at most so many nodes, what its locals stand for included.
const LARGEST: u32 = 96;

/// How a varying is interpolated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Kind {
    pub(super) interpolation: Interpolation,
    pub(super) sampling: Sampling,
}

/// An expression that may move.
#[derive(Clone, Copy, Debug)]
pub(super) struct Affine {
    /// How the varyings in it are interpolated; `None` if there are none.
    pub(super) kind: Option<Kind>,
    /// Operations on scalars in it, without those of its locals.
    pub(super) operations: u32,
    /// Nodes, those of its locals included.
    nodes: u32,
}

/// A local of a function.
pub(super) type LocalName = (FunctionId, LocalId);

/// The locals that are names for one expression, and the function that it is in: locals that are assigned where they are
/// declared and nowhere else, parameters that are never assigned of functions that are called from one place.
pub(super) type Names = FxHashMap<LocalName, (FunctionId, ExprId)>;

/// Those of a stage.
pub(super) fn names(shader: &Shader) -> Names {
    let mut names = arguments(shader);
    for (id, function) in shader.functions() {
        let body = function.body.as_deref().unwrap_or(&[]);
        let mut several: BTreeSet<LocalId> = BTreeSet::new();
        let mut see = |stmt: &Stmt| match &stmt.kind {
            StmtKind::Local(local, Some(value)) if function.local(*local).kind == LocalKind::Variable => {
                let before = names.insert((id, *local), (id, *value));
                several.extend(before.map(|_| *local));
            }
            StmtKind::Loop { condition: Some(condition), .. } => several.extend(condition.local),
            _ => {}
        };
        shader.visit_statements(body, &mut see);
        shader.visit_body(body, &mut |expr| {
            written_by(shader, expr, &mut |target| {
                if let Some(VarRef::Local(local)) = shader.root_variable(target) {
                    several.insert(local);
                }
            });
        });
        for local in several {
            names.remove(&(id, local));
        }
    }
    names
}

/// The arguments of functions that are called from one place.
fn arguments(shader: &Shader) -> Names {
    let mut calls: FxHashMap<FunctionId, Vec<(FunctionId, ExprId)>> = FxHashMap::default();
    for (id, function) in shader.functions() {
        shader.visit_body(function.body.as_deref().unwrap_or(&[]), &mut |expr| {
            if let ExprKind::Call(callee, _) = shader.expr(expr).kind {
                calls.entry(callee).or_default().push((id, expr));
            }
        });
    }
    let mut names = Names::default();
    for (callee, function) in shader.functions() {
        let Some([(caller, call)]) = calls.get(&callee).map(Vec::as_slice) else { continue };
        let ExprKind::Call(_, arguments) = &shader.expr(*call).kind else { continue };
        for (index, argument) in arguments.iter().enumerate().take(function.param_count) {
            if crate::forward::is_in(function.param_mode(index)) {
                names.insert((callee, LocalId::new(index)), (*caller, *argument));
            }
        }
    }
    names
}

/// The degrees of a stage's expressions, by their numbers.
pub(super) struct Degrees<'a> {
    types: &'a Types,
    shader: &'a Shader,
    links: &'a Links,
    names: &'a Names,
    known: Vec<Option<Affine>>,
}

impl<'a> Degrees<'a> {
    /// Those of all expressions that the functions' bodies have.
    pub(super) fn of(types: &'a Types, shader: &'a Shader, links: &'a Links, names: &'a Names) -> Self {
        let mut degrees = Self { types, shader, links, names, known: vec![None; shader.exprs.len()] };
        // Callers first: an argument is known before what is done with it.
        let functions = shader.main.map(|main| shader.callees_first(main)).unwrap_or_default();
        for id in functions.into_iter().rev() {
            let function = shader.function(id);
            let mut order = Vec::new();
            shader.visit_body(function.body.as_deref().unwrap_or(&[]), &mut |expr| order.push(expr));
            // Operands have smaller numbers; so has what a local was declared with.
            order.sort_unstable();
            for expr in order {
                let degree = degrees.one(id, expr).filter(|affine| affine.nodes <= LARGEST);
                if let Some(slot) = degrees.known.get_mut(expr.index()) {
                    *slot = degree;
                }
            }
        }
        degrees
    }

    /// The degree of an expression.
    pub(super) fn get(&self, id: ExprId) -> Option<Affine> {
        self.known.get(id.index()).copied().flatten()
    }

    fn one(&self, function: FunctionId, id: ExprId) -> Option<Affine> {
        let expr = self.shader.expr(id);
        let leaf = |kind| Some(Affine { kind, operations: 0, nodes: 1 });
        match &expr.kind {
            ExprKind::Literal(_) => leaf(None),
            ExprKind::Var(VarRef::Local(local)) => {
                let affine = self.get(self.names.get(&(function, *local))?.1)?;
                Some(Affine { operations: 0, ..affine })
            }
            ExprKind::Var(VarRef::Global(global)) => match self.shader.global(*global).storage {
                Storage::In => leaf(Some(self.links.varying(*global)?.kind)),
                Storage::Uniform | Storage::Const if self.links.is_shared(*global) => leaf(None),
                _ => None,
            },
            ExprKind::Index(base, index) => {
                matches!(self.shader.expr(*index).kind, ExprKind::Literal(_)).then_some(())?;
                self.all(&[*base], 0)
            }
            ExprKind::Member(base, _) | ExprKind::Swizzle(base, _) => self.all(&[*base], 0),
            ExprKind::Convert(a) => self.all(&[*a], 0).filter(|affine| affine.kind.is_none()),
            ExprKind::Construct(kind, list) => match kind {
                ConstructKind::Array | ConstructKind::Struct => None,
                _ => self.all(list, 0),
            },
            ExprKind::Unary(UnaryOp::Negate, a) => self.all(&[*a], 0),
            ExprKind::Binary(op, a, b) => self.binary(*op, *a, *b, id),
            ExprKind::BuiltinCall(function, list) => self.call(*function, list, id),
            _ => None,
        }
        .filter(|_| {
            self.types.scalar_of(expr.ty).is_some()
                || matches!(expr.kind, ExprKind::Var(_) | ExprKind::Member(..) | ExprKind::Index(..))
        })
    }

    /// A sum or a list of these: as affine as they are, if their varyings are of one kind.
    fn all(&self, list: &[ExprId], operations: u32) -> Option<Affine> {
        let mut whole = Affine { kind: None, operations, nodes: 1 };
        for id in list {
            let part = self.get(*id)?;
            if whole.kind.is_some() && part.kind.is_some() && whole.kind != part.kind {
                return None;
            }
            whole.kind = whole.kind.or(part.kind);
            whole.operations = whole.operations.saturating_add(part.operations);
            whole.nodes = whole.nodes.saturating_add(part.nodes);
        }
        Some(whole)
    }

    /// A product: affine if only one factor is.
    fn product(&self, a: ExprId, b: ExprId, operations: u32) -> Option<Affine> {
        let both = self.get(a)?.kind.is_some() && self.get(b)?.kind.is_some();
        if both { None } else { self.all(&[a, b], operations) }
    }

    fn scalars(&self, id: ExprId) -> u32 {
        self.types.flat_len(self.shader.expr(id).ty)
    }

    fn binary(&self, op: BinaryOp, a: ExprId, b: ExprId, id: ExprId) -> Option<Affine> {
        if self.types.scalar_of(self.shader.expr(id).ty) != Some(Scalar::Float) {
            return None;
        }
        match op {
            BinaryOp::Add | BinaryOp::Sub => self.all(&[a, b], self.scalars(id)),
            BinaryOp::Mul => self.product(a, b, self.scalars(id)),
            BinaryOp::MatMul => {
                let inner = match self.types.get(self.shader.expr(a).ty) {
                    Type::Matrix(columns, _) => u32::from(columns),
                    _ => self.scalars(a),
                };
                self.product(a, b, self.scalars(id) * (2 * inner - 1))
            }
            BinaryOp::Div if self.get(b)?.kind.is_none() => self.all(&[a, b], self.scalars(id)),
            _ => None,
        }
    }

    fn call(&self, function: F, list: &[ExprId], id: ExprId) -> Option<Affine> {
        let (a, b) = (list.first().copied()?, list.get(1).copied().unwrap_or(*list.first()?));
        let scalars = self.scalars(id);
        match function {
            F::Dot => return self.product(a, b, 2 * self.scalars(a) - 1),
            F::Cross => return self.product(a, b, 9),
            F::MatrixCompMult | F::OuterProduct => return self.product(a, b, scalars),
            F::Transpose => return self.all(list, 0),
            F::Radians | F::Degrees => return self.all(list, scalars),
            F::Mix => {
                let weight = self.get(*list.get(2)?)?;
                let ends = self.all(&[a, b], 0)?;
                let linear = weight.kind.is_none() || ends.kind.is_none();
                let floats = self.types.scalar_of(self.shader.expr(*list.get(2)?).ty) == Some(Scalar::Float);
                return if linear && floats { self.all(list, 3 * scalars) } else { None };
            }
            _ => {}
        }
        // Any other function, of what is the same for all fragments.
        let computes = matches!(
            function.class(),
            Class::Unary(_) | Class::Binary(_) | Class::Ternary(_) | Class::Numbers(_) | Class::Composite(_)
        );
        let whole = self.all(list, 4 * scalars)?;
        (computes && whole.kind.is_none()).then_some(whole)
    }
}
