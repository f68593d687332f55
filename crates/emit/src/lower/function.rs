//! [`Ctx`]: the state of lowering one function: naga's arenas, the expressions to emit, and names.
//!
//! *Holds:* an expression is evaluated at its `Emit`, so what is added between two statements is emitted between
//! them. Literals, variables and arguments are not evaluated and are outside every range.

use super::slots::{Corner, LocalSlot, Lowered, OutputMember, SamplerValue};
use super::{Lower, Try, for_each_operand, internal, naga_span};
use glisten_front::hir::{FunctionId, GlobalId, LocalId, LocalKind, ParamMode, ScalarValue, Shader, Stage, TypeId};
use glisten_front::source::Span;
use naga::{Arena, Block, Expression, Handle, Literal, LocalVariable, Statement};
use rustc_hash::FxHashMap;

/// The kind of a literal, which distinguishes literals of equal value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum Shared {
    Bool(bool),
    Int(i32),
    Uint(u32),
    Float(u32),
    Global(Handle<naga::GlobalVariable>),
    Constant(Handle<naga::Constant>),
    Local(Handle<LocalVariable>),
    Zero(Handle<naga::Type>),
}

/// How deep an expression may nest in the text before it gets a name. Tint and naga reject text that nests much
/// deeper than a hundred levels, and a reader gives up long before.
const TEXT_DEPTH: u8 = 24;

/// The state of lowering one function.
pub(super) struct Ctx<'l, 'a> {
    pub(super) low: &'l mut Lower<'a>,
    pub(super) shader: &'a Shader,
    pub(super) id: FunctionId,
    pub(super) out: naga::Function,
    blocks: Vec<Block>,
    open: usize,
    slots: Vec<LocalSlot>,
    pub(super) param_samplers: FxHashMap<LocalId, Vec<SamplerValue>>,
    /// In the entry point: the globals that no other function uses.
    pub(super) entry: FxHashMap<GlobalId, LocalSlot>,
    /// For each expression: how deep it nests in the text.
    depths: Vec<u8>,
    /// For each expression: whether a target knows its value before the shader runs.
    pub(super) known: Vec<bool>,
    shared: FxHashMap<Shared, Handle<Expression>>,
    span: naga::Span,
    /// How many loops surround the current statement.
    pub(super) loops: u32,
    /// How many switch bodies share the scope of the current statement.
    pub(super) in_switch: bool,
    /// Whether this is the entry point, whose `return` collects the outputs.
    pub(super) is_entry: bool,
    pub(super) outputs: Vec<OutputMember>,
    /// In a vertex stage that draws points as quads: the corner.
    pub(super) corner: Option<Corner>,
}

impl<'l, 'a> Ctx<'l, 'a> {
    /// An empty function for a function of the shader.
    pub(super) fn new(low: &'l mut Lower<'a>, id: FunctionId) -> Self {
        let shader = low.shader;
        let function = shader.function(id);
        Self {
            shader,
            id,
            out: naga::Function { name: Some(function.name.clone()), ..naga::Function::default() },
            blocks: vec![Block::new()],
            open: 0,
            slots: vec![LocalSlot::Unset; function.locals.len()],
            param_samplers: FxHashMap::default(),
            entry: FxHashMap::default(),
            depths: Vec::new(),
            known: Vec::new(),
            shared: FxHashMap::default(),
            span: naga_span(function.span),
            loops: 0,
            in_switch: false,
            is_entry: shader.main == Some(id),
            outputs: Vec::new(),
            corner: None,
            low,
        }
    }

    /// An empty function that the shader does not have, for generated code.
    pub(super) fn helper(low: &'l mut Lower<'a>, name: &str) -> Self {
        let main = low.shader.main.unwrap_or(FunctionId::new(0));
        let mut ctx = Self::new(low, main);
        ctx.out.name = Some(name.to_owned());
        ctx.is_entry = false;
        ctx
    }

    /// Whether this is the vertex stage.
    pub(super) fn is_vertex(&self) -> bool {
        self.shader.stage == Stage::Vertex
    }

    /// Sets the span of what is lowered from here on.
    pub(super) fn at(&mut self, span: Span) -> naga::Span {
        std::mem::replace(&mut self.span, naga_span(span))
    }

    /// Restores the span that [`Self::at`] returned.
    pub(super) fn back_to(&mut self, span: naga::Span) {
        self.span = span;
    }

