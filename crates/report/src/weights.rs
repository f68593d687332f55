//! [`Weights`]: the weight of each step of a program in the work of a report.
//!
//! *In:* the text of a weights file: a `name`, and the table `weights` of numbers by the names of steps. *Out:* the weighted
//! sum of [`Counts`].
//!
//! ```toml
//! name = "mine"
//! [weights]
//! pow = 12                                # for each component of the result
//! dot = { fixed = -1, argument = 2 }      # for a call, and for each component of the first argument
//! ```
//!
//! *Holds:* what a file does not name has the weight of the default file. A name that is not a step is an error with the nearest
//! one.

use glisten_emit::FloatWidth;
use glisten_front::diagnostic::did_you_mean;
use glisten_reference::{Counts, Step};
use serde::Deserialize;
use std::collections::BTreeMap;

/// The default: one for each scalar operation, four for those that are special, after the table of operations.
const OPERATIONS: &str = include_str!("weights/operations.toml");
/// Files by name.
const EMBEDDED: &[(&str, &str)] = &[
    ("operations", OPERATIONS),
    ("llvmpipe", include_str!("weights/llvmpipe.toml")),
    ("gpu", include_str!("weights/gpu.toml")),
];

/// The largest weight. With it, 2^40 steps are still far below the limits of a number.
const MOST: f64 = 1e6;

/// The weight of a step, depending on its sizes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
struct Sized {
    /// For each time.
    fixed: f64,
    /// For each component of the result.
    result: f64,
    /// For each component of the first argument; of a lookup for each texel.
    argument: f64,
}

impl Sized {
    fn of(self, step: Step) -> f64 {
        (self.fixed + self.result * f64::from(step.results) + self.argument * f64::from(step.argument)).max(0.0)
    }

    fn is_fit(self) -> bool {
        [self.fixed, self.result, self.argument].iter().all(|part| part.abs() <= MOST)
    }
}

/// A weight as it is written.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(untagged, expecting = "a number, or a table of `fixed`, `result` and `argument`")]
enum Written {
    Number(f64),
    Sized(Sized),
}

/// A weights file.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    name: String,
    #[serde(default)]
    #[expect(dead_code, reason = "for the reader of the file")]
    about: String,
    #[serde(default)]
    weights: BTreeMap<String, Written>,
    /// The weights of all operations in f16 and f64, against f32.
    #[serde(default)]
    width: WidthTable,
}

/// The table of the widths of floats.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct WidthTable {
    f16: Option<f64>,
    f64: Option<f64>,
}

/// The weight of every step.
#[derive(Clone, Debug, PartialEq)]
pub struct Weights {
    name: String,
    /// The factors of f16 and f64.
    widths: [f64; 2],
    steps: BTreeMap<&'static str, Sized>,
}

impl Default for Weights {
    fn default() -> Self {
        let none = Self { name: String::new(), widths: [1.0; 2], steps: BTreeMap::new() };
        none.with(OPERATIONS).expect("the embedded file names only steps, which a test shows")
    }
}

