//! Parses expressions (GLSL 1.50 §5, §9).

use super::place::Start;
use super::{MAX_NESTING, Parse, Parser, Reported, Token, TokenKind, TokenSource, codes};
use crate::diagnostic::Diagnostic;
use crate::source::Span;
use crate::syntax::ast::{BinaryOp, Expr, ExprId, ExprKind, Ident, IncDec, Literal, TypeBase, TypeSpec, UnaryOp};
use smallvec::SmallVec;

/// The binary operator of a token kind and its binding strength (§5.1).
fn binary_op(kind: TokenKind) -> Option<(BinaryOp, u8)> {
    use TokenKind::*;
    Some(match kind {
        OrOr => (BinaryOp::LogicalOr, 1),
        XorXor => (BinaryOp::LogicalXor, 2),
        AndAnd => (BinaryOp::LogicalAnd, 3),
        VerticalBar => (BinaryOp::BitOr, 4),
        Caret => (BinaryOp::BitXor, 5),
        Ampersand => (BinaryOp::BitAnd, 6),
        EqualEqual => (BinaryOp::Equal, 7),
        NotEqual => (BinaryOp::NotEqual, 7),
        LeftAngle => (BinaryOp::Less, 8),
        RightAngle => (BinaryOp::Greater, 8),
        LessEqual => (BinaryOp::LessEqual, 8),
        GreaterEqual => (BinaryOp::GreaterEqual, 8),
        LeftOp => (BinaryOp::Shl, 9),
        RightOp => (BinaryOp::Shr, 9),
        Plus => (BinaryOp::Add, 10),
        Dash => (BinaryOp::Sub, 10),
        Star => (BinaryOp::Mul, 11),
        Slash => (BinaryOp::Div, 11),
        Percent => (BinaryOp::Rem, 11),
        _ => return None,
    })
}

fn strength(op: BinaryOp) -> u8 {
    use BinaryOp::*;
    match op {
        LogicalOr => 1,
        LogicalXor => 2,
        LogicalAnd => 3,
        BitOr => 4,
        BitXor => 5,
        BitAnd => 6,
        Equal | NotEqual => 7,
        Less | Greater | LessEqual | GreaterEqual => 8,
        Shl | Shr => 9,
        Add | Sub => 10,
        Mul | Div | Rem => 11,
    }
}

fn assignment_op(kind: TokenKind) -> Option<Option<BinaryOp>> {
    use TokenKind::*;
    Some(match kind {
        Equal => None,
        MulAssign => Some(BinaryOp::Mul),
        DivAssign => Some(BinaryOp::Div),
        ModAssign => Some(BinaryOp::Rem),
        AddAssign => Some(BinaryOp::Add),
        SubAssign => Some(BinaryOp::Sub),
        LeftAssign => Some(BinaryOp::Shl),
        RightAssign => Some(BinaryOp::Shr),
        AndAssign => Some(BinaryOp::BitAnd),
        XorAssign => Some(BinaryOp::BitXor),
        OrAssign => Some(BinaryOp::BitOr),
        _ => return None,
    })
}

/// The prefix operators.
#[derive(Clone, Copy)]
enum Prefix {
    Unary(UnaryOp),
    Step(IncDec),
}

fn prefix_op(kind: TokenKind) -> Option<Prefix> {
    Some(match kind {
        TokenKind::Plus => Prefix::Unary(UnaryOp::Plus),
        TokenKind::Dash => Prefix::Unary(UnaryOp::Minus),
        TokenKind::Bang => Prefix::Unary(UnaryOp::Not),
        TokenKind::Tilde => Prefix::Unary(UnaryOp::BitNot),
        TokenKind::Increment => Prefix::Step(IncDec::PreIncrement),
        TokenKind::Decrement => Prefix::Step(IncDec::PreDecrement),
        _ => return None,
    })
}

impl<T: TokenSource> Parser<'_, '_, T> {
    /// Adds an expression to the tree, from its start to the last token read, unless it is too deep.
    pub(super) fn push(&mut self, kind: ExprKind, start: Start) -> Parse<ExprId> {
        let depth = self.depth_of(&kind);
        let span = self.since(start);
        if u32::from(depth) > MAX_NESTING {
            return Err(self.too_deep(span));
        }
        self.depths.push(depth);
        self.starts.push(start);
        Ok(self.ast.push(kind, span))
    }

    /// An expression that replaces an error, with what was understood of it.
    pub(super) fn error_expr(&mut self, span: Span, pieces: Vec<ExprId>) -> ExprId {
        let depth = self.deepest(&pieces) + 1;
        self.depths.push(depth);
        self.starts.push(self.start());
        self.ast.push(ExprKind::Error(pieces), span)
    }

