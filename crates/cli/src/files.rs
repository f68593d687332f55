//! Reads files completely, with a clear message for each possible failure, and writes them completely or not at all.

use crate::buffers;
use crate::exit::Failure;
#[cfg(feature = "play")]
use crate::gate;
use crate::overwrite;
use crate::pipes;
use crate::trace;
use crate::unfinished;
use glisten_front::diagnostic::codes::general;
use glisten_front::diagnostic::{Code, Diagnostic};
use glisten_front::source::{Prelude, SourceMap, Span};
use glisten_front::syntax::is_no_text;
use glisten_scene::{confined_to, is_allowed, may_end};
use glisten_sources::with_line_feeds;
use glisten_verify::scene::{DiskFiles, FileError, FileSource};
use std::collections::{BTreeMap, BTreeSet};
use std::ffi::OsString;
use std::fs;
use std::io::{self, Read, Write};
use std::path::{Component, Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

/// The largest file that is read at all. Sources have a smaller limit of their own, with its own code.
const MAX_BYTES: u64 = 64 << 20;

/// Why a file cannot be read: a code, and a sentence that names the file.
#[derive(Debug)]
pub(crate) struct ReadError {
    /// The code.
    pub(crate) code: &'static Code,
    /// The message.
    pub(crate) message: String,
    /// The help text.
    pub(crate) help: Option<String>,
}

impl ReadError {
    fn new(code: &'static Code, message: String) -> Self {
        Self { code, message, help: None }
    }

    /// The error as a diagnostic about the whole file `name`.
    pub(crate) fn diagnostic(self, sources: &mut SourceMap, name: &str) -> Diagnostic {
        let base = sources.add(name, "").map_or(0, |id| sources.file(id).base());
        Diagnostic::new(self.code, Span::new(base, base), self.message).maybe_help(self.help)
    }
}

/// The whole path of a file or folder, without `..`: the folder above `a/..` is not that of the name before, and `a` may be a link.
pub(crate) fn real(path: &Path) -> PathBuf {
    let goes_up = path.components().any(|part| part == Component::ParentDir);
    let real = if goes_up { fs::canonicalize(path) } else { std::path::absolute(path) };
    real.unwrap_or_else(|_| path.to_owned())
}

/// One name for a file, whatever the path to its folder: `a.glsl`, `./a.glsl`, `../here/a.glsl`. A link is a file of its own. What is on
/// no disk keeps its name.
pub(crate) fn one_name(name: &str) -> String {
    let path = Path::new(name);
    let folder = path.parent().map(|folder| if folder.as_os_str().is_empty() { Path::new(".") } else { folder });
    let real = folder.filter(|_| !name.starts_with('<')).and_then(|folder| fs::canonicalize(folder).ok());
    match (real, path.file_name()) {
        (Some(folder), Some(file)) => folder.join(file).to_string_lossy().into_owned(),
        _ => name.to_owned(),
    }
}

/// The name of a file from a folder, with `..` where it is not below that. Both are absolute. `None` if nothing leads from one to the
/// other: they are on different drives.
pub(crate) fn from_folder(file: &Path, folder: &Path) -> Option<PathBuf> {
    let common = file.components().zip(folder.components()).take_while(|(ours, theirs)| ours == theirs).count();
    let up = folder.components().skip(common);
    let is_below = common > 0 && up.clone().all(|part| matches!(part, Component::Normal(_)));
    is_below.then(|| up.map(|_| Component::ParentDir).chain(file.components().skip(common)).collect())
}

/// Reads a source text. Bytes that are not UTF-8 become U+FFFD.
pub(crate) fn read_source(name: &str, path: Option<&Path>) -> Result<Arc<str>, ReadError> {
    let bytes = match path {
        Some(path) => read(name, path)?,
        None => standard_input(name)?,
    };
    text_of(name, bytes)
}

/// The bytes of standard input, which each configuration of a source reads again.
fn standard_input(name: &str) -> Result<Vec<u8>, ReadError> {
    static READ: Mutex<Option<Vec<u8>>> = Mutex::new(None);
    let mut read = READ.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(bytes) = read.as_ref() {
        return Ok(bytes.clone());
    }
    let bytes = read_all(name, io::stdin().lock(), 0)?;
    *read = Some(bytes.clone());
    Ok(bytes)
}

/// Reads a text to put before sources. It may be empty.
pub(crate) fn read_prelude(path: &Path) -> Result<Prelude, ReadError> {
    let name = path.to_string_lossy().into_owned();
    let bytes = read(&name, path)?;
    let text = if bytes.is_empty() { "".into() } else { text_of(&name, bytes)? };
    Ok(Prelude { name, text })
}

/// The paths that are not UTF-8, by what is shown for them.
static NAMES: Mutex<BTreeMap<String, PathBuf>> = Mutex::new(BTreeMap::new());

/// The name that is shown for a path.
pub(crate) fn shown(path: &Path) -> String {
    let name = path.to_string_lossy().into_owned();
    note_name(&name, path);
    name
}

fn note_name(name: &str, path: &Path) {
    if path.to_str().is_none() {
        NAMES.lock().unwrap_or_else(PoisonError::into_inner).insert(name.to_owned(), path.to_owned());
    }
}

/// The path of a name that is shown.
pub(crate) fn path_of_name(name: &str) -> PathBuf {
    let names = NAMES.lock().unwrap_or_else(PoisonError::into_inner);
    names.get(name).cloned().unwrap_or_else(|| PathBuf::from(name))
}

/// The bytes of a name that is shown.
pub(crate) fn bytes_of_name(name: &str) -> Vec<u8> {
    path_of_name(name).as_os_str().as_encoded_bytes().to_vec()
}

/// Reads a file of any kind.
pub(crate) fn read(name: &str, path: &Path) -> Result<Vec<u8>, ReadError> {
    overwrite::note(path);
    note_name(name, path);
    let bytes = read_whole(name, path);
    trace::read(path, bytes.as_deref().ok());
    bytes
}

/// The arguments that confine a process of this program to the sandbox of this one.
pub(crate) fn sandbox() -> impl Iterator<Item = OsString> {
    confined_to().into_iter().flat_map(|folder| ["--sandbox".into(), folder.into()])
}

/// The files of the disk for scenes, or the texts in their place; it notes what is read.
pub(crate) struct SceneFiles;

impl FileSource for SceneFiles {
    fn read(&self, path: &str) -> Result<Vec<u8>, FileError> {
        overwrite::note(Path::new(path));
        let bytes = match buffers::get(Path::new(path)) {
            Some(bytes) => Ok(bytes.to_vec()),
            None if !is_open(Path::new(path)) => Err(FileError::Unreadable(OUTSIDE.to_owned())),
            None => DiskFiles.read(path),
        };
        trace::read(Path::new(path), bytes.as_deref().ok());
        bytes
    }
}

/// The reason for what the page of `glisten play` may not read.
const OUTSIDE: &str = "it is in none of the folders of `glisten play`";

/// Whether the job that runs may read a file of the disk.
#[cfg(feature = "play")]
fn is_open(path: &Path) -> bool {
    gate::may_read(path)
}

#[cfg(not(feature = "play"))]
fn is_open(_: &Path) -> bool {
    true
}

fn read_whole(name: &str, path: &Path) -> Result<Vec<u8>, ReadError> {
    if let Some(bytes) = buffers::get(path) {
        return Ok(bytes.to_vec());
    }
    if !is_allowed(path) {
        let message = format!("`{name}` is outside of the sandbox, and is not read");
        return Err(ReadError::new(&general::FILE_UNREADABLE, message));
    }
    if !is_open(path) {
        return Err(ReadError::new(&general::FILE_UNREADABLE, format!("cannot read `{name}`: {OUTSIDE}")));
    }
    let metadata = fs::metadata(path).map_err(|error| read_error(name, path, &error))?;
    // Room for all of it: otherwise a file is read in pieces.
    let room = metadata.len().min(MAX_BYTES) as usize + 1;
    if metadata.is_dir() {
        // A search gives the folders that it cannot read.
        return Err(match fs::read_dir(path) {
            Ok(_) => ReadError::new(&general::FILE_IS_FOLDER, format!("`{name}` is a folder, not a file")),
            Err(error) => {
                let message = format!("cannot read the folder `{name}`: {error}");
                let exclude =
                    "`exclude` under `[lint]` in glisten.toml, or .gitignore, leaves a folder out of searches";
                ReadError { help: Some(exclude.to_owned()), ..ReadError::new(&general::FILE_UNREADABLE, message) }
            }
        });
    }
    if metadata.len() > MAX_BYTES {
        return Err(too_large(name));
    }
    if !may_end(path).unwrap_or(true) {
        let message = format!("`{name}` is a pipe or a device, not a file");
        let error = ReadError::new(&general::FILE_UNREADABLE, message);
        return Err(ReadError { help: Some("write `-` for standard input".to_owned()), ..error });
    }
    let file = fs::File::open(path).map_err(|error| read_error(name, path, &error))?;
    read_all(name, file, room)
}

fn read_all(name: &str, reader: impl Read, room: usize) -> Result<Vec<u8>, ReadError> {
    let mut bytes = Vec::with_capacity(room);
    reader
        .take(MAX_BYTES + 1)
        .read_to_end(&mut bytes)
        .map_err(|error| ReadError::new(&general::FILE_UNREADABLE, format!("cannot read `{name}`: {error}")))?;
    if bytes.len() as u64 > MAX_BYTES { Err(too_large(name)) } else { Ok(bytes) }
}

fn too_large(name: &str) -> ReadError {
    ReadError::new(&general::TOO_LARGE, format!("`{name}` is larger than {} MiB", MAX_BYTES >> 20))
}

fn read_error(name: &str, path: &Path, error: &io::Error) -> ReadError {
    if error.kind() != io::ErrorKind::NotFound {
        return ReadError::new(&general::FILE_UNREADABLE, format!("cannot read `{name}`: {error}"));
    }
    let mut not_found = ReadError::new(&general::FILE_NOT_FOUND, format!("there is no file `{name}`"));
    not_found.help = nearest_file(path).map(|nearest| format!("there is `{}`", nearest.display()));
    not_found
}

/// A file next to the missing one whose name is similar.
fn nearest_file(path: &Path) -> Option<PathBuf> {
    let folder = path.parent()?;
    let listed = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let mut names: Vec<String> = fs::read_dir(listed)
        .ok()?
        .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
        .take(10_000)
        .collect();
    names.sort();
    let wanted = path.file_name()?.to_str()?;
    glisten_front::diagnostic::did_you_mean(wanted, names.iter().map(String::as_str)).map(|name| folder.join(name))
}

/// The text of `bytes`, if they are text.
pub(crate) fn text_of(name: &str, bytes: Vec<u8>) -> Result<Arc<str>, ReadError> {
    refuse_empty(name, &bytes)?;
    refuse_binary(name, &bytes)?;
    let mut bytes = bytes;
    bytes.pop_if(|last| *last == END_OF_FILE);
    let text = match String::from_utf8(bytes) {
        Ok(text) => text,
        Err(error) => String::from_utf8_lossy(error.as_bytes()).into_owned(),
    };
    Ok(with_line_feeds(text).into())
}

/// Reports a source without any text.
pub(crate) fn refuse_empty(name: &str, bytes: &[u8]) -> Result<(), ReadError> {
    if !bytes.iter().all(u8::is_ascii_whitespace) {
        return Ok(());
    }
    let mut empty = ReadError::new(&general::EMPTY_SOURCE, format!("`{name}` is empty"));
    empty.help = Some("a shader starts with a line `#version 150`".to_owned());
    Err(empty)
}

/// Reports bytes that are no text.
pub(crate) fn refuse_binary(name: &str, bytes: &[u8]) -> Result<(), ReadError> {
    let Some(looks_like) = binary(bytes) else { return Ok(()) };
    let mut binary = ReadError::new(&general::BINARY_SOURCE, format!("`{name}` is binary, not text"));
    binary.help = looks_like.map(str::to_owned);
    Err(binary)
}

/// `None` for text; otherwise the apparent file type, if it is known.
fn binary(bytes: &[u8]) -> Option<Option<&'static str>> {
    static MAGIC: &[(&[u8], &str)] = &[
        (&[0x03, 0x02, 0x23, 0x07], "it looks like SPIR-V; glisten takes the GLSL text"),
        (&[0x07, 0x23, 0x02, 0x03], "it looks like SPIR-V; glisten takes the GLSL text"),
        (&[0x89, b'P', b'N', b'G'], "it looks like a PNG picture"),
        (&[0x7f, b'E', b'L', b'F'], "it looks like a compiled program"),
        (&[0xff, 0xfe], "it looks like text in UTF-16; save it as UTF-8"),
        (&[0xfe, 0xff], "it looks like text in UTF-16; save it as UTF-8"),
    ];
    let known = MAGIC.iter().find(|(magic, _)| bytes.starts_with(magic)).map(|(_, what)| *what);
    // Comments may hold anything but NUL (§3.1), in any encoding, so bytes above 127 say nothing. Some control bytes are
    // errors where they are, and many are no text; one at the end is the mark of old systems for the end of a file.
    let text = bytes.strip_suffix(&[END_OF_FILE]).unwrap_or(bytes);
    let controls = text.iter().filter(|byte| **byte < b' ' && !WHITE_SPACE.contains(byte)).count();
    let is_binary = text.contains(&0) || is_no_text(controls, text.len());
    (is_binary || known.is_some()).then_some(known)
}

