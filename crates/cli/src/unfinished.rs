//! Temporary files, which become others by a new name once they are complete.
//!
//! *In:* a folder. *Out:* a file in it that is locked until it is closed; on request, the removal of what killed commands left.
//!
//! *Holds:* the system drops the locks of a process that ends, in whatever way. So a temporary file without a lock is
//! nobody's, and one with a lock is left alone, whichever machine or container its command runs on. Where a file system has
//! no locks, age decides.

use std::fs::{self, DirEntry, File};
use std::io;
use std::path::Path;
use std::time::Duration;
use tempfile::{Builder, NamedTempFile};

/// Where there are no locks, who has not written to a temporary file for this long was killed.
const ABANDONED: Duration = Duration::from_secs(60);

/// The state of a lock after an attempt to take it.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Lock {
    Taken,
    Others,
    Unknown,
}

/// Makes a temporary file in a folder, and locks it.
///
/// # Errors
/// The folder cannot be written to.
pub(crate) fn create(builder: &Builder<'_, '_>, folder: &Path) -> io::Result<NamedTempFile> {
    loop {
        let file = builder.tempfile_in(folder)?;
        // Between its creation and its lock, another command may take it for one that was left.
        if lock(file.as_file()) != Lock::Others && is_named(file.as_file()) {
            return Ok(file);
        }
    }
}

/// Removes the temporary files of a folder that nobody writes to. Their names begin with `prefix`.
pub(crate) fn sweep(folder: &Path, prefix: &str) {
    let entries = fs::read_dir(folder).into_iter().flatten().filter_map(Result::ok);
    let named = entries.filter(|entry| entry.file_name().as_encoded_bytes().starts_with(prefix.as_bytes()));
    for entry in named.filter(|entry| entry.file_type().is_ok_and(|kind| kind.is_file())) {
        let Ok(file) = File::open(entry.path()) else { continue };
        let is_abandoned = match lock(&file) {
            Lock::Taken => true,
            Lock::Others => false,
            Lock::Unknown => is_old(&entry),
        };
        if is_abandoned {
            // Another command may have removed it; if it cannot be removed, it does no harm.
            let _ = fs::remove_file(entry.path());
        }
    }
}

fn is_old(entry: &DirEntry) -> bool {
    let modified = entry.metadata().and_then(|found| found.modified()).ok();
    modified.and_then(|time| time.elapsed().ok()).is_some_and(|age| age > ABANDONED)
}

#[cfg(unix)]
fn lock(file: &File) -> Lock {
    use rustix::fs::{FlockOperation, flock};
    match flock(file, FlockOperation::NonBlockingLockExclusive) {
        Ok(()) => Lock::Taken,
        Err(rustix::io::Errno::WOULDBLOCK) => Lock::Others,
        Err(_) => Lock::Unknown,
    }
}

#[cfg(not(unix))]
fn lock(_: &File) -> Lock {
    Lock::Unknown
}

/// Whether the file has not been removed.
#[cfg(unix)]
fn is_named(file: &File) -> bool {
    use std::os::unix::fs::MetadataExt;
    file.metadata().is_ok_and(|found| found.nlink() > 0)
}

#[cfg(not(unix))]
fn is_named(_: &File) -> bool {
    true
}

#[cfg(all(test, unix))]
mod tests {
    use super::{create, sweep};
    use std::fs;
    use tempfile::Builder;

    #[test]
    fn what_nobody_writes_to_is_removed() {
        let folder = tempfile::tempdir().expect("a folder");
        let mut builder = Builder::new();
        builder.prefix(".x-");
        let written = create(&builder, folder.path()).expect("made");
        let (left, other) = (folder.path().join(".x-left"), folder.path().join("other"));
        fs::write(&left, b"half").expect("written");
        fs::write(&other, b"whole").expect("written");
        std::os::unix::fs::symlink(&other, folder.path().join(".x-link")).expect("linked");
        sweep(folder.path(), ".x-");
        assert!(!left.exists() && other.exists() && written.path().exists());
        assert!(folder.path().join(".x-link").exists(), "a link is none of them");
        let path = written.path().to_owned();
        let (file, kept) = written.keep().expect("kept");
        sweep(folder.path(), ".x-");
        assert!(kept.exists(), "it is locked while it is open");
        drop(file);
        // A process that another test starts has the file, too, until it runs its own program.
        let is_gone = (0..500).any(|_| {
            sweep(folder.path(), ".x-");
            std::thread::sleep(std::time::Duration::from_millis(10));
            !path.exists()
        });
        assert!(is_gone);
    }
}
