//! Analyzes operators without side effects (§5.9): unary, binary, `?:` and `,`.

use super::super::context::Analyzer;
use crate::diagnostic::codes::types;
use crate::diagnostic::{Advice, Applicability, Diagnostic, Fix, Place};
use crate::hir::{ArraySize, BinaryOp, ExprId, ExprKind, LogicalOp, Scalar, Type, TypeId, UnaryOp};
use crate::language::Feature;
use crate::source::Span;
use crate::syntax::ast;

/// The converted operands of a binary operator, and the type of the result.
pub(super) struct Typed {
    pub(super) left: ExprId,
    pub(super) right: ExprId,
    pub(super) operator: BinaryOp,
    pub(super) ty: TypeId,
}

/// The help for an assignment as a condition.
const ASSIGNS: &str = "`=` assigns; write `==` to compare";

impl Analyzer<'_> {
    /// `+a`, `-a`, `!a`, `~a`
    pub(super) fn unary(&mut self, operator: ast::UnaryOp, operand: ExprId, span: Span) -> ExprId {
        let ty = self.ty(operand);
        if ty.is_error() {
            return self.poison(span);
        }
        let scalar = self.types.scalar_of(ty);
        let is_scalar_or_vector = matches!(self.types.get(ty), Type::Scalar(_) | Type::Vector(..));
        let (allowed, kind, wanted) = match operator {
            ast::UnaryOp::Plus | ast::UnaryOp::Minus => {
                (scalar.is_some_and(|scalar| scalar != Scalar::Bool), UnaryOp::Negate, "numbers")
            }
            ast::UnaryOp::Not => (ty == TypeId::BOOL, UnaryOp::Not, "a `bool`"),
            ast::UnaryOp::BitNot => {
                (is_scalar_or_vector && scalar.is_some_and(Scalar::is_integer), UnaryOp::BitNot, "integers")
            }
        };
        if !allowed {
            let (spelling, name) = (unary_spelling(operator), self.type_name(ty));
            let help = (operator == ast::UnaryOp::Not && scalar == Some(Scalar::Bool))
                .then(|| "use the function `not` for each component of a vector".to_owned());
            let span_of_operand = self.span(operand);
            self.report(
                Diagnostic::new(&types::OPERANDS, span, format!("`{spelling}` needs {wanted}, not a `{name}`"))
                    .label(span_of_operand, format!("this is a `{name}`"))
                    .maybe_help(help),
            );
            return self.poison(span);
        }
        if operator == ast::UnaryOp::BitNot {
            self.require_operator("~", span);
        }
        if operator == ast::UnaryOp::Plus {
            if self.shader.root_variable(operand).is_none() {
                return operand;
            }
            // `+a` is `a`, but not an l-value. Two negations change no bit of any number.
            let negated = self.push(ExprKind::Unary(kind, operand), ty, span);
            return self.push(ExprKind::Unary(kind, negated), ty, span);
        }
        self.push(ExprKind::Unary(kind, operand), ty, span)
    }

    /// `a op b` without assignment.
    pub(super) fn binary(
        &mut self,
        operator: ast::BinaryOp,
        at: Span,
        left: ExprId,
        right: ExprId,
        span: Span,
    ) -> ExprId {
        if self.ty(left).is_error() || self.ty(right).is_error() {
            return self.poison(span);
        }
        let logical = match operator {
            ast::BinaryOp::LogicalAnd => Some(LogicalOp::And),
            ast::BinaryOp::LogicalOr => Some(LogicalOp::Or),
            _ => None,
        };
        if let Some(logical) = logical {
            if self.ty(left) == TypeId::BOOL && self.ty(right) == TypeId::BOOL {
                return self.push(ExprKind::Logical(logical, left, right), TypeId::BOOL, span);
            }
            self.report_operands(operator.spelling(), at, left, right);
            return self.poison(span);
        }
        match self.typed_binary(operator, left, right) {
            Some(typed) => self.push(ExprKind::Binary(typed.operator, typed.left, typed.right), typed.ty, span),
            None => {
                self.report_operands(operator.spelling(), at, left, right);
                self.poison(span)
            }
        }
    }

    /// Types an operator with two valid operands; `None` if it does not accept operands of these types.
    pub(super) fn typed_binary(&mut self, operator: ast::BinaryOp, left: ExprId, right: ExprId) -> Option<Typed> {
        use ast::BinaryOp as B;
        let operands = (left, right);
        let is_integer = |id| self.types.scalar_of(self.ty(id)).is_some_and(Scalar::is_integer);
        let is_of_integers = matches!(operator, B::Rem | B::BitAnd | B::BitXor | B::BitOr | B::Shl | B::Shr);
        if is_of_integers && is_integer(left) && is_integer(right) {
            self.require_operator(operator.spelling(), self.span(right));
        }
        match operator {
            B::Add => self.arithmetic(BinaryOp::Add, operands),
            B::Sub => self.arithmetic(BinaryOp::Sub, operands),
            B::Mul => self.arithmetic(BinaryOp::Mul, operands),
            B::Div => self.arithmetic(BinaryOp::Div, operands),
            B::Rem => self.integers(BinaryOp::Rem, operands),
            B::BitAnd => self.integers(BinaryOp::BitAnd, operands),
            B::BitXor => self.integers(BinaryOp::BitXor, operands),
            B::BitOr => self.integers(BinaryOp::BitOr, operands),
            B::Shl => self.shift(BinaryOp::Shl, operands),
            B::Shr => self.shift(BinaryOp::Shr, operands),
            B::Less => self.relation(BinaryOp::Less, operands),
            B::Greater => self.relation(BinaryOp::Greater, operands),
            B::LessEqual => self.relation(BinaryOp::LessEqual, operands),
            B::GreaterEqual => self.relation(BinaryOp::GreaterEqual, operands),
            B::Equal => self.equality(BinaryOp::Equal, operands),
            B::NotEqual => self.equality(BinaryOp::NotEqual, operands),
            B::LogicalXor => (self.ty(left) == TypeId::BOOL && self.ty(right) == TypeId::BOOL).then_some(Typed {
                left,
                right,
                operator: BinaryOp::LogicalXor,
                ty: TypeId::BOOL,
            }),
            B::LogicalAnd | B::LogicalOr => None,
        }
    }

    /// `+ - * /` on numbers of one scalar type, after conversion.
    fn arithmetic(&mut self, operator: BinaryOp, (left, right): (ExprId, ExprId)) -> Option<Typed> {
        let kinds = (self.types.scalar_of(self.ty(left))?, self.types.scalar_of(self.ty(right))?);
        let (left, right) = match kinds {
            (Scalar::Bool, _) | (_, Scalar::Bool) => return None,
            (a, b) if a == b => (left, right),
            (Scalar::Float, _) => (left, self.implicitly_float(right)),
            (_, Scalar::Float) => (self.implicitly_float(left), right),
            (Scalar::Uint, _) if self.conversions().to_uint => (left, self.with_scalar(right, Scalar::Uint)),
            (_, Scalar::Uint) if self.conversions().to_uint => (self.with_scalar(left, Scalar::Uint), right),
            _ => return None,
        };
        let (a, b) = (self.ty(left), self.ty(right));
        let (operator, ty) = match (self.types.get(a), self.types.get(b)) {
            (_, Type::Scalar(_)) => (operator, a),
            (Type::Scalar(_), _) => (operator, b),
            (Type::Vector(..), Type::Vector(..)) if a == b => (operator, a),
            (Type::Matrix(columns, rows), Type::Vector(_, size)) if operator == BinaryOp::Mul && columns == size => {
                (BinaryOp::MatMul, TypeId::vector(Scalar::Float, rows))
            }
            (Type::Vector(_, size), Type::Matrix(columns, rows)) if operator == BinaryOp::Mul && rows == size => {
                (BinaryOp::MatMul, TypeId::vector(Scalar::Float, columns))
            }
            (Type::Matrix(inner, rows), Type::Matrix(columns, other))
                if operator == BinaryOp::Mul && inner == other =>
            {
                (BinaryOp::MatMul, TypeId::matrix(columns, rows))
            }
            (Type::Matrix(..), Type::Matrix(..)) if a == b && operator != BinaryOp::Mul => (operator, a),
            _ => return None,
        };
        Some(Typed { left, right, operator, ty })
    }

    /// An operand of floats, after the implicit conversion.
    fn implicitly_float(&mut self, id: ExprId) -> ExprId {
        self.require_float(id);
        self.with_scalar(id, Scalar::Float)
    }

    /// `% & ^ |` on integers of the same signedness, from 4.00 on after conversion.
    fn integers(&mut self, operator: BinaryOp, (left, right): (ExprId, ExprId)) -> Option<Typed> {
        let kinds = (self.types.scalar_of(self.ty(left))?, self.types.scalar_of(self.ty(right))?);
        let (left, right) = match kinds {
            (Scalar::Uint, Scalar::Int) if self.conversions().to_uint => (left, self.with_scalar(right, Scalar::Uint)),
            (Scalar::Int, Scalar::Uint) if self.conversions().to_uint => (self.with_scalar(left, Scalar::Uint), right),
            _ => (left, right),
        };
        let (a, b) = (self.ty(left), self.ty(right));
        let kind = self.types.scalar_of(a)?;
        if !kind.is_integer() || self.types.scalar_of(b) != Some(kind) {
            return None;
        }
        let ty = match (self.types.get(a), self.types.get(b)) {
            (_, Type::Scalar(_)) => a,
            (Type::Scalar(_), _) => b,
            _ if a == b => a,
            _ => return None,
        };
        Some(Typed { left, right, operator, ty })
    }

    /// `<< >>`: the signedness may differ; a scalar is shifted only by a scalar.
    fn shift(&mut self, operator: BinaryOp, (left, right): (ExprId, ExprId)) -> Option<Typed> {
        let (a, b) = (self.ty(left), self.ty(right));
        let integer = |ty| self.types.scalar_of(ty).is_some_and(Scalar::is_integer);
        let sizes = match (self.types.get(a), self.types.get(b)) {
            (_, Type::Scalar(_)) => true,
            (Type::Vector(_, size), Type::Vector(_, other)) => size == other,
            _ => false,
        };
        (integer(a) && integer(b) && sizes).then_some(Typed { left, right, operator, ty: a })
    }

    /// `< > <= >=` on scalars.
    fn relation(&mut self, operator: BinaryOp, operands: (ExprId, ExprId)) -> Option<Typed> {
        let (left, right) = self.balance(operands)?;
        match self.types.get(self.ty(left)) {
            Type::Scalar(Scalar::Int | Scalar::Uint | Scalar::Float) => {
                Some(Typed { left, right, operator, ty: TypeId::BOOL })
            }
            _ => None,
        }
    }

    /// `== !=` on complete values of one type, except samplers and arrays without a size.
    fn equality(&mut self, operator: BinaryOp, operands: (ExprId, ExprId)) -> Option<Typed> {
        let (left, right) = self.balance(operands)?;
        let ty = self.ty(left);
        let comparable = ty != TypeId::VOID
            && !self.is_opaque(ty)
            && !matches!(self.types.get(ty), Type::Array(_, ArraySize::Unsized));
        self.require_array_value(right, self.span(right));
        if self.types.is_struct_with_array(ty) {
            self.require(Feature::ArraysInValues, self.span(right));
        }
        comparable.then_some(Typed { left, right, operator, ty: TypeId::BOOL })
    }

    /// Converts one of two expressions to the type of the other.
    pub(super) fn balance(&mut self, (left, right): (ExprId, ExprId)) -> Option<(ExprId, ExprId)> {
        let (a, b) = (self.ty(left), self.ty(right));
        if let Some(right) = self.convert(right, a) {
            return Some((left, right));
        }
        self.convert(left, b).map(|left| (left, right))
    }

    /// `a ? b : c`
    pub(super) fn ternary(&mut self, condition: ExprId, yes: ExprId, no: ExprId, span: Span) -> ExprId {
        self.require_bool(condition, "the condition of `?:`");
        let (a, b) = (self.ty(yes), self.ty(no));
        if a.is_error() || b.is_error() || self.ty(condition).is_error() {
            return self.poison(span);
        }
        let unsized_array = |ty| matches!(self.types.get(ty), Type::Array(_, ArraySize::Unsized));
        let opaque = self.is_opaque(a) || unsized_array(a);
        match self.balance((yes, no)) {
            Some((yes, no)) if !opaque => {
                let ty = self.ty(yes);
                if matches!(self.types.get(ty), Type::Array(..)) {
                    self.require(Feature::ArrayObjects, self.span(no));
                }
                // "any type other than an array" (GLSL ES 1.00 §5.9), and compilers count a struct that contains one alike.
                if self.types.is_struct_with_array(ty) {
                    self.require(Feature::ArraysInValues, self.span(no));
                }
                self.push(ExprKind::Ternary(condition, yes, no), ty, span)
            }
            _ => {
                let (a, b) = (self.type_name(a), self.type_name(b));
                let (yes, no) = (self.span(yes), self.span(no));
                let message = if opaque {
                    format!("`?:` cannot choose between values of type `{a}`")
                } else {
                    format!("the two results of `?:` are of different types: `{a}` and `{b}`")
                };
                self.report(
                    Diagnostic::new(&types::OPERANDS, no, message)
                        .here(format!("this is a `{b}`"))
                        .label(yes, format!("this is a `{a}`")),
                );
                self.poison(span)
            }
        }
    }

    /// Whether operators take no value of a type: samplers are only indexed, selected and passed (§4.1.7), and so are the instances of
    /// blocks, whose members alone are variables (§4.3.7).
    pub(super) fn is_opaque(&self, ty: TypeId) -> bool {
        self.types.contains_sampler(ty) || self.types.is_block(ty)
    }

    /// `a, b`
    pub(super) fn comma(&mut self, left: ExprId, right: ExprId, span: Span) -> ExprId {
        let ty = self.ty(right);
        if ty.is_error() || self.ty(left).is_error() {
            return self.poison(span);
        }
        for side in [left, right] {
            if self.is_opaque(self.ty(side)) {
                self.report_operands(",", span, left, right);
                return self.poison(span);
            }
        }
        self.push(ExprKind::Comma(left, right), ty, span)
    }

    /// Adds the help for an assignment as a condition to what was reported about it, from diagnostic `first` on.
    pub(in crate::analysis) fn help_with_assignment(&mut self, first: usize) {
        self.amend(first, |found| {
            if *found.code == types::NOT_AN_LVALUE && found.help.is_none() {
                found.help = Some(ASSIGNS.to_owned());
            }
        });
    }

    /// Reports an expression that is not a scalar `bool`.
    pub(in crate::analysis) fn require_bool(&mut self, id: ExprId, what: &str) {
        let ty = self.ty(id);
        if ty == TypeId::BOOL || ty.is_error() {
            return;
        }
        let (name, span) = (self.type_name(ty), self.span(id));
        let assigned = match self.expr_at(id).kind {
            ExprKind::Assign(None, left, right) => Some((self.span(left), self.span(right))),
            _ => None,
        };
        let help = match self.types.get(ty) {
            _ if assigned.is_some() => Some(ASSIGNS.into()),
            Type::Scalar(scalar) => Some(self.compared(id, scalar)),
            Type::Vector(Scalar::Bool, _) => Some("use `any(...)` or `all(...)`".into()),
            _ => None,
        };
        let mut finding = Diagnostic::new(&types::CONDITION, span, format!("{what} must be a `bool`, not a `{name}`"))
            .here(format!("this is a `{name}`"))
            .maybe_help(help);
        if let Some((left, right)) = assigned {
            let between = Span { start: left.end, end: right.start, ..span };
            // Operands that a macro puts together have something else between them.
            if self.sources.snippet(between).trim() == "=" {
                finding = finding.fix(Fix::new(Applicability::Unsafe, "write `==` to compare", between, " == "));
            }
        }
        self.report(finding);
    }

    /// The comparison of a number with zero, which is what other languages mean by a number as a condition.
    fn compared(&self, id: ExprId, scalar: Scalar) -> Advice {
        let zero = match scalar {
            Scalar::Float => "0.0",
            Scalar::Uint => "0u",
            Scalar::Int | Scalar::Bool => "0",
        };
        use ExprKind::{Assign, Binary, Comma, Ternary};
        let is_compound = matches!(self.expr_at(id).kind, Assign(..) | Binary(..) | Comma(..) | Ternary(..));
        let text = if is_compound { format!("(...) != {zero}") } else { format!("... != {zero}") };
        // A comma may be that of a decimal number: `u < 0,5`.
        let is_comma = matches!(self.expr_at(id).kind, Comma(..));
        let applicability = if is_comma { Applicability::Unsafe } else { Applicability::Safe };
        Advice::new(applicability, format!("compare it: `... != {zero}`"), Place::Around, text)
    }

    /// Reports operands that an operator does not accept.
    pub(super) fn report_operands(&mut self, spelling: &str, at: Span, left: ExprId, right: ExprId) {
        let (a, b) = (self.type_name(self.ty(left)), self.type_name(self.ty(right)));
        let help = self.operand_help(spelling, left, right);
        let (left, right) = (self.span(left), self.span(right));
        self.report(
            Diagnostic::new(&types::OPERANDS, at, format!("`{spelling}` does not take a `{a}` and a `{b}`"))
                .here("no such operation")
                .label(left, format!("this is a `{a}`"))
                .label(right, format!("this is a `{b}`"))
                .maybe_help(help),
        );
    }

    fn operand_help(&self, spelling: &str, left: ExprId, right: ExprId) -> Option<String> {
        let kinds = [left, right].map(|id| (self.types.get(self.ty(id)), self.types.scalar_of(self.ty(id))));
        let vectors = kinds.iter().any(|(ty, _)| matches!(ty, Type::Vector(..)));
        match (spelling, kinds) {
            ("<" | ">" | "<=" | ">=", _) if vectors => {
                Some("compare vectors with `lessThan`, `greaterThan` and so on".into())
            }
            ("%", _) if kinds.iter().any(|(_, scalar)| !matches!(scalar, Some(Scalar::Int | Scalar::Uint))) => {
                Some("`%` is for integers; use `mod(a, b)` for floats".into())
            }
            ("&" | "|" | "^", [(_, Some(Scalar::Bool)), (_, Some(Scalar::Bool))]) => {
                Some(format!("write `{spelling}{spelling}` between booleans"))
            }
            ("*", [(Type::Matrix(columns, rows), _), (Type::Vector(_, size), _)]) if size != columns => Some(format!(
                "the matrix has {columns} columns of {rows} rows: it takes a vector of {columns} components"
            )),
            ("*", [(Type::Vector(_, size), _), (Type::Matrix(columns, rows), _)]) if size != rows => Some(format!(
                "the matrix has {columns} columns of {rows} rows: it takes a vector of {rows} components on its left"
            )),
            ("&&" | "||" | "^^", _) => Some("compare each side first, so that both are a `bool`".into()),
            (_, [(_, Some(Scalar::Int)), (_, Some(Scalar::Uint))]) => {
                Some("write `uint(...)` around the left side".into())
            }
            (_, [(_, Some(Scalar::Uint)), (_, Some(Scalar::Int))]) => {
                Some("write the literal with `u`, or `uint(...)` around the right side".into())
            }
            _ => None,
        }
    }
}

fn unary_spelling(operator: ast::UnaryOp) -> &'static str {
    match operator {
        ast::UnaryOp::Plus => "+",
        ast::UnaryOp::Minus => "-",
        ast::UnaryOp::Not => "!",
        ast::UnaryOp::BitNot => "~",
    }
}
