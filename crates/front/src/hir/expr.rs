//! Typed expressions (§5).
//!
//! *Holds:* an expression has a smaller handle than its parent; conversions are explicit; constructors are in normal
//! form.

use super::{FunctionId, GlobalId, LocalId, ScalarValue, TypeId};
use crate::builtin::BuiltinFunction;
use crate::source::Span;
use smallvec::{SmallVec, smallvec};

pub use crate::language::IncDec;

/// The handle of an expression in a [`Shader`](super::Shader). Children have smaller handles than their parents.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ExprId(pub(crate) u32);

impl ExprId {
    /// The index in the arena.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// An expression with its type and its span.
#[derive(Clone, Debug, Hash)]
pub struct Expr {
    /// The kind.
    pub kind: ExprKind,
    /// The type.
    pub ty: TypeId,
    /// The span.
    pub span: Span,
}

/// A variable that an expression refers to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum VarRef {
    /// A global, a built-in variable, or a block. [`ExprKind::Member`] reaches the members of a block, also of one
    /// without an instance name.
    Global(GlobalId),
    /// A local or a parameter of the function that contains the expression.
    Local(LocalId),
}

/// The unary operators.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum UnaryOp {
    /// `-a` of scalars, vectors and matrices, component by component.
    Negate,
    /// `!a` of a `bool`.
    Not,
    /// `~a` of integers.
    BitNot,
}

/// The binary operators that evaluate both operands, left first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[expect(missing_docs, reason = "the names say it")]
pub enum BinaryOp {
    /// Component by component. One operand may be a scalar and the other a vector or matrix; otherwise both have one
    /// type.
    Add,
    Sub,
    Mul,
    Div,
    Rem,
    /// Matrix times vector, vector times matrix, matrix times matrix.
    MatMul,
    /// On integers. The right operand may be a scalar when the left one is a vector, and may differ in signedness.
    Shl,
    Shr,
    BitAnd,
    BitXor,
    BitOr,
    /// On scalars; the result is a `bool`.
    Less,
    Greater,
    LessEqual,
    GreaterEqual,
    /// On complete values of any type but samplers; the result is one `bool`.
    Equal,
    NotEqual,
    /// `^^`
    LogicalXor,
}

/// The operators that evaluate the right operand only if the left one does not decide the result.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[expect(missing_docs, reason = "the names say it")]
pub enum LogicalOp {
    And,
    Or,
}

/// One to four components of a vector.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Swizzle {
    /// The number of components.
    pub len: u8,
    /// The index of each component, 0 to 3; entries past `len` are 0.
    pub components: [u8; 4],
}

impl Swizzle {
    /// The components in use.
    pub fn as_slice(&self) -> &[u8] {
        self.components.get(..usize::from(self.len)).unwrap_or(&[])
    }

    /// Whether a component is named twice, so that nothing can be assigned to it.
    pub(crate) fn has_repeats(&self) -> bool {
        let all = self.as_slice();
        all.iter().enumerate().any(|(index, component)| all.iter().take(index).any(|other| other == component))
    }
}

/// The normal forms of constructors (§5.4). Scalar conversions are separate [`ExprKind::Convert`]s in the arguments.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ConstructKind {
    /// A vector from one scalar of its own component type.
    Splat,
    /// A vector or matrix from scalars, vectors and matrices of its own component type. Their components (those of
    /// matrices by columns) fill it in order; the last argument may have excess components.
    Compose,
    /// A matrix from one float on its diagonal.
    Diagonal,
    /// A matrix from a matrix; elements that the argument lacks come from the identity.
    Resize,
    /// An array, with one argument for each element.
    Array,
    /// A struct, with one argument for each member.
    Struct,
}

