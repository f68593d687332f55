//! Places variables that the text or the host may place: attributes and fragment outputs (OpenGL 3.2 §2.11.3, §3.9.2).
//!
//! *In:* the variables of one interface and its [`Rules`]. *Out:* the location of each that has one.
//!
//! *Holds:* `layout(location)` in the text wins over a binding by name, that over the automatic choice: the lowest free
//! run, in the order of the declarations, for the active variables first. Inactive ones that find no room are left out.

use super::Linker;
use super::locations::Locations;
use crate::diagnostic::{Code, Diagnostic, codes};
use crate::hir::{Global, GlobalId};

/// A variable to place.
pub(super) struct Variable<'a> {
    pub(super) id: GlobalId,
    pub(super) global: &'a Global,
    /// How many locations it takes.
    pub(super) count: u32,
    /// Which row of locations it is in: the index of a fragment output, 0 elsewhere.
    pub(super) row: u32,
    /// Whether it has to have a location.
    pub(super) active: bool,
    /// The location that is given, then the one that was found.
    pub(super) location: Option<u32>,
}

/// What is special to an interface.
pub(super) struct Rules<'a> {
    /// How many locations each row has.
    pub(super) limit: u32,
    /// How many rows.
    pub(super) rows: usize,
    /// What a location is called: as a thing that is taken, and before its number.
    pub(super) words: (&'static str, &'static str),
    /// What is reported where there is no room.
    pub(super) too_many: &'static Code,
    /// How to make room.
    pub(super) help: Option<&'static str>,
    /// The host's choices. The last of a name counts.
    pub(super) bindings: &'a [(String, u32)],
}

/// Two variables that text or bindings put at one location.
pub(super) struct Clash {
    /// The one that was there, and the one that came.
    pub(super) variables: (GlobalId, GlobalId),
    /// The lowest location that they share.
    pub(super) shared: u32,
}

impl Rules<'_> {
    /// The location that the text or a binding gives.
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

    /// Gives each variable its location; `clash` judges those that share one.
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

/// `1 location`, `3 locations`
pub(super) fn plural(count: u32, noun: &str) -> String {
    let ending = if count == 1 { "" } else { "s" };
    format!("{count} {noun}{ending}")
}
