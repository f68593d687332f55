//! [`Store`]: the folder of a cache on disk.
//!
//! *In:* a kind, a digest, bytes. *Out:* the same bytes later, or nothing. *Holds:* an entry is complete or not there: it is
//! written to a temporary file and renamed. Its digest is checked when it is read; one that does not fit is removed. Several
//! processes may use the folder at once, and a process that is killed leaves nothing but temporary files, which the next
//! cleaning removes.

use crate::cli::digest::Digest;
use std::fs::{self, File};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

/// The kind of an entry: as in Bazel's protocol, a result, found by the digest of what it depends on, or bytes, found by their own.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(in crate::cli) enum Kind {
    /// `ac`, the action cache.
    Result,
    /// `cas`, the content-addressed storage.
    Bytes,
}

impl Kind {
    /// Its name in paths and addresses.
    pub(in crate::cli) fn word(self) -> &'static str {
        match self {
            Self::Result => "ac",
            Self::Bytes => "cas",
        }
    }
}

/// The name of the folder of temporary files.
const TEMPORARY: &str = "tmp";
/// Marks the folder as a cache, for backup programs (<https://bford.info/cachedir/>) and for `glisten cache clean`.
const TAG: &str = "CACHEDIR.TAG";
const TAG_TEXT: &str = "Signature: 8a477f597d28d172789f06886806bc55\n# This folder is a cache of glisten.\n";
/// A temporary file of this age belongs to no process that runs.
const ABANDONED: Duration = Duration::from_secs(3600);
/// Entries used within this time count as used at the same time.
const SAME_TIME: Duration = Duration::from_secs(60);
/// Entries larger than this are not read.
const MAX_BYTES: u64 = 256 << 20;

/// An entry, for cleaning.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(in crate::cli) struct Entry {
    /// When it was last used.
    pub(in crate::cli) used: SystemTime,
    /// Its file.
    pub(in crate::cli) path: PathBuf,
    /// Its size.
    pub(in crate::cli) bytes: u64,
    /// Its kind.
    pub(in crate::cli) kind: Kind,
}

/// A folder with entries.
#[derive(Clone, Debug)]
pub(in crate::cli) struct Store {
    folder: PathBuf,
}

impl Store {
    /// The cache in a folder, which need not exist.
    pub(in crate::cli) fn new(folder: &Path) -> Self {
        Self { folder: folder.to_owned() }
    }

    /// The folder.
    pub(super) fn folder(&self) -> &Path {
        &self.folder
    }

    /// Whether the folder is a cache.
    pub(in crate::cli) fn is_there(&self) -> bool {
        self.folder.join(TAG).is_file()
    }

    fn path(&self, kind: Kind, digest: Digest) -> PathBuf {
        let name = digest.to_string();
        let (first, _) = name.split_at(2);
        self.folder.join(kind.word()).join(first).join(&name)
    }

    /// The bytes of an entry. One that is damaged is removed.
    pub(super) fn get(&self, kind: Kind, digest: Digest) -> Option<Vec<u8>> {
        let path = self.path(kind, digest);
        let file = File::open(&path).ok()?;
        let size = file.metadata().ok()?.len().min(MAX_BYTES);
        // Room for all of it: otherwise a file is read in five pieces.
        let mut bytes = Vec::with_capacity(usize::try_from(size).unwrap_or(0) + 1);
        file.take(MAX_BYTES).read_to_end(&mut bytes).ok()?;
        let content = match kind {
            Kind::Bytes => (Digest::of(&bytes) == digest).then_some(bytes),
            Kind::Result => unsealed(bytes, digest),
        };
        if content.is_none() {
            // Another process may have removed it already.
            let _ = fs::remove_file(&path);
            return None;
        }
        touch(&path);
        content
    }

    /// Keeps an entry.
    ///
    /// # Errors
    /// The folder cannot be written to, or the disk is full.
    pub(super) fn put(&self, kind: Kind, digest: Digest, bytes: &[u8]) -> io::Result<()> {
        let path = self.path(kind, digest);
        let sealed;
        let bytes = match kind {
            // One that is damaged is removed by reading it.
            Kind::Bytes if self.get(kind, digest).is_some() => return Ok(()),
            Kind::Bytes => bytes,
            Kind::Result => {
                sealed = [seal(bytes, digest).as_bytes(), bytes].concat();
                &sealed
            }
        };
        self.write(&path, bytes)
    }

    /// Writes a file of the cache.
    pub(super) fn write(&self, path: &Path, bytes: &[u8]) -> io::Result<()> {
        let temporary = self.folder.join(TEMPORARY);
        if !temporary.is_dir() {
            fs::create_dir_all(&temporary)?;
        }
        let tag = self.folder.join(TAG);
        if !tag.exists() {
            self.place(&tag, TAG_TEXT.as_bytes())?;
        }
        self.place(path, bytes)
    }

    fn place(&self, path: &Path, bytes: &[u8]) -> io::Result<()> {
        let mut file = tempfile::Builder::new().tempfile_in(self.folder.join(TEMPORARY))?;
        file.write_all(bytes)?;
        if let Some(folder) = path.parent().filter(|folder| !folder.is_dir()) {
            fs::create_dir_all(folder)?;
        }
        file.persist(path).map(drop).map_err(|error| error.error)
    }

