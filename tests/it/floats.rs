//! Programs with floats of other widths: the judges accept them, and their pictures are as far from the truth as the width
//! says.

use crate::drawing::from_texts;
use crate::emit::{Collected, fixtures};
use crate::support::compile_files;
use glisten_emit::{Conventions, FloatWidth, Target, emit};
use glisten_gpu::{Gpu, Via};
use glisten_reference::{Precision, RenderOptions, render};
use glisten_scene::picture::Picture;

/// The targets that have floats of a width.
const WIDTHS: [(FloatWidth, &[Target]); 2] =
    [(FloatWidth::Half, &[Target::Wgsl, Target::Spirv]), (FloatWidth::Double, &[Target::Spirv])];

#[test]
fn every_fixture_is_accepted_in_other_widths() {
    let mut collected = Collected::new();
    let (mut written, mut refused) = (0, Vec::new());
    for folder in ["programs", "lower"] {
        for files in fixtures(folder).values() {
            let compilation = compile_files(files);
            let Some(program) = &compilation.program else { continue };
            for (floats, targets) in WIDTHS {
                let conventions = Conventions { floats, ..Conventions::default() };
                for (shader, &target) in
                    program.stages.iter().flat_map(|shader| targets.iter().map(move |one| (shader, one)))
                {
                    let name = format!("{} in {} for {}", files[0].display(), floats.ty(), target.name());
                    let plain = emit(program, shader.stage, target, &Conventions::default());
                    match emit(program, shader.stage, target, &conventions) {
                        Ok(emitted) => collected.add(&name, emitted),
                        Err(found) if plain.is_ok() => refused.extend(found.into_iter().map(|one| one.message)),
                        Err(_) => continue,
                    }
                    written += 1;
                }
            }
        }
    }
    collected.validate();
    assert!(written > 60, "{written} modules");
    refused.sort();
    refused.dedup();
    let too_large = ["100000000000000000000000000000000000000", "16777216"];
    let told = |value| format!("this stage cannot be written in f16: {value} is beyond the range of an f16");
    assert_eq!(refused, too_large.map(told));
}

#[test]
fn targets_without_a_width_say_so() {
    let compilation = compile_files(&fixtures("programs").into_values().next().expect("a program"));
    let program = compilation.program.expect("it compiles");
    let stage = glisten_front::hir::Stage::Fragment;
    for (floats, target, told) in [
        (FloatWidth::Half, Target::Glsl, "GLSL has no f16"),
        (FloatWidth::Double, Target::Wgsl, "WGSL has no f64"),
        (FloatWidth::Double, Target::Hlsl, "HLSL has no f64"),
    ] {
        let found = emit(&program, stage, target, &Conventions { floats, ..Conventions::default() });
        let found = found.expect_err("there is no such type");
        assert_eq!(found.iter().map(|one| (one.code.id, one.message.as_str())).collect::<Vec<_>>(), [("E0802", told)]);
    }
}

const VERTEX: &str = "#version 150
in vec2 p;
out vec2 place;
struct Wave { vec3 phase; mat2 turn; };
uniform Waves { Wave wave[2]; float scale; };
void main() {
    place = scale * p;
    Wave w = wave[1];
    place += 0.0 * (w.turn * w.phase.xy);
    gl_Position = vec4(p, 0.0, 1.0);
}
";

const FRAGMENT: &str = "#version 150
in vec2 place;
out vec4 color;
struct Wave { vec3 phase; mat2 turn; };
uniform Waves { Wave wave[2]; float scale; };
float sum(in float a[3], inout vec3 total) {
    total += vec3(a[0], a[1], a[2]);
    return a[0] + a[1] + a[2];
}
void main() {
    vec3 total = vec3(0.0);
    for (int i = 0; i < 2; i++) {
        Wave w = wave[i];
        vec2 turned = w.turn * place;
        float parts[3] = float[3](turned.x * turned.x, sqrt(abs(turned.y)), length(w.phase));
        total.z += sum(parts, total) / float(i + 3);
    }
    color = vec4(total * 0.125, dFdx(place.x) * 8.0);
}
";

const SCENE: &str = r#"
[framebuffer]
width = 32
height = 32
[[draw]]
vertex = "wave.vert"
fragment = "wave.frag"
mesh = { shape = "quad", position = "p" }
[draw.uniforms]
"wave[0].phase" = [0.1, 0.2, 0.3]
"wave[0].turn" = [0.8, 0.6, -0.6, 0.8]
"wave[1].phase" = [0.7, 0.1, 0.5]
"wave[1].turn" = [0.28, 0.96, -0.96, 0.28]
scale = 0.9
"#;

/// The largest difference of a channel over the pixels of two pictures.
fn largest(a: &Picture, b: &Picture) -> f64 {
    let pixels = a.attachments[0].iter().zip(&b.attachments[0]);
    pixels.flat_map(|(a, b)| a.iter().zip(b).map(|(a, b)| (a - b).abs())).fold(0.0, f64::max)
}

#[test]
fn a_picture_is_as_exact_as_its_floats() {
    let scene = from_texts([("wave.toml", SCENE), ("wave.vert", VERTEX), ("wave.frag", FRAGMENT)]);
    let options = RenderOptions { precision: Precision::F64, ..RenderOptions::default() };
    let truth = render(&scene, &options).expect("the reference draws it");
    let gpu = Gpu::new(None).expect("lavapipe");
    let error = |via, floats| {
        let prepared = gpu.prepare_in(&scene, via, floats).expect("the scene is prepared");
        largest(&gpu.draw(&prepared).expect("it is drawn").picture, &truth)
    };
    let single = error(Via::Spirv, FloatWidth::Single);
    assert!(single < 1e-6, "{single}");
    for via in [Via::Spirv, Via::Wgsl] {
        let half = error(via, FloatWidth::Half);
        assert!((1e-5..5e-3).contains(&half), "{half} by {}", via.name());
    }
    // Varyings and outputs are f32 still.
    let double = error(Via::Spirv, FloatWidth::Double);
    assert!(double <= single, "{double} against {single}");
}
