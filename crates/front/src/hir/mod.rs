//! The typed program: what a shader means, every name resolved and every expression typed.
//!
//! *In:* built by [`analysis`](crate::analysis) from the syntax tree. *Out:* read by `link`, `lint`, `lower`
//! and `cpu`. A [`Shader`] is one stage; [`Types`] is shared by all stages of a compilation, so that equal types
//! have equal handles.
//!
//! *Holds:* no naga type is known here. Implicit conversions (§4.1.10) are explicit [`ExprKind::Convert`]s,
//! constructors are in normal form, `.length()` is a literal. Expression children precede their parents in the
//! arena. A shader with errors still has a HIR: what was not understood is [`ExprKind::Error`] of
//! [`TypeId::ERROR`]; nothing behind `link` ever sees one, because a program with errors is not handed on.

mod expr;
mod print;
mod reach;
mod shader;
mod stmt;
mod value;
mod visit;

pub use crate::language::{
    ArraySize, Interpolation, MatrixLayout, Member, ParamMode, SamplerDim, SamplerType, Scalar, Stage, Storage,
    StructId, StructType, Type, TypeId, Types,
};
pub use expr::{BinaryOp, ConstructKind, Expr, ExprId, ExprKind, IncDec, LogicalOp, Swizzle, UnaryOp, VarRef};
pub use print::print;
pub use shader::{
    BlockInfo, BlockLayout, FragCoordLayout, Function, FunctionId, GeometryLayout, Global, GlobalId, Local, LocalId,
    LocalKind, PerVertexOut, PrimitiveIn, PrimitiveOut, Shader,
};
pub use stmt::{Case, CaseLabel, Condition, LoopKind, Stmt, StmtKind};
pub use value::{ScalarValue, Value};
