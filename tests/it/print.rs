//! The printer of the typed program: its text is valid GLSL, has the same meaning, and prints the same again.

use glisten_front::hir::{Stage, print};
use glisten_front::{Compilation, Compiler, Options, Source};
use std::path::{Path, PathBuf};

fn stage_of(path: &Path) -> Option<Stage> {
    match path.extension()?.to_str()? {
        "vert" => Some(Stage::Vertex),
        "geom" => Some(Stage::Geometry),
        "frag" => Some(Stage::Fragment),
        _ => None,
    }
}

fn shaders(folder: &Path, found: &mut Vec<PathBuf>) {
    let entries = std::fs::read_dir(folder).expect("the fixtures are there");
    for path in entries.flatten().map(|entry| entry.path()) {
        if path.is_dir() {
            shaders(&path, found);
        } else if stage_of(&path).is_some() {
            found.push(path);
        }
    }
    found.sort();
}

fn compile(name: &str, text: String, stage: Stage) -> Compilation {
    let source = Source { name: name.into(), text: text.into(), stage };
    Compiler::new(Options::default()).compile(&[source])
}

fn printed(compilation: &Compilation) -> Option<String> {
    let program = compilation.program.as_ref()?;
    program.stages.first().map(|shader| print(&program.types, shader))
}

#[test]
fn printing_and_reading_again_is_stable() {
    let mut files = Vec::new();
    for folder in ["fixtures/valid", "fixtures/programs"] {
        shaders(&Path::new(env!("CARGO_MANIFEST_DIR")).join(folder), &mut files);
    }
    let mut n_printed = 0;
    let mut failures = Vec::new();
    for file in files {
        let name = file.display().to_string();
        let stage = stage_of(&file).expect("only shaders were collected");
        let text = String::from_utf8_lossy(&std::fs::read(&file).expect("readable")).into_owned();
        // Other tests handle fixtures with includes or errors.
        let Some(first) = printed(&compile(&name, text, stage)) else { continue };
        n_printed += 1;
        let again = compile(&name, first.clone(), stage);
        match printed(&again) {
            None => {
                let messages: Vec<_> = again.diagnostics.iter().map(|found| found.message.clone()).collect();
                failures.push(format!("{name}: the printed text is refused: {messages:?}\n{first}"));
            }
            Some(second) if second != first => {
                failures.push(format!("{name}: differs\n{first}\n--- again ---\n{second}"))
            }
            Some(_) => {}
        }
    }
    assert!(n_printed >= 10, "only {n_printed} fixtures could be printed");
    assert!(failures.is_empty(), "{} of {n_printed}:\n{}", failures.len(), failures.join("\n"));
}
