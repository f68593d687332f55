//! Known cases: each is attributed to the right expression.

use super::{BOUND, CauseKind, Examination, ExamineOptions, SpanError, Stability, Trace, examine, trace};
use crate::RenderOptions;
use glisten_front::compiler::{Compiler, Options};
use glisten_front::source::SourceMap;
use glisten_scene::{AttributeData, AttributeValues, MemoryFiles, NoLibrary, Scene, load};

const VERTEX: &str =
    "#version 150\nin vec2 p;\nout vec2 at;\nvoid main() { at = p; gl_Position = vec4(p, 0.0, 1.0); }\n";

/// A program that fills a picture of 16x16 pixels, in which `at` goes from -1 to 1 both ways, with this body of the
/// fragment stage.
fn traced(body: &str) -> (Trace, SourceMap) {
    traced_with(body, "")
}

fn traced_with(body: &str, more: &str) -> (Trace, SourceMap) {
    let (scene, sources) = scene_of(body, more);
    let options = RenderOptions::default();
    (trace(&scene, &options).unwrap_or_else(|found| panic!("{found:?}")), sources)
}

pub(super) fn scene_of(body: &str, more: &str) -> (Scene, SourceMap) {
    scene_with(VERTEX, body, more)
}

/// A program with this vertex stage and this body of the fragment stage, in a picture of 16x16 pixels.
pub(crate) fn scene_with(vertex: &str, body: &str, more: &str) -> (Scene, SourceMap) {
    let scene = "[framebuffer]\nwidth = 16\nheight = 16\n[[draw]]\nvertex = \"a.vert\"\nfragment = \"a.frag\"\n\
        primitive = \"triangle_strip\"\n[draw.attributes]\np = { size = 2, values = [-1, -1, 1, -1, -1, 1, 1, 1] }\n";
    let scene = format!("{scene}{more}");
    let fragment = format!("#version 150\nin vec2 at;\nout vec4 o;\n{body}\n");
    let files = MemoryFiles::new([("a.toml", scene.as_str()), ("a.vert", vertex), ("a.frag", fragment.as_str())]);
    let loaded = load("a.toml", &files, &NoLibrary, &Compiler::new(Options::default()));
    let told: Vec<&str> = loaded.diagnostics.iter().map(|finding| finding.message.as_str()).collect();
    let scene = loaded.scene.unwrap_or_else(|| panic!("{told:?}"));
    (scene, loaded.sources)
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
    assert_eq!(span.kind, CauseKind::Cancellation);
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
    assert_eq!(trace.picture.attachments[0][0][0], 2.25, "the picture is f32's");
}

/// The examination of a body, and the texts and kinds of its causes, worst first.
fn examined(body: &str) -> (Examination, Vec<(String, CauseKind)>) {
    let (scene, sources) = scene_of(body, "");
    let mut options =
        ExamineOptions { bound: BOUND, bound_relative: 0.0, all: false, figures: false, progress: &mut |_, _| true };
    let found = examine(&scene, &mut options).unwrap_or_else(|found| panic!("{found:?}"));
    let causes = found.causes.iter().map(|cause| (sources.snippet(cause.span).to_owned(), cause.kind)).collect();
    (found, causes)
}

/// Two expressions break the same pixels, so that none heals one alone.
#[test]
fn expressions_that_break_the_same_pixels_are_causes_together() {
    let divided = "uniform float z;\nvoid main() { o = vec4(1.0 / z,\n2.0 / z, 0.0, 1.0); }";
    let large = "void main() {\nfloat a = exp(at.x * at.x * 20.0 + 100.0);\nfloat b = exp(at.y * at.y * 20.0 + 100.0);\n\
                 o = vec4(a / (a + 1.0), b / (b + 1.0), 0.0, 1.0); }";
    for (body, wanted) in [
        (divided, ["1.0 / z", "2.0 / z"]),
        (large, ["exp(at.x * at.x * 20.0 + 100.0)", "exp(at.y * at.y * 20.0 + 100.0)"]),
    ] {
        let (found, causes) = examined(body);
        assert_eq!(found.verdict, Stability::Broken);
        let mut texts: Vec<&str> = causes.iter().map(|(text, _)| text.as_str()).collect();
        texts.sort_unstable();
        assert_eq!(texts, wanted);
        assert!(found.causes.iter().all(|cause| cause.harm.is_none() && cause.non_finite > 0), "{:?}", found.causes);
    }
}

