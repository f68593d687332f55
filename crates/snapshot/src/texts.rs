//! The texts of snapshots.
//!
//! *In:* a program, a compilation, a scene. *Out:* a text that is the same on every machine. *Holds:* an error becomes the text,
//! so that a snapshot shows that a target lacks something.

use glisten_emit::{Conventions, Emitted, Target, emit, reflect};
use glisten_front::diagnostic::write::human;
use glisten_front::source::SourceMap;
use glisten_front::{Compilation, Program, Stage};
use glisten_scene::Scene;
use glisten_verify::specialize::{self, Contract, specialize_scene_by};

/// The code of all stages for a target. SPIR-V is listed, an instruction a line: its operation's number and its words.
pub fn emitted(program: &Program, target: Target) -> String {
    let mut text = String::new();
    for shader in &program.stages {
        text.push_str(&format!("// {}\n", shader.stage.name()));
        match emit(program, shader.stage, target, &Conventions::default()) {
            Ok(Emitted::Text(code)) => text.push_str(without_head(&code)),
            Ok(Emitted::Words(words)) => text.push_str(&listed(&words)),
            Err(errors) => {
                errors.iter().for_each(|error| text.push_str(&format!("{}: {}\n", error.code, error.message)))
            }
        }
        text.push('\n');
    }
    text
}

/// The code without the line that names the version of glisten.
fn without_head(code: &str) -> &str {
    let is_head = |line: &str| line.starts_with("//") && line.contains("translated by glisten");
    code.split_once('\n').filter(|(first, _)| is_head(first)).map_or(code, |(_, rest)| rest)
}

/// The instructions of a module, without its head (SPIR-V 1.6 §2.3).
fn listed(words: &[u32]) -> String {
    let mut text = String::new();
    let mut rest = words.get(5..).unwrap_or_default();
    while let Some((&first, _)) = rest.split_first() {
        let length = ((first >> 16) as usize).clamp(1, rest.len());
        let (instruction, after) = rest.split_at(length);
        text.push_str(&format!("{:4}", first & 0xffff));
        let words: Vec<String> = instruction.iter().skip(1).map(|word| format!(" {word:x}")).collect();
        text.push_str(&words.concat());
        text.push('\n');
        rest = after;
    }
    text
}

/// The reflection as JSON.
pub fn reflection(program: &Program) -> String {
    let mut reflection = reflect(program, &Conventions::default());
    reflection.compact();
    serde_json::to_string_pretty(&reflection).expect("a reflection is always JSON")
}

/// The diagnostics with their excerpts.
pub fn diagnostics(compilation: &Compilation) -> String {
    human(&compilation.sources, compilation.diagnostics.iter(), false)
}

/// The account of what specialization leaves out of a scene, as JSON.
pub fn account(scene: &Scene, sources: &SourceMap) -> String {
    let specialized = specialize_scene_by(Contract::default(), scene, sources, &[]);
    let file = |draw: &glisten_scene::Draw, stage: Stage| {
        let shader = draw.program.stage(stage);
        let main = shader.and_then(|shader| shader.main.map(|main| shader.function(main).span));
        let place = main.and_then(|span| sources.file_of(span));
        let path = place.map_or("", |file| sources.file(file).name());
        path.rsplit(['/', '\\']).next().unwrap_or_default().to_owned()
    };
    let names: Vec<[String; 3]> = scene
        .draws
        .iter()
        .map(|draw| [file(draw, Stage::Vertex), file(draw, Stage::Fragment), draw.program.name.clone()])
        .collect();
    match specialize::account(&scene.name, scene, &specialized, &names) {
        Ok(account) => serde_json::to_string_pretty(&account).expect("an account is always JSON"),
        Err(errors) => errors.iter().map(|error| format!("{}: {}\n", error.code, error.message)).collect(),
    }
}
