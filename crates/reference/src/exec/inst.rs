//! The instruction set of the register machine.
//!
//! A register is one scalar in 64 lanes, in the float or the int file. Aggregates are their scalars in flat order
//! ([`Types::flat_len`](glisten_front::hir::Types::flat_len)). An [`Operand`] may also be one number for all lanes.
//! Arithmetic writes all lanes, active or not: it is total, so only stores to variables are masked.

use glisten_front::hir::{SamplerType, Scalar};

// The operations are those of the front end's table. Functions of whole vectors and matrices are computed in the
// domain's wide type and rounded once.
pub(super) use glisten_front::builtin::operations::{
    Binary as Float2, Composite, Derivative, Lookup, Ternary as Float3, Unary as Float1,
};

/// An operand of an instruction.
///
/// Compiled code has two phases. During compilation, registers are virtual, and results of the preamble have separate
/// numbers. Then [`alloc`](super::compile) converts both to indices in a [`Machine`](super::Machine).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(super) struct Operand(u32);

const POOL: u32 = 1 << 31;
const PREAMBLE: u32 = 3 << 30;
const NUMBER: u32 = (1 << 30) - 1;

impl Operand {
    /// A register: 64 lanes.
    pub(super) fn reg(number: u32) -> Self {
        Self(number & NUMBER)
    }
    /// A number for all lanes: a constant, or a scalar of a uniform.
    pub(super) fn pool(number: u32) -> Self {
        Self(POOL | number & NUMBER)
    }
    /// A number for all lanes that the preamble computes.
    pub(super) fn preamble(number: u32) -> Self {
        Self(PREAMBLE | number & NUMBER)
    }
    #[inline(always)]
    pub(super) fn is_reg(self) -> bool {
        self.0 & POOL == 0
    }
    /// Whether the operand is one number for all lanes.
    #[inline(always)]
    pub(super) fn is_scalar(self) -> bool {
        !self.is_reg()
    }
    pub(super) fn is_preamble(self) -> bool {
        self.0 & PREAMBLE == PREAMBLE
    }
    /// The index in its file.
    #[inline(always)]
    pub(super) fn number(self) -> usize {
        (self.0 & NUMBER) as usize
    }
}

/// The file of a register.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(super) enum Class {
    Float,
    Int,
}

impl Class {
    /// The class of a scalar; without a type, it is the number of a sampler's slot.
    pub(super) fn of(scalar: Option<Scalar>) -> Self {
        if scalar == Some(Scalar::Float) { Self::Float } else { Self::Int }
    }
}

/// A range of operands in [`Inner::lists`](super::code::Inner).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct List {
    pub(super) start: u32,
    pub(super) len: u32,
}

/// An index into the instructions.
pub(super) type Target = u32;
/// A saved mask.
pub(super) type Slot = u32;

/// float, float to bool
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Compare {
    Less,
    LessEqual,
    Equal,
    NotEqual,
}

/// float to int
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum FloatToInt {
    Int,
    Uint,
    Bool,
    IsNan,
    IsInf,
    /// The bits of the nearest f32.
    Bits,
    /// The bits of the nearest 16-bit float.
    Half,
}

