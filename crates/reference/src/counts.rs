//! [`counts`]: everything that a picture takes, step by step.
//!
//! *In:* a scene. *Out:* for each draw the [`Step`]s that its stages execute, and how often, counted while the reference draws
//! in f32.
//!
//! *Holds:* the counts are the same on every machine and with any number of threads. A step counts once in each invocation
//! that executes it; what only constants determine, what no output depends on, and helper invocations do not count. Nothing
//! is moved out of an invocation because it depends on uniforms alone: hardly any GPU does that. *Not done here:* weights; and
//! see [`work`](crate::work()) for the operations of floats alone.

use crate::RenderOptions;
use crate::domain::F32;
use crate::exec::{Event, Form, Observer, Order, Step};
use crate::pipeline::{self, Study};
use glisten_front::diagnostic::Diagnostic;
use glisten_scene::Scene;
use rustc_hash::FxHashMap;
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

/// How often each step is executed.
pub type Counts = BTreeMap<Step, u64>;

/// Counts for one piece of the drawing.
#[derive(Debug)]
struct Counter {
    steps: FxHashMap<Step, u64>,
    totals: Arc<Mutex<Vec<Counts>>>,
}

impl Observer<F32> for Counter {
    fn see(&mut self, _event: &Event<'_, F32>) {}

    fn count(&mut self, step: Step, lanes: u32) {
        *self.steps.entry(step).or_default() += u64::from(lanes);
    }

    fn finish(self: Box<Self>, order: Order) {
        let mut totals = self.totals.lock().unwrap_or_else(PoisonError::into_inner);
        let Some(counts) = totals.get_mut(order.draw) else { return };
        // Sums do not depend on their order.
        #[expect(clippy::iter_over_hash_type, reason = "the sums are the same in any order")]
        for (step, count) in self.steps {
            *counts.entry(step).or_default() += count;
        }
    }
}

/// Counts what each draw of a scene executes.
///
/// # Errors
/// As [`render`](crate::render).
pub fn counts(scene: &Scene, options: &RenderOptions) -> Result<Vec<Counts>, Vec<Diagnostic>> {
    let totals = Arc::new(Mutex::new(vec![Counts::new(); scene.draws.len()]));
    let shared = Arc::clone(&totals);
    let make = move || -> Box<dyn Observer<F32>> {
        Box::new(Counter { steps: FxHashMap::default(), totals: Arc::clone(&shared) })
    };
    let study = Study { observers: Some(&make), form: Form::Counted, ..Study::NONE };
    pipeline::render_studied::<F32>(scene, options, study)?;
    let totals = totals.lock().unwrap_or_else(PoisonError::into_inner);
    Ok(totals.clone())
}

#[cfg(test)]
mod tests {
    use super::{Counts, Step, counts};
    use crate::RenderOptions;
    use glisten_front::compiler::{Compiler, Options};
    use glisten_scene::{MemoryFiles, NoLibrary, Scene, load};

    const VERTEX: &str =
        "#version 150\nin vec2 p;\nout vec2 at;\nvoid main() { at = p; gl_Position = vec4(p, 0.0, 1.0); }\n";

    /// A quad of 16x16 pixels that this body shades, with `u = 2.0`.
    fn scene_of(body: &str) -> Scene {
        let scene = "[framebuffer]\nwidth = 16\nheight = 16\n[[draw]]\nvertex = \"a.vert\"\nfragment = \"a.frag\"\n\
            primitive = \"triangle_strip\"\n[draw.attributes]\np = { size = 2, values = [-1, -1, 1, -1, -1, 1, 1, 1] }\n\
            [draw.uniforms]\nu = 2.0\n[draw.textures]\nt = { width = 2, height = 2, values = [1,0,0,1, 0,1,0,1, 0,0,1,1, 1,1,1,1], filter = \"linear\" }\n";
        let fragment =
            format!("#version 150\nin vec2 at;\nout vec4 o;\nuniform float u;\nuniform sampler2D t;\n{body}\n");
        let files = MemoryFiles::new([("a.toml", scene), ("a.vert", VERTEX), ("a.frag", fragment.as_str())]);
        let loaded = load("a.toml", &files, &NoLibrary, &Compiler::new(Options::default()));
        let told: Vec<&str> = loaded.diagnostics.iter().map(|finding| finding.message.as_str()).collect();
        loaded.scene.unwrap_or_else(|| panic!("{told:?}"))
    }

    fn counted(body: &str) -> Counts {
        let options = RenderOptions { mark_edges: false, ..RenderOptions::default() };
        counts(&scene_of(body), &options).expect("the scene can be drawn").remove(0)
    }

    fn of(counts: &Counts, name: &str) -> u64 {
        counts.iter().filter(|(step, _)| step.name == name).map(|(_, count)| count).sum()
    }