/// The kinds of expressions. L-values (§5.8) are built from `Var`, `Member`, `Index` and `Swizzle`.
#[derive(Clone, Debug, Hash)]
pub enum ExprKind {
    /// An expression in error, which has been reported.
    Error,
    /// A literal.
    Literal(ScalarValue),
    /// A variable.
    Var(VarRef),
    /// A member of a struct or block.
    Member(ExprId, u32),
    /// An element of an array, a column of a matrix, a component of a vector. The index is `int` or `uint`.
    Index(ExprId, ExprId),
    /// Components of a vector.
    Swizzle(ExprId, Swizzle),
    /// The component-wise conversion of a scalar, vector or matrix to the scalar type of the expression's own type,
    /// implicit (§4.1.10) or by a constructor (§5.4.1).
    Convert(ExprId),
    /// A constructor.
    Construct(ConstructKind, Vec<ExprId>),
    /// A unary operation.
    Unary(UnaryOp, ExprId),
    /// `++` or `--`; the operand is an l-value.
    IncDec(IncDec, ExprId),
    /// A binary operation.
    Binary(BinaryOp, ExprId, ExprId),
    /// `&&`, `||`
    Logical(LogicalOp, ExprId, ExprId),
    /// `a ? b : c`: evaluates only one of `b` and `c`.
    Ternary(ExprId, ExprId, ExprId),
    /// `a = b` or `a op= b`. The value is that of `a` afterwards. The right side has the type that the operator
    /// requires.
    Assign(Option<BinaryOp>, ExprId, ExprId),
    /// `a, b`
    Comma(ExprId, ExprId),
    /// A call of a function of the shader. Arguments are evaluated left to right. Those for `out` and `inout`
    /// parameters are l-values; they are evaluated once, and after the call the results are copied back in the order
    /// of the parameters (§6.1.1), with a conversion if the parameter's type differs.
    Call(FunctionId, Vec<ExprId>),
    /// A call of a built-in function. The types of the arguments determine the overload.
    BuiltinCall(BuiltinFunction, Vec<ExprId>),
}

impl ExprKind {
    /// The operands, in evaluation order.
    pub fn children(&self) -> SmallVec<[ExprId; 4]> {
        match self {
            Self::Error | Self::Literal(_) | Self::Var(_) => SmallVec::new(),
            Self::Member(a, _) | Self::Swizzle(a, _) | Self::Convert(a) | Self::Unary(_, a) | Self::IncDec(_, a) => {
                smallvec![*a]
            }
            Self::Index(a, b)
            | Self::Binary(_, a, b)
            | Self::Logical(_, a, b)
            | Self::Assign(_, a, b)
            | Self::Comma(a, b) => smallvec![*a, *b],
            Self::Ternary(a, b, c) => smallvec![*a, *b, *c],
            Self::Construct(_, list) | Self::Call(_, list) | Self::BuiltinCall(_, list) => SmallVec::from_slice(list),
        }
    }

    /// Puts the operands on a stack, the last one first: what is taken next is the first.
    pub(super) fn push_operands(&self, stack: &mut SmallVec<[ExprId; 32]>) {
        match self {
            Self::Error | Self::Literal(_) | Self::Var(_) => {}
            Self::Member(a, _) | Self::Swizzle(a, _) | Self::Convert(a) | Self::Unary(_, a) | Self::IncDec(_, a) => {
                stack.push(*a);
            }
            Self::Index(a, b)
            | Self::Binary(_, a, b)
            | Self::Logical(_, a, b)
            | Self::Assign(_, a, b)
            | Self::Comma(a, b) => stack.extend_from_slice(&[*b, *a]),
            Self::Ternary(a, b, c) => stack.extend_from_slice(&[*c, *b, *a]),
            Self::Construct(_, list) | Self::Call(_, list) | Self::BuiltinCall(_, list) => {
                stack.extend(list.iter().rev().copied());
            }
        }
    }

    /// Calls `f` with each operand, in evaluation order, to change it.
    pub fn for_each_operand(&mut self, f: &mut dyn FnMut(&mut ExprId)) {
        match self {
            Self::Error | Self::Literal(_) | Self::Var(_) => {}
            Self::Member(a, _) | Self::Swizzle(a, _) | Self::Convert(a) | Self::Unary(_, a) | Self::IncDec(_, a) => {
                f(a)
            }
            Self::Index(a, b)
            | Self::Binary(_, a, b)
            | Self::Logical(_, a, b)
            | Self::Assign(_, a, b)
            | Self::Comma(a, b) => {
                f(a);
                f(b);
            }
            Self::Ternary(a, b, c) => {
                f(a);
                f(b);
                f(c);
            }
            Self::Construct(_, list) | Self::Call(_, list) | Self::BuiltinCall(_, list) => list.iter_mut().for_each(f),
        }
    }
}
