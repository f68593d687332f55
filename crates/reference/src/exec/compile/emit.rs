//! [`Emitter`]: appends instructions, interns constants and lists, and moves into the preamble what is the same for
//! every invocation.

use super::super::code::{Form, PoolSource, Section};
use super::super::inst::{Class, Inst, List, Operand, Slot, Target, TextureCall};
use super::super::note::Note;
use super::facts::{Chain, Definition};
use glisten_front::link::RootIndex;
use glisten_front::source::Span;
use rustc_hash::FxHashMap;

/// The instructions of one stage during compilation.
#[derive(Default)]
pub(super) struct Emitter {
    pub(super) main: Section,
    pub(super) preamble: Section,
    pub(super) form: Form,
    /// The span for new instructions.
    pub(super) span: Span,
    pub(super) words: Vec<u32>,
    pub(super) textures: Vec<TextureCall>,
    pub(super) notes: Vec<Note>,
    pub(super) pools: [Vec<PoolSource>; 2],
    pub(super) preamble_results: [u32; 2],
    pub(super) mask_slots: u32,
    /// Registers with the same value in all lanes.
    pub(super) splats: Vec<(Class, Operand, Operand)>,
    /// For each virtual register, whether it is the home of a variable, which is written more than once.
    homes: [Vec<bool>; 2],
    interned: [FxHashMap<PoolSource, Operand>; 2],
    splatted: FxHashMap<(Class, Operand), Operand>,
    main_lists: FxHashMap<(Class, Vec<Operand>), List>,
    preamble_lists: FxHashMap<(Class, Vec<Operand>), List>,
    /// The sums and products with constants.
    pub(super) chains: FxHashMap<Operand, Chain>,
    /// The definitions of registers, as far as they are linear.
    pub(super) definitions: FxHashMap<Operand, Definition>,
    /// The registers with the noise of registers.
    pub(super) noises: FxHashMap<Operand, Operand>,
    /// The number of stores and joins when they were computed.
    pub(super) noises_at: u32,
    /// The number of stores, and of points where lanes diverge or join.
    pub(super) stores: u32,
    /// Preamble instructions by what they compute (with `dst` blanked).
    computed: FxHashMap<Inst, Operand>,
}

impl Emitter {
    pub(super) fn new(form: Form) -> Self {
        Self { form, ..Self::default() }
    }

    pub(super) fn register_count(&self, class: Class) -> usize {
        self.homes[class as usize].len()
    }

    /// A register that one instruction writes.
    pub(super) fn temp(&mut self, class: Class) -> Operand {
        let homes = &mut self.homes[class as usize];
        homes.push(false);
        Operand::reg(homes.len() as u32 - 1)
    }

    /// A register for a variable.
    pub(super) fn home(&mut self, class: Class) -> Operand {
        let homes = &mut self.homes[class as usize];
        homes.push(true);
        Operand::reg(homes.len() as u32 - 1)
    }

    /// Whether a later store may change the operand.
    pub(super) fn is_home(&self, class: Class, operand: Operand) -> bool {
        operand.is_reg() && self.homes[class as usize].get(operand.number()).copied().unwrap_or(false)
    }

    fn source(&mut self, class: Class, source: PoolSource) -> Operand {
        let pool = &mut self.pools[class as usize];
        *self.interned[class as usize].entry(source).or_insert_with(|| {
            pool.push(source);
            Operand::pool(pool.len() as u32 - 1)
        })
    }

    pub(super) fn float(&mut self, value: f32) -> Operand {
        self.source(Class::Float, PoolSource::Constant(value.to_bits()))
    }

    pub(super) fn int(&mut self, bits: u32) -> Operand {
        self.source(Class::Int, PoolSource::Constant(bits))
    }

    pub(super) fn zero(&mut self, class: Class) -> Operand {
        self.source(class, PoolSource::Constant(0))
    }

    /// A scalar that was never written.
    pub(super) fn unwritten(&mut self, class: Class, index: u32) -> Operand {
        self.source(class, PoolSource::Unwritten(index))
    }

    pub(super) fn uniform(&mut self, class: Class, root: RootIndex, flat: u32) -> Operand {
        let uniform = self.source(class, PoolSource::Uniform(root, flat));
        // What reads a register is not moved into the preamble.
        if self.form == Form::Counted { self.in_register(class, uniform) } else { uniform }
    }

