//! `--prune`: removes the outputs of variants that are no longer asked for.
//!
//! *In:* an output folder, and the files that the variants have. *Out:* a folder without other outputs. *Holds:* a file goes
//! only if its name is the digest of its own bytes, as the names of outputs are: what anybody else has put there remains.

use super::index::{DIGITS, Files};
use crate::digest::Digest;
use crate::exit::Failure;
use crate::files;
use std::fs;
use std::path::{Path, PathBuf};

/// Removes outputs that no variant has, and folders that are empty then.
///
/// # Errors
/// One of them cannot be removed.
pub(super) fn prune(folder: &Path, used: &Files) -> Result<(), Failure> {
    for program in entries(folder).into_iter().filter(|path| path.is_dir() && !path.is_symlink()) {
        let mut removed = false;
        for path in entries(&program) {
            let name = path.strip_prefix(folder).unwrap_or(&path).to_string_lossy().replace('\\', "/");
            if used.contains_key(&name) || !is_output(&path) {
                continue;
            }
            let failed = |error| Failure::usage(format!("cannot remove `{}`: {error}", path.display()));
            fs::remove_file(&path).map_err(failed)?;
            removed = true;
        }
        if removed {
            // One that is not empty remains.
            let _ = fs::remove_dir(&program);
        }
    }
    Ok(())
}

/// Whether a file is named after its own bytes.
fn is_output(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let Some((digits, _)) = name.split_once('.') else { return false };
    let may_be = digits.len() == DIGITS && digits.bytes().all(|digit| digit.is_ascii_hexdigit());
    let digest = || files::read(&name, path).ok().map(|bytes| Digest::of(&bytes).to_string());
    may_be && digest().is_some_and(|digest| digest.starts_with(digits))
}

fn entries(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten().filter_map(Result::ok);
    entries.map(|entry| entry.path()).collect()
}
