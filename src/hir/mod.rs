//! The typed program: the meaning of a shader, with every name resolved and every expression typed.
//!
//! *In:* [`analysis`](crate::analysis) builds it from the syntax tree. *Out:* `link`, `lint`, `lower` and `cpu` read
//! it. A [`Shader`] is one stage. All stages of a compilation share one [`Types`], so that equal types have equal
//! handles.
//!
//! *Holds:* there are no naga types here. Implicit conversions (§4.1.10) are explicit [`ExprKind::Convert`]s,
//! constructors are in normal form, `.length()` is a literal. Child expressions precede their parents in the arena. A
//! shader with errors still has a HIR, in which anything in error is [`ExprKind::Error`] of [`TypeId::ERROR`]. No
//! phase after `link` ever sees one, because a program with errors is not passed on.

mod expr;
mod print;
mod reach;
mod shader;
mod stmt;
mod ty;
mod value;
mod visit;

pub use expr::{BinaryOp, ConstructKind, Expr, ExprId, ExprKind, IncDec, LogicalOp, Swizzle, UnaryOp, VarRef};
pub use print::print;
pub use shader::{
    BlockInfo, BlockLayout, FragCoordLayout, Function, FunctionId, GeometryLayout, Global, GlobalId, Interpolation,
    Local, LocalId, LocalKind, ParamMode, PerVertexOut, PrimitiveIn, PrimitiveOut, Shader, Stage, Storage,
};
pub use stmt::{Case, CaseLabel, Condition, LoopKind, Stmt, StmtKind};
pub use ty::{
    ArraySize, MatrixLayout, Member, SamplerDim, SamplerType, Scalar, StructId, StructType, Type, TypeId, Types,
};
pub use value::{ScalarValue, Value};

/// Runs a traversal that recurses `depth` levels with enough stack: on this thread if that is shallow, else on a
/// thread of its own. A traversal may use up to 8 KiB of stack per level.
pub(crate) fn with_stack<R: Send>(depth: u32, walk: impl FnOnce() -> R + Send) -> R {
    const SHALLOW: u32 = 48;
    const BYTES_A_LEVEL: usize = 8 << 10;
    if depth <= SHALLOW {
        return walk();
    }
    let bytes = (depth as usize * BYTES_A_LEVEL).max(4 << 20);
    std::thread::scope(|scope| {
        let thread = std::thread::Builder::new().stack_size(bytes).spawn_scoped(scope, walk);
        match thread.map(std::thread::ScopedJoinHandle::join) {
            Ok(Ok(result)) => result,
            Ok(Err(panic)) => std::panic::resume_unwind(panic),
            Err(error) => panic!("the system gives no thread with {bytes} bytes of stack: {error}"),
        }
    })
}
