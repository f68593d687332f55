//! [`Blob`]: bytes that the host owns: code, a reflection, diagnostics.

use crate::pointers::take_back;
use std::ffi::c_char;
use std::ptr;

/// Bytes. After the last one there is a NUL, so that those of a text are a C string.
pub struct Blob {
    bytes: Vec<u8>,
}

impl Blob {
    pub(crate) fn new(mut bytes: Vec<u8>) -> Self {
        bytes.push(0);
        Self { bytes }
    }
}

/// The bytes; NULL for NULL.
///
/// # Safety
/// `blob` is NULL or alive.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn glisten_blob_data(blob: *const Blob) -> *const c_char {
    // SAFETY: the host's.
    unsafe { blob.as_ref() }.map_or(ptr::null(), |blob| blob.bytes.as_ptr().cast())
}

/// How many bytes there are, without the NUL after them; 0 for NULL.
///
/// # Safety
/// `blob` is NULL or alive.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn glisten_blob_size(blob: *const Blob) -> usize {
    // SAFETY: the host's.
    unsafe { blob.as_ref() }.map_or(0, |blob| blob.bytes.len().saturating_sub(1))
}

/// Frees the bytes.
///
/// # Safety
/// `blob` is NULL, or alive and not used any more.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn glisten_blob_free(blob: *mut Blob) {
    // SAFETY: the host's.
    unsafe { take_back(blob) };
}
