//! Compiles paths: `a`, `a.b[i].xy`, as r-values and l-values (§5.5 to §5.8).
//!
//! Known indices select scalars at compile time. The others become one index into a table of all scalars that may be
//! selected. Each index is clamped into its range on its own, as an `int`: below 0 selects the first element, past
//! the end the last.

use super::super::inst::{Class, Inst, Int2, Operand};
use super::vars::VarId;
use super::{Compiler, Val};
use glisten_front::hir::{ExprId, ExprKind, Swizzle, Type, TypeId};
use smallvec::SmallVec;

/// The base of a path.
enum Base {
    Var(VarId),
    /// An r-value that is not a variable.
    Value(Val),
}

/// An index that is not known at compile time.
struct Dynamic {
    index: Operand,
    /// The number of scalars between elements.
    stride: u32,
    count: u32,
}

/// A part of a variable or value.
pub(super) struct Path {
    base: Base,
    offset: u32,
    dynamic: SmallVec<[Dynamic; 2]>,
    /// The type before the swizzle.
    ty: TypeId,
    swizzle: Option<Swizzle>,
}

impl Compiler<'_> {
    /// Evaluates the indices of a path, and its base if that is not a variable.
    pub(super) fn path(&mut self, expr: ExprId) -> Path {
        self.path_before(expr, false)
    }

    /// The same, where the path is used after what `changes` variables: its indices stay what they are now.
    pub(super) fn path_before(&mut self, expr: ExprId, changes: bool) -> Path {
        // From the outside in, then from the base out, so that indices are evaluated left to right.
        let shader = self.shader;
        let mut steps = vec![expr];
        let mut base = expr;
        while let ExprKind::Member(inner, _) | ExprKind::Index(inner, _) | ExprKind::Swizzle(inner, _) =
            shader.expr(base).kind
        {
            base = inner;
            steps.push(base);
        }
        steps.pop();
        let ty = self.ty(base);
        let start = match shader.expr(base).kind {
            ExprKind::Var(var) => self.var_of(var).map(Base::Var),
            _ => None,
        };
        let later_effects = steps.first().is_some_and(|outermost| self.effects.has(*outermost));
        let start = start.unwrap_or_else(|| {
            let value = self.expr(base);
            Base::Value(if later_effects { self.keep_all(base, value) } else { value })
        });
        let mut path = Path { base: start, offset: 0, dynamic: SmallVec::new(), ty, swizzle: None };
        for step in steps.into_iter().rev() {
            self.step(&mut path, step, changes || later_effects);
        }
        path
    }

    fn step(&mut self, path: &mut Path, expr: ExprId, keeps: bool) {
        match shader_kind(self, expr) {
            ExprKind::Member(_, member) => {
                if let Type::Struct(id) = self.types.get(path.ty) {
                    let members = &self.types.structure(id).members;
                    let before = members.iter().take(member as usize);
                    path.offset += before.fold(0, |sum, member| sum + self.types.flat_len(member.ty));
                }
                path.ty = self.ty(expr);
            }
            ExprKind::Index(base, index) => {
                let element = self.ty(expr);
                let stride = self.types.flat_len(element);
                let whole = self.types.flat_len(self.ty(base));
                let value = self.expr(index);
                let index = value.first().copied().unwrap_or_else(|| self.emit.int(0));
                let index = if keeps { self.emit.keep(Class::Int, index) } else { index };
                self.index(path, index, stride, whole.checked_div(stride).unwrap_or(0));
                path.ty = element;
            }
            ExprKind::Swizzle(_, swizzle) => {
                // A swizzle of a swizzle selects from the components of the first.
                path.swizzle = Some(match path.swizzle {
                    None => swizzle,
                    Some(inner) => compose(inner, swizzle),
                });
            }
            _ => {}
        }
    }

    fn index(&mut self, path: &mut Path, index: Operand, stride: u32, count: u32) {
        if let Some(swizzle) = path.swizzle.take() {
            // A component of a swizzle: look up the component, then select it from the vector.
            let components: Val =
                swizzle.as_slice().iter().map(|component| self.emit.int(u32::from(*component))).collect();
            let table: Vec<Operand> = components.to_vec();
            let picked = self.load(Class::Int, &table, index);
            path.dynamic.push(Dynamic { index: picked, stride, count: 4 });
            return;
        }
        match self.emit.known_int(index) {
            Some(bits) => {
                let known = (bits as i32).clamp(0, count.saturating_sub(1) as i32) as u32;
                path.offset += known * stride;
            }
            None => path.dynamic.push(Dynamic { index, stride, count }),
        }
    }

    /// Looks up a table element.
    fn load(&mut self, class: Class, table: &[Operand], index: Operand) -> Operand {
        if let Some(bits) = self.emit.known_int(index) {
            let known = (bits as i32).clamp(0, table.len() as i32 - 1) as usize;
            return table.get(known).copied().unwrap_or_else(|| self.emit.zero(class));
        }
        let hoisted = index.is_scalar() && table.iter().all(|operand| operand.is_scalar());
        let list = self.emit.list(class, table, hoisted);
        let reads: &[Operand] = if hoisted { &[index] } else { &[Operand::reg(0)] };
        self.emit.pure(class, reads, |dst| match class {
            Class::Float => Inst::LoadFloat { dst, table: list, index },
            Class::Int => Inst::LoadInt { dst, table: list, index },
        })
    }

    /// The number of scalars that the path selects, before its swizzle.
    fn width(&self, path: &Path) -> u32 {
        self.types.flat_len(path.ty)
    }

    fn components(&self, path: &Path) -> SmallVec<[u32; 4]> {
        match path.swizzle {
            Some(swizzle) => swizzle.as_slice().iter().map(|component| u32::from(*component)).collect(),
            None => (0..self.width(path)).collect(),
        }
    }

    /// One index for all dynamic ones, in the order of [`offsets`].
    fn joint_index(&mut self, path: &Path) -> Operand {
        let mut joint: Option<Operand> = None;
        for dynamic in &path.dynamic {
            let last = self.emit.int(dynamic.count.saturating_sub(1));
            let index =
                if path.dynamic.len() == 1 { dynamic.index } else { self.int2(Int2::ClampIndex, dynamic.index, last) };
            joint = Some(match joint {
                None => index,
                Some(before) => {
                    let count = self.emit.int(dynamic.count);
                    let scaled = self.int2(Int2::Mul, before, count);
                    self.int2(Int2::Add, scaled, index)
                }
            });
        }
        joint.unwrap_or_else(|| self.emit.int(0))
    }

    fn base_value(&mut self, base: &Base, flat: u32) -> Operand {
        match base {
            Base::Var(var) => self.read(*var, flat as usize),
            Base::Value(value) => match value.get(flat as usize) {
                Some(operand) => *operand,
                None => self.emit.zero(Class::Float),
            },
        }
    }

    /// The value of the path.
    pub(super) fn read_path(&mut self, path: &Path) -> Val {
        let components = self.components(path);
        if path.dynamic.is_empty() {
            return components.iter().map(|component| self.base_value(&path.base, path.offset + component)).collect();
        }
        let classes = self.classes(path.ty);
        let index = self.joint_index(path);
        let offsets = offsets(path);
        components
            .iter()
            .map(|component| {
                let table: Vec<Operand> =
                    offsets.iter().map(|offset| self.base_value(&path.base, offset + component)).collect();
                let class = classes.get(*component as usize).copied().unwrap_or(Class::Float);
                self.load(class, &table, index)
            })
            .collect()
    }

    /// Assigns to the path, in the active lanes.
    pub(super) fn write_path(&mut self, path: &Path, value: &[Operand]) {
        let Base::Var(var) = path.base else { return };
        let components = self.components(path);
        let classes = self.classes(path.ty);
        let class_of = |component: u32| classes.get(component as usize).copied().unwrap_or(Class::Float);
        // `a.xy = a.yx` must read before it writes.
        let value: Val = if value.len() > 1 {
            components
                .iter()
                .zip(value)
                .map(|(component, operand)| self.emit.keep(class_of(*component), *operand))
                .collect()
        } else {
            Val::from_slice(value)
        };
        if path.dynamic.is_empty() {
            for (component, operand) in components.iter().zip(value) {
                self.assign(var, (path.offset + component) as usize, operand);
            }
            return;
        }
        self.mark_written(var);
        let index = self.joint_index(path);
        let offsets = offsets(path);
        for (component, a) in components.iter().zip(value) {
            let homes: Vec<Operand> =
                offsets.iter().map(|offset| self.settle(var, (offset + component) as usize)).collect();
            let class = class_of(*component);
            let table = self.emit.list(class, &homes, false);
            self.emit.push(match class {
                Class::Float => Inst::StoreIndexedFloat { table, index, a },
                Class::Int => Inst::StoreIndexedInt { table, index, a },
            });
        }
    }
}

fn shader_kind(compiler: &Compiler<'_>, expr: ExprId) -> ExprKind {
    match &compiler.shader.expr(expr).kind {
        ExprKind::Member(base, member) => ExprKind::Member(*base, *member),
        ExprKind::Index(base, index) => ExprKind::Index(*base, *index),
        ExprKind::Swizzle(base, swizzle) => ExprKind::Swizzle(*base, *swizzle),
        _ => ExprKind::Error,
    }
}

fn compose(inner: Swizzle, outer: Swizzle) -> Swizzle {
    let mut components = [0; 4];
    for (to, from) in components.iter_mut().zip(outer.as_slice()) {
        *to = inner.as_slice().get(usize::from(*from)).copied().unwrap_or(0);
    }
    Swizzle { len: outer.len, components }
}

/// The offset of the path for each combination of the dynamic indices, the last one fastest.
fn offsets(path: &Path) -> Vec<u32> {
    let mut offsets = vec![path.offset];
    for dynamic in &path.dynamic {
        offsets = offsets
            .iter()
            .flat_map(|offset| (0..dynamic.count).map(move |element| offset + element * dynamic.stride))
            .collect();
    }
    offsets
}
