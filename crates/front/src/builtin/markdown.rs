//! The tables as Markdown, for `docs/operations.md` and `docs/envelope.md`.

use super::functions::{Row, all};
use super::operations::precision::RULES;
use super::operations::{
    Binary, BuiltinFunction, CallCost, Class, Formula, Linear, Lookup, Operation, Precision, Rule, Unary,
};
use super::{Availability, Stages};
use crate::language::NEVER;
use std::collections::BTreeSet;
use std::fmt::Write;

/// All operators on floats and all built-in functions, section by section.
pub fn operations_markdown() -> String {
    let mut out =
        String::from("### Operators on floats (§5.9)\n\n| operator | may jump | precision |\n| --- | --- | --- |\n");
    for (name, jumps, rule) in operators() {
        let _ = writeln!(out, "| `{name}` | {} | {} |", yes(jumps), rule.describe());
    }
    for section in sections() {
        let _ = write!(
            out,
            "\n### {section}\n\n| function | prototypes | since | class | cost | may jump | precision |\n\
             | --- | --- | --- | --- | --- | --- | --- |\n"
        );
        for operation in rows().filter(|operation| operation.section() == section) {
            let _ = writeln!(out, "{}", operation.line());
        }
    }
    out
}

/// All rules of precision: operation, allowed error, source.
pub fn precision_markdown() -> String {
    let mut out = String::from("| operation | allowed | source |\n| --- | --- | --- |\n");
    for rule in RULES {
        let _ = writeln!(out, "| {} | {} | {} |", code(rule.operation), rule.describe(), rule.source);
    }
    out
}

fn rows() -> impl Iterator<Item = &'static Operation> {
    BuiltinFunction::ALL.iter().map(|function| function.operation())
}

/// The sections in the specification's order, and then those of extensions.
fn sections() -> Vec<&'static str> {
    let mut seen: Vec<&'static str> = Vec::new();
    for row in all().filter(|row| !row.deprecated) {
        if !seen.contains(&row.section) {
            seen.push(row.section);
        }
    }
    seen.sort_by_key(|section| section.rsplit('.').next().and_then(|number| number.parse().ok()).unwrap_or(u32::MAX));
    seen
}

fn operators() -> impl Iterator<Item = (&'static str, bool, &'static Rule)> {
    let unary = [Unary::Neg].map(|op| (op.name(), op.jumps(), op.rule()));
    let binary = [Binary::Add, Binary::Sub, Binary::Mul, Binary::Div];
    unary.into_iter().chain(binary.map(|op| (op.name(), op.jumps(), op.rule())))
}

fn yes(holds: bool) -> &'static str {
    if holds { "yes" } else { "" }
}

/// A list of names, each as code.
fn code(list: &str) -> String {
    list.split(", ").map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ")
}

impl Operation {
    fn line(&self) -> String {
        let prototypes: Vec<&Row> = self.prototypes().filter(|row| !row.deprecated).collect();
        let list: Vec<String> = prototypes.iter().map(|row| format!("`{}`", row.prototype())).collect();
        let since: BTreeSet<String> = prototypes.iter().map(|row| row.availability.describe()).collect();
        let rule = self.rule.map_or(String::new(), Rule::describe);
        format!(
            "| `{}` | {} | {} | {} | {} | {} | {rule} |",
            self.name,
            list.join("<br>"),
            since.into_iter().collect::<Vec<_>>().join(", "),
            self.class.describe(),
            self.cost.describe(),
            yes(self.jumps()),
        )
    }
}

impl Availability {
    /// `130`, `150, geometry stage`
    fn describe(self) -> String {
        let stages = [(Stages::VERTEX, "vertex"), (Stages::GEOMETRY, "geometry"), (Stages::FRAGMENT, "fragment")];
        let named: Vec<&str> =
            stages.iter().filter(|(stage, _)| self.stages.contains(*stage)).map(|(_, name)| *name).collect();
        let stages = if self.stages.is_all() { String::new() } else { format!(" ({} stage)", named.join(", ")) };
        match self.since.desktop {
            NEVER => format!("extension{stages}"),
            since => format!("{since}{stages}"),
        }
    }
}

