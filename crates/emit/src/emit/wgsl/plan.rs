//! Decides which values get a name, and which are written where they are used.
//!
//! naga evaluates an expression at its `Emit`. In the text, an expression without a name is evaluated where it is
//! written. That is the same if nothing between the two places changes what the expression reads, and if calls stay in
//! their order.
//!
//! *In:* a function. *Out:* a [`Plan`]. *Holds:* values that are used several times have names, but for parts of other
//! values and for variables that keep their value until the last use. What a store or a call would overtake has a name.
//! Nothing that reads variables, calls or looks up moves into a branch or a loop.

use super::Style;
use super::effects::{Call, Class, Effects, classes, root};
use super::order::Effect;
use crate::emit::statements::{blocks, operands};
use crate::lower::for_each_operand;
use naga::{Block, Expression, Function, Handle, Statement};

/// After this many attempts, everything that could be overtaken gets a name.
const ATTEMPTS: usize = 12;
/// With more reads and calls in one statement, calls get names.
const MOST_ATOMS: usize = 96;

/// Which expressions of a function get names.
pub(super) struct Plan {
    named: Vec<bool>,
    open: Vec<bool>,
    /// How often each expression is written.
    uses: Vec<u32>,
}

impl Plan {
    /// Whether the expression is a `let`.
    pub(super) fn is_named(&self, handle: Handle<Expression>) -> bool {
        self.named.get(handle.index()).copied().unwrap_or(false)
    }

    /// Whether the expression is only there for its elements.
    pub(super) fn is_open(&self, handle: Handle<Expression>) -> bool {
        self.open.get(handle.index()).copied().unwrap_or(false)
    }

    /// Whether the expression is used at all.
    pub(super) fn is_used(&self, handle: Handle<Expression>) -> bool {
        self.uses.get(handle.index()).is_some_and(|uses| *uses > 0)
    }

    /// The plan for a function.
    pub(super) fn of(
        module: &naga::Module,
        function: &Function,
        info: &naga::valid::FunctionInfo,
        effects: &[Effects],
        style: Style,
    ) -> Self {
        let len = function.expressions.len();
        let mut planner = Planner {
            module,
            function,
            effects,
            style,
            classes: classes(module, function, info, style),
            forced: vec![false; len],
            plan: Self { named: vec![false; len], open: Vec::new(), uses: vec![0; len] },
            users: vec![None; len],
            emitted: vec![false; len],
            left: vec![0; len],
            pending: Vec::new(),
            calls: vec![None; len],
            atoms: Vec::new(),
        };
        planner.plan.open = planner.classes.iter().map(|class| *class == Class::Open).collect();
        planner.find_users();
        for attempt in 0.. {
            let before = planner.forced.iter().filter(|forced| **forced).count();
            if attempt == ATTEMPTS {
                planner.force_all();
            }
            planner.count_uses();
            if planner.classes.iter().all(|class| !matches!(class, Class::Load(..) | Class::Call | Class::Lookup)) {
                break;
            }
            planner.pending.clear();
            planner.emitted.fill(false);
            planner.left.copy_from_slice(&planner.plan.uses);
            planner.block(&function.body);
            let after = planner.forced.iter().filter(|forced| **forced).count();
            if after == before || attempt >= ATTEMPTS {
                break;
            }
        }
        planner.plan
    }
}

/// A plan in progress.
pub(super) struct Planner<'f> {
    pub(super) module: &'f naga::Module,
    pub(super) function: &'f Function,
    pub(super) effects: &'f [Effects],
    style: Style,
    classes: Vec<Class>,
    /// Whether an expression has a name because something would overtake it.
    forced: Vec<bool>,
    plan: Plan,
    /// One user of each expression.
    users: Vec<Option<Handle<Expression>>>,
    emitted: Vec<bool>,
    /// How often each expression has still to be written.
    left: Vec<u32>,
    /// Reads, calls and lookups that are evaluated but not written yet.
    pending: Vec<Handle<Expression>>,
    /// For each result of a call: what it calls.
    pub(super) calls: Vec<Option<Call<'f>>>,
    atoms: Vec<Handle<Expression>>,
}

impl<'f> Planner<'f> {
    pub(super) fn class(&self, handle: Handle<Expression>) -> Class {
        self.classes.get(handle.index()).copied().unwrap_or(Class::Pure)
    }

    fn find_users(&mut self) {
        let function = self.function;
        for (handle, expression) in function.expressions.iter() {
            for_each_operand(expression, |operand| {
                if let Some(user) = self.users.get_mut(operand.index()) {
                    *user = Some(handle);
                }
            });
        }
        self.find_calls(&function.body);
    }

    fn find_calls(&mut self, block: &'f Block) {
        for statement in block {
            if let Statement::Call { function, arguments, result: Some(result) } = statement
                && let Some(call) = self.calls.get_mut(result.index())
            {
                *call = Some((*function, arguments));
                for argument in arguments {
                    if let Some(user) = self.users.get_mut(argument.index()) {
                        *user = Some(*result);
                    }
                }
            }
            blocks(statement).into_iter().for_each(|inner| self.find_calls(inner));
        }
    }

