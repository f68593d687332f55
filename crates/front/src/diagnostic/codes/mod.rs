//! The registry of diagnostic codes: one row for each code, one file for each phase.
//!
//! A row contains everything that `glisten explain`, the reference page and SARIF's rule metadata need. Each `bad`
//! example raises its code, and each `good` one is clean; a test runs them all.
//!
//! | range | phase |
//! | --- | --- |
//! | `E01xx` | reading, preprocessor, version and extensions |
//! | `E02xx` | syntax |
//! | `E03xx` | names, scopes, declarations |
//! | `E04xx` | types, expressions, constants |
//! | `E05xx` | statements, functions |
//! | `E06xx` | qualifiers, layouts, blocks, built-in variables |
//! | `E07xx` | link |
//! | `E08xx` | lowering, emission, targets |
//! | `E09xx` | scenes and running |
//! | `E0001` to `E0099` | limits, unsupported features, internal errors |
//! | `W01xx` to `W07xx` | forgiven, or legal but harmful; the hundreds are those of the errors |
//! | `L0xxx` | lint rules |

use super::{Group, LintInfo, Severity, group};
use std::fmt;

/// A row of the registry.
#[derive(Debug)]
pub struct Code {
    /// `E0301`: stable forever.
    pub id: &'static str,
    /// A name that can follow "allow": `undeclared-identifier`.
    pub name: &'static str,
    /// The severity, unless levels change it.
    pub severity: Severity,
    /// The section of the specification: `GLSL 1.50 §4.2.2`, or empty.
    pub section: &'static str,
    /// The page: what the code means and why, in whole sentences. Empty in a module for the web, as are the examples.
    pub page: &'static str,
    /// An example that raises the code.
    pub bad: Example,
    /// The example, corrected.
    pub good: Example,
    /// For a lint rule: its group, its level and its fixes.
    pub lint: Option<LintInfo>,
}

impl Code {
    /// Whether it is dropped unless a level asks for it.
    pub fn is_off(&self) -> bool {
        self.lint.is_some_and(|lint| lint.level == group::Default::Off)
    }

    /// The group, of a lint rule.
    pub fn group(&self) -> Option<Group> {
        self.lint.map(|lint| lint.group)
    }
}

/// A phase that reports, or the lint: the files of this folder.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Area {
    /// Limits, unsupported features, internal errors.
    General,
    /// Reading, the preprocessor, versions and extensions.
    Preprocess,
    /// The grammar.
    Syntax,
    /// Names, scopes, declarations.
    Names,
    /// Types, expressions, constants.
    Types,
    /// Statements and functions.
    Statements,
    /// Qualifiers, layouts, blocks, built-in variables.
    Qualifiers,
    /// The link.
    Link,
    /// Lowering, emission, targets.
    Targets,
    /// Scenes and running.
    Scenes,
    /// Lint rules.
    Lint,
}

impl Code {
    /// The area that it belongs to: the hundreds of its number, by the table at the head of this file.
    pub fn area(&self) -> Area {
        match self.id.as_bytes() {
            [b'L', ..] => Area::Lint,
            [_, b'0', b'1', ..] => Area::Preprocess,
            [_, b'0', b'2', ..] => Area::Syntax,
            [_, b'0', b'3', ..] => Area::Names,
            [_, b'0', b'4', ..] => Area::Types,
            [_, b'0', b'5', ..] => Area::Statements,
            [_, b'0', b'6', ..] => Area::Qualifiers,
            [_, b'0', b'7', ..] => Area::Link,
            [_, b'0', b'8', ..] => Area::Targets,
            [_, b'0', b'9', ..] => Area::Scenes,
            _ => Area::General,
        }
    }
}

impl PartialEq for Code {
    fn eq(&self, other: &Self) -> bool {
        self.id == other.id
    }
}

impl Eq for Code {}

impl fmt::Display for Code {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.id)
    }
}

