//! [`Recorder`]: collects the notes of followed invocations.
//!
//! *In:* the notes of a machine, and which of its lanes are followed. *Out:* [`Invocation`]s. *Holds:* their order does not
//! depend on threads.

use super::{Component, Entry, Invocation, MOST_ENTRIES, component};
use crate::domain::{Domain, Integer};
use crate::exec::{Event, Fate, Invoked, LANES, NoteKind, Noted, NotedScalar, Observer, Order};
use glisten_front::hir::{Scalar, Stage};
use std::sync::{Arc, Mutex, PoisonError};

/// The invocations that all recorders of a drawing have recorded.
#[derive(Debug, Default)]
pub(super) struct Recordings(Mutex<Vec<(Order, Vec<Invocation>)>>);

impl Recordings {
    /// The invocations in the order in which they are drawn.
    pub(super) fn in_order(&self) -> Vec<Invocation> {
        let mut all = std::mem::take(&mut *self.0.lock().unwrap_or_else(PoisonError::into_inner));
        all.sort_by_key(|(order, _)| *order);
        all.into_iter().flat_map(|(_, invocations)| invocations).collect()
    }
}

/// Records one piece of a drawing.
#[derive(Debug)]
pub(super) struct Recorder {
    all: Arc<Recordings>,
    found: Vec<Invocation>,
    /// The invocation in each lane, by its index in `found`, and the number of calls around what it runs.
    followed: [Option<(usize, usize)>; LANES],
}

impl Recorder {
    pub(super) fn new(all: &Arc<Recordings>) -> Self {
        Self { all: Arc::clone(all), found: Vec::new(), followed: [None; LANES] }
    }
}

impl<D: Domain> Observer<D> for Recorder {
    fn see(&mut self, _: &Event<'_, D>) {}

    fn follows(&mut self, lane: usize, invoked: &Invoked) {
        let (stage, instance) = match *invoked {
            Invoked::Vertex { instance, .. } => (Stage::Vertex, instance),
            Invoked::Fragment { .. } => (Stage::Fragment, 0),
        };
        if let Some(slot) = self.followed.get_mut(lane) {
            *slot = Some((self.found.len(), 0));
        }
        self.found.push(Invocation {
            draw: 0,
            instance,
            stage,
            invoked: *invoked,
            vertices: Vec::new(),
            fate: Fate::Done,
            entries: Vec::new(),
            left_out: 0,
        });
    }

    fn note(&mut self, noted: &Noted<'_, D>) {
        for lane in noted.lanes.lanes() {
            let Some(Some((index, depth))) = self.followed.get_mut(lane) else { continue };
            let Some(invocation) = self.found.get_mut(*index) else { continue };
            if noted.note.kind == NoteKind::Return {
                *depth = depth.saturating_sub(1);
            }
            if invocation.entries.len() < MOST_ENTRIES || noted.note.kind == NoteKind::Output {
                invocation.entries.push(entry(noted, lane, *depth));
            } else {
                invocation.left_out += 1;
            }
            *depth += usize::from(noted.note.kind == NoteKind::Call);
        }
    }

    fn ended(&mut self, lane: usize, fate: Fate) {
        let Some((index, _)) = self.followed.get_mut(lane).and_then(Option::take) else { return };
        if let Some(invocation) = self.found.get_mut(index) {
            invocation.fate = fate;
        }
    }

    fn finish(mut self: Box<Self>, order: Order) {
        if self.found.is_empty() {
            return;
        }
        for invocation in &mut self.found {
            invocation.draw = order.draw;
            if invocation.stage == Stage::Fragment {
                invocation.instance = order.instance;
            }
        }
        let mut all = self.all.0.lock().unwrap_or_else(PoisonError::into_inner);
        all.push((order, std::mem::take(&mut self.found)));
    }
}

fn entry<D: Domain>(noted: &Noted<'_, D>, lane: usize, depth: usize) -> Entry {
    let scalar = |(values, scalar): (&NotedScalar<'_, D>, &Option<Scalar>)| match values {
        NotedScalar::Float(values) => component(values.at(lane)),
        NotedScalar::Int(values) => integer(values.at(lane).bits(), *scalar),
    };
    Entry {
        kind: noted.note.kind,
        span: noted.note.span,
        name: noted.note.name.clone(),
        ty: noted.note.ty,
        depth,
        scalars: noted.scalars.iter().zip(&noted.note.scalars).map(scalar).collect(),
    }
}

fn integer(bits: u32, scalar: Option<Scalar>) -> Component {
    match scalar {
        Some(Scalar::Bool) => Component::Bool(bits != 0),
        Some(Scalar::Uint) => Component::Uint(bits),
        Some(Scalar::Int | Scalar::Float) => Component::Int(bits as i32),
        None => Component::Sampler(bits),
    }
}
