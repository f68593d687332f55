//! The bytes of a glTF file's buffers.
//!
//! *In:* the chunk of a binary file, data URIs, names of files. *Out:* slices. *Holds:* a buffer is read once, when it is asked for.

use crate::files::{FileSource, relative_to};
use base64::Engine;
use base64::alphabet::STANDARD;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};
use gltf::json::buffer::View;
use gltf::json::{Index, Root};
use percent_encoding::percent_decode_str;

/// Padding may be left out: exporters do.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &STANDARD,
    GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent),
);

/// The buffers of a file.
pub(super) struct Buffers<'a> {
    path: &'a str,
    root: &'a Root,
    files: &'a dyn FileSource,
    blob: Option<Vec<u8>>,
    read: Vec<Option<Vec<u8>>>,
}

impl<'a> Buffers<'a> {
    pub(super) fn new(path: &'a str, root: &'a Root, blob: Option<Vec<u8>>, files: &'a dyn FileSource) -> Self {
        Self { path, root, files, blob, read: vec![None; root.buffers.len()] }
    }

    /// The bytes of a view.
    pub(super) fn view(&mut self, view: Index<View>) -> Result<&[u8], String> {
        let number = view.value();
        let root = self.root;
        let view = root.get(view).ok_or_else(|| format!("there is no buffer view {number}"))?;
        let (offset, len) = (view.byte_offset.map_or(0, |offset| offset.0), view.byte_length.0);
        let bytes = self.buffer(view.buffer.value())?;
        let end = offset.checked_add(len).and_then(|end| usize::try_from(end).ok());
        let range = usize::try_from(offset).ok().zip(end);
        range.and_then(|(start, end)| bytes.get(start..end)).ok_or_else(|| {
            format!(
                "buffer view {number} has bytes {offset} to {}, and its buffer has {}",
                offset.saturating_add(len),
                bytes.len()
            )
        })
    }

    fn buffer(&mut self, number: usize) -> Result<&[u8], String> {
        if self.read.get(number).is_some_and(Option::is_none) {
            let uri = self.root.buffers.get(number).and_then(|buffer| buffer.uri.clone());
            let bytes = match uri {
                Some(uri) => self.uri(&uri).map_err(|error| format!("buffer {number}: {error}"))?,
                None => self.blob.take().ok_or_else(|| format!("buffer {number} has no data"))?,
            };
            if let Some(slot) = self.read.get_mut(number) {
                *slot = Some(bytes);
            }
        }
        let bytes = self.read.get(number).and_then(Option::as_deref);
        bytes.ok_or_else(|| format!("there is no buffer {number}"))
    }

    /// The bytes of a data URI or of a file next to this one.
    pub(super) fn uri(&self, uri: &str) -> Result<Vec<u8>, String> {
        if let Some(data) = uri.strip_prefix("data:") {
            let (kind, text) = data.split_once(',').ok_or("a data URI without a comma")?;
            if !kind.ends_with(";base64") {
                return Ok(percent_decode_str(text).collect());
            }
            return BASE64.decode(text).map_err(|error| format!("its base64 is malformed: {error}"));
        }
        if uri.contains("://") {
            return Err(format!("`{uri}` is not a file, and nothing is downloaded"));
        }
        let name = percent_decode_str(uri).decode_utf8_lossy();
        let path = relative_to(self.path, &name);
        self.files.read(&path).map_err(|error| format!("cannot read `{path}`: {error}"))
    }
}
