//! The formulas of the gallery as numbers: parses the subset of TeX that `crates/report/src/gallery/math.rs` typesets, and evaluates
//! it over scalars and vectors.
//!
//! *In:* a formula as a scene prints it, and the values of its symbols. *Out:* its definitions, and their values.
//! *Holds:* the reading is the usual one of such formulas: juxtaposition multiplies, the dot is the scalar product,
//! the circled cross multiplies channel by channel.

use std::fmt;

/// A number, or a vector or color.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Value {
    Number(f64),
    Vector([f64; 3]),
}

/// A node of a formula.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Node {
    Number(f64),
    /// A symbol with its subscript: `K_diff`.
    Symbol(String),
    Add(Box<Node>, Box<Node>),
    Subtract(Box<Node>, Box<Node>),
    Negate(Box<Node>),
    /// Juxtaposition.
    Times(Box<Node>, Box<Node>),
    Dot(Box<Node>, Box<Node>),
    /// Channel by channel.
    ByChannel(Box<Node>, Box<Node>),
    Divide(Box<Node>, Box<Node>),
    Power(Box<Node>, Box<Node>),
    Max(Box<Node>, Box<Node>),
    Length(Box<Node>),
    Ceiling(Box<Node>),
    Root(Box<Node>),
    /// A table: its name and the coordinate.
    Table(String, Box<Node>),
    /// The sum over the lights.
    OverLights(Box<Node>),
    /// First where the second is above the third, else the fourth.
    Where(Box<[Node; 4]>),
}

/// `name = value`.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Definition {
    pub(crate) name: String,
    pub(crate) value: Node,
}

/// Parses the definitions of formulas, of which one may go on over several lines. `x = \mathrm{const}` defines
/// nothing.
pub(crate) fn definitions(formulas: &[&str]) -> Result<Vec<Definition>, String> {
    let mut whole: Vec<String> = Vec::new();
    for formula in formulas {
        match whole.last_mut() {
            Some(last) if formula.trim_start().starts_with("\\quad") => *last = format!("{last} {formula}"),
            _ => whole.push((*formula).to_owned()),
        }
    }
    let mut found = Vec::new();
    for formula in whole.iter().filter(|formula| !formula.contains("\\mathrm{const}")) {
        found.extend(definition(formula).map_err(|error| format!("{formula}: {error}"))?);
    }
    Ok(found)
}

/// The definitions of one formula: one, or several with commas and chains of `=` between them.
fn definition(formula: &str) -> Result<Vec<Definition>, String> {
    let mut parser = Parser { tokens: tokens(formula)?, at: 0 };
    let mut found = Vec::new();
    loop {
        let mut sides = vec![parser.sum()?];
        while parser.accept("=") {
            sides.push(parser.sum()?);
        }
        let mut value = sides.pop().ok_or("empty")?;
        if parser.accept("where") {
            let left = parser.sum()?;
            parser.expect(">")?;
            let right = parser.sum()?;
            parser.accept(",");
            parser.expect("else")?;
            value = Node::Where(Box::new([value, left, right, parser.sum()?]));
        }
        if sides.is_empty() {
            return Err("it defines nothing".to_owned());
        }
        for side in sides {
            found.push(match side {
                Node::Symbol(name) => Definition { name, value: value.clone() },
                Node::Divide(one, name) if *one == Node::Number(1.0) => {
                    let Node::Symbol(name) = *name else { return Err("no symbol on the left".to_owned()) };
                    Definition { name, value: Node::Divide(Box::new(Node::Number(1.0)), Box::new(value.clone())) }
                }
                other => return Err(format!("no symbol on the left: {other:?}")),
            });
        }
        if !parser.accept(",") {
            break;
        }
    }
    match parser.tokens.get(parser.at) {
        None => Ok(found),
        Some(rest) => Err(format!("`{rest}` is left over")),
    }
}

/// Greek letters that are symbols.
const GREEK: &[&str] = &["\\theta", "\\alpha", "\\sigma", "\\pi"];

/// Commands without a meaning of their own.
const IGNORED: &[&str] = &["\\,", "\\;", "\\quad", "\\mathbf", "\\mathrm"];

