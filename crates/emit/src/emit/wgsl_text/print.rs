//! Writes the bodies of functions, with the parentheses that WGSL requires and no others (WGSL §8.17).

use super::tree::{Expr, Stmt};

/// How tightly an expression binds; a larger number binds more tightly.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Level {
    /// `&&`, `||`, and the binary bit operators: they do not mix.
    Logical,
    Relation,
    Shift,
    Sum,
    Product,
    Unary,
}

fn level_of(op: &str) -> Level {
    match op {
        "*" | "/" | "%" => Level::Product,
        "+" | "-" => Level::Sum,
        "<<" | ">>" => Level::Shift,
        "==" | "!=" | "<" | ">" | "<=" | ">=" => Level::Relation,
        _ => Level::Logical,
    }
}

impl Expr {
    fn level(&self) -> Level {
        match self {
            Self::Binary(op, ..) => level_of(op),
            _ => Level::Unary,
        }
    }

    /// Its text.
    pub(super) fn text(&self) -> String {
        let mut text = String::new();
        self.write(&mut text);
        text
    }

    fn write(&self, text: &mut String) {
        match self {
            Self::Leaf(leaf) => text.push_str(leaf),
            Self::Call(name, arguments) => {
                text.push_str(name);
                text.push('(');
                text.push_str(&arguments_text(arguments));
                text.push(')');
            }
            Self::Index(base, index) => {
                base.write_if(base.is_postfix(), text);
                text.push('[');
                index.write(text);
                text.push(']');
            }
            Self::Member(base, member) => {
                base.write_if(base.is_postfix(), text);
                text.push('.');
                text.push_str(member);
            }
            Self::Unary(op, operand) => {
                text.push_str(op);
                // `- -a` is not `--a`, and `&&` is an operator.
                let twice = matches!(&**operand, Self::Unary(inner, _) if inner == op);
                operand.write_if(operand.level() == Level::Unary && !twice, text);
            }
            Self::Binary(op, left, right) => {
                left.write_if(fits(op, left, true), text);
                text.push(' ');
                text.push_str(op);
                text.push(' ');
                right.write_if(fits(op, right, false), text);
            }
        }
    }

    /// Whether `.x` or `[i]` can follow without parentheses.
    fn is_postfix(&self) -> bool {
        !matches!(self, Self::Unary(..) | Self::Binary(..))
    }

    /// Writes it bare, or in parentheses.
    fn write_if(&self, bare: bool, text: &mut String) {
        if !bare {
            text.push('(');
        }
        self.write(text);
        if !bare {
            text.push(')');
        }
    }
}

/// Whether an operand of a binary operator needs no parentheses.
fn fits(op: &str, operand: &Expr, is_left: bool) -> bool {
    let level = operand.level();
    match level_of(op) {
        Level::Product => level >= if is_left { Level::Product } else { Level::Unary },
        Level::Sum => level >= if is_left { Level::Sum } else { Level::Product },
        Level::Shift => level == Level::Unary,
        Level::Relation => level >= Level::Sum,
        Level::Logical | Level::Unary => {
            let chain = is_left && matches!(operand, Expr::Binary(inner, ..) if *inner == op);
            match op {
                "&&" | "||" => chain || level >= Level::Relation,
                _ => chain || level == Level::Unary,
            }
        }
    }
}

/// The arguments of a call. `f(a < b, c > d)` would be a name with parameters, so comparisons then keep parentheses.
fn arguments_text(arguments: &[Expr]) -> String {
    let texts: Vec<String> = arguments.iter().map(Expr::text).collect();
    let opens = texts.iter().any(|text| text.contains(" <"));
    let closes = texts.iter().any(|text| text.contains(" >"));
    let wrapped = arguments.iter().zip(texts).map(|(argument, text)| {
        let compares = argument.level() < Level::Sum && (text.contains(" <") || text.contains(" >"));
        if opens && closes && compares { format!("({text})") } else { text }
    });
    wrapped.collect::<Vec<_>>().join(", ")
}