    #[test]
    fn each_step_counts_where_it_is_executed() {
        // The body, and steps with their counts in 256 fragments.
        let cases: &[(&str, &[(&str, u64)])] = &[
            ("void main() { o = vec4(at.x * u); }", &[("*", 256), ("vertex", 4), ("fragment", 256), ("+", 0)]),
            // Uniforms alone: in every invocation. Constants alone: in none.
            ("void main() { o = vec4(pow(u, 3.0) + sin(1.0)); }", &[("pow", 256), ("sin", 0), ("+", 256)]),
            // What is not executed does not count; half of the fragments are left of the middle.
            (
                "void main() { if (at.x < 0.0) o = vec4(sqrt(at.y + u)); else o = vec4(u); }",
                &[("sqrt", 128), ("comparison", 256), ("branch", 256)],
            ),
            // Nor does an operand that is not chosen: never, or in half of the fragments.
            (
                "void main() { o = u < 1.0 ? texture(t, at) : vec4(at.x > 2.0 ? exp(at.y) : u); }",
                &[("lookup", 0), ("exp", 0)],
            ),
            (
                "void main() { o = vec4(at.x < 0.0 ? sqrt(at.y + u) : sin(at.y)); }",
                &[("sqrt", 128), ("sin", 128), ("selection", 256)],
            ),
            (
                "void main() { o = vec4(at.x < 0.0 ? u : at.y < 0.0 ? exp(u) : log(u)); }",
                &[("exp", 64), ("log", 64), ("comparison", 384)],
            ),
            ("void main() { o = vec4(at.x < 0.0 && exp(at.y) > u); }", &[("exp", 128), ("comparison", 384)]),
            ("void main() { o = vec4(at.x < 0.0 || exp(at.y) > u || sin(at.y) > u); }", &[("exp", 128), ("sin", 112)]),
            (
                "void main() { float unread = at.x < 0.0 ? exp(at.x) : u; o = vec4(at.y); }",
                &[("exp", 0), ("comparison", 0)],
            ),
            // What nothing reads does not count.
            ("void main() { float unread = exp(at.x); o = vec4(at.y); }", &[("exp", 0)]),
            ("void main() { float x = 0.0; for (int i = 0; i < 5; i++) x += at.x; o = vec4(x); }", &[("+", 1280)]),
            ("void main() { o = texture(t, at) + textureLod(t, at, 0.0); }", &[("lookup", 512), ("+", 1024)]),
            ("void main() { if (at.x < 0.0) discard; o = vec4(1.0); }", &[("fragment", 256)]),
            ("void main() { o = mat4(u) * vec4(at, at); }", &[("*", 4096), ("+", 3072)]),
            ("void main() { o = vec4(normalize(vec3(at, u)), dot(at, at)); }", &[("normalize", 256), ("dot", 256)]),
        ];
        for (body, expected) in cases {
            let counts = counted(body);
            for (name, count) in *expected {
                assert_eq!(of(&counts, name), *count, "{name} of {body}: {counts:?}");
            }
        }
    }

    #[test]
    fn the_operations_of_floats_are_those_that_are_executed() {
        // The operations and lookups of 256 fragments; a comparison of uniforms is made once.
        let cases = [
            ("void main() { o = u < 1.0 ? texture(t, at) : vec4(at.x * u); }", [257, 0]),
            ("void main() { o = at.x < 0.0 ? texture(t, at) : vec4(at.y * u); }", [256 + 128 * 4 + 128, 128]),
            ("void main() { o = vec4(at.x < 0.0 && sin(at.x) > at.y); }", [256 + 128 * 2 + 256, 0]),
        ];
        let options = RenderOptions { mark_edges: false, ..RenderOptions::default() };
        for (body, expected) in cases {
            let work = crate::work(&scene_of(body), &options).expect("the scene can be drawn").remove(0);
            assert_eq!([work.fragment_operations, work.texture_lookups], expected, "{body}");
        }
    }

    #[test]
    fn sizes_are_told() {
        let counts = counted("void main() { o = texture(t, at) * length(vec3(at, u)); }");
        let step = |name: &str| counts.keys().find(|step| step.name == name).copied().expect("it is executed");
        assert_eq!(step("lookup"), Step { name: "lookup", results: 4, argument: 4 });
        assert_eq!(step("length"), Step { name: "length", results: 1, argument: 3 });
        assert_eq!(step("fragment"), Step { name: "fragment", results: 4, argument: 2 });
    }

    #[test]
    fn threads_change_nothing_and_all_names_are_known() {
        let body =
            "void main() { o = vec4(0.0); for (int i = 0; i < int(at.x * 4.0 + 5.0); i++) o += fwidth(at.y) * u; }";
        let names = Step::names();
        let here = counted(body);
        assert!(here.keys().all(|step| names.contains(&step.name)), "{here:?}");
        let pool = rayon::ThreadPoolBuilder::new().num_threads(5).build().expect("threads");
        assert_eq!(pool.install(|| counted(body)), here);
    }
}
