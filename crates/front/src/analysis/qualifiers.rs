//! Qualifiers (§4.3 to §4.7): turns a list as written into a [`Qualifiers`] record, and checks where each is allowed.

use super::context::Analyzer;
use crate::diagnostic::codes::qualifiers;
use crate::diagnostic::{Advice, Applicability, Code, Diagnostic, Place};
use crate::hir::{Interpolation, Sampling};
use crate::language::{Extensions, Feature, Precision};
use crate::source::Span;
use crate::syntax::ast::{Ident, LayoutId, Qualifier, QualifierKind};

/// The storage and parameter qualifiers; a declaration has at most one of them besides `const`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum StorageWord {
    Attribute,
    Varying,
    /// `varying out`, of EXT_gpu_shader4.
    VaryingOut,
    In,
    Out,
    Inout,
    Uniform,
}

impl StorageWord {
    /// The spelling in GLSL.
    pub(super) fn spelling(self) -> &'static str {
        match self {
            Self::Attribute => "attribute",
            Self::Varying => "varying",
            Self::VaryingOut => "varying out",
            Self::In => "in",
            Self::Out => "out",
            Self::Inout => "inout",
            Self::Uniform => "uniform",
        }
    }
}

/// The qualifiers of one declaration.
#[derive(Clone, Debug, Default)]
pub(super) struct Qualifiers {
    pub(super) storage: Option<(StorageWord, Span)>,
    pub(super) constant: Option<Span>,
    pub(super) interpolation: Option<(Interpolation, Span)>,
    pub(super) sampling: Option<(Sampling, Span)>,
    pub(super) invariant: Option<Span>,
    pub(super) precision: Option<(Precision, Span)>,
    pub(super) precise: Option<Span>,
    /// All identifiers of all `layout(...)`, in source order.
    pub(super) layout: Vec<LayoutId>,
    /// The first `layout(...)`.
    pub(super) layout_span: Option<Span>,
    /// Whether a local variable has a storage qualifier, which only global ones have. That has been reported.
    pub(super) belongs_outside: bool,
}

impl Qualifiers {
    /// Where in a pixel the variable is evaluated.
    pub(super) fn sampling(&self) -> Sampling {
        self.sampling.map_or(Sampling::Center, |(sampling, _)| sampling)
    }
}

/// The kind of declaration that a list of qualifiers belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum DeclarationContext {
    /// A variable at global scope.
    Global,
    /// A local variable.
    Local,
    /// A parameter.
    Parameter,
    /// The return type of a function.
    Return,
    /// A member of a struct.
    StructMember,
    /// A member of an interface block.
    BlockMember,
    /// An interface block.
    Block,
    /// A declaration without a type: `invariant gl_Position;`, `layout(..) in;`.
    Alone,
}

/// The classes of qualifiers, which determine their order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Class {
    Layout,
    Invariant,
    Interpolation,
    Sampling,
    Const,
    Storage,
    Precision,
    Precise,
}

struct ClassRow {
    class: Class,
    what: &'static str,
    /// The rank in the order of §4.7. `layout` has none, but comes before storage.
    rank: u8,
    contexts: &'static [DeclarationContext],
}

use DeclarationContext::{Alone, Block, BlockMember, Global, Local, Parameter, Return, StructMember};

#[rustfmt::skip]
static CLASSES: &[ClassRow] = &[
    ClassRow { class: Class::Layout, what: "a layout qualifier", rank: 0, contexts: &[Global, Block, BlockMember, Alone] },
    ClassRow { class: Class::Invariant, what: "`invariant`", rank: 1, contexts: &[Global, BlockMember, Alone] },
    ClassRow { class: Class::Interpolation, what: "an interpolation qualifier", rank: 2, contexts: &[Global, BlockMember] },
    ClassRow { class: Class::Sampling, what: "`centroid` or `sample`", rank: 3, contexts: &[Global, BlockMember] },
    ClassRow { class: Class::Const, what: "`const`", rank: 4, contexts: &[Global, Local, Parameter] },
    ClassRow { class: Class::Storage, what: "a storage qualifier", rank: 5, contexts: &[Global, Parameter, BlockMember, Block, Alone] },
    ClassRow { class: Class::Precision, what: "a precision qualifier", rank: 6, contexts: &[Global, Local, Parameter, Return, StructMember, BlockMember] },
    ClassRow { class: Class::Precise, what: "`precise`", rank: 0, contexts: &[Global, Local, Parameter, Return, StructMember, BlockMember, Block, Alone] },
];

fn class_of(kind: &QualifierKind) -> Class {
    match kind {
        QualifierKind::Layout(_) => Class::Layout,
        QualifierKind::Invariant => Class::Invariant,
        QualifierKind::Smooth | QualifierKind::Flat | QualifierKind::Noperspective => Class::Interpolation,
        QualifierKind::Centroid | QualifierKind::Sample => Class::Sampling,
        QualifierKind::Const => Class::Const,
        QualifierKind::Attribute
        | QualifierKind::Varying
        | QualifierKind::In
        | QualifierKind::Out
        | QualifierKind::Inout
        | QualifierKind::Uniform => Class::Storage,
        QualifierKind::Highp | QualifierKind::Mediump | QualifierKind::Lowp => Class::Precision,
        QualifierKind::Precise => Class::Precise,
    }
}

