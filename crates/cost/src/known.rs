//! Facts about values before anything is drawn: constants, and uniforms whose ranges somebody states.
//!
//! *In:* ranges of uniforms by name, and an expression. *Out:* bounds of a scalar, or what a condition decides. *Holds:* what is not
//! known has no bounds. The elements of an array share one range.

use glisten_front::builtin::BuiltinFunction as B;
use glisten_front::fold;
use glisten_front::hir::written_by;
use glisten_front::hir::{
    BinaryOp, Case, CaseLabel, ExprId, ExprKind, Function, LocalId, LogicalOp, Scalar, ScalarValue, Shader, StmtKind,
    Storage, Type, Types, UnaryOp, VarRef,
};
use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};

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
    /// The bounds of the counters of the loops that are walked, innermost last.
    counters: RefCell<Vec<(LocalId, [f64; 2])>>,
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
        Self { types, shader, function, ranges, definitions, counters: RefCell::default() }
    }

    /// Walks the body of a loop with these bounds of its counter.
    pub(super) fn inside<R>(&self, counter: Option<(LocalId, [f64; 2])>, walk: impl FnOnce() -> R) -> R {
        let before = self.counters.borrow().len();
        self.counters.borrow_mut().extend(counter);
        let result = walk();
        self.counters.borrow_mut().truncate(before);
        result
    }

    fn counter(&self, local: LocalId) -> Option<[f64; 2]> {
        self.counters.borrow().iter().rev().find(|(counter, _)| *counter == local).map(|(_, sides)| *sides)
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

    /// Whether the bounds of a scalar depend on the stated range of a uniform.
    pub(super) fn is_stated(&self, id: ExprId) -> bool {
        let (mut pending, mut seen, mut is_stated) = (vec![id], BTreeSet::new(), false);
        while let Some(root) = pending.pop().filter(|_| !is_stated) {
            self.shader.visit_expr(root, &mut |id| {
                if let ExprKind::Var(VarRef::Local(local)) = self.shader.expr(id).kind
                    && seen.insert(local.index())
                {
                    pending.extend(self.definitions.get(local.index()).copied().flatten());
                }
                is_stated |= self.path(id).is_some_and(|path| self.ranges.get(&path).is_some());
            });
        }
        is_stated
    }

    /// The kind of a scalar.
    pub(super) fn scalar(&self, id: ExprId) -> Option<Scalar> {
        match self.types.get(self.shader.expr(id).ty) {
            Type::Scalar(scalar) => Some(scalar),
            _ => None,
        }
    }

    fn walk(&self, id: ExprId, depth: u32) -> Option<[f64; 2]> {
        let scalar = self.scalar(id)?;
        let [low, high] = self.unlimited(id, depth)?;
        match scalar {
            // A side that is open ends where the type does. What passes it wraps.
            Scalar::Uint if low == f64::NEG_INFINITY => Some([0.0, high]),
            Scalar::Uint => (low >= 0.0 && (high <= f64::from(u32::MAX) || high.is_infinite())).then_some([low, high]),
            Scalar::Int => {
                let fits =
                    |side: f64| side.is_infinite() || (side >= f64::from(i32::MIN) && side <= f64::from(i32::MAX));
                (fits(low) && fits(high)).then_some([low, high])
            }
            Scalar::Float | Scalar::Bool => Some([low, high]),
        }
    }

    fn unlimited(&self, id: ExprId, depth: u32) -> Option<[f64; 2]> {
        if depth > DEPTH {
            return None;
        }
        if let Some(value) = self.constant(id) {
            return Some([value, value]);
        }
        let is_whole = matches!(self.scalar(id), Some(Scalar::Int | Scalar::Uint));
        let of = |id: ExprId| self.walk(id, depth + 1);
        match &self.shader.expr(id).kind {
            ExprKind::Var(VarRef::Local(local)) => {
                self.counter(*local).or_else(|| of((*self.definitions.get(local.index())?)?))
            }
            ExprKind::Var(_) | ExprKind::Member(..) | ExprKind::Index(..) => self.ranges.get(&self.path(id)?),
            ExprKind::Convert(value) => {
                let [low, high] = of(*value)?;
                match self.scalar(id)? {
                    Scalar::Bool if low > 0.0 || high < 0.0 => Some([1.0, 1.0]),
                    Scalar::Bool => Some([0.0, f64::from(u8::from(low != high))]),
                    Scalar::Int | Scalar::Uint => Some([low.trunc(), high.trunc()]),
                    Scalar::Float => Some([low, high]),
                }
            }
            ExprKind::Ternary(condition, yes, no) => match self.decides(*condition, depth + 1) {
                Some(true) => of(*yes),
                Some(false) => of(*no),
                None => {
                    let ([a, b], [c, d]) = (of(*yes)?, of(*no)?);
                    Some([a.min(c), b.max(d)])
                }
            },
            ExprKind::Unary(UnaryOp::Negate, value) => of(*value).map(|[low, high]| [-high, -low]),
            ExprKind::Binary(operator, a, b) => {
                let ([a, b], [c, d]) = (of(*a)?, of(*b)?);
                match operator {
                    BinaryOp::Add => Some([a + c, b + d]),
                    BinaryOp::Sub => Some([a - d, b - c]),
                    BinaryOp::Mul => spanned([a * c, a * d, b * c, b * d]),
                    BinaryOp::Div if c > 0.0 || d < 0.0 => {
                        let quotients = [a / c, a / d, b / c, b / d];
                        spanned(if is_whole { quotients.map(f64::trunc) } else { quotients })
                    }
                    BinaryOp::Shl if c == d => Some([a * c.exp2(), b * c.exp2()]),
                    BinaryOp::Shr if c == d => Some([(a / c.exp2()).floor(), (b / c.exp2()).floor()]),
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
            ExprKind::Binary(operator, left, right) if self.scalar(*left).is_some() => {
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

    /// Whether the value of a selector may begin each of its cases, and whether it may begin none.
    pub(super) fn may_begin(&self, selector: ExprId, cases: &[Case]) -> (Vec<bool>, bool) {
        let is_signed = self.scalar(selector) != Some(Scalar::Uint);
        let value = |bits: u32| if is_signed { f64::from(bits.cast_signed()) } else { f64::from(bits) };
        let [low, high] = self.bounds(selector).unwrap_or([f64::NEG_INFINITY, f64::INFINITY]);
        let is_within = |bits: u32| (low..=high).contains(&value(bits));
        let labels = cases.iter().flat_map(|case| &case.labels);
        let named: BTreeSet<u32> = labels
            .filter_map(|label| match label {
                CaseLabel::Value(bits) => Some(*bits).filter(|bits| is_within(*bits)),
                CaseLabel::Default => None,
            })
            .collect();
        // Whole numbers of the range that no label names.
        let others = high.floor() - low.ceil() + 1.0 > named.len() as f64;
        let may = |label: &CaseLabel| match label {
            CaseLabel::Value(bits) => is_within(*bits),
            CaseLabel::Default => others,
        };
        let has_default = cases.iter().any(|case| case.labels.contains(&CaseLabel::Default));
        (cases.iter().map(|case| case.labels.iter().any(may)).collect(), others && !has_default)
    }
}

/// The bounds of several numbers; `None` if one is none.
fn spanned(numbers: [f64; 4]) -> Option<[f64; 2]> {
    let low = numbers.iter().copied().fold(f64::INFINITY, f64::min);
    let high = numbers.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    (!numbers.iter().any(|number| number.is_nan())).then_some([low, high])
}
