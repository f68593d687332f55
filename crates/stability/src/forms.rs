//! Stable forms of what several exponentials make up: a quotient, a logarithm of a sum, a share of a sum.
//!
//! *In:* the expression of a cause. *Out:* the expression that it is a part of, if that has a stable form, and the parts of the form.
//! *Holds:* a local that is given one value stands for it, if that is made of what never changes. The exponentials themselves may leave
//! the range of f32; a stable form has none of a positive argument.

use glisten_front::builtin::BuiltinFunction as B;
use glisten_front::hir::{
    BinaryOp, ExprId, ExprKind, Function, LocalId, ScalarValue, Shader, StmtKind, VarRef, written_by,
};
use std::collections::{BTreeMap, BTreeSet};

/// An expression that has a stable form.
#[derive(Clone, Copy, Debug)]
pub(super) struct Around {
    /// The expression.
    pub(super) whole: ExprId,
    form: Form,
    /// Whether the base is 2.
    is_binary: bool,
}

/// A stable form by the arguments of its exponentials; `None` for the argument of a number 1.
#[derive(Clone, Copy, Debug)]
enum Form {
    /// `exp(a) / exp(b)`
    Quotient(ExprId, ExprId),
    /// `log(exp(a) + exp(b))`
    LogOfSum(ExprId, Option<ExprId>),
    /// `exp(a) / (exp(a) + exp(b))`
    Share(ExprId, Option<ExprId>),
}

impl Around {
    /// The help: the form to write instead.
    pub(super) fn advice(self) -> &'static str {
        match self.form {
            Form::Quotient(..) => {
                "the exponentials leave the range of f32 before their quotient does: take one of the difference, `exp(a - b)`"
            }
            Form::LogOfSum(..) => {
                "the exponentials leave the range of f32 before the logarithm of their sum does: write `max(a, b) + log(1.0 + exp(-abs(a - \
                 b)))`, with 0 for `a` where the sum has a 1: `max(x, 0.0) + log(1.0 + exp(-abs(x)))`"
            }
            Form::Share(..) => {
                "the exponentials leave the range of f32 before their quotient does: write `1.0 / (1.0 + exp(b - a))`, and `1.0 / (1.0 + \
                 exp(-x))` for a sigmoid"
            }
        }
    }

    /// The text of the stable form, by the texts of operands.
    pub(super) fn text(self, text: &dyn Fn(ExprId) -> Option<String>) -> Option<String> {
        let (exp, log) = if self.is_binary { ("exp2", "log2") } else { ("exp", "log") };
        Some(match self.form {
            Form::Quotient(a, b) => format!("{exp}({} - {})", text(a)?, text(b)?),
            Form::LogOfSum(a, None) => format!("(max({x}, 0.0) + {log}(1.0 + {exp}(-abs({x}))))", x = text(a)?),
            Form::LogOfSum(a, Some(b)) => {
                let (a, b) = (text(a)?, text(b)?);
                format!("(max({a}, {b}) + {log}(1.0 + {exp}(-abs({a} - {b}))))")
            }
            Form::Share(a, None) => format!("(1.0 / (1.0 + {exp}(-{})))", text(a)?),
            Form::Share(a, Some(b)) => format!("(1.0 / (1.0 + {exp}({} - {})))", text(b)?, text(a)?),
        })
    }
}

/// The first expression with a stable form that another one is a part of.
pub(super) fn around(shader: &Shader, part: ExprId) -> Option<Around> {
    let function = shader.functions().map(|(_, function)| function).find(|function| {
        let mut is_inside = false;
        let body = function.body.as_deref().unwrap_or(&[]);
        shader.visit_body(body, &mut |expr| is_inside |= expr == part);
        is_inside
    })?;
    let values = Values::of(shader, function);
    let mut found = None;
    shader.visit_body(function.body.as_deref().unwrap_or(&[]), &mut |whole| {
        if found.is_none()
            && let Some((form, is_binary, parts)) = values.form(whole)
            && (whole == part || parts.contains(&part))
        {
            found = Some(Around { whole, form, is_binary });
        }
    });
    found
}

/// The values that locals of a function stand for.
struct Values<'a> {
    shader: &'a Shader,
    definitions: BTreeMap<LocalId, ExprId>,
    written: BTreeSet<LocalId>,
}