/// int to float
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum IntToFloat {
    Int,
    Uint,
    /// The f32 with these bits.
    Bits,
    /// The 16-bit float with the lowest bits.
    Half,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Int1 {
    Neg,
    BitNot,
    /// `!` of a `bool`.
    Not,
    /// 0 or 1.
    Bool,
    Abs,
    Sign,
    Reverse,
    Count,
    Lowest,
    HighestSigned,
    HighestUnsigned,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Int2 {
    Add,
    Sub,
    Mul,
    DivSigned,
    DivUnsigned,
    RemSigned,
    RemUnsigned,
    Shl,
    ShrSigned,
    ShrUnsigned,
    And,
    Or,
    Xor,
    Equal,
    NotEqual,
    LessSigned,
    LessUnsigned,
    LessEqualSigned,
    LessEqualUnsigned,
    MinSigned,
    MinUnsigned,
    MaxSigned,
    MaxUnsigned,
    /// The first operand clamped to 0 ..= the second, as `int`s: an index of one of several dimensions.
    ClampIndex,
}

impl Int2 {
    /// Whether it is a quotient or a remainder.
    #[inline(always)]
    pub(super) fn divides(self) -> bool {
        matches!(self, Self::DivSigned | Self::DivUnsigned | Self::RemSigned | Self::RemUnsigned)
    }

    /// The operation as GLSL writes it, if §5.9 leaves its result undefined for some operands.
    #[inline(always)]
    pub(super) fn undefined_name(self) -> Option<&'static str> {
        match self {
            Self::DivSigned | Self::DivUnsigned => Some("/"),
            Self::RemSigned | Self::RemUnsigned => Some("%"),
            Self::Shl => Some("<<"),
            Self::ShrSigned | Self::ShrUnsigned => Some(">>"),
            _ => None,
        }
    }

    /// Whether §5.9 leaves its result undefined for some integers of two intervals: a divisor of zero, a negative operand
    /// of a remainder, a shift by a negative number or by 32 bits or more.
    #[inline(always)]
    pub(super) fn is_undefined(self, (least, _): (i32, i32), (low, high): (i32, i32)) -> bool {
        match self {
            Self::DivSigned | Self::DivUnsigned | Self::RemUnsigned => low <= 0 && high >= 0,
            Self::RemSigned => least < 0 || low <= 0,
            Self::Shl | Self::ShrSigned | Self::ShrUnsigned => low < 0 || high > 31,
            _ => false,
        }
    }
}

/// The operands of a texture instruction, all of which are registers.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct TextureCall {
    pub(super) lookup: Lookup,
    pub(super) kind: SamplerType,
    /// An int: the number of the sampler slot.
    pub(super) sampler: Operand,
    /// Floats (ints for `Fetch`), after projection, with the layer last.
    pub(super) coordinate: Vec<Operand>,
    /// The reference of a shadow sampler.
    pub(super) reference: Option<Operand>,
    /// The bias or level: a float, or an int for `Fetch` and `Size`.
    pub(super) level: Option<Operand>,
    pub(super) dx: Vec<Operand>,
    pub(super) dy: Vec<Operand>,
    /// Ints.
    pub(super) offset: Vec<Operand>,
    /// The gathered component: an int.
    pub(super) component: Option<Operand>,
    /// The results: floats or ints, depending on the sampler's texels (ints for `Size` and `Levels`, floats for `QueryLod`).
    pub(super) results: Vec<Operand>,
}