    /// The span of the current expression or statement.
    pub(super) fn here(&self) -> Span {
        let range = self.span.to_range().unwrap_or(0..0);
        Span::new(range.start as u32, range.end as u32)
    }

    /// Adds an expression that is evaluated here.
    pub(super) fn add(&mut self, expression: Expression) -> Handle<Expression> {
        if expression.needs_pre_emit() {
            self.flush();
            let literal =
                matches!(expression, Expression::Literal(_) | Expression::ZeroValue(_) | Expression::Constant(_));
            let handle = self.append(expression, 0, literal);
            self.open = self.out.expressions.len();
            return handle;
        }
        let expression = self.kept_from_evaluation(expression);
        let expression = self.with_scalar_constituents(expression);
        let known = self.is_known(&expression);
        let mut depth = 0_u8;
        for_each_operand(&expression, |operand| {
            depth = depth.max(self.depths.get(operand.index()).copied().unwrap_or(0));
        });
        // A pointer is not a value and cannot have a name; loads from it can.
        let nameable = !matches!(expression, Expression::Access { .. } | Expression::AccessIndex { .. });
        let deep = depth >= TEXT_DEPTH && nameable;
        let handle = self.append(expression, if deep { 0 } else { depth.saturating_add(1) }, known);
        if deep {
            self.name(handle, "part");
        }
        handle
    }

    fn append(&mut self, expression: Expression, depth: u8, known: bool) -> Handle<Expression> {
        self.depths.push(depth);
        self.known.push(known);
        self.out.expressions.append(expression, self.span)
    }

    /// Gives a value a name in the text.
    pub(super) fn name(&mut self, handle: Handle<Expression>, name: &str) {
        self.out.named_expressions.entry(handle).or_insert_with(|| name.to_owned());
    }

    /// Whether the value has a name or is a name.
    pub(super) fn is_named(&self, handle: Handle<Expression>) -> bool {
        self.out.named_expressions.contains_key(&handle) || self.out.expressions[handle].needs_pre_emit()
    }

    /// Emits all expressions added so far.
    pub(super) fn flush(&mut self) {
        let range = self.out.expressions.range_from(self.open);
        self.open = self.out.expressions.len();
        if range.clone().next().is_some() {
            let span = self.span;
            self.block().push(Statement::Emit(range), span);
        }
    }

    fn block(&mut self) -> &mut Block {
        if self.blocks.is_empty() {
            self.blocks.push(Block::new());
        }
        let last = self.blocks.len() - 1;
        &mut self.blocks[last]
    }

    /// Adds a statement after everything added so far.
    pub(super) fn statement(&mut self, statement: Statement) {
        self.flush();
        let span = self.span;
        self.block().push(statement, span);
    }

    /// Whether nothing can follow in the current block.
    pub(super) fn is_over(&self) -> bool {
        self.open == self.out.expressions.len() && self.blocks.last().is_some_and(ends)
    }

    /// Whether the current block is the function's own.
    pub(super) fn is_outermost(&self) -> bool {
        self.blocks.len() <= 1
    }

    /// Whether the target sees that the end of the function cannot be reached. A `discard` ends a
    /// function in some of them.
    pub(super) fn has_returned(&mut self) -> bool {
        self.flush();
        let kill_ends = self.low.can().ends_at_discard || self.out.result.is_none();
        self.is_over() || self.blocks.last().is_some_and(|block| terminates(block, kill_ends))
    }

    /// Opens a block.
    pub(super) fn begin(&mut self) {
        self.flush();
        self.blocks.push(Block::new());
    }

    /// Closes the block and returns it.
    pub(super) fn end(&mut self) -> Block {
        self.flush();
        self.blocks.pop().unwrap_or_default()
    }

    /// Lowers into a new block.
    pub(super) fn in_block(&mut self, lower: impl FnOnce(&mut Self) -> Try<()>) -> Try<Block> {
        self.begin();
        let result = lower(self);
        let block = self.end();
        result.map(|()| block)
    }

    /// The result of a call, which the call statement evaluates.
    pub(super) fn call(
        &mut self,
        function: Handle<naga::Function>,
        arguments: Vec<Handle<Expression>>,
        has_result: bool,
    ) -> Option<Handle<Expression>> {
        self.flush();
        let result = has_result.then(|| {
            let handle = self.append(Expression::CallResult(function), 0, false);
            self.open = self.out.expressions.len();
            handle
        });
        self.statement(Statement::Call { function, arguments, result });
        result
    }

