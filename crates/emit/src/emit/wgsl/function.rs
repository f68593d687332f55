//! Builds the tree of a function.
//!
//! *In:* a function, and the [`Plan`] that says which values have names. *Out:* its [`Body`], and how its variables are
//! used, by which [`super::declarations`] declares them.

use super::declarations::{Local, Mention, Use};
use super::effects::{Call, Effects};
use super::expressions::Try;
use super::inverse::Inverses;
use super::loops::{self, Leaves};
use super::names::{Names, Words};
use super::plan::Plan;
use super::tree::{Block, BlockId, Body, Expr, NameId, Stmt, StmtKind};
use super::{Style, effects};
use naga::valid::FunctionInfo;
use naga::{Expression, Function, Handle, LocalVariable, Module, Statement, SwitchValue};
use rustc_hash::FxHashMap;

/// The things that are the same for all functions of a module.
pub(super) struct Context<'m> {
    pub(super) module: &'m Module,
    pub(super) names: &'m Names,
    pub(super) effects: &'m [Effects],
    pub(super) style: Style,
}

/// A function in progress.
pub(super) struct Builder<'m> {
    pub(super) module: &'m Module,
    pub(super) names: Words<'m>,
    pub(super) function: &'m Function,
    pub(super) info: &'m FunctionInfo,
    style: Style,
    plan: Plan,
    pub(super) body: Body<'m>,
    /// The names of values.
    named: FxHashMap<Handle<Expression>, NameId>,
    parameters: Vec<NameId>,
    pub(super) locals: Vec<Local<'m>>,
    calls: FxHashMap<Handle<Expression>, Call<'m>>,
    /// The variables that the statement in progress uses.
    mentioned: Vec<(Handle<LocalVariable>, Use)>,
    open: BlockId,
    pub(super) inverses: &'m Inverses,
}

/// A function's tree before its declarations have their places.
pub(super) struct Built<'m> {
    pub(super) body: Body<'m>,
    pub(super) parameters: Vec<NameId>,
    pub(super) locals: Vec<Local<'m>>,
}