/// An instruction. `dst` is always a register.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Inst {
    Float1 {
        op: Float1,
        dst: Operand,
        a: Operand,
    },
    Float2 {
        op: Float2,
        dst: Operand,
        a: Operand,
        b: Operand,
    },
    /// `a * b + c`, rounded twice.
    MulAdd {
        dst: Operand,
        a: Operand,
        b: Operand,
        c: Operand,
    },
    /// `a`, the result of a chain of sums or products; in an envelope joined with the sum or product of a list, which
    /// is the same chain with its constants combined.
    Folded {
        sum: bool,
        dst: Operand,
        a: Operand,
        list: List,
    },
    /// `a0 b0 + a1 b1 + ...` over pairs in a list, from left to right, each step rounded.
    SumOfProducts {
        dst: Operand,
        list: List,
    },
    Float3 {
        op: Float3,
        dst: Operand,
        a: Operand,
        b: Operand,
        c: Operand,
    },
    Compare {
        op: Compare,
        dst: Operand,
        a: Operand,
        b: Operand,
    },
    FloatToInt {
        op: FloatToInt,
        dst: Operand,
        a: Operand,
    },
    IntToFloat {
        op: IntToFloat,
        dst: Operand,
        a: Operand,
    },
    Int1 {
        op: Int1,
        dst: Operand,
        a: Operand,
    },
    Int2 {
        op: Int2,
        dst: Operand,
        a: Operand,
        b: Operand,
    },
    SelectFloat {
        dst: Operand,
        c: Operand,
        a: Operand,
        b: Operand,
    },
    SelectInt {
        dst: Operand,
        c: Operand,
        a: Operand,
        b: Operand,
    },
    /// `results` and `arguments` are registers; `size` is the dimension.
    Composite {
        op: Composite,
        size: u8,
        results: List,
        arguments: List,
    },
    Derivative {
        op: Derivative,
        dst: Operand,
        a: Operand,
        /// How far apart the errors of `a` may be in two lanes: the sum of both lanes' numbers.
        noise: Option<Operand>,
    },
    /// The noise of `of`, a sum of terms: that of each in a list, followed by its factor, and the rounding.
    Noise {
        dst: Operand,
        of: Operand,
        divides: bool,
        list: List,
    },
    /// The noise of `of`, by what it is computed from.
    NoiseOf {
        op: Noisy,
        dst: Operand,
        of: Operand,
        /// Numbers, each followed by its noise.
        list: List,
    },
    Texture {
        call: u32,
    },
    /// Loads the element of a table at an index, which is clamped.
    LoadFloat {
        dst: Operand,
        table: List,
        index: Operand,
    },
    LoadInt {
        dst: Operand,
        table: List,
        index: Operand,
    },
    /// Copies all lanes.
    MoveFloat {
        dst: Operand,
        a: Operand,
    },
    MoveInt {
        dst: Operand,
        a: Operand,
    },
    /// Copies the active lanes.
    StoreFloat {
        dst: Operand,
        a: Operand,
    },
    StoreInt {
        dst: Operand,
        a: Operand,
    },
    /// Copies the active lanes to the register of a table at an index, which is clamped.
    StoreIndexedFloat {
        table: List,
        index: Operand,
        a: Operand,
    },
    StoreIndexedInt {
        table: List,
        index: Operand,
        a: Operand,
    },
    /// Saves the mask.
    Save {
        slot: Slot,
    },
    /// The lanes where `c` is true continue, the others wait in `rest`. Jumps to `next` if no lane continues.
    Arm {
        c: Operand,
        rest: Slot,
        next: Target,
    },
    /// The waiting lanes continue. Jumps to `end` if there is none.
    Rest {
        rest: Slot,
        end: Target,
    },
    /// The saved lanes continue, except those that have left.
    Join {
        slot: Slot,
    },
    /// The active lanes leave all these saved masks. No lane continues.
    Leave {
        slots: List,
    },
    Discard,
    /// Ends the run if any lane gets here: a call that is too long to be written out.
    Endless,
    /// Adds a vertex with these numbers to the stream of each active lane (`EmitVertex`).
    Emit {
        floats: List,
        ints: List,
    },
    /// Ends the primitive of each active lane (`EndPrimitive`).
    EndPrimitive,
    /// The observer sees only the lanes where `c` is `is`. The other lanes run as well.
    Watch {
        c: Operand,
        is: bool,
        slot: Slot,
    },
    /// The observer sees again the lanes that it saw before.
    Unwatch {
        slot: Slot,
    },
    /// Shows an observer the scalars of a [`Note`](super::note::Note).
    Note {
        note: u32,
        floats: List,
        ints: List,
    },
    /// The lanes where `c` is true stay in the loop. Jumps to `exit` if there is none.
    LoopTest {
        c: Operand,
        active: Slot,
        exit: Target,
    },
    /// The lanes that are still in the loop continue, including those after a `continue`. Jumps to `exit` if there is
    /// none.
    LoopNext {
        active: Slot,
        exit: Target,
    },
    /// Jumps back to the head if the budget allows, otherwise to `exit`.
    LoopBack {
        head: Target,
        exit: Target,
    },
    /// Moves the lanes of `rest` whose selector is among the labels to `slot`.
    CaseMask {
        selector: Operand,
        labels: List,
        rest: Slot,
        slot: Slot,
    },
    /// Deactivates all lanes: before the first case.
    Idle,
    /// Activates the lanes of `slot`, too. Jumps to `next` if no lane is active then.
    Case {
        slot: Slot,
        next: Target,
    },
}

/// How an instruction uses an operand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Use {
    Read,
    Write,
}

/// A computation whose noise depends on how its operands change from one fragment of a quad to the next.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Noisy {
    /// `a0 * b0 + a1 * b1 + ...`
    Products,
    /// `a / b`
    Quotient,
    /// `sqrt(a)`
    Root,
    /// `inversesqrt(a)`
    InverseRoot,
}

