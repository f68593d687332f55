//! [`Compiler`]: the options of compilations, and the host's function for includes.

use crate::pointers::{c_text, exclusive, optional_text, take_back, text};
use crate::reply::{Reply, User, text_of};
use crate::status::{Status, call};
use glisten_binding::{Answer, Error, Settings};
use std::ffi::{c_char, c_void};
use std::ptr;
use std::sync::Arc;

/// The options of compilations. One compiler serves any number of them.
#[derive(Default)]
pub struct Compiler {
    pub(crate) settings: Settings,
}

/// A host's function for included files. `path` is that of the `#include`, `angled` whether it is in angle brackets, `from` the
/// name of the file with the `#include`. It answers by `glisten_reply_found` or `glisten_reply_missing`, or not at all. It must not
/// throw, nor jump out. It is called from each thread that compiles.
pub type IncludeFunction = Option<
    unsafe extern "C" fn(user: *mut c_void, path: *const c_char, angled: bool, from: *const c_char, reply: *mut Reply),
>;

/// A compiler without options. Never NULL.
#[unsafe(no_mangle)]
pub extern "C" fn glisten_compiler_new() -> *mut Compiler {
    Box::into_raw(Box::default())
}

/// Frees a compiler. Programs and scenes made with it live on.
///
/// # Safety
/// `compiler` is NULL, or alive and not used any more.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn glisten_compiler_free(compiler: *mut Compiler) {
    // SAFETY: the host's.
    unsafe { take_back(compiler) };
}

/// Changes a compiler.
///
/// # Safety
/// `compiler` is NULL, or alive and not used elsewhere.
unsafe fn change(compiler: *mut Compiler, change: impl FnOnce(&mut Settings) -> Result<(), Error>) -> Status {
    call(|| {
        // SAFETY: the host's.
        let compiler = unsafe { exclusive(compiler, "compiler")? };
        // A panic leaves the settings as they were.
        let mut settings = compiler.settings.clone();
        change(&mut settings)?;
        compiler.settings = settings;
        Ok(Status::Ok)
    })
}

/// Sets an option as the flag of the same name of `glisten compile` does: `clip-z` to `minus-one-to-one`, `deny` to `warnings`. See
/// integrations/c/README.md for all of them.
///
/// # Safety
/// `compiler` is NULL, or alive and not used elsewhere; the texts end with NUL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn glisten_compiler_set(
    compiler: *mut Compiler,
    option: *const c_char,
    value: *const c_char,
) -> Status {
    // SAFETY: the host's.
    unsafe { change(compiler, |settings| settings.set(text(option, "option")?, text(value, "value")?)) }
}

/// Defines a macro before the first line of each source. A `value` of NULL is 1.
///
/// # Safety
/// `compiler` is NULL, or alive and not used elsewhere; the texts end with NUL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn glisten_compiler_define(
    compiler: *mut Compiler,
    name: *const c_char,
    value: *const c_char,
) -> Status {
    // SAFETY: the host's.
    unsafe {
        change(compiler, |settings| settings.define(text(name, "name")?, optional_text(value, "value")?.unwrap_or("1")))
    }
}

/// Adds a folder to the search path of `#include`.
///
/// # Safety
/// `compiler` is NULL, or alive and not used elsewhere; the text ends with NUL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn glisten_compiler_add_include_folder(compiler: *mut Compiler, folder: *const c_char) -> Status {
    // SAFETY: the host's.
    unsafe {
        change(compiler, |settings| {
            settings.includes.folders.push(text(folder, "folder")?.into());
            Ok(())
        })
    }
}

/// Binds a vertex attribute to a location, as `glBindAttribLocation` does.
///
/// # Safety
/// `compiler` is NULL, or alive and not used elsewhere; the text ends with NUL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn glisten_compiler_bind_attribute(
    compiler: *mut Compiler,
    name: *const c_char,
    location: u32,
) -> Status {
    // SAFETY: the host's.
    unsafe { change(compiler, |settings| settings.bind_attribute(text(name, "name")?, location)) }
}

/// Binds a fragment output to a color number, as `glBindFragDataLocation` does.
///
/// # Safety
/// `compiler` is NULL, or alive and not used elsewhere; the text ends with NUL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn glisten_compiler_bind_output(
    compiler: *mut Compiler,
    name: *const c_char,
    color_number: u32,
) -> Status {
    // SAFETY: the host's.
    unsafe { change(compiler, |settings| settings.bind_output(text(name, "name")?, color_number)) }
}

/// Sets the function that is asked first for included files, and the pointer that it gets. With NULL, nobody is asked. If `in_memory`,
/// the disk is not searched for what it does not answer.
///
/// # Safety
/// `compiler` is NULL, or alive and not used elsewhere; `user` serves the function while the compiler lives.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn glisten_compiler_set_include(
    compiler: *mut Compiler,
    function: IncludeFunction,
    user: *mut c_void,
    in_memory: bool,
) -> Status {
    let user = User(user);
    // SAFETY: the host's.
    unsafe {
        change(compiler, |settings| {
            settings.includes.in_memory = in_memory;
            settings.includes.ask = None;
            if function.is_some() {
                settings.includes.ask =
                    Some(Arc::new(move |path, angled, from| ask(function, user, path, angled, from)));
            }
            Ok(())
        })
    }
}

fn ask(function: IncludeFunction, user: User, path: &str, angled: bool, from: &str) -> Answer {
    let Some(function) = function else { return Answer::Pass };
    let mut reply = Reply { answer: None };
    let (c_path, c_from) = (c_text(path), c_text(from));
    // SAFETY: the host set the function and its pointer; the texts and the reply live while it runs.
    unsafe { function(user.pointer(), c_path.as_ptr(), angled, c_from.as_ptr(), ptr::from_mut(&mut reply)) };
    match reply.answer {
        None => Answer::Pass,
        Some(Err(reason)) => Answer::Missing(reason),
        Some(Ok(found)) => match text_of(found.bytes) {
            Ok(text) => Answer::Found { name: found.name.unwrap_or_else(|| path.to_owned()), text },
            Err(error) => Answer::Missing(error.message),
        },
    }
}
