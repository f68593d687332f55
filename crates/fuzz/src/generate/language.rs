//! [`Language`]: the part of the language that a version has, for the generator.
//!
//! *In:* a version. *Out:* its types, and the overloads of its built-in functions by their results. *Holds:* everything is from glisten's
//! tables: what a row adds there is generated here.

use super::types::{FLOAT, Ty};
use glisten_front::builtin::functions::{self, Effect, Row, Signature};
use glisten_front::hir::{ParamMode, Scalar, Stage, TypeId};
use glisten_front::language::{Extensions, Feature, Profile, Version};
use glisten_front::source::Span;
use glisten_front::syntax::keywords::TABLE;
use glisten_front::syntax::token::TokenKind;
use std::collections::BTreeMap;
use std::sync::OnceLock;

/// The versions: their numbers, and whether they are of OpenGL ES.
pub const VERSIONS: &[(u16, bool)] = &[
    (110, false),
    (120, false),
    (130, false),
    (140, false),
    (150, false),
    (330, false),
    (400, false),
    (410, false),
    (420, false),
    (430, false),
    (440, false),
    (450, false),
    (460, false),
    (100, true),
    (300, true),
    (310, true),
];

/// An overload of a built-in function.
#[derive(Clone, Copy, Debug)]
pub(super) struct Overload {
    pub(super) row: &'static Row,
    pub(super) signature: Signature,
}

/// The overloads of one name with one result.
pub(super) type Named = Vec<Overload>;

/// A version with what it has.
#[derive(Debug)]
pub struct Language {
    /// The version.
    pub version: Version,
    /// Scalars, vectors and matrices.
    pub(super) basics: Vec<Ty>,
    /// The built-in functions of a stage, by their results: those of each name together. `None` is `void`.
    functions: [BTreeMap<Option<Ty>, Vec<Named>>; 2],
}

impl Language {
    /// All versions.
    pub fn all() -> &'static [Self] {
        static ALL: OnceLock<Vec<Language>> = OnceLock::new();
        ALL.get_or_init(|| VERSIONS.iter().map(|(number, is_es)| Self::new(*number, *is_es)).collect())
    }

    /// The language of a version.
    pub fn of(number: u16, is_es: bool) -> Option<&'static Self> {
        Self::all().iter().find(|one| one.version.number == number && one.version.is_es() == is_es)
    }

    fn new(number: u16, is_es: bool) -> Self {
        let profile = if is_es { Profile::Es } else { Profile::Core };
        let version = Version { number, profile, span: Span::default() };
        let functions = [Stage::Vertex, Stage::Fragment].map(|stage| functions_of(version, stage));
        let mut basics = Vec::new();
        for scalar in Scalar::ALL {
            basics.extend((1..=4).map(|size| Ty::Vector(scalar, size)));
        }
        for columns in 2..=4 {
            basics.extend((2..=4).map(|rows| Ty::Matrix(columns, rows)));
        }
        basics.retain(|ty| is_word(version, &ty.name()));
        Self { version, basics, functions }
    }

    /// The `#version` line without the end of its line.
    pub fn line(&self) -> String {
        match (self.version.is_es(), self.version.number) {
            (true, 100) => "#version 100".to_owned(),
            (true, number) => format!("#version {number} es"),
            (false, number) => format!("#version {number}"),
        }
    }

    /// Whether the version has a feature.
    pub(super) fn has(&self, feature: Feature) -> bool {
        self.version.has(feature)
    }

    /// Whether it is at least a version of OpenGL's language, or at least one of OpenGL ES'.
    pub(super) fn since(&self, desktop: u16, es: u16) -> bool {
        self.version.number >= if self.version.is_es() { es } else { desktop }
    }

    /// Whether a word is a keyword.
    pub(super) fn has_word(&self, word: &str) -> bool {
        is_word(self.version, word)
    }

    /// Whether arrays are values.
    pub(super) fn has_array_values(&self) -> bool {
        self.has(Feature::ArrayObjects)
    }

    /// The functions of a stage with a result, or without one.
    pub(super) fn functions(&self, stage: Stage, result: Option<&Ty>) -> &[Named] {
        let [vertex, fragment] = &self.functions;
        let all = if stage == Stage::Fragment { fragment } else { vertex };
        all.get(&result.cloned()).map_or(&[], Vec::as_slice)
    }
}

fn is_word(version: Version, word: &str) -> bool {
    let row = TABLE.iter().find(|row| row.spelling == word);
    row.is_some_and(|row| {
        let kind = row.kind_in(version, Extensions::empty());
        kind == row.kind && !matches!(kind, TokenKind::Ident | TokenKind::Reserved)
    })
}

/// Whether the generator has values for a parameter: all but arrays.
fn is_known(ty: TypeId) -> bool {
    use glisten_front::hir::{Type, Types};
    Ty::of(ty).is_some() || ty == TypeId::FOUR_OFFSETS || matches!(Types::basic().get(ty), Type::Sampler(_))
}

fn functions_of(version: Version, stage: Stage) -> BTreeMap<Option<Ty>, Vec<Named>> {
    let mut all: BTreeMap<Option<Ty>, BTreeMap<&str, Named>> = BTreeMap::new();
    for row in functions::all() {
        // `ftransform()` is of the fixed-function pipeline, and what emits is of geometry shaders.
        let is_plain = row.effect != Effect::Emits && !row.params.is_empty();
        if !is_plain || !row.availability.holds(version, Extensions::empty(), stage) {
            continue;
        }
        for signature in row.signatures(stage) {
            let known = signature.params().iter().all(|(ty, mode)| is_known(*ty) && *mode != ParamMode::Inout);
            let result = Ty::of(signature.ret);
            let is_result = result.is_some() || signature.ret == TypeId::VOID;
            let has_words = [signature.ret]
                .iter()
                .chain(signature.params().iter().map(|(ty, _)| ty))
                .filter_map(|ty| Ty::of(*ty))
                .all(|ty| ty == FLOAT || is_word(version, &ty.name()));
            if known && is_result && has_words {
                all.entry(result).or_default().entry(row.name).or_default().push(Overload { row, signature });
            }
        }
    }
    all.into_iter().map(|(result, names)| (result, names.into_values().collect())).collect()
}
