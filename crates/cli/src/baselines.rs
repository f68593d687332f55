//! The baselines of a run: the one that the command line names, or those that the configurations of its files name.
//!
//! *In:* arguments, `baseline` in `[lint]` of `glisten.toml`. *Out:* units without the findings that are known; the files, written. *Holds:*
//! a flag takes precedence. A finding that any of the baselines has is known: names of files tell them apart.

use crate::baseline::{Baseline, BaselineArgs};
use crate::console::Console;
use crate::exit::Failure;
use crate::session::{Session, Unit};
use std::path::PathBuf;

/// The baselines of a run.
pub(crate) struct Baselines {
    /// Each with whether a configuration names it.
    list: Vec<(Baseline, bool)>,
}

impl Baselines {
    /// The baseline that the arguments name.
    ///
    /// # Errors
    /// The file cannot be read or is none.
    pub(crate) fn given(args: &BaselineArgs) -> Result<Self, Failure> {
        let given = Baseline::new(args)?;
        Ok(Self { list: given.into_iter().map(|baseline| (baseline, false)).collect() })
    }

    /// Adds those that the configurations of the units' files name, if the arguments name none.
    ///
    /// # Errors
    /// A file that cannot be read or is none; an update without any.
    pub(crate) fn complete(
        &mut self,
        args: &BaselineArgs,
        session: &mut Session<'_>,
        units: &[Unit],
    ) -> Result<(), Failure> {
        if self.list.is_empty() {
            let mut paths: Vec<PathBuf> = units.iter().filter_map(|unit| of_unit(session, unit)).collect();
            paths.sort();
            paths.dedup();
            for path in paths {
                self.list.extend(Baseline::new(&args.at(path))?.map(|baseline| (baseline, true)));
            }
        }
        if args.updates() && self.list.is_empty() {
            let message = "`--update-baseline` has no file to write";
            return Err(
                Failure::usage(message).help("name it by `--baseline`, or by `baseline` in `[lint]` of `glisten.toml`")
            );
        }
        Ok(())
    }

    /// Removes the known findings from the units.
    pub(crate) fn apply(&self, units: &mut [Unit], console: Option<&Console>) {
        for (baseline, _) in &self.list {
            baseline.apply(units, console);
        }
    }

    /// Writes the findings of the units, each into the baseline of its configuration.
    ///
    /// # Errors
    /// A file cannot be written.
    pub(crate) fn update(&self, session: &mut Session<'_>, units: &[Unit], console: &Console) -> Result<(), Failure> {
        for (baseline, by_configuration) in &self.list {
            let mut own =
                |unit: &&Unit| !by_configuration || of_unit(session, unit).is_some_and(|path| path == baseline.path());
            let units: Vec<&Unit> = units.iter().filter(|unit| own(unit)).collect();
            baseline.update(&units, console)?;
        }
        Ok(())
    }
}

/// The baseline that the configuration of a unit's first file names.
fn of_unit(session: &mut Session<'_>, unit: &Unit) -> Option<PathBuf> {
    let input = unit.group.inputs.first()?;
    session.settings_of(&input.name).baseline.clone()
}
