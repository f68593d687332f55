//! Variables during compilation: the values or homes of their scalars.

use super::super::code::{Form, Port};
use super::super::inst::{Class, Operand};
use super::effects::Assigned;
use super::{Compiler, Val};
use glisten_front::hir::{Global, GlobalId, LocalId, ScalarValue, Stage, Storage, TypeId, Value, VarRef};
use glisten_front::link::RootIndex;
use glisten_front::link::usage::first_use;
use glisten_front::source::Span;
use std::rc::Rc;

/// The index of a variable in [`Compiler::vars`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct VarId(pub(super) usize);

/// A variable during compilation.
pub(super) struct Var {
    pub(super) classes: Rc<[Class]>,
    /// The current value of each scalar; `None`, which is 0, if nothing was assigned.
    values: Vec<Option<Operand>>,
    homes: Vec<Option<Operand>>,
    /// The region that declares it.
    region: u32,
    /// Whether lanes that leave a function early still need it.
    outlives: bool,
    /// Whether it was ever assigned.
    written: bool,
}

impl Compiler<'_> {
    /// Declares a variable in the current region.
    pub(super) fn declare(&mut self, ty: TypeId, outlives: bool) -> VarId {
        let classes = self.classes(ty);
        let count = classes.len();
        self.vars.push(Var {
            classes,
            values: vec![None; count],
            homes: vec![None; count],
            region: self.region,
            outlives,
            written: false,
        });
        VarId(self.vars.len() - 1)
    }

    /// Declares all globals, with their initial values.
    pub(super) fn declare_globals(&mut self) {
        let shader = self.shader;
        for (id, global) in shader.globals() {
            let var = self.declare(global.ty, true);
            if let Some(entry) = self.globals.get_mut(id.index()) {
                *entry = Some(var);
            }
            let values = match global.storage {
                Storage::Const if global.initializer.is_some_and(|init| self.is_open(init)) => {
                    self.open.insert(var);
                    None
                }
                Storage::Const => global.value.as_ref().map(|value| self.constant(value)),
                Storage::Uniform => Some(self.uniform(id, global)),
                // Registers are assigned when they are first read.
                Storage::In => None,
                Storage::Private | Storage::Out => None,
            };
            if let (Some(values), Some(var)) = (values, self.vars.get_mut(var.0)) {
                var.values = values.into_iter().map(Some).collect();
            }
        }
        for (id, global) in shader.globals() {
            let is_open = global.initializer.is_some_and(|init| self.is_open(init));
            let known = global.value.as_ref().filter(|_| !is_open);
            if let (Storage::Const | Storage::Private, None, Some(init)) = (global.storage, known, global.initializer) {
                let value = self.expr(init);
                if let Some(Some(var)) = self.globals.get(id.index()).copied() {
                    self.assign_all(var, &value);
                }
            } else if let (Storage::Private, Some(value)) = (global.storage, &global.value) {
                let value = self.constant(value);
                if let Some(Some(var)) = self.globals.get(id.index()).copied() {
                    self.assign_all(var, &value);
                }
            }
        }
    }

    pub(super) fn constant(&mut self, value: &Value) -> Val {
        value.scalars.iter().map(|scalar| self.literal(*scalar)).collect()
    }

    pub(super) fn literal(&mut self, value: ScalarValue) -> Operand {
        match value {
            ScalarValue::Bool(value) => self.emit.int(u32::from(value)),
            ScalarValue::Int(value) => self.emit.int(value as u32),
            ScalarValue::Uint(value) => self.emit.int(value),
            ScalarValue::Float(value) => self.emit.float(value),
        }
    }

    /// The pool indices of a uniform's scalars; for samplers, the numbers of their slots.
    fn uniform(&mut self, id: GlobalId, global: &Global) -> Val {
        let end = (self.shader.stage, id);
        let interface = &self.program.interface;
        let root = interface.roots.iter().position(|root| root.globals.contains(&end));
        let classes = self.classes(global.ty);
        let mut values: Val = (classes.iter().enumerate())
            .map(|(flat, class)| match root {
                Some(root) => self.emit.uniform(*class, RootIndex(root as u32), flat as u32),
                None => self.emit.zero(*class),
            })
            .collect();
        for (slot, sampler) in interface.samplers.iter().enumerate() {
            if sampler.globals.contains(&end)
                && let Some(value) = values.get_mut(sampler.flat_offset as usize)
            {
                *value = self.emit.int(slot as u32);
            }
        }
        values
    }

    pub(super) fn global_var(&self, id: GlobalId) -> Option<VarId> {
        self.globals.get(id.index()).copied().flatten()
    }

    pub(super) fn local_var(&self, id: LocalId) -> Option<VarId> {
        self.frames.last()?.locals.get(id.index()).copied().flatten()
    }

    pub(super) fn var_of(&self, var: VarRef) -> Option<VarId> {
        match var {
            VarRef::Global(id) => self.global_var(id),
            VarRef::Local(id) => self.local_var(id),
        }
    }

    /// Binds a local of the function that is being inlined.
    pub(super) fn bind(&mut self, local: LocalId, var: VarId) {
        if let Some(frame) = self.frames.last_mut()
            && let Some(entry) = frame.locals.get_mut(local.index())
        {
            *entry = Some(var);
        }
    }

    /// The current value of one scalar.
    pub(super) fn read(&mut self, var: VarId, flat: usize) -> Operand {
        let Some(known) = self.vars.get(var.0).and_then(|var| var.values.get(flat).copied()) else {
            return self.emit.zero(Class::Float);
        };
        known.unwrap_or_else(|| self.first_read(var, flat))
    }

    /// The first read: for an input, a register that the caller fills; for anything else 0, since nothing was
    /// assigned.
    fn first_read(&mut self, var: VarId, flat: usize) -> Operand {
        let Some(class) = self.vars.get(var.0).and_then(|var| var.classes.get(flat).copied()) else {
            return self.emit.zero(Class::Float);
        };
        let input = (self.globals.iter().position(|global| *global == Some(var)))
            .filter(|index| self.shader.globals.get(*index).is_some_and(|global| global.storage == Storage::In));
        let Some(index) = input else { return self.unwritten(var, class) };
        let register = self.emit.temp(class);
        let global = GlobalId::new(index);
        self.inputs.push(Port { global, flat: flat as u32, class, register: register.number() });
        if let Some(value) = self.vars.get_mut(var.0).and_then(|var| var.values.get_mut(flat)) {
            *value = Some(register);
        }
        register
    }

    /// A scalar of a variable to which nothing was assigned: 0, or a number to be guessed.
    fn unwritten(&mut self, var: VarId, class: Class) -> Operand {
        let declaration = if self.emit.form == Form::Guessed { self.declaration(var) } else { None };
        let Some(span) = declaration else { return self.emit.zero(class) };
        let index = self.unwritten_at(span);
        self.emit.unwritten(class, index)
    }

    /// The number of a declaration among those without a value.
    fn unwritten_at(&mut self, span: Span) -> u32 {
        let known = self.unwritten.iter().position(|known| *known == span);
        known.unwrap_or_else(|| {
            self.unwritten.push(span);
            self.unwritten.len() - 1
        }) as u32
    }

    /// The declaration of a variable of the text. Of built-in ones, only an output that some path writes may lack a value; its place is
    /// where it is first named (GLSL 1.50 §7.1, §7.2).
    fn declaration(&self, var: VarId) -> Option<Span> {
        if let Some(index) = self.globals.iter().position(|global| *global == Some(var)) {
            let global = self.shader.globals.get(index)?;
            if global.builtin.is_none() {
                return Some(global.span);
            }
            let is_output = global.storage == Storage::Out && global.written;
            return is_output.then(|| first_use(self.shader, GlobalId::new(index))).flatten();
        }
        if let Some(frame) = self.frames.iter().rev().find(|frame| frame.result == Some(var)) {
            // A function that may end without `return` has an undefined result (§6.1).
            let function = self.shader.function(frame.function);
            return function.body.as_deref().filter(|body| !super::ends::always_leaves(body)).map(|_| function.span);
        }
        let frame = self.frames.iter().rev().find_map(|frame| {
            let local = frame.locals.iter().position(|local| *local == Some(var))?;
            Some((frame.function, local))
        });
        let (function, local) = frame?;
        self.shader.function(function).locals.get(local).filter(|local| !local.name.is_empty()).map(|local| local.span)
    }

    /// The current values of all scalars.
    pub(super) fn read_all(&mut self, var: VarId) -> Val {
        let count = self.vars.get(var.0).map_or(0, |var| var.classes.len());
        (0..count).map(|flat| self.read(var, flat)).collect()
    }

    fn home(&mut self, var: VarId, flat: usize) -> Operand {
        let (class, known) = match self.vars.get(var.0) {
            Some(var) => {
                (var.classes.get(flat).copied().unwrap_or(Class::Float), var.homes.get(flat).copied().flatten())
            }
            None => (Class::Float, None),
        };
        known.unwrap_or_else(|| {
            let home = self.emit.home(class);
            if let Some(entry) = self.vars.get_mut(var.0).and_then(|var| var.homes.get_mut(flat)) {
                *entry = Some(home);
            }
            home
        })
    }

    /// Moves one scalar to its home, and returns that.
    pub(super) fn settle(&mut self, var: VarId, flat: usize) -> Operand {
        let value = self.read(var, flat);
        let home = self.home(var, flat);
        if value != home {
            let class = self.vars.get(var.0).and_then(|var| var.classes.get(flat).copied()).unwrap_or(Class::Float);
            self.emit.copy(class, home, value);
            if let Some(entry) = self.vars.get_mut(var.0).and_then(|var| var.values.get_mut(flat)) {
                *entry = Some(home);
            }
        }
        home
    }

    /// Moves the scalars that a construct assigns to their homes, before lanes diverge.
    pub(super) fn settle_assigned(&mut self, assigned: &Assigned) {
        let locals = assigned.locals.iter().filter_map(|local| self.local_var(*local)).collect::<Vec<_>>();
        let globals = assigned.globals.iter().filter_map(|global| self.global_var(*global)).collect::<Vec<_>>();
        for var in locals.into_iter().chain(globals) {
            let count = self.vars.get(var.0).map_or(0, |var| var.classes.len());
            for flat in 0..count {
                self.settle(var, flat);
            }
        }
    }

    /// Assigns one scalar in the active lanes.
    pub(super) fn assign(&mut self, var: VarId, flat: usize, value: Operand) {
        let Some(state) = self.vars.get_mut(var.0) else { return };
        state.written = true;
        let class = state.classes.get(flat).copied().unwrap_or(Class::Float);
        if state.region == self.region && !(state.outlives && self.parted) {
            let kept = self.emit.keep(class, value);
            if let Some(entry) = self.vars.get_mut(var.0).and_then(|var| var.values.get_mut(flat)) {
                *entry = Some(kept);
            }
            return;
        }
        let home = self.settle(var, flat);
        if home != value {
            self.emit.store(class, home, value);
        }
    }

    pub(super) fn assign_all(&mut self, var: VarId, values: &[Operand]) {
        for (flat, value) in values.iter().enumerate() {
            self.assign(var, flat, *value);
        }
    }

    /// Records a store through an index.
    pub(super) fn mark_written(&mut self, var: VarId) {
        if let Some(var) = self.vars.get_mut(var.0) {
            var.written = true;
        }
    }

    /// Moves every output to a register that persists.
    pub(super) fn settle_outputs(&mut self) -> Vec<Port> {
        let mut ports = Vec::new();
        let mut never_written = Vec::new();
        for (global, facts) in self.shader.globals() {
            let Some(var) = self.global_var(global).filter(|_| facts.storage == Storage::Out) else { continue };
            if !self.vars.get(var.0).is_some_and(|var| var.written) {
                let is_color = self.shader.stage == Stage::Fragment && facts.builtin.is_none();
                if is_color && self.emit.form == Form::Guessed {
                    never_written.push(facts.span);
                }
                continue;
            }
            let classes = self.vars.get(var.0).map(|var| Rc::clone(&var.classes)).unwrap_or_else(|| Rc::new([]));
            for (flat, class) in classes.iter().enumerate() {
                let register = self.settle(var, flat);
                ports.push(Port { global, flat: flat as u32, class: *class, register: register.number() });
            }
        }
        // The last one: `Machine::never_written`.
        never_written.into_iter().for_each(|span| self.unwritten.push(span));
        ports
    }
}
