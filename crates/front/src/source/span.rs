//! [`Span`]: a range of source text and the macro use it came through.

/// The number of a macro use in a [`SourceMap`](super::SourceMap); [`ExpansionId::NONE`] for text outside macros.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ExpansionId(u32);

impl ExpansionId {
    /// Text that does not come from a macro.
    pub const NONE: Self = Self(0);
    /// The mark of a scattered span ([`Span::scattered`]), next to the number.
    const SCATTERED: u32 = 1 << 31;

    /// The expansion with this number in the source map, counted from 1.
    pub(crate) fn new(number: u32) -> Self {
        Self(number)
    }

    /// The index in the source map's table, or `None` for text outside macros.
    pub(crate) fn index(self) -> Option<usize> {
        (self.plain().0 as usize).checked_sub(1)
    }

    /// The same number without a mark.
    pub(crate) fn plain(self) -> Self {
        Self(self.0 & !Self::SCATTERED)
    }

    /// This number with the mark of another one.
    pub(crate) fn marked_as(self, other: Self) -> Self {
        Self(self.0 | other.0 & Self::SCATTERED)
    }

    /// The number as it is saved.
    pub(crate) fn bits(self) -> u32 {
        self.0
    }

    /// Whether the text comes from a macro, or from several places around one.
    pub fn is_some(self) -> bool {
        self.0 != 0
    }
}

/// A half-open range `start..end` of global byte offsets in a [`SourceMap`](super::SourceMap), at the place where the
/// text was *written*, together with the macro use that put the text where it is.
///
/// Offset 0 belongs to no file. `Span::default()` is unknown and is shown without an excerpt.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Span {
    /// First byte.
    pub start: u32,
    /// One past the last byte.
    pub end: u32,
    /// The macro use that put the text here.
    pub expansion: ExpansionId,
}

impl Span {
    /// The range `start..end` of text outside macros.
    pub fn new(start: u32, end: u32) -> Self {
        Self { start, end, expansion: ExpansionId::NONE }
    }

    /// Whether this is a position in a text at all.
    pub fn is_known(self) -> bool {
        self.end != 0
    }

    /// This place for what was read in pieces: a macro use begins or ends inside of it, or puts together what is apart in the text.
    /// The text of the span is then not what was read, so nobody may quote or change it.
    pub(crate) fn scattered(self) -> Self {
        Self { expansion: ExpansionId(self.expansion.0 | ExpansionId::SCATTERED), ..self }
    }

    /// An empty span directly after this one, where something is missing.
    pub fn after(self) -> Self {
        Self { start: self.end, ..self }
    }
}
