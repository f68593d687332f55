//! Variables and their parts: what is known of them, and what an assignment changes.

use super::store::Key;
use super::{Forward, Val};
use crate::facts::{self, Fact, Facts};
use glisten_front::hir::{Expr, ExprId, ExprKind, ScalarValue, Type, TypeId};
use smallvec::SmallVec;

/// A part of a variable.
#[derive(Clone, Debug)]
pub(super) struct Place {
    key: Key,
    /// The first scalar, and how many follow.
    start: u32,
    len: u32,
    /// Indices that are not known.
    open: SmallVec<[Open; 2]>,
    /// Of a swizzle: the components in its order.
    components: Option<SmallVec<[u8; 4]>>,
}

/// What an index that is not known chooses among.
#[derive(Clone, Debug)]
enum Open {
    /// So many parts, each of so many scalars.
    Parts { len: u32, count: u32 },
    /// The components of a swizzle.
    Components(SmallVec<[u8; 4]>),
}

impl Open {
    /// Where the parts start, from the start of the whole on.
    fn starts(&self) -> SmallVec<[u32; 4]> {
        match self {
            Self::Parts { len, count } => (0..*count).map(|index| index * len).collect(),
            Self::Components(components) => components.iter().map(|component| u32::from(*component)).collect(),
        }
    }

    fn count(&self) -> u64 {
        match self {
            Self::Parts { count, .. } => u64::from(*count),
            Self::Components(components) => components.len() as u64,
        }
    }
}

/// At most so many parts are looked at for an index that is not known.
const MOST_PARTS: u64 = 1 << 12;

impl Place {
    /// The starts of all parts that it may be; `None` if they are too many.
    fn starts(&self) -> Option<Vec<u32>> {
        let count = self.open.iter().fold(1u64, |count, open| count.saturating_mul(open.count()));
        if count.saturating_mul(u64::from(self.len)) > MOST_PARTS {
            return None;
        }
        let mut starts = vec![self.start];
        for open in &self.open {
            let own = open.starts();
            starts = starts.iter().flat_map(|start| own.iter().map(move |offset| start + offset)).collect();
        }
        Some(starts)
    }

    /// The scalars from a start on, in the order of the value.
    fn scalars(&self, start: u32) -> SmallVec<[u32; 4]> {
        match &self.components {
            Some(components) => components.iter().map(|component| start + u32::from(*component)).collect(),
            None => (start..start + self.len).collect(),
        }
    }
}