impl<'m> Builder<'m> {
    /// The tree of a function.
    pub(super) fn build(
        context: &Context<'m>,
        inverses: &'m Inverses,
        function: &'m Function,
        info: &'m FunctionInfo,
    ) -> Try<Built<'m>> {
        let Context { module, names, effects, style } = *context;
        let mut builder = Self {
            module,
            names: Words(names),
            function,
            info,
            style,
            plan: Plan::of(module, function, info, effects, style),
            body: Body { blocks: vec![Block::default()], names: Vec::new() },
            named: FxHashMap::default(),
            parameters: Vec::new(),
            locals: Vec::new(),
            calls: FxHashMap::default(),
            mentioned: Vec::new(),
            open: BlockId(0),
            inverses,
        };
        builder.declare()?;
        builder.block(&function.body)?;
        Ok(Built { body: builder.body, parameters: builder.parameters, locals: builder.locals })
    }

    pub(super) fn is_full(&self) -> bool {
        self.style == Style::Full
    }

    /// Whether a composition is only there for its components.
    pub(super) fn is_open(&self, handle: Handle<Expression>) -> bool {
        self.plan.is_open(handle)
    }

    fn name(&mut self, name: &str) -> NameId {
        self.body.names.push(name.to_owned());
        NameId(self.body.names.len() - 1)
    }

    fn declare(&mut self) -> Try<()> {
        let function = self.function;
        for argument in &function.arguments {
            let name = self.name(argument.name.as_deref().unwrap_or("unnamed"));
            self.parameters.push(name);
        }
        for (handle, variable) in function.local_variables.iter() {
            let name = self.name(variable.name.as_deref().unwrap_or("variable"));
            let value = match variable.init {
                Some(init) => Some(self.value(init)?),
                None => None,
            };
            let ty = self.names.ty(self.module, variable.ty);
            let span = function.local_variables.get_span(handle);
            self.locals.push(Local { name, ty, value, span, mentions: Vec::new() });
        }
        Ok(())
    }

    pub(super) fn is_pointer(&self, handle: Handle<Expression>) -> bool {
        effects::is_pointer(&self.module.types, &self.info[handle].ty)
    }

    /// The name of a value that has been written already.
    pub(super) fn named(&self, handle: Handle<Expression>) -> Option<NameId> {
        self.named.get(&handle).copied()
    }

    pub(super) fn argument(&self, index: u32) -> Try<Expr<'m>> {
        let name = self.parameters.get(index as usize).copied();
        name.map(Expr::Local).ok_or_else(|| "a parameter is missing".to_owned())
    }

    /// A variable, which the current statement uses.
    pub(super) fn variable(&mut self, variable: Handle<LocalVariable>) -> Try<Expr<'m>> {
        self.mentioned.push((variable, Use::Other));
        let local = self.locals.get(variable.index()).ok_or("a variable is missing")?;
        Ok(Expr::Local(local.name))
    }

    /// The name of a polyfill for `inverse`.
    pub(super) fn inverse(&self, ty: &naga::TypeInner) -> Try<&'static str> {
        self.inverses.name(ty).ok_or_else(|| format!("WGSL has no inverse of {ty:?}"))
    }

    /// The call that a value comes from.
    pub(super) fn call_of(&mut self, handle: Handle<Expression>) -> Try<Expr<'m>> {
        let (function, arguments) = self.calls.get(&handle).copied().ok_or("a call is missing")?;
        self.call(function, arguments)
    }

    fn call(&mut self, function: Handle<Function>, arguments: &[Handle<Expression>]) -> Try<Expr<'m>> {
        let arguments = arguments.iter().map(|argument| {
            if let Expression::LocalVariable(_) = self.function.expressions[*argument] {
                let value = self.value(*argument);
                if let Some((_, how)) = self.mentioned.last_mut() {
                    *how = Use::Pointer;
                }
                return value;
            }
            self.value(*argument)
        });
        let arguments = arguments.collect::<Try<Vec<_>>>()?;
        Ok(Expr::Call(self.names.0.function(function).into(), arguments))
    }

    /// Adds a statement, and remembers where it uses variables.
    fn push(&mut self, kind: StmtKind<'m>, span: naga::Span) {
        let block = self.open;
        let at = self.body.blocks.get(block.0).map_or(0, |block| block.statements.len());
        for (variable, how) in self.mentioned.drain(..) {
            if let Some(local) = self.locals.get_mut(variable.index()) {
                local.mentions.push(Mention { block, at, how });
            }
        }
        if let Some(block) = self.body.blocks.get_mut(block.0) {
            block.statements.push(Stmt::new(kind, span));
        }
    }

    /// Builds a block that belongs to the next statement of the open one.
    fn inner(&mut self, block: &'m naga::Block, repeats: bool) -> Try<BlockId> {
        let outer = self.open;
        let at = self.body.blocks.get(outer.0).map_or(0, |block| block.statements.len());
        let id = BlockId(self.body.blocks.len());
        self.body.blocks.push(Block { parent: Some((outer, at)), repeats, ..Block::default() });
        self.open = id;
        let mentioned = std::mem::take(&mut self.mentioned);
        self.block(block)?;
        self.mentioned = mentioned;
        self.open = outer;
        Ok(id)
    }

    fn block(&mut self, block: &'m naga::Block) -> Try<()> {
        for (statement, span) in block.span_iter() {
            self.statement(statement, *span)?;
        }
        Ok(())
    }

    fn statement(&mut self, statement: &'m Statement, span: naga::Span) -> Try<()> {
        match statement {
            Statement::Emit(range) => {
                for handle in range.clone() {
                    if self.plan.is_named(handle) {
                        self.let_statement(handle, span)?;
                    }
                }
                return Ok(());
            }
            Statement::Call { function, arguments, result } => {
                if let Some(result) = result {
                    self.calls.insert(*result, (*function, arguments));
                    if self.plan.is_named(*result) {
                        return self.let_statement(*result, span);
                    }
                    if self.plan.is_used(*result) {
                        return Ok(());
                    }
                }
                let call = self.call(*function, arguments)?;
                self.push(StmtKind::Call(call), span);
            }
            Statement::Store { pointer, value } => self.store(*pointer, *value, span)?,
            Statement::Return { value } => {
                let value = match value {
                    Some(value) => Some(self.value(*value)?),
                    None => None,
                };
                self.push(StmtKind::Return(value), span);
            }
            Statement::Kill => self.push(StmtKind::Word("discard"), span),
            Statement::Break => self.push(StmtKind::Word("break"), span),
            Statement::Continue => self.push(StmtKind::Word("continue"), span),
            Statement::If { condition, accept, reject } => {
                let condition = self.value(*condition)?;
                let accept = self.inner(accept, false)?;
                let reject = self.inner(reject, false)?;
                self.push(StmtKind::If { condition, accept, reject }, span);
            }
            Statement::Switch { selector, cases } => {
                let selector = self.value(*selector)?;
                let cases = self.cases(cases)?;
                self.push(StmtKind::Switch { selector, cases }, span);
            }
            Statement::Loop { body, continuing, break_if } => self.repeat(body, continuing, *break_if, span)?,
            Statement::Block(block) => {
                let block = self.inner(block, false)?;
                self.push(StmtKind::Block(block), span);
            }
            other => return Err(format!("no WGSL for {other:?}")),
        }
        Ok(())
    }

    fn let_statement(&mut self, handle: Handle<Expression>, span: naga::Span) -> Try<()> {
        let value = self.value(handle)?;
        let name = match self.function.named_expressions.get(&handle) {
            Some(name) => self.name(name),
            None => {
                let name = self.describing(handle);
                self.name(&name)
            }
        };
        self.named.insert(handle, name);
        let kind = if self.is_full() && matches!(value, Expr::Constant(_)) {
            let ty = self.names.inner(self.module, self.info[handle].ty.inner_with(&self.module.types));
            StmtKind::Var { name, ty, value: Some(value) }
        } else {
            StmtKind::Let { name, value }
        };
        self.push(kind, span);
        Ok(())
    }

    /// A name that says what a value is.
    fn describing(&self, handle: Handle<Expression>) -> String {
        match &self.function.expressions[handle] {
            Expression::ImageQuery { .. } => "size".to_owned(),
            Expression::ImageSample { .. } | Expression::ImageLoad { .. } => "texel".to_owned(),
            Expression::CallResult(function) => format!("{}_result", self.names.0.function(*function)),
            Expression::Load { pointer } => match self.function.expressions[*pointer] {
                Expression::LocalVariable(variable) => {
                    let name = self.function.local_variables[variable].name.as_deref();
                    format!("{}_before", name.unwrap_or("value"))
                }
                Expression::GlobalVariable(variable) => format!("{}_before", self.names.0.global_name(variable)),
                _ => "value".to_owned(),
            },
            _ => "value".to_owned(),
        }
    }

    fn store(&mut self, pointer: Handle<Expression>, value: Handle<Expression>, span: naga::Span) -> Try<()> {
        let value = self.value(value)?;
        let whole = match self.function.expressions[pointer] {
            Expression::LocalVariable(variable) => Some(variable),
            _ => None,
        };
        // A value that reads the variable cannot start it.
        let reads = whole.is_some_and(|whole| self.mentioned.iter().any(|(variable, _)| *variable == whole));
        let target = self.reference(pointer)?;
        if let Some((_, how)) = self.mentioned.last_mut().filter(|_| whole.is_some()) {
            *how = if reads { Use::Update } else { Use::Store };
        } else if let Some(naga_root) = effects::root(self.module, &self.function.expressions, pointer)
            && let effects::Root::Local(root) = naga_root
        {
            self.mentioned.push((root, Use::Update));
        }
        let value = if self.is_full() { self.with_target(value, &target) } else { value };
        let is_scalar = match self.info[pointer].ty.inner_with(&self.module.types) {
            naga::TypeInner::Pointer { base, .. } => {
                matches!(self.module.types[*base].inner, naga::TypeInner::Scalar(_))
            }
            naga::TypeInner::ValuePointer { size, .. } => size.is_none(),
            _ => false,
        };
        let kind = loops::compound(StmtKind::Assign { target, op: None, value, whole }, is_scalar);
        self.push(kind, span);
        Ok(())
    }

    /// `a + 1` for `b + 1` directly behind `let b = a;`, where `a` is what is stored to.
    fn with_target(&self, value: Expr<'m>, target: &Expr<'m>) -> Expr<'m> {
        let last = self.body.blocks.get(self.open.0).and_then(|block| block.statements.last());
        match (value, last.map(|last| &last.kind)) {
            (Expr::Binary(op, left, right), Some(StmtKind::Let { name, value: before }))
                if *left == Expr::Local(*name) && before == target =>
            {
                Expr::Binary(op, Box::new(target.clone()), right)
            }
            (value, _) => value,
        }
    }

    /// The cases of a `switch` with their labels: empty ones belong to the next.
    fn cases(&mut self, cases: &'m [naga::SwitchCase]) -> Try<Vec<(String, BlockId)>> {
        let mut built = Vec::new();
        let mut labels: Vec<String> = Vec::new();
        for case in cases {
            labels.push(match case.value {
                SwitchValue::I32(value) => value.to_string(),
                SwitchValue::U32(value) => format!("{value}u"),
                SwitchValue::Default => "default".to_owned(),
            });
            if case.fall_through {
                if !case.body.is_empty() {
                    return Err("a case falls through".to_owned());
                }
                continue;
            }
            let text = labels.join(", ");
            labels.clear();
            let head = if text == "default" { text } else { format!("case {text}") };
            built.push((head, self.inner(&case.body, false)?));
        }
        Ok(built)
    }

    fn repeat(
        &mut self,
        body: &'m naga::Block,
        continuing: &'m naga::Block,
        break_if: Option<Handle<Expression>>,
        span: naga::Span,
    ) -> Try<()> {
        let body = self.inner(body, true)?;
        let continuing = self.inner(continuing, true)?;
        let break_if = match break_if {
            // What it uses is used in the `continuing` block: it is declared outside.
            Some(condition) => Some(self.value(condition)?),
            None => None,
        };
        let kind = match self.head(body, continuing, break_if.is_some()) {
            Some((condition, step)) => StmtKind::For { init: None, condition, step: step.map(Box::new), body },
            None => {
                let len = self.body.blocks.get(continuing.0).map_or(0, |block| block.statements.len());
                if let Some(block) = self.body.blocks.get_mut(continuing.0) {
                    block.in_head = len;
                }
                StmtKind::Loop { body, continuing, break_if }
            }
        };
        self.push(kind, span);
        Ok(())
    }

    /// The head of a `for` or `while`.
    fn head(
        &mut self,
        body: BlockId,
        continuing: BlockId,
        has_break: bool,
    ) -> Option<(Option<Expr<'m>>, Option<StmtKind<'m>>)> {
        if has_break {
            return None;
        }
        let breaks = |id: BlockId| {
            let block = self.body.blocks.get(id.0).map(|block| block.statements.as_slice());
            matches!(block, Some([only]) if matches!(only.kind, StmtKind::Word("break")))
        };
        let is_empty = |id: BlockId| self.body.blocks.get(id.0).is_some_and(|block| block.statements.is_empty());
        let leaves = match self.body.blocks.get(body.0)?.statements.first().map(|first| &first.kind) {
            Some(StmtKind::If { accept, reject, .. }) if breaks(*accept) && is_empty(*reject) => Leaves::If,
            Some(StmtKind::If { accept, reject, .. }) if is_empty(*accept) && breaks(*reject) => Leaves::Unless,
            _ => Leaves::No,
        };
        let mut own = std::mem::take(self.body.blocks.get_mut(body.0)?);
        let mut step = std::mem::take(self.body.blocks.get_mut(continuing.0)?);
        let head = loops::head(&mut own, &mut step, leaves);
        *self.body.blocks.get_mut(body.0)? = own;
        *self.body.blocks.get_mut(continuing.0)? = step;
        head
    }
}
