//! [`answer`]: the answer to a job that needs no driver.
//!
//! *In:* a job, a scene that was read with its texts. *Out:* one JSON object, or a sentence. *Holds:* it is the same in the process of
//! `glisten play` and in a page that has glisten as a module.

use super::criteria::{Criteria, told};
use super::look::{Shown, look};
use super::needs::needs;
use super::stability::stability;
use super::{Job, Pictures, Wish};
use glisten_emit::Target;
use glisten_front::diagnostic::write::{self, Finding};
use glisten_front::diagnostic::{Diagnostic, Levels};
use glisten_front::source::SourceMap;
use glisten_reference::trace::{Place, trace};
use glisten_verify::scene::{Loaded, Scene};
use serde_json::Value;

/// The levels that findings have by themselves and by comments.
pub struct OwnLevels;

impl Criteria for OwnLevels {
    fn levels_of(&mut self, _: &str) -> Levels {
        Levels::default()
    }

    fn findings(&mut self, sources: &SourceMap, mut found: Vec<Diagnostic>) -> Vec<Finding> {
        let levels = Levels::default();
        found.retain_mut(|diagnostic| levels.apply(sources, diagnostic));
        found.sort_by_key(|diagnostic| sources.call_site(diagnostic.primary.span).start);
        write::findings(sources, &found)
    }
}

/// The answer to a job; `load` reads its scene.
///
/// # Errors
/// The reason why there is none.
pub fn answer<C: Criteria>(
    job: &Job,
    criteria: &mut C,
    pictures: &mut Pictures,
    load: impl FnOnce(&mut C) -> Loaded,
) -> Result<Value, String> {
    match &job.wish {
        Wish::Look { target, leaves_out } => {
            let target = Target::from_word(target).ok_or_else(|| format!("`{target}` is no language"))?;
            let loaded = load(criteria);
            Ok(look(criteria, &job.scene, loaded, Shown { target, leaves_out: *leaves_out }).0)
        }
        Wish::Draw { gpu: false, coarse: true } => pictures.first_look(&drawable(load(criteria))?.0),
        Wish::Draw { gpu: false, coarse: false } => pictures.reference(&drawable(load(criteria))?.0),
        Wish::Draw { gpu: true, .. } | Wish::Judge | Wish::Variants => Err("there is no driver here".to_owned()),
        Wish::NewScene { .. } => Err("only the program makes scenes".to_owned()),
        Wish::Needs => {
            let (scene, sources) = drawable(load(criteria))?;
            needs(&job.scene, &scene, &sources)
        }
        Wish::Stability => {
            let (scene, sources) = drawable(load(criteria))?;
            stability(&scene, &sources)
        }
        Wish::Plan | Wish::Show { .. } | Wish::JudgeShown { .. } => Err("only a page draws by a browser".to_owned()),
        Wish::Pixel { x, y } => Ok(pictures.pixel(*x, *y)),
        Wish::Trace { x, y } => {
            let (scene, sources) = drawable(load(criteria))?;
            followed(&job.scene, &scene, &sources, [*x, *y])
        }
    }
}

/// The scene, or what keeps it from being drawn.
///
/// # Errors
/// The first error.
pub fn drawable(loaded: Loaded) -> Result<(Scene, SourceMap), String> {
    let Loaded { scene, sources, diagnostics, .. } = loaded;
    match scene {
        Some(scene) => Ok((scene, sources)),
        None => {
            let diagnostics: Vec<_> = diagnostics.into_iter().filter(|diagnostic| diagnostic.is_error()).collect();
            Err(told(diagnostics.iter().take(1)))
        }
    }
}

/// The values that the fragments of a pixel computed, as `glisten trace` tells them.
fn followed(name: &str, scene: &Scene, sources: &SourceMap, pixel: [u32; 2]) -> Result<Value, String> {
    let place = Place::Pixel(pixel);
    let found = trace(scene, place).map_err(|errors| told(errors.iter().take(1)))?;
    serde_json::to_value(glisten_verify::trace::told(name, scene, sources, place, &found))
        .map_err(|error| error.to_string())
}

#[cfg(test)]
mod tests {
    use super::{OwnLevels, answer};
    use crate::{Job, Pictures};
    use glisten_front::Compiler;
    use glisten_front::Options;
    use glisten_verify::scene::{self, MemoryFiles};
    use serde_json::Value;

