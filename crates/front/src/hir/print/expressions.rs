//! Prints expressions, with as few parentheses as the precedences (GLSL 1.50 §5.1) allow.

use super::Printer;
use crate::builtin::{BuiltinFunction, functions};
use crate::hir::{
    BinaryOp, Expr, ExprId, ExprKind, IncDec, LogicalOp, ParamMode, ScalarValue, Swizzle, Type, TypeId, UnaryOp, VarRef,
};

/// The precedence of an operator; a larger number binds more tightly.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Precedence(u8);

impl Precedence {
    const COMMA: Self = Self(0);
    const ASSIGN: Self = Self(1);
    const TERNARY: Self = Self(2);
    const OR: Self = Self(3);
    const XOR: Self = Self(4);
    const AND: Self = Self(5);
    const BIT_OR: Self = Self(6);
    const BIT_XOR: Self = Self(7);
    const BIT_AND: Self = Self(8);
    const EQUALITY: Self = Self(9);
    const RELATION: Self = Self(10);
    const SHIFT: Self = Self(11);
    const SUM: Self = Self(12);
    const PRODUCT: Self = Self(13);
    const PREFIX: Self = Self(14);
    const POSTFIX: Self = Self(15);

    fn tighter(self) -> Self {
        Self(self.0 + 1)
    }
}

fn binary(op: BinaryOp) -> (&'static str, Precedence) {
    match op {
        BinaryOp::Add => ("+", Precedence::SUM),
        BinaryOp::Sub => ("-", Precedence::SUM),
        BinaryOp::Mul | BinaryOp::MatMul => ("*", Precedence::PRODUCT),
        BinaryOp::Div => ("/", Precedence::PRODUCT),
        BinaryOp::Rem => ("%", Precedence::PRODUCT),
        BinaryOp::Shl => ("<<", Precedence::SHIFT),
        BinaryOp::Shr => (">>", Precedence::SHIFT),
        BinaryOp::BitAnd => ("&", Precedence::BIT_AND),
        BinaryOp::BitXor => ("^", Precedence::BIT_XOR),
        BinaryOp::BitOr => ("|", Precedence::BIT_OR),
        BinaryOp::Less => ("<", Precedence::RELATION),
        BinaryOp::Greater => (">", Precedence::RELATION),
        BinaryOp::LessEqual => ("<=", Precedence::RELATION),
        BinaryOp::GreaterEqual => (">=", Precedence::RELATION),
        BinaryOp::Equal => ("==", Precedence::EQUALITY),
        BinaryOp::NotEqual => ("!=", Precedence::EQUALITY),
        BinaryOp::LogicalXor => ("^^", Precedence::XOR),
    }
}

/// A literal that parses to the same bits.
pub(super) fn literal(value: ScalarValue) -> String {
    match value {
        ScalarValue::Bool(value) => value.to_string(),
        ScalarValue::Int(i32::MIN) => "0x80000000".into(),
        ScalarValue::Int(value) => value.to_string(),
        ScalarValue::Uint(value) => format!("{value}u"),
        ScalarValue::Float(value) if value.is_nan() => "0.0 / 0.0".into(),
        // A number outside the range of f32 parses to an infinity.
        ScalarValue::Float(value) if value.is_infinite() => (if value > 0.0 { "1e39" } else { "-1e39" }).into(),
        ScalarValue::Float(value) => {
            let text = format!("{value:?}");
            if text.contains(['.', 'e']) { text } else { format!("{text}.0") }
        }
    }
}

fn literal_precedence(value: ScalarValue) -> Precedence {
    match value {
        ScalarValue::Int(value) if value < 0 && value != i32::MIN => Precedence::PREFIX,
        ScalarValue::Float(value) if value.is_nan() => Precedence::PRODUCT,
        ScalarValue::Float(value) if value.is_sign_negative() => Precedence::PREFIX,
        ScalarValue::Bool(_) | ScalarValue::Int(_) | ScalarValue::Uint(_) | ScalarValue::Float(_) => {
            Precedence::POSTFIX
        }
    }
}