fn tokens(formula: &str) -> Result<Vec<String>, String> {
    let mut tokens = Vec::new();
    let mut rest = formula.trim_start();
    while let Some(first) = rest.chars().next() {
        let length = match first {
            '\\' => {
                let letters = rest[1..].find(|letter: char| !letter.is_ascii_alphabetic()).unwrap_or(rest.len() - 1);
                1 + letters.max(1)
            }
            '0'..='9' => rest.find(|letter: char| !letter.is_ascii_digit() && letter != '.').unwrap_or(rest.len()),
            _ if first.is_ascii() => 1,
            _ => return Err(format!("`{first}`")),
        };
        let token = &rest[..length];
        rest = rest[length..].trim_start();
        if token == "\\text" {
            let end = rest.find('}').ok_or("`\\text` without a group")?;
            tokens.push(rest[1..end].trim().to_owned());
            rest = rest[end + 1..].trim_start();
        } else if !IGNORED.contains(&token) {
            tokens.push(token.to_owned());
        }
    }
    Ok(tokens)
}

struct Parser {
    tokens: Vec<String>,
    at: usize,
}

impl Parser {
    fn peek(&self) -> &str {
        self.tokens.get(self.at).map_or("", String::as_str)
    }

    fn take(&mut self) -> String {
        self.at += 1;
        self.tokens.get(self.at - 1).cloned().unwrap_or_default()
    }

    fn accept(&mut self, token: &str) -> bool {
        let found = self.peek() == token;
        self.at += usize::from(found);
        found
    }

    fn expect(&mut self, token: &str) -> Result<(), String> {
        if self.accept(token) { Ok(()) } else { Err(format!("`{token}` is missing before `{}`", self.peek())) }
    }

    fn sum(&mut self) -> Result<Node, String> {
        let mut left = self.product()?;
        loop {
            if self.accept("+") {
                left = Node::Add(Box::new(left), Box::new(self.product()?));
            } else if self.accept("-") {
                left = Node::Subtract(Box::new(left), Box::new(self.product()?));
            } else {
                return Ok(left);
            }
        }
    }

    fn product(&mut self) -> Result<Node, String> {
        if self.accept("-") {
            return Ok(Node::Negate(Box::new(self.product()?)));
        }
        let mut left = self.power()?;
        loop {
            left = if self.accept("\\cdot") {
                Node::Dot(Box::new(left), Box::new(self.power()?))
            } else if self.accept("\\otimes") {
                Node::ByChannel(Box::new(left), Box::new(self.power()?))
            } else if self.accept("/") {
                Node::Divide(Box::new(left), Box::new(self.power()?))
            } else if self.starts_factor() {
                Node::Times(Box::new(left), Box::new(self.power()?))
            } else {
                return Ok(left);
            };
        }
    }

    fn starts_factor(&self) -> bool {
        let token = self.peek();
        let closing = ["where", "else", "\\}", "\\rceil"].contains(&token);
        !closing && token.starts_with(|first: char| first.is_ascii_alphanumeric() || "\\({".contains(first))
    }

    fn power(&mut self) -> Result<Node, String> {
        let base = self.atom()?;
        if !self.accept("^") {
            return Ok(base);
        }
        let exponent = self.script()?;
        // The number of a light is written as an exponent in (101).
        Ok(if exponent == Node::Symbol("k".to_owned()) {
            base
        } else {
            Node::Power(Box::new(base), Box::new(exponent))
        })
    }

    /// One token or a group, as after `^`.
    fn script(&mut self) -> Result<Node, String> {
        if self.accept("{") {
            let inside = self.sum()?;
            self.expect("}")?;
            return Ok(inside);
        }
        self.atom()
    }

    fn group(&mut self) -> Result<Node, String> {
        self.expect("{")?;
        let inside = self.sum()?;
        self.expect("}")?;
        Ok(inside)
    }

    /// A symbol with the subscript that follows it.
    fn subscripted(&mut self, mut name: String) -> String {
        name = name.trim_start_matches('\\').to_owned();
        if self.accept("_") {
            name.push('_');
            if self.accept("{") {
                while !self.accept("}") && self.at < self.tokens.len() {
                    name.push_str(&self.take());
                }
            } else {
                name.push_str(&self.take());
            }
        }
        name
    }

