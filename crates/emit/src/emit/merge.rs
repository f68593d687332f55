//! Merges the modules of two stages into one, for hosts that have a file for each program.
//!
//! *In:* validated modules, each with one entry point. *Out:* a module with both. *Holds:* what is equal in both is there
//! once: types, constants, resources of one binding, variables, functions. What differs stays apart; the writers keep the
//! names apart.

use glisten_front::hir::Stage;
use naga::{
    Arena, ArraySize, Block, Constant, Expression, Function, GlobalVariable, Handle, Module, Statement, Type,
    TypeInner, UniqueArena,
};

/// The module of both.
pub(super) fn merged(mut first: Module, second: Module) -> Module {
    let mut merge = Merge { types: Vec::new(), constants: Vec::new(), globals: Vec::new(), functions: Vec::new() };
    merge.types(&mut first, &second.types);
    merge.constants(&mut first, &second);
    merge.globals(&mut first, &second);
    for (handle, function) in second.functions.iter() {
        let function = merge.function(function.clone());
        let known = first.functions.iter().find(|(_, known)| equal_functions(known, &function));
        let known = known.map(|(handle, _)| handle);
        let span = second.functions.get_span(handle);
        merge.functions.push(known.unwrap_or_else(|| first.functions.append(function, span)));
    }
    for mut entry in second.entry_points {
        entry.function = merge.function(entry.function);
        first.entry_points.push(entry);
    }
    first
}

/// For each handle of the second module: the one in the first.
struct Merge {
    types: Vec<Handle<Type>>,
    constants: Vec<Handle<Constant>>,
    globals: Vec<Handle<GlobalVariable>>,
    functions: Vec<Handle<Function>>,
}

/// Replaces a handle.
fn map<T>(known: &[Handle<T>], handle: &mut Handle<T>) {
    if let Some(new) = known.get(handle.index()) {
        *handle = *new;
    }
}

impl Merge {
    fn types(&mut self, first: &mut Module, types: &UniqueArena<Type>) {
        for (handle, ty) in types.iter() {
            let mut ty = ty.clone();
            match &mut ty.inner {
                TypeInner::Pointer { base, .. }
                | TypeInner::Array { base, size: ArraySize::Constant(_) | ArraySize::Dynamic, .. }
                | TypeInner::BindingArray { base, .. } => map(&self.types, base),
                TypeInner::Struct { members, .. } => {
                    members.iter_mut().for_each(|member| map(&self.types, &mut member.ty));
                }
                _ => {}
            }
            self.types.push(first.types.insert(ty, types.get_span(handle)));
        }
    }

    fn constants(&mut self, first: &mut Module, second: &Module) {
        for (handle, constant) in second.constants.iter() {
            let mut constant = constant.clone();
            map(&self.types, &mut constant.ty);
            constant.init = self.constant(first, &second.global_expressions, constant.init);
            let same = |known: &Constant| {
                (&known.name, known.ty) == (&constant.name, constant.ty)
                    && equal_values(&first.global_expressions, known.init, constant.init)
            };
            let known = first.constants.iter().find(|(_, known)| same(known)).map(|(handle, _)| handle);
            let span = second.constants.get_span(handle);
            self.constants.push(known.unwrap_or_else(|| first.constants.append(constant, span)));
        }
    }

    fn globals(&mut self, first: &mut Module, second: &Module) {
        for (handle, variable) in second.global_variables.iter() {
            let mut variable = variable.clone();
            map(&self.types, &mut variable.ty);
            variable.init = variable.init.map(|init| self.constant(first, &second.global_expressions, init));
            let same = |known: &GlobalVariable| {
                let inits = match (known.init, variable.init) {
                    (None, None) => true,
                    (Some(known), Some(own)) => equal_values(&first.global_expressions, known, own),
                    _ => false,
                };
                // The resource of a binding has one name, whatever each stage calls it.
                let named = known.binding.is_some() || known.name == variable.name;
                inits
                    && named
                    && (known.space, known.binding, known.ty) == (variable.space, variable.binding, variable.ty)
            };
            let known = first.global_variables.iter().find(|(_, known)| same(known)).map(|(handle, _)| handle);
            let span = second.global_variables.get_span(handle);
            self.globals.push(known.unwrap_or_else(|| first.global_variables.append(variable, span)));
        }
    }

    /// Copies a constant expression.
    fn constant(
        &self,
        first: &mut Module,
        expressions: &Arena<Expression>,
        handle: Handle<Expression>,
    ) -> Handle<Expression> {
        let mut expression = expressions[handle].clone();
        match &mut expression {
            Expression::Compose { components, .. } => {
                components.iter_mut().for_each(|part| *part = self.constant(first, expressions, *part));
            }
            Expression::Splat { value, .. } => *value = self.constant(first, expressions, *value),
            _ => {}
        }
        self.expression(&mut expression);
        first.global_expressions.append(expression, expressions.get_span(handle))
    }

