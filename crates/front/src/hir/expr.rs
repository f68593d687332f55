//! Expressions (§5).

use super::{FunctionId, GlobalId, LocalId, ScalarValue, TypeId};
use crate::builtin::BuiltinFunction;
use crate::source::Span;
use smallvec::{SmallVec, smallvec};

pub use crate::language::IncDec;

/// An expression in a [`Shader`](super::Shader); children have smaller handles than their parents.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ExprId(pub(crate) u32);

impl ExprId {
    /// The place in the arena.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// An expression, its type, and the text it stands for.
#[derive(Clone, Debug)]
pub struct Expr {
    /// Which.
    pub kind: ExprKind,
    /// Its type.
    pub ty: TypeId,
    /// Where.
    pub span: Span,
}

/// A variable that an expression names.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum VarRef {
    /// A global, a built-in variable, or a block (its members are reached by [`ExprKind::Member`], also those of
    /// a block without an instance name).
    Global(GlobalId),
    /// A local or a parameter of the function that the expression stands in.
    Local(LocalId),
}

/// Operators with one operand.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum UnaryOp {
    /// `-a` of scalars, vectors and matrices, component by component.
    Negate,
    /// `!a` of a `bool`.
    Not,
    /// `~a` of integers.
    BitNot,
}

/// Operators with two operands that are both evaluated, left first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[expect(missing_docs, reason = "the names say it")]
pub enum BinaryOp {
    /// Component by component. One operand may be a scalar beside a vector or matrix; else both have one type.
    Add,
    Sub,
    Mul,
    Div,
    Rem,
    /// Matrix times vector, vector times matrix, matrix times matrix.
    MatMul,
    /// Integers; the right operand may be a scalar beside a vector and may differ in sign.
    Shl,
    Shr,
    BitAnd,
    BitXor,
    BitOr,
    /// Scalars, giving `bool`.
    Less,
    Greater,
    LessEqual,
    GreaterEqual,
    /// Whole values of any type but samplers, giving one `bool`.
    Equal,
    NotEqual,
    /// `^^`
    LogicalXor,
}

/// Operators whose right operand is evaluated only if the left one leaves the answer open.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[expect(missing_docs, reason = "the names say it")]
pub enum LogicalOp {
    And,
    Or,
}

/// One to four components of a vector.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Swizzle {
    /// How many.
    pub len: u8,
    /// Which, 0 to 3 each; those past `len` are 0.
    pub components: [u8; 4],
}

impl Swizzle {
    /// The components in use.
    pub fn as_slice(&self) -> &[u8] {
        self.components.get(..usize::from(self.len)).unwrap_or(&[])
    }
}

/// The normal forms of constructors (§5.4). Scalar conversions stand before them as [`ExprKind::Convert`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ConstructKind {
    /// A vector from one scalar of its own component type.
    Splat,
    /// A vector or matrix from scalars, vectors and matrices of its own component type, whose components (matrices by
    /// columns) fill it in order; the last argument may have components left over.
    Compose,
    /// A matrix from one float on its diagonal.
    Diagonal,
    /// A matrix from a matrix; what the argument lacks comes from the identity.
    Resize,
    /// An array, one argument an element.
    Array,
    /// A struct, one argument a member.
    Struct,
}

/// What an expression is. L-values (§5.8) are built from `Var`, `Member`, `Index` and `Swizzle`.
#[derive(Clone, Debug)]
pub enum ExprKind {
    /// Already reported.
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
    /// One operand.
    Unary(UnaryOp, ExprId),
    /// `++`, `--`; the operand is an l-value.
    IncDec(IncDec, ExprId),
    /// Two operands.
    Binary(BinaryOp, ExprId, ExprId),
    /// `&&`, `||`
    Logical(LogicalOp, ExprId, ExprId),
    /// `a ? b : c`: only one of the two is evaluated.
    Ternary(ExprId, ExprId, ExprId),
    /// `a = b`, `a op= b`; the value is that of `a` afterwards. The right side has the type that the operator wants.
    Assign(Option<BinaryOp>, ExprId, ExprId),
    /// `a, b`
    Comma(ExprId, ExprId),
    /// A function of the shader. Arguments are evaluated left to right; those for `out` and `inout` parameters are
    /// l-values, evaluated once, and copied back in the parameters' order after the call (§6.1.1), with a conversion
    /// if the parameter's type differs.
    Call(FunctionId, Vec<ExprId>),
    /// A built-in function. Which overload it is, the arguments' types tell.
    BuiltinCall(BuiltinFunction, Vec<ExprId>),
}

impl ExprKind {
    /// The operands, in the order in which they are evaluated.
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
}
