//! The texts that the page shows of a scene: findings, texts, controls, reflection, the programs in another language.
//!
//! *In:* a scene that was read. *Out:* one JSON object. *Holds:* the findings are those of `glisten lint` for the same programs, in
//! the form of its `--format json`; each program of the scene is told once.

use super::controls::controls;
use super::criteria::Criteria;
use super::translations::translations;
use glisten_emit::Target;
use glisten_front::diagnostic::write;
use glisten_front::diagnostic::{Code, Diagnostic, Levels};
use glisten_front::link::Program;
use glisten_front::lint::check_some;
use glisten_front::source::SourceMap;
use glisten_verify::scene::{Loaded, Scene};
use glisten_verify::specialize::specialize_scene;
use serde_json::{Value, json};
use std::sync::Arc;

/// How the programs are shown.
#[derive(Clone, Copy, Debug)]
pub struct Shown {
    /// The language.
    pub target: Target,
    /// Whether they are without what the picture does not need.
    pub leaves_out: bool,
}

/// The answer for a scene file, with the scene if there is one.
pub fn look(criteria: &mut impl Criteria, name: &str, loaded: Loaded, shown: Shown) -> (Value, Option<Scene>) {
    let Loaded { scene, sources, diagnostics, io_error } = loaded;
    // A scene that cannot be read has no text; in the page, one may be left.
    let is_read =
        !io_error || sources.files().next().is_none_or(|(_, file)| file.name() != name || !file.text().is_empty());
    // Errors in the configuration of the scene are told even if the scene has none.
    criteria.levels_of(name);
    let programs = scene.as_ref().map(programs).unwrap_or_default();
    let mut found: Vec<_> = diagnostics.into_iter().collect();
    for program in &programs {
        found.extend(lints(criteria, program, &sources));
    }
    let findings = criteria.findings(&sources, found);
    let findings: Value = serde_json::from_str(&write::json(&findings, None)).unwrap_or_default();
    let text = sources.files().next().map(|(_, file)| file.text().to_owned()).unwrap_or_default();
    let residual = scene.as_ref().filter(|_| shown.leaves_out).map(|scene| specialize_scene(scene, &sources, &[]));
    let residual = residual.as_ref().map(|residual| self::programs(&residual.scene));
    let answer = json!({
        "findings": findings,
        "files": files(&sources, is_read),
        "controls": controls(&text),
        "programs": translations(criteria, &sources, residual.as_deref().unwrap_or(&programs), shown.target),
        "size": scene.as_ref().map(|scene| [scene.framebuffer.width, scene.framebuffer.height]),
    });
    (answer, scene)
}

/// The programs of a scene, each once.
fn programs(scene: &Scene) -> Vec<Arc<Program>> {
    let mut programs: Vec<Arc<Program>> = Vec::new();
    for draw in &scene.draws {
        if !programs.iter().any(|program| Arc::ptr_eq(program, &draw.program)) {
            programs.push(Arc::clone(&draw.program));
        }
    }
    programs
}

fn lints(criteria: &mut impl Criteria, program: &Program, sources: &SourceMap) -> Vec<Diagnostic> {
    let levels: Vec<Levels> = sources.files().map(|(_, file)| criteria.levels_of(file.name())).collect();
    let wanted = |code: &Code| levels.iter().any(|levels| levels.may_report(code));
    criteria.guarded(|| check_some(program, sources, wanted)).unwrap_or_default()
}

/// The texts that were read, the scene file first if it is one of them.
fn files(sources: &SourceMap, is_scene_read: bool) -> Vec<Value> {
    let file =
        |(_, file): (_, &glisten_front::source::SourceFile)| json!({ "name": file.name(), "text": &**file.text() });
    sources.files().skip(usize::from(!is_scene_read)).map(file).collect()
}