    fn force_all(&mut self) {
        for (forced, class) in self.forced.iter_mut().zip(&self.classes) {
            *forced |= matches!(class, Class::Load(..) | Class::Call | Class::Lookup);
        }
    }

    /// Counts how often each expression is written, and names those that must be.
    fn count_uses(&mut self) {
        let function = self.function;
        let mut uses = std::mem::take(&mut self.plan.uses);
        uses.fill(0);
        count_in(&function.body, &mut uses);
        let handles: Vec<Handle<Expression>> = function.expressions.iter().map(|(handle, _)| handle).collect();
        for handle in handles.into_iter().rev() {
            let index = handle.index();
            let own = uses.get(index).copied().unwrap_or(0);
            let named = self.gets_name(handle, own);
            if let Some(place) = self.plan.named.get_mut(index) {
                *place = named;
            }
            let call = self.calls.get(index).copied().flatten();
            let written = match call {
                _ if named => 1,
                // Without a use of its result, a call is a statement.
                Some(_) => own.max(1),
                None => own,
            };
            if written == 0 {
                continue;
            }
            let mut count = |operand: Handle<Expression>| {
                if let Some(place) = uses.get_mut(operand.index()) {
                    *place = place.saturating_add(written);
                }
            };
            match call {
                Some((_, arguments)) => arguments.iter().for_each(|argument| count(*argument)),
                None => for_each_operand(&function.expressions[handle], count),
            }
        }
        self.plan.uses = uses;
    }

    /// Whether an expression that is written this often gets a name.
    fn gets_name(&self, handle: Handle<Expression>, uses: u32) -> bool {
        let forced = self.forced.get(handle.index()).copied().unwrap_or(false);
        match self.class(handle) {
            Class::Given | Class::Pointer | Class::Open => false,
            _ if forced || self.function.named_expressions.contains_key(&handle) => true,
            Class::Part | Class::Constant | Class::Load(_, true) => false,
            Class::Lookup if self.style != Style::Full => true,
            _ => uses >= 2,
        }
    }

    fn block(&mut self, block: &'f Block) {
        let start = self.pending.len();
        for statement in block {
            match statement {
                Statement::Emit(range) => range.clone().for_each(|handle| self.emit(handle)),
                Statement::Call { function, arguments, result } => {
                    let pending = result.is_some_and(|result| self.plan.is_used(result) && !self.plan.is_named(result));
                    if let (Some(result), true) = (result, pending) {
                        self.mark_emitted(*result);
                        self.pending.push(*result);
                        continue;
                    }
                    if let Some(result) = result {
                        self.mark_emitted(*result);
                    }
                    self.anchor(arguments, Effect::Call { function: *function, arguments });
                }
                Statement::Store { pointer, value } => self.anchor_store(*pointer, *value),
                Statement::Return { value } => match value {
                    Some(value) => self.anchor(&[*value], Effect::None),
                    None => self.anchor(&[], Effect::None),
                },
                Statement::If { condition, .. } => self.compound(&[*condition], statement),
                Statement::Switch { selector, .. } => self.compound(&[*selector], statement),
                Statement::Loop { body, continuing, break_if } => {
                    self.force_pending(0);
                    self.block(body);
                    self.block(continuing);
                    if let Some(condition) = break_if {
                        self.anchor(&[*condition], Effect::None);
                    }
                }
                Statement::Block(_) => self.compound(&[], statement),
                _ => self.force_pending(0),
            }
        }
        self.force_pending(start);
        self.pending.truncate(start);
    }

    fn compound(&mut self, operands: &[Handle<Expression>], statement: &'f Statement) {
        self.anchor(operands, Effect::None);
        self.force_pending(0);
        for inner in blocks(statement) {
            self.block(inner);
        }
    }

    fn mark_emitted(&mut self, handle: Handle<Expression>) {
        if let Some(emitted) = self.emitted.get_mut(handle.index()) {
            *emitted = true;
        }
    }

    fn emit(&mut self, handle: Handle<Expression>) {
        if self.plan.is_named(handle) {
            self.anchor_of(handle);
        } else if self.plan.is_used(handle)
            && matches!(self.class(handle), Class::Load(..) | Class::Call | Class::Lookup)
        {
            self.pending.push(handle);
        }
        self.mark_emitted(handle);
    }

    /// A value with a name is written here.
    fn anchor_of(&mut self, handle: Handle<Expression>) {
        self.atoms.clear();
        self.operands_of(handle);
        if matches!(self.class(handle), Class::Load(..) | Class::Lookup) {
            self.atoms.push(handle);
        }
        self.settle(Effect::None);
    }

    /// The operands are written here, and then something happens.
    fn anchor(&mut self, operands: &[Handle<Expression>], effect: Effect<'_>) {
        self.atoms.clear();
        for operand in operands {
            self.visit(*operand);
        }
        self.settle(effect);
    }