impl Weights {
    /// The names of the files that are built in.
    pub fn embedded() -> Vec<&'static str> {
        EMBEDDED.iter().map(|(name, _)| *name).collect()
    }

    /// The weights of a file that is built in.
    pub fn named(name: &str) -> Option<Self> {
        let text = EMBEDDED.iter().find(|(known, _)| *known == name)?.1;
        Self::default().with(text).ok()
    }

    /// The weights of a file with this text.
    ///
    /// # Errors
    /// A sentence that says what is wrong, and in which line.
    pub fn parse(text: &str) -> Result<Self, String> {
        Self::default().with(text)
    }

    /// The name that the file gives itself.
    pub fn name(&self) -> &str {
        &self.name
    }

    fn with(mut self, text: &str) -> Result<Self, String> {
        let file: File = toml::from_str(text).map_err(|error| {
            let line = error.span().map_or(1, |span| 1 + text[..span.start].matches('\n').count());
            format!("line {line}: {}", error.message().trim().replace('\n', ", "))
        })?;
        let names = Step::names();
        for (name, written) in &file.weights {
            let Some(known) = names.iter().find(|known| *known == name) else {
                let near = did_you_mean(name, names.iter().copied());
                let near = near.map_or_else(String::new, |near| format!("; did you mean `{near}`?"));
                return Err(format!("there is no step `{name}`{near}"));
            };
            let sized = match *written {
                Written::Number(result) => Sized { result, ..Sized::default() },
                Written::Sized(sized) => sized,
            };
            if !sized.is_fit() {
                return Err(format!("the weight of `{name}` is a number of at most {MOST}"));
            }
            self.steps.insert(known, sized);
        }
        for (own, (name, given)) in self.widths.iter_mut().zip([("f16", file.width.f16), ("f64", file.width.f64)]) {
            let Some(factor) = given else { continue };
            if !(factor > 0.0 && factor <= MOST) {
                return Err(format!("the weight of `{name}` is a number above 0 and at most {MOST}"));
            }
            *own = factor;
        }
        self.name = file.name;
        Ok(self)
    }

    /// The weighted sum, rounded to a whole number. The invocations of a stage are no operations, but may have a weight.
    pub(super) fn sum(&self, counts: &Counts, floats: FloatWidth) -> u64 {
        let factor = match floats {
            FloatWidth::Half => self.widths[0],
            FloatWidth::Single => 1.0,
            FloatWidth::Double => self.widths[1],
        };
        let parts = counts.iter().map(|(step, count)| {
            let weight = self.steps.get(step.name).copied().unwrap_or_default();
            weight.of(*step) * *count as f64
        });
        (factor * parts.sum::<f64>()).round() as u64
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glisten_front::builtin::BuiltinFunction;
    use glisten_front::builtin::operations::Class;

    /// The weights of an arithmetic and of a special operation, and of a lookup, by `library::Cost`.
    const CLASSES: [f64; 3] = [1.0, 4.0, 16.0];

    #[test]
    fn the_default_file_is_the_table_of_operations() {
        let weights = Weights::default();
        let missing: Vec<&str> = Step::names().into_iter().filter(|name| !weights.steps.contains_key(name)).collect();
        assert_eq!(missing, [""; 0], "every step has a weight");
        let [arithmetic, special, lookup] = CLASSES;
        for function in BuiltinFunction::ALL {
            let operation = function.operation();
            let counted = matches!(
                operation.class,
                Class::Unary(_) | Class::Binary(_) | Class::Ternary(_) | Class::Composite(_) | Class::Derivative(_)
            );
            // The reference has one step for `round` and this.
            if !counted || operation.name == "roundEven" {
                continue;
            }
            let cost = operation.cost;
            let part = |of: fn(&glisten_front::builtin::operations::Linear) -> i32| {
                f64::from(of(&cost.arithmetic)) * arithmetic + f64::from(of(&cost.special)) * special
            };
            let expected = Sized {
                fixed: part(|cost| cost.fixed),
                result: part(|cost| cost.result),
                argument: part(|cost| cost.first),
            };
            assert_eq!(weights.steps.get(operation.name), Some(&expected), "{}", operation.name);
        }
        assert_eq!(weights.steps.get(Step::LOOKUP), Some(&Sized { fixed: lookup, ..Sized::default() }));
    }

    #[test]
    fn embedded_files_can_be_read() {
        for name in Weights::embedded() {
            let weights = Weights::named(name).expect(name);
            assert_eq!(weights.name(), name);
            EMBEDDED.iter().for_each(|(_, text)| drop(Weights::parse(text).expect(name)));
        }
        assert_eq!(Weights::named("cpu"), None);
    }

    #[test]
    fn sums_follow_the_sizes() {
        let weights =
            Weights::parse("name = \"x\"\n[weights]\npow = 0.5\ndot = { fixed = -1, argument = 2 }").expect("good");
        let step = |name, results, argument| Step { name, results, argument };
        let counts = Counts::from([(step("pow", 1, 1), 10), (step("dot", 1, 3), 2), (step("+", 1, 1), 7)]);
        assert_eq!(weights.sum(&counts, FloatWidth::Single), 5 + 10 + 7);
        let wide = Weights::parse("name = \"x\"\n[width]\nf64 = 32").expect("good");
        assert_eq!(wide.sum(&counts, FloatWidth::Double), 32 * wide.sum(&counts, FloatWidth::Single));
    }

    #[test]
    fn mistakes_are_told() {
        for (text, told) in [
            ("name = \"x\"\n[weights]\npwo = 1", "did you mean `pow`?"),
            ("name = \"x\"\n[weights]\npow = \"dear\"", "line 3"),
            ("name = \"x\"\n[weights]\npow = { fix = 1 }", "line 3"),
            ("name = \"x\"\n[weights]\npow = 1e300", "the weight of `pow`"),
            ("name = \"x\"\n[weights]\npow = nan", "the weight of `pow`"),
            ("name = \"x\"\n[width]\nf16 = 0", "above 0"),
            ("name = \"x\"\n[width]\nf32 = 1", "line 3"),
            ("[weights]\npow = 1", "name"),
            ("name = \"x\"\nweight = 3", "weight"),
        ] {
            let error = Weights::parse(text).expect_err(text);
            assert!(error.contains(told), "{error}");
        }
    }
}
