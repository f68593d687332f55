//! `compile -O`: what reaches no output is left out, and nothing else changes.

use glisten::emit::{Conventions, Emitted, Reflection, Target, emit, left_out, optimize, reflect};
use glisten::scene::Scene;
use glisten::{Compiler, Options, Program, Source, Stage};
use std::collections::BTreeSet;
use std::sync::Arc;

fn program(vertex: &str, fragment: &str) -> (Program, glisten::source::SourceMap) {
    let text = |text: &str| format!("#version 150\n{text}").into();
    let sources = [
        Source { name: "a.vert".into(), text: text(vertex), stage: Stage::Vertex },
        Source { name: "a.frag".into(), text: text(fragment), stage: Stage::Fragment },
    ];
    let compiled = Compiler::new(Options::default()).compile(&sources);
    let messages: Vec<_> = compiled.diagnostics.iter().map(|found| found.message.clone()).collect();
    (compiled.program.unwrap_or_else(|| panic!("{messages:?}\n{vertex}\n{fragment}")), compiled.sources)
}

/// The names of a reflection that are active, or that are not.
fn names(reflection: &Reflection, active: bool) -> BTreeSet<String> {
    let attributes = reflection.attributes.iter().map(|row| (&row.name, row.active));
    let varyings = reflection.varyings.iter().map(|row| (&row.name, row.active));
    let uniforms = reflection.uniforms.iter().map(|row| (&row.name, row.active));
    let samplers = reflection.samplers.iter().map(|row| (&row.name, row.active));
    let all = attributes.chain(varyings).chain(uniforms).chain(samplers);
    all.filter(|(_, is)| *is == active).map(|(name, _)| name.clone()).collect()
}

fn wgsl(program: &Program, stage: Stage) -> String {
    match emit(program, stage, Target::Wgsl, &Conventions::default()) {
        Ok(Emitted::Text(text)) => text,
        other => panic!("{other:?}"),
    }
}

/// Without `active`, which is all that may change.
pub(crate) fn places(program: &Program) -> Reflection {
    let mut reflection = reflect(program, &Conventions::default());
    reflection.attributes.iter_mut().for_each(|row| row.active = true);
    reflection.varyings.iter_mut().for_each(|row| row.active = true);
    reflection.blocks.iter_mut().for_each(|row| row.active = true);
    reflection.uniforms.iter_mut().for_each(|row| row.active = true);
    reflection.samplers.iter_mut().for_each(|row| row.active = true);
    reflection.struct_arrays.iter_mut().for_each(|row| row.active = true);
    // Stages that do not read it do not see it.
    reflection.loose_block.iter_mut().for_each(|row| row.visibility.clear());
    reflection.blocks.iter_mut().for_each(|row| row.visibility.clear());
    reflection.samplers.iter_mut().for_each(|row| row.visibility.clear());
    reflection
}

#[test]
fn what_reaches_no_output_is_not_active() {
    // Declarations and body of each stage, and all that is left.
    let plain = "in vec4 p;\nin vec4 q;\nout vec4 v;\nout vec4 w;\nuniform vec4 u;\nuniform sampler2D t;\n";
    let read = "in vec4 v;\nin vec4 w;\nout vec4 color;\n";
    let cases: &[(&str, &str, &str, &[&str])] = &[
        // A varying that is read for nothing takes its attribute along.
        ("v = p; w = q; gl_Position = p;", "", "vec4 dead = w; color = v;", &["p", "v"]),
        ("v = p; w = q * u; gl_Position = p;", "", "vec4 dead = w; color = v;", &["p", "v"]),
        // A chain of stores, a loop that fills what nobody reads.
        ("v = p; vec4 a = q; vec4 b = a; a = b; w = p; gl_Position = p;", "", "color = v + w;", &["p", "v", "w"]),
        (
            "v = p; w = p; vec4 s = vec4(0.0); for (int i = 0; i < 4; ++i) s += q; gl_Position = p;",
            "",
            "color = v + w;",
            &["p", "v", "w"],
        ),
        // What decides a discard, an index, a condition or a position reaches an output.
        ("v = p; w = q; gl_Position = p;", "", "if (w.x > 0.5) discard; color = v;", &["p", "q", "v", "w"]),
        ("v = p; w = q; gl_Position = p + u;", "", "color = v[int(w.x)] * vec4(1.0);", &["p", "q", "u", "v", "w"]),
        ("v = p; w = vec4(0.0); if (q.x > 0.0) v = u; gl_Position = p;", "", "color = v;", &["p", "q", "u", "v"]),
        ("v = p; w = texture(t, q.xy); gl_Position = p;", "", "vec4 c = w; color = v; c = v;", &["p", "v"]),
        ("v = p; w = q; gl_Position = p;", "", "vec4 c = w; color = v; gl_FragDepth = c.x;", &["p", "q", "v", "w"]),
        // What a function takes and does not use, what it gives and nobody takes.
        ("v = p; w = q; gl_Position = p;", "vec4 f(vec4 a, vec4 b) { return a; }", "color = f(v, w);", &["p", "v"]),
        (
            "v = p; w = q; gl_Position = p;",
            "void f(vec4 a, out vec4 b) { b = a; }",
            "vec4 c; f(w, c); color = v;",
            &["p", "v"],
        ),
        ("v = p; w = q; gl_Position = p;", "vec4 g = vec4(1.0); void f() { g = w; }", "f(); color = v;", &["p", "v"]),
        (
            "v = p; w = q; gl_Position = p;",
            "vec4 g = vec4(1.0); void f() { g = w; }",
            "f(); color = v + g;",
            &["p", "q", "v", "w"],
        ),
        ("v = p; w = q; gl_Position = p;", "vec4 g = vec4(1.0);\nvec4 h = g;", "color = v; h = w;", &["p", "v"]),
        // A store that is overwritten first.
        ("v = q; v = p; w = p; gl_Position = p;", "", "vec4 c = w; c = v; color = c;", &["p", "v"]),
        // What may be left before the second store is made.
        ("v = p; w = q; gl_Position = p;", "", "color = w; if (v.x > 0.0) return; color = v;", &["p", "q", "v", "w"]),
    ];
    for (vertex, functions, fragment, active) in cases {
        let (program, sources) = program(
            &format!("{plain}void main() {{ {vertex} }}\n"),
            &format!("{read}{functions}\nvoid main() {{ {fragment} }}\n"),
        );
        let optimized = optimize(&program);
        let is = names(&reflect(&optimized, &Conventions::default()), true);
        // A whole varying that is stored to twice is not followed: the outputs of a stage are read when it ends.
        let expected: BTreeSet<String> = active.iter().map(|name| (*name).to_owned()).collect();
        let extra: Vec<&String> =
            is.difference(&expected).filter(|name| !(vertex.starts_with("v = q; v") && *name == "q")).collect();
        assert!(extra.is_empty() && is.is_superset(&expected), "{is:?}, not {expected:?}, of\n{vertex}\n{fragment}");
        let texts = wgsl(&optimized, Stage::Vertex) + &wgsl(&optimized, Stage::Fragment);
        for name in names(&reflect(&optimized, &Conventions::default()), false) {
            // A member of the block of the loose uniforms keeps its place.
            let declared = texts.contains(&format!(" {name}: ")) || texts.contains(&format!("({name}: "));
            assert!(!declared || name == "u", "`{name}` is in\n{texts}");
        }
        assert_eq!(places(&program), places(&optimized), "{vertex}\n{fragment}");
        let told: BTreeSet<String> =
            left_out(&program, &optimized, Some(&sources)).into_iter().map(|one| one.name).collect();
        for name in names(&reflect(&optimized, &Conventions::default()), false) {
            assert!(told.contains(&name), "nobody told of `{name}`: {told:?}\n{vertex}\n{fragment}");
        }
    }
}

