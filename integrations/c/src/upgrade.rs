//! [`Upgrade`]: sources of older versions, rewritten.

use crate::compiler::Compiler;
use crate::pointers::{c_text, give, reference, take_back, text};
use crate::program::{Source, sources_of};
use crate::status::{Status, call};
use glisten_binding::{Error, Format, upgrade};
use std::ffi::{CString, c_char};
use std::ptr;

/// The sources of a program in another version. It never changes.
pub struct Upgrade {
    texts: Vec<CString>,
    notes: Vec<CString>,
}

/// Rewrites the sources of a program, as `glisten upgrade` does, for the version `150`, `330`, `450`, `460`, `300es` or `vulkan`. Files that they include
/// stay as they are. With errors in the sources, which `glisten_last_error` shows, the status is `GLISTEN_STATUS_CONTENT`; so it is
/// if a source is newer than the version, or has a name that the version has no counterpart for.
///
/// # Safety
/// `compiler` is NULL or alive; `sources` are `count` sources with their texts; `version` ends with NUL; `upgraded` is NULL or can be
/// written to.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn glisten_upgrade_sources(
    compiler: *const Compiler,
    sources: *const Source,
    count: usize,
    version: *const c_char,
    upgraded: *mut *mut Upgrade,
) -> Status {
    call(|| {
        let made = || {
            // SAFETY: the host's.
            let (compiler, sources) = unsafe { (reference(compiler, "compiler")?, sources_of(sources, count)?) };
            // SAFETY: the host's.
            let done = upgrade(&compiler.settings, &sources, unsafe { text(version, "version")? })?;
            if !done.is_sound() {
                return Err(Error::content(done.diagnostics(Format::Human).trim_end().to_owned()));
            }
            let list = |texts: &[String]| texts.iter().map(|text| c_text(text)).collect();
            Ok(Upgrade { texts: list(done.texts()), notes: list(done.notes()) })
        };
        // SAFETY: the host's.
        unsafe { give(upgraded, made)? };
        Ok(Status::Ok)
    })
}

/// Frees an upgrade.
///
/// # Safety
/// `upgrade` is NULL, or alive and not used any more.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn glisten_upgrade_free(upgrade: *mut Upgrade) {
    // SAFETY: the host's.
    unsafe { take_back(upgrade) };
}

/// The new text of the source with this number, from 0; NULL if there is none.
///
/// # Safety
/// `upgrade` is NULL or alive.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn glisten_upgrade_text(upgrade: *const Upgrade, index: usize) -> *const c_char {
    // SAFETY: the host's.
    let upgrade = unsafe { upgrade.as_ref() };
    upgrade.and_then(|upgrade| upgrade.texts.get(index)).map_or(ptr::null(), |text| text.as_ptr())
}

/// A sentence for the author of the host, from 0; NULL if there is none with this number.
///
/// # Safety
/// `upgrade` is NULL or alive.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn glisten_upgrade_note(upgrade: *const Upgrade, index: usize) -> *const c_char {
    // SAFETY: the host's.
    let upgrade = unsafe { upgrade.as_ref() };
    upgrade.and_then(|upgrade| upgrade.notes.get(index)).map_or(ptr::null(), |note| note.as_ptr())
}
