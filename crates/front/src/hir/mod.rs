//! The typed program: the meaning of a shader, with every name resolved and every expression typed.
//!
//! *In:* [`analysis`](crate::analysis) builds it from the syntax tree. *Out:* `link`, `lint`, `lower` and `cpu` read
//! it. A [`Shader`] is one stage. All stages of a compilation share one [`Types`], so that equal types have equal
//! handles.
//!
//! *Holds:* there are no naga types here. Implicit conversions (§4.1.10) are explicit [`ExprKind::Convert`]s,
//! constructors are in normal form, `.length()` is a literal, behind a comma if the expression before it has effects. Child
//! expressions precede their parents in the arena. A shader with errors still has a HIR, in which anything in error is [`ExprKind::Error`] of [`TypeId::ERROR`]. No
//! phase after `link` ever sees one, because a program with errors is not passed on.

mod effects;
mod expr;
mod handles;
mod members;
mod names;
mod precise;
mod print;
mod reach;
mod same;
mod shader;
mod stmt;
mod value;
mod visit;
mod written_out;

pub use crate::language::{
    ArraySize, Interpolation, MatrixLayout, Member, MemberPlace, ParamMode, SamplerDim, SamplerType, Sampling, Scalar,
    Stage, Storage, StructId, StructType, Type, TypeId, Types,
};
pub use effects::{is_pure, may_act, written_by};
pub use expr::{BinaryOp, ConstructKind, Expr, ExprId, ExprKind, IncDec, LogicalOp, Swizzle, UnaryOp, VarRef};
pub use handles::{FunctionId, GlobalId, LocalId};
pub use members::MembersRead;
pub use names::{all_names, fresh_name, global_names};
pub use precise::Precise;
pub use print::{Notes, print, print_with};
pub use same::{same_form, same_value};
pub use shader::{
    BlockInfo, BlockLayout, DepthMode, FragCoordLayout, Function, GeometryLayout, Global, Local, LocalKind, Origin,
    PerVertexOut, PrimitiveIn, PrimitiveOut, Shader,
};
pub use stmt::{Case, CaseLabel, Condition, LoopKind, Stmt, StmtKind};
pub use value::{ScalarValue, Value};
