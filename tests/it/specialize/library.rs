//! What hosts call: residuals that are never larger, residuals that are kept, and which uniforms are worth fixing.

use super::{load, scene_files};
use crate::support::root;
use glisten::emit::{Conventions, Emitted, Target, optimize};
use glisten::specialize::{Known, ScalarValue, SpecializeOptions, Variants, specialize_smallest, specialize_with};
use glisten::{Compiler, Options, Program, Source, Stage};
use glisten_reference::{Precision, RenderOptions, work};
use glisten_specialize::Extent;
use glisten_variants::spirv_instructions;
use glisten_verify::specialize::{Suggestion, suggest};
use std::sync::Arc;

const VERTEX: &str = "#version 150\nin vec4 p;\nout vec4 v;\nvoid main() { v = p; gl_Position = p; }\n";

fn program(fragment: &str) -> Program {
    let source = |name: &str, text: &str, stage| Source { name: name.into(), text: text.into(), stage };
    let sources = [source("a.vert", VERTEX, Stage::Vertex), source("a.frag", fragment, Stage::Fragment)];
    let compiled = Compiler::new(Options::default()).compile(&sources);
    let messages: Vec<_> = compiled.diagnostics.iter().map(|found| found.message.clone()).collect();
    compiled.program.unwrap_or_else(|| panic!("{messages:?}\n{fragment}"))
}

fn known(values: &[(&str, &[ScalarValue])]) -> Known {
    let mut known = Known::default();
    known.uniforms.extend(values.iter().map(|(name, values)| ((*name).to_owned(), values.to_vec())));
    known
}

/// A loop whose every round is as long as the first stays one; so does a function that two kinds of calls need.
#[test]
fn what_would_be_longer_written_out_stays() {
    let work = "{ vec3 d = normalize(v.xyz * u - vec3(float(i), 1.0, 2.0)); \
                s += max(dot(d, v.xyz), 0.0) * pow(abs(d.x), 5.0) / length(d.xy + s); }";
    let head = "#version 150\nin vec4 v;\nuniform float u;\nuniform int n;\nout vec4 color;\n";
    let repeated =
        format!("{head}void main() {{ float s = 0.0; for (int i = 0; i < n; ++i) {{ {work} }} color = vec4(s); }}\n");
    let cloned = format!(
        "{head}float f(int i, float s) {{ {work} {work} {work} return s; }}\n\
         void main() {{ color = vec4(f(1, v.x), f(2, v.y), f(3, v.z), f(4, v.w)); }}\n"
    );
    let decided = format!(
        "{head}void main() {{ float s = 0.0; for (int i = 0; i < n; ++i) {{ if (u < 0.0) {{ {work} }} }} color = vec4(s); }}\n"
    );
    let values = known(&[("n", &[ScalarValue::Int(6)]), ("u", &[ScalarValue::Float(1.5)])]);
    let options = SpecializeOptions::default();
    for (text, extents) in [(&repeated, 1..4), (&cloned, 1..4), (&decided, 0..1)] {
        let program = program(text);
        let residual = specialize_smallest(&program, &values, &options);
        assert!(residual.fault.is_none(), "{:?}", residual.fault);
        assert!(extents.contains(&(residual.extent as usize)), "{:?}:\n{text}", residual.extent);
        let [before, after] = [&program, &residual.program].map(|program| spirv_instructions(&optimize(program)));
        assert!(after <= before, "{before} to {after}:\n{:?}", residual.text(Stage::Fragment));
    }
    // All extents are residuals of the same program, and each can be asked for.
    let program = program(&repeated);
    let texts = Extent::ALL.map(|extent| {
        let options = SpecializeOptions { extent, ..options };
        specialize_with(&program, &values, &options).text(Stage::Fragment).expect("a stage").to_owned()
    });
    let loops = |text: &str| text.contains("for (");
    assert!(!loops(&texts[0]) && texts[1..].iter().all(|text| loops(text)), "{texts:?}");
    assert!(!texts[1].contains("uniform int n;") && texts[3].contains("uniform int n;"), "{texts:?}");
}

/// Scenes whose residual executes more as the reference counts, and not on a GPU: the reference computes both arms of a `?:` for all lanes
/// where they are cheap. In the original an arm calls a function, `safeLargest()`, so that it is computed for the lanes that take it; in the
/// residual it is a number. They may have this many times the operations.
static COUNTED: (&[&str], f64) = (&["dial", "ember"], 1.1);