/// The white space of GLSL (§3.1).
const WHITE_SPACE: &[u8] = b"\t\n\x0b\x0c\r";
/// The beginning of the names of temporary files. Each exists for the time of one write.
const TEMPORARY: &str = ".glisten-";
/// Control-Z.
const END_OF_FILE: u8 = 0x1a;

/// Makes sure that a file can be written, before the work that makes it.
///
/// # Errors
/// It cannot, or it is an input.
pub(crate) fn check_writable(path: &Path) -> Result<(), Failure> {
    overwrite::refuse(path)?;
    check_replaceable(path)
}

/// Makes sure that a file can be written, which may be one that was read.
///
/// # Errors
/// It cannot.
pub(crate) fn check_replaceable(path: &Path) -> Result<(), Failure> {
    match fs::metadata(path) {
        Ok(found) if found.is_file() => return open_to_write(path).map(drop),
        // The other end of a pipe would take that for all of the text.
        Ok(found) if !found.is_dir() => return Ok(()),
        _ => {}
    }
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    builder().tempfile_in(folder).map(drop).map_err(|error| unwritable(path, &error))
}

/// The failure to write a file. The name of a temporary file is nobody's business.
fn unwritable(path: &Path, error: &io::Error) -> Failure {
    let reason = error.to_string();
    let reason = reason.split(" at path ").next().unwrap_or_default();
    Failure::usage(format!("cannot write `{}`: {reason}", path.display()))
}

