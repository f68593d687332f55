//! The effects of expressions and calls, as far as they decide where these can be written.

use super::Style;
use crate::emit::statements::{blocks, operands};
use crate::lower::for_each_operand;
use naga::{
    Arena, Block, Expression, Function, GlobalVariable, Handle, LocalVariable, Statement, TypeInner, UniqueArena,
};

/// The variable behind a pointer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Root {
    Local(Handle<LocalVariable>),
    Global(Handle<GlobalVariable>),
    /// The variable behind a parameter.
    Parameter(u32),
}

/// The effects of a function beyond its result.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Effects {
    /// It stores to variables of the module, through pointers, or discards.
    pub(super) writes: bool,
    /// It reads variables of the module that change.
    pub(super) reads: bool,
}

/// A call: what it calls, with which arguments.
pub(super) type Call<'m> = (Handle<Function>, &'m [Handle<Expression>]);

/// How an expression has to be handled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Class {
    /// A literal, a variable, a parameter: not evaluated.
    Given,
    /// A pointer to a part of something.
    Pointer,
    /// A part of a value, which may be written several times.
    Part,
    /// An array of parameters of which only single elements are read: they are written instead.
    Open,
    /// A value that never changes: of a uniform.
    Constant,
    /// A value that a store may change. The flag says whether it may be read several times.
    Load(Root, bool),
    /// The result of a call.
    Call,
    /// A lookup or a derivative: control flow matters.
    Lookup,
    Pure,
}

/// The variable that a pointer leads to; none for pointers to what never changes.
pub(super) fn root(
    module: &naga::Module,
    expressions: &Arena<Expression>,
    mut pointer: Handle<Expression>,
) -> Option<Root> {
    loop {
        match expressions[pointer] {
            Expression::Access { base, .. } | Expression::AccessIndex { base, .. } => pointer = base,
            Expression::LocalVariable(variable) => return Some(Root::Local(variable)),
            Expression::FunctionArgument(index) => return Some(Root::Parameter(index)),
            Expression::GlobalVariable(variable) => {
                let changes = module.global_variables[variable].space == naga::AddressSpace::Private;
                return changes.then_some(Root::Global(variable));
            }
            _ => return None,
        }
    }
}

/// Whether all indices of a pointer are constant.
fn is_plain(expressions: &Arena<Expression>, mut pointer: Handle<Expression>) -> bool {
    loop {
        match expressions[pointer] {
            Expression::AccessIndex { base, .. } => pointer = base,
            Expression::Access { .. } => return false,
            _ => return true,
        }
    }
}

pub(super) fn is_pointer(types: &UniqueArena<naga::Type>, ty: &naga::proc::TypeResolution) -> bool {
    matches!(ty.inner_with(types), TypeInner::Pointer { .. } | TypeInner::ValuePointer { .. })
}

/// The class of each expression of a function.
pub(super) fn classes(
    module: &naga::Module,
    function: &Function,
    info: &naga::valid::FunctionInfo,
    style: Style,
) -> Vec<Class> {
    let class = |(handle, expression): (Handle<Expression>, &Expression)| match *expression {
        ref given if given.needs_pre_emit() => Class::Given,
        Expression::Access { .. } | Expression::AccessIndex { .. } if is_pointer(&module.types, &info[handle].ty) => {
            Class::Pointer
        }
        Expression::Access { index, .. } => match function.expressions[index] {
            ref given if given.needs_pre_emit() => Class::Part,
            _ => Class::Pure,
        },
        Expression::AccessIndex { .. } => Class::Part,
        Expression::Swizzle { .. } if style == Style::Full => Class::Part,
        Expression::Load { pointer } => match root(module, &function.expressions, pointer) {
            Some(root) => Class::Load(root, style == Style::Full && is_plain(&function.expressions, pointer)),
            None if style == Style::Full && is_plain(&function.expressions, pointer) => Class::Constant,
            None => Class::Pure,
        },
        Expression::CallResult(_) => Class::Call,
        Expression::ImageSample { .. } | Expression::ImageLoad { .. } | Expression::ImageQuery { .. } => Class::Lookup,
        Expression::Derivative { .. } => Class::Lookup,
        _ => Class::Pure,
    };
    let mut classes: Vec<Class> = function.expressions.iter().map(class).collect();
    if style == Style::Full {
        open(module, function, &mut classes);
    }
    classes
}

/// Finds the arrays of parameters of which only single elements are read. A vector may be composed of shorter ones, which are not its
/// components (GLSL 1.50 §5.4.2).
fn open(module: &naga::Module, function: &Function, classes: &mut [Class]) {
    let is_by_components = |ty: Handle<naga::Type>, parts: usize| match module.types[ty].inner {
        TypeInner::Vector { size, .. } => size as usize == parts,
        _ => true,
    };
    let mut found: Vec<Handle<Expression>> = Vec::new();
    for (handle, expression) in function.expressions.iter() {
        if let Expression::Compose { ty, components } = expression
            && is_by_components(*ty, components.len())
            && function.named_expressions.contains_key(&handle)
            && components
                .iter()
                .all(|component| matches!(function.expressions[*component], Expression::FunctionArgument(_)))
        {
            found.push(handle);
        }
    }
    if found.is_empty() {
        return;
    }
    let mut read_whole: Vec<Handle<Expression>> = Vec::new();
    for (_, expression) in function.expressions.iter() {
        if !matches!(expression, Expression::AccessIndex { .. }) {
            for_each_operand(expression, |operand| read_whole.push(operand));
        }
    }
    in_statements(&function.body, &mut read_whole);
    for handle in found.into_iter().filter(|handle| !read_whole.contains(handle)) {
        if let Some(class) = classes.get_mut(handle.index()) {
            *class = Class::Open;
        }
    }
}

/// Collects the operands of statements.
fn in_statements(block: &Block, found: &mut Vec<Handle<Expression>>) {
    for statement in block {
        operands(statement, |operand| found.push(operand));
        blocks(statement).into_iter().for_each(|inner| in_statements(inner, found));
    }
}

/// The effects of each function of a module; callees come first.
pub(super) fn of_functions(module: &naga::Module) -> Vec<Effects> {
    let mut all: Vec<Effects> = Vec::with_capacity(module.functions.len());
    for (_, function) in module.functions.iter() {
        let mut effects = Effects::default();
        for (_, expression) in function.expressions.iter() {
            if let Expression::Load { pointer } = expression {
                effects.reads |= matches!(root(module, &function.expressions, *pointer), Some(Root::Global(_)));
            }
        }
        of_block(module, function, &function.body, &all, &mut effects);
        all.push(effects);
    }
    all
}

fn of_block(module: &naga::Module, function: &Function, block: &Block, known: &[Effects], effects: &mut Effects) {
    for statement in block {
        match statement {
            Statement::Store { pointer, .. } => {
                effects.writes |= !matches!(root(module, &function.expressions, *pointer), Some(Root::Local(_)));
            }
            Statement::Kill => effects.writes = true,
            Statement::Call { function: callee, .. } => {
                let callee = known.get(callee.index()).copied().unwrap_or(Effects { writes: true, reads: true });
                effects.writes |= callee.writes;
                effects.reads |= callee.reads;
            }
            Statement::Emit(_) | Statement::Return { .. } | Statement::Break | Statement::Continue => {}
            Statement::If { .. } | Statement::Switch { .. } | Statement::Loop { .. } | Statement::Block(_) => {}
            _ => effects.writes = true,
        }
        for inner in blocks(statement) {
            of_block(module, function, inner, known, effects);
        }
    }
}