    /// Replaces the handles of an expression that lead out of its function.
    fn expression(&self, expression: &mut Expression) {
        match expression {
            Expression::ZeroValue(ty) | Expression::Compose { ty, .. } => map(&self.types, ty),
            Expression::Constant(constant) => map(&self.constants, constant),
            Expression::GlobalVariable(variable) => map(&self.globals, variable),
            Expression::CallResult(function) => map(&self.functions, function),
            _ => {}
        }
    }

    fn function(&self, mut function: Function) -> Function {
        function.arguments.iter_mut().for_each(|argument| map(&self.types, &mut argument.ty));
        function.result.iter_mut().for_each(|result| map(&self.types, &mut result.ty));
        function.local_variables.iter_mut().for_each(|(_, local)| map(&self.types, &mut local.ty));
        function.expressions.iter_mut().for_each(|(_, expression)| self.expression(expression));
        self.block(&mut function.body);
        function
    }

    fn block(&self, block: &mut Block) {
        for statement in block.iter_mut() {
            match statement {
                Statement::Call { function, .. } => map(&self.functions, function),
                Statement::Block(block) => self.block(block),
                Statement::If { accept, reject, .. } => {
                    self.block(accept);
                    self.block(reject);
                }
                Statement::Switch { cases, .. } => cases.iter_mut().for_each(|case| self.block(&mut case.body)),
                Statement::Loop { body, continuing, .. } => {
                    self.block(body);
                    self.block(continuing);
                }
                _ => {}
            }
        }
    }
}

/// Whether two constant expressions have one value.
fn equal_values(all: &Arena<Expression>, one: Handle<Expression>, other: Handle<Expression>) -> bool {
    match (&all[one], &all[other]) {
        (Expression::Compose { ty, components }, Expression::Compose { ty: other_ty, components: others }) => {
            let parts = components.iter().zip(others);
            ty == other_ty
                && components.len() == others.len()
                && parts.into_iter().all(|(one, other)| equal_values(all, *one, *other))
        }
        (Expression::Splat { size, value }, Expression::Splat { size: other_size, value: other }) => {
            size == other_size && equal_values(all, *value, *other)
        }
        (one, other) => one == other,
    }
}

/// Whether two functions are the same but for their places in the source.
fn equal_functions(one: &Function, other: &Function) -> bool {
    let arguments = |function: &Function| {
        function.arguments.iter().map(|argument| (argument.name.clone(), argument.ty)).collect::<Vec<_>>()
    };
    let locals = |function: &Function| {
        let all = function.local_variables.iter();
        all.map(|(_, local)| (local.name.clone(), local.ty, local.init)).collect::<Vec<_>>()
    };
    let result = |function: &Function| function.result.as_ref().map(|result| result.ty);
    one.name == other.name
        && result(one) == result(other)
        && one.expressions.len() == other.expressions.len()
        && one.named_expressions == other.named_expressions
        && arguments(one) == arguments(other)
        && locals(one) == locals(other)
        && one.expressions.iter().zip(other.expressions.iter()).all(|((_, one), (_, other))| one == other)
        && equal_blocks(&one.body, &other.body)
}

fn equal_blocks(one: &Block, other: &Block) -> bool {
    one.len() == other.len() && one.iter().zip(other.iter()).all(|(one, other)| equal_statements(one, other))
}

fn equal_statements(one: &Statement, other: &Statement) -> bool {
    match (one, other) {
        (Statement::Block(one), Statement::Block(other)) => equal_blocks(one, other),
        (
            Statement::If { condition, accept, reject },
            Statement::If { condition: other, accept: other_accept, reject: other_reject },
        ) => condition == other && equal_blocks(accept, other_accept) && equal_blocks(reject, other_reject),
        (Statement::Switch { selector, cases }, Statement::Switch { selector: other, cases: others }) => {
            let same = |(one, other): (&naga::SwitchCase, &naga::SwitchCase)| {
                (one.value, one.fall_through) == (other.value, other.fall_through)
                    && equal_blocks(&one.body, &other.body)
            };
            selector == other && cases.len() == others.len() && cases.iter().zip(others).all(same)
        }
        (
            Statement::Loop { body, continuing, break_if },
            Statement::Loop { body: other, continuing: other_continuing, break_if: other_break },
        ) => break_if == other_break && equal_blocks(body, other) && equal_blocks(continuing, other_continuing),
        // These have no blocks, and therefore no places in the source.
        (one, other) => {
            std::mem::discriminant(one) == std::mem::discriminant(other) && format!("{one:?}") == format!("{other:?}")
        }
    }
}

/// Gives the entry point of each stage a name of its own.
pub(super) fn name_entry_points(module: &mut Module) {
    for entry in &mut module.entry_points {
        let stage = match entry.stage {
            naga::ShaderStage::Vertex => Stage::Vertex,
            _ => Stage::Fragment,
        };
        entry.name = entry_point(stage).to_owned();
        entry.function.name = Some(entry.name.clone());
    }
}

/// The name of a stage's entry point in a module with several.
pub(super) fn entry_point(stage: Stage) -> &'static str {
    match stage {
        Stage::Vertex => "vs_main",
        Stage::Geometry => "gs_main",
        Stage::Fragment => "fs_main",
    }
}