    /// An argument of the function.
    pub(super) fn argument(
        &mut self,
        name: &str,
        ty: Handle<naga::Type>,
        binding: Option<naga::Binding>,
    ) -> Handle<Expression> {
        let name = if name.is_empty() { "unnamed" } else { name };
        let index = self.out.arguments.len() as u32;
        self.out.arguments.push(naga::FunctionArgument { name: Some(name.to_owned()), ty, binding });
        self.add(Expression::FunctionArgument(index))
    }

    /// A variable of the function, as a pointer.
    pub(super) fn variable(&mut self, name: &str, ty: Handle<naga::Type>) -> Handle<Expression> {
        self.variable_with(name, ty, None)
    }

    /// A variable of the function with an initial value that needs no evaluation.
    pub(super) fn variable_with(
        &mut self,
        name: &str,
        ty: Handle<naga::Type>,
        init: Option<Handle<Expression>>,
    ) -> Handle<Expression> {
        let variable = LocalVariable { name: Some(name.to_owned()), ty, init };
        let handle = self.out.local_variables.append(variable, self.span);
        self.shared_expression(Shared::Local(handle), Expression::LocalVariable(handle))
    }

    /// A variable of a GLSL type.
    pub(super) fn variable_of(&mut self, name: &str, ty: TypeId) -> Try<Handle<Expression>> {
        let ty = self.low.value_type(ty)?;
        Ok(self.variable(name, ty))
    }

    fn shared_expression(&mut self, key: Shared, expression: Expression) -> Handle<Expression> {
        if let Some(known) = self.shared.get(&key) {
            return *known;
        }
        let handle = self.add(expression);
        self.shared.insert(key, handle);
        handle
    }

    /// A literal. A non-finite float has none: see [`Self::scalar`].
    pub(super) fn literal(&mut self, value: ScalarValue) -> Handle<Expression> {
        let (key, literal) = match value {
            ScalarValue::Bool(value) => (Shared::Bool(value), Literal::Bool(value)),
            ScalarValue::Int(value) => (Shared::Int(value), Literal::I32(value)),
            ScalarValue::Uint(value) => (Shared::Uint(value), Literal::U32(value)),
            ScalarValue::Float(value) => (Shared::Float(value.to_bits()), Literal::F32(value)),
        };
        self.shared_expression(key, Expression::Literal(literal))
    }

    /// `float` literal.
    pub(super) fn float(&mut self, value: f32) -> Handle<Expression> {
        self.literal(ScalarValue::Float(value))
    }

    /// `int` literal.
    pub(super) fn int(&mut self, value: i32) -> Handle<Expression> {
        self.literal(ScalarValue::Int(value))
    }

    /// `uint` literal.
    pub(super) fn uint(&mut self, value: u32) -> Handle<Expression> {
        self.literal(ScalarValue::Uint(value))
    }

    /// `bool` literal.
    pub(super) fn boolean(&mut self, value: bool) -> Handle<Expression> {
        self.literal(ScalarValue::Bool(value))
    }

    /// The zero value of a type.
    pub(super) fn zero(&mut self, ty: Handle<naga::Type>) -> Handle<Expression> {
        self.shared_expression(Shared::Zero(ty), Expression::ZeroValue(ty))
    }

    /// A variable of the module.
    pub(super) fn global_variable(&mut self, variable: Handle<naga::GlobalVariable>) -> Handle<Expression> {
        self.shared_expression(Shared::Global(variable), Expression::GlobalVariable(variable))
    }

    /// A constant of the module.
    pub(super) fn module_constant(&mut self, constant: Handle<naga::Constant>) -> Handle<Expression> {
        self.shared_expression(Shared::Constant(constant), Expression::Constant(constant))
    }

    /// Loads from a pointer.
    pub(super) fn load(&mut self, pointer: Handle<Expression>) -> Handle<Expression> {
        self.add(Expression::Load { pointer })
    }

    /// Stores to a pointer.
    pub(super) fn store(&mut self, pointer: Handle<Expression>, value: Handle<Expression>) {
        self.statement(Statement::Store { pointer, value });
    }

    /// The representation of a local.
    pub(super) fn slot(&self, local: LocalId) -> LocalSlot {
        self.slots.get(local.index()).cloned().unwrap_or(LocalSlot::Unset)
    }

