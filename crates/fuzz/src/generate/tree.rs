//! Generated programs as trees, so that they can be changed and made smaller: [`Expr`] and [`Stmt`].
//!
//! *In:* patterns with places for parts: `(@ + @)`, `if (@) {$}`. *Out:* text. *Holds:* an expression knows its type; a statement that
//! assigns knows what is visible there.

use super::types::Ty;

/// The ways in which an expression may be changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Use {
    /// It is a value: another of its type may be in its place.
    Value,
    /// It is a literal number.
    Literal,
    /// It is written to, or has to be constant.
    Fixed,
}

/// An expression.
#[derive(Clone, Debug)]
pub struct Expr {
    /// Its type.
    pub ty: Ty,
    /// How it may be changed.
    pub usage: Use,
    /// The texts around its operands: one more than these.
    texts: Vec<String>,
    /// Its operands.
    pub operands: Vec<Expr>,
}

impl Expr {
    /// An expression by a pattern, in which `@` are the operands.
    pub fn new(ty: Ty, pattern: &str, operands: Vec<Self>) -> Self {
        let texts: Vec<String> = pattern.split('@').map(str::to_owned).collect();
        debug_assert_eq!(texts.len(), operands.len() + 1, "{pattern}");
        Self { ty, usage: Use::Value, texts, operands }
    }

    /// The operator between its two operands, in parentheses.
    pub(super) fn operator(&self) -> Option<&str> {
        match self.texts.as_slice() {
            [first, operator, last] if first == "(" && last == ")" => Some(operator.trim()),
            _ => None,
        }
    }

    /// The texts around its operands.
    pub(super) fn texts(&self) -> &[String] {
        &self.texts
    }

    /// Takes the parentheses around it away.
    pub(super) fn bared(&mut self) {
        let has_parentheses = self.texts.first().is_some_and(|text| text.starts_with('('))
            && self.texts.last().is_some_and(|text| text.ends_with(')'));
        if has_parentheses {
            self.texts.first_mut().into_iter().for_each(|text| *text = text.split_off(1));
            self.texts.last_mut().into_iter().for_each(|text| text.truncate(text.len() - 1));
        }
    }

    /// Gives the overload that it calls a name of its own.
    pub(super) fn renamed(&mut self) {
        self.texts.iter_mut().for_each(|text| *text = own_name(text));
    }

    /// Whether a part of it writes something, or calls a function that may.
    pub(super) fn has_effects(&self) -> bool {
        let writes = |text: &String| {
            ["++", "--", "(f", " = ", "+= ", "modf(", "frexp(", "Carry(", "Borrow(", "Extended("]
                .iter()
                .any(|word| text.contains(word))
                || text.starts_with('f') && text.as_bytes().get(1).is_some_and(u8::is_ascii_digit)
        };
        self.texts.iter().any(writes) || self.operands.iter().any(Self::has_effects)
    }

    /// An expression without operands.
    pub fn leaf(ty: Ty, text: impl Into<String>) -> Self {
        Self { ty, usage: Use::Value, texts: vec![text.into()], operands: Vec::new() }
    }

    /// This expression for another use.
    #[must_use]
    pub fn used(self, usage: Use) -> Self {
        Self { usage, ..self }
    }

    /// Its text.
    pub fn text(&self) -> String {
        let mut text = String::new();
        self.write(&mut text);
        text
    }

    fn write(&self, text: &mut String) {
        let mut operands = self.operands.iter();
        for piece in &self.texts {
            text.push_str(piece);
            if let Some(operand) = operands.next() {
                operand.write(text);
            }
        }
    }
}

/// A variable that can be named.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Variable {
    /// Its name.
    pub name: String,
    /// Its type.
    pub ty: Ty,
    /// Whether it may be assigned to.
    pub writable: bool,
    /// Whether it is a constant expression.
    pub constant: bool,
    /// Whether it is a local of a function.
    pub local: bool,
    /// The number of values from 0 that it may have, of a loop's variable.
    pub below: Option<u32>,
}

