//! Assigns locations to attributes and fragment outputs, whose locations the text or the host may set (OpenGL 3.2
//! §2.11.3, §3.9.2).
//!
//! *In:* the variables of one interface and its [`Rules`]. *Out:* the location of each variable that has one.
//!
//! *Holds:* `layout(location)` in the text takes precedence over a binding by name, and that over automatic
//! assignment, which takes the lowest free range. Active variables are assigned first, in order of declaration.
//! Inactive ones that do not fit are omitted.

use super::Linker;
use super::locations::Locations;
use crate::diagnostic::{Code, Diagnostic, codes, plural};
use crate::hir::{Global, GlobalId};

/// A variable that needs a location.
pub(super) struct Variable<'a> {
    pub(super) id: GlobalId,
    pub(super) global: &'a Global,
    /// The number of locations that it takes.
    pub(super) count: u32,
    /// Its row of locations: the index of a fragment output, otherwise 0.
    pub(super) row: u32,
    /// Whether it must have a location.
    pub(super) active: bool,
    /// The explicit location, later the assigned one.
    pub(super) location: Option<u32>,
}

/// The properties of one interface.
pub(super) struct Rules<'a> {
    /// The number of locations in each row.
    pub(super) limit: u32,
    /// The number of rows.
    pub(super) rows: usize,
    /// The words for a location: as a unit that is counted, and before its number.
    pub(super) words: (&'static str, &'static str),
    /// The code to report if the locations do not suffice.
    pub(super) too_many: &'static Code,
    /// How to free locations.
    pub(super) help: Option<&'static str>,
    /// The host's bindings. The last one for a name counts.
    pub(super) bindings: &'a [(String, u32)],
}

/// Two variables whose explicit locations overlap.
pub(super) struct Clash {
    /// The earlier one and the later one.
    pub(super) variables: (GlobalId, GlobalId),
    /// The lowest location that they share.
    pub(super) shared: u32,
}

impl Rules<'_> {
    /// The location that the text or a binding sets.
    pub(super) fn fixed(&self, ctx: &mut Linker<'_>, global: &Global) -> Option<u32> {
        let bound = self.bindings.iter().rev().find(|(name, _)| *name == global.name);
        let bound = bound.map(|&(_, location)| location);
        if let (Some(declared), Some(bound)) = (global.location, bound)
            && declared != bound
        {
            let (name, noun) = (&global.name, self.words.0);
            let message =
                format!("`{name}` is bound to {noun} {bound}, and its declaration says {declared}, which wins");
            ctx.report(Diagnostic::new(&codes::link::BINDING_IGNORED, global.span, message));
        }
        global.location.or(bound)
    }

    /// Assigns a location to each variable. `clash` decides about variables that share one.
    pub(super) fn place(
        &self,
        ctx: &mut Linker<'_>,
        variables: &mut [Variable<'_>],
        clash: &mut dyn FnMut(&mut Linker<'_>, &Clash),
    ) {
        let mut rows = vec![Locations::new(self.limit); self.rows];
        for variable in variables.iter() {
            if let Some(location) = variable.location
                && let Some(found) = self.place_fixed(ctx, &mut rows, variable, location)
            {
                clash(ctx, &found);
            }
        }
        for active in [true, false] {
            for variable in variables.iter_mut().filter(|variable| variable.active == active) {
                if variable.location.is_none() {
                    variable.location = place_free(&mut rows, variable);
                    if active && variable.location.is_none() {
                        self.no_room(ctx, variable);
                    }
                }
            }
        }
    }

    fn place_fixed(
        &self,
        ctx: &mut Linker<'_>,
        rows: &mut [Locations<Option<GlobalId>>],
        variable: &Variable<'_>,
        first: u32,
    ) -> Option<Clash> {
        let Some(run) = rows.get_mut(variable.row as usize).and_then(|row| row.run_mut(first, variable.count)) else {
            self.beyond_the_limit(ctx, variable, first);
            return None;
        };
        let held = run.iter().zip(first..).find_map(|(&holder, location)| Some((holder?, location)));
        run.fill(Some(variable.id));
        held.map(|(holder, shared)| Clash { variables: (holder, variable.id), shared })
    }

    fn beyond_the_limit(&self, ctx: &mut Linker<'_>, variable: &Variable<'_>, first: u32) {
        let Variable { global, count, .. } = variable;
        let (noun, number) = self.words;
        let (name, taken, limit) = (&global.name, plural(*count, noun), self.limit);
        let message = format!("`{name}` takes {taken} from {number} {first} on, and there are only {limit}");
        ctx.report(Diagnostic::new(self.too_many, global.span, message));
    }

    fn no_room(&self, ctx: &mut Linker<'_>, variable: &Variable<'_>) {
        let (name, taken) = (&variable.global.name, plural(variable.count, self.words.0));
        let message = format!("no room for `{name}`, which takes {taken} of the {}", self.limit);
        let diagnostic = Diagnostic::new(self.too_many, variable.global.span, message);
        ctx.report(match self.help {
            Some(help) => diagnostic.help(help),
            None => diagnostic,
        });
    }
}

fn place_free(rows: &mut [Locations<Option<GlobalId>>], variable: &Variable<'_>) -> Option<u32> {
    let row = rows.get_mut(variable.row as usize)?;
    let first = row.lowest(variable.count, Option::is_none)?;
    row.run_mut(first, variable.count)?.fill(Some(variable.id));
    Some(first)
}