#[test]
fn a_cancellation_that_reaches_the_picture_is_a_cause_with_its_harm() {
    let body = "void main() { float x = (at.x + 2.0) * 1e-4; float c = 1.0 - cos(x);\nfloat q = c / (x * x); \
                o = vec4(q, 0.5, at.y * 0.5 + 0.5, 1.0); }";
    let (found, causes) = examined(body);
    assert_eq!(found.verdict, Stability::Degraded);
    assert_eq!(causes[0], ("1.0 - cos(x)".to_owned(), CauseKind::Cancellation));
    let (_, worst) = found.errors.worst().expect("an error");
    let harm = found.causes[0].harm.expect("it is finite");
    assert!(harm > 0.9 * worst && harm <= 1.1 * worst, "{harm} {worst}");
}

#[test]
fn what_does_no_harm_is_not_named() {
    // The cosine cancels near 0, and nobody sees it.
    let body = "void main() { float d = at.x * 0.7 + at.y * 0.3 - 0.1; o = vec4(max(d, 0.0), d * 0.1, 1.0 - at.x * at.x, 1.0); }";
    let (found, causes) = examined(body);
    assert_eq!((found.verdict, causes), (Stability::Stable, vec![]));
}

#[test]
fn a_nan_that_max_may_hide_breaks() {
    let body = "void main() { vec3 h = vec3(at, 0.0) - vec3(at, 0.0); o = vec4(max(normalize(h).x, 0.25)); }";
    let (found, causes) = examined(body);
    assert_eq!(found.verdict, Stability::Broken);
    assert_eq!(causes[0], ("normalize(h)".to_owned(), CauseKind::Division));
    assert_eq!(found.causes[0].harm, None);
    assert!(found.non_finite > 0);
}

/// The verdict on a triangle with these corners in a picture of 17x17 pixels, where the middle has no direction.
fn of_triangle(corners: &str) -> Stability {
    let (mut scene, _) = scene_of("void main() { o = vec4(normalize(gl_FragCoord.xy - vec2(8.5)), 0.0, 1.0); }", "");
    (scene.framebuffer.width, scene.framebuffer.height) = (17, 17);
    let values = corners.split(' ').map(|value| value.parse().expect("a number")).collect();
    let draw = &mut scene.draws[0];
    draw.attributes = vec![Some(AttributeData { size: 2, divisor: 0, values: AttributeValues::Float(values) })];
    draw.vertex_count = 3;
    let mut options =
        ExamineOptions { bound: BOUND, bound_relative: 0.0, all: false, figures: false, progress: &mut |_, _| true };
    examine(&scene, &mut options).unwrap_or_else(|found| panic!("{found:?}")).verdict
}

#[test]
fn the_parts_of_a_clipped_triangle_have_no_edge_between_them() {
    for corners in ["-1 -1 3 -1 -1 3", "-2.5 -2.5 2.5 -2.5 0 9", "-0.9 -0.8 0.9 -0.9 0 0.9"] {
        assert_eq!(of_triangle(corners), Stability::Broken, "{corners}");
    }
    // The edge itself runs through the middle: either side may cover that pixel.
    assert_eq!(of_triangle("-1 -1 1 1 -1 1"), Stability::Stable);
}

#[test]
fn what_the_language_leaves_undefined_breaks() {
    let cases = [
        ("atan(at.y * t, at.x * t)", "", CauseKind::Domain),
        ("float(int(gl_FragCoord.x) / k)", "int(gl_FragCoord.x) / k", CauseKind::Division),
        ("clamp(at.x, 1.0, t)", "", CauseKind::Domain),
        ("smoothstep(1.0, t, at.x)", "", CauseKind::Domain),
    ];
    for (expression, place, kind) in cases {
        let body = format!("uniform float t; uniform int k; void main() {{ o = vec4({expression}); }}");
        let (found, causes) = examined(&body);
        let place = if place.is_empty() { expression } else { place };
        assert_eq!(found.verdict, Stability::Broken, "{expression}");
        assert_eq!(causes, [(place.to_owned(), kind)]);
        assert!(found.causes[0].undefined.is_some() && found.causes[0].harm.is_some_and(|harm| harm > BOUND));
    }
    // Nobody sees it.
    let body = "uniform float t; void main() { o = vec4(atan(at.y * t, at.x * t) * t + 0.5); }";
    assert_eq!(examined(body).0.verdict, Stability::Stable);
}

