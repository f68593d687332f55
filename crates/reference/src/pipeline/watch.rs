//! [`Watch`]: gives machines their observers.
//!
//! *In:* what makes observers, if anything does. *Out:* machines that are watched, each for one piece of the drawing.

use crate::domain::Domain;
use crate::exec::{Code, Machine, Observer, Order};
use glisten_scene::Draw;

/// Makes an observer for a piece of the drawing.
pub(crate) type MakeObserver<D> = dyn Fn() -> Box<dyn Observer<D>> + Sync;

/// Who watches a draw.
#[derive(Clone, Copy)]
pub(super) struct Watch<'a, D: Domain> {
    pub(super) make: Option<&'a MakeObserver<D>>,
    pub(super) draw: usize,
    pub(super) instance: u32,
    /// Whether each operation of the text shall have instructions of its own.
    pub(super) apart: bool,
}

/// What [`Order::stage`] says.
pub(super) const SAME_FOR_VERTICES: u8 = 0;
pub(super) const SAME_FOR_FRAGMENTS: u8 = 1;
pub(super) const VERTICES: u8 = 2;
pub(super) const FRAGMENTS: u8 = 3;

impl<D: Domain> Watch<'_, D> {
    /// Shows once what the stage computes for all invocations alike.
    pub(super) fn common(&self, code: &Code, draw: &Draw, stage: u8) {
        if let Some(make) = self.make {
            Machine::watched(code, &draw.uniforms, &draw.textures, make()).end_watch(self.order(stage, 0));
        }
    }

    pub(super) fn begin(&self, machine: &mut Machine<D>) {
        if let Some(make) = self.make {
            machine.watch(make());
        }
    }

    pub(super) fn end(&self, machine: &mut Machine<D>, stage: u8, part: usize) {
        machine.end_watch(self.order(stage, part));
    }

    fn order(&self, stage: u8, part: usize) -> Order {
        Order { draw: self.draw, instance: self.instance, stage, part }
    }
}