fn row_of(class: Class) -> Option<&'static ClassRow> {
    CLASSES.iter().find(|row| row.class == class)
}

impl DeclarationContext {
    fn name(self) -> &'static str {
        match self {
            Self::Global => "a global variable",
            Self::Local => "a local variable",
            Self::Parameter => "a parameter",
            Self::Return => "a return type",
            Self::StructMember => "a member of a struct",
            Self::BlockMember => "a member of a block",
            Self::Block => "a block",
            Self::Alone => "a declaration without a type",
        }
    }
}

impl Analyzer<'_> {
    /// Checks a list of qualifiers: none twice, each allowed here, in the order of §4.7.
    pub(super) fn qualifiers(&mut self, list: &[Qualifier], context: DeclarationContext) -> Qualifiers {
        let outside = list.iter().find(|one| context == Local && class_of(&one.kind) == Class::Storage);
        if let Some(storage) = outside {
            self.report_outside(storage);
        }
        let mut record = Qualifiers { belongs_outside: outside.is_some(), ..Qualifiers::default() };
        let mut last: Option<(u8, &Qualifier)> = None;
        for qualifier in list {
            let Some(row) = row_of(class_of(&qualifier.kind)) else { continue };
            // What goes with a storage qualifier is right where that is.
            if record.belongs_outside && !row.contexts.contains(&context) {
                continue;
            }
            if !self.check_context(qualifier, row, context) {
                continue;
            }
            // A `const` after `uniform` is one too many, in any order.
            let is_conflict = matches!(qualifier.kind, QualifierKind::Const) && record.storage.is_some();
            if !(is_conflict && context == Global) {
                self.check_order(qualifier, row, &mut last);
            }
            self.record(&mut record, qualifier);
        }
        self.check_invariant_layout(&record, context);
        record
    }

    /// In GLSL ES 3.00, a `layout` stands before a storage qualifier alone (§4.7; §9, type_qualifier).
    fn check_invariant_layout(&mut self, record: &Qualifiers, context: DeclarationContext) {
        let (Some(span), Some(layout), Global) = (record.invariant, record.layout_span, context) else { return };
        if self.ast.version.has(Feature::NoInvariantLayout) {
            self.report(
                Diagnostic::new(
                    &qualifiers::MISPLACED,
                    span,
                    "`invariant` is not allowed in a declaration with a layout",
                )
                .here("not allowed here")
                .label(layout, "the layout")
                .help("make the variable invariant by a line of its own: `invariant name;`"),
            );
        }
    }

    fn check_context(&mut self, qualifier: &Qualifier, row: &ClassRow, context: DeclarationContext) -> bool {
        if row.contexts.contains(&context) {
            return true;
        }
        let (what, context_name) = (row.what, context.name());
        self.report(
            Diagnostic::new(
                &qualifiers::MISPLACED,
                qualifier.span,
                format!("{what} is not allowed before {context_name}"),
            )
            .here("not allowed here")
            .help(Advice::new(Applicability::Safe, "remove it", Place::Over, "")),
        );
        false
    }

    /// Reports a storage qualifier inside a function. Without it the variable would be another one, so that is no fix.
    fn report_outside(&mut self, storage: &Qualifier) {
        let word = self.sources.snippet(storage.span).to_owned();
        self.report(
            Diagnostic::new(
                &qualifiers::MISPLACED,
                storage.span,
                format!("a variable inside a function cannot be `{word}`"),
            )
            .here("not allowed here")
            .help("declare it at global scope, before the function"),
        );
    }

    fn check_order<'q>(&mut self, qualifier: &'q Qualifier, row: &ClassRow, last: &mut Option<(u8, &'q Qualifier)>) {
        let rank = row.rank;
        let before_storage = |rank: u8| rank == 0;
        if let Some((earlier, other)) = *last {
            let wrong = if before_storage(rank) { earlier >= 4 } else { rank < earlier };
            if wrong && !self.allows(Feature::QualifierOrder, qualifier.span) {
                let what = row.what;
                self.report(
                    Diagnostic::new(&qualifiers::ORDER, qualifier.span, format!("{what} comes too late"))
                        .here("must come earlier")
                        .label(other.span, "before this")
                        .help(self.order()),
                );
            }
        }
        if rank >= last.map_or(0, |(earlier, _)| earlier) {
            *last = Some((rank, qualifier));
        }
    }

    /// The order of qualifiers in words (§4.7), and how OpenGL's language allows any.
    fn order(&self) -> String {
        let order = "the order is: layout, invariant, interpolation, centroid or sample, storage, precision";
        let any =
            if self.ast.version.is_es() { "" } else { " (or `#extension GL_ARB_shading_language_420pack : enable`)" };
        format!("{order}{any}")
    }

    fn record(&mut self, record: &mut Qualifiers, qualifier: &Qualifier) {
        let span = qualifier.span;
        let storage = |word| Some((word, span));
        match &qualifier.kind {
            QualifierKind::Const => self.once(&mut record.constant, span, span, "`const`"),
            QualifierKind::Centroid => self.sampling(record, Sampling::Centroid, span),
            QualifierKind::Sample => self.sampling(record, Sampling::Sample, span),
            QualifierKind::Invariant => self.once(&mut record.invariant, span, span, "`invariant`"),
            QualifierKind::Precise => self.once(&mut record.precise, span, span, "`precise`"),
            QualifierKind::Highp => self.precision_word(record, Precision::High, span),
            QualifierKind::Mediump => self.precision_word(record, Precision::Medium, span),
            QualifierKind::Lowp => self.precision_word(record, Precision::Low, span),
            QualifierKind::Smooth => self.interpolation(record, Interpolation::Smooth, span),
            QualifierKind::Flat => self.interpolation(record, Interpolation::Flat, span),
            QualifierKind::Noperspective => self.interpolation(record, Interpolation::Noperspective, span),
            QualifierKind::Attribute => self.storage(record, storage(StorageWord::Attribute)),
            QualifierKind::Varying => self.storage(record, storage(StorageWord::Varying)),
            QualifierKind::In => self.storage(record, storage(StorageWord::In)),
            QualifierKind::Out => self.storage(record, storage(StorageWord::Out)),
            QualifierKind::Inout => self.storage(record, storage(StorageWord::Inout)),
            QualifierKind::Uniform => self.storage(record, storage(StorageWord::Uniform)),
            QualifierKind::Layout(ids) => {
                if let Some(first) = record.layout_span
                    && !self.allows(Feature::RepeatedLayouts, span)
                {
                    self.repeated(&qualifiers::REPEATED, first, span, "a layout qualifier");
                }
                record.layout_span.get_or_insert(span);
                record.layout.extend(ids.iter().copied());
            }
        }
    }

    fn interpolation(&mut self, record: &mut Qualifiers, word: Interpolation, span: Span) {
        match record.interpolation {
            Some((_, first)) => self.repeated(&qualifiers::REPEATED, first, span, "an interpolation qualifier"),
            None => record.interpolation = Some((word, span)),
        }
    }

    fn precision_word(&mut self, record: &mut Qualifiers, word: Precision, span: Span) {
        match record.precision {
            Some((_, first)) => self.repeated(&qualifiers::REPEATED, first, span, "a precision qualifier"),
            None => record.precision = Some((word, span)),
        }
    }

    /// "At most one auxiliary qualifier" (GLSL 4.20 §4.3).
    fn sampling(&mut self, record: &mut Qualifiers, sampling: Sampling, span: Span) {
        match record.sampling {
            Some((known, first)) => {
                let what = if known == sampling { known.word() } else { None };
                let what = what.map_or("`centroid` or `sample`".to_owned(), |word| format!("`{word}`"));
                self.repeated(&qualifiers::REPEATED, first, span, &what);
            }
            None => record.sampling = Some((sampling, span)),
        }
    }

    fn storage(&mut self, record: &mut Qualifiers, word: Option<(StorageWord, Span)>) {
        let (Some((_, span)), earlier) = (word, record.storage) else { return };
        match (earlier, word) {
            (Some((StorageWord::Varying, _)), Some((StorageWord::Out, _)))
                if self.extensions.contains(Extensions::GPU_SHADER4) =>
            {
                record.storage = Some((StorageWord::VaryingOut, span));
            }
            (Some((_, first)), _) => self.repeated(&qualifiers::REPEATED, first, span, "a storage qualifier"),
            (None, _) => record.storage = word,
        }
    }

    fn once(&mut self, slot: &mut Option<Span>, value: Span, span: Span, what: &str) {
        match *slot {
            Some(first) => self.repeated(&qualifiers::REPEATED, first, span, what),
            None => *slot = Some(value),
        }
    }

    /// Notes a declaration that has the word `precise` among its qualifiers.
    pub(super) fn note_precise(&mut self, list: &[Qualifier], name: Ident) {
        if list.iter().any(|one| one.kind == QualifierKind::Precise) {
            self.shader.precise.add(self.ast.name(name), name.span);
        }
    }

    pub(super) fn repeated(&mut self, code: &'static Code, first: Span, second: Span, what: &str) {
        self.report(
            Diagnostic::new(code, second, format!("{what} occurs twice in one declaration"))
                .here("one too many")
                .label(first, "the first one"),
        );
    }

    /// Reports a qualifier that is not allowed on this variable.
    pub(super) fn misplaced(&mut self, span: Span, message: impl Into<String>, help: &str) {
        self.report(Diagnostic::new(&qualifiers::MISPLACED, span, message.into()).here("not allowed here").help(help));
    }
}
