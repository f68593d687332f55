//! Writes the bodies of functions, with the parentheses that WGSL requires and no others (WGSL §8.17), in lines of at most
//! [`WIDTH`] columns where that is possible.

use super::levels::{Level, compared, fits, level_of};
use super::tree::{Block, BlockId, Body, Expr, Stmt, StmtKind};

/// The longest line.
pub(super) const WIDTH: usize = 110;
/// The blanks of one level.
pub(super) const INDENT: &str = "    ";

/// Writes a tree with the names of its locals.
pub(super) struct Printer<'b, 'm> {
    body: &'b Body<'m>,
    text: String,
    marks: Marks,
}

/// Places of a text, in ascending order, with the places of the source that they come from.
pub(super) type Marks = Vec<(usize, naga::Span)>;

/// The statements of a function's body, each on its line, and where each begins in the text.
pub(super) fn body(body: &Body<'_>) -> (String, Marks) {
    let mut printer = Printer { body, text: String::new(), marks: Marks::new() };
    printer.block(BlockId(0), 1);
    (printer.text, printer.marks)
}

/// An expression of the module behind the beginning of its declaration.
pub(super) fn expression(head: &str, expr: &Expr<'_>) -> String {
    let body = Body { blocks: Vec::new(), names: Vec::new() };
    let mut printer = Printer { body: &body, text: head.to_owned(), marks: Marks::new() };
    printer.wrapped(expr, 0, 1);
    printer.text
}

impl Printer<'_, '_> {
    fn block(&mut self, id: BlockId, indent: usize) {
        let Some(block) = self.body.blocks.get(id.0) else { return };
        for stmt in &block.statements {
            self.stmt(stmt, indent);
        }
        self.lines(&block.end, indent);
    }

    fn lines(&mut self, lines: &[String], indent: usize) {
        for line in lines {
            // An empty line is nothing at the beginning of a block.
            if !line.is_empty() {
                self.indent(indent);
            } else if self.text.is_empty() || self.text.ends_with("{\n") || self.text.ends_with("\n\n") {
                continue;
            }
            self.text.push_str(line);
            self.text.push('\n');
        }
    }

    fn indent(&mut self, indent: usize) {
        for _ in 0..indent {
            self.text.push_str(INDENT);
        }
    }

    fn line(&mut self, indent: usize, line: &str, behind: &[String]) {
        self.indent(indent);
        self.text.push_str(line);
        self.end_line(behind);
    }

    /// Ends a line with comments.
    fn end_line(&mut self, behind: &[String]) {
        for comment in behind {
            self.text.push_str("  ");
            self.text.push_str(comment);
        }
        self.text.push('\n');
    }

    fn is_empty(&self, id: BlockId) -> bool {
        let block = self.body.blocks.get(id.0);
        block.is_none_or(|block| {
            block.end.is_empty() && block.statements.iter().all(|stmt| matches!(stmt.kind, StmtKind::Empty))
        })
    }

    /// Ends the line that opens a block, and writes the block.
    fn inner(&mut self, id: BlockId, indent: usize) {
        let head: &[String] = self.body.blocks.get(id.0).map_or(&[], |block| block.head.as_slice());
        self.end_line(head);
        self.block(id, indent + 1);
    }