/// No scene's residual is larger than what `compile -O` makes of the original, and none executes more. `SPECIALIZE_ALL=1` looks
/// at all scenes.
#[test]
fn no_residual_is_larger_than_the_original() {
    let step = if std::env::var_os("SPECIALIZE_ALL").is_some() { 1 } else { 9 };
    let mut wrong = Vec::new();
    for path in scene_files().into_iter().step_by(step) {
        let Some((scene, sources)) = load(&path) else { continue };
        let specialized = glisten::specialize::specialize_scene(&scene, &sources, &[]);
        let options = RenderOptions { precision: Precision::F32, mark_edges: false, ..RenderOptions::default() };
        let works = [&scene, &specialized.scene].map(|scene| work(scene, &options).unwrap_or_default());
        for (before, after) in works[0].iter().zip(&works[1]) {
            let [before, after] = [before, after].map(|work| work.vertex_operations + work.fragment_operations);
            let is_counted = path.file_stem().is_some_and(|stem| COUNTED.0.iter().any(|name| stem == *name));
            let most = if is_counted { before as f64 * COUNTED.1 } else { before as f64 };
            if after as f64 > most {
                wrong.push(format!("{}: {before} operations to {after}", path.display()));
            }
        }
        for (draw, left) in scene.draws.iter().zip(&specialized.scene.draws) {
            let [before, after] =
                [&draw.program, &left.program].map(|program| spirv_instructions(&optimize(program.as_ref())));
            if after > before {
                wrong.push(format!("{}: {before} to {after}", path.display()));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn variants_are_made_once() {
    let fragment = "#version 150\nin vec4 v;\nuniform int mode;\nuniform vec4 tint;\nuniform float unread;\nout vec4 color;\n\
        void main() { color = mode == 1 ? v.yxzw * tint : mode == 2 ? v.yxzw * tint : v; }\n";
    let variants = Variants::new(program(fragment));
    let values = |mode: i32, unread: f32, tint: f32| {
        known(&[
            ("mode", &[ScalarValue::Int(mode)]),
            ("unread", &[ScalarValue::Float(unread)]),
            ("tint", &[ScalarValue::Float(tint); 4]),
        ])
    };
    assert!(variants.is_empty() && variants.made(&values(1, 0.0, 0.5)).is_none());
    let first = variants.get(&values(1, 0.0, 0.5));
    // What nobody reads decides nothing.
    assert!(Arc::ptr_eq(&first, &variants.get(&values(1, 7.0, 0.5))));
    assert!(variants.made(&values(1, 8.0, 0.5)).is_some_and(|made| Arc::ptr_eq(&made, &first)));
    // Other values, the same residual: a host has the pipeline.
    assert_eq!(variants.get(&values(2, 0.0, 0.5)).id(), first.id());
    assert_eq!(variants.get(&values(5, 0.0, 0.5)).id(), variants.get(&values(6, 0.0, 0.25)).id());
    assert_ne!(variants.get(&values(1, 0.0, 0.25)).id(), first.id());
    assert_eq!(variants.len(), 3);
    // The modules and the reflection are those of the residual.
    let conventions = Conventions::default();
    let module = first.module(Stage::Fragment, Target::Wgsl, &conventions);
    assert!(matches!(&module, Ok(Emitted::Text(text)) if text.contains("0.5") && !text.contains("mode")), "{module:?}");
    assert!(first.reflection(&conventions).uniforms.is_empty());
    assert_eq!(variants.program().interface.uniforms.len(), 3);
    // Threads that ask at once get one and the same.
    let ids: Vec<usize> = std::thread::scope(|scope| {
        let ask = |mode: i32| variants.get(&values(mode % 2 + 1, 0.0, 0.75)).id();
        let threads: Vec<_> = (0..8).map(|mode| scope.spawn(move || ask(mode))).collect();
        threads.into_iter().map(|thread| thread.join().expect("it does not panic")).collect()
    });
    assert!(ids.iter().all(|id| *id == ids[0]), "{ids:?}");
}

fn suggestion(names: &[&str]) -> Suggestion {
    let scenes: Vec<_> = names
        .iter()
        .map(|name| {
            let path = root().join(format!("fixtures/specialize/by_hand/{name}.toml"));
            ((*name).to_owned(), load(&path).expect("a scene").0)
        })
        .collect();
    let scenes: Vec<_> = scenes.iter().map(|(name, scene)| (name.clone(), scene)).collect();
    let mut steps = Vec::new();
    let found = suggest(&scenes, &[], &mut |done, of| steps.push((done, of))).expect("they draw");
    assert!(steps.last().is_some_and(|(done, of)| done == of), "{steps:?}");
    found
}

#[test]
fn uniforms_are_ranked_by_what_they_save() {
    let found = suggestion(&["plain_color", "graded", "noise_one"]);
    assert_eq!(found.scenes, ["plain_color", "graded", "noise_one"]);
    assert!(found.operations_all < found.operations_none, "{found:?}");
    assert!(found.uniforms.iter().rev().map(|one| one.saves).is_sorted(), "{:?}", found.uniforms);
    let of = |name: &str| found.uniforms.iter().find(|one| one.name == name).unwrap_or_else(|| panic!("{name}"));
    // How the noise is made matters where there is noise; what nobody mixes in does not.
    assert!(of("source").values == 3 && of("octaves").saves > of("texel").saves, "{:?}", found.uniforms);
    let first = found.curve.first().expect("a point");
    assert!(first.fixed.is_none() && first.variants == 1 && first.operations == found.operations_none);
    let last = found.curve.last().expect("a point");
    assert_eq!((last.variants, last.operations), (3, found.operations_all));
    assert_eq!(found.curve.len(), found.uniforms.len() + 1);
    // No more programs than scenes, and in the end at least as many as in the beginning.
    assert!(found.curve.iter().all(|point| (1..=3).contains(&point.variants)), "{:?}", found.curve);
}
