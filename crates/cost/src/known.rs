//! Facts about values before anything is drawn: constants, and uniforms whose ranges somebody states.
//!
//! *In:* ranges of uniforms by name, and an expression. *Out:* bounds of a scalar, or what a condition decides. *Holds:* what is not
//! known has no bounds. The elements of an array share one range.

use glisten_front::builtin::BuiltinFunction as B;
use glisten_front::fold;
use glisten_front::hir::written_by;
use glisten_front::hir::{
    BinaryOp, ExprId, ExprKind, Function, LogicalOp, ScalarValue, Shader, StmtKind, Storage, Type, Types, UnaryOp,
    VarRef,
};
use std::collections::BTreeMap;

/// How deep expressions are followed.
const DEPTH: u32 = 32;

/// The ranges of uniforms by name: `lights`, `light[].kind`. An index is left out, since elements share a range.
#[derive(Clone, Debug, Default)]
pub struct Ranges(BTreeMap<String, [f64; 2]>);

impl Ranges {
    /// Adds a range; of two for one name, what contains both.
    pub fn add(&mut self, name: &str, [low, high]: [f64; 2]) {
        let range = self.0.entry(plain(name)).or_insert([low, high]);
        *range = [range[0].min(low), range[1].max(high)];
    }

    /// The range of a name.
    pub fn get(&self, name: &str) -> Option<[f64; 2]> {
        self.0.get(name).copied()
    }
}

/// A name without the numbers of its indices.
fn plain(name: &str) -> String {
    let mut plain = String::new();
    let mut inside = false;
    for letter in name.chars() {
        inside = letter == '[' || inside && letter != ']';
        if !inside || letter == '[' {
            plain.push(letter);
        }
    }
    plain
}

/// A function, and what is known of its variables.
pub(super) struct Known<'a> {
    pub(super) types: &'a Types,
    pub(super) shader: &'a Shader,
    pub(super) function: &'a Function,
    ranges: &'a Ranges,
    /// The only value that each local is given, if it is one.
    definitions: Vec<Option<ExprId>>,
}

impl<'a> Known<'a> {
    pub(super) fn new(types: &'a Types, shader: &'a Shader, function: &'a Function, ranges: &'a Ranges) -> Self {
        let mut definitions = vec![None; function.locals.len()];
        let mut written = vec![false; function.locals.len()];
        let body = function.body.as_deref().unwrap_or(&[]);
        shader.visit_statements(body, &mut |statement| {
            if let StmtKind::Local(local, value) = statement.kind {
                definitions.get_mut(local.index()).into_iter().for_each(|slot| *slot = value);
            }
        });
        shader.visit_body(body, &mut |expr| {
            written_by(shader, expr, &mut |target| {
                if let Some(VarRef::Local(local)) = shader.root_variable(target) {
                    written.get_mut(local.index()).into_iter().for_each(|slot| *slot = true);
                }
            });
        });
        for (definition, _) in definitions.iter_mut().zip(written).filter(|(_, written)| *written) {
            *definition = None;
        }
        Self { types, shader, function, ranges, definitions }
    }

    /// The value of a constant scalar.
    pub(super) fn constant(&self, id: ExprId) -> Option<f64> {
        let locals = |variable: VarRef| match variable {
            VarRef::Local(local) => self.function.locals.get(local.index())?.value.as_ref(),
            VarRef::Global(_) => None,
        };
        let value = fold::evaluate(self.shader, self.types, id, &locals)?;
        match value.scalars.as_slice() {
            [ScalarValue::Int(value)] => Some(f64::from(*value)),
            [ScalarValue::Uint(value)] => Some(f64::from(*value)),
            [ScalarValue::Float(value)] => Some(f64::from(*value)),
            [ScalarValue::Bool(value)] => Some(f64::from(u8::from(*value))),
            _ => None,
        }
    }

    /// The bounds of a scalar.
    pub(super) fn bounds(&self, id: ExprId) -> Option<[f64; 2]> {
        self.walk(id, 0)
    }