    fn atom(&mut self) -> Result<Node, String> {
        let token = self.take();
        let closed = |parser: &mut Self, end: &str| -> Result<Box<Node>, String> {
            let inside = parser.sum()?;
            parser.expect(end)?;
            Ok(Box::new(inside))
        };
        Ok(match token.as_str() {
            "(" => *closed(self, ")")?,
            "{" => match *closed(self, "}")? {
                // A vector's letter is in a group, its subscript after that.
                Node::Symbol(name) => Node::Symbol(self.subscripted(name)),
                other => other,
            },
            "\\{" => *closed(self, "\\}")?,
            "|" => Node::Length(closed(self, "|")?),
            "\\lceil" => Node::Ceiling(closed(self, "\\rceil")?),
            "\\sqrt" => Node::Root(Box::new(self.group()?)),
            "\\frac" => Node::Divide(Box::new(self.group()?), Box::new(self.group()?)),
            "\\max" => {
                self.expect("(")?;
                let left = Box::new(self.sum()?);
                self.expect(",")?;
                Node::Max(left, closed(self, ")")?)
            }
            "\\cos" => {
                let exponent = if self.accept("^") { Some(self.script()?) } else { None };
                let angle = self.take();
                let cosine = Node::Symbol(format!("cos {}", self.subscripted(angle)));
                exponent.map_or(cosine.clone(), |exponent| Node::Power(Box::new(cosine), Box::new(exponent)))
            }
            "\\sum" => {
                self.subscripted(String::new());
                self.expect("^")?;
                self.script()?;
                Node::OverLights(Box::new(self.product()?))
            }
            "T" => {
                let name = self.subscripted(token);
                self.expect("(")?;
                Node::Table(name, closed(self, ")")?)
            }
            number if number.starts_with(|first: char| first.is_ascii_digit()) => {
                Node::Number(number.parse().map_err(|error| format!("`{number}`: {error}"))?)
            }
            letter if letter.starts_with(|first: char| first.is_ascii_alphabetic()) || GREEK.contains(&letter) => {
                Node::Symbol(self.subscripted(token))
            }
            other => return Err(format!("`{other}` in the place of a factor")),
        })
    }
}

/// Where the values of symbols and tables come from.
pub(crate) trait Values {
    /// The value of a symbol for the present light.
    fn symbol(&self, name: &str) -> Result<Value, String>;
    /// A table at a coordinate.
    fn table(&self, name: &str, at: f64) -> Result<Value, String>;
    /// A sum over all lights.
    fn over_lights(&self, term: &Node) -> Result<Value, String>;
}

/// The value of a formula.
pub(crate) fn evaluate(node: &Node, values: &dyn Values) -> Result<Value, String> {
    let of = |node: &Node| evaluate(node, values);
    let number = |node: &Node| match evaluate(node, values)? {
        Value::Number(number) => Ok(number),
        Value::Vector(_) => Err(format!("a number is wanted: {node:?}")),
    };
    match node {
        Node::Number(number) => Ok(Value::Number(*number)),
        Node::Symbol(name) => values.symbol(name),
        Node::Add(a, b) => by_channel(of(a)?, of(b)?, false, |a, b| a + b),
        Node::Subtract(a, b) => by_channel(of(a)?, of(b)?, false, |a, b| a - b),
        Node::Negate(a) => by_channel(Value::Number(-1.0), of(a)?, true, |a, b| a * b),
        Node::Times(a, b) => match (of(a)?, of(b)?) {
            (Value::Vector(_), Value::Vector(_)) => Err("two vectors side by side".to_owned()),
            (a, b) => by_channel(a, b, true, |a, b| a * b),
        },
        Node::ByChannel(a, b) => by_channel(of(a)?, of(b)?, true, |a, b| a * b),
        Node::Divide(a, b) => {
            let divisor = number(b)?;
            by_channel(of(a)?, Value::Number(divisor), true, |a, b| a / b)
        }
        Node::Dot(a, b) => match (of(a)?, of(b)?) {
            (Value::Vector(a), Value::Vector(b)) => Ok(Value::Number(dot(a, b))),
            (a, b) => Err(format!("the dot of {a:?} and {b:?}")),
        },
        Node::Power(a, b) => Ok(Value::Number(number(a)?.powf(number(b)?))),
        Node::Max(a, b) => Ok(Value::Number(number(a)?.max(number(b)?))),
        Node::Ceiling(a) => Ok(Value::Number(number(a)?.ceil())),
        Node::Root(a) => Ok(Value::Number(number(a)?.sqrt())),
        Node::Length(a) => match of(a)? {
            Value::Vector(a) => Ok(Value::Number(dot(a, a).sqrt())),
            Value::Number(a) => Ok(Value::Number(a.abs())),
        },
        Node::Table(name, at) => values.table(name, number(at)?),
        Node::OverLights(term) => values.over_lights(term),
        Node::Where(parts) => {
            let [yes, left, right, no] = parts.as_ref();
            if number(left)? > number(right)? { of(yes) } else { of(no) }
        }
    }
}

