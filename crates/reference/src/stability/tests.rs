//! Known cases: each is attributed to the right expression.

use super::{SpanError, Trace, trace};
use crate::RenderOptions;
use glisten_front::compiler::{Compiler, Options};
use glisten_front::source::SourceMap;
use glisten_scene::{MemoryFiles, NoLibrary, load};

const VERTEX: &str =
    "#version 150\nin vec2 p;\nout vec2 at;\nvoid main() { at = p; gl_Position = vec4(p, 0.0, 1.0); }\n";

/// A program that fills a picture of 16x16 pixels, in which `at` goes from -1 to 1 both ways, with this body of the
/// fragment stage.
fn traced(body: &str) -> (Trace, SourceMap) {
    traced_with(body, "")
}

fn traced_with(body: &str, more: &str) -> (Trace, SourceMap) {
    let scene = "[framebuffer]\nwidth = 16\nheight = 16\n[[draw]]\nvertex = \"a.vert\"\nfragment = \"a.frag\"\n\
        primitive = \"triangle_strip\"\n[draw.attributes]\np = { size = 2, values = [-1, -1, 1, -1, -1, 1, 1, 1] }\n";
    let scene = format!("{scene}{more}");
    let fragment = format!("#version 150\nin vec2 at;\nout vec4 o;\n{body}\n");
    let files = MemoryFiles::new([("a.toml", scene.as_str()), ("a.vert", VERTEX), ("a.frag", fragment.as_str())]);
    let loaded = load("a.toml", &files, &NoLibrary, &Compiler::new(Options::default()));
    let told: Vec<&str> = loaded.diagnostics.iter().map(|finding| finding.message.as_str()).collect();
    let scene = loaded.scene.unwrap_or_else(|| panic!("{told:?}"));
    let options = RenderOptions::default();
    (trace(&scene, &options).unwrap_or_else(|found| panic!("{found:?}")), loaded.sources)
}

/// The texts of the causes with their figures, worst first.
fn causes(body: &str) -> Vec<(String, SpanError)> {
    let (trace, sources) = traced(body);
    let causes = trace.spans.iter().filter(|span| span.is_cause());
    causes.map(|span| (sources.snippet(span.span).to_owned(), *span)).collect()
}

fn texts(body: &str) -> Vec<String> {
    causes(body).into_iter().map(|(text, _)| text).collect()
}

#[test]
fn what_only_rounds_is_no_cause() {
    let body = "void main() { vec3 n = normalize(vec3(at, 1.5)); float d = dot(n, n) * 0.7 + at.x * at.x; \
                o = vec4(sqrt(d), exp2(d), n.x, mix(2.0, 3.0, d)); }";
    assert_eq!(texts(body), [] as [&str; 0]);
    let (trace, _) = traced(body);
    assert!(trace.output_error > 0.0 && trace.output_error < 1e-6, "{}", trace.output_error);
    assert!(trace.picture.covered.iter().all(|covered| *covered));
}

#[test]
fn a_difference_that_cancels_is_named_and_not_what_follows() {
    let body = "void main() { float x = at.x * 1e-3 + 2e-3; float c = 1.0 - cos(x);\nfloat q = c / (x * x); \
                o = vec4(q, q + 1.0, c * 5.0, 1.0); }";
    let found = causes(body);
    assert_eq!(found.len(), 1, "{found:?}");
    let (text, span) = &found[0];
    assert_eq!(text, "1.0 - cos(x)");
    assert!(span.canceled_bits > 17.0 && span.mean_lost_bits > 10.0, "{span:?}");
    assert!(span.condition > 1e5, "the difference is ill-conditioned: {span:?}");
    assert_eq!(span.added, 0.0, "the difference itself is exact");
    assert_eq!(span.evaluations, 256);
}

#[test]
fn a_large_exponent_is_laid_at_the_power() {
    let found = causes("void main() { float c = 0.9999 + at.x * 1e-5; o = vec4(pow(c, 20000.0) * 2.0); }");
    assert_eq!(found.iter().map(|(text, _)| text.as_str()).collect::<Vec<_>>(), ["pow(c, 20000.0)"]);
    let span = found[0].1;
    assert!(span.condition > 1e3, "{span:?}");
    assert!(span.added_ulps > 1.0, "the logarithm's rounding is multiplied, too: {span:?}");
}

