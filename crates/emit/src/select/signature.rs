//! [`Signature`]: the parameters of a function that is made, and what a call passes for them.
//!
//! *In:* chains and values at a call. *Out:* the parameters, the arguments, and the [`Key`] by which equal functions are shared.
//! *Holds:* arguments are in the order of the expression that the call replaces. A global is named, not passed.

use super::Selection;
use super::chain::{Chain, Step};
use glisten_front::builtin::BuiltinFunction;
use glisten_front::hir::{
    ConstructKind, ExprId, ExprKind, FunctionId, GlobalId, Local, LocalId, LocalKind, ParamMode, Scalar, ScalarValue,
    Type, TypeId, Value, VarRef,
};
use glisten_front::source::Span;

/// The identity of a function that is made.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(super) struct Key {
    pub(super) what: What,
    pub(super) arguments: Vec<Argument>,
    pub(super) result: TypeId,
}

/// The computation of a function that is made.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(super) enum What {
    /// A lookup.
    Lookup(BuiltinFunction),
    /// A part of a uniform block.
    Read,
    /// That of a function of the shader.
    Copy(FunctionId),
}

/// An argument as far as functions differ by it.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(super) enum Argument {
    Value(TypeId),
    /// An argument that must be constant, as bits.
    Constant(TypeId, Vec<u32>),
    /// A chain: its root, its steps, the types of its indices.
    Chosen(Root, Vec<Step>, Vec<TypeId>),
}

/// Where a chain begins: a global, or a parameter of a type.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(super) enum Root {
    Global(GlobalId),
    Parameter(TypeId),
}

/// The parameters of a function, and what a call passes.
#[derive(Debug, Default)]
pub(super) struct Signature {
    pub(super) parameters: Vec<Local>,
    pub(super) passed: Vec<ExprId>,
    pub(super) arguments: Vec<Argument>,
}

/// A chain inside of a function that is made: its root and its indices there.
#[derive(Clone, Debug)]
pub(super) struct Inner {
    pub(super) chain: Chain,
    root: VarRef,
    indices: Vec<(LocalId, TypeId)>,
}

impl Signature {
    /// Adds a parameter.
    pub(super) fn parameter(&mut self, parameter: Local, value: ExprId) -> LocalId {
        let id = LocalId::new(self.parameters.len());
        self.parameters.push(parameter);
        self.passed.push(value);
        id
    }

    /// Adds a parameter that is a value.
    pub(super) fn value(&mut self, selection: &Selection<'_>, name: &str, value: ExprId) -> LocalId {
        let ty = selection.shader.expr(value).ty;
        self.arguments.push(Argument::Value(ty));
        self.parameter(parameter(name, ty), value)
    }

    /// Adds the parameters of a chain: its root unless that is a global, and its indices.
    pub(super) fn chain(&mut self, selection: &Selection<'_>, name: &str, chain: Chain) -> Inner {
        let shader = &selection.shader;
        let mut types = Vec::new();
        let (key, root) = match chain.root {
            VarRef::Global(global) => (Root::Global(global), chain.root),
            VarRef::Local(_) => {
                let ty = shader.expr(chain.base).ty;
                (Root::Parameter(ty), VarRef::Local(self.parameter(parameter(name, ty), chain.base)))
            }
        };
        let mut indices = Vec::new();
        for &index in &chain.indices {
            let ty = shader.expr(index).ty;
            types.push(ty);
            indices.push((self.parameter(parameter("index", ty), index), ty));
        }
        let steps = chain.steps.iter().map(|(step, _)| *step).collect();
        self.arguments.push(Argument::Chosen(key, steps, types));
        Inner { chain, root, indices }
    }
}

fn parameter(name: &str, ty: TypeId) -> Local {
    Local { name: name.to_owned(), ty, kind: LocalKind::Param(ParamMode::In), value: None, span: Span::default() }
}

impl Argument {
    /// A constant argument.
    pub(super) fn constant(value: &Value) -> Self {
        let bits = value.scalars.iter().map(|scalar| match scalar {
            ScalarValue::Bool(value) => u32::from(*value),
            ScalarValue::Int(value) => *value as u32,
            ScalarValue::Uint(value) => *value,
            ScalarValue::Float(value) => value.to_bits(),
        });
        Self::Constant(value.ty, bits.collect())
    }
}