pub(crate) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// An operation on two values of one kind or, if `mixed`, on a number and each channel of a vector.
fn by_channel(a: Value, b: Value, mixed: bool, operation: impl Fn(f64, f64) -> f64) -> Result<Value, String> {
    let each = |a: [f64; 3], b: [f64; 3]| Value::Vector(std::array::from_fn(|i| operation(a[i], b[i])));
    match (a, b) {
        (Value::Number(a), Value::Number(b)) => Ok(Value::Number(operation(a, b))),
        (Value::Vector(a), Value::Vector(b)) => Ok(each(a, b)),
        (Value::Number(a), Value::Vector(b)) if mixed => Ok(each([a; 3], b)),
        (Value::Vector(a), Value::Number(b)) if mixed => Ok(each(a, [b; 3])),
        (a, b) => Err(format!("{a} and {b} do not add up")),
    }
}

impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(number) => write!(f, "{number}"),
            Self::Vector(vector) => write!(f, "{vector:?}"),
        }
    }
}

/// The arithmetic of formulas, without any scene.
#[test]
fn formulas_have_their_usual_meaning() {
    struct Known;
    impl Values for Known {
        fn symbol(&self, name: &str) -> Result<Value, String> {
            match name {
                "N" => Ok(Value::Vector([0.0, 0.6, 0.8])),
                "L" => Ok(Value::Vector([0.0, 0.0, 1.0])),
                "K_diff" => Ok(Value::Vector([0.5, 0.25, 1.0])),
                "cos theta_h" | "t" => Ok(Value::Number(0.5)),
                other => Err(other.to_owned()),
            }
        }
        fn table(&self, _: &str, at: f64) -> Result<Value, String> {
            Ok(Value::Number(10.0 * at))
        }
        fn over_lights(&self, term: &Node) -> Result<Value, String> {
            by_channel(Value::Number(3.0), evaluate(term, self)?, true, |a, b| a * b)
        }
    }
    for (formula, wanted) in [
        (r"x = 2 (\mathbf{N} \cdot \mathbf{L}) \mathbf{N} - \mathbf{L}", Value::Vector([0.0, 0.96, 0.28])),
        (r"x = \max(-\mathbf{N} \cdot \mathbf{L}, 0)^{4}", Value::Number(0.0)),
        (r"x = \cos^{3}\theta_h K_{diff} \otimes K_{diff}", Value::Vector([0.03125, 0.0078125, 0.125])),
        (r"x = \frac{t}{4 - 2 t + t}", Value::Number(0.5 / 3.5)),
        (r"x = \lceil \max(\mathbf{N} \cdot \mathbf{L}, 0) - t \rceil", Value::Number(1.0)),
        (r"x = T_{metal}(\frac{t + 1}{2})", Value::Number(7.5)),
        (r"x = 1 + \sum_{k=1}^{n} t^k \{ 1 + t^k \}", Value::Number(3.25)),
        (r"x = 1 \text{where} t > 0.25, \text{else} 2", Value::Number(1.0)),
        (r"x = \sqrt{t^2 + |\mathbf{L}|}", Value::Number(1.25f64.sqrt())),
    ] {
        let found = definitions(&[formula]).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!((found.len(), found[0].name.as_str()), (1, "x"), "{formula}");
        let value = evaluate(&found[0].value, &Known).unwrap_or_else(|error| panic!("{formula}: {error}"));
        let close = by_channel(value, wanted, false, |a, b| (a - b).abs()).expect("of one kind");
        let error = match close {
            Value::Number(error) => error,
            Value::Vector(errors) => errors.into_iter().fold(0.0, f64::max),
        };
        assert!(error < 1e-12, "{formula}: {value}, not {wanted}");
    }
    assert_eq!(definitions(&[r"s_c = 1, \; s_l = s_q = 0"]).expect("three").len(), 3);
    for formula in ["x", r"x = \mathbf{N} K_{diff} \infty", "x + 1 = 2"] {
        assert!(definitions(&[formula]).is_err(), "{formula}");
    }
    let mixed = definitions(&[r"x = \mathbf{N} + 1"]).expect("it parses");
    assert!(evaluate(&mixed[0].value, &Known).is_err());
}
