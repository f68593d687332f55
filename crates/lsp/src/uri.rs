//! Names of documents: URIs of the protocol, and paths.
//!
//! *Holds:* a document that is no file keeps its URI as its path, so that its name still tells its stage.

use lsp_types::Uri;
use percent_encoding::{AsciiSet, CONTROLS, percent_decode_str, utf8_percent_encode};
use std::path::{Component, Path, PathBuf};
use std::str::FromStr;

/// The characters that a path of a URI writes with a percent sign (RFC 3986 §3.3).
const ENCODED: &AsciiSet = &CONTROLS
    .add(b' ')
    .add(b'"')
    .add(b'#')
    .add(b'%')
    .add(b'<')
    .add(b'>')
    .add(b'?')
    .add(b'[')
    .add(b'\\')
    .add(b']')
    .add(b'^')
    .add(b'`')
    .add(b'{')
    .add(b'|')
    .add(b'}');

/// The path of a document.
pub(crate) fn path(uri: &Uri) -> PathBuf {
    let text = uri.as_str();
    let Some(rest) = text.strip_prefix("file://") else { return PathBuf::from(text) };
    // Another machine's name is no part of the path.
    let encoded = rest.find('/').and_then(|start| rest.get(start..)).unwrap_or(rest);
    let decoded = percent_decode_str(encoded).decode_utf8_lossy().into_owned();
    let without_slash = decoded.strip_prefix('/').filter(|rest| rest.as_bytes().get(1) == Some(&b':'));
    plain(Path::new(without_slash.unwrap_or(&decoded)))
}

/// The path without `.` and without `x/..`.
fn plain(path: &Path) -> PathBuf {
    let mut plain = PathBuf::new();
    for component in path.components() {
        match component {
            Component::CurDir => {}
            Component::ParentDir => {
                plain.pop();
            }
            _ => plain.push(component),
        }
    }
    plain
}

/// The URI of a path.
pub(crate) fn of(path: &Path) -> Option<Uri> {
    let text = path.to_string_lossy().replace('\\', "/");
    if !path.is_absolute() {
        return Uri::from_str(&text).ok().filter(|uri| uri.scheme().is_some());
    }
    let slash = if text.starts_with('/') { "" } else { "/" };
    Uri::from_str(&format!("file://{slash}{}", utf8_percent_encode(&text, ENCODED))).ok()
}

#[cfg(test)]
mod tests {
    use super::{of, path};
    use lsp_types::Uri;
    use std::path::{Path, PathBuf};
    use std::str::FromStr;

    #[test]
    fn paths_survive() {
        for name in ["/a/b.frag", "/with space/é#1%.vert", "/a[0]/{x}.glsl"] {
            let uri = of(Path::new(name)).expect("a URI");
            assert_eq!(path(&uri), PathBuf::from(name), "{}", uri.as_str());
        }
        let untitled = Uri::from_str("untitled:Untitled-1").expect("a URI");
        assert_eq!(of(&path(&untitled)), Some(untitled));
        let local = Uri::from_str("file://localhost/a/./b/../c.vert").expect("a URI");
        assert_eq!(path(&local), PathBuf::from("/a/c.vert"));
    }
}