    /// The value of an int operand, if it is constant.
    pub(super) fn known_int(&self, operand: Operand) -> Option<u32> {
        if operand.is_reg() || operand.is_preamble() {
            return None;
        }
        match self.pools[Class::Int as usize].get(operand.number()) {
            Some(PoolSource::Constant(bits)) => Some(*bits),
            _ => None,
        }
    }

    pub(super) fn push(&mut self, inst: Inst) {
        self.stores += u32::from(inst.is_control() || inst.stores());
        self.main.push(inst, self.span);
    }

    /// The index of the next instruction.
    pub(super) fn here(&self) -> Target {
        self.main.insts.len() as Target
    }

    /// Appends a jump whose target [`Self::land`] fills in.
    pub(super) fn jump(&mut self, inst: Inst) -> Target {
        self.push(inst);
        self.here() - 1
    }

    /// Sets the target of a jump to the next instruction.
    pub(super) fn land(&mut self, jump: Target) {
        let here = self.here();
        if let Some(target) = self.main.insts.get_mut(jump as usize).and_then(Inst::target_mut) {
            *target = here;
        }
    }

    pub(super) fn slot(&mut self) -> Slot {
        self.mask_slots += 1;
        self.mask_slots - 1
    }

    pub(super) fn words(&mut self, words: &[u32]) -> List {
        let start = self.words.len() as u32;
        self.words.extend_from_slice(words);
        List { start, len: words.len() as u32 }
    }

    pub(super) fn list(&mut self, class: Class, operands: &[Operand], preamble: bool) -> List {
        let key = (class, operands.to_vec());
        let (map, section) = if preamble {
            (&mut self.preamble_lists, &mut self.preamble)
        } else {
            (&mut self.main_lists, &mut self.main)
        };
        if let Some(list) = map.get(&key) {
            return *list;
        }
        let list = List { start: section.lists.len() as u32, len: operands.len() as u32 };
        section.lists.extend_from_slice(operands);
        map.insert(key, list);
        list
    }

    /// Emits a pure instruction with one result, into the preamble if everything that it reads is the same in all
    /// lanes.
    pub(super) fn pure(&mut self, class: Class, reads: &[Operand], make: impl Fn(Operand) -> Inst) -> Operand {
        if !reads.iter().all(|operand| operand.is_scalar()) {
            let dst = self.temp(class);
            self.push(make(dst));
            return dst;
        }
        let key = make(Operand::pool(0));
        if let Some(operand) = self.computed.get(&key) {
            return *operand;
        }
        let dst = self.preamble_result(class);
        self.preamble.push(make(dst), self.span);
        self.computed.insert(key, dst);
        dst
    }

    pub(super) fn preamble_result(&mut self, class: Class) -> Operand {
        let count = &mut self.preamble_results[class as usize];
        *count += 1;
        Operand::preamble(*count - 1)
    }

    /// A register with the operand in all lanes.
    pub(super) fn in_register(&mut self, class: Class, operand: Operand) -> Operand {
        if operand.is_reg() {
            return operand;
        }
        if let Some(register) = self.splatted.get(&(class, operand)) {
            return *register;
        }
        let register = self.temp(class);
        self.splats.push((class, register, operand));
        self.splatted.insert((class, operand), register);
        register
    }

    /// The operand, copied if a later store may change it.
    pub(super) fn keep(&mut self, class: Class, operand: Operand) -> Operand {
        if !self.is_home(class, operand) {
            return operand;
        }
        let dst = self.temp(class);
        self.copy(class, dst, operand);
        dst
    }

    /// Copies all lanes.
    pub(super) fn copy(&mut self, class: Class, dst: Operand, a: Operand) {
        self.push(match class {
            Class::Float => Inst::MoveFloat { dst, a },
            Class::Int => Inst::MoveInt { dst, a },
        });
    }

    /// Stores the active lanes.
    pub(super) fn store(&mut self, class: Class, dst: Operand, a: Operand) {
        self.push(match class {
            Class::Float => Inst::StoreFloat { dst, a },
            Class::Int => Inst::StoreInt { dst, a },
        });
    }
}