impl Printer<'_> {
    /// A whole expression.
    pub(super) fn expr(&self, id: ExprId) -> String {
        let mut text = String::new();
        self.write(id, Precedence::COMMA, &mut text);
        text
    }

    /// An expression in a comma-separated list.
    pub(super) fn argument(&self, id: ExprId) -> String {
        let mut text = String::new();
        self.write(id, Precedence::ASSIGN, &mut text);
        text
    }

    /// Writes an expression where operators bind at least as tightly as `outer`.
    fn write(&self, id: ExprId, outer: Precedence, text: &mut String) {
        let expr = self.shader.expr(id);
        let own = self.precedence(expr);
        if own < outer {
            text.push('(');
        }
        self.write_bare(expr, own, text);
        if own < outer {
            text.push(')');
        }
    }

    fn precedence(&self, expr: &Expr) -> Precedence {
        match &expr.kind {
            ExprKind::Literal(value) => literal_precedence(*value),
            ExprKind::Binary(op, ..) => binary(*op).1,
            ExprKind::Logical(LogicalOp::And, ..) => Precedence::AND,
            ExprKind::Logical(LogicalOp::Or, ..) => Precedence::OR,
            ExprKind::Ternary(..) => Precedence::TERNARY,
            ExprKind::Assign(..) => Precedence::ASSIGN,
            ExprKind::Comma(..) => Precedence::COMMA,
            ExprKind::Unary(..) => Precedence::PREFIX,
            ExprKind::IncDec(IncDec::PreIncrement | IncDec::PreDecrement, _) => Precedence::PREFIX,
            ExprKind::Error
            | ExprKind::Var(_)
            | ExprKind::Member(..)
            | ExprKind::Index(..)
            | ExprKind::Swizzle(..)
            | ExprKind::Convert(_)
            | ExprKind::Construct(..)
            | ExprKind::IncDec(..)
            | ExprKind::Call(..)
            | ExprKind::BuiltinCall(..) => Precedence::POSTFIX,
        }
    }

    fn write_bare(&self, expr: &Expr, own: Precedence, text: &mut String) {
        match &expr.kind {
            ExprKind::Error => text.push_str("<error>"),
            ExprKind::Literal(value) => text.push_str(&literal(*value)),
            ExprKind::Var(variable) => text.push_str(self.variable_name(*variable)),
            ExprKind::Member(base, member) => self.write_member(*base, *member, text),
            ExprKind::Index(base, index) => {
                self.write(*base, Precedence::POSTFIX, text);
                text.push('[');
                self.write(*index, Precedence::COMMA, text);
                text.push(']');
            }
            ExprKind::Swizzle(base, swizzle) => self.write_swizzle(expr, *base, *swizzle, text),
            ExprKind::Convert(inner) => self.write_call(&self.type_name(expr.ty), &[*inner], text),
            ExprKind::Construct(_, arguments) => self.write_construct(expr.ty, arguments, text),
            ExprKind::Unary(op, operand) => self.write_unary(*op, *operand, text),
            ExprKind::IncDec(op, operand) => self.write_inc_dec(*op, *operand, text),
            ExprKind::Binary(op, left, right) => self.write_binary(binary(*op).0, own, *left, *right, text),
            ExprKind::Logical(op, left, right) => {
                let word = if *op == LogicalOp::And { "&&" } else { "||" };
                self.write_binary(word, own, *left, *right, text);
            }
            ExprKind::Ternary(condition, yes, no) => {
                self.write(*condition, Precedence::OR, text);
                text.push_str(" ? ");
                self.write(*yes, Precedence::ASSIGN, text);
                text.push_str(" : ");
                self.write(*no, Precedence::ASSIGN.max(Precedence::TERNARY), text);
            }
            ExprKind::Assign(op, target, value) => {
                self.write(*target, Precedence::PREFIX, text);
                text.push(' ');
                text.push_str(op.map_or("", |op| binary(op).0));
                text.push_str("= ");
                self.write(*value, Precedence::ASSIGN, text);
            }
            ExprKind::Comma(left, right) => {
                self.write(*left, Precedence::COMMA, text);
                text.push_str(", ");
                self.write(*right, Precedence::ASSIGN, text);
            }
            ExprKind::Call(function, arguments) => self.write_call(self.names.function(*function), arguments, text),
            ExprKind::BuiltinCall(function, arguments) => {
                self.write_call(self.builtin_name(*function, expr.ty, arguments), arguments, text);
            }
        }
    }

    fn variable_name(&self, variable: VarRef) -> &str {
        match variable {
            VarRef::Global(id) => self.names.global(id),
            VarRef::Local(id) => self.function.map_or("", |function| self.names.local(function, id)),
        }
    }

    /// Writes a member; in a block without an instance name, the member is a name of its own.
    fn write_member(&self, base: ExprId, member: u32, text: &mut String) {
        let base_expr = self.shader.expr(base);
        let nameless = match base_expr.kind {
            ExprKind::Var(VarRef::Global(id)) => self.names.global(id).is_empty(),
            _ => false,
        };
        if !nameless {
            self.write(base, Precedence::POSTFIX, text);
            text.push('.');
        }
        if let Type::Struct(id) = self.types.get(base_expr.ty)
            && let Some(member) = self.types.structure(id).members.get(member as usize)
        {
            text.push_str(&member.name);
        }
    }

    /// Writes a swizzle; components of a scalar (ARB_shading_language_420pack) become a constructor.
    fn write_swizzle(&self, expr: &Expr, base: ExprId, swizzle: Swizzle, text: &mut String) {
        if matches!(self.types.get(self.shader.expr(base).ty), Type::Scalar(_)) {
            self.write_call(&self.type_name(expr.ty), &[base], text);
            return;
        }
        self.write(base, Precedence::POSTFIX, text);
        text.push('.');
        text.extend(swizzle.as_slice().iter().filter_map(|&component| "xyzw".chars().nth(usize::from(component))));
    }

    fn write_construct(&self, ty: TypeId, arguments: &[ExprId], text: &mut String) {
        // A conversion is already written as a constructor: `vec2(i)`, not `vec2(vec2(i))`.
        if let [argument] = arguments
            && let Expr { kind: ExprKind::Convert(inner), ty: converted, .. } = self.shader.expr(*argument)
            && *converted == ty
        {
            self.write_call(&self.type_name(ty), &[*inner], text);
            return;
        }
        self.write_call(&self.type_name(ty), arguments, text);
    }

    fn write_call(&self, name: &str, arguments: &[ExprId], text: &mut String) {
        text.push_str(name);
        text.push('(');
        for (index, &argument) in arguments.iter().enumerate() {
            if index > 0 {
                text.push_str(", ");
            }
            self.write(argument, Precedence::ASSIGN, text);
        }
        text.push(')');
    }

    fn write_unary(&self, op: UnaryOp, operand: ExprId, text: &mut String) {
        let start = text.len();
        text.push(match op {
            UnaryOp::Negate => '-',
            UnaryOp::Not => '!',
            UnaryOp::BitNot => '~',
        });
        self.write(operand, Precedence::PREFIX, text);
        // `- -a` must not become `--a`.
        if text.get(start..).is_some_and(|written| written.starts_with("--")) {
            text.insert(start + 1, ' ');
        }
    }

    fn write_inc_dec(&self, op: IncDec, operand: ExprId, text: &mut String) {
        match op {
            IncDec::PreIncrement | IncDec::PreDecrement => {
                text.push_str(if op == IncDec::PreIncrement { "++" } else { "--" });
                self.write(operand, Precedence::PREFIX, text);
            }
            IncDec::PostIncrement | IncDec::PostDecrement => {
                self.write(operand, Precedence::POSTFIX, text);
                text.push_str(if op == IncDec::PostIncrement { "++" } else { "--" });
            }
        }
    }

    fn write_binary(&self, word: &str, own: Precedence, left: ExprId, right: ExprId, text: &mut String) {
        self.write(left, own, text);
        text.push(' ');
        text.push_str(word);
        text.push(' ');
        self.write(right, own.tighter(), text);
    }

    /// Whether the shader calls something else by the name of a function, as sources of 1.20 may: `uniform sampler2D
    /// texture;`.
    fn is_hidden(&self, name: &str) -> bool {
        let shader = self.shader;
        let mut locals = shader.functions.iter().flat_map(|function| &function.locals);
        shader.globals.iter().any(|global| global.name == name)
            || shader.functions.iter().any(|function| function.name == name)
            || locals.any(|local| local.name == name)
    }

    /// The name whose row has these types: `shadow2D` returns a `vec4`, `texture` of the same sampler a `float`.
    fn builtin_name(&self, function: BuiltinFunction, ret: TypeId, arguments: &[ExprId]) -> &'static str {
        let types: Vec<(TypeId, ParamMode)> =
            arguments.iter().map(|&id| (self.shader.expr(id).ty, ParamMode::In)).collect();
        let fits = |signature: &functions::Signature| {
            let params = signature.params();
            signature.ret == ret
                && params.len() == types.len()
                && params.iter().zip(&types).all(|((param, _), (argument, _))| param == argument)
        };
        let rows = || functions::all().filter(|row| row.function == function);
        // The extension of older versions has its own spelling.
        let extended = function == BuiltinFunction::TextureQueryLod && self.shader.version.number < 400;
        let modern =
            rows().filter(|row| !row.deprecated).any(|row| row.signatures(self.shader.stage).any(|s| fits(&s)));
        if modern && !extended && !self.is_hidden(function.name()) {
            return function.name();
        }
        let old = rows().find(|row| row.deprecated && row.signatures(self.shader.stage).any(|s| fits(&s)));
        old.map_or(function.name(), |row| row.name)
    }
}