    /// All entries, those first that have not been used for longest.
    pub(in crate::cli) fn entries(&self) -> Vec<Entry> {
        let mut entries = Vec::new();
        for kind in [Kind::Result, Kind::Bytes] {
            for folder in files_in(&self.folder.join(kind.word())) {
                for path in files_in(&folder) {
                    let Ok(found) = fs::metadata(&path) else { continue };
                    let used = found.modified().unwrap_or(SystemTime::UNIX_EPOCH);
                    entries.push(Entry { used, path, bytes: found.len(), kind });
                }
            }
        }
        entries.sort();
        entries
    }

    /// Removes entries until no more than `limit` bytes are left, those first that have not been used for longest. If there is
    /// too much, a tenth more is removed than has to be. Returns how many entries were removed.
    pub(in crate::cli) fn clean(&self, limit: u64) -> usize {
        for path in files_in(&self.folder.join(TEMPORARY)) {
            let age = fs::metadata(&path).and_then(|found| found.modified()).ok().and_then(|time| time.elapsed().ok());
            if limit == 0 || age.is_some_and(|age| age > ABANDONED) {
                let _ = fs::remove_file(&path);
            }
        }
        let entries = self.entries();
        let mut total: u64 = entries.iter().map(|entry| entry.bytes).sum();
        if total <= limit {
            return 0;
        }
        let mut removed = 0;
        for entry in entries {
            if total <= limit - limit / 10 && limit > 0 {
                break;
            }
            // Another process may have removed it; it is gone in any case.
            let _ = fs::remove_file(&entry.path);
            total = total.saturating_sub(entry.bytes);
            removed += 1;
        }
        removed
    }
}

/// The line before a result: what shows that it is whole, and the result of this key.
fn seal(bytes: &[u8], digest: Digest) -> String {
    let key = digest.to_string();
    format!("{}\n", crate::cli::digest::Hasher::new("seal").with(key.as_bytes()).with(bytes).finish())
}

fn unsealed(mut bytes: Vec<u8>, digest: Digest) -> Option<Vec<u8>> {
    let end = bytes.iter().position(|byte| *byte == b'\n')? + 1;
    let content = bytes.split_off(end);
    (bytes == seal(&content, digest).as_bytes()).then_some(content)
}

/// Notes that an entry is used.
fn touch(path: &Path) {
    let age = fs::metadata(path).and_then(|found| found.modified()).ok().and_then(|time| time.elapsed().ok());
    if age.is_none_or(|age| age < SAME_TIME) {
        return;
    }
    // A cache that is read only is not cleaned by this user.
    let _ = File::options().append(true).open(path).and_then(|file| file.set_modified(SystemTime::now()));
}

fn files_in(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten().filter_map(Result::ok);
    entries.map(|entry| entry.path()).collect()
}

#[cfg(test)]
mod tests {
    use super::{Kind, Store, files_in};
    use crate::cli::digest::Digest;
    use std::fs::{self, File};
    use std::time::{Duration, SystemTime};

    #[test]
    fn a_damaged_entry_is_none() {
        let folder = tempfile::tempdir().expect("a folder");
        let store = Store::new(folder.path());
        for kind in [Kind::Result, Kind::Bytes] {
            let digest = Digest::of(b"content");
            assert_eq!(store.get(kind, digest), None);
            store.put(kind, digest, b"content").expect("written");
            assert_eq!(store.get(kind, digest).as_deref(), Some(&b"content"[..]));
            let path = store.path(kind, digest);
            let whole = fs::read(&path).expect("the entry");
            for damaged in [&whole[..whole.len() - 1], b"", b"no line", &[&whole[..], b"x"].concat()] {
                fs::write(&path, damaged).expect("damaged");
                assert_eq!(store.get(kind, digest), None);
                assert!(!path.exists());
                store.put(kind, digest, b"content").expect("written again");
            }
            assert_eq!(store.get(kind, digest).as_deref(), Some(&b"content"[..]));
        }
        // A result under the key of another is no result.
        let other = Digest::of(b"other");
        fs::create_dir_all(store.path(Kind::Result, other).parent().expect("a folder")).expect("made");
        fs::copy(store.path(Kind::Result, Digest::of(b"content")), store.path(Kind::Result, other)).expect("copied");
        assert_eq!(store.get(Kind::Result, other), None);
    }

    #[test]
    fn what_was_not_used_for_longest_goes_first() {
        let folder = tempfile::tempdir().expect("a folder");
        let store = Store::new(folder.path());
        let bytes = |number: u8| vec![number; 1000];
        for number in 0..10 {
            let digest = Digest::of(&bytes(number));
            store.put(Kind::Bytes, digest, &bytes(number)).expect("written");
            let file = File::options().append(true).open(store.path(Kind::Bytes, digest)).expect("the entry");
            let time = SystemTime::now() - Duration::from_secs(1000 * u64::from(10 - number));
            file.set_modified(time).expect("the time is set");
        }
        assert!(store.get(Kind::Bytes, Digest::of(&bytes(0))).is_some(), "used again");
        assert_eq!(store.clean(10_000), 0);
        assert_eq!(store.clean(5000), 6);
        assert!(store.get(Kind::Bytes, Digest::of(&bytes(0))).is_some());
        assert!(store.get(Kind::Bytes, Digest::of(&bytes(1))).is_none());
        fs::write(folder.path().join("tmp/left"), b"half").expect("written");
        store.clean(0);
        assert!(store.entries().is_empty() && files_in(&folder.path().join("tmp")).is_empty());
    }
}