impl Inst {
    /// Visits all operands that the instruction contains directly.
    pub(super) fn visit(&mut self, f: &mut dyn FnMut(Class, Use, &mut Operand)) {
        use Class::{Float, Int};
        use Use::{Read, Write};
        match self {
            Self::Derivative { dst, a, noise, .. } => {
                f(Float, Read, a);
                noise.iter_mut().for_each(|noise| f(Float, Read, noise));
                f(Float, Write, dst);
            }
            Self::Float1 { dst, a, .. }
            | Self::Folded { dst, a, .. }
            | Self::Noise { dst, of: a, .. }
            | Self::NoiseOf { dst, of: a, .. } => {
                f(Float, Read, a);
                f(Float, Write, dst);
            }
            Self::Float2 { dst, a, b, .. } => {
                f(Float, Read, a);
                f(Float, Read, b);
                f(Float, Write, dst);
            }
            Self::MulAdd { dst, a, b, c } | Self::Float3 { dst, a, b, c, .. } => {
                f(Float, Read, a);
                f(Float, Read, b);
                f(Float, Read, c);
                f(Float, Write, dst);
            }
            Self::SumOfProducts { dst, .. } => f(Float, Write, dst),
            Self::Compare { dst, a, b, .. } => {
                f(Float, Read, a);
                f(Float, Read, b);
                f(Int, Write, dst);
            }
            Self::FloatToInt { dst, a, .. } => {
                f(Float, Read, a);
                f(Int, Write, dst);
            }
            Self::IntToFloat { dst, a, .. } => {
                f(Int, Read, a);
                f(Float, Write, dst);
            }
            Self::Int1 { dst, a, .. } => {
                f(Int, Read, a);
                f(Int, Write, dst);
            }
            Self::Int2 { dst, a, b, .. } => {
                f(Int, Read, a);
                f(Int, Read, b);
                f(Int, Write, dst);
            }
            Self::SelectFloat { dst, c, a, b } => {
                f(Int, Read, c);
                f(Float, Read, a);
                f(Float, Read, b);
                f(Float, Write, dst);
            }
            Self::SelectInt { dst, c, a, b } => {
                f(Int, Read, c);
                f(Int, Read, a);
                f(Int, Read, b);
                f(Int, Write, dst);
            }
            Self::LoadFloat { dst, index, .. } => {
                f(Int, Read, index);
                f(Float, Write, dst);
            }
            Self::LoadInt { dst, index, .. } => {
                f(Int, Read, index);
                f(Int, Write, dst);
            }
            Self::MoveFloat { dst, a } | Self::StoreFloat { dst, a } => {
                f(Float, Read, a);
                f(Float, Write, dst);
            }
            Self::MoveInt { dst, a } | Self::StoreInt { dst, a } => {
                f(Int, Read, a);
                f(Int, Write, dst);
            }
            Self::StoreIndexedFloat { index, a, .. } => {
                f(Int, Read, index);
                f(Float, Read, a);
            }
            Self::StoreIndexedInt { index, a, .. } => {
                f(Int, Read, index);
                f(Int, Read, a);
            }
            Self::Arm { c, .. } | Self::LoopTest { c, .. } | Self::Watch { c, .. } => f(Int, Read, c),
            Self::CaseMask { selector, .. } => f(Int, Read, selector),
            Self::Composite { .. }
            | Self::Texture { .. }
            | Self::Save { .. }
            | Self::Rest { .. }
            | Self::Join { .. }
            | Self::Leave { .. }
            | Self::Discard
            | Self::Endless
            | Self::Emit { .. }
            | Self::EndPrimitive
            | Self::Note { .. }
            | Self::Unwatch { .. }
            | Self::LoopNext { .. }
            | Self::LoopBack { .. }
            | Self::Idle
            | Self::Case { .. } => {}
        }
    }