/// Writes the statements of a block.
pub(super) fn block(statements: &[Stmt], indent: usize, text: &mut String) {
    statements.iter().for_each(|one| statement(one, indent, text));
}

fn line(indent: usize, line: &str, text: &mut String) {
    for _ in 0..indent {
        text.push_str("    ");
    }
    text.push_str(line);
    text.push('\n');
}

fn statement(stmt: &Stmt, indent: usize, text: &mut String) {
    let inner = indent + 1;
    match stmt {
        Stmt::If { condition, accept, reject } => {
            line(indent, &format!("if {} {{", condition.text()), text);
            block(accept, inner, text);
            otherwise(reject, indent, text);
            line(indent, "}", text);
        }
        Stmt::Switch { selector, cases } => {
            line(indent, &format!("switch {} {{", selector.text()), text);
            for (labels, body) in cases {
                line(inner, &format!("{labels}: {{"), text);
                block(body, inner + 1, text);
                line(inner, "}", text);
            }
            line(indent, "}", text);
        }
        Stmt::Loop { body, continuing, break_if } => {
            line(indent, "loop {", text);
            block(body, inner, text);
            if !continuing.is_empty() || break_if.is_some() {
                line(inner, "continuing {", text);
                block(continuing, inner + 1, text);
                if let Some(condition) = break_if {
                    line(inner + 1, &format!("break if {};", condition.text()), text);
                }
                line(inner, "}", text);
            }
            line(indent, "}", text);
        }
        Stmt::For { init, condition, step, body } => {
            let init = init.as_ref().map_or(String::new(), |init| simple(init));
            let condition = condition.as_ref().map_or(String::new(), |condition| format!(" {}", condition.text()));
            let step = step.as_ref().map_or(String::new(), |step| format!(" {}", simple(step)));
            line(indent, &format!("for ({init};{condition};{step}) {{"), text);
            block(body, inner, text);
            line(indent, "}", text);
        }
        Stmt::While { condition, body } => {
            line(indent, &format!("while {} {{", condition.text()), text);
            block(body, inner, text);
            line(indent, "}", text);
        }
        Stmt::Block(body) => {
            line(indent, "{", text);
            block(body, inner, text);
            line(indent, "}", text);
        }
        _ => line(indent, &format!("{};", simple(stmt)), text),
    }
}

/// The branches after an `if`, up to the last brace.
fn otherwise(mut reject: &[Stmt], indent: usize, text: &mut String) {
    while let [Stmt::If { condition, accept, reject: next }] = reject {
        line(indent, &format!("}} else if {} {{", condition.text()), text);
        block(accept, indent + 1, text);
        reject = next;
    }
    if !reject.is_empty() {
        line(indent, "} else {", text);
        block(reject, indent + 1, text);
    }
}

/// A statement without a block, and without its semicolon.
fn simple(stmt: &Stmt) -> String {
    match stmt {
        Stmt::Let { name, value } => format!("let {name} = {}", value.text()),
        Stmt::Var { name, ty, value: Some(value) } => format!("var {name}: {ty} = {}", value.text()),
        Stmt::Var { name, ty, value: None } => format!("var {name}: {ty}"),
        Stmt::Assign { target, op, value } => {
            format!("{} {}= {}", target.text(), op.unwrap_or_default(), value.text())
        }
        Stmt::Step { target, op } => format!("{}{op}", target.text()),
        Stmt::Call(call) => call.text(),
        Stmt::Word(word) => (*word).to_owned(),
        Stmt::Return(Some(value)) => format!("return {}", value.text()),
        Stmt::Return(None) => "return".to_owned(),
        // These have blocks.
        Stmt::If { .. } | Stmt::Switch { .. } | Stmt::Loop { .. } | Stmt::For { .. } => String::new(),
        Stmt::While { .. } | Stmt::Block(_) => String::new(),
    }
}