    fn stmt(&mut self, stmt: &Stmt<'_>, indent: usize) {
        self.lines(&stmt.above, indent);
        self.mark(stmt);
        match &stmt.kind {
            StmtKind::Empty => {}
            StmtKind::If { condition, accept, reject } => {
                self.headed(indent, "if ", condition);
                self.inner(*accept, indent);
                self.otherwise(*reject, indent);
                self.line(indent, "}", &stmt.behind);
            }
            StmtKind::Switch { selector, cases } => {
                self.headed(indent, "switch ", selector);
                self.text.push('\n');
                for (labels, body) in cases {
                    self.indent(indent + 1);
                    self.text.push_str(labels);
                    self.text.push_str(": {");
                    if self.is_empty(*body) {
                        self.text.push_str("}\n");
                        continue;
                    }
                    self.inner(*body, indent + 1);
                    self.line(indent + 1, "}", &[]);
                }
                self.line(indent, "}", &stmt.behind);
            }
            StmtKind::Loop { body, continuing, break_if } => {
                self.indent(indent);
                self.text.push_str("loop {");
                self.inner(*body, indent);
                if !self.is_empty(*continuing) || break_if.is_some() {
                    self.line(indent + 1, "continuing {", &[]);
                    self.block(*continuing, indent + 2);
                    if let Some(condition) = break_if {
                        self.indent(indent + 2);
                        self.text.push_str("break if ");
                        self.wrapped(condition, indent + 2, 1);
                        self.text.push_str(";\n");
                    }
                    self.line(indent + 1, "}", &[]);
                }
                self.line(indent, "}", &stmt.behind);
            }
            StmtKind::For { init: None, condition: Some(condition), step: None, body } => {
                self.headed(indent, "while ", condition);
                self.inner(*body, indent);
                self.line(indent, "}", &stmt.behind);
            }
            StmtKind::For { init, condition, step, body } => {
                self.indent(indent);
                self.text.push_str("for (");
                if let Some(init) = init {
                    self.counter(init);
                }
                self.text.push(';');
                if let Some(condition) = condition {
                    self.text.push(' ');
                    self.expr(condition);
                }
                self.text.push(';');
                if let Some(step) = step {
                    self.text.push(' ');
                    self.simple(step, indent);
                }
                self.text.push_str(") {");
                self.inner(*body, indent);
                self.line(indent, "}", &stmt.behind);
            }
            StmtKind::Block(body) => {
                self.indent(indent);
                self.text.push('{');
                self.inner(*body, indent);
                self.line(indent, "}", &stmt.behind);
            }
            kind => {
                self.indent(indent);
                self.simple(kind, indent);
                self.text.push(';');
                self.end_line(&stmt.behind);
            }
        }
    }

    /// The next line comes from the statement.
    fn mark(&mut self, stmt: &Stmt<'_>) {
        let spans = [stmt.declared, stmt.span];
        self.marks.extend(spans.into_iter().filter(naga::Span::is_defined).map(|span| (self.text.len(), span)));
    }

    /// The head of a statement with a block.
    fn headed(&mut self, indent: usize, word: &str, condition: &Expr<'_>) {
        self.indent(indent);
        self.text.push_str(word);
        self.wrapped(condition, indent, 2);
        self.text.push_str(" {");
    }

    /// The branches after an `if`, up to the last brace.
    fn otherwise(&mut self, mut reject: BlockId, indent: usize) {
        while let Some(block) = self.body.blocks.get(reject.0)
            && let Some(stmt) = only(block)
            && let StmtKind::If { condition, accept, reject: next } = &stmt.kind
        {
            self.mark(stmt);
            self.indent(indent);
            self.text.push_str("} else if ");
            self.wrapped(condition, indent, 2);
            self.text.push_str(" {");
            self.inner(*accept, indent);
            reject = *next;
        }
        if !self.is_empty(reject) {
            self.indent(indent);
            self.text.push_str("} else {");
            self.inner(reject, indent);
        }
    }

    /// The first part of a `for`. The number says whether the counter is signed.
    fn counter(&mut self, init: &StmtKind<'_>) {
        match init {
            StmtKind::Var { name, value: Some(value @ Expr::Number(number)), .. } if number.suffix != "h" => {
                self.text.push_str("var ");
                self.name(name.0);
                self.text.push_str(" = ");
                self.expr(value);
            }
            init => self.simple(init, 0),
        }
    }

    fn name(&mut self, name: usize) {
        self.text.push_str(self.body.names.get(name).map_or("", String::as_str));
    }

    /// A statement without a block, and without its semicolon.
    fn simple(&mut self, kind: &StmtKind<'_>, indent: usize) {
        match kind {
            StmtKind::Let { name, value } => {
                self.text.push_str("let ");
                self.name(name.0);
                self.text.push_str(" = ");
                self.wrapped(value, indent, 1);
            }
            StmtKind::Var { name, ty, value } => {
                self.text.push_str("var ");
                self.name(name.0);
                self.text.push_str(": ");
                self.text.push_str(ty);
                if let Some(value) = value {
                    self.text.push_str(" = ");
                    self.wrapped(value, indent, 1);
                }
            }
            StmtKind::Assign { target, op, value, .. } => {
                self.expr(target);
                self.text.push(' ');
                self.text.push_str(op.unwrap_or_default());
                self.text.push_str("= ");
                self.wrapped(value, indent, 1);
            }
            StmtKind::Step { target, op } => {
                self.expr(target);
                self.text.push_str(op);
            }
            StmtKind::Call(call) => self.wrapped(call, indent, 1),
            StmtKind::Word(word) => self.text.push_str(word),
            StmtKind::Return(Some(value)) => {
                self.text.push_str("return ");
                self.wrapped(value, indent, 1);
            }
            StmtKind::Return(None) => self.text.push_str("return"),
            _ => {}
        }
    }

    /// The columns of the current line.
    fn column(&self) -> usize {
        self.text.len() - self.text.rfind('\n').map_or(0, |at| at + 1)
    }