    /// The beginning of an expression.
    fn start_of(&self, id: ExprId) -> Start {
        self.starts.get(id.index()).copied().unwrap_or_else(|| self.start())
    }

    fn depth(&self, id: ExprId) -> u16 {
        self.depths.get(id.index()).copied().unwrap_or(1)
    }

    fn deepest(&self, ids: &[ExprId]) -> u16 {
        ids.iter().map(|id| self.depth(*id)).max().unwrap_or(0)
    }

    /// The depth of an expression: one more than its deepest child, where the left operand of a chain counts as the
    /// same level.
    fn depth_of(&self, kind: &ExprKind) -> u16 {
        let below = match kind {
            ExprKind::Literal(_) | ExprKind::Name(_) => 0,
            ExprKind::Binary(_, _, left, right) | ExprKind::Comma(left, right) => {
                return self.depth(*left).max(self.depth(*right) + 1);
            }
            ExprKind::Unary(_, a) | ExprKind::IncDec(_, a) | ExprKind::Field(a, _) | ExprKind::Index(a, None) => {
                self.depth(*a)
            }
            ExprKind::Assign(_, _, a, b) | ExprKind::Index(a, Some(b)) => self.depth(*a).max(self.depth(*b)),
            ExprKind::Ternary(a, b, c) => self.deepest(&[*a, *b, *c]),
            ExprKind::Error(list) | ExprKind::Call(_, list) | ExprKind::List(list) => self.deepest(list),
            ExprKind::Construct(ty, list) => {
                let sizes = ty.array.iter().filter_map(|dim| dim.size).map(|size| self.depth(size)).max();
                self.deepest(list).max(sizes.unwrap_or(0))
            }
            ExprKind::Method(a, _, list) => self.depth(*a).max(self.deepest(list)),
        };
        below + 1
    }

    pub(super) fn expr(&self, id: ExprId) -> &Expr {
        self.ast.expr(id)
    }

    /// expression
    pub(super) fn expression(&mut self) -> Parse<ExprId> {
        let mut left = self.assignment_expression()?;
        while self.eat(TokenKind::Comma).is_some() {
            let right = self.assignment_expression()?;
            left = self.push(ExprKind::Comma(left, right), self.start_of(left))?;
        }
        Ok(left)
    }

    /// assignment_expression, conditional_expression
    pub(super) fn assignment_expression(&mut self) -> Parse<ExprId> {
        self.nested(|this| {
            let left = this.binary_expression()?;
            if this.kind() == TokenKind::Question {
                return this.conditional(left);
            }
            let Some(op) = assignment_op(this.kind()) else { return Ok(left) };
            let operator = this.bump().span;
            let right = this.assignment_expression()?;
            this.push(ExprKind::Assign(op, operator, left, right), this.start_of(left))
        })
    }

    /// conditional_expression alone, where an assignment is not allowed
    pub(super) fn constant_expression(&mut self) -> Parse<ExprId> {
        self.nested(|this| {
            let left = this.binary_expression()?;
            if this.kind() == TokenKind::Question { this.conditional(left) } else { Ok(left) }
        })
    }

    fn conditional(&mut self, condition: ExprId) -> Parse<ExprId> {
        self.bump();
        let yes = self.expression()?;
        if self.kind() != TokenKind::Colon {
            return Err(self.unexpected("`:` of the `?:`"));
        }
        self.bump();
        let no = self.assignment_expression()?;
        self.push(ExprKind::Ternary(condition, yes, no), self.start_of(condition))
    }

    /// logical_or_expression and everything below it down to multiplicative_expression, on an explicit stack.
    fn binary_expression(&mut self) -> Parse<ExprId> {
        let floor = self.operators.len();
        let mut left = self.unary_expression()?;
        loop {
            let next = binary_op(self.kind());
            let least = next.map_or(0, |(_, strength)| strength);
            while self.operators.len() > floor {
                let Some(&(op, span, operand)) = self.operators.last().filter(|(op, ..)| strength(*op) >= least) else {
                    break;
                };
                self.operators.pop();
                left = self.push(ExprKind::Binary(op, span, operand, left), self.start_of(operand))?;
            }
            let Some((op, _)) = next else { return Ok(left) };
            let operator = self.bump().span;
            self.operators.push((op, operator, left));
            left = self.unary_expression()?;
        }
    }

    /// unary_expression
    fn unary_expression(&mut self) -> Parse<ExprId> {
        if prefix_op(self.kind()).is_none() {
            return self.postfix_expression();
        }
        let mut operators: SmallVec<[(Prefix, Start); 4]> = SmallVec::new();
        while let Some(op) = prefix_op(self.kind()) {
            operators.push((op, self.start()));
            self.bump();
        }
        let mut operand = self.postfix_expression()?;
        while let Some((op, operator)) = operators.pop() {
            let kind = match op {
                Prefix::Unary(op) => ExprKind::Unary(op, operand),
                Prefix::Step(op) => ExprKind::IncDec(op, operand),
            };
            operand = self.push(kind, operator)?;
        }
        Ok(operand)
    }

