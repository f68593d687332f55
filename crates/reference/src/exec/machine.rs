//! [`Machine`]: runs [`Code`] in a domain.

use super::Mask;
use super::code::{Code, Inner, PoolSource, Port};
use super::exactly::Exactly;
use super::guess::Guess;
use super::inst::Class;
use super::mute::Muted;
use super::observe::Observer;
use super::registers::{Register, Registers};
use super::streams::Streams;
use super::ways::{Ways, couples};
use crate::domain::{Domain, Integer, Lanes, Number, Profile, take_redone};
use glisten_front::hir::{GlobalId, ScalarValue, Stage};
use glisten_front::source::Span;
use glisten_scene::Texture;
use std::sync::Arc;

/// The number of instructions that loops may run in one run of a machine. Each time a loop goes back to its head, the
/// instructions between count once for all lanes. Above it, all loops are left, and [`Machine::budget_exceeded`]
/// returns true. It suffices for 65,536 iterations of a body of 256 instructions. [`Machine::limit_loops`] changes
/// it.
pub const LOOP_BUDGET: u64 = 1 << 24;

/// The last rounds that the budget of a run allows. The loops that go on in them, and no loop around them, do not end.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct LastRounds {
    /// The budget for them.
    pub(super) budget: u64,
    /// The head and the last instruction of the outermost loop that went on.
    pub(super) outermost: Option<(usize, usize)>,
}

impl LastRounds {
    /// The last rounds of a run with this budget.
    fn of(budget: u64) -> Self {
        Self { budget: budget >> 4, outermost: None }
    }

    /// Takes the cost of a round of a loop. Returns whether there was as much.
    pub(super) fn take(&mut self, cost: u64, (head, end): (usize, usize)) -> bool {
        if self.outermost.is_none_or(|known| head <= known.0 && end >= known.1) {
            self.outermost = Some((head, end));
        }
        let left = self.budget.checked_sub(cost);
        self.budget = left.unwrap_or(0);
        left.is_some()
    }
}

/// The registers of one thread for one draw. Reusable: run it tile after tile.
#[derive(Debug)]
pub struct Machine<D: Domain> {
    pub(super) code: Code,
    pub(super) registers: Registers<D>,
    pub(super) slots: Vec<u64>,
    pub(super) textures: Vec<Option<Arc<Texture>>>,
    pub(super) discarded: u64,
    pub(super) undecided: u64,
    /// Lanes that may or may not be discarded.
    pub(super) perhaps_discarded: u64,
    pub(super) ways: Ways,
    /// The vertices that a geometry stage emits.
    pub(super) streams: Streams<D>,
    /// All lanes that run.
    pub(super) whole: u64,
    /// The operation or input that adds nothing to envelopes.
    pub(super) muted: Option<Muted>,
    /// The budget of each run.
    pub(super) loop_budget: u64,
    /// The rest for this run, but for the [last rounds](Self::last).
    pub(super) budget: u64,
    /// The end of the budget, in which the loop that does not end is looked for.
    pub(super) last: LastRounds,
    /// While exploring, the budget after it was exceeded.
    pub(super) allowance: u64,
    /// The [cost](super::cost) of what was executed since somebody asked.
    pub(super) executed: u64,
    /// The rounds of loops after which lanes are [cut](Self::cut); none in most machines.
    pub(super) most_rounds: Option<u64>,
    /// The rounds of all loops in this run.
    pub(super) rounds: u64,
    /// The lanes that went on after that many rounds.
    pub(super) cut: u64,
    pub(super) budget_exceeded: bool,
    /// The loop that exceeded it.
    pub(super) runaway: Span,
    pub(super) observer: Option<Box<dyn Observer<D>>>,
    /// The expressions whose error is left out.
    pub(super) exactly: Option<Arc<Exactly>>,
    /// The numbers in the place of what is undefined.
    pub(super) guess: Option<Arc<Guess>>,
    /// The powers of a guess for the `pow` that runs, by lane.
    pub(super) powers: Option<Vec<f64>>,
    /// The lanes that an observer is shown.
    pub(super) watched: u64,
}

/// The purpose of a machine. The purposes exclude each other.
#[derive(Debug)]
pub enum Purpose<D: Domain> {
    /// Results.
    Results,
    /// The share of an operation in the envelopes: its own contribution is left out.
    Share(Muted),
    /// An observer, which also sees the preamble.
    Watching(Box<dyn Observer<D>>),
    /// Results without the f32 error of some expressions.
    Corrected(Arc<Exactly>),
    /// Results with numbers in the place of what the language leaves undefined.
    Guessing(Arc<Guess>),
}

impl<D: Domain> Machine<D> {
    /// Creates a machine for the uniforms (of each root of the interface, flat) and textures (of each sampler slot)
    /// of a draw, and runs the preamble.
    pub fn new(code: &Code, uniforms: &[Vec<ScalarValue>], textures: &[Option<Arc<Texture>>]) -> Self {
        Self::with(Purpose::Results, Profile::default(), code, uniforms, textures)
    }