    fn walk(&self, id: ExprId, depth: u32) -> Option<[f64; 2]> {
        if depth > DEPTH || !matches!(self.types.get(self.shader.expr(id).ty), Type::Scalar(_)) {
            return None;
        }
        if let Some(value) = self.constant(id) {
            return Some([value, value]);
        }
        let of = |id: ExprId| self.walk(id, depth + 1);
        match &self.shader.expr(id).kind {
            ExprKind::Var(VarRef::Local(local)) => of((*self.definitions.get(local.index())?)?),
            ExprKind::Var(_) | ExprKind::Member(..) | ExprKind::Index(..) => self.ranges.get(&self.path(id)?),
            ExprKind::Convert(value) => of(*value),
            ExprKind::Unary(UnaryOp::Negate, value) => of(*value).map(|[low, high]| [-high, -low]),
            ExprKind::Binary(operator, a, b) => {
                let ([a, b], [c, d]) = (of(*a)?, of(*b)?);
                match operator {
                    BinaryOp::Add => Some([a + c, b + d]),
                    BinaryOp::Sub => Some([a - d, b - c]),
                    BinaryOp::Mul => {
                        let corners = [a * c, a * d, b * c, b * d];
                        let low = corners.iter().copied().fold(f64::INFINITY, f64::min);
                        Some([low, corners.iter().copied().fold(f64::NEG_INFINITY, f64::max)])
                    }
                    _ => None,
                }
            }
            ExprKind::BuiltinCall(function, arguments) => self.call(*function, arguments, depth + 1),
            _ => None,
        }
    }

    /// A minimum has the bound of either operand.
    fn call(&self, function: B, arguments: &[ExprId], depth: u32) -> Option<[f64; 2]> {
        let all = [f64::NEG_INFINITY, f64::INFINITY];
        let of = |index: usize| arguments.get(index).and_then(|id| self.walk(*id, depth)).unwrap_or(all);
        let ([a, b], [c, d]) = (of(0), of(1));
        let found = match function {
            B::Min => [a.min(c), b.min(d)],
            B::Max => [a.max(c), b.max(d)],
            B::Clamp => {
                let [low, high] = [c, of(2)[1]];
                [a.max(low).min(high), b.max(low).min(high)]
            }
            _ => return None,
        };
        (found != all).then_some(found)
    }

    /// The name of a uniform, or of a part of one.
    fn path(&self, id: ExprId) -> Option<String> {
        let (mut at, mut parts) = (id, Vec::new());
        loop {
            match &self.shader.expr(at).kind {
                ExprKind::Var(VarRef::Global(global)) => {
                    let global = self.shader.globals.get(global.index())?;
                    if global.storage != Storage::Uniform {
                        return None;
                    }
                    // The members of a block without an instance are names of their own.
                    let is_plain = global.block.as_ref().is_some_and(|block| block.instance.is_none());
                    parts.push(if is_plain { String::new() } else { global.name.clone() });
                    break;
                }
                ExprKind::Member(inner, index) => {
                    let Type::Struct(structure) = self.types.get(self.shader.expr(*inner).ty) else { return None };
                    let member = self.types.structure(structure).members.get(*index as usize)?;
                    parts.push(format!(".{}", member.name));
                    at = *inner;
                }
                ExprKind::Index(inner, _) => {
                    parts.push("[]".to_owned());
                    at = *inner;
                }
                _ => return None,
            }
        }
        parts.reverse();
        Some(parts.concat().trim_start_matches('.').to_owned())
    }

    /// The decision of a condition, if it is always the same.
    pub(super) fn decided(&self, id: ExprId) -> Option<bool> {
        self.decides(id, 0)
    }

    fn decides(&self, id: ExprId, depth: u32) -> Option<bool> {
        if depth > DEPTH {
            return None;
        }
        let of = |id: ExprId| self.decides(id, depth + 1);
        match &self.shader.expr(id).kind {
            ExprKind::Unary(UnaryOp::Not, inner) => of(*inner).map(|is_true| !is_true),
            ExprKind::Logical(operator, a, b) => {
                let (a, b) = (of(*a), of(*b));
                // One operand may be enough.
                let enough = *operator == LogicalOp::Or;
                if a == Some(enough) || b == Some(enough) { Some(enough) } else { a.and(b) }
            }
            ExprKind::Binary(operator, left, right) if self.is_scalar(*left) => {
                let ([a, b], [c, d]) = (self.walk(*left, depth)?, self.walk(*right, depth)?);
                let either = |yes: bool, no: bool| if yes { Some(true) } else { no.then_some(false) };
                match operator {
                    BinaryOp::Less => either(b < c, a >= d),
                    BinaryOp::LessEqual => either(b <= c, a > d),
                    BinaryOp::Greater => either(a > d, b <= c),
                    BinaryOp::GreaterEqual => either(a >= d, b < c),
                    BinaryOp::Equal => either(a == b && c == d && a == c, b < c || a > d),
                    BinaryOp::NotEqual => either(b < c || a > d, a == b && c == d && a == c),
                    _ => None,
                }
            }
            _ => match self.walk(id, depth)? {
                [low, high] if low == high => Some(low != 0.0),
                _ => None,
            },
        }
    }

    fn is_scalar(&self, id: ExprId) -> bool {
        matches!(self.types.get(self.shader.expr(id).ty), Type::Scalar(_))
    }
}