impl Forward<'_> {
    /// Writes down what names a variable or a part of something. The place is there if it is a variable's.
    pub(super) fn path(&mut self, id: ExprId) -> (Val, Option<Place>) {
        let Expr { kind, ty, span } = self.shader.expr(id).clone();
        match kind {
            ExprKind::Var(variable) => {
                let len = self.types.flat_len(ty);
                let place = Place { key: self.key(variable), start: 0, len, open: SmallVec::new(), components: None };
                self.named(ExprKind::Var(variable), (ty, span), Some(place), Facts::new())
            }
            ExprKind::Member(base, member) => {
                let base_ty = self.shader.expr(base).ty;
                let (base, place) = self.path(base);
                let start = self.member_start(base_ty, member);
                let len = self.types.flat_len(ty);
                let part = part(&base.facts, start, len);
                let place = place.map(|place| Place { start: place.start + start, len, ..place });
                self.named(ExprKind::Member(base.id, member), (ty, span), place, part)
            }
            ExprKind::Index(base, index) => self.element(base, index, (ty, span)),
            ExprKind::Swizzle(base, swizzle) => {
                let (base, place) = self.path(base);
                let order = swizzle.as_slice();
                let facts = if base.facts.is_empty() {
                    Facts::new()
                } else {
                    order.iter().map(|component| facts::at(&base.facts, usize::from(*component))).collect()
                };
                let place = place.map(|place| {
                    let components = match &place.components {
                        Some(inner) => order.iter().filter_map(|c| inner.get(usize::from(*c)).copied()).collect(),
                        None => SmallVec::from_slice(order),
                    };
                    Place { components: Some(components), ..place }
                });
                self.named(ExprKind::Swizzle(base.id, swizzle), (ty, span), place, facts)
            }
            _ => (self.eval_value(id), None),
        }
    }

    fn element(
        &mut self,
        base: ExprId,
        index: ExprId,
        own: (TypeId, glisten_front::source::Span),
    ) -> (Val, Option<Place>) {
        let base_ty = self.shader.expr(base).ty;
        let (base, place) = self.path(base);
        let index = self.eval(index);
        let len = self.types.flat_len(own.0);
        let count = self.elements(base_ty);
        let kind = ExprKind::Index(base.id, index.id);
        match whole(facts::at(&index.facts, 0)) {
            Some(known) => {
                // The reference limits an index into range.
                let start = known.clamp(0, i64::from(count.max(1)) - 1) as u32 * len;
                let facts = part(&base.facts, start, len);
                let place = place.map(|place| match &place.components {
                    Some(components) => {
                        let component = components.get(start as usize).copied().unwrap_or(0);
                        Place { components: Some(SmallVec::from_slice(&[component])), ..place }
                    }
                    None => Place { start: place.start + start, len, ..place },
                });
                self.named(kind, own, place, facts)
            }
            None => {
                let facts = if base.facts.is_empty() {
                    Facts::new()
                } else {
                    let parts = (0..count).map(|element| part(&base.facts, element * len, len));
                    parts.reduce(|a, b| facts::join(&a, &b)).unwrap_or_default()
                };
                let facts = facts.into_iter().map(|fact| Fact { constant: false, ..fact }).collect();
                let place = place.map(|place| {
                    let Place { key, start, mut open, components, .. } = place;
                    open.push(components.map_or(Open::Parts { len, count }, Open::Components));
                    Place { key, start, len, open, components: None }
                });
                self.named(kind, own, place, facts)
            }
        }
    }

    /// Writes a path down, with the facts of its place or, where it is none, of the value.
    fn named(
        &mut self,
        kind: ExprKind,
        (ty, span): (TypeId, glisten_front::source::Span),
        place: Option<Place>,
        facts: Facts,
    ) -> (Val, Option<Place>) {
        let facts = match &place {
            // A whole array is looked at element by element.
            Some(place) if place.len <= super::NOTED as u32 || place.components.is_some() => self.read(place),
            Some(_) => Facts::new(),
            None => facts,
        };
        // A vector's length limits its components together alone.
        let is_part = matches!(kind, ExprKind::Swizzle(..)) || self.types.flat_len(ty) == 1;
        let facts = if is_part { facts.into_iter().map(Fact::apart).collect() } else { facts };
        let small = self.types.flat_len(ty) <= super::NOTED as u32;
        let facts = if small { crate::fast::finite(self.math, self.types, ty, facts) } else { facts };
        let id = self.push(kind, ty, span, &facts);
        (Val { id, facts }, place)
    }

    /// What is known of a part of a variable.
    pub(super) fn read(&self, place: &Place) -> Facts {
        let cell = self.store.get(place.key);
        if cell.is_empty() {
            return Facts::new();
        }
        let value = |start: u32| -> Facts {
            place.scalars(start).iter().map(|scalar| facts::at(cell, *scalar as usize)).collect()
        };
        if place.open.is_empty() {
            return value(place.start);
        }
        let Some(starts) = place.starts() else { return Facts::new() };
        let joined = starts.into_iter().map(value).reduce(|a, b| facts::join(&a, &b)).unwrap_or_default();
        joined.into_iter().map(|fact| Fact { constant: false, ..fact }).collect()
    }

    /// A value is assigned to a part of a variable.
    pub(super) fn write(&mut self, place: &Place, value: &[Fact]) {
        if self.store.get(place.key).is_empty() {
            return;
        }
        let Some(starts) = place.starts() else {
            self.store.forget(place.key);
            return;
        };
        let sure = place.open.is_empty();
        let is_part = place.components.is_some() || place.len == 1 || value.len() == 1;
        let targets: Vec<SmallVec<[u32; 4]>> = starts.into_iter().map(|start| place.scalars(start)).collect();
        self.store.change(place.key, |cell| {
            for scalars in targets {
                for (index, scalar) in scalars.iter().enumerate() {
                    let new = facts::at(value, index);
                    let new = if is_part { new.apart() } else { new };
                    if let Some(slot) = cell.get_mut(*scalar as usize) {
                        *slot = if sure { new } else { slot.join(new) };
                    }
                }
            }
        });
    }

    /// The scalars before a member.
    pub(super) fn member_start(&self, ty: TypeId, member: u32) -> u32 {
        let Type::Struct(id) = self.types.get(ty) else { return 0 };
        let members = &self.types.structure(id).members;
        members.iter().take(member as usize).map(|member| self.types.flat_len(member.ty)).sum()
    }

    /// How many elements an index chooses among.
    fn elements(&self, ty: TypeId) -> u32 {
        match self.types.get(ty) {
            Type::Array(_, glisten_front::hir::ArraySize::Sized(size)) => size,
            Type::Matrix(columns, _) => u32::from(columns),
            Type::Vector(_, size) => u32::from(size),
            _ => 0,
        }
    }
}

/// The value of an index.
fn whole(fact: Fact) -> Option<i64> {
    match fact.value()? {
        ScalarValue::Int(value) => Some(i64::from(value)),
        ScalarValue::Uint(value) => Some(i64::from(value)),
        ScalarValue::Bool(_) | ScalarValue::Float(_) => None,
    }
}

/// A slice of facts; empty where nothing is known.
fn part(facts: &[Fact], start: u32, len: u32) -> Facts {
    facts.get(start as usize..(start + len) as usize).map_or_else(Facts::new, Facts::from_slice)
}
