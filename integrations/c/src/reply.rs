//! [`Reply`]: the answer of a host's function that is asked for a file.

use crate::pointers::{exclusive, optional_text, slice, text};
use crate::status::{Status, call};
use glisten_binding::Error;
use std::ffi::{c_char, c_void};

/// The answer to a question for a file. It lives while the function runs that is asked. A function that answers nothing passes:
/// then an include is looked for in the folders and in the library, and a file of a scene is missing.
pub struct Reply {
    pub(crate) answer: Option<Result<Found, String>>,
}

/// A file of the host.
pub(crate) struct Found {
    pub(crate) name: Option<String>,
    pub(crate) bytes: Vec<u8>,
}

/// Answers with the bytes of the file, which are copied. `name` is for diagnostics and for the includes of that file; NULL stands
/// for the path that was asked for.
///
/// # Safety
/// `reply` is that of the question; `bytes` are `size` bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn glisten_reply_found(
    reply: *mut Reply,
    name: *const c_char,
    bytes: *const c_char,
    size: usize,
) -> Status {
    call(|| {
        // SAFETY: the host's.
        let (reply, name, bytes) = unsafe {
            let bytes = slice(bytes.cast::<u8>(), size, "text of the file")?;
            (exclusive(reply, "reply")?, optional_text(name, "name of the file")?, bytes)
        };
        reply.answer = Some(Ok(Found { name: name.map(str::to_owned), bytes: bytes.to_vec() }));
        Ok(Status::Ok)
    })
}

/// Answers that there is no such file, for a reason: a sentence without a full stop.
///
/// # Safety
/// `reply` is that of the question.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn glisten_reply_missing(reply: *mut Reply, reason: *const c_char) -> Status {
    call(|| {
        // SAFETY: the host's.
        let (reply, reason) = unsafe { (exclusive(reply, "reply")?, text(reason, "reason")?) };
        reply.answer = Some(Err(reason.to_owned()));
        Ok(Status::Ok)
    })
}

/// A pointer of the host that is handed back to its function.
#[derive(Clone, Copy)]
pub(crate) struct User(pub(crate) *mut c_void);

// SAFETY: glisten only hands the pointer back. The header asks for functions that may be called from any thread that uses the
// compiler or loads the scene.
unsafe impl Send for User {}
// SAFETY: as above.
unsafe impl Sync for User {}

impl User {
    /// The pointer. A method, so that closures take the whole value rather than its field.
    pub(crate) fn pointer(self) -> *mut c_void {
        self.0
    }
}

/// The bytes as a text.
pub(crate) fn text_of(bytes: Vec<u8>) -> Result<String, Error> {
    String::from_utf8(bytes).map_err(|_| Error::argument("the text of the file is not UTF-8"))
}