/// Writes a file completely like [`replace`], unless this command reads it.
///
/// # Errors
/// It cannot be written, or it is an input.
pub(crate) fn write(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    overwrite::refuse(path)?;
    replace(path, bytes)
}

/// Opens a file that is there, and changes nothing in it. A folder lets replace a file that its own mode protects: this asks the file.
fn open_to_write(path: &Path) -> Result<fs::File, Failure> {
    fs::OpenOptions::new().write(true).open(path).map_err(|error| {
        let failure = unwritable(path, &error);
        let is_protected = error.kind() == io::ErrorKind::PermissionDenied;
        if is_protected {
            failure.help("the file is protected: give yourself the permission to write it")
        } else {
            failure
        }
    })
}

/// Where the links of a path lead that is not there yet.
fn end_of_links(path: &Path) -> PathBuf {
    const MOST: usize = 40;
    let mut at = path.to_owned();
    for _ in 0..MOST {
        let Ok(next) = fs::read_link(&at) else { break };
        at = at.parent().unwrap_or(Path::new("")).join(next);
    }
    at
}

/// Writes a file completely: to a temporary name next to it, which is then renamed. Anything but a regular file (a
/// pipe, `/dev/null`) is written to directly. It may be one that was read, to change it in place. One that the user may not write
/// stays as it is.
pub(crate) fn replace(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    let failed = |error: &io::Error| unwritable(path, error);
    let target = match fs::metadata(path) {
        Ok(metadata) if metadata.is_dir() => {
            return Err(Failure::usage(format!("cannot write `{}`: it is a folder", path.display())));
        }
        Ok(metadata) if !metadata.is_file() => {
            return pipes::open(path).and_then(|mut pipe| pipe.write_all(bytes)).map_err(|error| failed(&error));
        }
        // A link is followed, so that it remains a link.
        Ok(_) => {
            open_to_write(path)?;
            fs::canonicalize(path).unwrap_or_else(|_| path.to_owned())
        }
        Err(_) => end_of_links(path),
    };
    let folder = target.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    sweep(folder);
    let mut file = unfinished::create(&builder(), folder).map_err(|error| failed(&error))?;
    file.write_all(bytes).map_err(|error| failed(&error))?;
    keep_mode(file.as_file(), &target);
    file.persist(&target).map(drop).map_err(|error| failed(&error.error))
}

