//! Chooses samplers and uniform blocks by an index that is not constant (GLSL 4.00 §4.1.7, §4.3.7; any index before 1.30):
//! no target has arrays of them that can be indexed so.
//!
//! *In:* a stage. *Out:* the same stage, in which a constant chooses each sampler and each block. *Holds:* a lookup or a read
//! becomes the call of a function that has one branch for each element; equal ones share a function. Lookups with implicit
//! derivatives look up all elements before the branches, since derivatives need uniform control flow. A function that gets a
//! chosen sampler is copied, and the copy gets the whole array and the index. An index is clamped to the array, each
//! by itself, as in the reference.
//!
//! | file | contents |
//! | --- | --- |
//! | `chain` | a variable with members and elements |
//! | `signature` | what a call passes, and what functions can be shared |
//! | `branches` | the functions with a branch for each element |
//! | `copies` | copies of functions |

mod branches;
mod chain;
mod copies;
mod signature;
#[cfg(test)]
mod tests;

use chain::Chain;
use glisten_front::builtin::operations::Class;
use glisten_front::diagnostic::Diagnostic;
use glisten_front::diagnostic::codes::general;
use glisten_front::hir::{
    Expr, ExprId, ExprKind, FunctionId, LocalKind, ScalarValue, Shader, Storage, Type, TypeId, Types, Value, VarRef,
};
use glisten_front::source::Span;
use rustc_hash::{FxHashMap, FxHashSet};
use signature::Key;
use std::borrow::Cow;

/// A result, or the one diagnostic that says why there is none.
type Try<T> = Result<T, Box<Diagnostic>>;

/// How many expressions the functions of one stage may have together.
const MOST_EXPRESSIONS: usize = 1 << 20;

/// The state of one stage.
struct Selection<'t> {
    types: &'t Types,
    shader: Shader,
    /// The functions so far, by what they do.
    made: FxHashMap<Key, FunctionId>,
    /// All names in the shader, which those of the functions differ from.
    names: FxHashSet<String>,
    /// How many expressions may still be added.
    left: usize,
    /// The things that take a constant index.
    choice: Choice,
}

/// The things that take constant indices alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Choice {
    /// Samplers and blocks.
    Samplers,
    /// The other members of a struct that has samplers, too: in a text, the index is that of the struct (GLSL ES 3.00 §4.1.7.1).
    Structs,
}

/// Makes all indices of samplers and uniform blocks constant.
///
/// # Errors
/// If there is too much to choose from, or if a function changes its copy of what is chosen.
pub(crate) fn select<'s>(types: &Types, shader: &'s Shader, choice: Choice) -> Try<Cow<'s, Shader>> {
    if !shader.exprs.iter().any(|expr| may_choose(types, shader, expr)) {
        return Ok(Cow::Borrowed(shader));
    }
    let shader = shader.clone();
    let (made, names) = (FxHashMap::default(), names_in(types, &shader));
    let mut selection = Selection { types, shader, made, names, left: MOST_EXPRESSIONS, choice };
    selection.run()?;
    Ok(Cow::Owned(selection.shader))
}

/// Whether an expression may choose a sampler or a block by an index that is not constant.
fn may_choose(types: &Types, shader: &Shader, expr: &Expr) -> bool {
    let ExprKind::Index(base, index) = expr.kind else { return false };
    let chooses = types.contains_sampler(expr.ty) || is_block_array(types, shader, base);
    chooses && !matches!(shader.expr(index).kind, ExprKind::Literal(_))
}

/// The names of globals, members of blocks, functions and locals.
fn names_in(types: &Types, shader: &Shader) -> FxHashSet<String> {
    let mut names = FxHashSet::default();
    for global in &shader.globals {
        names.insert(global.name.clone());
        if let (Some(block), Type::Struct(id)) = (&global.block, types.get(global.ty)) {
            names.extend(block.instance.clone());
            names.extend(types.structure(id).members.iter().map(|member| member.name.clone()));
        }
    }
    for function in &shader.functions {
        names.insert(function.name.clone());
        names.extend(function.locals.iter().map(|local| local.name.clone()));
    }
    names
}

/// Whether an expression is an array of uniform blocks.
fn is_block_array(types: &Types, shader: &Shader, id: ExprId) -> bool {
    let ExprKind::Var(VarRef::Global(global)) = shader.expr(id).kind else { return false };
    let global = shader.global(global);
    global.storage == Storage::Uniform && global.block.is_some() && matches!(types.get(global.ty), Type::Array(..))
}

