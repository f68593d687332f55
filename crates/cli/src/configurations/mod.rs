//! `glisten lint --configurations`: programs as each of their macros from outside would have them.
//!
//! ```text
//!  texts ──► choices   macros that decide conditions and are defined nowhere, with the values that matter
//!        ──► cover     a few configurations with every pair of values
//!        ──► allowed   those that `[lint.configurations]` allows
//!        ──► complete  more of them, for pairs and branches that are left out where configurations are forbidden
//!        ──► merge     each finding once, with the macros under which it comes
//! ```
//!
//! *In:* compiled programs; for some of them the variants of a file of permutations, which then are the configurations. *Out:* the programs with the findings of all configurations. *Holds:* macros that the command line
//! defines stay as they are. A configuration is compiled only if it can differ from those before it: the compiler tells which
//! macros a result depends on. One that reaches an `#error` is none: the author excludes it. Nor is one for which a file that a search
//! found would need a `#version` line: its host adds that.

mod allowed;
mod choices;
mod complete;
mod cover;
mod merge;

use crate::arguments::config;
use crate::inputs::Group;
use crate::session::{self, Session, Unit};
use crate::variants::Variant;
use crate::variants::stated::{Stated, Values};
use allowed::allowed;
use choices::{Choice, Conditions, choices_of, conditions};
use complete::{Completion, Fixed, has};
use glisten_front::compiler::{Compiler, Options};
use glisten_front::diagnostic::Diagnostic;
use glisten_front::diagnostic::codes::preprocess::{BRANCH_IN_NO_CONFIGURATION, ERROR_DIRECTIVE, MISSING_VERSION};
use glisten_front::source::{SourceFile, Span};
use merge::merged;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The most configurations of a program that nothing forbids.
const MAX_CONFIGURATIONS: usize = 64;
/// The most configurations of a program that are compiled, with those that an `#error` forbids.
const MAX_COMPILED: usize = 256;
/// The most macros of a program that are varied.
const MAX_CHOICES: usize = 40;
/// How many configurations are compiled at a time.
const AT_ONCE: usize = 8;
/// The most configurations that are tried for one branch.
const MAX_TRIES: usize = 32;
/// The most different variants of a program that are compiled.
const MAX_VARIANTS: usize = 4096;
/// How often texts that a configuration includes may bring new macros.
const MAX_ROUNDS: usize = 3;

/// The checks of units by themselves.
type Lints = fn(&mut Session<'_>, &[Unit], &[Compiler]) -> Vec<Vec<Diagnostic>>;

/// How much was looked at.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Extent {
    /// The programs that have configurations.
    pub(crate) programs: usize,
    /// Their configurations, and how many of them were compiled.
    pub(crate) configurations: usize,
    pub(crate) compiled: usize,
    /// The branches in their texts that macros from outside decide, and how many of them no configuration reaches.
    pub(crate) branches: usize,
    pub(crate) unreached: usize,
}

/// A configuration and its result.
struct Tried {
    variant: Variant,
    /// The place of its result among those of the program; another configuration may have the same.
    result: usize,
}

/// The result of a configuration.
struct Found {
    variant: Variant,
    unit: Unit,
    /// For each file the branches that it reaches, by the lines of their directives.
    reached: BTreeMap<String, BTreeSet<usize>>,
    /// Whether it reaches an `#error`.
    is_forbidden: bool,
}

/// The macros that the conditions of these texts ask for and that come from outside, with the values that make a difference; not
/// those of `given`.
#[cfg(feature = "lsp")]
pub(crate) fn asked(texts: &[&str], given: &BTreeSet<String>) -> Vec<(String, Vec<Option<String>>)> {
    let texts: Vec<Conditions> = texts.iter().map(|text| conditions(text)).collect();
    let choices = choices_of(&texts, given, MAX_CHOICES).into_iter();
    choices.map(|choice| (choice.name, choice.values)).collect()
}

/// The variants of programs by the names of these.
pub(crate) type Listed = BTreeMap<String, Vec<Variant>>;

/// The units with the findings of all configurations, which for programs in `listed` are these. `lints` gives the findings of the
/// rules.
pub(crate) fn explored(
    session: &mut Session<'_>,
    units: Vec<Unit>,
    listed: &Listed,
    found: &BTreeSet<PathBuf>,
    lints: Lints,
) -> (Vec<Unit>, Extent) {
    let mut extent = Extent::default();
    let mut all = Vec::new();
    for unit in units {
        let mut search = Search::new(session.compiler(), &unit, listed.get(&unit.group.name));
        if search.choices.is_empty() && search.listed.is_none() {
            all.push(unit);
            continue;
        }
        search.run(session, &unit.group);
        all.extend(search.finish(session, unit, (lints, found), &mut extent));
    }
    (all, extent)
}

