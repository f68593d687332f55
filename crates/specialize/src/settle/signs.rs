//! Signs of zeros: where nobody sees whether a 0 is -0.
//!
//! *In:* a walked stage, and the globals in which somebody outside sees it. *Out:* a flag for each expression and each global.
//! *Holds:* an expression without the flag may give 0 for -0, or -0 for 0, and the stage computes the same bits: what it goes into is a
//! comparison, the coordinate of a texture, a sum that is not 0 and so on, or has no flag either. Flags are raised until nothing changes;
//! after too many rounds everything has one.
//!
//! | operation | who sees the sign of an operand |
//! | --- | --- |
//! | comparisons, conversions to other types, `abs`, `cos`, `exp`, `length` and so on | nobody |
//! | coordinates of lookups that divide by nothing, levels, references | nobody |
//! | `x + c`, `x - c` where one is not 0 | nobody |
//! | other sums, products, `mix`, `max`, `normalize`, vectors, matrices and their parts | who sees that of the result |
//! | divisors, bits, `atan` of two numbers and all others | the operation itself |

#![deny(
    clippy::wildcard_enum_match_arm,
    reason = "what is added to the language does not pass until it is judged here"
)]

use crate::facts::Fact;
use crate::forward::Walked;
use glisten_front::builtin::BuiltinFunction;
use glisten_front::builtin::operations::{
    Binary, Class, Composite, Lookup, MatrixFunction, Numbers, Ternary, TextureForm, Unary,
};
use glisten_front::hir::{
    BinaryOp, ExprId, ExprKind, FunctionId, LocalId, ParamMode, Scalar, ScalarValue, Stmt, StmtKind, Types, UnaryOp,
    VarRef,
};
use smallvec::{SmallVec, smallvec};

/// After so many rounds everybody sees everything.
const ROUNDS: usize = 16;

/// Who sees the sign of a zero of an operand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Sees {
    Nobody,
    /// Whoever sees that of the result.
    AsTheResult,
    TheOperation,
}
use Sees::{AsTheResult, Nobody, TheOperation};

impl Sees {
    fn given(self, result: bool) -> bool {
        match self {
            Nobody => false,
            AsTheResult => result,
            TheOperation => true,
        }
    }
}

/// Where somebody sees the sign of a zero.
#[derive(Debug)]
struct Signs {
    /// By expression.
    exprs: Vec<bool>,
    /// By clone and local.
    locals: Vec<Vec<bool>>,
    globals: Vec<bool>,
    /// By clone: in what it returns.
    results: Vec<bool>,
    changed: bool,
}

/// Finds out where in a stage somebody sees the sign of a zero, from the globals in which somebody outside does. The globals come back with
/// those that the stage itself looks at.
pub(crate) fn mark_signs(types: &Types, walked: &mut Walked, globals: Vec<bool>) -> Vec<bool> {
    let n_globals = globals.len();
    match found(types, walked, globals) {
        Some(signs) => {
            walked.signs = signs.exprs;
            signs.globals
        }
        None => vec![true; n_globals],
    }
}

/// Finds out where an operation sees the sign of a zero, from the globals that operations of a later stage look at: a picture is the same with
/// either sign. The globals come back as those of [`mark_signs`].
pub(crate) fn mark_looked_at(types: &Types, walked: &mut Walked, globals: Vec<bool>) -> Vec<bool> {
    let n_globals = globals.len();
    match found(types, walked, globals) {
        Some(signs) => {
            walked.looked_at = signs.exprs;
            signs.globals
        }
        None => {
            walked.looked_at = vec![true; walked.shader.exprs.len()];
            vec![true; n_globals]
        }
    }
}

/// The flags, if they come to rest.
fn found(types: &Types, walked: &Walked, globals: Vec<bool>) -> Option<Signs> {
    let shader = &walked.shader;
    let mut signs = Signs {
        exprs: vec![false; shader.exprs.len()],
        locals: shader.functions.iter().map(|function| vec![false; function.locals.len()]).collect(),
        globals,
        results: vec![false; shader.functions.len()],
        changed: true,
    };
    for _ in 0..ROUNDS {
        if !std::mem::take(&mut signs.changed) {
            return Some(signs);
        }
        signs.round(types, walked);
    }
    None
}