impl Selection<'_> {
    fn run(&mut self) -> Try<()> {
        let globals = self.shader.globals.iter().filter(|global| global.storage == Storage::Private);
        let initializers: Vec<ExprId> = globals.filter_map(|global| global.initializer).collect();
        let mut exprs = Vec::new();
        for initializer in initializers {
            self.shader.visit_expr(initializer, &mut |id| exprs.push(id));
        }
        self.expressions(None, &exprs)?;
        // Copies of functions follow the functions of the shader, and what they choose is found in turn.
        let mut next = 0;
        while let Some(function) = self.shader.functions.get(next) {
            let mut exprs = Vec::new();
            if let Some(body) = &function.body {
                self.shader.visit_body(body, &mut |id| exprs.push(id));
            }
            self.expressions(Some(FunctionId::new(next)), &exprs)?;
            next += 1;
        }
        Ok(())
    }

    /// Rewrites the expressions of a function, or of initializers; outer ones come first.
    fn expressions(&mut self, function: Option<FunctionId>, exprs: &[ExprId]) -> Try<()> {
        let mut inner = FxHashSet::default();
        for &id in exprs {
            let shader = &self.shader;
            match &shader.expr(id).kind {
                ExprKind::BuiltinCall(builtin, _) if matches!(builtin.class(), Class::Texture(_)) => {
                    self.lookup(function, id)?;
                }
                ExprKind::Call(..) => self.call(function, id)?,
                ExprKind::Assign(_, target, _) | ExprKind::IncDec(_, target) => self.check_target(function, *target)?,
                ExprKind::Index(base, _) | ExprKind::Member(base, _) | ExprKind::Swizzle(base, _) => {
                    inner.insert(*base);
                    if !inner.contains(&id) && (self.reads_chosen_block(id) || self.reads_chosen_struct(id)) {
                        self.read(function, id)?;
                    }
                }
                _ => {}
            }
        }
        Ok(())
    }

    /// Whether a chain begins with an array of uniform blocks.
    fn reads_chosen_block(&self, mut id: ExprId) -> bool {
        loop {
            match self.shader.expr(id).kind {
                ExprKind::Index(base, _) | ExprKind::Member(base, _) | ExprKind::Swizzle(base, _) => id = base,
                _ => return is_block_array(self.types, &self.shader, id),
            }
        }
    }

    /// Whether something without samplers is a part of something with samplers, and texts take no such index.
    fn reads_chosen_struct(&self, mut id: ExprId) -> bool {
        let has_sampler = |id: ExprId| self.types.contains_sampler(self.shader.expr(id).ty);
        if self.choice == Choice::Samplers || has_sampler(id) {
            return false;
        }
        while let ExprKind::Index(base, _) | ExprKind::Member(base, _) | ExprKind::Swizzle(base, _) =
            self.shader.expr(id).kind
        {
            id = base;
        }
        has_sampler(id)
    }

    /// Refuses to change a part of a struct that is chosen: only a parameter can be changed, and no call denotes a part of it.
    fn check_target(&self, function: Option<FunctionId>, target: ExprId) -> Try<()> {
        if !self.reads_chosen_struct(target) || !self.chain(function, target).is_some_and(|chain| chain.is_chosen()) {
            return Ok(());
        }
        let message = "an index that is not constant chooses what changes, of structs that contain samplers";
        Err(Box::new(
            Diagnostic::new(&general::NOT_SUPPORTED_YET, self.shader.expr(target).span, message)
                .help("keep what changes in an array of its own"),
        ))
    }

    /// The chain of an expression.
    fn chain(&self, function: Option<FunctionId>, id: ExprId) -> Option<Chain> {
        Chain::of(self.types, &self.shader, id, &|index| self.constant_index(function, index))
    }

    /// The value of an expression of a function if it is constant.
    fn evaluated(&self, function: Option<FunctionId>, id: ExprId) -> Option<Value> {
        let locals = function.map_or(&[][..], |function| self.shader.function(function).locals.as_slice());
        glisten_front::fold::evaluate(&self.shader, self.types, id, &|var| match var {
            VarRef::Local(local) => {
                let local = locals.get(local.index())?;
                local.value.as_ref().filter(|_| local.kind == LocalKind::Const)
            }
            VarRef::Global(_) => None,
        })
    }

    fn constant_index(&self, function: Option<FunctionId>, id: ExprId) -> Option<u32> {
        match self.evaluated(function, id)?.scalars.as_slice() {
            [ScalarValue::Int(index)] => Some(u32::try_from(*index).unwrap_or(0)),
            [ScalarValue::Uint(index)] => Some(*index),
            _ => None,
        }
    }

    /// Adds an expression to the shader.
    fn push(&mut self, kind: ExprKind, ty: TypeId, span: Span) -> ExprId {
        self.left = self.left.saturating_sub(1);
        self.shader.push(kind, ty, span)
    }

    /// Refuses what would take more expressions than there may be.
    fn afford(&self, expressions: usize, span: Span) -> Try<()> {
        if expressions <= self.left {
            return Ok(());
        }
        let message = "there is too much to choose from by indices that are not constant";
        Err(Box::new(
            Diagnostic::new(&general::NOT_SUPPORTED_YET, span, message)
                .here("each element takes a branch, here and in each function that gets it")
                .help("use smaller arrays, or a texture array"),
        ))
    }

    /// A name that nothing else has.
    fn unused(&mut self, wanted: &str) -> String {
        let wanted = wanted.trim_end_matches('_');
        let mut name = wanted.to_owned();
        let mut number = 1_u32;
        while !self.names.insert(name.clone()) {
            number += 1;
            name = format!("{wanted}_{number}");
        }
        name
    }

    /// Replaces an expression by a call. What the call passes was part of the expression, so it precedes it.
    fn replace(&mut self, id: ExprId, function: FunctionId, passed: Vec<ExprId>) {
        if let Some(expr) = self.shader.exprs.get_mut(id.index()) {
            expr.kind = ExprKind::Call(function, passed);
        }
    }
}