/// The configurations of a program.
struct Search<'l> {
    /// The variants that somebody listed: there are no others.
    listed: Option<&'l Vec<Variant>>,
    /// The statements of the project.
    stated: Stated,
    /// The macros that the command line defines.
    given: BTreeSet<String>,
    /// The conditions of each file.
    texts: BTreeMap<String, Conditions>,
    choices: Vec<Choice>,
    tried: Vec<Tried>,
    found: Vec<Found>,
}

impl<'l> Search<'l> {
    fn new(compiler: &Compiler, unit: &Unit, listed: Option<&'l Vec<Variant>>) -> Self {
        let given = compiler.options().defines.iter().map(|(name, _)| name.clone()).collect();
        let first = unit.group.inputs.first().and_then(|input| input.path.as_deref());
        let folder = first.and_then(Path::parent).filter(|folder| !folder.as_os_str().is_empty());
        let stated =
            if listed.is_some() { Stated::default() } else { config::stated(folder.unwrap_or(Path::new("."))) };
        let (texts, choices, tried, found) = (BTreeMap::new(), Vec::new(), Vec::new(), Vec::new());
        let mut search = Self { listed, stated, given, texts, choices, tried, found };
        search.read([unit]);
        search
    }

    /// Looks for conditions in the files of results.
    fn read<'u>(&mut self, units: impl IntoIterator<Item = &'u Unit>) {
        for unit in units {
            // A name in angle brackets is no file: the command line, an engine's texts, the library; or it is standard input.
            let is_input = |name: &str| unit.group.inputs.iter().any(|input| input.name == name);
            let is_text = |name: &str| !name.starts_with('<') || is_input(name);
            for (_, file) in unit.batch.sources.files().filter(|(_, file)| is_text(file.name())) {
                self.texts.entry(file.name().to_owned()).or_insert_with(|| conditions(file.text()));
            }
        }
        let texts: Vec<Conditions> = self.texts.values().cloned().collect();
        self.choices = choices_of(&texts, &self.given, MAX_CHOICES);
        for choice in &mut self.choices {
            if let Some(variants) = self.listed {
                choice.values = values_in(variants, &choice.name);
            } else if let Some(values) = self.stated.values.get(&choice.name) {
                choice.values.clone_from(values);
            }
        }
    }

    /// The configurations that are tried first.
    fn first(&self) -> Vec<Variant> {
        if let Some(variants) = self.listed {
            return variants.clone();
        }
        let sizes: Vec<usize> = self.choices.iter().map(|choice| choice.values.len()).collect();
        let covering = cover::pairs(&sizes, MAX_CONFIGURATIONS);
        covering.iter().filter_map(|one| allowed(self.variant(one), &self.stated, &self.choices)).collect()
    }

    /// Whether `more` configurations may still be compiled.
    fn may_compile(&self, more: usize) -> bool {
        if self.listed.is_some() {
            return self.found.len() + more < MAX_VARIANTS;
        }
        let good = self.found.iter().filter(|found| !found.is_forbidden).count();
        good + more < MAX_CONFIGURATIONS && self.found.len() + more < MAX_COMPILED
    }

    fn run(&mut self, session: &Session<'_>, group: &Group) {
        for _ in 0..MAX_ROUNDS {
            // What was compiled before tells nothing of new macros.
            self.tried.clear();
            self.found.clear();
            let before = (self.choices.clone(), self.texts.len());
            // Those at a time that can work in parallel; the later ones may share a result.
            for variants in self.first().chunks(AT_ONCE) {
                self.try_all(session, group, variants.to_vec());
            }
            let found = std::mem::take(&mut self.found);
            self.read(found.iter().map(|found| &found.unit));
            self.found = found;
            if (&self.choices, self.texts.len()) == (&before.0, before.1) {
                break;
            }
        }
        if self.listed.is_some() {
            return;
        }
        for pair in self.open_pairs() {
            self.search(session, group, vec![pair.clone()], |search| search.has_good(&pair));
        }
        for branch in self.unreached() {
            let fixed = self.combinations(&branch.names);
            self.search(session, group, fixed, |search| search.is_reached(&branch));
        }
    }

    /// Tries configurations that have some of these values, one after the other, until one is `enough`.
    fn search(&mut self, session: &Session<'_>, group: &Group, all: Vec<Fixed>, enough: impl Fn(&Self) -> bool) {
        let mut tries = 0;
        for fixed in all {
            let forbidden = self.forbidden_groups();
            let good = self.found.iter().filter(|found| !found.is_forbidden).map(|found| &found.variant).collect();
            let groups = self.stated.groups().chain(forbidden).collect();
            let offered = Completion { stated: &self.stated, choices: &self.choices, groups, good }.of(&fixed);
            for variant in offered {
                if tries >= MAX_TRIES || enough(self) || !self.may_compile(0) {
                    return;
                }
                tries += 1;
                self.try_all(session, group, vec![variant]);
                // Where nothing forbids it, the others differ in macros that do not decide here.
                if self.has_good(&fixed) {
                    break;
                }
            }
        }
    }

    /// The macros of the branches with an `#error`.
    fn forbidden_groups(&self) -> impl Iterator<Item = BTreeSet<String>> + '_ {
        let branches = self.texts.values().flat_map(|text| &text.branches);
        branches.filter(|branch| branch.is_error).map(|branch| branch.names.as_ref().clone())
    }

    /// Whether a configuration that nothing forbids has these values.
    fn has_good(&self, fixed: &Fixed) -> bool {
        self.tried.iter().any(|tried| {
            has(&tried.variant, fixed) && self.found.get(tried.result).is_some_and(|found| !found.is_forbidden)
        })
    }

    /// The pairs of values that only forbidden configurations have; those of configurations that are allowed are there already.
    fn open_pairs(&self) -> Vec<Fixed> {
        let is_free = self.stated.groups().next().is_none() && self.found.iter().all(|found| !found.is_forbidden);
        if is_free {
            return Vec::new();
        }
        let mut open = Vec::new();
        for (at, a) in self.choices.iter().enumerate() {
            for b in self.choices.iter().skip(at + 1) {
                for (x, y) in a.values.iter().flat_map(|x| b.values.iter().map(move |y| (x, y))) {
                    let pair = Fixed::from([(a.name.clone(), x.clone()), (b.name.clone(), y.clone())]);
                    if !self.has_good(&pair) {
                        open.push(pair);
                    }
                }
            }
        }
        open
    }

    fn variant(&self, numbers: &[usize]) -> Variant {
        let value = |(choice, number): (&Choice, &usize)| {
            let value = choice.values.get(*number).cloned().flatten()?;
            Some((choice.name.clone(), value))
        };
        self.choices.iter().zip(numbers).filter_map(value).collect()
    }

    /// The combinations of the values of some macros. Those with more macros come first: a branch that is left is seldom one that
    /// wants none.
    fn combinations(&self, names: &BTreeSet<String>) -> Vec<Fixed> {
        let choices: Vec<&Choice> = self.choices.iter().filter(|choice| names.contains(&choice.name)).collect();
        let value = |choice: &Choice, at: usize| choice.values.get(at).cloned().flatten();
        let sizes: Vec<usize> = choices.iter().map(|choice| choice.values.len()).collect();
        let mut all = digits(&sizes, MAX_TRIES * MAX_TRIES);
        all.sort_by_cached_key(|one| {
            let defined = choices.iter().zip(one).filter(|(choice, at)| value(choice, **at).is_some());
            std::cmp::Reverse(defined.count())
        });
        all.truncate(MAX_TRIES);
        let fixed = |one: &Vec<usize>| {
            let values = choices.iter().zip(one);
            values.map(|(choice, at)| (choice.name.clone(), value(choice, *at))).collect()
        };
        all.iter().map(fixed).collect()
    }

    /// Compiles configurations in parallel, but for those that have the result of another one.
    fn try_all(&mut self, session: &Session<'_>, group: &Group, variants: Vec<Variant>) {
        let mut fresh: Vec<Variant> = Vec::new();
        for variant in variants {
            match self.found.iter().position(|found| has_result(&variant, found)) {
                Some(result) => self.tried.push(Tried { variant, result }),
                None if self.may_compile(fresh.len()) => fresh.push(variant),
                None => {}
            }
        }
        let listed = self.listed.into_iter().flatten().flat_map(|variant| variant.keys());
        let names: BTreeSet<&String> = self.choices.iter().map(|choice| &choice.name).chain(listed).collect();
        let names: Vec<String> = names.into_iter().cloned().collect();
        let texts = &self.texts;
        let work = |variant: Variant| compiled(session.compiler(), group, variant, &names, texts);
        let found: Vec<Found> = session.threads().map(fresh, work);
        for found in found {
            self.tried.push(Tried { variant: found.variant.clone(), result: self.found.len() });
            self.found.push(found);
        }
    }

    /// Whether a configuration that nothing forbids reaches a branch. An `#error` is reached by those that it forbids.
    fn is_reached(&self, branch: &Named) -> bool {
        self.found.iter().any(|found| (branch.is_error || !found.is_forbidden) && found.reaches(branch))
    }

    /// The branches that choices alone decide.
    fn branches(&self) -> impl Iterator<Item = Named> + '_ {
        let is_choice = |name: &String| self.choices.iter().any(|choice| choice.name == *name);
        self.texts.iter().flat_map(move |(file, text)| {
            let branches = text.branches.iter().filter(move |one| one.end > one.directive + 1);
            let decided = branches.filter(move |one| !one.names.is_empty() && one.names.iter().all(is_choice));
            decided.map(|one| Named {
                file: file.clone(),
                directive: one.directive,
                names: Arc::clone(&one.names),
                is_error: one.is_error,
            })
        })
    }

    fn unreached(&self) -> Vec<Named> {
        self.branches().filter(|one| !self.is_reached(one)).collect()
    }

    /// Whether all values of the macros that decide a branch were tried, and none reaches it, forbidden or not.
    fn is_dead(&self, branch: &Named) -> bool {
        if self.found.iter().any(|found| found.reaches(branch)) {
            return false;
        }
        let deciding = self.choices.iter().filter(|choice| branch.names.contains(&choice.name));
        let count = deciding.map(|choice| choice.values.len()).fold(1, usize::saturating_mul);
        self.may_compile(0) && (self.listed.is_some() || count <= MAX_TRIES)
    }

    /// The units of all configurations, without what others told already, and with what no configuration reaches.
    fn finish(
        mut self,
        session: &mut Session<'_>,
        unit: Unit,
        (lints, from_search): (Lints, &BTreeSet<PathBuf>),
        extent: &mut Extent,
    ) -> Vec<Unit> {
        let (branches, unreached) = (self.branches().count(), self.unreached());
        let dead: Vec<&Named> = unreached.iter().filter(|branch| self.is_dead(branch)).collect();
        extent.programs += 1;
        extent.branches += branches;
        extent.unreached += unreached.len();
        extent.configurations += self.tried.len();
        extent.compiled += self.found.len();
        let found = std::mem::take(&mut self.found);
        let (variants, units): (Vec<Variant>, Vec<(Unit, usize)>) =
            found.into_iter().map(|found| (found.variant, (found.unit, 0))).unzip();
        let mut units = session.adopt(units);
        let compilers: Vec<Compiler> =
            variants.iter().map(|variant| compiler_of(session.compiler(), variant, &[])).collect();
        let findings = lints(session, &units, &compilers);
        for (unit, findings) in units.iter_mut().zip(findings) {
            session.add(&mut unit.batch, findings);
        }
        let is_found = |unit: &Unit| {
            unit.group.inputs.iter().any(|input| input.path.as_ref().is_some_and(|path| from_search.contains(path)))
        };
        let is_listed = self.listed.is_some();
        let is_excluded = |unit: &Unit| {
            if is_listed {
                return false;
            }
            let mut errors = unit.batch.diagnostics.iter().filter(|one| one.is_error());
            errors.any(|one| *one.code == ERROR_DIRECTIVE || *one.code == MISSING_VERSION && is_found(unit))
        };
        let excluded: Vec<bool> = units.iter().map(is_excluded).collect();
        let tried = self
            .tried
            .iter()
            .filter(|tried| tried.result == 0 || !excluded.get(tried.result).copied().unwrap_or_default());
        let tried: Vec<(&Variant, usize)> = tried.map(|tried| (&tried.variant, tried.result)).collect();
        let mut units = merged(units, &variants, &tried, &self.texts);
        match units.first_mut() {
            Some(first) => {
                let found = dead.iter().filter_map(|branch| told(first, branch, self.listed.is_some()));
                let found = found.collect::<Vec<_>>();
                session.add(&mut first.batch, found);
            }
            None => units.push(unit),
        }
        units
    }
}