    /// An expression, in several lines if it does not fit into one with `tail` columns behind it.
    fn wrapped(&mut self, expr: &Expr<'_>, indent: usize, tail: usize) {
        let start = self.text.len();
        self.expr(expr);
        if self.column() + tail <= WIDTH {
            return;
        }
        match expr {
            Expr::Call(name, arguments) if !arguments.is_empty() => {
                self.text.truncate(start);
                self.text.push_str(name);
                self.text.push_str("(\n");
                let compared = compared(arguments);
                for argument in arguments {
                    self.indent(indent + 1);
                    self.parenthesized(compared && argument.level() < Level::Sum, |printer| {
                        printer.wrapped(argument, indent + 1, 1);
                    });
                    self.text.push_str(",\n");
                }
                self.indent(indent);
                self.text.push(')');
            }
            Expr::Binary(op, left, right) => {
                self.text.truncate(start);
                self.chain(op, left, right, indent, tail);
            }
            Expr::Member(base, member) if matches!(**base, Expr::Call(..)) => {
                self.text.truncate(start);
                self.wrapped(base, indent, tail + 1 + member.len());
                self.text.push('.');
                self.text.push_str(member);
            }
            _ => {}
        }
    }

    /// A chain of operators of one level, with a line for each operand.
    fn chain(&mut self, op: &str, left: &Expr<'_>, right: &Expr<'_>, indent: usize, tail: usize) {
        match left {
            Expr::Binary(inner, first, second) if level_of(inner) == level_of(op) && fits(op, left, true) => {
                self.chain(inner, first, second, indent, 0);
            }
            left => self.parenthesized(!fits(op, left, true), |printer| printer.wrapped(left, indent + 1, 1)),
        }
        self.text.push('\n');
        self.indent(indent + 1);
        self.text.push_str(op);
        self.text.push(' ');
        self.parenthesized(!fits(op, right, false), |printer| printer.wrapped(right, indent + 1, tail + 1));
    }

    fn parenthesized(&mut self, needed: bool, write: impl FnOnce(&mut Self)) {
        if needed {
            self.text.push('(');
        }
        write(self);
        if needed {
            self.text.push(')');
        }
    }

    fn expr(&mut self, expr: &Expr<'_>) {
        match expr {
            Expr::Number(number) => {
                self.text.push_str(&number.digits);
                if number.suffixed {
                    self.text.push_str(number.suffix);
                }
            }
            Expr::Leaf(leaf) | Expr::Constant(leaf) => self.text.push_str(leaf),
            Expr::Local(name) => self.name(name.0),
            Expr::Call(name, arguments) => {
                self.text.push_str(name);
                self.text.push('(');
                let compared = compared(arguments);
                for (at, argument) in arguments.iter().enumerate() {
                    if at > 0 {
                        self.text.push_str(", ");
                    }
                    self.parenthesized(compared && argument.level() < Level::Sum, |printer| printer.expr(argument));
                }
                self.text.push(')');
            }
            Expr::Index(base, index) => {
                self.parenthesized(!base.is_postfix(), |printer| printer.expr(base));
                self.text.push('[');
                self.expr(index);
                self.text.push(']');
            }
            Expr::Member(base, member) => {
                self.parenthesized(!base.is_postfix(), |printer| printer.expr(base));
                self.text.push('.');
                self.text.push_str(member);
            }
            Expr::Unary(op, operand) => {
                self.text.push_str(op);
                // `- -a` is not `--a`, and `&&` is an operator.
                let bare = operand.level() == Level::Unary && !operand.begins_with(op);
                self.parenthesized(!bare, |printer| printer.expr(operand));
            }
            Expr::Binary(op, left, right) => {
                self.parenthesized(!fits(op, left, true), |printer| printer.expr(left));
                self.text.push(' ');
                self.text.push_str(op);
                self.text.push(' ');
                self.parenthesized(!fits(op, right, false), |printer| printer.expr(right));
            }
        }
    }
}

/// The statement of a block that has one, and no comments.
fn only<'b, 'm>(block: &'b Block<'m>) -> Option<&'b Stmt<'m>> {
    let is_bare = |stmt: &Stmt<'_>| stmt.above.is_empty() && stmt.behind.is_empty();
    if !block.head.is_empty() || !block.end.is_empty() || !block.statements.iter().all(is_bare) {
        return None;
    }
    let mut real = block.statements.iter().filter(|stmt| !matches!(stmt.kind, StmtKind::Empty));
    real.next().filter(|_| real.next().is_none())
}