#[test]
fn a_vector_too_short_to_normalize_bears_infinity_or_nan_there() {
    let body =
        "void main() { vec3 v = vec3(1e-30) * (at.x + 2.0); vec3 n = normalize(v); o = vec4(n * 0.5, n.x + 1.0); }";
    let found = causes(body);
    assert_eq!(found.iter().map(|(text, _)| text.as_str()).collect::<Vec<_>>(), ["normalize(v)"]);
    let span = found[0].1;
    assert_eq!((span.births, span.births_in_both), (3 * 256, 0), "f64 has no trouble");
    let message = span.diagnostic().message;
    assert_eq!(message, "this is finite, and in f32 it is not");
}

#[test]
fn what_no_precision_can_save_is_told_apart() {
    let found = causes("void main() { vec2 zero = at - at; o = vec4(1.0 / zero.x); }");
    let (text, span) = &found[0];
    assert_eq!(text, "1.0 / zero.x");
    assert_eq!((span.births, span.births_in_both), (256, 256));
}

#[test]
fn a_branch_that_f32_takes_otherwise_is_counted_at_its_condition() {
    // In f32 the sum is 1 everywhere.
    let body =
        "void main() { float tiny = 1e-9 * (at.x + 2.0); if (1.0 + tiny > 1.0) o = vec4(1.0); else o = vec4(0.0); }";
    let found = causes(body);
    assert_eq!(found.iter().map(|(text, _)| text.as_str()).collect::<Vec<_>>(), ["1.0 + tiny > 1.0"]);
    assert_eq!((found[0].1.disagreements, found[0].1.decisions), (256, 256));
    let selected = causes("void main() { float tiny = 1e-9 * (at.x + 2.0); o = vec4(1.0 + tiny > 1.0 ? 2.0 : 3.0); }");
    assert_eq!(selected[0].1.disagreements, 256);
    let jump = causes("void main() { o = vec4(floor(at.x * 1e-9 + 1.0)); }");
    let (text, span) = &jump[0];
    assert_eq!(text, "floor(at.x * 1e-9 + 1.0)");
    assert_eq!(span.disagreements, 128, "where x is negative f64 stays below 1");
}

#[test]
fn figures_do_not_depend_on_threads() {
    let body =
        "void main() { float s = 0.0; for (int i = 0; i < 5; ++i) s += sin(at.x * float(i)) / 3.0; o = vec4(s); }";
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a pool");
    let (alone, _) = one.install(|| traced(body));
    let (many, _) = traced(body);
    assert_eq!(alone.spans, many.spans);
}

#[test]
fn what_is_the_same_everywhere_counts_once() {
    let (trace, sources) = traced("uniform float u = 2.0; void main() { o = vec4(sqrt(u * 3.0) + at.x); }");
    let found = trace.spans.iter().find(|span| sources.snippet(span.span) == "sqrt(u * 3.0)");
    assert_eq!(found.map(|span| span.evaluations), Some(1));
}

#[test]
fn a_texel_that_f32_misses_is_laid_at_the_lookup() {
    // In f64 the coordinate is left of the middle; in f32 it is on it, and so in the right texel.
    let body = "uniform sampler2D tex; void main() { o = texture(tex, vec2(0.5 - 1e-9 * (at.x + 2.0), 0.5)) * 3.0; }";
    let texture = "[draw.textures]\ntex = { width = 2, height = 1, values = [0.25, 0, 0, 1, 0.75, 0, 0, 1] }\n";
    let (trace, sources) = traced_with(body, texture);
    let causes: Vec<&SpanError> = trace.spans.iter().filter(|span| span.is_cause()).collect();
    let texts: Vec<&str> = causes.iter().map(|span| sources.snippet(span.span)).collect();
    assert_eq!(texts, ["texture(tex, vec2(0.5 - 1e-9 * (at.x + 2.0), 0.5))"]);
    assert_eq!((causes[0].error, trace.output_error), (0.5, 1.5));
    assert_eq!(trace.picture.attachments[0][0][0], 0.75, "the picture is f64's");
}