    /// Creates a machine for a purpose, and a device.
    pub fn with(
        purpose: Purpose<D>,
        profile: Profile,
        code: &Code,
        uniforms: &[Vec<ScalarValue>],
        textures: &[Option<Arc<Texture>>],
    ) -> Self {
        let (mut muted, mut observer, mut exactly, mut guess) = (None, None, None, None);
        match purpose {
            Purpose::Results => {}
            Purpose::Share(left_out) => muted = Some(left_out),
            Purpose::Watching(watching) => observer = Some(watching),
            Purpose::Corrected(corrected) => exactly = Some(corrected),
            Purpose::Guessing(numbers) => guess = Some(numbers),
        }
        let inner = &code.inner;
        let unwritten = |source: &PoolSource| match source {
            PoolSource::Unwritten(index) => guess.as_ref()?.unwritten(*inner.unwritten.get(*index as usize)?),
            _ => None,
        };
        let float = |source: &PoolSource| match unwritten(source) {
            Some(numbers) => D::Float::from_f64(numbers.float),
            None => float_of::<D>(*source, uniforms),
        };
        let int = |source: &PoolSource| match unwritten(source) {
            Some(numbers) => D::Int::from_bits(numbers.int),
            None => int_of::<D>(*source, uniforms),
        };
        let floats = inner.float_pool.iter().map(float).collect();
        let ints = inner.int_pool.iter().map(int).collect();
        let mut machine = Self {
            code: code.clone(),
            registers: Registers::new(inner.preamble_results, floats, ints, profile),
            slots: vec![0; inner.mask_slots],
            textures: textures.to_vec(),
            discarded: 0,
            undecided: 0,
            perhaps_discarded: 0,
            ways: Ways::new(couples(&inner.main, inner)),
            streams: Streams::new(inner.stage == Stage::Geometry, inner.max_vertices),
            whole: 1,
            muted,
            loop_budget: LOOP_BUDGET,
            budget: LOOP_BUDGET,
            last: LastRounds::default(),
            allowance: 0,
            executed: 0,
            most_rounds: None,
            rounds: 0,
            cut: 0,
            budget_exceeded: false,
            runaway: Span::default(),
            observer,
            exactly,
            guess,
            powers: None,
            watched: 1,
        };
        machine.execute(&inner.preamble, inner, 1);
        machine.registers.finish_preamble(inner.registers);
        for (class, register, from) in &inner.splats {
            machine.registers.splat(*class, *register, *from);
        }
        machine
    }

    /// The cost of what was executed since the last call on this thread, in additions of floats with bounds for 64 lanes; 0 in other domains.
    pub fn take_executed(&mut self) -> u64 {
        std::mem::take(&mut self.executed) + take_redone()
    }

    /// Replaces [`LOOP_BUDGET`].
    pub fn limit_loops(&mut self, instructions: u64) {
        self.loop_budget = instructions;
    }

    /// Lets the outputs of a lane be anything, in a domain with envelopes, where its loops run more rounds than this together.
    pub fn cut_loops(&mut self, rounds: u64) {
        self.most_rounds = Some(rounds).filter(|_| D::HAS_INTERVALS);
    }

    fn port(ports: &[Port], class: Class, global: GlobalId, flat: u32) -> Option<usize> {
        let port = ports.iter().find(|port| port.global == global && port.flat == flat)?;
        (port.class == class).then_some(port.register)
    }

    /// The lanes of a `float` in an input's flat layout ([`Types::flat_len`](glisten_front::hir::Types::flat_len)),
    /// to be set before a run. They keep their values between runs. `None` if the stage does not read it or it is not
    /// a float.
    pub fn float_input(&mut self, global: GlobalId, flat: u32) -> Option<&mut Lanes<D::Float>> {
        let register = Self::port(&self.code.inner.inputs, Class::Float, global, flat)?;
        self.registers.floats.get_mut(register).map(Register::spread)
    }

    /// The lanes of an `int`, `uint` or `bool` in an input's flat layout.
    pub fn int_input(&mut self, global: GlobalId, flat: u32) -> Option<&mut Lanes<D::Int>> {
        let register = Self::port(&self.code.inner.inputs, Class::Int, global, flat)?;
        self.registers.ints.get_mut(register).map(Register::spread)
    }

    /// The lanes for the noise of a `float` input: the part of its error that is not common to the fragments of a
    /// primitive. `None` if no derivative needs it.
    pub fn noise_input(&mut self, global: GlobalId, flat: u32) -> Option<&mut Lanes<D::Float>> {
        let register = Self::port(&self.code.inner.noises, Class::Float, global, flat)?;
        self.registers.floats.get_mut(register).map(Register::spread)
    }

