//! `glisten lib export`: the library as files, in the language of a host.
//!
//! *In:* a folder and a form. *Out:* GLSL with or without includes, WGSL, or the structs of the programs' uniforms in Rust or C.

use crate::console::Console;
use crate::exit::{Exit, Failure, Outcome};
use crate::files;
use crate::variants::axes::define;
use clap::Args;
use glisten_build::{c_structs, rust_structs};
use glisten_front::diagnostic::write::human;
use glisten_front::hir::Stage;
use glisten_front::{Compilation, Compiler, Options, Source};
use glisten_library::{Embedded, Overloads, flat, modules, programs, shader, shader_files, wgsl};
use std::borrow::Cow;
use std::path::{Path, PathBuf};

/// The options of `glisten lib export`.
#[derive(Args, Debug)]
pub(crate) struct ExportArgs {
    #[command(flatten)]
    form: FormArgs,
    /// Define a macro before the texts are read (repeatable): `GLISTEN_LIGHTS=16`, `GLISTEN_CONES`
    #[arg(short = 'D', value_name = "NAME[=VALUE]", value_parser = define, requires = "form")]
    defines: Vec<(String, String)>,
    /// The output folder
    #[arg(value_name = "DIR")]
    folder: PathBuf,
}

/// The form of the files; without one, they are GLSL with includes.
#[derive(Args, Debug)]
#[group(id = "form", multiple = false)]
struct FormArgs {
    /// Write the text of a module in place of its include: each file is whole, for hosts without includes
    #[arg(long, conflicts_with = "defines")]
    flat: bool,
    /// Write each module as WGSL without an entry point, and all of them as `glisten.wgsl`. Overloads have the types of their
    /// parameters in their names: `sdfBox_vec2_vec2`
    #[arg(long)]
    wgsl: bool,
    /// Write the structs of the programs' uniforms (`Light`, `Material`) and vertices as `programs.rs`
    #[arg(long)]
    rust: bool,
    /// Write the structs of each program's uniforms as a header of C and C++
    #[arg(long)]
    c: bool,
}

/// Writes the files.
pub(crate) fn export(args: &ExportArgs, console: &Console) -> Outcome {
    let ExportArgs { form, defines, folder } = args;
    files::make_folder(folder)?;
    let options = Options { defines: defines.clone(), ..Options::default() };
    let written = match form {
        FormArgs { wgsl: true, .. } => export_wgsl(folder, &options)?,
        FormArgs { rust: true, .. } => export_rust(folder, &options)?,
        FormArgs { c: true, .. } => export_c(folder, &options)?,
        FormArgs { flat, .. } => export_glsl(folder, if *flat { Includes::Replaced } else { Includes::Kept })?,
    };
    console.remark(&format!("wrote {written} to {}", folder.display()));
    Ok(Exit::Ok)
}

/// The includes in exported files.
#[derive(Clone, Copy, Debug)]
enum Includes {
    /// Each names another exported file.
    Kept,
    /// Each is the text of the module.
    Replaced,
}

fn export_glsl(folder: &Path, includes: Includes) -> Result<String, Failure> {
    for module in modules() {
        let text = match includes {
            Includes::Kept => Cow::Borrowed(module.text),
            Includes::Replaced => Cow::Owned(flat(module.text)),
        };
        files::write(&folder.join(format!("{}.glsl", module.name)), text.as_bytes())?;
    }
    let programs = folder.join("programs");
    files::make_folder(&programs)?;
    for (file, text) in shader_files().filter_map(|file| Some((file, shader(file)?))) {
        let text = match includes {
            Includes::Kept => from_disk(text),
            Includes::Replaced => flat(text),
        };
        files::write(&programs.join(file), text.as_bytes())?;
    }
    Ok(format!("{} modules and {} shaders", modules().len(), shader_files().count()))
}

/// The text of a program's shader with paths to the modules in place of their include names, one folder up.
fn from_disk(text: &str) -> String {
    let line = |line: &str| match line.strip_prefix("#include <glisten/").and_then(|rest| rest.strip_suffix('>')) {
        Some(file) => format!("#include \"../{file}\"\n"),
        None => format!("{line}\n"),
    };
    text.lines().map(line).collect()
}

fn export_wgsl(folder: &Path, options: &Options) -> Result<String, Failure> {
    let overloads = Overloads::of_the_library();
    let each = modules().iter().map(|module| (module.name, std::slice::from_ref(module)));
    for (name, modules) in each.chain([("glisten", modules())]) {
        let text = wgsl(&format!("{name}.glsl"), modules, &overloads, options)
            .map_err(|told| refused(&format!("WGSL cannot have the module `{name}`"), &told))?;
        files::write(&folder.join(format!("{name}.wgsl")), text.as_bytes())?;
    }
    Ok(format!("{} modules, and all of them as glisten.wgsl,", modules().len()))
}

fn export_rust(folder: &Path, options: &Options) -> Result<String, Failure> {
    let programs = compiled(options)?;
    let text = rust_structs(&programs).map_err(|told| refused("Rust cannot have the programs", &told))?;
    files::write(&folder.join("programs.rs"), text.as_bytes())?;
    Ok(format!("the structs of {} programs", programs.len()))
}

fn export_c(folder: &Path, options: &Options) -> Result<String, Failure> {
    let programs = compiled(options)?;
    for (name, compilation) in &programs {
        let text = c_structs(name, compilation).unwrap_or_default();
        files::write(&folder.join(format!("{name}.h")), text.as_bytes())?;
    }
    Ok(format!("the structs of {} programs", programs.len()))
}

/// All programs of the library, linked.
fn compiled(options: &Options) -> Result<Vec<(String, Compilation)>, Failure> {
    let compiler = Compiler::new(options.clone()).with_includes(Embedded);
    let compile = |program: &glisten_library::LibraryProgram| {
        let source = |file: &'static str, stage| Some(Source { name: file.into(), text: shader(file)?.into(), stage });
        let sources = [source(program.vertex, Stage::Vertex), source(program.fragment, Stage::Fragment)];
        let compilation = compiler.compile(&sources.into_iter().flatten().collect::<Vec<_>>());
        if compilation.program.is_some() {
            return Ok((program.name.to_owned(), compilation));
        }
        let told = human(&compilation.sources, &compilation.diagnostics, false);
        Err(refused(&format!("the program `{}` does not compile", program.name), &told))
    };
    programs().iter().map(compile).collect()
}

/// A failure with what the compiler says.
fn refused(message: &str, told: &str) -> Failure {
    Failure::new(Exit::Content, format!("{message}:\n{}", told.trim_end()))
        .help("a macro of `-D` may have changed the texts; without `-D`, this is a fault of glisten: please report it")
}
