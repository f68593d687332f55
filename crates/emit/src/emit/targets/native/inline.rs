//! Removes unneeded names from emitted text: a load that needs no name is written where it is used.
//!
//! naga's text writers name every load (`let _e7 = color;`), because a statement between the load and its use might
//! change the value. Usually none does. Superfluous once naga names only loads that a store may overtake.
//!
//! *In:* a validated module. *Out:* the same module without the `Emit`s of such loads. The writers spell out an
//! expression without an `Emit` at its use. The result is only for the text writers, since naga's validator requires
//! that every expression is emitted.
//!
//! *Holds:* a load is removed only if all of its uses are evaluated in the same run of `Emit`s or by the statement
//! directly after that run, and that statement evaluates its operands before it does anything else.

use crate::emit::statements::{blocks, operands};
use crate::lower::for_each_operand;
use naga::{Block, Expression, Function, Handle, Range, Statement};

/// Removes the `Emit`s of loads that need no name.
pub(super) fn inline_loads(module: &mut naga::Module) {
    for (_, function) in module.functions.iter_mut() {
        inline_in(function);
    }
    for entry in &mut module.entry_points {
        inline_in(&mut entry.function);
    }
}

fn inline_in(function: &mut Function) {
    let mut uses = Uses::of(function);
    let mut body = std::mem::take(&mut function.body);
    uses.block(function, &mut body);
    function.body = body;
}

/// The uses of an expression.
#[derive(Clone, Copy, Debug, Default)]
struct Use {
    count: u32,
    /// The expression that uses it, if the user is an expression.
    user: Option<Handle<Expression>>,
}

struct Uses {
    all: Vec<Use>,
    /// For each expression, the number of the run of `Emit`s that evaluates it, counted from 1.
    run: Vec<u32>,
    runs: u32,
}

impl Uses {
    fn of(function: &Function) -> Self {
        let len = function.expressions.len();
        let mut uses = Self { all: vec![Use::default(); len], run: vec![0; len], runs: 0 };
        for (handle, expression) in function.expressions.iter() {
            for_each_operand(expression, |operand| uses.count(operand, Some(handle)));
        }
        uses.statements(&function.body);
        uses
    }

    fn count(&mut self, handle: Handle<Expression>, user: Option<Handle<Expression>>) {
        if let Some(known) = self.all.get_mut(handle.index()) {
            known.count += 1;
            known.user = user;
        }
    }

    /// Counts the uses by statements, except operands of a statement directly after a run, which `block` handles.
    fn statements(&mut self, block: &Block) {
        for statement in block {
            operands(statement, |handle| self.count(handle, None));
            for inner in blocks(statement) {
                self.statements(inner);
            }
        }
    }

    fn block(&mut self, function: &Function, block: &mut Block) {
        let statements: Vec<(Statement, naga::Span)> = std::mem::take(block).span_into_iter().collect();
        let mut kept = Block::with_capacity(statements.len());
        let mut run: Vec<(Range<Expression>, naga::Span)> = Vec::new();
        for (mut statement, span) in statements {
            if let Statement::Emit(range) = statement {
                run.push((range, span));
                continue;
            }
            self.write_run(function, &mut run, Some(&statement), &mut kept);
            for inner in blocks_mut(&mut statement) {
                self.block(function, inner);
            }
            kept.push(statement, span);
        }
        self.write_run(function, &mut run, None, &mut kept);
        *block = kept;
    }

    /// Writes the `Emit`s of a run without the loads that need no name.
    fn write_run(
        &mut self,
        function: &Function,
        run: &mut Vec<(Range<Expression>, naga::Span)>,
        behind: Option<&Statement>,
        kept: &mut Block,
    ) {
        self.runs += 1;
        for (range, _) in run.iter() {
            for handle in range.clone() {
                if let Some(place) = self.run.get_mut(handle.index()) {
                    *place = self.runs;
                }
            }
        }
        let mut by_statement = Vec::new();
        // The condition at the end of a loop is evaluated there, not before the loop.
        if let Some(statement) = behind.filter(|statement| !matches!(statement, Statement::Loop { .. })) {
            operands(statement, |handle| by_statement.push(handle));
        }
        for (range, span) in run.drain(..) {
            let mut open: Option<(Handle<Expression>, Handle<Expression>)> = None;
            for handle in range {
                if self.needs_no_name(function, handle, &by_statement) {
                    push_range(kept, open.take(), span);
                } else {
                    open = Some((open.map_or(handle, |(first, _)| first), handle));
                }
            }
            push_range(kept, open, span);
        }
    }

