//! [`Store`]: the folder of a cache on disk.
//!
//! *In:* a kind, a digest, bytes. *Out:* the same bytes later, or nothing. *Holds:* an entry is complete or not there: it is
//! written to a temporary file and renamed. Its digest is checked when it is read; one that does not fit is removed. Several
//! processes may use the folder at once, and a process that is killed leaves nothing but temporary files, which the next one
//! removes.

use crate::digest::Digest;
use crate::unfinished;
use std::fs::{self, File, Metadata};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

/// The kind of an entry: as in Bazel's protocol, a result, found by the digest of what it depends on, or bytes, found by their own.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Kind {
    /// `ac`, the action cache.
    Result,
    /// `cas`, the content-addressed storage.
    Bytes,
}

impl Kind {
    /// Its name in paths and addresses.
    pub(crate) fn word(self) -> &'static str {
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
/// Entries used within this time count as used at the same time.
const SAME_TIME: Duration = Duration::from_secs(60);
/// Entries larger than this are not read, since no output is as large.
const MAX_BYTES: u64 = 256 << 20;
/// The folders among which entries are spread evenly, by the first two digits of their digests.
const SHARDS: u64 = 256;
/// How many of them tell the size of the cache.
const SAMPLE: u64 = 8;
/// A cache with a smaller limit than this is measured completely.
const SMALL: u64 = 64 << 20;

/// An entry, for cleaning.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Entry {
    /// When it was last used.
    pub(crate) used: SystemTime,
    /// Its file.
    pub(crate) path: PathBuf,
    /// The bytes that it takes on the disk.
    pub(crate) bytes: u64,
    /// Its kind.
    pub(crate) kind: Kind,
}

/// A folder with entries.
#[derive(Clone, Debug)]
pub(crate) struct Store {
    folder: PathBuf,
}

impl Store {
    /// The cache in a folder, which need not exist.
    pub(crate) fn new(folder: &Path) -> Self {
        Self { folder: folder.to_owned() }
    }

    /// The folder.
    pub(super) fn folder(&self) -> &Path {
        &self.folder
    }

    /// Whether the folder is a cache.
    pub(crate) fn is_there(&self) -> bool {
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
        let found = fs::metadata(&path).ok()?;
        let bytes = read(&path, &found, MAX_BYTES);
        let content = bytes.and_then(|bytes| match kind {
            Kind::Bytes => (Digest::of(&bytes) == digest).then_some(bytes),
            Kind::Result => unsealed(bytes, digest),
        });
        if content.is_none() {
            // Another process may have removed it already.
            let _ = fs::remove_file(&path);
            return None;
        }
        touch(&path, &found);
        content
    }

    /// The digest that an entry of `programs` has.
    pub(super) fn remembered(path: &Path) -> Option<Digest> {
        let bytes = read(path, &fs::metadata(path).ok()?, 256)?;
        Digest::from_hex(str::from_utf8(&bytes).ok()?.trim())
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
        let mut file = unfinished::create(&tempfile::Builder::new(), &self.folder.join(TEMPORARY))?;
        file.write_all(bytes)?;
        if let Some(folder) = path.parent().filter(|folder| !folder.is_dir()) {
            fs::create_dir_all(folder)?;
        }
        file.persist(path).map(drop).map_err(|error| error.error)
    }

    /// All entries, those first that have not been used for longest.
    pub(crate) fn entries(&self) -> Vec<Entry> {
        let folders = |kind: Kind| files_in(&self.folder.join(kind.word()));
        let of = |kind| folders(kind).into_iter().flat_map(move |folder| entries_in(&folder, kind));
        let mut entries: Vec<Entry> = [Kind::Result, Kind::Bytes].into_iter().flat_map(of).collect();
        entries.sort();
        entries
    }

    /// Removes what killed processes left.
    pub(crate) fn sweep(&self) {
        unfinished::sweep(&self.folder.join(TEMPORARY), "");
    }

    /// Keeps the folder below a limit. Looking at all of it would take longer than a small build: unless the limit is small,
    /// some of its parts tell whether that is needed.
    pub(super) fn keep_below(&self, limit: u64) {
        if limit < SMALL || self.estimate() > limit / 2 {
            self.clean(limit);
        }
    }

