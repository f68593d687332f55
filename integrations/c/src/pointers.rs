//! Pointers of a host: to references and texts, and back.

use glisten_binding::Error;
use std::ffi::{CStr, CString, c_char};
use std::ptr;

/// The value behind a pointer.
///
/// # Safety
/// A pointer that is not null is that of a living `T` which nobody changes meanwhile.
pub(crate) unsafe fn reference<'a, T>(pointer: *const T, what: &str) -> Result<&'a T, Error> {
    // SAFETY: the caller's.
    unsafe { pointer.as_ref() }.ok_or_else(|| Error::argument(format!("the {what} is NULL")))
}

/// The value behind a pointer, to change it.
///
/// # Safety
/// A pointer that is not null is that of a living `T` which nobody else uses meanwhile.
pub(crate) unsafe fn exclusive<'a, T>(pointer: *mut T, what: &str) -> Result<&'a mut T, Error> {
    // SAFETY: the caller's.
    unsafe { pointer.as_mut() }.ok_or_else(|| Error::argument(format!("the {what} is NULL")))
}

/// A text that ends with NUL.
///
/// # Safety
/// A pointer that is not null is that of such a text, which nobody changes meanwhile.
pub(crate) unsafe fn text<'a>(pointer: *const c_char, what: &str) -> Result<&'a str, Error> {
    if pointer.is_null() {
        return Err(Error::argument(format!("the {what} is NULL")));
    }
    // SAFETY: the caller's.
    let text = unsafe { CStr::from_ptr(pointer) };
    text.to_str().map_err(|_| Error::argument(format!("the {what} is not UTF-8")))
}

/// A text that may be missing.
///
/// # Safety
/// As for [`text`].
pub(crate) unsafe fn optional_text<'a>(pointer: *const c_char, what: &str) -> Result<Option<&'a str>, Error> {
    // SAFETY: the caller's.
    if pointer.is_null() { Ok(None) } else { unsafe { text(pointer, what) }.map(Some) }
}

/// Numbers in memory of the host.
///
/// # Safety
/// A pointer that is not null is that of `count` values which nobody changes meanwhile.
pub(crate) unsafe fn slice<'a, T>(pointer: *const T, count: usize, what: &str) -> Result<&'a [T], Error> {
    if count == 0 {
        return Ok(&[]);
    }
    if count > isize::MAX as usize / size_of::<T>().max(1) {
        return Err(Error::argument(format!("the {what} cannot be that large")));
    }
    // SAFETY: the caller's; the size fits into the address space.
    unsafe { reference(pointer, what).map(|first| std::slice::from_raw_parts(ptr::from_ref(first), count)) }
}

/// Gives a handle to the host. The place is set to null first, so that a failure leaves null.
///
/// # Safety
/// A pointer that is not null is that of a place that can be written to.
pub(crate) unsafe fn give<T>(place: *mut *mut T, make: impl FnOnce() -> Result<T, Error>) -> Result<*mut T, Error> {
    if place.is_null() {
        return Err(Error::argument("the place for the result is NULL"));
    }
    // SAFETY: the caller's.
    unsafe { place.write(ptr::null_mut()) };
    let handle = Box::into_raw(Box::new(make()?));
    // SAFETY: the caller's.
    unsafe { place.write(handle) };
    Ok(handle)
}

/// Takes a handle back and drops it.
///
/// # Safety
/// A pointer that is not null came from [`give`] or from `Box`, and was not taken back before.
pub(crate) unsafe fn take_back<T>(handle: *mut T) {
    if !handle.is_null() {
        // SAFETY: the caller's.
        let owned = unsafe { Box::from_raw(handle) };
        crate::status::call(|| {
            drop(owned);
            Ok(crate::status::Status::Ok)
        });
    }
}

/// A text for the host. A NUL within it would end it early, so it is replaced.
pub(crate) fn c_text(text: &str) -> CString {
    CString::new(text.replace('\0', "\u{fffd}")).unwrap_or_default()
}
