//! Calls: a function is walked again for each way in which it is called, as long as that is affordable.

use super::places::Place;
use super::store::{Cell, Key};
use super::{DEEPEST, Forward, Frame, Val, is_in};
use crate::facts::{self, Fact, Facts, What};
use glisten_front::hir::{ExprId, ExprKind, FunctionId, LocalKind, ParamMode, ScalarValue, Stmt, Storage, TypeId};
use glisten_front::source::Span;
use rustc_hash::FxHashMap;
use std::rc::Rc;

/// A function is walked again at most so often.
const MOST_CLONES: usize = 24;

/// The clones of functions.
#[derive(Default)]
pub(super) struct Variants {
    /// By function, and what is known of parameters and globals, bit by bit.
    known: FxHashMap<(FunctionId, Vec<u64>), usize>,
    finished: Vec<Finished>,
    counts: FxHashMap<FunctionId, usize>,
    /// The clone that stands for all calls.
    general: FxHashMap<FunctionId, FunctionId>,
    /// General clones whose bodies are still to be walked.
    pending: Vec<FunctionId>,
}

/// What a call comes to.
pub(super) struct Finished {
    clone: FunctionId,
    result: Facts,
    /// What parameters hold at the end.
    parameters: Vec<Facts>,
    /// Globals that were changed.
    globals: Vec<(Key, Cell)>,
    /// Whether the call comes back.
    live: bool,
}

/// An argument.
struct Argument {
    facts: Facts,
    place: Option<Place>,
    /// Whether it has the parameter's very type, so that nothing is converted on the way back.
    same: bool,
}

