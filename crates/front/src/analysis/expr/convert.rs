//! Implicit conversions (§4.1.10): none in 1.10 and ES, integers to `float` from 1.20 on, `int` to `uint` from 4.00 on.
//!
//! *Holds:* a conversion is an expression of its own in the typed program; nothing later converts.

use super::super::context::Analyzer;
use crate::diagnostic::codes::types;
use crate::diagnostic::{Advice, Applicability, Diagnostic, Place};
use crate::hir::{ArraySize, ExprId, ExprKind, Scalar, Type, TypeId, Types};
use crate::language::Feature;

/// The implicit conversions of a language.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::analysis) struct Conversions {
    /// Integers to `float`, from 1.20 on.
    pub(in crate::analysis) to_float: bool,
    /// `int` to `uint`, from 4.00 on.
    pub(in crate::analysis) to_uint: bool,
}

impl Conversions {
    /// Whether one type converts implicitly to another. A type does not convert to itself.
    pub(in crate::analysis) fn convert(self, types: &Types, from: TypeId, to: TypeId) -> bool {
        match (types.get(from), types.get(to)) {
            (Type::Scalar(from), Type::Scalar(to)) => self.scalars(from, to),
            (Type::Vector(from, size), Type::Vector(to, other)) => size == other && self.scalars(from, to),
            _ => false,
        }
    }

    fn scalars(self, from: Scalar, to: Scalar) -> bool {
        match (from, to) {
            (Scalar::Int | Scalar::Uint, Scalar::Float) => self.to_float,
            (Scalar::Int, Scalar::Uint) => self.to_uint,
            _ => false,
        }
    }
}

