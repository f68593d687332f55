//! The files that a host needs next to the sources: reflection, WGSL, a module of Rust, headers of C; the passes of a pack of Minecraft.
//!
//! *In:* ported programs. *Out:* files of the new folder. *Holds:* the files of a program agree with each other in every number, and with
//! the new texts, if the host reads those.

use super::programs::{Done, Ported};
use super::tree::{NewFolder, folder_and_stem};
use crate::exit::{Exit, Failure};
use glisten_emit::{Conventions, Emitted, Target, emit, reflect};
use glisten_front::{Compilation, Program, Stage};
use glisten_port::{FileReport, Host, done, header, post_effect, reflection, renumbered};
use glisten_upgrade::Dialect;
use std::path::Path;

/// Adds the files that the host needs. Returns sentences for the programs at some places.
pub(super) fn add(
    host: &Host,
    ported: &Ported,
    folder: &mut NewFolder,
    pack: &Path,
) -> Result<Vec<(usize, String)>, Failure> {
    let (mut pairs, mut notes) = (Vec::new(), Vec::new());
    for (index, one) in ported.programs.iter().enumerate() {
        let Some(compilation) = described(host, ported, one) else { continue };
        let Some(program) = &compilation.program else { continue };
        let Some(first) = one.first().and_then(|path| folder.place(pack, &path)) else { continue };
        let (place, stem) = folder_and_stem(&first);
        let name = |kind: &str, extension: &str| {
            let path = Path::new(kind).join(&place).join(format!("{stem}.{extension}"));
            path.to_string_lossy().replace('\\', "/")
        };
        let whole = first.rsplit_once('.').map_or(first.as_str(), |(stem, _)| stem);
        let mut new = if host.has_header { reflection(program) } else { reflect(program, &Conventions::default()) };
        if host.has_header {
            folder.add(&name("include", "h"), header(whole, program, &new).into_bytes());
        }
        new.compact();
        let json = serde_json::to_string_pretty(&new).unwrap_or_default() + "\n";
        folder.add(&name("reflection", "json"), json.into_bytes());
        if host.has_wgsl {
            notes.extend(other_numbers(ported, one, program).map(|note| (index, note)));
            wgsl(program, &name, folder);
        }
        if host.has_rust && one.report.new.len() == 2 {
            pairs.push((whole.replace(['/', '.', '-', ' '], "_"), compilation));
        }
    }
    if !pairs.is_empty() {
        let root = std::path::absolute(pack).unwrap_or_else(|_| pack.to_owned());
        let text = glisten_build::wgpu_module(&pairs, &root).map_err(|errors| Failure::new(Exit::Content, errors))?;
        folder.add("shaders.rs", text.into_bytes());
    }
    Ok(notes)
}

/// Adds the WGSL of a program.
fn wgsl(program: &Program, name: &dyn Fn(&str, &str) -> String, folder: &mut NewFolder) {
    for shader in &program.stages {
        let extension = if shader.stage == Stage::Vertex { "vert.wgsl" } else { "frag.wgsl" };
        if let Ok(Emitted::Text(text)) = emit(program, shader.stage, Target::Wgsl, &Conventions::default()) {
            folder.add(&name("wgsl", extension), text.into_bytes());
        }
    }
}

/// The program that the host's files describe: the texts with their numbers for a host that reads them, and the program before numbers
/// were written for one that gets WGSL, of which all files then have the same numbers.
fn described(host: &Host, ported: &Ported, one: &Done) -> Option<Compilation> {
    let unit = ported.units.get(one.index?)?;
    match &host.dialect {
        Some(_) if host.has_wgsl => Some(unit.compiler.compile(&unit.sources)),
        Some(dialect) if host.has_header => of_texts(ported, one, dialect),
        Some(dialect) => {
            let index = one.index.filter(|index| ported.plain.refused.get(*index).is_some_and(Option::is_none))?;
            let (compiler, sources) = unit.read_back(index, &ported.plain, dialect);
            Some(compiler.compile(&sources))
        }
        None => Some(unit.compiler.compile(&unit.sources)),
    }
}

/// The program of the new texts, as they are written.
fn of_texts(ported: &Ported, one: &Done, dialect: &Dialect) -> Option<Compilation> {
    let index = one.index?;
    let (compiler, sources) = ported.units.get(index)?.read_back(index, &ported.tree, dialect);
    Some(compiler.compile(&sources))
}

/// The names that the WGSL of a program numbers otherwise than its new texts.
fn other_numbers(ported: &Ported, one: &Done, code: &Program) -> Option<String> {
    let compilation = of_texts(ported, one, ported.host.dialect.as_ref()?)?;
    let names: Vec<String> =
        renumbered(code, &compilation.program?).into_iter().map(|name| format!("`{name}`")).collect();
    let others = "in GLSL, whose files other programs share, than in WGSL, `shaders.rs` and the reflection";
    (!names.is_empty()).then(|| format!("other numbers {others}: {}", names.join(", ")))
}

/// The passes of a pack, by the blocks of its shaders.
pub(super) fn passes(host: &Host, folder: &mut NewFolder) -> Vec<FileReport> {
    let of_game = |name: &str| host.dialect.iter().flat_map(|dialect| &dialect.blocks).any(|block| block.name == name);
    let names: Vec<String> = folder
        .names()
        .filter(|name| name.contains("/post_effect/") && name.ends_with(".json"))
        .map(str::to_owned)
        .collect();
    let mut reports = Vec::new();
    for name in names {
        let Some(old) = folder.text(&name) else { continue };
        let shader = |id: &str, is_fragment: bool| {
            let (namespace, path) = id.split_once(':').unwrap_or(("minecraft", id));
            let extension = if is_fragment { "fsh" } else { "vsh" };
            let own = format!("assets/{namespace}/shaders/{path}.{extension}");
            let found = folder.names().find(|name| name.ends_with(&own)).map(str::to_owned);
            folder.text(&found?)
        };
        let Some(new) = post_effect(&old, &shader, &of_game) else { continue };
        let mut done = done(&old, &old);
        done.push("the values of uniforms are by blocks".to_owned());
        reports.push(FileReport {
            file: name.clone(),
            new: name.clone(),
            done,
            notes: new.notes,
            texts: (old, new.text.clone()),
        });
        folder.replace(&name, &name, new.text.into_bytes());
    }
    reports
}

/// Notes the uniforms in new blocks of which no pass and no game has a value.
pub(super) fn note_unfilled(folder: &NewFolder, files: &mut [FileReport]) {
    let is_pass = |name: &&str| name.contains("/post_effect/") && name.ends_with(".json");
    let passes: String = folder.names().filter(is_pass).filter_map(|name| folder.text(name)).collect();
    for file in files.iter_mut().filter(|file| file.file.contains("/shaders/")) {
        let old = glisten_port::blocks(&file.texts.0);
        let new =
            glisten_port::blocks(&file.texts.1).into_iter().filter(|(name, _)| !old.iter().any(|(own, _)| own == name));
        let is_filled = |name: &str| passes.contains(&format!("\"{name}\""));
        let members = new.flat_map(|(_, members)| members).filter(|(_, name)| !is_filled(name));
        let names: Vec<String> = members.map(|(_, name)| format!("`{name}`")).collect();
        if !names.is_empty() {
            file.notes.push(format!("neither the game nor a pass has a value for {}", names.join(", ")));
        }
    }
}
