//! The files that come from an older host, in the new folder.
//!
//! *In:* ported programs, and which of the files that they include are older. *Out:* those files at their new places, the blocks that they
//! hide, and a row of the account for each.

use super::programs::Ported;
use super::tree::NewFolder;
use crate::files;
use glisten_port::{FileReport, Host, done};
use glisten_upgrade::{NewFile, with_version};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Puts an included file of an older host to its new place.
pub(super) fn bring(
    pack: &Path,
    ported: &Ported,
    folder: &mut NewFolder,
    (file, old_name): (&NewFile, &str),
) -> Option<FileReport> {
    let new = folder.place(pack, Path::new(&file.new_name()))?;
    let own = folder.place(pack, Path::new(old_name));
    // An engine that ignores the version of an included file has it blank.
    let on_disk = || files::read(old_name, Path::new(old_name)).ok();
    let old = own.as_ref().and_then(|own| folder.text(own));
    let old = old.or_else(|| on_disk().map(|bytes| String::from_utf8_lossy(&bytes).into_owned()));
    let old = old.unwrap_or_else(|| file.old.clone());
    let text = with_version(&old, &file.text);
    let is_read = ported.programs.iter().any(|program| program.index.is_none() && program.reads.contains(&file.name));
    let first = match &own {
        Some(own) if is_read => {
            format!("copied; `{own}` stays for a program that was left as it was, and hides the host's file")
        }
        Some(own) => {
            folder.remove(own);
            moved_away(own)
        }
        None => "a file of the older host; the new one has another of this name".to_owned(),
    };
    folder.add(&new, text.clone().into_bytes());
    let done = std::iter::once(first).chain(done(&old, &text)).collect();
    let texts = (old, text);
    Some(FileReport { file: own.unwrap_or_else(|| new.clone()), new, done, notes: Vec::new(), texts })
}

/// Moves the older files that nothing includes.
pub(super) fn move_unread(pack: &Path, ported: &Ported, folder: &mut NewFolder) -> Vec<FileReport> {
    let moved = ported.older_files.unread().into_iter().filter_map(|(old, new)| {
        let places = [&old, &new].map(|name| folder.place(pack, Path::new(name)));
        let [Some(file), Some(new)] = places else { return None };
        let text = folder.text(&file)?;
        folder.replace(&file, &new, text.clone().into_bytes());
        Some(FileReport { done: vec![moved_away(&file)], file, new, notes: Vec::new(), texts: (text.clone(), text) })
    });
    moved.collect()
}

/// The sentence about a file that would hide one of the host.
fn moved_away(file: &str) -> String {
    format!("moved, because under its old name it would hide the host's file: `{file}`")
}

/// Adds the blocks of the host whose files older ones hide.
pub(super) fn blocks(pack: &Path, host: &Host, ported: &Ported, folder: &mut NewFolder) -> Vec<FileReport> {
    let used = ported.tree.files.iter().flat_map(|file| ported.older_files.blocks(host, &file.name, &file.text));
    let places: BTreeMap<PathBuf, String> = used.collect();
    let added = places.into_iter().filter_map(|(path, text)| {
        let name = folder.place(pack, &path)?;
        folder.add(&name, text.clone().into_bytes());
        let done = vec!["a block of the host, without the functions of its file".to_owned()];
        Some(FileReport { file: name.clone(), new: name, done, notes: Vec::new(), texts: (String::new(), text) })
    });
    added.collect()
}
