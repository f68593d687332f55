//! No output replaces a file that the same command reads, or another output.
//!
//! *In:* the names of files that are read, and of those to be written. *Out:* an error for a name that is both, or that is written twice.
//! *Holds:* links and other
//! names of a file are seen through; [`files::write`](crate::files::write) asks here, so each command that writes does. What changes
//! files in place says so by [`files::replace`](crate::files::replace).

use crate::exit::Failure;
use crate::seen;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Component, Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// The files that were read.
#[derive(Default)]
struct Inputs {
    /// As they were named.
    named: BTreeSet<PathBuf>,
    /// Those whose own names are not known yet. They are found out when a file is written that exists.
    pending: Vec<PathBuf>,
    /// Their own names.
    found: BTreeSet<PathBuf>,
}

static INPUTS: Mutex<Inputs> =
    Mutex::new(Inputs { named: BTreeSet::new(), pending: Vec::new(), found: BTreeSet::new() });

/// Notes that a file is read, or will be.
pub(crate) fn note(path: &Path) {
    seen::note(path);
    let mut inputs = INPUTS.lock().unwrap_or_else(PoisonError::into_inner);
    if !inputs.named.contains(path) {
        inputs.named.insert(path.to_owned());
        inputs.pending.push(path.to_owned());
    }
}

/// Refuses to write a file that is read.
///
/// # Errors
/// It is.
pub(crate) fn refuse(path: &Path) -> Result<(), Failure> {
    let Ok(own) = fs::canonicalize(path) else { return Ok(()) };
    let mut inputs = INPUTS.lock().unwrap_or_else(PoisonError::into_inner);
    let pending = std::mem::take(&mut inputs.pending);
    inputs.found.extend(pending.into_iter().filter_map(|path| fs::canonicalize(path).ok()));
    if own.is_file() && inputs.found.contains(&own) {
        let message = format!("the output `{}` is one of the inputs", path.display());
        return Err(Failure::usage(message).help("choose another name, or another folder"));
    }
    Ok(())
}

/// Refuses to write two outputs to one file.
///
/// # Errors
/// Two of the names are those of one file.
pub(crate) fn refuse_equal<'p>(outputs: impl IntoIterator<Item = &'p Path>) -> Result<(), Failure> {
    let mut seen = BTreeSet::new();
    for path in outputs {
        // What is no file, such as `/dev/null`, takes any number.
        let is_file = fs::metadata(path).map_or(true, |found| found.is_file());
        if is_file && !seen.insert(own_name(path)) {
            let message = format!("two outputs would both be written to `{}`", path.display());
            return Err(Failure::usage(message).help("choose another name for one of them"));
        }
    }
    Ok(())
}

/// The name that a file has, or would have, after links are followed.
pub(crate) fn own_name(path: &Path) -> PathBuf {
    let absolute = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let known = absolute.ancestors().find_map(|folder| Some((fs::canonicalize(folder).ok()?, folder)));
    let Some((mut own, folder)) = known else { return absolute };
    // Nothing of the rest is there yet, so it has no links.
    for part in absolute.strip_prefix(folder).into_iter().flat_map(Path::components) {
        match part {
            Component::ParentDir => drop(own.pop()),
            part => own.push(part),
        }
    }
    own
}

#[cfg(test)]
mod tests {
    use super::{note, refuse, refuse_equal};
    use std::fs;

    #[test]
    fn two_outputs_of_one_name_are_refused() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = |name: &str| folder.path().join(name);
        let are_refused = |names: [&str; 2]| {
            let [one, other] = names.map(path);
            refuse_equal([one.as_path(), other.as_path()]).is_err()
        };
        assert!(are_refused(["new", "new"]) && are_refused(["o/a.json", "./o/a.json"]));
        assert!(are_refused(["new", "o/../new"]) && are_refused(["new", "o/p/../../new"]));
        assert!(!are_refused(["new", "newer"]) && !are_refused(["o/a.json", "a.json"]));
        fs::write(path("there"), "").expect("written");
        assert!(are_refused(["there", "there"]) && !are_refused([".", "."]));
    }

    #[test]
    fn other_names_of_an_input_are_refused() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = |name: &str| folder.path().join(name);
        for name in ["a.frag", "b.frag"] {
            fs::write(path(name), "").expect("written");
        }
        fs::create_dir(path("below")).expect("made");
        note(&path("a.frag"));
        assert!(refuse(&path("a.frag")).is_err());
        assert!(refuse(&path("below/../a.frag")).is_err());
        assert!(refuse(&path("b.frag")).is_ok());
        assert!(refuse(&path("new.frag")).is_ok());
        #[cfg(unix)]
        {
            std::os::unix::fs::symlink(path("b.frag"), path("link.frag")).expect("linked");
            note(&path("link.frag"));
            assert!(refuse(&path("b.frag")).is_err());
        }
    }
}