    /// postfix_expression
    fn postfix_expression(&mut self) -> Parse<ExprId> {
        let mut base = self.primary_expression()?;
        loop {
            base = match self.kind() {
                TokenKind::LeftBracket => self.index(base)?,
                TokenKind::Dot => self.field(base)?,
                TokenKind::Increment => self.step(base, IncDec::PostIncrement)?,
                TokenKind::Decrement => self.step(base, IncDec::PostDecrement)?,
                TokenKind::LeftParen => self.array_constructor(base)?,
                _ => return Ok(base),
            };
        }
    }

    fn step(&mut self, base: ExprId, op: IncDec) -> Parse<ExprId> {
        self.bump();
        self.push(ExprKind::IncDec(op, base), self.start_of(base))
    }

    fn index(&mut self, base: ExprId) -> Parse<ExprId> {
        let opening = self.bump();
        let index = if self.kind() == TokenKind::RightBracket { None } else { Some(self.expression()?) };
        self.close(opening, TokenKind::RightBracket, "`]` or an operator")?;
        self.push(ExprKind::Index(base, index), self.start_of(base))
    }

    fn field(&mut self, base: ExprId) -> Parse<ExprId> {
        self.bump();
        let name = self.ident("the name of a member or a swizzle")?;
        if self.kind() == TokenKind::LeftParen {
            let arguments = self.arguments()?;
            return self.push(ExprKind::Method(base, name, arguments), self.start_of(base));
        }
        self.push(ExprKind::Field(base, name), self.start_of(base))
    }

    /// `S[2](..)`: what was read as indices of a name are the array sizes of a type.
    fn array_constructor(&mut self, base: ExprId) -> Parse<ExprId> {
        let mut sizes = Vec::new();
        let mut inner = base;
        let name = loop {
            match self.expr(inner).kind {
                ExprKind::Index(below, size) => {
                    let end = self.expr(inner).span.end;
                    let span = Span { start: self.expr(below).span.end, end, ..self.expr(inner).span };
                    sizes.push(crate::syntax::ast::ArrayDim { size, span });
                    inner = below;
                }
                ExprKind::Name(name) => break Some(name),
                _ => break None,
            }
        };
        let Some(name) = name else {
            let span = self.current.span;
            let diagnostic = Diagnostic::new(&codes::UNEXPECTED_TOKEN, span, "only names and types can be called")
                .here("these parentheses call what precedes them")
                .label(self.expr(base).span, "this is neither");
            return Err(self.report_found(diagnostic));
        };
        sizes.reverse();
        let span = self.expr(base).span;
        let ty = TypeSpec { base: TypeBase::Named(name), array: sizes, span };
        let arguments = self.arguments()?;
        self.push(ExprKind::Construct(Box::new(ty), arguments), self.start_of(base))
    }

    /// `(a, b)`, `()`, `(void)`
    fn arguments(&mut self) -> Parse<Vec<ExprId>> {
        let opening = self.bump();
        let mut arguments = Vec::new();
        if self.kind() == TokenKind::Void && self.ahead(1).kind == TokenKind::RightParen {
            self.bump();
        }
        if self.kind() != TokenKind::RightParen {
            arguments.push(self.assignment_expression()?);
            while self.eat(TokenKind::Comma).is_some() {
                arguments.push(self.assignment_expression()?);
            }
        }
        self.close(opening, TokenKind::RightParen, "`,`, `)` or an operator")?;
        Ok(arguments)
    }

    /// primary_expression, and calls by name
    fn primary_expression(&mut self) -> Parse<ExprId> {
        let (token, start) = (self.current, self.start());
        let literal = match token.kind {
            TokenKind::Ident | TokenKind::Reserved => return self.name(),
            TokenKind::Invalid => {
                self.bump();
                return Ok(self.error_expr(token.span, Vec::new()));
            }
            TokenKind::Type => return self.constructor(),
            TokenKind::Foreign => return Err(self.foreign()),
            TokenKind::Unsigned => {
                let ty = self.type_specifier()?;
                let arguments = self.arguments()?;
                return self.push(ExprKind::Construct(Box::new(ty), arguments), start);
            }
            TokenKind::LeftParen => return self.parenthesized(),
            TokenKind::Int => Literal::Int(token.payload as i32),
            TokenKind::Uint => Literal::Uint(token.payload),
            TokenKind::Float => Literal::Float(f32::from_bits(token.payload)),
            TokenKind::True => Literal::Bool(true),
            TokenKind::False => Literal::Bool(false),
            _ => return Err(self.no_expression()),
        };
        self.bump();
        self.push(ExprKind::Literal(literal), start)
    }

