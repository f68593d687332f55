//! [`Reply`]: a JSON object, and the bytes that it refers to by offset and length.

use glisten_binding::{Error, Kind};
use serde_json::{Map, Value, json};

/// What the host gets.
#[derive(Default)]
pub(crate) struct Reply {
    object: Map<String, Value>,
    blob: Vec<u8>,
}

impl Reply {
    /// The reply to a request that has no result.
    pub(crate) fn of_error(error: &Error) -> Self {
        let kind = match error.kind {
            Kind::Argument => "argument",
            Kind::Content => "content",
            Kind::File => "file",
            Kind::Internal => "internal",
        };
        let mut reply = Self::default();
        reply.set("error", json!({ "kind": kind, "message": error.message, "diagnostics": error.diagnostics }));
        reply
    }

    /// Sets a key.
    pub(crate) fn set(&mut self, key: &str, value: impl Into<Value>) {
        self.object.insert(key.to_owned(), value.into());
    }

    /// Adds bytes; returns what refers to them.
    pub(crate) fn bytes(&mut self, bytes: &[u8]) -> Value {
        // Numbers of eight bytes are read in place.
        self.blob.resize(self.blob.len().next_multiple_of(8), 0);
        let offset = self.blob.len();
        self.blob.extend_from_slice(bytes);
        json!([offset, bytes.len()])
    }

    /// The reply as bytes.
    pub(crate) fn into_bytes(self) -> Vec<u8> {
        let text = Value::Object(self.object).to_string();
        let length = u32::try_from(text.len()).unwrap_or(u32::MAX);
        [length.to_le_bytes().as_slice(), text.as_bytes(), &self.blob].concat()
    }
}
