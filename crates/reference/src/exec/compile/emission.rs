//! Compiles `EmitVertex` and `EndPrimitive` (GLSL 1.50 §8.10).
//!
//! An emitted vertex has the current values of all outputs that the stage writes anywhere; those that are not assigned yet
//! are 0. Outputs keep their values after `EmitVertex`, although §8.10 leaves them undefined: that is what drivers do.

use super::super::inst::{Class, Inst, Operand};
use super::{Compiler, Val};
use glisten_front::hir::{GlobalId, Stage, Storage};
use std::rc::Rc;

impl Compiler<'_> {
    /// `EmitVertex()`
    pub(super) fn emit_vertex(&mut self) -> Val {
        let mut values: [Vec<Operand>; 2] = Default::default();
        for (global, flat, class) in self.emitted_scalars() {
            if let Some(var) = self.global_var(global) {
                let value = self.read(var, flat as usize);
                values[class as usize].push(value);
            }
        }
        let [floats, ints] = values;
        let floats = self.emit.list(Class::Float, &floats, false);
        let ints = self.emit.list(Class::Int, &ints, false);
        self.emit.push(Inst::Emit { floats, ints });
        Val::new()
    }

    /// `EndPrimitive()`
    pub(super) fn end_primitive(&mut self) -> Val {
        self.emit.push(Inst::EndPrimitive);
        Val::new()
    }

    /// The scalars of an emitted vertex, floats and ints.
    pub(super) fn emitted_places(&mut self) -> [Vec<(GlobalId, u32)>; 2] {
        let mut places: [Vec<(GlobalId, u32)>; 2] = Default::default();
        if self.shader.stage == Stage::Geometry {
            for (global, flat, class) in self.emitted_scalars() {
                places[class as usize].push((global, flat));
            }
        }
        places
    }

    fn emitted_scalars(&mut self) -> Vec<(GlobalId, u32, Class)> {
        let mut list = Vec::new();
        for (id, global) in self.shader.globals() {
            if global.storage != Storage::Out || !global.written {
                continue;
            }
            let classes = Rc::clone(&self.classes(global.ty));
            list.extend((0..).zip(classes.iter()).map(|(flat, class)| (id, flat, *class)));
        }
        list
    }
}
