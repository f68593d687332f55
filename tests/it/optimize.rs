//! `compile -O`: what reaches no output is left out, and nothing else changes.

use glisten::emit::{Conventions, Emitted, Reflection, Target, emit, left_out, optimize, reflect};
use glisten::scene::{self, MemoryFiles, Scene};
use glisten::{Compiler, Options, Program, Source, Stage};
use std::collections::BTreeSet;

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

/// A scene of 4 by 4 pixels, with a triangle that covers them.
fn scene_of(vertex: &str, fragment: &str) -> (Scene, glisten::source::SourceMap) {
    const SCENE: &str = "framebuffer = { width = 4, height = 4 }\n[[draw]]\nvertex = \"a.vert\"\nfragment = \"a.frag\"\n\
        [draw.attributes]\np = { size = 3, values = [-1, -1, 0.5, 3, -1, -0.5, -1, 3, 0.25] }\n";
    let [vertex, fragment] = [vertex, fragment].map(|text| format!("#version 150\n{text}"));
    let files = MemoryFiles::new([("s.toml", SCENE), ("a.vert", &vertex), ("a.frag", &fragment)]);
    let loaded = scene::load("s.toml", &files, &Compiler::new(Options::default()));
    let messages: Vec<_> = loaded.diagnostics.iter().map(|found| found.message.clone()).collect();
    (loaded.scene.unwrap_or_else(|| panic!("{messages:?}\n{vertex}\n{fragment}")), loaded.sources)
}

/// Checks that a program is the same picture, bit for bit, when it is optimized, and when nothing of it is known to a specialization.
fn assert_drawn_alike(vertex: &str, fragment: &str) {
    let (scene, sources) = scene_of(vertex, fragment);
    let drawn = crate::specialize::bits(&scene);
    assert!(
        drawn.is_ok() && drawn == crate::specialize::bits(&optimized_scene(&scene)),
        "optimized:\n{vertex}\n{fragment}"
    );
    let left = glisten::specialize::specialize_scene(&scene, &sources, &[]).scene;
    assert!(drawn == crate::specialize::bits(&left), "specialized:\n{vertex}\n{fragment}");
}

/// The effects of a function may depend on the variable that takes its value, and the next stage reads any member of a struct.
#[test]
fn what_acts_keeps_its_operands() {
    const STEP: &str = "vec4 sum = vec4(0.0);\nfloat next(float t) { sum += vec4(t * 0.1); return t * 0.5 + 0.1; }\n";
    let cases = [
        (STEP, "float t = v.x; for (int i = 0; i < 3; ++i) t = next(t); color = sum;"),
        (STEP, "vec2 t = v.xy; for (int i = 0; i < 3; ++i) t.x = next(t.x); color = sum;"),
        (STEP, "float t[2]; t[0] = v.x; for (int i = 0; i < 3; ++i) t[0] = next(t[0]); color = sum;"),
        (STEP, "float t = v.x; t = v.y; t = t > 0.5 ? next(1.0) : 0.0; color = sum;"),
        (STEP, "float t = v.x; t = v.y; bool b = t > 0.5; b = b && next(t) > 0.0; color = sum;"),
        (STEP, "float t = v.x; t *= 2.0; t += next(t); color = sum;"),
        (STEP, "float t = v.x, s; for (int i = 0; i < 3; ++i) t = (s = t * 0.5); color = vec4(s);"),
        (STEP, "float t = v.x, s; for (int i = 0; i < 3; ++i) t = modf(t * 3.5, s); color = vec4(s);"),
        (STEP, "float t = v.x; int n = 0; for (int i = 0; i < 3; ++i) t = t * float(n++); color = vec4(n);"),
        ("float f(float t) { if (t > 0.5) discard; return t; }\n", "float t = v.x; t = v.y; t = f(t); color = v;"),
        ("void f(out float o, float t) { o = t; }\n", "float t = v.x, s; t = v.y; f(s, t); color = vec4(s);"),
        (
            "struct S { float a; vec2 b; };\nvec4 sum = vec4(0.0);\nS next(S s) { sum += s.b.xyxy; s.b *= s.a; return s; }\n",
            "S s = S(0.5, v.xy); s = next(s); s = next(s); color = sum;",
        ),
        (
            "float s = 0.5;\nfloat o = 0.0;\nfloat f(float t) { o = t; return t; }\n",
            "s = v.x; s = f(s); color = vec4(o);",
        ),
    ];
    for (declarations, statements) in cases {
        let text = format!("in vec4 v;\nout vec4 color;\n{declarations}void main() {{ {statements} }}\n");
        assert_drawn_alike(
            "in vec3 p;\nout vec4 v;\nvoid main() { gl_Position = vec4(p, 1.0); v = vec4(p * 0.5 + 0.5, 0.7); }\n",
            &text,
        );
    }
    let passed = |statements: &str| {
        format!(
            "in vec3 p;\nstruct S {{ vec2 a; vec2 b; }};\nout S v;\nvoid main() {{ gl_Position = vec4(p, 1.0); {statements} }}\n"
        )
    };
    for statements in [
        "S s; s.a = p.xy; s.b = p.yx; v = s;",
        "S s = S(p.yy, p.xx); s.b *= 0.5; v = s;",
        "S s[2]; s[1].a = p.xy; s[1].b = p.yx; v = s[1];",
    ] {
        let fragment =
            "struct S { vec2 a; vec2 b; };\nin S v;\nout vec4 color;\nvoid main() { color = vec4(v.b, v.a); }\n";
        assert_drawn_alike(&passed(statements), fragment);
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
    scene.with_programs(&optimize)
}

#[cfg(feature = "gpu")]
mod drawn {
    use super::optimized_scene;
    use crate::random::{scene, seeds, text};
    use crate::specialize::{bits, load, share};
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

    /// Other tests draw what `compile` writes by default; this one draws what `compile -O0` does. `SPECIALIZE_ALL=1` draws all
    /// scenes instead of a share.
    #[test]
    fn whole_programs_hold_on_the_gpu() {
        let gpu: Gpu = crate::drawing::gpu();
        let mut wrong = Vec::new();
        for path in share() {
            let Some((scene, _)) = load(&path) else { continue };
            let runners = OnGpu::both(&gpu).map(|runner| runner.whole(true));
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

    /// The driver gets what `compile` writes by default: WGSL cannot hold what this program computes for nothing.
    #[test]
    fn compiled_programs_are_drawn() {
        let levels: String = (0..100).map(|level| format!("if (v > {level}.0) {{ dead += 1.0; ")).collect();
        let body = format!("float dead = v; {levels}{} color = vec4(v, 0.5, 0.25, 1.0);", "}".repeat(100));
        let fragment = format!("in float v; out vec4 color; void main() {{ {body} }}");
        let (scene, _) =
            super::scene_of("in vec4 p; out float v; void main() { v = p.x; gl_Position = p; }", &fragment);
        let gpu: Gpu = crate::drawing::gpu();
        let [spirv, wgsl] = OnGpu::both(&gpu);
        let verification = verify(&scene, &[&spirv as &dyn Runner, &wgsl], &Options::default());
        assert!(verification.is_ok_and(|verification| verification.holds()));
        assert!(wgsl.whole(true).draw(&scene).is_err(), "WGSL holds the whole program");
    }
}
