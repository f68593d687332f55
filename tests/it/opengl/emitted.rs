//! OpenGL draws the emitted GLSL as the reference draws the source: every scene of the fixtures, in each version that the
//! driver reads.

use super::{EMPTY, EXCEPTIONS, Expected, gl, judged, named_files, small, told};
use crate::drawing::from_disk;
use crate::support::root;
use glisten::scene::Scene;
use glisten_emit::{Conventions, Emitted, GlslVersion, Target, emit};
use glisten_scene::Draw;
use glisten_scene::picture::Picture;
use std::sync::Arc;

/// The scene with the emitted texts of its programs; none if the version lacks something, or if `gl_FragColor` is for several
/// attachments: as an output of the shader's own, it is for the first.
fn emitted(scene: &Scene, glsl_version: GlslVersion) -> Option<Scene> {
    let is_for_all = |draw: &Draw| draw.program.interface.outputs.iter().any(|output| output.name == "gl_FragColor");
    if scene.framebuffer.attachments > 1 && scene.draws.iter().any(is_for_all) {
        return None;
    }
    let conventions = Conventions { glsl_version, ..Conventions::default() };
    let mut scene = scene.clone();
    for draw in &mut scene.draws {
        let mut program = (*draw.program).clone();
        let written = program.clone();
        for shader in &mut program.stages {
            let Ok(Emitted::Text(text)) = emit(&written, shader.stage, Target::Glsl, &conventions) else { return None };
            shader.texts = vec![text.into()];
        }
        draw.program = Arc::new(program);
    }
    Some(scene)
}

const VERSIONS: [GlslVersion; 3] = [GlslVersion::Desktop330, GlslVersion::Desktop450, GlslVersion::Es300];

#[test]
fn opengl_draws_emitted_glsl_as_the_reference_draws_the_source() {
    let Some(gl) = gl() else { return };
    let (mut wrong, mut counts) = (Vec::new(), [0; VERSIONS.len()]);
    for (name, path) in named_files(&root().join("fixtures/scenes"), "toml") {
        let scene = small(from_disk(path));
        let exception = EXCEPTIONS.iter().find(|(known, ..)| *known == name);
        let mut judged_picture: Option<Picture> = None;
        for (version, count) in VERSIONS.iter().zip(&mut counts) {
            let name = format!("{name} in {}", version.word());
            // The other versions have no arrays that are indexed so.
            if *version == GlslVersion::Desktop450 && matches!(exception, Some((_, Expected::Withheld, _))) {
                continue;
            }
            let Some(emitted) = emitted(&scene, *version) else { continue };
            let picture = match gl.render(&emitted) {
                Ok(picture) => picture,
                Err(_) if matches!(exception, Some((_, Expected::Refused(_), _))) => continue,
                Err(error) => {
                    wrong.push(format!("{name}: {error}"));
                    continue;
                }
            };
            *count += 1;
            // The versions draw the same picture next to always, and judging one takes longer than drawing it.
            if judged_picture.as_ref().is_some_and(|known| known.attachments == picture.attachments) {
                continue;
            }
            let verdict = judged(&name, &scene, picture.clone(), exception);
            if verdict.fails() || (verdict.covered == 0 && !is_empty(&name)) {
                wrong.push(told(&name, &verdict));
            }
            judged_picture = Some(picture);
        }
    }
    assert!(wrong.is_empty(), "{} of {counts:?}: {}", wrong.len(), wrong.join("\n"));
    assert!(counts[0] > 120 && counts[1] > 120 && counts[2] > 80, "only {counts:?} scenes");
}

fn is_empty(name: &str) -> bool {
    EMPTY.iter().any(|empty| name.starts_with(&format!("{empty} ")))
}