impl Signs {
    fn round(&mut self, types: &Types, walked: &Walked) {
        for (id, function) in walked.shader.functions() {
            self.body((types, walked, id), function.body.as_deref().unwrap_or(&[]));
        }
        for (id, global) in walked.shader.globals() {
            if let Some(initializer) = global.initializer {
                let seen = self.globals.get(id.index()).copied().unwrap_or(true);
                self.expr((types, walked, FunctionId::new(0)), initializer, seen);
            }
        }
    }

    /// Uses follow what is stored, mostly: so backwards.
    fn body(&mut self, of: Of<'_>, body: &[Stmt]) {
        for stmt in body.iter().rev() {
            for inner in stmt.kind.bodies().into_iter().rev() {
                self.body(of, inner);
            }
            let seen = match &stmt.kind {
                StmtKind::Local(local, _) => self.variable(of.2, VarRef::Local(*local)),
                StmtKind::Return(_) => self.results.get(of.2.index()).copied().unwrap_or(true),
                StmtKind::Expr(_)
                | StmtKind::Block(_)
                | StmtKind::If { .. }
                | StmtKind::Switch { .. }
                | StmtKind::Loop { .. }
                | StmtKind::Break
                | StmtKind::Continue
                | StmtKind::Discard => false,
            };
            for expr in stmt.kind.exprs() {
                self.expr(of, expr, seen);
            }
        }
    }

    fn variable(&self, function: FunctionId, variable: VarRef) -> bool {
        let seen = match variable {
            VarRef::Global(id) => self.globals.get(id.index()),
            VarRef::Local(id) => self.locals.get(function.index()).and_then(|locals| locals.get(id.index())),
        };
        seen.copied().unwrap_or(true)
    }

    fn raise(&mut self, function: FunctionId, variable: VarRef, seen: bool) {
        let slot = match variable {
            VarRef::Global(id) => self.globals.get_mut(id.index()),
            VarRef::Local(id) => self.locals.get_mut(function.index()).and_then(|locals| locals.get_mut(id.index())),
        };
        if let Some(slot) = slot.filter(|slot| seen && !**slot) {
            *slot = true;
            self.changed = true;
        }
    }

    fn expr(&mut self, of: Of<'_>, root: ExprId, seen: bool) {
        let (types, walked, function) = of;
        let mut pending = vec![(root, seen)];
        while let Some((id, mut seen)) = pending.pop() {
            let kind = &walked.shader.expr(id).kind;
            let children = kind.children();
            let mut operands: SmallVec<[bool; 4]> = smallvec![false; children.len()];
            match kind {
                ExprKind::Var(variable) => self.raise(function, *variable, seen),
                ExprKind::Assign(op, target, value) => {
                    let root = walked.shader.root_variable(*target);
                    seen |= root.is_none_or(|variable| self.variable(function, variable));
                    let [old, new] = match op {
                        Some(op) => {
                            of_binary(*op, walked.before.get(&id).map_or(&[], |facts| facts), walked.facts(*value))
                        }
                        None => [Nobody, AsTheResult],
                    };
                    if let Some(root) = root {
                        self.raise(function, root, old.given(seen));
                    }
                    operands = smallvec![old.given(seen), new.given(seen)];
                }
                ExprKind::IncDec(_, target) => {
                    if let Some(root) = walked.shader.root_variable(*target) {
                        self.raise(function, root, seen);
                    }
                }
                ExprKind::Call(callee, arguments) => {
                    if let Some(result) = self.results.get_mut(callee.index()).filter(|result| seen && !**result) {
                        *result = true;
                        self.changed = true;
                    }
                    for (index, argument) in arguments.iter().enumerate() {
                        let given = self.argument(walked, function, (*callee, index), *argument);
                        operands.get_mut(index).into_iter().for_each(|slot| *slot = given);
                    }
                }
                ExprKind::Error
                | ExprKind::Literal(_)
                | ExprKind::Member(..)
                | ExprKind::Index(..)
                | ExprKind::Swizzle(..)
                | ExprKind::Convert(_)
                | ExprKind::Construct(..)
                | ExprKind::Unary(..)
                | ExprKind::Binary(..)
                | ExprKind::Logical(..)
                | ExprKind::Ternary(..)
                | ExprKind::Comma(..)
                | ExprKind::BuiltinCall(..) => {
                    for (slot, sees) in operands.iter_mut().zip(of_operands(types, walked, id)) {
                        *slot = sees.given(seen);
                    }
                }
            }
            if let Some(slot) = self.exprs.get_mut(id.index()) {
                *slot |= seen;
            }
            pending.extend(children.into_iter().zip(operands));
        }
    }