    /// Sets the representation of a local.
    pub(super) fn set_slot(&mut self, local: LocalId, slot: LocalSlot) {
        if let Some(place) = self.slots.get_mut(local.index()) {
            *place = slot;
        }
    }

    /// The expressions so far.
    pub(super) fn expressions(&self) -> &Arena<Expression> {
        &self.out.expressions
    }

    /// Returns the finished function.
    pub(super) fn finish(mut self) -> (naga::Function, &'l mut Lower<'a>) {
        self.flush();
        self.out.body = self.blocks.pop().unwrap_or_default();
        (self.out, self.low)
    }

    /// Declares the parameters: `out` parameters as pointers, a sampler as a texture and a sampler.
    pub(super) fn declare_parameters(&mut self) -> Try<()> {
        let function = self.shader.function(self.id);
        for (index, param) in function.params().iter().enumerate() {
            let local = LocalId::new(index);
            self.at(param.span);
            if self.low.types.contains_sampler(param.ty) {
                let samplers = self.sampler_parameters(param)?;
                self.param_samplers.insert(local, samplers);
            }
            if !self.low.has_value(param.ty) {
                continue;
            }
            let ty = self.low.value_type(param.ty)?;
            if matches!(param.kind, LocalKind::Param(ParamMode::Out | ParamMode::Inout)) {
                let space = naga::AddressSpace::Function;
                let pointer = self.low.insert_type(None, naga::TypeInner::Pointer { base: ty, space });
                let argument = self.argument(&param.name, pointer, None);
                self.set_slot(local, LocalSlot::Pointer(argument));
            } else {
                let argument = self.argument(&param.name, ty, None);
                self.set_slot(local, LocalSlot::Value(argument));
            }
        }
        self.copy_written_parameters()
    }

    /// Gives parameters that are written a variable, since arguments cannot be written to.
    fn copy_written_parameters(&mut self) -> Try<()> {
        let function = self.shader.function(self.id);
        for (index, param) in function.params().iter().enumerate() {
            let local = LocalId::new(index);
            let LocalSlot::Value(argument) = self.slot(local) else { continue };
            let needs = self.low.facts.function(self.id).and_then(|facts| facts.needs_variable.get(index).copied());
            if needs == Some(true) {
                let variable = self.variable_of(&param.name, param.ty)?;
                self.store(variable, argument);
                self.set_slot(local, LocalSlot::Pointer(variable));
            }
        }
        Ok(())
    }

    /// The internal error of an invalid handle.
    pub(super) fn internal_error(&self, message: &str) -> Box<glisten_front::diagnostic::Diagnostic> {
        internal(self.here(), message)
    }
}

/// Whether the block ends in a statement after which naga allows none.
fn ends(block: &Block) -> bool {
    matches!(block.last(), Some(Statement::Break | Statement::Continue | Statement::Return { .. } | Statement::Kill))
}

/// Whether nothing after the block can be reached; `kill_ends` says whether that is so after a `discard`.
fn terminates(block: &Block, kill_ends: bool) -> bool {
    match block.last() {
        Some(Statement::Break | Statement::Continue | Statement::Return { .. }) => true,
        Some(Statement::Kill) => kill_ends,
        Some(Statement::If { accept, reject, .. }) => terminates(accept, kill_ends) && terminates(reject, kill_ends),
        Some(Statement::Block(block)) => terminates(block, kill_ends),
        _ => false,
    }
}

impl Lower<'_> {
    /// Lowers a function of the shader other than `main`.
    pub(super) fn function(&mut self, id: FunctionId) -> Try<()> {
        let shader = self.shader;
        let function = shader.function(id);
        let Some(body) = &function.body else {
            return Err(internal(function.span, format!("`{}` has no body", function.name)));
        };
        let result = match function.ret {
            TypeId::VOID => None,
            ty => Some(naga::FunctionResult { ty: self.value_type(ty)?, binding: None }),
        };
        let mut ctx = Ctx::new(self, id);
        ctx.out.result = result;
        ctx.declare_parameters()?;
        ctx.body(body)?;
        if !ctx.has_returned() && function.ret != TypeId::VOID {
            ctx.return_nothing()?;
        }
        let (out, low) = ctx.finish();
        let handle = low.module.functions.append(out, naga_span(function.span));
        if let Some(place) = low.functions.get_mut(id.index()) {
            *place = Some(Lowered { handle });
        }
        Ok(())
    }
}