impl Forward<'_> {
    pub(super) fn call(&mut self, function: FunctionId, arguments: &[ExprId], own: (TypeId, Span)) -> Val {
        let mut ids = Vec::with_capacity(arguments.len());
        let mut given = Vec::with_capacity(arguments.len());
        for (index, argument) in arguments.iter().enumerate() {
            let (id, argument) = self.argument(function, index, *argument);
            ids.push(id);
            given.push(argument);
        }
        let shader = self.shader;
        let Some(body) = shader.function(function).body.as_deref() else {
            return self.give(ExprKind::Error, own, Facts::new());
        };
        let cloned = self.variants.counts.get(&function).copied().unwrap_or(0);
        if self.frames.len() >= DEEPEST || !self.may_grow() {
            return self.general_call(function, ids, &given, own);
        }
        let key = (function, self.pattern(function, &given));
        let finished = match self.variants.known.get(&key) {
            Some(index) => *index,
            None if cloned >= MOST_CLONES => return self.general_call(function, ids, &given, own),
            None => {
                *self.variants.counts.entry(function).or_default() += 1;
                let index = self.specialized(function, body, &given);
                // A walk that was given up tells nothing of the function.
                if !self.failed {
                    self.variants.known.insert(key, index);
                }
                index
            }
        };
        self.apply(finished, function, &given);
        let Some(finished) = self.variants.finished.get(finished) else {
            return self.give(ExprKind::Error, own, Facts::new());
        };
        let (clone, result) = (finished.clone, finished.result.clone());
        self.give(ExprKind::Call(clone, ids), own, result)
    }

    /// Evaluates an argument.
    fn argument(&mut self, function: FunctionId, index: usize, argument: ExprId) -> (ExprId, Argument) {
        let mode = self.shader.function(function).param_mode(index);
        if is_in(mode) {
            let value = self.eval(argument);
            return (value.id, Argument { facts: value.facts, place: None, same: true });
        }
        let (target, place) = self.path(argument);
        let facts = match (&place, mode) {
            (Some(place), ParamMode::Inout) => self.read(place),
            _ => Facts::new(),
        };
        // A parameter of another type takes the value converted.
        let param = self.shader.function(function).params().get(index).map(|param| param.ty);
        let same = param == Some(self.shader.expr(argument).ty);
        (target.id, Argument { facts: if same { facts } else { Facts::new() }, place, same })
    }

    /// The facts that a call depends on, bit by bit.
    fn pattern(&self, function: FunctionId, given: &[Argument]) -> Vec<u64> {
        let mut bits = Vec::new();
        for argument in given {
            bits.push(argument.facts.len() as u64);
            argument.facts.iter().for_each(|fact| encode(fact, &mut bits));
        }
        let effect = self.effects.function(function);
        for global in effect.names.union(&effect.writes) {
            if matches!(self.shader.global(*global).storage, Storage::Private | Storage::Out) {
                bits.push(global.index() as u64);
                self.store.get(Key(global.index() as u32)).iter().for_each(|fact| encode(fact, &mut bits));
            }
        }
        bits
    }

    /// Walks a function for one call.
    fn specialized(&mut self, function: FunctionId, body: &[Stmt], given: &[Argument]) -> usize {
        let clone = self.clone_of(function);
        let parameters: Vec<Facts> = given.iter().map(|argument| argument.facts.clone()).collect();
        let (body, mut finished) = self.walk_body(function, body, &parameters);
        finished.clone = clone;
        self.finish_clone(clone, body);
        self.variants.finished.push(finished);
        self.variants.finished.len() - 1
    }

    /// What a call changes: its globals are those of the walk, its `out` parameters go to the arguments.
    fn apply(&mut self, index: usize, function: FunctionId, given: &[Argument]) {
        let Some(finished) = self.variants.finished.get(index) else { return };
        let (parameters, live) = (finished.parameters.clone(), finished.live);
        let globals: Vec<(Key, Cell)> = finished.globals.iter().map(|(key, cell)| (*key, Rc::clone(cell))).collect();
        for (key, cell) in globals {
            self.store.set(key, cell);
        }
        self.store.live &= live;
        self.copy_back(function, given, &parameters);
    }

    /// Copies `out` and `inout` parameters back, in their order (§6.1.1).
    fn copy_back(&mut self, function: FunctionId, given: &[Argument], parameters: &[Facts]) {
        for (index, argument) in given.iter().enumerate() {
            if is_in(self.shader.function(function).param_mode(index)) {
                continue;
            }
            let Some(place) = &argument.place else { continue };
            let facts = parameters.get(index).filter(|_| argument.same).cloned().unwrap_or_default();
            self.write(place, &facts);
        }
    }

    /// Walks a body in a frame of its own.
    pub(super) fn walk_body(&mut self, function: FunctionId, body: &[Stmt], given: &[Facts]) -> (Vec<Stmt>, Finished) {
        let base = self.store.len();
        let declared = self.shader.function(function);
        for (index, local) in declared.locals.iter().enumerate() {
            let len = self.types.flat_len(local.ty);
            let facts = given.get(index).filter(|_| matches!(local.kind, LocalKind::Param(_)));
            let followed = if len > super::FOLLOWED { 0 } else { len as usize };
            self.store
                .push((0..followed).map(|scalar| facts.map_or(Fact::ANY, |facts| facts::at(facts, scalar))).collect());
        }
        let mark = self.store.mark();
        self.frames.push(Frame { function, base, mark, exits: Vec::new(), result: None });
        let (targets, forks) = (std::mem::take(&mut self.targets), self.forks);
        let body = self.statements(body);
        self.targets = targets;
        self.forks = forks;
        let finished = self.end_frame(function);
        (body, finished)
    }

    fn end_frame(&mut self, function: FunctionId) -> Finished {
        let Some(frame) = self.frames.pop() else {
            let (parameters, globals) = (Vec::new(), Vec::new());
            return Finished { clone: FunctionId::new(0), result: Facts::new(), parameters, globals, live: true };
        };
        for exit in &frame.exits {
            self.store.meet(exit, frame.mark);
        }
        let params = 0..self.shader.function(function).param_count as u32;
        let parameters = params.map(|index| Facts::from_slice(self.store.get(Key(frame.base + index)))).collect();
        let globals = self.store.changes(frame.mark).0.into_iter().filter(|(key, _)| key.0 < frame.base);
        let globals: Vec<(Key, Cell)> =
            globals.filter(|(key, _)| (key.0 as usize) < self.shader.globals.len()).collect();
        self.store.truncate(frame.base);
        let live = self.store.live;
        Finished { clone: FunctionId::new(0), result: frame.result.unwrap_or_default(), parameters, globals, live }
    }

    /// A place for a clone, whose body comes later.
    pub(super) fn clone_of(&mut self, function: FunctionId) -> FunctionId {
        let id = FunctionId::new(self.out.functions.len());
        let mut clone = self.shader.function(function).clone();
        clone.body = None;
        self.out.functions.push(clone);
        self.origins.push(function);
        id
    }

    pub(super) fn finish_clone(&mut self, clone: FunctionId, body: Vec<Stmt>) {
        if let Some(function) = self.out.functions.get_mut(clone.index()) {
            function.body = Some(body);
        }
    }

    /// A call of the clone that stands for all calls: nothing is known of what it does.
    fn general_call(&mut self, function: FunctionId, ids: Vec<ExprId>, given: &[Argument], own: (TypeId, Span)) -> Val {
        let clone = match self.variants.general.get(&function) {
            Some(clone) => *clone,
            None => {
                let clone = self.clone_of(function);
                self.variants.general.insert(function, clone);
                self.variants.pending.push(function);
                clone
            }
        };
        let written: Vec<_> = self.effects.function(function).writes.iter().copied().collect();
        for global in written {
            self.store.forget(Key(global.index() as u32));
        }
        self.copy_back(function, given, &[]);
        let facts = crate::fast::finite(self.math, self.types, own.0, Facts::new());
        self.give(ExprKind::Call(clone, ids), own, facts)
    }

    /// Walks the bodies of the clones that stand for all calls.
    pub(super) fn walk_general(&mut self) {
        while let Some(function) = self.variants.pending.pop() {
            self.store.live = true;
            for (id, global) in self.shader.globals() {
                if matches!(global.storage, Storage::Private | Storage::Out) {
                    self.store.forget(Key(id.index() as u32));
                }
            }
            let shader = self.shader;
            let body = shader.function(function).body.as_deref().unwrap_or(&[]);
            let (body, _) = self.walk_body(function, body, &[]);
            if let Some(clone) = self.variants.general.get(&function).copied() {
                self.finish_clone(clone, body);
            }
        }
    }
}

