//! [`Digest`]: the SHA-256 of bytes, which names what a cache holds; [`Content`]: bytes that have one.
//!
//! *In:* bytes. *Out:* 32 bytes, or 64 hexadecimal digits. *Holds:* a content's digest is computed when somebody asks for it, once.
//! [`Hasher`] puts the length before each part, so two lists of
//! parts have the same digest only if they are equal.

use serde::{Deserialize, Serialize};
use sha2::{Digest as _, Sha256};
use std::fmt;
use std::hash::Hash;
use std::ops::Deref;
use std::sync::{Arc, OnceLock};

/// The SHA-256 of bytes.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(into = "String", try_from = "String")]
pub(crate) struct Digest([u8; 32]);

impl Digest {
    /// The digest of bytes.
    pub(crate) fn of(bytes: &[u8]) -> Self {
        Self(Sha256::digest(bytes).into())
    }

    /// The digest that 64 hexadecimal digits name.
    pub(crate) fn from_hex(text: &str) -> Option<Self> {
        let digits = text.as_bytes();
        let mut bytes = [0; 32];
        if digits.len() != 64 || !digits.iter().all(|digit| matches!(digit, b'0'..=b'9' | b'a'..=b'f')) {
            return None;
        }
        for (byte, pair) in bytes.iter_mut().zip(digits.chunks(2)) {
            *byte = u8::from_str_radix(std::str::from_utf8(pair).ok()?, 16).ok()?;
        }
        Some(Self(bytes))
    }
}

impl fmt::Display for Digest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        const DIGITS: &[u8; 16] = b"0123456789abcdef";
        let digits: [u8; 64] = std::array::from_fn(|at| {
            let byte = self.0[at / 2];
            DIGITS[usize::from(if at % 2 == 0 { byte >> 4 } else { byte & 15 })]
        });
        f.write_str(str::from_utf8(&digits).unwrap_or_default())
    }
}

impl fmt::Debug for Digest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl From<Digest> for String {
    fn from(digest: Digest) -> Self {
        digest.to_string()
    }
}

impl TryFrom<String> for Digest {
    type Error = &'static str;

    fn try_from(text: String) -> Result<Self, Self::Error> {
        Self::from_hex(&text).ok_or("not a SHA-256")
    }
}

/// Bytes with their digest, which is computed on demand: a compilation without a cache asks for none.
#[derive(Clone, Debug)]
pub(crate) struct Content(Arc<(Box<[u8]>, OnceLock<Digest>)>);

impl Content {
    /// Bytes whose digest is known.
    pub(crate) fn known(digest: Digest, bytes: Vec<u8>) -> Self {
        Self(Arc::new((bytes.into(), digest.into())))
    }

    /// The digest of the bytes.
    pub(crate) fn digest(&self) -> Digest {
        *self.0.1.get_or_init(|| Digest::of(&self.0.0))
    }
}

impl From<Vec<u8>> for Content {
    fn from(bytes: Vec<u8>) -> Self {
        Self(Arc::new((bytes.into(), OnceLock::new())))
    }
}

impl Deref for Content {
    type Target = [u8];

    fn deref(&self) -> &[u8] {
        &self.0.0
    }
}

/// The digest of what a value tells a hasher: equal digests mean that the values are alike.
pub(crate) fn of_structure(value: &impl Hash) -> Digest {
    let mut structure = Structure(Vec::with_capacity(1 << 14));
    value.hash(&mut structure);
    Digest::of(&structure.0)
}

/// The hasher of [`of_structure`]: the bytes so far. One digest of all is faster than many of a few bytes.
struct Structure(Vec<u8>);

impl std::hash::Hasher for Structure {
    fn write(&mut self, bytes: &[u8]) {
        self.0.extend_from_slice(bytes);
    }

    /// A number for tables, which nobody asks for here.
    fn finish(&self) -> u64 {
        Digest::of(&self.0).0.iter().take(8).fold(0, |all, byte| (all << 8) | u64::from(*byte))
    }
}

/// The digest of a list of parts.
pub(crate) struct Hasher(Sha256);

impl Hasher {
    /// An empty list. Lists of different `kind` never have the same digest.
    pub(crate) fn new(kind: &str) -> Self {
        Self(Sha256::new()).with(kind.as_bytes())
    }

    /// Adds a part.
    #[must_use]
    pub(crate) fn with(mut self, part: &[u8]) -> Self {
        self.0.update((part.len() as u64).to_le_bytes());
        self.0.update(part);
        self
    }

    /// The digest.
    pub(crate) fn finish(self) -> Digest {
        Digest(self.0.finalize().into())
    }
}

#[cfg(test)]
mod tests {
    use super::{Content, Digest, Hasher, of_structure};

    #[test]
    fn digests_are_those_of_the_standard() {
        let empty = "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855";
        assert_eq!(Digest::of(b"").to_string(), empty);
        assert_eq!(Digest::from_hex(empty), Some(Digest::of(b"")));
        assert_eq!(Digest::from_hex(&empty.to_uppercase()), None);
        assert_eq!(Digest::from_hex("e3"), None);
        let two = |a: &str, b: &str| Hasher::new("test").with(a.as_bytes()).with(b.as_bytes()).finish();
        assert_ne!(two("ab", "c"), two("a", "bc"));
        assert_eq!(of_structure(&("ab", Some(1))), of_structure(&("ab", Some(1))));
        assert_ne!(of_structure(&("ab", "c")), of_structure(&("a", "bc")));
        assert_eq!(Content::from(vec![1, 2]).digest(), Digest::of(&[1, 2]));
    }
}