    /// Whether the sign of an argument is seen, through the parameter.
    fn argument(
        &mut self,
        walked: &Walked,
        function: FunctionId,
        (callee, index): (FunctionId, usize),
        argument: ExprId,
    ) -> bool {
        let param = VarRef::Local(LocalId::new(index));
        let inside = self.variable(callee, param);
        let mode = walked.shader.function(callee).param_mode(index);
        if matches!(mode, ParamMode::Out | ParamMode::Inout) {
            let outside = walked.shader.root_variable(argument);
            let seen = outside.is_none_or(|variable| self.variable(function, variable));
            self.raise(callee, param, seen);
        }
        inside && mode != ParamMode::Out
    }
}

/// The types, a stage, and the function in it.
type Of<'a> = (&'a Types, &'a Walked, FunctionId);

/// Who sees the signs of the operands of what neither stores nor calls.
fn of_operands(types: &Types, walked: &Walked, id: ExprId) -> SmallVec<[Sees; 4]> {
    let expr = walked.shader.expr(id);
    let children = expr.kind.children();
    let all = |sees: Sees| smallvec![sees; children.len()];
    match &expr.kind {
        ExprKind::Member(..) | ExprKind::Swizzle(..) | ExprKind::Construct(..) => all(AsTheResult),
        ExprKind::Index(..) => smallvec![AsTheResult, Nobody],
        ExprKind::Convert(_) => all(if types.scalar_of(expr.ty) == Some(Scalar::Float) { AsTheResult } else { Nobody }),
        ExprKind::Unary(op, _) => all(match op {
            UnaryOp::Negate => AsTheResult,
            UnaryOp::Not | UnaryOp::BitNot => Nobody,
        }),
        ExprKind::Binary(op, a, b) => SmallVec::from_slice(&of_binary(*op, walked.facts(*a), walked.facts(*b))),
        ExprKind::Logical(..) => all(Nobody),
        ExprKind::Ternary(..) => smallvec![Nobody, AsTheResult, AsTheResult],
        ExprKind::Comma(..) => smallvec![Nobody, AsTheResult],
        ExprKind::BuiltinCall(BuiltinFunction::Pow, _) => {
            let exponents = children.get(1).map_or(&[][..], |exponent| walked.facts(*exponent));
            smallvec![of_base(exponents), Nobody]
        }
        ExprKind::BuiltinCall(function, _) => of_function(*function, children.len()),
        ExprKind::Literal(_)
        | ExprKind::Var(_)
        | ExprKind::Assign(..)
        | ExprKind::IncDec(..)
        | ExprKind::Call(..)
        | ExprKind::Error => all(TheOperation),
    }
}

/// Who sees the sign of a base that is 0: for an odd exponent the result has it, for other positive ones it is 0.
fn of_base(exponents: &[Fact]) -> Sees {
    let is_odd = |value: f32| value % 2.0 == 1.0;
    let is_even = |fact: &Fact| matches!(fact.value(), Some(ScalarValue::Float(value)) if !is_odd(value));
    match () {
        () if exponents.is_empty() || !exponents.iter().all(|fact| fact.range().low > 0.0) => TheOperation,
        () if exponents.iter().all(is_even) => Nobody,
        () => AsTheResult,
    }
}

/// Whether 0 is none of the values.
fn has_no_zero(facts: &[Fact]) -> bool {
    !facts.is_empty() && facts.iter().all(|fact| !fact.range().has_zero())
}

