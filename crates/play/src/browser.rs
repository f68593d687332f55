//! Scenes that a browser draws by WebGPU, and the verdict on what it drew.
//!
//! *In:* a scene that was read; the bytes that the browser read back. *Out:* a [`Plan`]; a picture; a verdict. *Holds:* the picture is judged
//! by what WGSL and WebGPU let any GPU do, since nobody knows which one drew, but for the precision of window positions, which a page can
//! measure.

use super::answers::drawable;
use super::criteria::told;
use super::verdict::judged;
use super::{Kept, Pictures, Positions, drawn};
use glisten_front::source::SourceMap;
use glisten_plan::Plan;
use glisten_plan::pixels::picture;
use glisten_reference::domain::Profile;
use glisten_scene::picture::Picture;
use glisten_verify::scene::{Loaded, Scene};
use glisten_verify::verify::{self, Drawn, Failure, Options, Runner};
use serde_json::Value;

/// A picture that was drawn elsewhere.
struct Given(Picture);

impl Runner for Given {
    fn name(&self) -> &'static str {
        "webgpu"
    }

    fn draw(&self, _: &Scene) -> Result<Drawn, Failure> {
        Ok(Drawn { picture: self.0.clone(), milliseconds: 0.0 })
    }
}

/// The calls of WebGPU that draw a scene.
///
/// # Errors
/// The scene has errors, or WebGPU lacks something that it needs.
pub fn plan(loaded: Loaded, kept: &mut Kept) -> Result<Plan, String> {
    let (scene, _) = drawable(loaded)?;
    let scene = glisten_reference::expand(&scene).map_err(|errors| told(&errors))?;
    Plan::with(&kept.as_compiled(&scene), &mut kept.written).map_err(|error| error.to_string())
}

/// The picture that the browser drew, from the planes of its attachments and of the stencil.
///
/// # Errors
/// The scene has errors.
pub fn show(loaded: Loaded, planes: Vec<Vec<u8>>, by: &str, pictures: &mut Pictures) -> Result<Value, String> {
    let (scene, _) = drawable(loaded)?;
    let picture = picture(&scene.framebuffer, planes);
    let shown = drawn(&picture, &scene, by);
    pictures.take_driver(picture);
    Ok(shown)
}

/// The verdict on what the browser drew.
///
/// # Errors
/// The scene has errors, or the reference cannot draw it.
pub fn compare(
    loaded: Loaded,
    planes: Vec<Vec<u8>>,
    (by, positions): (&str, Option<Positions>),
    pictures: &mut Pictures,
) -> Result<Value, String> {
    let (scene, sources) = drawable(loaded)?;
    let profile = positions.map_or(Profile::WGSL, |Positions { bits, exact }| Profile {
        // No GPU conforms with less, and more is nothing that a page could tell.
        subpixel_bits: bits.clamp(4, 8),
        exact_positions: exact,
        ..Profile::WGSL
    });
    let answer = verified(&scene, (&sources, profile), picture(&scene.framebuffer, planes))?;
    let told = judged(&answer, &scene, by);
    let driver = answer.runs.first().map(|run| run.picture.clone());
    pictures.take_judged(answer.reference, driver, answer.shares);
    Ok(told)
}

fn verified(
    scene: &Scene,
    (sources, profile): (&SourceMap, Profile),
    picture: Picture,
) -> Result<verify::Verification, String> {
    let options = Options { profile, sources: Some(sources), ..Options::default() };
    verify::verify(scene, &[&Given(picture)], &options).map_err(|failure| failure.to_string())
}

#[cfg(test)]
mod tests {
    use super::{compare, plan, show};
    use crate::{Kept, Pictures, Positions};
    use glisten_front::Compiler;
    use glisten_front::Options;
    use glisten_verify::scene::{self, Loaded, MemoryFiles};

    const SCENE: &str = "[framebuffer]\nwidth = 4\nheight = 2\nformat = \"rgba8unorm\"\n[[draw]]\nvertex = \"a.vert\"\nfragment = \"a.frag\"\n\
        vertex_count = 3\n[draw.uniforms]\ntint = [0.2, 0.4, 1.0]\n";
    const VERTEX: &str = "#version 150\nvoid main() {\n    vec2 at = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0;\n\
        gl_Position = vec4(at, 0.0, 1.0);\n}\n";
    const FRAGMENT: &str =
        "#version 150\nuniform vec3 tint;\nout vec4 color;\nvoid main() { color = vec4(tint, 1.0); }\n";

    fn loaded() -> Loaded {
        let files = MemoryFiles::new([("s.toml", SCENE), ("a.vert", VERTEX), ("a.frag", FRAGMENT)]);
        scene::load("s.toml", &files, &Compiler::new(Options::default()))
    }

    /// The planes that a GPU would give back.
    fn planes(pixel: [u8; 4]) -> Vec<Vec<u8>> {
        vec![pixel.repeat(8), vec![1; 8]]
    }

    #[test]
    fn a_right_picture_holds_and_a_wrong_one_fails() {
        let calls = plan(loaded(), &mut Kept::default()).expect("a plan").calls;
        assert!(calls["draws"][0]["fragment"].as_str().is_some_and(|text| text.contains("@fragment")), "{calls}");
        let mut pictures = Pictures::default();
        let shown = show(loaded(), planes([51, 102, 255, 255]), "a GPU", &mut pictures).expect("a picture");
        assert_eq!((&shown["by"], &shown["is_empty"]), (&"a GPU".into(), &false.into()));
        let verdict =
            compare(loaded(), planes([51, 102, 255, 255]), ("a GPU", None), &mut pictures).expect("a verdict");
        assert_eq!(verdict["verdict"], "holds", "{}", verdict["says"]);
        assert_eq!(pictures.pixel(0, 0)["driver"]["values"][0], "0.2000000");
        let verdict =
            compare(loaded(), planes([51, 104, 255, 255]), ("a GPU", None), &mut pictures).expect("a verdict");
        assert_eq!(verdict["verdict"], "fails", "{}", verdict["says"]);
        // What was cut off is not covered.
        let verdict =
            compare(loaded(), Vec::new(), ("a GPU", Some(Positions { bits: 8, exact: false })), &mut pictures)
                .expect("a verdict");
        assert_eq!(verdict["verdict"], "fails", "{}", verdict["says"]);
    }
}