    /// A value is stored. What the pointer reads is evaluated before the value or after it.
    fn anchor_store(&mut self, pointer: Handle<Expression>, value: Handle<Expression>) {
        self.atoms.clear();
        self.visit(pointer);
        let indices = self.atoms.clone();
        self.visit(value);
        let calls: Vec<_> = self.atoms.iter().copied().filter(|atom| self.class(*atom) == Class::Call).collect();
        for index in indices {
            if calls.iter().any(|call| self.conflict(index, *call)) {
                self.force(index);
            }
        }
        let root = root(self.module, &self.function.expressions, pointer);
        self.settle(Effect::Store(root));
    }

    /// Collects the reads, calls and lookups of an expression in the order in which the text evaluates them.
    fn visit(&mut self, handle: Handle<Expression>) {
        let class = self.class(handle);
        if class == Class::Given || self.plan.is_named(handle) {
            return;
        }
        self.operands_of(handle);
        if matches!(class, Class::Load(..) | Class::Call | Class::Lookup) {
            self.atoms.push(handle);
            if let Some(left) = self.left.get_mut(handle.index()) {
                *left = left.saturating_sub(1);
            }
        }
    }

    fn operands_of(&mut self, handle: Handle<Expression>) {
        let expression = &self.function.expressions[handle];
        match (self.calls.get(handle.index()).copied().flatten(), expression) {
            (Some((_, arguments)), _) => arguments.iter().for_each(|argument| self.visit(*argument)),
            // The text has them in another order.
            (None, Expression::Select { condition, accept, reject }) => {
                [reject, accept, condition].into_iter().for_each(|operand| self.visit(*operand));
            }
            (None, expression) => for_each_operand(expression, |operand| self.visit(operand)),
        }
    }

    /// Names what the atoms, or the effect after them, would overtake.
    fn settle(&mut self, effect: Effect<'_>) {
        let atoms = std::mem::take(&mut self.atoms);
        let calls = atoms.iter().filter(|atom| self.class(**atom) == Class::Call).count();
        if calls > 0 && atoms.len() > MOST_ATOMS {
            for atom in &atoms {
                if self.class(*atom) == Class::Call {
                    self.force(*atom);
                }
            }
        } else if calls > 0 {
            self.keep_order(&atoms);
        }
        let pending = std::mem::take(&mut self.pending);
        let mut kept = Vec::with_capacity(pending.len());
        for one in pending {
            let left = self.left.get(one.index()).copied().unwrap_or(0);
            if left == 0 {
                continue;
            }
            let overtaken = self.style != Style::Full
                || self.is_overtaken(one, effect)
                || atoms.iter().any(|atom| *atom != one && self.conflict(one, *atom));
            if overtaken {
                self.force_largest(one);
            } else {
                kept.push(one);
            }
        }
        self.pending = kept;
        self.atoms = atoms;
    }

    /// Atoms of one statement that the text would evaluate in another order.
    fn keep_order(&mut self, atoms: &[Handle<Expression>]) {
        for (at, first) in atoms.iter().enumerate() {
            for second in atoms.iter().skip(at + 1) {
                if second.index() < first.index() && self.conflict(*first, *second) {
                    self.force(*second);
                }
            }
        }
    }

    fn force(&mut self, handle: Handle<Expression>) {
        if let Some(forced) = self.forced.get_mut(handle.index()) {
            *forced = true;
        }
    }

    /// Names everything that is pending from a place on.
    fn force_pending(&mut self, start: usize) {
        let pending: Vec<_> = self.pending.iter().skip(start).copied().collect();
        for one in pending {
            if self.left.get(one.index()).is_some_and(|left| *left > 0) {
                self.force_largest(one);
            }
        }
        self.pending.truncate(start);
    }

    /// Names the largest value with this in it that is already evaluated.
    fn force_largest(&mut self, handle: Handle<Expression>) {
        let mut largest = handle;
        let mut at = handle;
        while self.plan.uses.get(at.index()) == Some(&1) {
            let Some(user) = self.users.get(at.index()).copied().flatten() else { break };
            let evaluated = self.emitted.get(user.index()).copied().unwrap_or(false);
            if !evaluated || !self.plan.is_used(user) || self.plan.is_named(user) || self.style != Style::Full {
                break;
            }
            // A pointer has no name.
            if self.class(user) != Class::Pointer {
                largest = user;
            }
            at = user;
        }
        self.force(largest);
    }
}

/// Counts the operands of statements; those of calls with a result count with it.
fn count_in(block: &Block, uses: &mut [u32]) {
    for statement in block {
        if !matches!(statement, Statement::Call { result: Some(_), .. }) {
            operands(statement, |handle| {
                if let Some(place) = uses.get_mut(handle.index()) {
                    *place += 1;
                }
            });
        }
        blocks(statement).into_iter().for_each(|inner| count_in(inner, uses));
    }
}