#[test]
fn a_sum_over_many_steps_accumulates() {
    let body =
        "void main() { float t = 0.0;\nfor (int i = 0; i < 3000; ++i) t += 0.1 + at.x * 1e-3;\n o = vec4(t - 300.0); }";
    let (found, causes) = examined(body);
    assert_eq!(causes[0], ("t += 0.1 + at.x * 1e-3".to_owned(), CauseKind::Accumulation), "{causes:?}");
    assert!(!found.causes[0].ill_posed);
}

/// Chaos, and steps beyond the limit of an explicit method, that begin with uniforms.
#[test]
fn a_loop_that_magnifies_its_uniforms_is_ill_posed() {
    for body in [
        "uniform float r = 3.9; uniform float x0 = 0.35; void main() { float x = x0;\nfor (int i = 0; i < 60; ++i) x = r * x * (1.0 - x);\n\
         o = vec4(x); }",
        "uniform float k = 1e4; uniform float dt = 0.05; void main() { float x = 1.0 + 0.1 * at.x, v = 0.0;\n\
         for (int i = 0; i < 20; ++i) { float a = -k * x;\nx += v * dt;\nv += a * dt; }\no = vec4(x); }",
    ] {
        let (found, causes) = examined(body);
        assert!(
            !causes.is_empty() && found.causes.iter().all(|cause| cause.ill_posed),
            "{causes:?}: {:?}",
            found.causes
        );
    }
    // Whole numbers are exact, and so is how often the loop runs.
    let body = "uniform float count = 3000.0; uniform float step = 0.1; void main() { float t = at.x * 1e-3;\n\
        for (float i = 0.0; i < count; ++i) t += step;\no = vec4(t - 300.0); }";
    let (found, causes) = examined(body);
    assert_eq!(causes[0], ("t += step".to_owned(), CauseKind::Accumulation), "{causes:?}");
    assert!(!found.causes[0].ill_posed);
}

/// The distance is not the problem's: without it the fraction is the same.
#[test]
fn a_far_varying_is_a_rounding_and_not_ill_posed() {
    let vertex = "#version 150\nin vec2 p;\nuniform vec2 origin = vec2(1e6, 3e6);\nout vec2 at;\n\
        void main() { at = p + origin; gl_Position = vec4(p, 0.0, 1.0); }\n";
    let body = "void main() { o = vec4(abs(fract(at * 0.5) - 0.5), 0.0, 1.0); }";
    let (scene, sources) = scene_with(vertex, body, "");
    let mut options =
        ExamineOptions { bound: BOUND, bound_relative: 0.0, all: false, figures: false, progress: &mut |_, _| true };
    let found = examine(&scene, &mut options).unwrap_or_else(|found| panic!("{found:?}"));
    let causes: Vec<_> = found
        .causes
        .iter()
        .map(|cause| (sources.snippet(cause.span).to_owned(), cause.kind, cause.ill_posed))
        .collect();
    assert!(causes.contains(&("at".to_owned(), CauseKind::Rounding, false)), "{causes:?}");
    assert!(causes.iter().all(|cause| !cause.2), "{causes:?}");
}

#[test]
fn a_hash_is_ill_posed() {
    let body = "void main() { o = vec4(fract(sin(dot(gl_FragCoord.xy, vec2(12.9898, 78.233))) * 43758.5453)); }";
    let (found, causes) = examined(body);
    assert_eq!(found.verdict, Stability::Broken);
    assert!(found.causes.iter().all(|cause| cause.ill_posed || !cause.kind.is_decision()), "{causes:?}");
    assert!(found.causes.iter().any(|cause| cause.ill_posed), "{causes:?}");
}

#[test]
fn a_fraction_of_a_large_number_is_unstable_and_not_ill_posed() {
    let body = "uniform float offset = 70000.0; void main() { o = vec4(fract(at.x * 0.37 + offset)); }";
    let (found, causes) = examined(body);
    // The sum loses the digits, and the fraction shows it.
    assert_eq!(causes[0], ("at.x * 0.37 + offset".to_owned(), CauseKind::Rounding), "{causes:?}");
    assert_eq!(causes[1], ("fract(at.x * 0.37 + offset)".to_owned(), CauseKind::Conversion), "{causes:?}");
    assert!(found.causes.iter().all(|cause| !cause.ill_posed), "{causes:?}");
}

#[test]
fn the_varyings_of_a_pixel_are_known() {
    let (scene, _) = scene_of("void main() { o = vec4(at, 0.0, 1.0); }", "");
    let inputs = super::inputs_at(&scene, [8, 8]).unwrap_or_else(|found| panic!("{found:?}"));
    assert_eq!(inputs, [("at".to_owned(), vec![0.0625, -0.0625])]);
}