fn of_binary(op: BinaryOp, a: &[Fact], b: &[Fact]) -> [Sees; 2] {
    match op {
        BinaryOp::Add | BinaryOp::Sub if has_no_zero(a) || has_no_zero(b) => [Nobody; 2],
        BinaryOp::Add | BinaryOp::Sub | BinaryOp::Mul | BinaryOp::MatMul => [AsTheResult; 2],
        BinaryOp::Div => [AsTheResult, TheOperation],
        BinaryOp::Less
        | BinaryOp::Greater
        | BinaryOp::LessEqual
        | BinaryOp::GreaterEqual
        | BinaryOp::Equal
        | BinaryOp::NotEqual
        | BinaryOp::Rem
        | BinaryOp::Shl
        | BinaryOp::Shr
        | BinaryOp::BitAnd
        | BinaryOp::BitXor
        | BinaryOp::BitOr
        | BinaryOp::LogicalXor => [Nobody; 2],
    }
}

fn of_function(function: BuiltinFunction, arguments: usize) -> SmallVec<[Sees; 4]> {
    let all = |sees: Sees| smallvec![sees; arguments];
    match function.class() {
        Class::Unary(op) => all(of_unary(op)),
        Class::Binary(op) => match op {
            Binary::Min | Binary::Max | Binary::Add | Binary::Sub | Binary::Mul => all(AsTheResult),
            Binary::Step => all(Nobody),
            Binary::Pow => smallvec![TheOperation, Nobody],
            Binary::Mod | Binary::Div => smallvec![AsTheResult, TheOperation],
            Binary::Atan2 => all(TheOperation),
        },
        Class::Ternary(op) => all(match op {
            Ternary::Clamp | Ternary::Mix | Ternary::Fma => AsTheResult,
            Ternary::Smoothstep => Nobody,
        }),
        Class::Numbers(op) => all(match op {
            Numbers::Abs => Nobody,
            Numbers::Sign | Numbers::Min | Numbers::Max | Numbers::Clamp | Numbers::Mix => AsTheResult,
            Numbers::Atan if arguments == 1 => AsTheResult,
            Numbers::Atan => TheOperation,
        }),
        Class::Composite(op) => match op {
            Composite::Length | Composite::Distance => all(Nobody),
            Composite::Dot | Composite::Cross | Composite::Normalize | Composite::Reflect => all(AsTheResult),
            Composite::Faceforward => smallvec![AsTheResult, Nobody, Nobody],
            Composite::Refract | Composite::Determinant | Composite::Inverse => all(TheOperation),
        },
        Class::Matrix(op) => all(match op {
            MatrixFunction::ComponentProduct | MatrixFunction::OuterProduct | MatrixFunction::Transpose => AsTheResult,
        }),
        Class::Relation(_) | Class::Boolean(_) | Class::Test(_) | Class::Bits(_) => all(Nobody),
        Class::Derivative(_) => all(AsTheResult),
        Class::Texture(form) => all(of_lookup(form)),
        Class::BitCast(_)
        | Class::Packing(_)
        | Class::Modf
        | Class::Composed
        | Class::Noise(_)
        | Class::Emission(_) => all(TheOperation),
    }
}

fn of_unary(op: Unary) -> Sees {
    match op {
        Unary::Abs | Unary::Cos | Unary::Cosh | Unary::Exp | Unary::Exp2 | Unary::Log | Unary::Log2 | Unary::Acos => {
            Nobody
        }
        Unary::Neg
        | Unary::Sign
        | Unary::Floor
        | Unary::Trunc
        | Unary::Round
        | Unary::Ceil
        | Unary::Fract
        | Unary::Radians
        | Unary::Degrees
        | Unary::Sin
        | Unary::Tan
        | Unary::Asin
        | Unary::Atan
        | Unary::Sinh
        | Unary::Tanh
        | Unary::Asinh
        | Unary::Atanh
        | Unary::Sqrt => AsTheResult,
        Unary::Inversesqrt | Unary::Acosh => TheOperation,
    }
}

/// Texels are found by sums and comparisons, unless a coordinate is a divisor.
fn of_lookup(form: TextureForm) -> Sees {
    match form.lookup {
        Lookup::Implicit | Lookup::Lod | Lookup::Gather | Lookup::Fetch | Lookup::Size | Lookup::Levels
            if !form.projective =>
        {
            Nobody
        }
        Lookup::Implicit
        | Lookup::Lod
        | Lookup::Gather
        | Lookup::Fetch
        | Lookup::Size
        | Lookup::Levels
        | Lookup::Grad
        | Lookup::QueryLod => TheOperation,
    }
}
