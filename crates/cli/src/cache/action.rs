//! [`ActionResult`]: a result as Bazel's remote execution protocol writes it.
//!
//! *In:* the outputs of a program by their digests, and a text. *Out:* bytes of protobuf. *Holds:* a server that checks results,
//! as bazel-remote does, accepts it: <https://github.com/bazelbuild/remote-apis>, `build.bazel.remote.execution.v2`. The text
//! takes the place of a command's standard output.

use crate::digest::{Content, Digest};
use prost::Message;

/// The result of an action, as far as it is used here.
#[derive(Clone, PartialEq, Message)]
pub(super) struct ActionResult {
    /// The outputs.
    #[prost(message, repeated, tag = "2")]
    pub(super) output_files: Vec<OutputFile>,
    /// The text.
    #[prost(bytes = "vec", tag = "5")]
    pub(super) stdout_raw: Vec<u8>,
}

/// An output.
#[derive(Clone, PartialEq, Message)]
pub(super) struct OutputFile {
    /// The name.
    #[prost(string, tag = "1")]
    pub(super) path: String,
    /// The digest of the bytes.
    #[prost(message, optional, tag = "2")]
    pub(super) digest: Option<SizedDigest>,
}

/// A digest with a size.
#[derive(Clone, PartialEq, Message)]
pub(super) struct SizedDigest {
    /// 64 hexadecimal digits.
    #[prost(string, tag = "1")]
    pub(super) hash: String,
    /// The number of bytes.
    #[prost(int64, tag = "2")]
    pub(super) size_bytes: i64,
}

impl OutputFile {
    /// An output.
    pub(super) fn new(path: &str, content: &Content) -> Self {
        let digest = SizedDigest { hash: content.digest().to_string(), size_bytes: content.len() as i64 };
        Self { path: path.to_owned(), digest: Some(digest) }
    }

    /// The digest and the number of bytes, if they are such.
    pub(super) fn digest(&self) -> Option<(Digest, usize)> {
        let digest = self.digest.as_ref()?;
        Some((Digest::from_hex(&digest.hash)?, usize::try_from(digest.size_bytes).ok()?))
    }
}

#[cfg(test)]
mod tests {
    use super::{ActionResult, OutputFile};
    use crate::digest::Content;
    use prost::Message;

    #[test]
    fn the_bytes_are_those_of_the_protocol() {
        let file = OutputFile::new("a", &Content::from(Vec::new()));
        let result = ActionResult { output_files: vec![file], stdout_raw: b"t".to_vec() };
        let bytes = result.encode_to_vec();
        // Field 2, 71 bytes: field 1 "a"; field 2, 66 bytes: field 1, 64 digits. The size 0 is left out. Field 5 "t".
        assert_eq!(bytes[..9], [0x12, 71, 0x0a, 1, b'a', 0x12, 66, 0x0a, 64]);
        assert_eq!(bytes[bytes.len() - 3..], [0x2a, 1, b't']);
        assert_eq!(ActionResult::decode(&*bytes).expect("read"), result);
    }
}