/// The role of a statement, for what changes programs.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Role {
    /// Anything else.
    #[default]
    Other,
    /// `place = value;` with these locals.
    Assignment(Vec<Variable>),
    /// It declares a name that statements behind it use.
    Declaration,
    /// A line for the preprocessor.
    Directive,
    /// Statements under `#if` and `#else`, and whether the first are taken.
    Conditional(bool),
    /// It gives an output of the stage its value.
    Output,
}

/// A statement, a declaration or a function.
#[derive(Clone, Debug)]
pub struct Stmt {
    /// Its role.
    pub role: Role,
    /// The texts around its parts: one more than these.
    texts: Vec<String>,
    /// Its parts, in order.
    pub parts: Vec<StmtPart>,
}

/// A part of a statement.
#[derive(Clone, Debug)]
pub enum StmtPart {
    /// An expression.
    Expr(Expr),
    /// Statements, on lines of their own.
    Body(Vec<Stmt>),
}

impl Stmt {
    /// A statement by a pattern, in which `@` are expressions and `$` are bodies.
    pub fn new(pattern: &str, exprs: Vec<Expr>, bodies: Vec<Vec<Self>>) -> Self {
        let (mut exprs, mut bodies) = (exprs.into_iter(), bodies.into_iter());
        let (mut texts, mut parts) = (vec![String::new()], Vec::new());
        for letter in pattern.chars() {
            let part = match letter {
                '@' => exprs.next().map(StmtPart::Expr),
                '$' => bodies.next().map(StmtPart::Body),
                _ => None,
            };
            match part {
                Some(part) => {
                    parts.push(part);
                    texts.push(String::new());
                }
                None => texts.last_mut().into_iter().for_each(|text| text.push(letter)),
            }
        }
        Self { role: Role::Other, texts, parts }
    }

    /// A statement without parts.
    pub fn text_only(text: impl Into<String>) -> Self {
        Self { role: Role::Other, texts: vec![text.into()], parts: Vec::new() }
    }

    /// Gives the overload that it defines or calls a name of its own.
    pub(super) fn renamed(&mut self) {
        self.texts.iter_mut().for_each(|text| *text = own_name(text));
    }

    /// Makes a constant a variable.
    pub(super) fn varied(&mut self) {
        if let Some(first) = self.texts.first_mut()
            && let Some(rest) = first.strip_prefix("const ")
        {
            *first = rest.to_owned();
        }
    }

    /// The texts around its parts.
    pub(super) fn texts(&self) -> &[String] {
        &self.texts
    }

    /// This statement in another role.
    #[must_use]
    pub fn with(self, role: Role) -> Self {
        Self { role, ..self }
    }

    /// Its text, without the end of its last line.
    pub fn text(&self) -> String {
        let mut text = String::new();
        self.write(0, &mut text);
        text
    }

    fn write(&self, indent: usize, text: &mut String) {
        let margin = "    ".repeat(indent);
        text.push_str(&margin);
        let mut parts = self.parts.iter();
        for piece in &self.texts {
            text.push_str(piece);
            match parts.next() {
                Some(StmtPart::Expr(expr)) => expr.write(text),
                Some(StmtPart::Body(body)) => {
                    text.push('\n');
                    write_all(body, indent + 1, text);
                    text.push_str(&margin);
                }
                None => {}
            }
        }
    }
}

/// The text of statements, each with the end of its line.
pub fn text_of(statements: &[Stmt]) -> String {
    let mut text = String::new();
    write_all(statements, 0, &mut text);
    text
}

fn write_all(statements: &[Stmt], indent: usize, text: &mut String) {
    for statement in statements {
        statement.write(indent, text);
        text.push('\n');
    }
}

/// A text in which blanks between a name and `(` are a part of the name.
fn own_name(text: &str) -> String {
    match text.split_once(" (") {
        Some((head, tail)) if head.trim_end().ends_with(|letter: char| letter.is_ascii_digit()) => {
            let name = head.trim_end();
            format!("{name}_{}({tail}", head.len() - name.len() + 1)
        }
        _ => text.to_owned(),
    }
}