impl Analyzer<'_> {
    /// The implicit conversions at the current declaration.
    pub(in crate::analysis) fn conversions(&self) -> Conversions {
        let has = |feature| self.ast.version.has_with(feature, self.extensions);
        Conversions { to_float: has(Feature::ImplicitToFloat), to_uint: has(Feature::ImplicitToUint) }
    }

    /// The expression converted to a type; `None` if there is no such conversion.
    pub(in crate::analysis) fn convert(&mut self, id: ExprId, to: TypeId) -> Option<ExprId> {
        let from = self.ty(id);
        if from == to || from.is_error() || to.is_error() {
            return Some(id);
        }
        if self.conversions().convert(self.types, from, to) {
            return Some(self.push_convert(id, to));
        }
        let of_later = Conversions { to_float: true, to_uint: false };
        if of_later.convert(self.types, from, to) {
            self.require_float(id);
            return Some(self.push_convert(id, to));
        }
        None
    }

    /// Like [`Self::convert`], but reports an expression that does not convert; `what` must be a `to`.
    pub(in crate::analysis) fn convert_or_report(&mut self, id: ExprId, to: TypeId, what: &str) -> ExprId {
        if let Some(converted) = self.convert(id, to) {
            return converted;
        }
        let (from, span) = (self.ty(id), self.span(id));
        let (from_name, to_name) = (self.type_name(from), self.type_name(to));
        let finding =
            Diagnostic::new(&types::MISMATCH, span, format!("{what} is a `{to_name}` and cannot hold a `{from_name}`"));
        let finding = finding.here(format!("this is a `{from_name}`")).maybe_help(self.conversion_help(from, to, span));
        self.report(finding);
        self.poison(span)
    }

    /// A help text with the constructor that would fix a mismatch, if there is one.
    pub(in crate::analysis) fn conversion_help(
        &self,
        from: TypeId,
        to: TypeId,
        span: crate::source::Span,
    ) -> Option<Advice> {
        let name = self.type_name(to);
        let text = self.sources.snippet(span);
        if let (Type::Scalar(Scalar::Float), Type::Scalar(whole @ (Scalar::Int | Scalar::Uint))) =
            (self.types.get(from), self.types.get(to))
            && let Some(number) = whole_literal(text).filter(|_| !span.expansion.is_some())
            && (number.parse::<i32>().is_ok() || whole == Scalar::Uint && number.parse::<u32>().is_ok())
        {
            let suffix = if whole == Scalar::Uint { "u" } else { "" };
            return Some(Advice::write(Applicability::Safe, format!("{number}{suffix}")));
        }
        if !span.expansion.is_some()
            && let Some(count) = comma_values(text)
        {
            return self.constructor_of_values(count, to, text);
        }
        let short = if text.is_empty() || text.len() > 40 || span.expansion.is_some() { "..." } else { text };
        let around = |arguments: &str| {
            let call = |inner: &str| format!("{name}({})", arguments.replace("...", inner));
            Some(Advice::new(Applicability::Unsafe, format!("write `{}`", call(short)), Place::Around, call("...")))
        };
        match (self.types.get(from), self.types.get(to)) {
            (Type::Scalar(_), Type::Scalar(_) | Type::Vector(..)) => around("..."),
            (Type::Vector(_, from), Type::Vector(_, to)) if from >= to => around("..."),
            (Type::Vector(_, 3), Type::Vector(_, 4)) => around("..., 1.0"),
            (Type::Matrix(..), Type::Matrix(..)) => around("..."),
            (Type::Array(_, ArraySize::Unsized), _) => Some("give the array a size in its declaration".into()),
            _ => None,
        }
    }

    /// The help for `(a, b, c)`, the last of whose values counts: the constructor that is meant takes all of them.
    fn constructor_of_values(&self, count: usize, to: TypeId, text: &str) -> Option<Advice> {
        let is_meant = match self.types.get(to) {
            Type::Vector(_, size) => usize::from(size) == count,
            Type::Matrix(columns, rows) => usize::from(columns) * usize::from(rows) == count,
            _ => false,
        };
        let name = self.type_name(to);
        let shown = if text.len() > 40 { "(..)" } else { text };
        let sentence = format!("write `{name}{shown}`");
        is_meant.then(|| Advice::new(Applicability::Unsafe, sentence, Place::Before, name))
    }

    /// Converts a numeric or boolean value component by component, as constructors do (§5.4.1).
    pub(in crate::analysis) fn with_scalar(&mut self, id: ExprId, scalar: Scalar) -> ExprId {
        let ty = match self.types.get(self.ty(id)) {
            Type::Scalar(from) if from != scalar => TypeId::vector(scalar, 1),
            Type::Vector(from, size) if from != scalar => TypeId::vector(scalar, size),
            _ => return id,
        };
        self.push_convert(id, ty)
    }

    fn push_convert(&mut self, id: ExprId, to: TypeId) -> ExprId {
        let span = self.span(id);
        self.push(ExprKind::Convert(id), to, span)
    }
}

/// How many values are between the parentheses of `(a, b, c)`, if there are several.
fn comma_values(text: &str) -> Option<usize> {
    let inner = text.strip_prefix('(')?.strip_suffix(')')?;
    let (mut depth, mut count) = (0_u32, 1);
    for letter in inner.chars() {
        match letter {
            '(' | '[' | '{' => depth += 1,
            ')' | ']' | '}' => depth = depth.checked_sub(1)?,
            ',' if depth == 0 => count += 1,
            _ => {}
        }
    }
    (count > 1).then_some(count)
}

/// The digits before the point of a literal that is a whole number: `1` for `1.0`, `1.` and `1.0f`.
fn whole_literal(text: &str) -> Option<&str> {
    let (whole, fraction) = text.strip_suffix(['f', 'F']).unwrap_or(text).split_once('.')?;
    let is_whole = !whole.is_empty() && whole.bytes().all(|digit| digit.is_ascii_digit());
    // A leading zero would make it octal.
    let is_plain = whole == "0" || !whole.starts_with('0');
    (is_whole && is_plain && fraction.bytes().all(|digit| digit == b'0')).then_some(whole)
}
