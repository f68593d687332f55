//! [`LintInfo`]: what the row of a lint rule says besides that of every code: its group, whether it is on, its fixes.

/// A group of lint rules, which levels can name as a whole.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Group {
    /// Constructs that are hardly meant, or undefined.
    Correctness,
    /// Constructs that another machine or another interface of graphics takes differently, or does not have.
    Port,
    /// Values that are infinite, not a number, or less exact than they look.
    Numerics,
    /// Work that need not be done, or not so often.
    Performance,
    /// Text that can be simpler, and declarations that nothing uses.
    Style,
    /// Forms that later versions of the language replaced.
    Legacy,
}

impl Group {
    /// All groups, in the order in which they are listed.
    pub const ALL: [Self; 6] =
        [Self::Correctness, Self::Port, Self::Numerics, Self::Performance, Self::Style, Self::Legacy];

    /// The name that levels and comments take.
    pub fn name(self) -> &'static str {
        match self {
            Self::Correctness => "correctness",
            Self::Port => "port",
            Self::Numerics => "numerics",
            Self::Performance => "performance",
            Self::Style => "style",
            Self::Legacy => "legacy",
        }
    }

    /// The group of a name, in any case.
    pub fn find(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|group| group.name().eq_ignore_ascii_case(name))
    }
}

/// The machine fixes that the findings of a rule may have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fixable {
    /// None.
    No,
    /// Fixes that change nothing that the shader computes.
    Safe,
    /// Fixes that a person should look at.
    Unsafe,
}

impl Fixable {
    /// The word for it: `none`, `safe`, `unsafe`.
    pub fn name(self) -> &'static str {
        match self {
            Self::No => "none",
            Self::Safe => "safe",
            Self::Unsafe => "unsafe",
        }
    }
}

/// Whether a rule reports without being asked to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Default {
    /// Only where a level asks for it.
    Off,
    /// As a note.
    Note,
    /// As a warning.
    Warning,
}

impl Default {
    /// The word for it: `allow`, `note`, `warn`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Off => "allow",
            Self::Note => "note",
            Self::Warning => "warn",
        }
    }
}

/// The part of a row that only lint rules have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LintInfo {
    /// The group.
    pub group: Group,
    /// Its level without any configuration.
    pub level: Default,
    /// The fixes that its findings may have.
    pub fixable: Fixable,
    /// The first version of glisten that has the rule.
    pub since: &'static str,
    /// Why the level is what it is, and what the rule leaves out.
    pub rationale: &'static str,
}