    /// About how many bytes there are.
    fn estimate(&self) -> u64 {
        // Other processes look at other parts.
        let first = u64::from(std::process::id());
        let names = (0..SAMPLE).map(|number| format!("{:02x}", (first + number * SHARDS / SAMPLE) % SHARDS));
        let bytes = |name: String| -> u64 {
            let of = |kind: Kind| entries_in(&self.folder.join(kind.word()).join(&name), kind);
            [Kind::Result, Kind::Bytes].into_iter().flat_map(of).map(|entry| entry.bytes).sum()
        };
        names.map(bytes).sum::<u64>().saturating_mul(SHARDS / SAMPLE)
    }

    /// Removes entries until no more than `limit` bytes are left, those first that have not been used for longest. If there is
    /// too much, a tenth more is removed than has to be. Returns how many entries were removed.
    pub(crate) fn clean(&self, limit: u64) -> usize {
        self.sweep();
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
    format!("{}\n", crate::digest::Hasher::new("seal").with(key.as_bytes()).with(bytes).finish())
}

fn unsealed(mut bytes: Vec<u8>, digest: Digest) -> Option<Vec<u8>> {
    let end = bytes.iter().position(|byte| *byte == b'\n')? + 1;
    let content = bytes.split_off(end);
    (bytes == seal(&content, digest).as_bytes()).then_some(content)
}

/// Notes that an entry is used.
fn touch(path: &Path, found: &Metadata) {
    let age = found.modified().ok().and_then(|time| time.elapsed().ok());
    if age.is_none_or(|age| age < SAME_TIME) {
        return;
    }
    // A cache that is read only is not cleaned by this user.
    let _ = File::options().append(true).open(path).and_then(|file| file.set_modified(SystemTime::now()));
}

/// The bytes of a file; `None` for a device, a pipe, or more than `limit`. Nothing but a regular file is opened.
fn read(path: &Path, found: &Metadata, limit: u64) -> Option<Vec<u8>> {
    let size = Some(found.len()).filter(|size| found.is_file() && *size <= limit)?;
    // Room for all of it: otherwise a file is read in five pieces.
    let mut bytes = Vec::with_capacity(usize::try_from(size).ok()? + 1);
    File::open(path).ok()?.take(size + 1).read_to_end(&mut bytes).ok()?;
    (bytes.len() as u64 == size).then_some(bytes)
}

fn entries_in(folder: &Path, kind: Kind) -> Vec<Entry> {
    let entry = |path: PathBuf| {
        let found = fs::metadata(&path).ok()?;
        let used = found.modified().unwrap_or(SystemTime::UNIX_EPOCH);
        Some(Entry { used, path, bytes: on_disk(&found), kind })
    };
    files_in(folder).into_iter().filter_map(entry).collect()
}

/// The bytes that a file takes on the disk.
#[cfg(unix)]
fn on_disk(found: &Metadata) -> u64 {
    use std::os::unix::fs::MetadataExt;
    found.len().max(found.blocks() * 512)
}

#[cfg(not(unix))]
fn on_disk(found: &Metadata) -> u64 {
    found.len()
}

fn files_in(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten().filter_map(Result::ok);
    entries.map(|entry| entry.path()).collect()
}

#[cfg(test)]
mod tests {
    use super::{Kind, Store, files_in};
    use crate::digest::Digest;
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
        // What is no file is none either, and is not read.
        #[cfg(unix)]
        {
            let path = store.path(Kind::Bytes, Digest::of(b"content"));
            fs::remove_file(&path).expect("removed");
            std::os::unix::fs::symlink("/dev/zero", &path).expect("linked");
            assert_eq!(store.get(Kind::Bytes, Digest::of(b"content")), None);
            assert!(!path.is_symlink());
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
        // File systems differ in what a file takes.
        let each = store.entries()[0].bytes;
        assert!(each >= 1000, "{each}");
        assert_eq!(store.clean(10 * each), 0);
        assert_eq!(store.clean(5 * each), 6);
        assert!(store.get(Kind::Bytes, Digest::of(&bytes(0))).is_some());
        assert!(store.get(Kind::Bytes, Digest::of(&bytes(1))).is_none());
        store.keep_below(u64::MAX);
        assert_eq!(store.entries().len(), 4);
        fs::write(folder.path().join("tmp/left"), b"half").expect("written");
        store.clean(0);
        assert!(store.entries().is_empty() && files_in(&folder.path().join("tmp")).is_empty());
    }
}
