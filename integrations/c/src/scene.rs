//! [`Scene`]: a scene file with its programs.

use crate::blob::Blob;
use crate::compiler::Compiler;
use crate::diagnostic::{Diagnostic, Kept, show};
use crate::names::{self, FormatNumber};
use crate::picture::Picture;
use crate::pointers::{c_text, give, reference, take_back, text};
use crate::reply::{Reply, User};
use crate::status::{Status, call};
use glisten_binding::{Error, FileError, Files, Precision, Scenery};
use std::ffi::{c_char, c_void};
use std::ptr;
use std::sync::Arc;

/// A precision of the CPU reference: one of `GLISTEN_PRECISION_`.
pub type PrecisionNumber = u32;
/// Double precision.
pub const GLISTEN_PRECISION_F64: PrecisionNumber = 0;
/// Single precision, with one rounding per operation.
pub const GLISTEN_PRECISION_F32: PrecisionNumber = 1;

/// A host's function for the files of a scene: the scene itself, its shaders, meshes and images. It answers by
/// `glisten_reply_found` or `glisten_reply_missing`. It must not throw, nor jump out.
pub type ReadFunction = Option<unsafe extern "C" fn(user: *mut c_void, path: *const c_char, reply: *mut Reply)>;

/// A scene and everything that is wrong with it. It never changes.
pub struct Scene {
    scenery: Scenery,
    diagnostics: Vec<Kept>,
}

const _: () = {
    const fn is_shared<T: Send + Sync>() {}
    is_shared::<Scene>();
    is_shared::<Picture>();
};

/// Loads the scene at a path: from the disk, or with the files of `function`, unless it is NULL. Statuses are those of
/// `glisten_compile`, and `GLISTEN_STATUS_FILE` if a file is missing.
///
/// # Safety
/// `compiler` is NULL or alive; `path` ends with NUL; `scene` is NULL or can be written to.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn glisten_scene_load(
    compiler: *const Compiler,
    path: *const c_char,
    function: ReadFunction,
    user: *mut c_void,
    scene: *mut *mut Scene,
) -> Status {
    let user = User(user);
    call(|| {
        let made = || {
            // SAFETY: the host's.
            let (compiler, path) = unsafe { (reference(compiler, "compiler")?, text(path, "path")?) };
            let files = match function {
                None => Files::Disk,
                Some(_) => Files::Host(Arc::new(move |path: &str| read(function, user, path))),
            };
            let scenery = Scenery::load(&compiler.settings, path, &files)?;
            let diagnostics = Kept::all(scenery.findings());
            Ok(Scene { scenery, diagnostics })
        };
        // SAFETY: the host's; the handle was just made.
        let is_sound = unsafe { (*give(scene, made)?).scenery.is_sound() };
        Ok(if is_sound { Status::Ok } else { Status::Content })
    })
}

fn read(function: ReadFunction, user: User, path: &str) -> Result<Vec<u8>, FileError> {
    let Some(function) = function else { return Err(FileError::Missing) };
    let mut reply = Reply { answer: None };
    let c_path = c_text(path);
    // SAFETY: the host gave the function and its pointer; the text and the reply live while it runs.
    unsafe { function(user.pointer(), c_path.as_ptr(), ptr::from_mut(&mut reply)) };
    match reply.answer {
        None => Err(FileError::Missing),
        Some(Err(reason)) => Err(FileError::Unreadable(reason)),
        Some(Ok(found)) => Ok(found.bytes),
    }
}

/// Frees a scene.
///
/// # Safety
/// `scene` is NULL, or alive and not used any more.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn glisten_scene_free(scene: *mut Scene) {
    // SAFETY: the host's.
    unsafe { take_back(scene) };
}

/// How many diagnostics the scene has; 0 for NULL.
///
/// # Safety
/// `scene` is NULL or alive.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn glisten_scene_diagnostic_count(scene: *const Scene) -> usize {
    // SAFETY: the host's.
    unsafe { scene.as_ref() }.map_or(0, |scene| scene.diagnostics.len())
}

/// Writes a diagnostic of the scene to `diagnostic`.
///
/// # Safety
/// `scene` is NULL or alive; `diagnostic` is NULL or can be written to.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn glisten_scene_diagnostic(
    scene: *const Scene,
    index: usize,
    diagnostic: *mut Diagnostic,
) -> Status {
    call(|| {
        // SAFETY: the host's.
        unsafe { show(&reference(scene, "scene")?.diagnostics, index, diagnostic)? };
        Ok(Status::Ok)
    })
}

/// Gives all diagnostics of the scene as a text.
///
/// # Safety
/// `scene` is NULL or alive; `text` is NULL or can be written to.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn glisten_scene_diagnostics(
    scene: *const Scene,
    format: FormatNumber,
    text: *mut *mut Blob,
) -> Status {
    call(|| {
        let made = || {
            // SAFETY: the host's.
            let scene = unsafe { reference(scene, "scene")? };
            Ok(Blob::new(scene.scenery.diagnostics(names::format(format)?).into_bytes()))
        };
        // SAFETY: the host's.
        unsafe { give(text, made)? };
        Ok(Status::Ok)
    })
}

/// Draws the scene on the CPU, which may use many threads. It fails with `GLISTEN_STATUS_CONTENT` if the scene has errors.
///
/// # Safety
/// `scene` is NULL or alive; `picture` is NULL or can be written to.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn glisten_render(
    scene: *const Scene,
    precision: PrecisionNumber,
    picture: *mut *mut Picture,
) -> Status {
    call(|| {
        let made = || {
            // SAFETY: the host's.
            let scene = unsafe { reference(scene, "scene")? };
            let precision = match precision {
                GLISTEN_PRECISION_F64 => Precision::F64,
                GLISTEN_PRECISION_F32 => Precision::F32,
                _ => return Err(Error::argument("there is no precision with this number")),
            };
            scene.scenery.draw(precision).map(|drawn| Picture { drawn })
        };
        // SAFETY: the host's.
        unsafe { give(picture, made)? };
        Ok(Status::Ok)
    })
}