/// A branch with its file.
struct Named {
    file: String,
    directive: usize,
    names: Arc<BTreeSet<String>>,
    is_error: bool,
}

impl Found {
    fn reaches(&self, branch: &Named) -> bool {
        self.reached.get(&branch.file).is_some_and(|lines| lines.contains(&branch.directive))
    }
}

/// The finding that no configuration reaches a branch.
fn told(unit: &Unit, branch: &Named, is_listed: bool) -> Option<Diagnostic> {
    let (_, file) = unit.batch.sources.files().find(|(_, file)| file.name() == branch.file)?;
    let range = line(file, branch.directive)?;
    let text = file.text().get(range.clone())?;
    let indent = text.len() - text.trim_start().len();
    let start = file.base() + (range.start + indent) as u32;
    let span = Span::new(start, start + text.trim().len() as u32);
    let names: Vec<String> = branch.names.iter().map(|name| format!("`{name}`")).collect();
    let names = names.join(", ");
    let (message, help) = if is_listed {
        let message = format!("no variant reaches these lines, which depend on {names}");
        (message, "remove them, correct the condition, or add a variant")
    } else {
        let message = format!("no value of {names} that the conditions name reaches these lines");
        (message, "remove them, or correct the condition; `-D` and `[lint.configurations]` give a macro other values")
    };
    Some(Diagnostic::new(&BRANCH_IN_NO_CONFIGURATION, span, message).help(help))
}