    /// The lists of operands that the instruction reads and writes.
    pub(super) fn lists(&self) -> [Option<(Class, Use, List)>; 2] {
        match *self {
            Self::SumOfProducts { list, .. }
            | Self::Folded { list, .. }
            | Self::Noise { list, .. }
            | Self::NoiseOf { list, .. } => [Some((Class::Float, Use::Read, list)), None],
            Self::Composite { results, arguments, .. } => {
                [Some((Class::Float, Use::Read, arguments)), Some((Class::Float, Use::Write, results))]
            }
            Self::Emit { floats, ints } | Self::Note { floats, ints, .. } => {
                [Some((Class::Float, Use::Read, floats)), Some((Class::Int, Use::Read, ints))]
            }
            Self::LoadFloat { table, .. } => [Some((Class::Float, Use::Read, table)), None],
            Self::LoadInt { table, .. } => [Some((Class::Int, Use::Read, table)), None],
            Self::StoreIndexedFloat { table, .. } => [Some((Class::Float, Use::Write, table)), None],
            Self::StoreIndexedInt { table, .. } => [Some((Class::Int, Use::Write, table)), None],
            _ => [None, None],
        }
    }

    /// Whether lanes diverge or join at the instruction.
    pub(super) fn is_control(&self) -> bool {
        let mut inst = *self;
        inst.target_mut().is_some()
            || matches!(inst, Self::Save { .. } | Self::Join { .. } | Self::Leave { .. })
            || matches!(inst, Self::Discard | Self::Endless | Self::Idle)
    }

    /// Whether it changes the home of a variable.
    pub(super) fn stores(&self) -> bool {
        matches!(
            self,
            Self::StoreFloat { .. }
                | Self::StoreInt { .. }
                | Self::StoreIndexedFloat { .. }
                | Self::StoreIndexedInt { .. }
        )
    }

    /// The target of a jump.
    pub(super) fn target_mut(&mut self) -> Option<&mut Target> {
        match self {
            Self::Arm { next: target, .. }
            | Self::Rest { end: target, .. }
            | Self::LoopTest { exit: target, .. }
            | Self::LoopNext { exit: target, .. }
            | Self::LoopBack { exit: target, .. }
            | Self::Case { next: target, .. } => Some(target),
            _ => None,
        }
    }
}

impl TextureCall {
    /// Whether the results are ints.
    pub(super) fn has_integer_results(&self) -> bool {
        match self.lookup {
            Lookup::Size | Lookup::Levels => true,
            Lookup::QueryLod => false,
            Lookup::Implicit | Lookup::Lod | Lookup::Grad | Lookup::Fetch | Lookup::Gather => {
                self.kind.texel != Scalar::Float && !self.kind.shadow
            }
        }
    }

    /// The files of the coordinates and of the level.
    fn classes(&self) -> (Class, Class) {
        let by_integer = |integer: bool| if integer { Class::Int } else { Class::Float };
        let is_fetch = self.lookup == Lookup::Fetch;
        (by_integer(is_fetch), by_integer(is_fetch || self.lookup == Lookup::Size))
    }

    /// Whether a condition holds for all operands that are read.
    pub(super) fn all_read(&self, holds: impl Fn(Class, Operand) -> bool) -> bool {
        let (coordinates, levels) = self.classes();
        let all = |class: Class, operands: &[Operand]| operands.iter().all(|operand| holds(class, *operand));
        holds(Class::Int, self.sampler)
            && all(coordinates, &self.coordinate)
            && all(levels, self.level.as_slice())
            && all(Class::Float, self.reference.as_slice())
            && all(Class::Float, &self.dx)
            && all(Class::Float, &self.dy)
            && all(Class::Int, &self.offset)
            && all(Class::Int, self.component.as_slice())
    }

    /// Visits all operands.
    pub(super) fn visit(&mut self, f: &mut dyn FnMut(Class, Use, &mut Operand)) {
        let (coordinates, levels) = self.classes();
        f(Class::Int, Use::Read, &mut self.sampler);
        self.coordinate.iter_mut().for_each(|operand| f(coordinates, Use::Read, operand));
        self.level.iter_mut().for_each(|operand| f(levels, Use::Read, operand));
        self.reference.iter_mut().for_each(|operand| f(Class::Float, Use::Read, operand));
        self.dx.iter_mut().chain(&mut self.dy).for_each(|operand| f(Class::Float, Use::Read, operand));
        self.offset.iter_mut().chain(&mut self.component).for_each(|operand| f(Class::Int, Use::Read, operand));
        let results = if self.has_integer_results() { Class::Int } else { Class::Float };
        self.results.iter_mut().for_each(|operand| f(results, Use::Write, operand));
    }
}
