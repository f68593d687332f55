//! A copy of the sources with switches for faults.
//!
//! *In:* the sources, and rows of the table. *Out:* files. *Holds:* a file is written only if it differs, so that a second build is short. Every
//! file of the repository is copied; what git ignores is not.

use super::{Planted, SWITCH};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::process::Command;

/// The module that tells which fault is on.
const MODULE: &str = "//! The fault that is on.\n\
use std::sync::OnceLock;\n\
/// Whether the fault of a number is on.\n\
#[inline]\n\
pub fn on(number: u32) -> bool {\n\
    static CHOSEN: OnceLock<u32> = OnceLock::new();\n\
    *CHOSEN.get_or_init(|| std::env::var(\"SWITCH\").ok().and_then(|text| text.parse().ok()).unwrap_or(0)) == number\n\
}\n";

fn wrong(path: &Path) -> impl Fn(std::io::Error) -> String + '_ {
    move |error| format!("{}: {error}", path.display())
}

/// Writes a file if it differs.
fn write(path: &Path, bytes: &[u8]) -> Result<(), String> {
    if std::fs::read(path).is_ok_and(|old| old == bytes) {
        return Ok(());
    }
    let folder = path.parent().unwrap_or(path);
    std::fs::create_dir_all(folder).map_err(wrong(folder))?;
    std::fs::write(path, bytes).map_err(wrong(path))
}

/// Copies the files of the repository, but for those in which faults are planted: [`plant`] writes them.
pub(super) fn copy(root: &Path, to: &Path) -> Result<(), String> {
    let listed = Command::new("git").args(["ls-files", "-z"]).current_dir(root).output();
    let listed = listed.map_err(|error| format!("git: {error}"))?;
    for name in String::from_utf8_lossy(&listed.stdout).split('\0').filter(|name| !name.is_empty()) {
        let path = root.join(name);
        if name.ends_with(".rs") || !path.is_file() {
            continue;
        }
        write(&to.join(name), &std::fs::read(&path).map_err(wrong(&path))?)?;
    }
    Ok(())
}

/// Writes the sources in Rust, with the faults. Those of an earlier copy that are there no more are removed.
pub(super) fn plant(root: &Path, to: &Path, faults: &[Planted]) -> Result<(), String> {
    let sources = sources(root, faults)?;
    sources.iter().try_for_each(|(name, text)| write(&to.join(name), text.as_bytes()))?;
    remove_others(to, &sources.keys().map(|name| to.join(name)).collect())
}

/// Removes the sources in Rust below a folder that are not among these.
fn remove_others(folder: &Path, these: &BTreeSet<PathBuf>) -> Result<(), String> {
    for entry in std::fs::read_dir(folder).map_err(wrong(folder))? {
        let path = entry.map_err(wrong(folder))?.path();
        if path.is_dir() {
            remove_others(&path, these)?;
        } else if path.extension().is_some_and(|extension| extension == "rs") && !these.contains(&path) {
            std::fs::remove_file(&path).map_err(wrong(&path))?;
        }
    }
    Ok(())
}

/// The sources in Rust by their names, with the faults.
pub(super) fn sources(root: &Path, faults: &[Planted]) -> Result<BTreeMap<String, String>, String> {
    let listed = Command::new("git").args(["ls-files", "-z", "*.rs"]).current_dir(root).output();
    let listed = listed.map_err(|error| format!("git: {error}"))?;
    let mut files: BTreeMap<String, String> = BTreeMap::new();
    for name in String::from_utf8_lossy(&listed.stdout).split('\0').filter(|name| !name.is_empty()) {
        let path = root.join(name);
        if path.is_file() {
            files.insert(name.to_owned(), std::fs::read_to_string(&path).map_err(wrong(&path))?);
        }
    }
    for (number, fault) in faults.iter().enumerate() {
        let text = files.get_mut(&fault.file).ok_or_else(|| format!("`{}`: no file {}", fault.name, fault.file))?;
        *text = planted(text, fault, number + 1)?;
    }
    let library = "crates/front/src/lib.rs";
    let text = files.get_mut(library).ok_or_else(|| format!("no file {library}"))?;
    text.push_str("\n#[doc(hidden)]\npub mod planted;\n");
    files.insert("crates/front/src/planted.rs".to_owned(), MODULE.replace("SWITCH", SWITCH));
    Ok(files)
}

/// A text with a switch for a fault.
fn planted(text: &str, fault: &Planted, number: usize) -> Result<String, String> {
    let [before, expression, behind] = &fault.text;
    let whole = fault.text.concat();
    let mut places = text.match_indices(&whole);
    let (Some((at, _)), None) = (places.next(), places.next()) else {
        let count = text.matches(&whole).count();
        return Err(format!("`{}`: {} has its text {count} times, not once", fault.name, fault.file));
    };
    let path = if fault.file.starts_with("crates/front/") { "crate" } else { "glisten_front" };
    let switch =
        format!("{before}(if {path}::planted::on({number}) {{ {} }} else {{ {expression} }}){behind}", fault.faulty);
    let (head, tail) = text.split_at(at);
    Ok(format!("{head}{switch}{}", tail.get(whole.len()..).unwrap_or_default()))
}

#[cfg(test)]
mod tests {
    use super::{planted, remove_others};
    use crate::faults::read;
    use std::collections::BTreeSet;

    #[test]
    fn a_fault_has_a_switch() {
        let table = "[[fault]]\nname = 'n'\nphase = 'p'\nfile = 'src/a.rs'\ntext = 'x = «a + b»;'\nfaulty = 'a - b'\n";
        let faults = read(table).expect("a table");
        let fault = faults.first().expect("a row");
        let text = planted("let x = a + b;", fault, 3);
        let expected = "let x = (if glisten_front::planted::on(3) { a - b } else { a + b });";
        assert_eq!(text.as_deref(), Ok(expected));
        assert!(planted("let x = a;", fault, 3).is_err());
    }

    #[test]
    fn sources_that_are_there_no_more_are_removed() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = |name: &str| folder.path().join(name);
        std::fs::create_dir(path("a")).expect("a folder");
        ["a.rs", "a/mod.rs", "a/b.txt"].iter().for_each(|name| std::fs::write(path(name), "").expect("written"));
        remove_others(folder.path(), &BTreeSet::from([path("a/mod.rs")])).expect("removed");
        assert_eq!(["a.rs", "a/mod.rs", "a/b.txt"].map(|name| path(name).exists()), [false, true, true]);
    }
}