impl<'a> Values<'a> {
    fn of(shader: &'a Shader, function: &Function) -> Self {
        let (mut definitions, mut written) = (BTreeMap::new(), BTreeSet::new());
        let body = function.body.as_deref().unwrap_or(&[]);
        shader.visit_statements(body, &mut |statement| {
            if let StmtKind::Local(local, Some(value)) = statement.kind {
                definitions.insert(local, value);
            }
        });
        shader.visit_body(body, &mut |expr| {
            written_by(shader, expr, &mut |target| {
                if let Some(VarRef::Local(local)) = shader.root_variable(target) {
                    written.insert(local);
                }
            });
        });
        Self { shader, definitions, written }
    }

    /// The expression that another one stands for.
    fn meaning(&self, id: ExprId) -> ExprId {
        let mut at = id;
        loop {
            at = match self.shader.expr(at).kind {
                ExprKind::Convert(inner) => inner,
                ExprKind::Var(VarRef::Local(local)) if !self.written.contains(&local) => {
                    match self.definitions.get(&local) {
                        Some(value) if self.keeps(*value) => *value,
                        _ => return at,
                    }
                }
                _ => return at,
            };
        }
    }

    /// Whether an expression is made of what never changes.
    fn keeps(&self, id: ExprId) -> bool {
        let mut keeps = true;
        self.shader.visit_expr(id, &mut |inner| match self.shader.expr(inner).kind {
            ExprKind::Var(VarRef::Local(local)) => keeps &= !self.written.contains(&local),
            ExprKind::Var(VarRef::Global(global)) => keeps &= !self.shader.global(global).written,
            ExprKind::Call(..) => keeps = false,
            _ => {}
        });
        keeps
    }

    /// The form of an expression, whether its base is 2, and the expressions that it is made of.
    fn form(&self, whole: ExprId) -> Option<(Form, bool, Vec<ExprId>)> {
        match &self.shader.expr(whole).kind {
            ExprKind::Binary(BinaryOp::Div, over, under) => {
                let (over, under) = (self.meaning(*over), self.meaning(*under));
                let (a, is_binary) = self.exponential(over)?;
                if let Some((b, true)) = self.exponential(under).map(|(b, base)| (b, base == is_binary)) {
                    return Some((Form::Quotient(a, b), is_binary, vec![over, under]));
                }
                let sum = self.sum(under, is_binary)?;
                let is_over = |term: &Term| term.argument.is_some() && self.is_same(term.id, over);
                let other = match &sum {
                    [first, second] if is_over(first) => second,
                    [first, second] if is_over(second) => first,
                    _ => return None,
                };
                let parts = [over, under].into_iter().chain(sum.iter().map(|term| term.id)).collect();
                Some((Form::Share(a, other.argument), is_binary, parts))
            }
            ExprKind::BuiltinCall(function @ (B::Log | B::Log2), list) => {
                let under = self.meaning(*list.first()?);
                let is_binary = *function == B::Log2;
                let [first, second] = self.sum(under, is_binary)?;
                let (a, b) = match (first.argument, second.argument) {
                    (Some(a), b) => (a, b),
                    (None, Some(b)) => (b, None),
                    (None, None) => return None,
                };
                Some((Form::LogOfSum(a, b), is_binary, vec![under, first.id, second.id]))
            }
            _ => None,
        }
    }

    /// Whether two expressions are one, or written alike of what never changes.
    fn is_same(&self, a: ExprId, b: ExprId) -> bool {
        a == b || glisten_front::hir::same_value(self.shader, a, b) && self.keeps(a)
    }

    /// The argument of an exponential, and whether its base is 2.
    fn exponential(&self, id: ExprId) -> Option<(ExprId, bool)> {
        match &self.shader.expr(id).kind {
            ExprKind::BuiltinCall(function @ (B::Exp | B::Exp2), list) => Some((*list.first()?, *function == B::Exp2)),
            _ => None,
        }
    }

    /// The terms of a sum of two exponentials, or of one and 1.
    fn sum(&self, id: ExprId, is_binary: bool) -> Option<[Term; 2]> {
        let ExprKind::Binary(BinaryOp::Add, a, b) = self.shader.expr(id).kind else { return None };
        let term = |id: ExprId| {
            let id = self.meaning(id);
            match (self.exponential(id), &self.shader.expr(id).kind) {
                (Some((argument, base)), _) => (base == is_binary).then_some(Term { id, argument: Some(argument) }),
                (None, ExprKind::Literal(ScalarValue::Float(1.0))) => Some(Term { id, argument: None }),
                _ => None,
            }
        };
        Some([term(a)?, term(b)?])
    }
}

/// A term of a sum, and the argument of the exponential that it is.
#[derive(Clone, Copy)]
struct Term {
    id: ExprId,
    argument: Option<ExprId>,
}
