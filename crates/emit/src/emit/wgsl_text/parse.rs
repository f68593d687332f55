//! Reads the bodies of functions as naga writes them.
//!
//! *In:* the text between the braces of a function. *Out:* its tree; `None` for anything that naga does not write, whose
//! text then stays as it is.

use super::tree::{Block, Expr, Stmt};

/// A token, and whether it follows the one before without a blank.
#[derive(Clone, Copy, Debug)]
struct Token<'t> {
    text: &'t str,
    joined: bool,
}

/// Reads a body.
pub(super) fn body(text: &str) -> Option<Block> {
    let mut parser = Parser { tokens: tokens(text)?, at: 0 };
    let mut block = Vec::new();
    while parser.at < parser.tokens.len() {
        block.push(parser.statement()?);
    }
    Some(block)
}

/// The tokens of a text. `<` and `>` are always tokens of their own.
fn tokens(text: &str) -> Option<Vec<Token<'_>>> {
    const PAIRS: [&str; 5] = ["&&", "||", "==", "!=", "->"];
    let bytes = text.as_bytes();
    let mut tokens = Vec::new();
    let (mut at, mut joined) = (0, false);
    while let Some(&byte) = bytes.get(at) {
        if byte.is_ascii_whitespace() {
            (at, joined) = (at + 1, false);
            continue;
        }
        let rest = text.get(at..)?;
        let len = if byte.is_ascii_digit() {
            number(rest)
        } else if byte.is_ascii_alphabetic() || byte == b'_' {
            rest.bytes().take_while(|byte| byte.is_ascii_alphanumeric() || *byte == b'_').count()
        } else if PAIRS.iter().any(|pair| rest.starts_with(pair)) {
            2
        } else if byte.is_ascii_punctuation() {
            1
        } else {
            return None;
        };
        tokens.push(Token { text: rest.get(..len)?, joined });
        (at, joined) = (at + len, true);
    }
    Some(tokens)
}

/// The length of a number with its suffix: `1f`, `0.5f`, `1e-5f`, `0x1p3f`.
fn number(text: &str) -> usize {
    let bytes = text.as_bytes();
    let mut at = 0;
    while let Some(&byte) = bytes.get(at) {
        let exponent = at > 0 && matches!(bytes.get(at - 1), Some(b'e' | b'E' | b'p' | b'P'));
        let hexadecimal = text.starts_with("0x") && matches!(bytes.get(at - 1), Some(b'e' | b'E'));
        let sign = matches!(byte, b'+' | b'-') && exponent && !hexadecimal;
        if !(byte.is_ascii_alphanumeric() || byte == b'.' || sign) {
            break;
        }
        at += 1;
    }
    at
}

struct Parser<'t> {
    tokens: Vec<Token<'t>>,
    at: usize,
}

/// The binary operators by precedence, from the loosest. naga puts parentheses around each, so that this order is never
/// asked for; the text of people would be read right, too.
const LEVELS: [&[&str]; 8] =
    [&["||"], &["&&"], &["|"], &["^"], &["&"], &["==", "!=", "<", ">", "<=", ">="], &["<<", ">>"], &["+", "-"]];
const PRODUCTS: &[&str] = &["*", "/", "%"];