#[test]
fn stages_alone_and_blocks_keep_their_shape() {
    let text = "#version 150\nin vec4 p;\nout vec4 v;\nuniform Block { vec4 unread; vec4 read; };\n\
                uniform float first;\nuniform float second;\nvoid main() { v = read * second; gl_Position = p; }\n";
    let sources = [Source { name: "a.vert".into(), text: text.into(), stage: Stage::Vertex }];
    let program = Compiler::new(Options::default()).compile(&sources).program.expect("a program");
    let optimized = optimize(&program);
    assert_eq!(places(&program), places(&optimized));
    let text = wgsl(&optimized, Stage::Vertex);
    // Nobody knows who reads the output of a lone stage; the layout of a block is the host's.
    assert!(text.contains("@location(0) v: vec4<f32>") || text.contains("@location(0) v"), "{text}");
    assert!(text.contains("unread") && text.contains("first"), "{text}");
}

/// A scene whose draws run optimized programs.
pub(crate) fn optimized_scene(scene: &Scene) -> Scene {
    let mut scene = scene.clone();
    for draw in &mut scene.draws {
        draw.program = Arc::new(optimize(&draw.program));
    }
    scene
}

#[cfg(feature = "gpu")]
mod drawn {
    use super::optimized_scene;
    use crate::random::{scene, seeds, text};
    use crate::specialize::{Instead, bits, load, share};
    use glisten::verify::{OnGpu, Options, Runner, verify};
    use glisten_emit::{Conventions, Target, emit};
    use glisten_gpu::Gpu;
    use glisten_verify::verify::Demands;

    #[test]
    fn random_programs_draw_the_same_bytes() {
        let mut collected = crate::emit::Collected::new();
        for seed in seeds() {
            let Ok(scene) = scene(&text::fragment(seed)) else { continue };
            let optimized = optimized_scene(&scene);
            assert!(bits(&scene) == bits(&optimized), "seed {seed}");
            let program = &optimized.draws[0].program;
            for target in [Target::Wgsl, Target::Spirv] {
                let emitted = emit(program, glisten::Stage::Fragment, target, &Conventions::default());
                collected.add(&format!("seed {seed}"), emitted.expect("it is emitted"));
            }
        }
        collected.validate();
    }

    /// Judged by the envelopes of the originals. `SPECIALIZE_ALL=1` draws all scenes instead of a share.
    #[test]
    fn scenes_hold_on_the_gpu() {
        let gpu: Gpu = crate::drawing::gpu();
        let mut wrong = Vec::new();
        for path in share() {
            let Some((scene, _)) = load(&path) else { continue };
            let optimized = optimized_scene(&scene);
            let runners = OnGpu::both(&gpu);
            let runners = runners.each_ref().map(|runner| Instead { runner, scene: &optimized });
            let runners = [&runners[0] as &dyn Runner, &runners[1]];
            // Another test compares the same scenes with the population.
            let demands = Demands { likely: false, ..Demands::default() };
            match verify(&scene, &runners, &Options { demands, ..Options::default() }) {
                Ok(verification) if !verification.fails() => {}
                Ok(verification) => wrong.push(format!("{}\n{verification}", path.display())),
                Err(failure) => wrong.push(format!("{}: {failure}", path.display())),
            }
        }
        assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    }
}