/// An example on a page.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Example {
    /// A single vertex shader. Without a `#version` line of its own, it gets `#version 150`.
    Vertex(&'static str),
    /// A single fragment shader, with the same default version.
    Fragment(&'static str),
    /// A single geometry shader, with the same default version.
    Geometry(&'static str),
    /// A vertex and a fragment shader, linked.
    Program(&'static str, &'static str),
    /// Several shaders, linked; some may be of the same stage.
    Shaders(&'static [(crate::language::Stage, &'static str)]),
    /// Text that is not a shader (a scene, a command line). It is shown, not run.
    Text(&'static str),
    /// No short example exists.
    None,
}

/// Whether texts for people who look something up are left out: a module for the web is downloaded, and nothing in it shows them.
const LEFT_OUT: bool = cfg!(target_family = "wasm");

/// A text for people who look something up.
const fn text(text: &'static str) -> &'static str {
    if LEFT_OUT { "" } else { text }
}

/// An example for them.
const fn example(example: Example) -> Example {
    if LEFT_OUT { Example::None } else { example }
}

/// Declares the rows of a phase: `NAME = "E0301" "slug" Error "section" { page } bad { .. } good { .. };`
macro_rules! codes {
    ($($(#[$doc:meta])* $ident:ident = $id:literal $name:literal $severity:ident $section:literal
        $page:literal bad $bad:expr, good $good:expr;)*) => {
        $(#[doc = concat!("`", $id, "` ", $name)]
        #[doc = ""]
        #[doc = $page]
        #[doc(alias = $id)]
        pub static $ident: $crate::diagnostic::Code = $crate::diagnostic::Code {
            id: $id, name: $name, severity: $crate::diagnostic::Severity::$severity, section: $section,
            page: $crate::diagnostic::codes::text($page),
            bad: $crate::diagnostic::codes::example($bad),
            good: $crate::diagnostic::codes::example($good),
            lint: ::core::option::Option::None,
        };)*
        /// All rows of this phase.
        pub(super) static ALL: &[&$crate::diagnostic::Code] = &[$(&$ident),*];
    };
}

/// Declares the rows of lint rules: those of [`codes!`] with the level, the group and the fixes in place of the severity, and with
/// the reason of the level.
macro_rules! lints {
    ($($(#[$doc:meta])* $ident:ident = $id:literal $name:literal $level:ident $group:ident $fixable:ident $since:literal
        $section:literal $page:literal why $why:literal bad $bad:expr, good $good:expr;)*) => {
        $(#[doc = concat!("`", $id, "` ", $name)]
        #[doc = ""]
        #[doc = $page]
        #[doc(alias = $id)]
        pub static $ident: $crate::diagnostic::Code = $crate::diagnostic::Code {
            id: $id, name: $name, section: $section,
            page: $crate::diagnostic::codes::text($page),
            bad: $crate::diagnostic::codes::example($bad),
            good: $crate::diagnostic::codes::example($good),
            severity: match $crate::diagnostic::group::Default::$level {
                $crate::diagnostic::group::Default::Warning => $crate::diagnostic::Severity::Warning,
                _ => $crate::diagnostic::Severity::Note,
            },
            lint: ::core::option::Option::Some($crate::diagnostic::LintInfo {
                group: $crate::diagnostic::Group::$group, level: $crate::diagnostic::group::Default::$level,
                fixable: $crate::diagnostic::Fixable::$fixable, since: $since, rationale: $crate::diagnostic::codes::text($why),
            }),
        };)*
        /// All rows of this group.
        pub(in crate::diagnostic::codes) static ALL: &[&$crate::diagnostic::Code] = &[$(&$ident),*];
    };
}

pub mod general;
pub mod link;
pub mod lints;
pub mod names;
pub mod preprocess;
pub mod qualifiers;
pub mod scenes;
pub mod statements;
pub mod syntax;
pub mod targets;
pub mod types;
mod versions;

static PHASES: &[&[&Code]] = &[
    general::ALL,
    preprocess::ALL,
    syntax::ALL,
    names::ALL,
    types::ALL,
    statements::ALL,
    qualifiers::ALL,
    link::ALL,
    targets::ALL,
    scenes::ALL,
    lints::correctness::ALL,
    lints::port::ALL,
    lints::numerics::ALL,
    lints::performance::ALL,
    lints::style::ALL,
    lints::legacy::ALL,
];

/// All codes, in the order of the phases.
pub fn all() -> impl Iterator<Item = &'static Code> {
    PHASES.iter().flat_map(|phase| phase.iter().copied())
}

/// The rules that a level or a comment names.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Key {
    /// One code.
    Code(&'static Code),
    /// All lint rules of a group.
    Group(Group),
}

impl Key {
    /// The meaning of an identifier, the name of a code, or the name of a group.
    pub fn find(key: &str) -> Option<Self> {
        find(key).map(Self::Code).or_else(|| Group::find(key).map(Self::Group))
    }

    /// Whether a code is meant.
    pub fn names(self, code: &Code) -> bool {
        match self {
            Self::Code(named) => named == code,
            Self::Group(group) => code.group() == Some(group),
        }
    }

    /// All words that stand for something.
    pub fn words() -> impl Iterator<Item = &'static str> {
        all().flat_map(|code| [code.id, code.name]).chain(Group::ALL.into_iter().map(Group::name))
    }
}

/// The code with this identifier or name (`E0301`, `e0301` or `undeclared-identifier`).
pub fn find(key: &str) -> Option<&'static Code> {
    all().find(|code| code.id.eq_ignore_ascii_case(key) || code.name.eq_ignore_ascii_case(key))
}

#[cfg(test)]
mod tests {
    use super::{Area, PHASES, names, preprocess};

    #[test]
    fn the_codes_of_a_file_have_one_area_of_their_own() {
        let areas = PHASES.iter().map(|codes| {
            let area = codes[0].area();
            assert!(codes.iter().all(|code| code.area() == area), "{area:?}");
            area
        });
        let areas: Vec<Area> = areas.collect();
        assert_eq!(areas.iter().filter(|area| **area == Area::Lint).count(), 6);
        let phases: Vec<&Area> = areas.iter().filter(|area| **area != Area::Lint).collect();
        assert!(phases.iter().enumerate().all(|(index, area)| !phases[..index].contains(area)), "{phases:?}");
        assert_eq!((names::UNDECLARED.area(), preprocess::LATE_VERSION.area()), (Area::Names, Area::Preprocess));
    }
}
