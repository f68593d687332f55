//! [`Status`]: how a call ended, and the message of the last failure of a thread.

use crate::pointers::c_text;
use glisten_binding::{Error, Kind, guarded};
use std::cell::RefCell;
use std::ffi::{CString, c_char};
use std::ptr;

/// How a call ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub enum Status {
    /// It has done what it was asked for.
    Ok = 0,
    /// A shader or a scene has errors: see its diagnostics, or `glisten_last_error` where there are none.
    Content = 1,
    /// An argument is wrong: NULL, a text that is not UTF-8, an unknown name or number.
    Argument = 2,
    /// A file cannot be read.
    File = 3,
    /// A fault of glisten.
    Internal = 4,
}

thread_local! {
    static LAST: RefCell<Option<CString>> = const { RefCell::new(None) };
}

/// Runs the body of a function: errors and panics become a status and the message of this thread.
pub(crate) fn call(body: impl FnOnce() -> Result<Status, Error>) -> Status {
    guarded(body).unwrap_or_else(|error| {
        let status = match error.kind {
            Kind::Content => Status::Content,
            Kind::Argument => Status::Argument,
            Kind::File => Status::File,
            Kind::Internal => Status::Internal,
        };
        // A thread that is ending has no message any more.
        let _ = LAST.try_with(|last| *last.borrow_mut() = Some(c_text(&error.message)));
        status
    })
}

/// Why the last call of this thread that failed did so, as a sentence; NULL if none failed. It lives until the next call of
/// this thread that fails.
#[unsafe(no_mangle)]
pub extern "C" fn glisten_last_error() -> *const c_char {
    LAST.try_with(|last| last.borrow().as_ref().map_or(ptr::null(), |text| text.as_ptr())).unwrap_or(ptr::null())
}

/// The version of glisten, such as "0.1.0". It lives forever.
#[unsafe(no_mangle)]
pub extern "C" fn glisten_version() -> *const c_char {
    concat!(env!("CARGO_PKG_VERSION"), "\0").as_ptr().cast()
}

/// The version of this interface. It changes when a program that was built with an older header has to be built again.
pub const GLISTEN_ABI_VERSION: u32 = 1;

/// The `GLISTEN_ABI_VERSION` of the library, to compare with that of the header.
#[unsafe(no_mangle)]
pub extern "C" fn glisten_abi_version() -> u32 {
    GLISTEN_ABI_VERSION
}