    fn no_expression(&mut self) -> Reported {
        if self.kind() == TokenKind::LeftBrace {
            let diagnostic =
                Diagnostic::new(&codes::UNEXPECTED_TOKEN, self.current.span, "expected an expression, found `{`")
                    .here("a list is only allowed after `=`")
                    .help("write a constructor, such as `float[](1.0, 2.0)`");
            return self.report_found(diagnostic);
        }
        self.unexpected("an expression")
    }

    fn name(&mut self) -> Parse<ExprId> {
        let start = self.start();
        let name: Ident = self.ident("a name")?;
        if self.kind() != TokenKind::LeftParen {
            return self.push(ExprKind::Name(name), start);
        }
        let arguments = self.arguments()?;
        self.push(ExprKind::Call(name, arguments), start)
    }

    /// A type keyword and the arguments of its constructor.
    fn constructor(&mut self) -> Parse<ExprId> {
        let start = self.start();
        let token: Token = self.bump();
        let array = self.array_specifiers()?;
        let span = self.since(start);
        if self.kind() != TokenKind::LeftParen {
            let name = self.session.spelling(token).to_owned();
            return Err(self.unexpected(&format!("`(` after the type `{name}`")));
        }
        let ty = TypeSpec { base: TypeBase::Keyword(token.symbol()), array, span };
        let arguments = self.arguments()?;
        self.push(ExprKind::Construct(Box::new(ty), arguments), start)
    }

    /// The finding for `(float3)value`: a name in parentheses before a value is a cast of C or HLSL.
    fn named_cast(&mut self, opening: Start, inner: ExprId) -> Option<Diagnostic> {
        let is_name = matches!(self.ast.exprs.get(inner.index()).map(|expr| &expr.kind), Some(ExprKind::Name(_)));
        let before_value =
            matches!(self.kind(), TokenKind::Ident | TokenKind::Int | TokenKind::Uint | TokenKind::Float);
        if !is_name || !before_value {
            return None;
        }
        let span = self.since(opening);
        let name = self.session.sources.snippet(span).trim_matches(['(', ')', ' ']).to_owned();
        // Any other name may be a variable, with an operator missing behind it.
        let ty = crate::language::foreign::type_name(&name)?;
        Some(cast(span, &name, ty))
    }

    /// `(float)value`: a type in parentheses. It is reported, and its type counts as unknown.
    fn cast(&mut self, opening: Start) -> Parse<ExprId> {
        let name = self.session.spelling(self.current).to_owned();
        let reported = self.report_found(cast(self.current.span, &name, &name));
        self.bump();
        self.bump();
        if !self.begins_value() {
            return Err(reported);
        }
        let value = self.nested(Self::unary_expression)?;
        let whole = self.since(opening);
        Ok(self.error_expr(whole, vec![value]))
    }

    /// Whether an operand is next.
    fn begins_value(&self) -> bool {
        use TokenKind::*;
        let kind = self.kind();
        matches!(kind, Ident | Type | Int | Uint | Float | True | False | LeftParen) || prefix_op(kind).is_some()
    }

    /// `(a)`: in the tree, parentheses only widen the span.
    fn parenthesized(&mut self) -> Parse<ExprId> {
        let start = self.start();
        let opening = self.bump();
        if self.kind() == TokenKind::Type && self.ahead(1).kind == TokenKind::RightParen {
            return self.cast(start);
        }
        let inner = self.expression()?;
        self.close(opening, TokenKind::RightParen, "`)` or an operator")?;
        if let Some(finding) = self.named_cast(start, inner) {
            let _: Reported = self.report_found(finding);
            let value = self.nested(Self::unary_expression)?;
            let whole = self.since(start);
            return Ok(self.error_expr(whole, vec![value]));
        }
        let span = self.since(start);
        if let Some(expr) = self.ast.exprs.get_mut(inner.index()) {
            expr.span = span;
        }
        if let Some(place) = self.starts.get_mut(inner.index()) {
            *place = start;
        }
        let depth = self.depth(inner) + 1;
        if u32::from(depth) > MAX_NESTING {
            return Err(self.too_deep(span));
        }
        if let Some(place) = self.depths.get_mut(inner.index()) {
            *place = depth;
        }
        Ok(inner)
    }
}

/// The finding for a cast to what GLSL calls `ty`.
fn cast(span: Span, name: &str, ty: &str) -> Diagnostic {
    Diagnostic::new(&codes::UNEXPECTED_TOKEN, span, format!("`({name})` is not a cast: GLSL has none"))
        .help(format!("write `{ty}(..)` around the value"))
}