#[cfg(test)]
mod tests {
    use super::{Shown, look};
    use crate::Criteria;
    use glisten_emit::Target;
    use glisten_front::Compiler;
    use glisten_front::Options;
    use glisten_front::diagnostic::write::{self, Finding};
    use glisten_front::diagnostic::{Diagnostic, Levels};
    use glisten_front::source::SourceMap;
    use glisten_verify::scene::{self, MemoryFiles};
    use serde_json::Value;

    /// Every finding at its own level.
    struct Plain;

    impl Criteria for Plain {
        fn levels_of(&mut self, _: &str) -> Levels {
            Levels::default()
        }

        fn findings(&mut self, sources: &SourceMap, found: Vec<Diagnostic>) -> Vec<Finding> {
            write::findings(sources, &found)
        }
    }

    const SCENE: &str = "[framebuffer]\nwidth = 4\nheight = 2\n[[draw]]\nvertex = \"a.vert\"\nfragment = \"a.frag\"\nvertex_count = 3\n\
        [draw.uniforms]\ntint = [0.5, 0.25, 1.0]\n";
    const VERTEX: &str = "#version 150\nvoid main() { gl_Position = vec4(0.0, 0.0, 0.0, 1.0); }\n";

    fn looked(fragment: &str) -> Value {
        let files = MemoryFiles::new([("s.toml", SCENE), ("a.vert", VERTEX), ("a.frag", fragment)]);
        let loaded = scene::load("s.toml", &files, &Compiler::new(Options::default()));
        look(&mut Plain, "s.toml", loaded, Shown { target: Target::Wgsl, leaves_out: false }).0
    }

    #[test]
    fn a_scene_in_memory_is_shown() {
        let answer =
            looked("#version 150\nuniform vec3 tint;\nout vec4 color;\nvoid main() { color = vec4(tint, 1.0); }\n");
        assert_eq!(answer["size"], serde_json::json!([4, 2]));
        assert_eq!(answer["controls"][0]["kind"], "color");
        assert_eq!(answer["files"].as_array().map(Vec::len), Some(3));
        let text = answer["programs"][0]["stages"][1]["text"].as_str().unwrap_or_default();
        assert!(text.contains("@fragment"), "{answer}");
    }

    #[test]
    fn lines_know_the_statements_that_they_come_from() {
        let text = "#version 150\nuniform vec3 tint;\nout vec4 color;\nfloat half_of(float x) {\n    return 0.5 * x;\n}\n\
            void main() {\n    float lit = half_of(tint.r);\n    if (lit > 0.5) {\n        discard;\n    }\n    color = vec4(tint, lit);\n}\n";
        let answer = looked(text);
        let stage = &answer["programs"][0]["stages"][1];
        let written: Vec<&str> = stage["text"].as_str().unwrap_or_default().lines().collect();
        let mut found = Vec::new();
        for origin in stage["lines"].as_array().into_iter().flatten() {
            let number = |index: usize| origin[index].as_u64().unwrap_or(0) as usize;
            assert_eq!(answer["files"][number(1)]["name"], "a.frag", "{origin}");
            let line = written.get(number(0) - 1).copied().unwrap_or_default().trim();
            found.push((line.split(' ').next().unwrap_or_default(), number(2), number(3)));
        }
        for wanted in [("fn", 4, 4), ("return", 5, 5), ("if", 9, 11), ("discard;", 10, 10)] {
            assert!(found.contains(&wanted), "{wanted:?} in {found:?} of\n{}", written.join("\n"));
        }
        // The color is written on the lines of its own statement, and of no other.
        assert!(found.iter().any(|(_, from, to)| (*from, *to) == (12, 12)), "{found:?}");
    }

    #[test]
    fn an_error_is_found_at_its_place() {
        let answer = looked("#version 150\nout vec4 color;\nvoid main() { color = nothing; }\n");
        let found = &answer["findings"][0];
        assert_eq!(
            (&found["severity"], &found["file"], &found["line"]),
            (&"error".into(), &"a.frag".into(), &3.into())
        );
        assert_eq!(answer["programs"], serde_json::json!([]));
    }
}
