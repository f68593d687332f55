//! [`Program`]: what the compilation of sources results in.

use crate::blob::Blob;
use crate::compiler::Compiler;
use crate::diagnostic::{Diagnostic, Kept, show};
use crate::names::{self, FormatNumber, StageNumber, TargetNumber};
use crate::pointers::{give, reference, slice, take_back, text};
use crate::status::{Status, call};
use glisten_binding::{Compiled, Error, compile};
use std::ffi::c_char;

/// The size of a text that ends with NUL.
pub const GLISTEN_NUL_TERMINATED: usize = usize::MAX;

/// A source text.
#[repr(C)]
pub struct Source {
    /// The name for diagnostics, and for finding includes: a path.
    pub name: *const c_char,
    /// The text.
    pub text: *const c_char,
    /// How many bytes the text has; `GLISTEN_NUL_TERMINATED` if it ends with NUL.
    pub size: usize,
    /// The stage.
    pub stage: StageNumber,
}

/// A program and everything that is wrong with it. It never changes.
pub struct Program {
    compiled: Compiled,
    diagnostics: Vec<Kept>,
}

const _: () = {
    const fn is_shared<T: Send + Sync>() {}
    is_shared::<Program>();
    is_shared::<Compiler>();
};

/// The sources of the host.
///
/// # Safety
/// `sources` are `count` sources with their texts.
pub(crate) unsafe fn sources_of(sources: *const Source, count: usize) -> Result<Vec<glisten_binding::Source>, Error> {
    // SAFETY: the caller's.
    let sources = unsafe { slice(sources, count, "sources")? };
    let source = |source: &Source| {
        // SAFETY: the caller's.
        let name = unsafe { text(source.name, "name of a source")? };
        let content = match source.size {
            // SAFETY: the caller's.
            GLISTEN_NUL_TERMINATED => unsafe { text(source.text, "text of a source")? },
            // SAFETY: the caller's.
            size => std::str::from_utf8(unsafe { slice(source.text.cast::<u8>(), size, "text of a source")? })
                .map_err(|_| Error::argument(format!("the text of `{name}` is not UTF-8")))?,
        };
        glisten_binding::sources_of(name, content, names::stage(source.stage)?)
    };
    let sources: Vec<Vec<_>> = sources.iter().map(source).collect::<Result<_, Error>>()?;
    Ok(sources.concat())
}

/// Compiles, and gives the program to the host.
///
/// # Safety
/// As for [`glisten_compile`].
unsafe fn make(
    compiler: *const Compiler,
    sources: *const Source,
    count: usize,
    lints: bool,
    program: *mut *mut Program,
) -> Status {
    call(|| {
        let made = || {
            // SAFETY: the caller's.
            let (compiler, sources) = unsafe { (reference(compiler, "compiler")?, sources_of(sources, count)?) };
            let compiled = compile(&compiler.settings, &sources, lints)?;
            let diagnostics = Kept::all(compiled.findings());
            Ok(Program { compiled, diagnostics })
        };
        // SAFETY: the caller's; the handle was just made.
        let is_sound = unsafe { (*give(program, made)?).compiled.is_sound() };
        Ok(if is_sound { Status::Ok } else { Status::Content })
    })
}

/// Compiles the sources of one program. There is a program, with its diagnostics, if the status is `GLISTEN_STATUS_OK` or
/// `GLISTEN_STATUS_CONTENT`; the latter if there are errors.
///
/// # Safety
/// `compiler` is NULL or alive; `sources` are `count` sources with their texts; `program` is NULL or can be written to.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn glisten_compile(
    compiler: *const Compiler,
    sources: *const Source,
    count: usize,
    program: *mut *mut Program,
) -> Status {
    // SAFETY: the host's.
    unsafe { make(compiler, sources, count, false, program) }
}

