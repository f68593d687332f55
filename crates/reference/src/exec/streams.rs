//! The vertices that a geometry stage emits: a [`Stream`] for each lane (GLSL 1.50 §8.10).
//!
//! *In:* the instructions for `EmitVertex` and `EndPrimitive`, as lanes reach them. *Out:* each lane's vertices in order,
//! and where primitives end. *Holds:* vertices beyond `max_vertices` are dropped (§4.3.8.2 leaves them undefined). Where
//! lanes take several ways ([`ways`](super::ways)) that emit alike, the numbers are joined; if the ways emit differently,
//! the stream has the vertices of all of them, and is undecided.

use super::LANES;
use crate::domain::{Domain, Integer, Number};
use glisten_scene::picture::Interval;

/// The vertices that one invocation emitted.
#[derive(Clone, Debug)]
pub struct Stream<D: Domain> {
    /// The floats of all vertices.
    pub floats: Vec<D::Float>,
    /// The ints of all vertices.
    pub ints: Vec<D::Int>,
    /// After how many vertices primitives end, ascending.
    pub ends: Vec<u32>,
    /// The number of vertices.
    pub count: u32,
    /// Whether conforming GPUs may emit something else.
    pub undecided: bool,
}

impl<D: Domain> Default for Stream<D> {
    fn default() -> Self {
        Self { floats: Vec::new(), ints: Vec::new(), ends: Vec::new(), count: 0, undecided: false }
    }
}

impl<D: Domain> Stream<D> {
    fn clear(&mut self) {
        self.floats.clear();
        self.ints.clear();
        self.ends.clear();
        (self.count, self.undecided) = (0, false);
    }

    fn end(&mut self) {
        if self.ends.last().copied().unwrap_or(0) < self.count {
            self.ends.push(self.count);
        }
    }

    /// Joins the vertices of another way.
    fn join(&mut self, other: &Self) {
        if self.count == other.count && self.ends == other.ends {
            self.undecided |= other.undecided;
            self.floats.iter_mut().zip(&other.floats).for_each(|(own, new)| *own = own.joined(*new));
            self.ints.iter_mut().zip(&other.ints).for_each(|(own, new)| *own = own.joined(*new));
            return;
        }
        self.end();
        let before = self.count;
        self.floats.extend_from_slice(&other.floats);
        self.ints.extend_from_slice(&other.ints);
        self.ends.extend(other.ends.iter().map(|end| before + end));
        self.count += other.count;
        self.undecided = true;
    }

    /// Forgets all bounds.
    fn unlimit(&mut self) {
        self.undecided = true;
        let any = |number: &mut D::Float| *number = D::Float::with_interval(number.value(), Interval::ALL);
        self.floats.iter_mut().for_each(any);
        let any = |number: &mut D::Int| *number = D::Int::with_interval(number.bits(), i32::MIN, i32::MAX);
        self.ints.iter_mut().for_each(any);
    }
}

/// The streams of all lanes; none unless the stage emits.
#[derive(Clone, Debug)]
pub(super) struct Streams<D: Domain> {
    lanes: Vec<Stream<D>>,
    most: u32,
}

impl<D: Domain> Streams<D> {
    pub(super) fn new(emits: bool, most: u32) -> Self {
        Self { lanes: vec![Stream::default(); if emits { LANES } else { 0 }], most }
    }

    pub(super) fn clear(&mut self) {
        self.lanes.iter_mut().for_each(Stream::clear);
    }

    /// Replaces the streams of some lanes by those of others.
    pub(super) fn copy(&mut self, from: usize, to: usize, count: usize) {
        for lane in 0..count {
            if let Some(stream) = self.lanes.get(from + lane).cloned()
                && let Some(place) = self.lanes.get_mut(to + lane)
            {
                *place = stream;
            }
        }
    }

    /// Joins the streams of some lanes with those of others.
    pub(super) fn join(&mut self, from: usize, into: usize, count: usize) {
        for lane in 0..count {
            if let Some(stream) = self.lanes.get(from + lane).cloned() {
                self.join_one(&stream, into + lane, false);
            }
        }
    }

    /// Joins a stream with that of a lane, or replaces it.
    pub(super) fn join_one(&mut self, stream: &Stream<D>, into: usize, fresh: bool) {
        let limit = self.most.saturating_mul(4);
        let Some(place) = self.lanes.get_mut(into) else { return };
        if fresh {
            *place = stream.clone();
        } else if place.count.saturating_add(stream.count) <= limit || place.count == stream.count {
            place.join(stream);
        } else {
            place.undecided = true;
        }
    }

    /// The stream of a lane that may still emit.
    pub(super) fn open(&mut self, lane: usize) -> Option<&mut Stream<D>> {
        let most = self.most;
        self.lanes.get_mut(lane).filter(|stream| stream.count < most)
    }

    /// Ends the primitive of a lane.
    pub(super) fn end(&mut self, lane: usize) {
        self.lanes.get_mut(lane).into_iter().for_each(Stream::end);
    }

    pub(super) fn get(&self, lane: usize) -> Option<&Stream<D>> {
        self.lanes.get(lane)
    }

    pub(super) fn unlimit(&mut self, lane: usize) {
        self.lanes.get_mut(lane).into_iter().for_each(Stream::unlimit);
    }
}