/// Gives the file that takes another one's place its owner and its mode, where the system lets.
#[cfg(unix)]
fn keep_mode(file: &fs::File, replaced: &Path) {
    use std::os::unix::fs::{MetadataExt, PermissionsExt, fchown};
    let Ok(old) = fs::metadata(replaced) else { return };
    // The text is right without both. Only the administrator may give a file away.
    if file.metadata().is_ok_and(|new| (new.uid(), new.gid()) != (old.uid(), old.gid())) {
        let _ = fchown(file, Some(old.uid()), Some(old.gid()));
    }
    let _ = file.set_permissions(fs::Permissions::from_mode(old.mode() & 0o777));
}

#[cfg(not(unix))]
fn keep_mode(_: &fs::File, _: &Path) {}

/// Gives temporary files the permissions of any new file rather than restricted ones.
fn builder() -> tempfile::Builder<'static, 'static> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(TEMPORARY);
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    builder
}

/// Removes what killed commands left in a folder of outputs, once in a run.
fn sweep(folder: &Path) {
    static SWEPT: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());
    let is_new = SWEPT.lock().unwrap_or_else(PoisonError::into_inner).insert(folder.to_owned());
    if is_new {
        unfinished::sweep(folder, TEMPORARY);
    }
}

/// Creates a folder of outputs and its parents.
pub(crate) fn make_folder(path: &Path) -> Result<(), Failure> {
    if path.exists() && !path.is_dir() {
        return Err(Failure::usage(format!("`{}` is a file, not a folder", path.display())));
    }
    if path.is_dir() {
        sweep(path);
        return Ok(());
    }
    fs::create_dir_all(path)
        .map_err(|error| Failure::usage(format!("cannot make the folder `{}`: {error}", path.display())))
}