/// Compiles as `glisten_compile` does, and also looks for what is legal but will hurt. A part of a program is no error here.
///
/// # Safety
/// As for `glisten_compile`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn glisten_lint(
    compiler: *const Compiler,
    sources: *const Source,
    count: usize,
    program: *mut *mut Program,
) -> Status {
    // SAFETY: the host's.
    unsafe { make(compiler, sources, count, true, program) }
}

/// Frees a program.
///
/// # Safety
/// `program` is NULL, or alive and not used any more.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn glisten_program_free(program: *mut Program) {
    // SAFETY: the host's.
    unsafe { take_back(program) };
}

/// Whether the program has a stage, and no errors.
///
/// # Safety
/// `program` is NULL or alive.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn glisten_program_has_stage(program: *const Program, stage: StageNumber) -> bool {
    // SAFETY: the host's.
    let program = unsafe { program.as_ref() };
    let stage = names::stage(stage).ok().flatten();
    program.zip(stage).is_some_and(|(program, stage)| program.compiled.stages().contains(&stage))
}

/// Emits the code of a stage for a target. What the target cannot represent is `GLISTEN_STATUS_CONTENT`, with the diagnostics in
/// `glisten_last_error`.
///
/// # Safety
/// `program` is NULL or alive; `code` is NULL or can be written to.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn glisten_program_emit(
    program: *const Program,
    stage: StageNumber,
    target: TargetNumber,
    code: *mut *mut Blob,
) -> Status {
    call(|| {
        let made = || {
            // SAFETY: the host's.
            let program = unsafe { reference(program, "program")? };
            let stage = names::stage(stage)?.ok_or_else(|| Error::argument("a stage has to be named here"))?;
            program.compiled.emit(stage, names::target(target)?).map(Blob::new)
        };
        // SAFETY: the host's.
        unsafe { give(code, made)? };
        Ok(Status::Ok)
    })
}

/// Gives what a host needs to know about the program as JSON: attributes, uniforms with their offsets, bindings, varyings,
/// outputs. Its form is `docs/reflection.schema.json`.
///
/// # Safety
/// `program` is NULL or alive; `json` is NULL or can be written to.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn glisten_program_reflect(program: *const Program, json: *mut *mut Blob) -> Status {
    call(|| {
        // SAFETY: the host's.
        let made = || unsafe { reference(program, "program")?.compiled.reflect() };
        // SAFETY: the host's.
        unsafe { give(json, || made().map(|text| Blob::new(text.into_bytes())))? };
        Ok(Status::Ok)
    })
}

/// How many diagnostics the program has; 0 for NULL.
///
/// # Safety
/// `program` is NULL or alive.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn glisten_program_diagnostic_count(program: *const Program) -> usize {
    // SAFETY: the host's.
    unsafe { program.as_ref() }.map_or(0, |program| program.diagnostics.len())
}

/// Writes a diagnostic of the program to `diagnostic`. They are in the order of their places.
///
/// # Safety
/// `program` is NULL or alive; `diagnostic` is NULL or can be written to.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn glisten_program_diagnostic(
    program: *const Program,
    index: usize,
    diagnostic: *mut Diagnostic,
) -> Status {
    call(|| {
        // SAFETY: the host's.
        unsafe { show(&reference(program, "program")?.diagnostics, index, diagnostic)? };
        Ok(Status::Ok)
    })
}

/// Gives all diagnostics of the program as a text.
///
/// # Safety
/// `program` is NULL or alive; `text` is NULL or can be written to.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn glisten_program_diagnostics(
    program: *const Program,
    format: FormatNumber,
    text: *mut *mut Blob,
) -> Status {
    call(|| {
        let made = || {
            // SAFETY: the host's.
            let program = unsafe { reference(program, "program")? };
            Ok(Blob::new(program.compiled.diagnostics(names::format(format)?).into_bytes()))
        };
        // SAFETY: the host's.
        unsafe { give(text, made)? };
        Ok(Status::Ok)
    })
}
