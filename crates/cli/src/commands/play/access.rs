//! Who may ask the server, and for which files.
//!
//! *In:* the headers of a request, the names of files. *Out:* whether it is allowed. *Holds:* a request needs the token, which
//! the page's address has and no other page knows; the host and the origin must be this server's, so that a name that is made
//! to point to this machine (DNS rebinding) opens nothing; a file must lie in one of the folders after all links are followed.

use std::collections::BTreeSet;
use std::hash::{BuildHasher, Hasher, RandomState};
use std::path::{Path, PathBuf};

/// The most bytes of the name of a file.
const MAX_NAME: usize = 4096;

/// The secret of a server.
#[derive(Clone, Debug)]
pub(super) struct Token(String);

impl Token {
    /// A new secret. The keys of [`RandomState`] are the system's random bits, and a keyed hash tells nothing of its key.
    pub(super) fn new() -> Self {
        let keys = RandomState::new();
        let part = |number: u64| {
            let mut hasher = keys.build_hasher();
            hasher.write_u64(number);
            format!("{:016x}", hasher.finish())
        };
        Self(part(0) + &part(1))
    }

    /// The text of the secret.
    pub(super) fn text(&self) -> &str {
        &self.0
    }

    /// Whether a text is the secret. The time that it takes does not depend on where they differ.
    fn is(&self, text: &str) -> bool {
        let differ = self.0.bytes().zip(text.bytes()).fold(0, |all, (a, b)| all | (a ^ b));
        text.len() == self.0.len() && differ == 0
    }
}

/// The facts of a request that decide whether it is answered.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Asking<'a> {
    /// The header `Host`.
    pub(super) host: Option<&'a str>,
    /// The header `Origin`.
    pub(super) origin: Option<&'a str>,
    /// The token, from the address or a header.
    pub(super) token: Option<&'a str>,
}

/// Whether a request is of this server's own page; otherwise the reason.
pub(super) fn check(asking: Asking<'_>, token: &Token, port: u16) -> Result<(), &'static str> {
    let own = [format!("127.0.0.1:{port}"), format!("localhost:{port}")];
    if !asking.host.is_some_and(|host| own.iter().any(|own| own == host)) {
        return Err("the host is another one");
    }
    let is_own = |origin: &str| origin.strip_prefix("http://").is_some_and(|host| own.iter().any(|own| own == host));
    if asking.origin.is_some_and(|origin| !is_own(origin)) {
        return Err("the request is from another origin");
    }
    match asking.token {
        Some(text) if token.is(text) => Ok(()),
        _ => Err("the token is missing or wrong: open the address that `glisten play` printed"),
    }
}

/// The folders whose files the page may read and write.
#[derive(Clone, Debug, Default)]
pub(super) struct Folders(BTreeSet<PathBuf>);

impl Folders {
    /// Adds a folder, if it exists. The folder, if it is new.
    pub(super) fn add(&mut self, folder: &Path) -> Option<PathBuf> {
        let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
        let own = std::fs::canonicalize(folder).ok()?;
        self.0.insert(own.clone()).then_some(own)
    }

    /// The folders.
    pub(super) fn iter(&self) -> impl Iterator<Item = &Path> {
        self.0.iter().map(PathBuf::as_path)
    }

    /// Where a name leads, if that is in a folder. The file and its folder need not exist.
    pub(super) fn path(&self, name: &str) -> Option<PathBuf> {
        if name.is_empty() || name.len() > MAX_NAME || name.contains('\0') {
            return None;
        }
        let whole = resolved(Path::new(name))?;
        self.0.iter().any(|folder| whole.starts_with(folder)).then_some(whole)
    }
}

/// Where a path leads, after all links. What is not there has none. A link to what is not there would be followed when it is written.
fn resolved(path: &Path) -> Option<PathBuf> {
    let path = if path.as_os_str().is_empty() { Path::new(".") } else { path };
    if let Ok(whole) = std::fs::canonicalize(path) {
        return Some(whole);
    }
    if std::fs::symlink_metadata(path).is_ok() {
        return None;
    }
    Some(resolved(path.parent()?)?.join(path.file_name()?))
}

#[cfg(test)]
mod tests {
    use super::{Asking, Folders, Token, check};

    #[test]
    fn strangers_are_refused() {
        let token = Token::new();
        assert_eq!(token.text().len(), 32);
        assert_ne!(token.text(), Token::new().text());
        let own = Asking { host: Some("127.0.0.1:80"), origin: None, token: Some(token.text()) };
        assert_eq!(check(own, &token, 80), Ok(()));
        assert_eq!(check(Asking { host: Some("localhost:80"), ..own }, &token, 80), Ok(()));
        assert_eq!(check(Asking { origin: Some("http://127.0.0.1:80"), ..own }, &token, 80), Ok(()));
        let changed = token.text().replace(&token.text()[..1], "x");
        for bad in [
            Asking { token: None, ..own },
            Asking { token: Some(""), ..own },
            Asking { token: Some(&token.text()[1..]), ..own },
            Asking { token: Some(&changed), ..own },
            Asking { host: None, ..own },
            Asking { host: Some("example.org"), ..own },
            Asking { host: Some("example.org:80"), ..own },
            Asking { host: Some("127.0.0.1:81"), ..own },
            Asking { origin: Some("http://example.org"), ..own },
            Asking { origin: Some("https://127.0.0.1:80"), ..own },
            Asking { origin: Some("null"), ..own },
        ] {
            assert!(check(bad, &token, 80).is_err(), "{bad:?}");
        }
    }

    #[test]
    fn files_lie_in_the_folders() {
        let outside = tempfile::tempdir().expect("a folder");
        let inside = outside.path().canonicalize().expect("it is there").join("inside");
        std::fs::create_dir(&inside).expect("it can be made");
        std::fs::write(outside.path().join("secret"), "").expect("it can be written");
        std::fs::write(inside.join("a.frag"), "").expect("it can be written");
        let mut folders = Folders::default();
        assert!(folders.add(&inside).is_some() && folders.add(&inside).is_none());
        let path = |name: &str| folders.path(&inside.join(name).to_string_lossy());
        for name in ["a.frag", "new.frag", "none/new.frag", "none/none/new.frag"] {
            assert!(path(name).is_some_and(|path| path.starts_with(&inside)), "{name}");
        }
        let long = "a/".repeat(100_000);
        for name in ["../secret", "../new", "../none/new", "..", "no/../../secret", "no/..", "/etc/passwd", &long] {
            assert_eq!(path(name), None, "{name}");
        }
        assert_eq!(folders.path(""), None);
        #[cfg(unix)]
        for (link, to) in [("link", "../secret"), ("dangling", "../none")] {
            std::os::unix::fs::symlink(to, inside.join(link)).expect("it can be made");
            assert_eq!((path(link), path(&format!("{link}/new"))), (None, None), "{link}");
        }
    }
}