#[cfg(test)]
mod tests {
    use super::text_of;

    #[cfg(unix)]
    #[test]
    fn a_replaced_file_keeps_its_mode() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.frag");
        for mode in [0o600, 0o640, 0o755] {
            std::fs::write(&path, "old").expect("written");
            std::fs::set_permissions(&path, std::fs::Permissions::from_mode(mode)).expect("set");
            super::replace(&path, b"new").expect("replaced");
            let kept = std::fs::metadata(&path).expect("it is there").permissions().mode() & 0o777;
            assert_eq!((kept, std::fs::read(&path).expect("it is there")), (mode, b"new".to_vec()));
        }
    }

    #[test]
    fn text_and_binary_are_told_apart() {
        assert!(text_of("x", b"#version 150\n".to_vec()).is_ok());
        assert!(text_of("x", "// こんにちは\n".as_bytes().to_vec()).is_ok());
        let latin1 = text_of("x", b"// caf\xe9\nvoid main() {}\n".to_vec()).expect("one odd byte is forgiven");
        assert!(latin1.contains('\u{fffd}'));
        let shift_jis = b"// \x83e\x83N\x83X\x83`\x83\x83\x8d\xc0\x95W\n\x0bvoid main() {}\x0c".to_vec();
        assert!(text_of("x", shift_jis).is_ok());
        assert!(text_of("x", b"\x80\x81\x82\x83\x84\x85abc".to_vec()).is_ok());
        for text in ["void \x01 main", "void \x1b[31m main", "// \x07\nvoid main() {}"] {
            assert!(text_of("x", text.into()).is_ok_and(|read| *read == *text), "{text:?}");
        }
        assert!(text_of("x", b"void main() {}\n\x1a".to_vec()).is_ok_and(|text| text.ends_with("}\n")));
        for (bytes, code) in [
            (&b""[..], "E0013"),
            (b" \n\t", "E0013"),
            (b"void\0main", "E0014"),
            (b"\x03\x02\x23\x07abc", "E0014"),
            (b"\xff\xfe#\0v\0", "E0014"),
            (b"\x01\x02\x03\x04\x05\x06 a few control bytes are errors, and many are no text", "E0014"),
        ] {
            assert_eq!(text_of("x", bytes.to_vec()).expect_err("not text").code.id, code, "{bytes:?}");
        }
    }
}