    /// Whether a load can be written at its use.
    fn needs_no_name(&self, function: &Function, handle: Handle<Expression>, by: &[Handle<Expression>]) -> bool {
        let is_load = matches!(function.expressions[handle], Expression::Load { .. });
        is_load && !function.named_expressions.contains_key(&handle) && self.is_used_here(function, handle, by)
    }

    /// Whether the only use of the expression is in its own run, or in the statement after it.
    fn is_used_here(&self, function: &Function, mut handle: Handle<Expression>, by: &[Handle<Expression>]) -> bool {
        let run = self.run.get(handle.index()).copied();
        loop {
            let Some(known) = self.all.get(handle.index()) else { return false };
            if known.count != 1 {
                return false;
            }
            let Some(user) = known.user else { return by.contains(&handle) };
            if self.run.get(user.index()).copied() != run {
                return false;
            }
            if self.is_written_at_once(function, user) {
                return true;
            }
            handle = user;
        }
    }

    /// Whether the writers name the expression where it is emitted.
    fn is_written_at_once(&self, function: &Function, handle: Handle<Expression>) -> bool {
        let count = self.all.get(handle.index()).map_or(0, |known| known.count);
        match function.expressions[handle] {
            _ if function.named_expressions.contains_key(&handle) => true,
            Expression::ImageSample { .. } | Expression::ImageLoad { .. } | Expression::ImageQuery { .. } => true,
            Expression::Derivative { .. } => true,
            // These may be removed themselves.
            Expression::Load { .. } | Expression::Access { .. } | Expression::AccessIndex { .. } => false,
            _ => count >= 2,
        }
    }
}

fn push_range(block: &mut Block, open: Option<(Handle<Expression>, Handle<Expression>)>, span: naga::Span) {
    if let Some((first, last)) = open {
        block.push(Statement::Emit(Range::new_from_bounds(first, last)), span);
    }
}

fn blocks_mut(statement: &mut Statement) -> Vec<&mut Block> {
    match statement {
        Statement::Block(block) => vec![block],
        Statement::If { accept, reject, .. } => vec![accept, reject],
        Statement::Switch { cases, .. } => cases.iter_mut().map(|case| &mut case.body).collect(),
        Statement::Loop { body, continuing, .. } => vec![body, continuing],
        _ => Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::inline_loads;
    use naga::valid::{Capabilities, ValidationFlags, Validator};

    /// The text of a module after removing loads.
    fn written(text: &str) -> String {
        let mut module = naga::front::wgsl::parse_str(text).expect("the test's text is WGSL");
        let info = Validator::new(ValidationFlags::all(), Capabilities::all()).validate(&module).expect("valid");
        inline_loads(&mut module);
        naga::back::wgsl::write_string(&module, &info, naga::back::wgsl::WriterFlags::empty()).expect("written")
    }

    #[test]
    fn a_load_with_one_use_behind_it_needs_no_name() {
        let text = written("var<private> a: f32; var<private> b: f32; fn f() { b = a * 2.0; }");
        assert!(text.contains("b = (a * 2f);"), "{text}");
    }

    #[test]
    fn a_load_in_front_of_a_call_keeps_its_name() {
        let text = written(
            "var<private> a: f32; fn g() -> f32 { a = 1.0; return a; } fn f() -> f32 { let x = a; return x + g(); }",
        );
        let load = text.find("= a;").expect("the load has a name");
        assert!(load < text.rfind("g()").expect("the call is there"), "{text}");
    }

    #[test]
    fn a_load_in_front_of_a_store_keeps_its_name() {
        let text = written("var<private> a: f32; fn f() -> f32 { let x = a; a = 2.0; return x; }");
        assert!(text.contains("let x = a;"), "{text}");
    }

    #[test]
    fn a_swap_is_still_a_swap() {
        let text = written("var<private> a: f32; var<private> b: f32; fn f() { let x = a; a = b; b = x; }");
        assert!(text.contains("let x = a;") && text.contains("a = b;") && text.contains("b = x;"), "{text}");
    }
}
