//! [`Subject`]: what a rule looks at: the program, its texts, and the functions that run, each with all of its expressions.
//!
//! *In:* a program and its texts. *Out:* a [`Place`] for each function that `main` reaches. *Holds:* what several rules need of a
//! function is found once.

use super::interval::Range;
use super::texts::Texts;
use super::uses::{self, LocalUse};
use crate::fold;
use crate::hir::{
    Expr, ExprId, ExprKind, Function, GlobalId, LocalId, Shader, Stmt, Type, Types, Value, VarRef, same_value,
};
use crate::link::Program;
use crate::source::{SourceMap, Span};
use crate::syntax::Lexemes;
use rustc_hash::{FxHashMap, FxHashSet};
use std::cell::{OnceCell, RefCell};
use std::rc::Rc;

/// A program as rules see it.
pub(super) struct Subject<'a> {
    pub(super) program: &'a Program,
    pub(super) texts: Texts<'a>,
    /// The functions that run, of all stages.
    pub(super) places: Vec<Place<'a>>,
}

/// A function that runs.
pub(super) struct Place<'a> {
    pub(super) types: &'a Types,
    pub(super) shader: &'a Shader,
    pub(super) function: &'a Function,
    pub(super) body: &'a [Stmt],
    /// All expressions of the body: wholes before their operands, in the order of the text.
    pub(super) exprs: Vec<ExprId>,
    /// All statements, outer ones first.
    pub(super) statements: Vec<&'a Stmt>,
    /// The uses of each local.
    pub(super) locals: Vec<LocalUse>,
    /// The ranges of expressions that were asked for.
    pub(super) ranges: RefCell<FxHashMap<ExprId, Range>>,
    /// The tokens of the function's file, and its text, once they were asked for.
    pub(super) text: OnceCell<Option<(Rc<Lexemes>, Span)>>,
    /// The globals that conditions name.
    conditions: FxHashSet<GlobalId>,
}

impl<'a> Subject<'a> {
    pub(super) fn new(program: &'a Program, sources: &'a SourceMap) -> Self {
        let mut places = Vec::new();
        for shader in &program.stages {
            for function in shader.functions.iter().filter(|function| function.reachable) {
                let Some(body) = function.body.as_deref() else { continue };
                places.push(Place::new(&program.types, shader, function, body));
            }
        }
        Self { program, texts: Texts::new(sources), places }
    }

    /// Every expression of every function that runs.
    pub(super) fn exprs(&self) -> impl Iterator<Item = (&Place<'a>, ExprId)> {
        self.places.iter().flat_map(|place| place.exprs.iter().map(move |&expr| (place, expr)))
    }

    /// Every statement of every function that runs.
    pub(super) fn statements(&self) -> impl Iterator<Item = (&Place<'a>, &'a Stmt)> {
        self.places.iter().flat_map(|place| place.statements.iter().map(move |&statement| (place, statement)))
    }
}

impl<'a> Place<'a> {
    fn new(types: &'a Types, shader: &'a Shader, function: &'a Function, body: &'a [Stmt]) -> Self {
        let (mut exprs, mut statements) = (Vec::new(), Vec::new());
        shader.visit_statements(body, &mut |statement| {
            statements.push(statement);
            for root in statement.kind.exprs() {
                shader.visit_expr(root, &mut |expr| exprs.push(expr));
            }
        });
        let (locals, conditions) = uses::of_variables(shader, function, &statements);
        let (ranges, text) = (RefCell::default(), OnceCell::new());
        Self { types, shader, function, body, exprs, statements, locals, ranges, text, conditions }
    }

    pub(super) fn expr(&self, id: ExprId) -> &'a Expr {
        self.shader.expr(id)
    }

    pub(super) fn kind(&self, id: ExprId) -> &'a ExprKind {
        &self.shader.expr(id).kind
    }

    pub(super) fn ty(&self, id: ExprId) -> Type {
        self.types.get(self.shader.expr(id).ty)
    }

    /// Whether the type is `float` or a vector of floats.
    pub(super) fn is_float(&self, id: ExprId) -> bool {
        use crate::hir::Scalar::Float;
        matches!(self.ty(id), Type::Scalar(Float) | Type::Vector(Float, _))
    }

    /// Whether the type is `vec2`, `vec3` or `vec4`.
    pub(super) fn is_vector(&self, id: ExprId) -> bool {
        matches!(self.ty(id), Type::Vector(crate::hir::Scalar::Float, _))
    }

    /// The value of a constant expression.
    pub(super) fn value(&self, id: ExprId) -> Option<Value> {
        let locals = |variable: VarRef| match variable {
            VarRef::Local(local) => self.function.local(local).value.as_ref(),
            VarRef::Global(_) => None,
        };
        fold::evaluate(self.shader, self.types, id, &locals)
    }

    /// The numbers of a constant float, or of a vector or a matrix of them.
    pub(super) fn numbers(&self, id: ExprId) -> Option<Vec<f32>> {
        use crate::hir::ScalarValue::Float;
        let number = |scalar: &_| if let Float(number) = scalar { Some(*number) } else { None };
        self.value(id)?.scalars.iter().map(number).collect()
    }

    /// Whether every number of a constant is this one.
    pub(super) fn is_number(&self, id: ExprId, number: f32) -> bool {
        self.numbers(id).is_some_and(|all| all.iter().all(|one| (one - number).abs() == 0.0))
    }

    /// The value that a local stands for, if it is given a value where it is declared and never again; otherwise the expression itself.
    pub(super) fn meaning(&self, id: ExprId) -> ExprId {
        let mut at = id;
        // A local is declared after all that its initializer names.
        while let ExprKind::Var(VarRef::Local(local)) = self.kind(at)
            && let Some(value) = self.definition(*local)
        {
            at = value;
        }
        at
    }

    /// The only value that a local is ever given.
    pub(super) fn definition(&self, local: LocalId) -> Option<ExprId> {
        let uses = self.locals.get(local.index())?;
        uses.initializer.filter(|_| uses.writes == 0 && local.index() >= self.function.param_count)
    }

    /// Whether a condition in the function names a variable that the expression is made of, so that it may guard it.
    pub(super) fn is_guarded(&self, id: ExprId) -> bool {
        let mut named = false;
        self.leaves(id, &mut |variable| {
            named |= match variable {
                VarRef::Local(local) => self.locals.get(local.index()).is_some_and(|uses| uses.in_condition),
                VarRef::Global(global) => self.conditions.contains(&global),
            };
        });
        named
    }

    /// Calls `f` for every variable that an expression is made of, those behind the locals that it names included.
    pub(super) fn leaves(&self, id: ExprId, f: &mut dyn FnMut(VarRef)) {
        const MOST: usize = 512;
        let mut pending = vec![id];
        let mut count = 0;
        while let Some(id) = pending.pop() {
            count += 1;
            if count > MOST {
                return;
            }
            if let ExprKind::Var(variable) = self.kind(id) {
                f(*variable);
                if let VarRef::Local(local) = variable {
                    pending.extend(self.definition(*local));
                }
            }
            pending.extend(self.kind(id).children());
        }
    }

    /// Whether two expressions compute the same, by their form.
    pub(super) fn same(&self, a: ExprId, b: ExprId) -> bool {
        same_value(self.shader, a, b)
    }
}