    /// Runs `main` on the lanes of both masks. Helper lanes run for the derivatives of their quads and have no other
    /// effect. The other lanes are undefined after the run.
    pub fn run(&mut self, live: Mask, helpers: Mask) {
        let code = Arc::clone(&self.code.inner);
        let inner: &Inner = &code;
        self.discarded = 0;
        self.undecided = 0;
        self.perhaps_discarded = 0;
        (self.rounds, self.cut) = (0, 0);
        self.ways.begin_first();
        self.streams.clear();
        // A machine that has exceeded its budget is likely to do so again. Then it should end soon.
        let budget = if self.budget_exceeded { self.loop_budget >> 6 } else { self.loop_budget };
        self.last = LastRounds::of(budget);
        self.budget = budget - self.last.budget;
        // A guess looks at whole quads.
        self.watched = if self.guess.is_some() { live.0 | helpers.0 } else { live.0 };
        self.mute_input();
        self.count_invocations(inner);
        self.run_main(inner, live.0 | helpers.0);
        self.show_outputs(live.0 & !self.discarded);
        if D::HAS_INTERVALS {
            self.explore(live.0 | helpers.0);
            self.leave_cut();
        }
        self.discarded &= live.0;
        self.perhaps_discarded &= live.0;
        self.undecided &= live.0;
    }

    /// Runs only `main`, and spreads outputs, so that each lane has its own number.
    pub(super) fn run_main(&mut self, inner: &Inner, mask: u64) {
        self.execute(&inner.main, inner, mask);
        for port in &inner.outputs {
            self.registers.spread(port.class, port.register);
        }
    }

    /// The lanes of a `float` in an output's flat layout after a run. It is 0 where the shader wrote nothing. `None`
    /// if the stage never writes it or it is not a float.
    pub fn float_output(&self, global: GlobalId, flat: u32) -> Option<&Lanes<D::Float>> {
        let register = Self::port(&self.code.inner.outputs, Class::Float, global, flat)?;
        self.registers.floats.get(register)?.lanes()
    }

    /// The lanes of an `int`, `uint` or `bool` in an output's flat layout.
    pub fn int_output(&self, global: GlobalId, flat: u32) -> Option<&Lanes<D::Int>> {
        let register = Self::port(&self.code.inner.outputs, Class::Int, global, flat)?;
        self.registers.ints.get(register)?.lanes()
    }

    /// The number of an output that the stage never writes: 0, unless it is guessed.
    pub(crate) fn never_written(&self) -> f64 {
        let span = self.code.inner.unwritten.last().copied();
        let numbers = self.guess.as_ref().zip(span).and_then(|(guess, span)| guess.unwritten(span));
        numbers.map_or(0.0, |numbers| numbers.float)
    }

    /// The lanes that the last run discarded.
    pub fn discarded(&self) -> Mask {
        Mask(self.discarded)
    }

    /// The lanes that the last run may or may not have discarded, depending on undecided conditions.
    /// [`Self::discarded`] follows the value. Always empty in domains without envelopes.
    pub fn perhaps_discarded(&self) -> Mask {
        Mask(self.perhaps_discarded)
    }

    /// The lanes of the last run whose texture is undecided. Always empty in domains without envelopes.
    pub fn undecided(&self) -> Mask {
        Mask(self.undecided)
    }

    /// The loop that exceeded [`LOOP_BUDGET`] in any run of this machine.
    pub fn endless_loop(&self) -> Option<Span> {
        self.budget_exceeded.then_some(self.runaway)
    }

    /// Whether any run of this machine exceeded [`LOOP_BUDGET`].
    pub fn budget_exceeded(&self) -> bool {
        self.budget_exceeded
    }
}

fn uniform(uniforms: &[Vec<ScalarValue>], root: u32, flat: u32) -> Option<ScalarValue> {
    uniforms.get(root as usize)?.get(flat as usize).copied()
}

/// A uniform without a value is 0.
fn float_of<D: Domain>(source: PoolSource, uniforms: &[Vec<ScalarValue>]) -> D::Float {
    let value = match source {
        PoolSource::Constant(bits) => f32::from_bits(bits),
        PoolSource::Uniform(root, flat) => match uniform(uniforms, root.0, flat) {
            Some(ScalarValue::Float(value)) => value,
            Some(ScalarValue::Int(value)) => value as f32,
            Some(ScalarValue::Uint(value)) => value as f32,
            Some(ScalarValue::Bool(value)) => f32::from(u8::from(value)),
            None => 0.0,
        },
        PoolSource::Unwritten(_) => 0.0,
    };
    D::Float::from_f64(f64::from(value))
}

fn int_of<D: Domain>(source: PoolSource, uniforms: &[Vec<ScalarValue>]) -> D::Int {
    let bits = match source {
        PoolSource::Constant(bits) => bits,
        PoolSource::Uniform(root, flat) => match uniform(uniforms, root.0, flat) {
            Some(ScalarValue::Float(value)) => value as i32 as u32,
            Some(ScalarValue::Int(value)) => value as u32,
            Some(ScalarValue::Uint(value)) => value,
            Some(ScalarValue::Bool(value)) => u32::from(value),
            None => 0,
        },
        PoolSource::Unwritten(_) => 0,
    };
    D::Int::from_bits(bits)
}