impl<'t> Parser<'t> {
    fn peek(&self) -> &'t str {
        self.tokens.get(self.at).map_or("", |token| token.text)
    }

    fn next(&mut self) -> Option<&'t str> {
        let token = self.tokens.get(self.at)?;
        self.at += 1;
        Some(token.text)
    }

    fn eat(&mut self, text: &str) -> bool {
        let found = self.peek() == text;
        self.at += usize::from(found);
        found
    }

    fn expect(&mut self, text: &str) -> Option<()> {
        self.eat(text).then_some(())
    }

    fn is_joined(&self, offset: usize) -> bool {
        self.tokens.get(self.at + offset).is_some_and(|token| token.joined)
    }

    fn word(&mut self) -> Option<&'t str> {
        self.next().filter(|text| text.starts_with(|first: char| first.is_ascii_alphabetic() || first == '_'))
    }

    fn block(&mut self) -> Option<Block> {
        self.expect("{")?;
        let mut block = Vec::new();
        while !self.eat("}") {
            block.push(self.statement()?);
        }
        Some(block)
    }

    fn statement(&mut self) -> Option<Stmt> {
        match self.peek() {
            "let" => self.let_statement(),
            "var" => self.var_statement(),
            "if" => self.if_statement(),
            "switch" => self.switch_statement(),
            "loop" => self.loop_statement(),
            "{" => self.block().map(Stmt::Block),
            "return" => {
                self.at += 1;
                let value = if self.peek() == ";" { None } else { Some(self.expr()?) };
                self.expect(";")?;
                Some(Stmt::Return(value))
            }
            "break" => self.lone("break"),
            "continue" => self.lone("continue"),
            "discard" => self.lone("discard"),
            _ => self.simple_statement(),
        }
    }

    fn lone(&mut self, word: &'static str) -> Option<Stmt> {
        self.at += 1;
        self.expect(";")?;
        Some(Stmt::Word(word))
    }

    fn let_statement(&mut self) -> Option<Stmt> {
        self.at += 1;
        let name = self.word()?.to_owned();
        self.expect("=")?;
        let value = self.expr()?;
        self.expect(";")?;
        Some(Stmt::Let { name, value })
    }

    fn var_statement(&mut self) -> Option<Stmt> {
        self.at += 1;
        let name = self.word()?.to_owned();
        self.expect(":")?;
        let ty = self.type_name()?;
        let value = if self.eat("=") { Some(self.expr()?) } else { None };
        self.expect(";")?;
        Some(Stmt::Var { name, ty, value })
    }

    fn if_statement(&mut self) -> Option<Stmt> {
        self.at += 1;
        let condition = self.expr()?;
        let accept = self.block()?;
        let reject = if self.eat("else") {
            if self.peek() == "if" { vec![self.if_statement()?] } else { self.block()? }
        } else {
            Vec::new()
        };
        Some(Stmt::If { condition, accept, reject })
    }

    fn switch_statement(&mut self) -> Option<Stmt> {
        self.at += 1;
        let selector = self.expr()?;
        self.expect("{")?;
        let mut cases = Vec::new();
        while !self.eat("}") {
            let mut labels = String::new();
            while self.peek() != "{" {
                match self.next()? {
                    ":" => {}
                    "," => labels.push_str(", "),
                    "case" => labels.push_str("case "),
                    word => labels.push_str(word),
                }
            }
            cases.push((labels, self.block()?));
        }
        Some(Stmt::Switch { selector, cases })
    }

    fn loop_statement(&mut self) -> Option<Stmt> {
        self.at += 1;
        self.expect("{")?;
        let (mut body, mut continuing, mut break_if) = (Vec::new(), Vec::new(), None);
        while !self.eat("}") {
            if !self.eat("continuing") {
                body.push(self.statement()?);
                continue;
            }
            self.expect("{")?;
            while !self.eat("}") {
                if self.peek() == "break" && self.tokens.get(self.at + 1)?.text == "if" {
                    self.at += 2;
                    break_if = Some(self.expr()?);
                    self.expect(";")?;
                } else {
                    continuing.push(self.statement()?);
                }
            }
        }
        Some(Stmt::Loop { body, continuing, break_if })
    }

    fn simple_statement(&mut self) -> Option<Stmt> {
        let target = self.expr()?;
        let statement = if self.eat("=") {
            Stmt::Assign { target, op: None, value: self.expr()? }
        } else if matches!(target, Expr::Call(..)) {
            Stmt::Call(target)
        } else {
            return None;
        };
        self.expect(";")?;
        Some(statement)
    }

    fn expr(&mut self) -> Option<Expr> {
        self.level(0)
    }

    fn level(&mut self, level: usize) -> Option<Expr> {
        let Some(ops) = LEVELS.get(level) else { return self.product() };
        let mut left = self.level(level + 1)?;
        while let Some(op) = self.operator(ops) {
            let right = self.level(level + 1)?;
            left = Expr::Binary(op, Box::new(left), Box::new(right));
        }
        Some(left)
    }

    fn product(&mut self) -> Option<Expr> {
        let mut left = self.unary()?;
        while let Some(op) = self.operator(PRODUCTS) {
            let right = self.unary()?;
            left = Expr::Binary(op, Box::new(left), Box::new(right));
        }
        Some(left)
    }

    /// Reads an operator if it is one of these.
    fn operator(&mut self, ops: &[&'static str]) -> Option<&'static str> {
        let first = self.peek();
        let second = self.tokens.get(self.at + 1).map_or("", |token| token.text);
        let pair = match (first, second) {
            ("<", "<") | (">", ">") | ("<", "=") | (">", "=") if self.is_joined(1) => Some(format!("{first}{second}")),
            _ => None,
        };
        let text = pair.as_deref().unwrap_or(first);
        let op = ops.iter().copied().find(|op| *op == text)?;
        self.at += if pair.is_some() { 2 } else { 1 };
        Some(op)
    }

    fn unary(&mut self) -> Option<Expr> {
        for op in ["-", "!", "~", "*", "&"] {
            if self.eat(op) {
                return Some(Expr::Unary(op, Box::new(self.unary()?)));
            }
        }
        let mut expr = self.primary()?;
        loop {
            if self.eat(".") {
                expr = Expr::Member(Box::new(expr), self.word()?.to_owned());
            } else if self.eat("[") {
                let index = self.expr()?;
                self.expect("]")?;
                expr = Expr::Index(Box::new(expr), Box::new(index));
            } else {
                return Some(expr);
            }
        }
    }

    fn primary(&mut self) -> Option<Expr> {
        if self.eat("(") {
            let inner = self.expr()?;
            self.expect(")")?;
            return Some(inner);
        }
        let first = self.peek();
        if first.starts_with(|digit: char| digit.is_ascii_digit()) {
            self.at += 1;
            return Some(Expr::Leaf(first.to_owned()));
        }
        let name = self.type_name()?;
        if self.peek() != "(" || !self.is_joined(0) {
            return Some(Expr::Leaf(name));
        }
        self.at += 1;
        let mut arguments = Vec::new();
        while !self.eat(")") {
            if !arguments.is_empty() {
                self.expect(",")?;
            }
            arguments.push(self.expr()?);
        }
        Some(Expr::Call(name, arguments))
    }

    /// A name with its parameters: `array<vec4<f32>, 2>`.
    fn type_name(&mut self) -> Option<String> {
        let mut text = self.word()?.to_owned();
        if self.peek() != "<" || !self.is_joined(0) {
            return Some(text);
        }
        let mut depth = 0;
        loop {
            let token = self.next()?;
            match token {
                "<" => depth += 1,
                ">" => depth -= 1,
                _ => {}
            }
            text.push_str(if token == "," { ", " } else { token });
            if depth == 0 {
                return Some(text);
            }
        }
    }
}
