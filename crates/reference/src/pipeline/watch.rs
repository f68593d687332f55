//! [`Watch`]: attaches observers to machines.
//!
//! *In:* a factory of observers, if there is one. *Out:* observed machines, each for one piece of the drawing.

use crate::domain::Domain;
use crate::exec::{Code, Machine, Observer, Order, Piece, Purpose};
use glisten_scene::Draw;

/// Makes an observer for a piece of the drawing.
pub(crate) type MakeObserver<D> = dyn Fn() -> Box<dyn Observer<D>> + Sync;

/// The observers of a draw.
#[derive(Clone, Copy)]
pub(super) struct Watch<'a, D: Domain> {
    pub(super) make: Option<&'a MakeObserver<D>>,
    pub(super) draw: usize,
    pub(super) instance: u32,
    /// Whether each operation of the text needs instructions of its own.
    pub(super) unfused: bool,
}

impl<D: Domain> Watch<'_, D> {
    /// Shows once what the stage computes for all invocations.
    pub(super) fn common(&self, code: &Code, draw: &Draw, piece: Piece) {
        if let Some(make) = self.make {
            let mut machine = Machine::with(Purpose::Watching(make()), code, &draw.uniforms, &draw.textures);
            machine.end_watch(self.order(piece, 0));
        }
    }

    pub(super) fn begin(&self, machine: &mut Machine<D>) {
        if let Some(make) = self.make {
            machine.watch(make());
        }
    }

    pub(super) fn end(&self, machine: &mut Machine<D>, piece: Piece, part: usize) {
        machine.end_watch(self.order(piece, part));
    }

    fn order(&self, piece: Piece, part: usize) -> Order {
        Order { draw: self.draw, instance: self.instance, piece, part }
    }
}