impl Class {
    fn describe(self) -> &'static str {
        match self {
            Self::Unary(_) => "one float, by component",
            Self::Binary(_) => "two floats, by component",
            Self::Ternary(_) => "three floats, by component",
            Self::Numbers(_) => "by the types of the arguments",
            Self::Composite(_) => "whole vectors or matrices",
            Self::Matrix(_) => "matrices, without sums",
            Self::Relation(_) => "comparison, by component",
            Self::Boolean(_) => "`bvec`",
            Self::Test(_) => "kind of a float",
            Self::BitCast(_) => "bits of a number",
            Self::Bits(_) => "bits of integers, by component",
            Self::Packing(_) => "floats in a `uint`",
            Self::Modf => "writes an argument",
            Self::Composed => "written out in other operations",
            Self::Derivative(_) => "difference of fragments",
            Self::Noise(_) => "noise, which is 0",
            Self::Emission(_) => "geometry output",
            Self::Texture(form) => match form.lookup {
                Lookup::Implicit => "texture, implicit level",
                Lookup::Lod => "texture, explicit level",
                Lookup::Grad => "texture, gradients",
                Lookup::Fetch => "one texel",
                Lookup::Size => "size of a texture",
                Lookup::Gather => "four texels",
                Lookup::QueryLod => "level of detail",
                Lookup::Levels => "number of levels",
            },
        }
    }
}

impl Linear {
    /// `2 n + 3 m - 1`, with `n` the components of the result and `m` those of the first argument.
    fn describe(self) -> String {
        let mut text = String::new();
        for (count, unit) in [(self.result, " n"), (self.first, " m"), (self.fixed, "")] {
            if count == 0 {
                continue;
            }
            match (text.is_empty(), count < 0) {
                (true, true) => text.push('-'),
                (true, false) => {}
                (false, true) => text.push_str(" - "),
                (false, false) => text.push_str(" + "),
            }
            match (count.abs(), unit) {
                (1, " n" | " m") => text.push_str(unit.trim_start()),
                (count, unit) => {
                    let _ = write!(text, "{count}{unit}");
                }
            }
        }
        text
    }
}

impl CallCost {
    fn describe(self) -> String {
        let parts = [(self.special.describe(), "special"), (self.arithmetic.describe(), "arithmetic")];
        let mut list: Vec<String> = parts
            .into_iter()
            .filter(|(count, _)| !count.is_empty())
            .map(|(count, unit)| format!("{count} {unit}"))
            .collect();
        if self.texture > 0 {
            list.push(format!("{} lookup", self.texture));
        }
        list.join(", ")
    }
}

impl Rule {
    /// The allowed error in words.
    pub fn describe(&self) -> String {
        let formula = |formula: &Formula| format!("`{}`", formula.text(self.arguments));
        match self.precision {
            Precision::Exact => "exact".into(),
            Precision::Correct => "either f32 neighbor".into(),
            Precision::Ulps(n) => format!("{n} ULP"),
            Precision::UlpsWithArgument { fixed, slope } => format!("{fixed} + {slope} abs(x) ULP"),
            Precision::UlpsOrWithin { ulps, error, low, high } => {
                format!("{ulps} ULP; {} in [{low}, {high}]", power(error))
            }
            Precision::Absolute(error) => power(error),
            Precision::Angle { error, .. } => {
                format!("{}; beyond pi an ULP of the argument more; beyond 2^23 anything from -1 to 1", power(error))
            }
            Precision::Inherited(inherited) => formula(inherited),
            Precision::InheritedOr(inherited, error) => format!("{}, or {error:e}", formula(inherited)),
            Precision::EitherHalf => "the nearest integer; a half to either side".into(),
            Precision::EitherOfNan => "exact; either operand where one may be NaN".into(),
            Precision::EitherDifference => "both differences in the quad".into(),
            Precision::Cofactors => "cofactors, and cofactors over the determinant".into(),
        }
    }
}

/// `2^-11` for a power of two.
fn power(error: f64) -> String {
    let exponent = error.log2();
    if exponent.fract() == 0.0 { format!("2^{exponent}") } else { format!("{error:e}") }
}