fn encode(fact: &Fact, bits: &mut Vec<u64>) {
    let has_norm = fact.norm.is_finite();
    let flags = u64::from(fact.constant)
        | u64::from(fact.bound) << 1
        | u64::from(fact.scaled) << 10
        | u64::from(fact.up) << 11
        | u64::from(has_norm) << 12;
    if has_norm {
        bits.push(u64::from(fact.norm.to_bits()));
    }
    match fact.what {
        What::Any => bits.push(flags),
        What::Value(value) => {
            let (kind, value) = match value {
                ScalarValue::Bool(value) => (1, u32::from(value)),
                ScalarValue::Int(value) => (2, value as u32),
                ScalarValue::Uint(value) => (3, value),
                ScalarValue::Float(value) => (4, value.to_bits()),
            };
            bits.push(flags | kind << 2 | u64::from(value) << 32);
        }
        What::Int(low, high) => bits.extend([flags | 5 << 2, u64::from(low as u32) << 32 | u64::from(high as u32)]),
        What::Uint(low, high) => bits.extend([flags | 6 << 2, u64::from(low) << 32 | u64::from(high)]),
        What::Float(range) => {
            let kinds = u64::from(range.nan) << 8 | u64::from(range.negative_zero) << 9;
            bits.extend([flags | 7 << 2 | kinds, range.low.to_bits(), range.high.to_bits()]);
        }
    }
}