/// The first `most` numbers whose digits have these bases, the last digit counting fastest.
fn digits(bases: &[usize], most: usize) -> Vec<Vec<usize>> {
    let count = bases.iter().copied().fold(1, usize::saturating_mul).min(most);
    let of = |mut number: usize| {
        let mut digits: Vec<usize> = Vec::new();
        for base in bases.iter().rev().map(|base| (*base).max(1)) {
            digits.push(number % base);
            number /= base;
        }
        digits.reverse();
        digits
    };
    (0..count).map(of).collect()
}

/// The values that a macro has in these.
fn values_in(variants: &[Variant], name: &str) -> Values {
    let mut values = Values::new();
    for variant in variants {
        let value = variant.get(name).cloned();
        if !values.contains(&value) {
            values.push(value);
        }
    }
    values
}

/// The bytes of a line, counted from 0.
fn line(file: &SourceFile, number: usize) -> Option<std::ops::Range<usize>> {
    let text = file.text();
    let mut start = 0;
    for (at, line) in text.split('\n').enumerate() {
        if at == number {
            return Some(start..start + line.len());
        }
        start += line.len() + 1;
    }
    None
}

/// Whether a configuration has the result of another one: they agree on all that the result depends on.
fn has_result(variant: &Variant, found: &Found) -> bool {
    found.unit.asked.iter().all(|name| variant.get(name) == found.variant.get(name))
}

