//! The files that a host needs next to the sources: reflection, WGSL, a module of Rust, headers of C; the passes of a pack of Minecraft.
//!
//! *In:* ported programs. *Out:* files of the new folder. *Holds:* what is emitted comes from the new texts, as they are written.

use super::super::exit::{Exit, Failure};
use super::programs::{Done, Ported};
use super::tree::{NewFolder, folder_and_stem};
use crate::build::Build;
use crate::port::{FileReport, Host, done, header, post_effect};
use glisten_emit::{Conventions, Emitted, Target, emit, reflect};
use glisten_front::Stage;
use glisten_front::link::Program;
use std::path::Path;

/// Adds the files that the host needs.
pub(super) fn add(host: &Host, ported: &Ported, folder: &mut NewFolder, pack: &Path) -> Result<(), Failure> {
    let conventions = Conventions::default();
    let mut pairs = Vec::new();
    for one in &ported.programs {
        let Some(program) = read_back(host, ported, one) else { continue };
        let Some(first) = one.files.first().and_then(|path| folder.place(pack, path)) else { continue };
        let (place, stem) = folder_and_stem(&first);
        let name = |kind: &str, extension: &str| {
            let path = Path::new(kind).join(&place).join(format!("{stem}.{extension}"));
            path.to_string_lossy().replace('\\', "/")
        };
        let mut reflection = reflect(&program, &conventions);
        reflection.compact();
        let json = serde_json::to_string_pretty(&reflection).unwrap_or_default() + "\n";
        folder.add(&name("reflection", "json"), json.into_bytes());
        if host.has_header {
            folder.add(&name("include", "h"), header(&stem, &program, &reflect(&program, &conventions)).into_bytes());
        }
        if host.has_wgsl {
            for shader in &program.stages {
                let extension = if shader.stage == Stage::Vertex { "vert.wgsl" } else { "frag.wgsl" };
                if let Ok(Emitted::Text(text)) = emit(&program, shader.stage, Target::Wgsl, &conventions) {
                    folder.add(&name("wgsl", extension), text.into_bytes());
                }
            }
        }
        if let [vertex, fragment] = one.files.as_slice() {
            let module =
                first.rsplit_once('.').map_or(first.as_str(), |(stem, _)| stem).replace(['/', '.', '-', ' '], "_");
            pairs.push((module, vertex.clone(), fragment.clone()));
        }
    }
    if host.has_rust && !pairs.is_empty() {
        let named = |build: Build, (name, vertex, fragment): &(String, _, _)| {
            build.named_program(name.clone(), vertex, fragment)
        };
        let build = pairs.iter().fold(Build::new().without_spirv().wgpu(), named);
        let built = build.text().map_err(|error| Failure::new(Exit::Content, error.to_string()))?;
        folder.add("shaders.rs", built.text.into_bytes());
    }
    Ok(())
}

/// The program of the new texts.
fn read_back(host: &Host, ported: &Ported, one: &Done) -> Option<Program> {
    let index = one.index.filter(|index| ported.plain.refused.get(*index).is_some_and(Option::is_none))?;
    let unit = ported.units.get(index)?;
    let (compiler, sources) = match &host.dialect {
        Some(dialect) => unit.read_back(index, &ported.plain, dialect),
        None => (unit.compiler.clone(), unit.sources.clone()),
    };
    compiler.compile(&sources).program
}

/// The passes of a pack, by the blocks of its shaders.
pub(super) fn passes(folder: &mut NewFolder) -> Vec<FileReport> {
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
        let Some(new) = post_effect(&old, &shader) else { continue };
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