impl Selection<'_> {
    /// The chain as an expression of the function that is made. Each chosen element is the next of `elements`; without them it
    /// is an index again.
    pub(super) fn denoted(&mut self, inner: &Inner, elements: Option<&[u32]>, span: Span) -> ExprId {
        let base_ty = self.shader.expr(inner.chain.base).ty;
        let mut at = self.push(ExprKind::Var(inner.root), base_ty, span);
        let mut indices = inner.indices.iter();
        let mut elements = elements.map(|elements| elements.iter());
        for &(step, ty) in &inner.chain.steps {
            let kind = match (step, &mut elements) {
                (Step::Member(member), _) => ExprKind::Member(at, member),
                (Step::Swizzle(swizzle), _) => ExprKind::Swizzle(at, swizzle),
                (Step::Element(element), _) => ExprKind::Index(at, self.int(element, span)),
                (Step::Chosen(_), Some(elements)) => {
                    indices.next();
                    ExprKind::Index(at, self.int(elements.next().copied().unwrap_or(0), span))
                }
                (Step::Chosen(_) | Step::Indexed, _) => match indices.next() {
                    Some((local, ty)) => ExprKind::Index(at, self.local(*local, *ty, span)),
                    None => ExprKind::Index(at, self.int(0, span)),
                },
            };
            at = self.push(kind, ty, span);
        }
        at
    }

    /// The number of the branch that the indices choose: each clamped to its array, the last varying fastest.
    pub(super) fn branch(&mut self, inner: &Inner, span: Span) -> ExprId {
        let mut indices = inner.indices.iter();
        let mut branch = None;
        for (step, _) in inner.chain.steps.clone() {
            let index = matches!(step, Step::Chosen(_) | Step::Indexed).then(|| indices.next()).flatten();
            let (Step::Chosen(len), Some(&(local, ty))) = (step, index) else { continue };
            let mut index = self.local(local, ty, span);
            if ty != TypeId::INT {
                index = self.push(ExprKind::Convert(index), TypeId::INT, span);
            }
            let (first, last) = (self.int(0, span), self.int(len.saturating_sub(1), span));
            let clamped = ExprKind::BuiltinCall(BuiltinFunction::Clamp, vec![index, first, last]);
            let clamped = self.push(clamped, TypeId::INT, span);
            branch = Some(match branch {
                None => clamped,
                Some(before) => {
                    use glisten_front::hir::BinaryOp::{Add, Mul};
                    let len = self.int(len, span);
                    let rows = self.push(ExprKind::Binary(Mul, before, len), TypeId::INT, span);
                    self.push(ExprKind::Binary(Add, rows, clamped), TypeId::INT, span)
                }
            });
        }
        branch.unwrap_or_else(|| self.int(0, span))
    }

    pub(super) fn int(&mut self, value: u32, span: Span) -> ExprId {
        let value = ScalarValue::Int(i32::try_from(value).unwrap_or(i32::MAX));
        self.push(ExprKind::Literal(value), TypeId::INT, span)
    }

    pub(super) fn local(&mut self, local: LocalId, ty: TypeId, span: Span) -> ExprId {
        self.push(ExprKind::Var(VarRef::Local(local)), ty, span)
    }

    /// A constant of integers: a scalar, a vector, or an array of vectors.
    pub(super) fn spelled(&mut self, ty: TypeId, bits: &[u32], span: Span) -> ExprId {
        let (parts, kind) = match self.types.get(ty) {
            Type::Array(element, _) => (element, ConstructKind::Array),
            Type::Vector(scalar, _) => (TypeId::vector(scalar, 1), ConstructKind::Compose),
            Type::Scalar(Scalar::Uint) => {
                let value = ScalarValue::Uint(bits.first().copied().unwrap_or(0));
                return self.push(ExprKind::Literal(value), ty, span);
            }
            _ => {
                let value = ScalarValue::Int(bits.first().copied().unwrap_or(0) as i32);
                return self.push(ExprKind::Literal(value), ty, span);
            }
        };
        let len = self.types.flat_len(parts).max(1) as usize;
        let parts: Vec<ExprId> = bits.chunks(len).map(|bits| self.spelled(parts, bits, span)).collect();
        self.push(ExprKind::Construct(kind, parts), ty, span)
    }
}