/// The compiler of a configuration, which watches these macros.
fn compiler_of(compiler: &Compiler, variant: &Variant, names: &[String]) -> Compiler {
    let given = compiler.options().defines.iter().cloned();
    let own = variant.iter().map(|(name, value)| (name.clone(), value.clone()));
    let options =
        Options { defines: given.chain(own).collect(), watched: names.to_vec(), ..compiler.options().clone() };
    compiler.clone().with_options(options)
}

fn compiled(
    compiler: &Compiler,
    group: &Group,
    variant: Variant,
    names: &[String],
    texts: &BTreeMap<String, Conditions>,
) -> Found {
    let compiler = compiler_of(compiler, &variant, names);
    let (unit, _, inactive) = session::compile_group_by(group.clone(), |sources| {
        let (compilation, inspection) = compiler.inspect(sources, None);
        let spans = inspection.views().flat_map(|(_, view)| view.ast.directives.inactive.iter().copied());
        let inactive: Vec<Span> = spans.collect();
        (compilation, inactive)
    });
    let reached = unit.batch.sources.files().map(|(_, file)| {
        let Some(text) = texts.get(file.name()) else { return (file.name().to_owned(), BTreeSet::new()) };
        let starts: Vec<usize> =
            std::iter::once(0).chain(file.text().match_indices('\n').map(|(at, _)| at + 1)).collect();
        let is_in = |line: usize| {
            let at = starts.get(line).map(|at| file.base() + *at as u32);
            at.is_some_and(|at| !inactive.iter().any(|span| span.start <= at && at < span.end))
        };
        let lines = text.branches.iter().filter(|one| is_in(one.directive + 1)).map(|one| one.directive);
        (file.name().to_owned(), lines.collect())
    });
    let reached = reached.collect();
    let is_forbidden = unit.batch.diagnostics.iter().any(|one| one.is_error() && *one.code == ERROR_DIRECTIVE);
    Found { variant, reached, is_forbidden, unit }
}

#[cfg(test)]
mod tests {
    use super::digits;

    #[test]
    fn the_last_digit_counts_fastest() {
        assert_eq!(digits(&[2, 3], 100), [[0, 0], [0, 1], [0, 2], [1, 0], [1, 1], [1, 2]]);
        assert_eq!(
            digits(&[2; 80], 3).iter().map(|one| one[78..].to_vec()).collect::<Vec<_>>(),
            [[0, 0], [0, 1], [1, 0]]
        );
        assert_eq!(digits(&[], 5), [[0; 0]]);
    }
}