    const SCENE: &str = "[framebuffer]\nwidth = 4\nheight = 2\n[[draw]]\nvertex = \"a.vert\"\nfragment = \"a.frag\"\nvertex_count = 3\n\
        [draw.uniforms]\ntint = [0.5, 0.25, 1.0]\n";
    const VERTEX: &str = "#version 150\nvoid main() {\n    vec2 at = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0;\n\
        gl_Position = vec4(at, 0.0, 1.0);\n}\n";
    const FRAGMENT: &str = "#version 150\nuniform vec3 tint;\nout vec4 color;\nvoid main() {\n    float unused;\n    color = vec4(tint, 1.0);\n}\n";

    fn asked(pictures: &mut Pictures, wish: &str, fragment: &str) -> Result<Value, String> {
        let job: Job = serde_json::from_str(&format!("{{\"scene\":\"s.toml\",{wish}}}")).expect("a job");
        let files = MemoryFiles::new([("s.toml", SCENE), ("a.vert", VERTEX), ("a.frag", fragment)]);
        let compiler = Compiler::new(Options::default());
        answer(&job, &mut OwnLevels, pictures, |_| scene::load("s.toml", &files, &compiler))
    }

    #[test]
    fn a_page_without_a_driver_has_its_answers() {
        let mut pictures = Pictures::default();
        let mut ask = |wish| asked(&mut pictures, wish, FRAGMENT);
        let pixel = ask(r#""ask":"pixel","x":1,"y":1"#).expect("an answer");
        assert!(pixel["reference"].is_null(), "nothing was drawn: {pixel}");
        let drawn = ask(r#""ask":"draw""#).expect("a picture");
        assert_eq!((&drawn["width"], &drawn["height"], &drawn["is_empty"]), (&4.into(), &2.into(), &false.into()));
        assert!(drawn["picture"].as_str().is_some_and(|uri| uri.starts_with("data:image/png;base64,iVBOR")));
        assert!(drawn["block"].is_null());
        let pixel = ask(r#""ask":"pixel","x":1,"y":1"#).expect("an answer");
        assert_eq!(pixel["reference"]["values"][1], "0.2500000", "{pixel}");
        let traced = ask(r#""ask":"trace","x":1,"y":1"#).expect("steps");
        assert!(traced["invocations"].as_array().is_some_and(|all| !all.is_empty()), "{traced}");
        assert!(ask(r#""ask":"judge""#).is_err() && ask(r#""ask":"draw","gpu":true"#).is_err());
    }

    #[test]
    fn a_first_look_is_one_pixel_of_each_block() {
        let mut pictures = Pictures::default();
        let fragment =
            "#version 150\nout vec4 color;\nvoid main() { color = vec4(step(8.0, gl_FragCoord.x), 0.0, 0.0, 1.0); }\n";
        let mut ask = |wish: &str| {
            let job: Job = serde_json::from_str(&format!("{{\"scene\":\"s.toml\",{wish}}}")).expect("a job");
            let scene = SCENE.replace("width = 4\nheight = 2", "width = 16\nheight = 8").replace("tint", "# tint");
            let files = MemoryFiles::new([("s.toml", scene.as_str()), ("a.vert", VERTEX), ("a.frag", fragment)]);
            let compiler = Compiler::new(Options::default());
            answer(&job, &mut OwnLevels, &mut pictures, |_| scene::load("s.toml", &files, &compiler))
                .expect("an answer")
        };
        let coarse = ask(r#""ask":"draw","coarse":true"#);
        assert_eq!(coarse["block"], 8);
        assert!(ask(r#""ask":"pixel","x":1,"y":1"#)["reference"].is_null(), "it is not the picture");
        let whole = ask(r#""ask":"draw""#);
        // The middles of both blocks are like all of their pixels.
        assert_eq!(coarse["picture"], whole["picture"]);
        assert_eq!(ask(r#""ask":"pixel","x":9,"y":1"#)["reference"]["values"][0], "1.0000000");
    }

    #[test]
    fn levels_are_those_of_the_rules_and_of_comments() {
        let mut pictures = Pictures::default();
        let look = r#""ask":"look","target":"wgsl""#;
        let codes = |answer: &Value| -> Vec<String> {
            let found = answer["findings"].as_array().into_iter().flatten();
            found.map(|one| one["code"].as_str().unwrap_or_default().to_owned()).collect()
        };
        let answer = asked(&mut pictures, look, FRAGMENT).expect("an answer");
        assert_eq!(codes(&answer), ["L0051"], "{answer}");
        let allowed = FRAGMENT.replace("float unused;", "float unused; // glisten: allow(L0051)");
        assert_eq!(codes(&asked(&mut pictures, look, &allowed).expect("an answer")), Vec::<String>::new());
        let broken =
            asked(&mut pictures, r#""ask":"draw""#, &FRAGMENT.replace("tint, 1.0", "tint, x")).expect_err("an error");
        assert!(broken.contains("`x` is not declared"), "{broken}");
    }
}
