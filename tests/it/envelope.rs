//! The envelope compared with lavapipe: what it excuses, how wide it is, what its own rules are based on, and which
//! operations it is attributed to.
//!
//! Figures of the docs are printed by `cargo test --test it -- envelope --nocapture`. Needs a Vulkan software adapter.

#![expect(clippy::print_stdout, reason = "figures of the docs are printed here")]

use crate::drawing::{as_on_vulkan, from_disk, from_texts, gpu, loaded, reference, strict};
use crate::support::{compiler, fixture};
use glisten::scene::{MemoryFiles, Scene, load};
use glisten::specialize::specialize_scene;
use glisten::verify::Options;
use glisten_gpu::{Gpu, Via};
use glisten_reference::Precision;
use glisten_reference::domain::faults::Faults;
use glisten_reference::domain::{Profile, rules};
use glisten_scene::compare::{Criterion, Verdict, shares};
use glisten_scene::picture::Picture;
use glisten_verify::verify::Expected;

/// A square over the window, 64x64, drawn by a fragment shader.
fn square(fragment: &str, format: &str) -> Scene {
    let text = format!(
        "[framebuffer]\nwidth = 64\nheight = 64\nformat = \"{format}\"\n[[draw]]\nvertex = \"nothing.vert\"\n\
         fragment = \"a.frag\"\nprimitive = \"triangle_strip\"\nvertex_count = 4\n"
    );
    let fragment = format!("#version 150\nin vec2 place;\nout vec4 color;\n{fragment}\n");
    let vertex = fixture("scenes/core/nothing.vert");
    let files =
        MemoryFiles::new([("a.toml", text.as_str()), ("nothing.vert", vertex.as_str()), ("a.frag", fragment.as_str())]);
    loaded("a.toml", load("a.toml", &files, &compiler()))
}

fn drawn(gpu: &Gpu, scene: &Scene) -> Picture {
    gpu.render(scene, Via::Spirv).expect("it draws").picture
}

#[test]
fn known_faults_explain_what_the_strict_envelope_leaves_outside() {
    let gpu = gpu();
    let scene = from_disk("fixtures/scenes/core/behind_the_eye_noperspective.toml");
    let picture = drawn(&gpu, &scene);
    let judged = |options: &Options<'_>| {
        let mut expected = Expected::new(&scene, options).expect("the reference draws it");
        expected.compare(&picture).expect("the reference draws it")
    };
    assert!(judged(&strict()).fails(), "it holds without");
    let verdict = judged(&Options::default());
    assert!(!verdict.fails(), "{verdict:?}");
    let found: Vec<&str> = verdict.known_faults.iter().map(|count| count.fault).collect();
    assert_eq!(found, ["clipped_noperspective"]);
}

/// No pixel is wrong because of the sign of a zero: a driver may fold `x * 0.0`, and keeps the sign where 0 is a uniform. What no zero
/// explains is wrong.
#[test]
fn no_pixel_is_wrong_because_of_the_sign_of_a_zero() {
    let vertex = fixture("scenes/core/nothing.vert");
    let sign = |of: &str| format!("o = vec4(float(floatBitsToUint({of}) >> 31));");
    let bodies = [
        sign("q.x * a"),
        sign("q.x * 0.0"),
        sign("-0.0 * abs(q.x)"),
        sign("a - floor(q.x * 0.5 + 0.5)"),
        sign("ceil(q.x * 0.5 - 0.5) + a"),
        sign("mix(-a * abs(q.x), 1.0, a)"),
        sign("min(-a * abs(q.x), 0.0)"),
        sign("dot(vec3(a), vec3(q * 0.5 - 1.0, -1.0))"),
        sign("(mat2(a) * (q * 0.5 - 1.0)).x"),
        "o = vec4(atan(q.x * a, -1.0));".to_owned(),
        "o = vec4(atan(q.x * 0.0, -1.0));".to_owned(),
        "o = vec4(1.0 / (q.x * a) > 0.0 ? 1.0 : 0.25);".to_owned(),
        "o = vec4(1.0 / (q.x * 0.0) > 0.0 ? 1.0 : 0.25);".to_owned(),
        "vec3 d = 1.0 / vec3(q.x * a, q.y, 1.0); o = vec4(d.x > 0.0 ? 1.0 : 0.25);".to_owned(),
    ];
    let (gpu, options) = (gpu(), Options::default());
    let mut wrong = Vec::new();
    for body in bodies {
        let fragment = format!(
            "#version 330\nin vec2 place; uniform float a; out vec4 o;\nvoid main() {{ vec2 q = place * 2.0 - 1.0; {body} }}\n"
        );
        let text = "[framebuffer]\nwidth = 16\nheight = 16\n[[draw]]\nvertex = \"nothing.vert\"\nfragment = \"a.frag\"\n\
                    primitive = \"triangle_strip\"\nvertex_count = 4\n[draw.uniforms]\na = 0.0\n";
        let files =
            MemoryFiles::new([("a.toml", text), ("nothing.vert", vertex.as_str()), ("a.frag", fragment.as_str())]);
        let read = load("a.toml", &files, &compiler());
        let scene = read.scene.expect("the scene is right");
        let left = specialize_scene(&scene, &read.sources, &[]).scene;
        let mut expected = Expected::new(&scene, &options).expect("the reference draws it");
        let mut n_wrong = |picture: &Picture| {
            let verdict = expected.compare(picture).expect("the reference draws it");
            verdict.outside.max(verdict.outside_likely)
        };
        let [before, after] = [&scene, &left].map(|scene| drawn(&gpu, scene));
        let mut moved = before.clone();
        moved.attachments.iter_mut().flatten().for_each(|color| color[0] += 50.0);
        let found = [&before, &after, &moved].map(&mut n_wrong);
        if found[..2] != [0, 0] || found[2] < 100 {
            wrong.push(format!("{body}: {found:?}"));
        }
        if before.attachments != after.attachments {
            wrong.push(format!("{body}: the residual draws other bits"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// A triangle whose third corner is behind the eye. Where sides of the window cut it, a new corner has w = 0, and Mesa derives
/// NaN from the position there.
#[test]
fn noperspective_through_the_eye_is_linear_in_the_window() {
    let text = "framebuffer = { width = 64, height = 64 }\n[[draw]]\nvertex = \"a.vert\"\nfragment = \"a.frag\"\n[draw.attributes]\n\
                p = { size = 4, values = [-2, -1, -0.5, 1, 2, -1, -0.5, 1, 0, 3, -3.5, -2] }\n\
                c = { size = 3, values = [1, 0, 0, 0, 1, 0, 0, 0, 1] }\n";
    let vertex =
        "#version 150\nin vec4 p; in vec3 c;\nnoperspective out vec3 v;\nvoid main() { gl_Position = p; v = c; }\n";
    let fragment = "#version 150\nnoperspective in vec3 v;\nout vec4 o;\nvoid main() { o = vec4(v, 1.0); }\n";
    let scene = from_texts([("a.toml", text), ("a.vert", vertex), ("a.frag", fragment)]);
    let options = Options::default();
    let mut expected = Expected::new(&scene, &options).expect("the reference draws it");
    let picture = expected.picture();
    let covered = (0..64 * 64).filter(|pixel| picture.covered[*pixel]);
    let red = |pixel: usize| {
        let [x, y] = [pixel % 64, pixel / 64].map(|place| (place as f64 + 0.5) / 32.0 - 1.0);
        // 1 at (-2, -1), 0 at (2, -1), and 0 at (0, -1.5), which is the third corner over its w.
        1.5 - 0.25 * x - y
    };
    let errors: Vec<f64> = covered.map(|pixel| (picture.attachments[0][pixel][0] - red(pixel)).abs()).collect();
    assert!(errors.len() > 200 && errors.iter().all(|error| *error < 1e-9), "{errors:?}");
    let verdict = expected.compare(&drawn(&gpu(), &scene)).expect("the reference draws it");
    // The driver has NaN at each of these pixels, which no driver may.
    assert_eq!((verdict.outside, verdict.non_finite_cpu), (0, 0), "{verdict:?}");
    assert_eq!(verdict.non_finite_gpu > 0, verdict.fails(), "{verdict:?}");
}

/// For the channels of covered pixels: the width of the envelope, and lavapipe's error.
fn widths_and_errors(picture: &Picture, reference: &Picture) -> Vec<(f64, f64)> {
    let intervals = &reference.intervals.as_ref().expect("it has envelopes")[0];
    let mut pairs = Vec::new();
    for pixel in (0..intervals.len()).filter(|pixel| picture.covered[*pixel] && reference.covered[*pixel]) {
        let (gpu, cpu) = (picture.attachments[0][pixel], reference.attachments[0][pixel]);
        let channels = intervals[pixel].iter().zip(gpu).zip(cpu).take(3);
        pairs.extend(channels.map(|((range, gpu), cpu)| (range.width(), (gpu - cpu).abs())));
    }
    pairs
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

#[test]
fn the_envelope_is_not_much_wider_than_what_lavapipe_makes_of_it() {
    let gpu = gpu();
    println!("lighting scenes at exponent 32, median width of the envelope and lavapipe's error:");
    for name in ["blinn_phong", "phong", "blinn_phong_vertex", "phong_vertex"] {
        let text = fixture(&format!("scenes/{name}.toml")).replace("../programs/", "").replace("40.0", "32.0");
        let (vertex, fragment) = (fixture(&format!("programs/{name}.vert")), fixture(&format!("programs/{name}.frag")));
        let (vertex_name, fragment_name) = (format!("{name}.vert"), format!("{name}.frag"));
        let files = MemoryFiles::new([
            ("a.toml", text.as_str()),
            (vertex_name.as_str(), vertex.as_str()),
            (fragment_name.as_str(), fragment.as_str()),
        ]);
        let scene = loaded("a.toml", load("a.toml", &files, &compiler()));
        let (picture, reference) = (drawn(&gpu, &scene), reference(&scene, Precision::Envelope));
        let verdict = Verdict::new(&picture, &reference, Criterion::Envelope);
        let pairs = widths_and_errors(&picture, &reference);
        let width = median(pairs.iter().map(|pair| pair.0).collect());
        let largest = pairs.iter().map(|pair| pair.1).fold(0.0, f64::max);
        let typical = median(pairs.iter().map(|pair| pair.1).collect());
        println!(
            "  {name:20} width {width:.2e}, largest error {largest:.2e} (ratio {:.2}), median error {typical:.2e} (ratio \
             {:.0}), undecided {} of {}",
            width / largest,
            width / typical,
            verdict.undecided,
            verdict.covered
        );
        assert!(verdict.holds(false), "{name}: {verdict:?}");
        assert!(width < 20.0 * largest, "{name}");
        assert!(verdict.undecided * 100 < verdict.covered, "{name}");
    }
}

#[test]
fn a_bound_is_laid_at_the_expression_that_makes_it() {
    let body = "void main() { float c = 0.5 + 0.5 * place.x; color = vec4(pow(c, 200.0), c, 0, 1); }";
    let scene = square(body, "rgba32float");
    let of = |channel: usize| {
        let options = as_on_vulkan(Precision::Envelope, Faults::NONE);
        glisten_reference::explain(&scene, &options, [54, 20], 0, channel).expect("the pixel is drawn")
    };
    let (red, green) = (of(0), of(1));
    let share = |found: &[glisten_reference::Contribution], name: &str| {
        found.iter().filter(|one| one.operation == name).map(|one| one.share).fold(0.0, f64::max)
    };
    assert!(share(&red, "pow") > 0.2 && share(&red, "interpolation") > 0.2, "{red:?}");
    assert!(red.windows(2).all(|pair| pair[0].share >= pair[1].share), "{red:?}");
    assert!(green.iter().all(|one| one.operation != "pow" || one.share == 0.0), "{green:?}");
    let options = as_on_vulkan(Precision::Envelope, Faults::NONE);
    assert!(glisten_reference::explain(&scene, &options, [64, 10], 0, 1).is_err(), "there is no such pixel");
    assert_eq!(glisten_reference::explain(&scene, &options, [0, 0], 0, 1), Ok(Vec::new()), "nothing is drawn there");
}

/// The largest error of a channel against f64.
fn error(gpu: &Gpu, fragment: &str, channel: usize) -> f64 {
    let scene = square(fragment, "rgba32float");
    let (picture, exact) = (drawn(gpu, &scene), reference(&scene, Precision::F64));
    let pairs = picture.attachments[0].iter().zip(&exact.attachments[0]);
    pairs.map(|(gpu, cpu)| (gpu[channel] - cpu[channel]).abs()).fold(0.0, f64::max)
}

#[track_caller]
fn measured(what: &str, found: f64, allowed: f64, unit: &str) {
    println!("  {what:44} {found:9.2e} of {allowed:9.2e} {unit}");
    assert!(found <= allowed, "{what}");
}

/// How far off the interpolated position is, in pixels. If vertices are between points of the grid for coverage, a
/// varying with a steep slope shows whether it is interpolated between the snapped positions.
fn snapping(gpu: &Gpu) -> f64 {
    let text = "[framebuffer]\nwidth = 64\nheight = 64\n[[draw]]\nvertex = \"a.vert\"\nfragment = \"a.frag\"\n\
                primitive = \"triangles\"\n[draw.attributes]\n\
                p = { size = 2, values = [-0.90005, -0.90005, 0.90005, -0.9, -0.9, 0.90005] }\n\
                v = { size = 1, values = [0, 57.6, 0] }\n";
    let vertex =
        "#version 150\nin vec2 p;\nin float v;\nout float f;\nvoid main() { f = v; gl_Position = vec4(p, 0, 1); }\n";
    let fragment = "#version 150\nin float f;\nout vec4 color;\nvoid main() { color = vec4(f, 0, 0, 1); }\n";
    let files = MemoryFiles::new([("a.toml", text), ("a.vert", vertex), ("a.frag", fragment)]);
    let scene = loaded("a.toml", load("a.toml", &files, &compiler()));
    let (picture, exact) = (drawn(gpu, &scene), reference(&scene, Precision::F64));
    // The slope is one per pixel.
    let pairs = picture.attachments[0].iter().zip(&exact.attachments[0]).zip(&picture.covered);
    pairs.filter(|(_, covered)| **covered).map(|((gpu, cpu), _)| (gpu[0] - cpu[0]).abs()).fold(0.0, f64::max)
}

/// How far from the middle between two 8-bit steps a number may be that is stored as the farther step.
fn storing(gpu: &Gpu) -> f64 {
    let body = "void main() { color = vec4(gl_FragCoord.x / 64.0, gl_FragCoord.y / 64.0, (gl_FragCoord.x + 64.0 * \
                gl_FragCoord.y) / 4192.0, 1); }";
    let (bytes, floats) = (drawn(gpu, &square(body, "rgba8unorm")), drawn(gpu, &square(body, "rgba32float")));
    let pairs = bytes.attachments[0].iter().flatten().zip(floats.attachments[0].iter().flatten());
    pairs.map(|(byte, float)| ((byte - float).abs() - 0.5 / 255.0).max(0.0)).fold(0.0, f64::max)
}

#[test]
fn measured_rules_rest_on_what_the_driver_does() {
    let gpu = gpu();
    println!("rules of our own, as measured:");
    let angle = "float a = (gl_FragCoord.x - 0.5 + 64.0 * (gl_FragCoord.y - 0.5)) * 256.0;";
    for (what, body) in [("sin up to 1e6", "sin(a)"), ("cos up to 1e6", "cos(a)")] {
        let found = error(&gpu, &format!("void main() {{ {angle} color = vec4({body}); }}"), 0);
        measured(what, found, rules::SIN.absolute(), "");
    }
    for name in ["quad_smooth.toml", "triangle.toml", "core/depth_less.toml", "core/derivatives.toml"] {
        let scene = from_disk(format!("fixtures/scenes/{name}"));
        let used = shares(&drawn(&gpu, &scene), &reference(&scene, Precision::Envelope), Criterion::Envelope);
        let used = used.into_iter().filter(|share| share.is_finite()).fold(0.0, f64::max);
        measured(&format!("varyings of {name}"), used, 1.0, "of what is allowed");
    }
    // A snapped vertex moves by up to 1/512 pixel.
    measured("varyings follow snapped vertices by", snapping(&gpu), 1e-4, "pixels");
    measured("storing in 8 bits, from the middle", storing(&gpu), rules::STORE_SLACK.absolute(), "");
    let scene = from_disk("fixtures/scenes/core/texture_linear.toml");
    let (picture, exact) = (drawn(&gpu, &scene), reference(&scene, Precision::F64));
    let pairs = picture.attachments[0].iter().flatten().zip(exact.attachments[0].iter().flatten());
    let found = pairs.map(|(gpu, cpu)| (gpu - cpu).abs()).fold(0.0, f64::max);
    measured("linear filtering of floats", found, Profile::LLVMPIPE.filter_weight(), "times the range of the texels");
}

/// Whether each channel of each pixel lies in its envelope.
#[track_caller]
fn assert_inside(name: &str, picture: &Picture, envelope: &Picture) {
    let intervals = &envelope.intervals.as_ref().expect("it has envelopes")[0];
    for (pixel, (drawn, intervals)) in picture.attachments[0].iter().zip(intervals).enumerate() {
        for (drawn, interval) in drawn.iter().zip(intervals) {
            assert!(interval.contains(*drawn), "{name}, pixel {pixel}: {drawn:e} is not in {interval:?}");
        }
    }
}

/// Mesa combines the constants of a chain, as Vulkan and WGSL allow.
#[test]
fn constants_of_a_chain_may_be_combined() {
    let gpu = gpu();
    for (name, body) in [
        ("products", "float x = 1e-30 * (1.0 + place.x); color = vec4((x * 1e30) * 1e30);"),
        ("small products", "float x = 1e35 * (1.0 + place.x); color = vec4((x * 1e-25) * 1e-25);"),
        ("sums", "float x = 1e38 * (1.0 + place.x); color = vec4((x - 3e38) - 3e38);"),
        ("more terms", "color = vec4(((place.x * 1e30) * (1.0 + place.y)) * 1e20);"),
        ("quotients", "color = vec4((place.x / 1e-30) / 1e-30);"),
        ("a step", "float y = step(0.5, place.x); color = vec4((y + 0.02) - y, 1.0 / ((0.02 + y) - y), 0.0, 1.0);"),
        ("a condition", "float y = float(!(place.x < 0.5)); color = vec4((y + 0.02) - y);"),
    ] {
        let scene = square(&format!("void main() {{ {body} }}"), "rgba32float");
        let envelope = reference(&scene, Precision::Envelope);
        for via in [Via::Spirv, Via::Wgsl] {
            assert_inside(name, &gpu.render(&scene, via).expect("it draws").picture, &envelope);
        }
    }
}

/// The widest channel of an envelope.
fn widest(scene: &Scene, profile: Profile) -> f64 {
    let options = glisten_reference::RenderOptions { profile, ..as_on_vulkan(Precision::Envelope, Faults::NONE) };
    let picture = glisten_reference::render(scene, &options).expect("the reference draws it");
    let intervals = &picture.intervals.as_ref().expect("it has envelopes")[0];
    // Far from the edges of the square, where coverage is a matter of the profile, too.
    let inner = intervals.chunks(64).skip(16).take(32).flat_map(|row| &row[16..48]);
    inner.flatten().map(|interval| interval.width()).fold(0.0, f64::max)
}

#[test]
fn a_profile_allows_what_its_devices_may_do() {
    let halves = square("void main() { color = vec4(floor(gl_FragCoord.x) / 4.0); }", "rgba32float");
    assert_eq!(widest(&halves, Profile::LLVMPIPE), 0.0);
    assert!(widest(&halves, Profile::VULKAN) > 1e-6);
    let slopes = square("void main() { color = vec4(dFdx(place.x)); }", "rgba32float");
    // Vertices that are moved by a step of their positions change a slope, too.
    let exact = Profile { exact_positions: true, ..Profile::VULKAN };
    let [exact, moved] = [exact, Profile::VULKAN].map(|profile| widest(&slopes, profile));
    assert!(exact < 1e-5 && (exact..1.0).contains(&moved), "{exact} {moved}");
    assert!(widest(&slopes, Profile::WGSL).is_infinite());
    let reported = gpu().precision().expect("lavapipe reports its limits");
    assert_eq!(
        Profile::of_device("llvmpipe", Some(reported.bits())),
        Profile::LLVMPIPE,
        "the table is what it reports"
    );
}

/// GPUs that interpolate between window positions of few bits are inside of what a profile allows that has such, and outside of one that
/// has none.
#[test]
fn varyings_between_positions_of_few_bits_are_allowed_where_the_profile_has_them() {
    let scene = square("void main() { color = vec4(place, sin(9.0 * place.x), 1.0); }", "rgba32float");
    let exact = Profile { exact_positions: true, ..Profile::WGSL };
    let of = |precision, profile| glisten_reference::RenderOptions { profile, ..as_on_vulkan(precision, Faults::NONE) };
    let envelope = |profile| {
        let drawn =
            glisten_reference::render(&scene, &of(Precision::Envelope, profile)).expect("the reference draws it");
        drawn.intervals.expect("it has envelopes").remove(0)
    };
    let [allowed, narrow] = [Profile::WGSL, exact].map(envelope);
    let mut beyond = 0;
    for number in 0..16 {
        let options = of(Precision::F32, Profile::WGSL);
        let drawn = glisten_reference::simulate(&scene, &options, (1, number)).expect("it is drawn");
        let inner = (16..48).flat_map(|row| (16..48).map(move |column| row * 64 + column));
        for (pixel, channel) in inner.flat_map(|pixel| (0..4).map(move |channel| (pixel, channel))) {
            let value = drawn.attachments[0][pixel][channel];
            assert!(allowed[pixel][channel].contains(value), "GPU {number}, pixel {pixel}: {value}");
            beyond += usize::from(!narrow[pixel][channel].contains(value));
        }
    }
    assert!(beyond > 1000, "{beyond} numbers of GPUs that round positions are beyond those of others");
}

/// An error that both fragments of a derivative share does not count: the difference is as narrow as the rounding of its operands.
#[test]
fn fragments_of_a_derivative_lie_on_one_plane() {
    let gpu = gpu();
    for (body, most) in [("dFdx(place.x)", 1e-6), ("dFdy(3.0 * place.y - 1.0)", 4e-6), ("fwidth(place.x / 3.0)", 2e-6)]
    {
        let scene = square(&format!("void main() {{ color = vec4({body}); }}"), "rgba32float");
        let width = widest(&scene, Profile::LLVMPIPE);
        assert!(width > 0.0 && width < most, "{body}: {width:e}");
        assert_inside(body, &drawn(&gpu, &scene), &reference(&scene, Precision::Envelope));
    }
}

/// So it is for what is computed from varyings: products, lengths, quotients, normalized vectors.
#[test]
fn fragments_of_a_derivative_share_the_errors_of_products() {
    let gpu = gpu();
    for (body, most) in [
        // Each is of one coordinate: otherwise both rows of a quad, which a GPU may choose from, differ by more than roundings.
        ("dFdx(place.x * place.x)", 4e-6),
        ("dFdy(place.y * (place.y + 1.0))", 8e-6),
        ("fwidth(dot(place.xx, vec2(place.x, 1.0)))", 2e-5),
        ("fwidth(length(vec2(place.x + 3.0, place.x)))", 2e-5),
        ("dFdx(sqrt(place.x * place.x + 1.0))", 1e-5),
        ("dFdx(inversesqrt(place.x + 2.5))", 1e-5),
        ("dFdy(place.y / (place.y + 2.5))", 1e-5),
        ("dFdx(normalize(vec3(place.x, 0.5, 1.0)).x)", 1e-5),
    ] {
        let scene = square(&format!("void main() {{ color = vec4({body}); }}"), "rgba32float");
        let width = widest(&scene, Profile::LLVMPIPE);
        assert!(width > 0.0 && width < most, "{body}: {width:e}");
        let envelope = reference(&scene, Precision::Envelope);
        assert_inside(body, &drawn(&gpu, &scene), &envelope);
        let options = as_on_vulkan(Precision::F32, Faults::NONE);
        for member in 0..12 {
            let picture = glisten_reference::simulate(&scene, &options, (1, member)).expect("it can be drawn");
            assert_inside(&format!("{body}, simulated GPU {member}"), &picture, &envelope);
        }
    }
}

/// The known arithmetic of llvmpipe is llvmpipe's, bit for bit, where a hash shows every bit.
#[test]
fn the_sine_of_llvmpipe() {
    let gpu = gpu();
    let body = "vec2 p = floor(gl_FragCoord.xy); float x = p.x * 0.37109375 + p.y * 23.75; color = vec4(sin(x), cos(x), fract(sin(x) * 43758.5453), x);";
    let scene = square(&format!("void main() {{ {body} }}"), "rgba32float");
    let picture = drawn(&gpu, &scene);
    let options = as_on_vulkan(Precision::F32, Faults::NONE);
    let same = |number: u32| {
        let known = glisten_reference::as_llvmpipe(&scene, &options, number, None).expect("it can be drawn");
        let pairs = picture.attachments[0].iter().zip(&known.attachments[0]).zip(&known.covered);
        let covered = pairs.filter(|(_, covered)| **covered);
        covered.fold((0, 0), |(same, all), ((a, b), _)| (same + usize::from(a == b), all + 1))
    };
    let found: Vec<(usize, usize)> = (0..glisten_reference::domain::Gpu::LLVMPIPES).map(same).collect();
    assert!(found.iter().any(|(same, all)| *all > 1000 && 20 * same >= 19 * all), "{found:?}");
}

/// A surface drawn twice, the second time where depth is equal: decided, if the positions are invariant.
#[test]
fn a_prepass_decides_depth() {
    let vertex = |invariant: &str| {
        format!(
            "#version 150\n{invariant}\nin vec3 p;\nuniform mat4 m;\nout vec3 n;\nvoid main() {{ n = p; gl_Position = m * vec4(p, 1); }}\n"
        )
    };
    let draws = |function: &str| {
        let mesh = "cull = \"back\"\ndepth_test = true\n[draw.mesh]\nshape = \"sphere\"\nposition = \"p\"\n\
                    [draw.matrices]\nm = \"model_view_projection\"\n";
        format!(
            "framebuffer = {{ width = 48, height = 48 }}\n[camera]\neye = [0.4, 0.5, 4.0]\ntarget = [0.0, 0.0, 0.0]\nfovy = 32.0\nnear = \
             1.0\nfar = 10.0\n[[draw]]\nvertex = \"a.vert\"\nfragment = \"dark.frag\"\n{mesh}[[draw]]\nvertex = \"a.vert\"\nfragment = \
             \"lit.frag\"\ndepth_func = \"{function}\"\ndepth_write = false\n{mesh}"
        )
    };
    let dark = "#version 150\nin vec3 n;\nout vec4 color;\nvoid main() { color = vec4(0.1 * n.x); }\n";
    let lit = "#version 150\nin vec3 n;\nout vec4 color;\nvoid main() { color = vec4(n * 0.5 + 0.5, 1.0); }\n";
    let undecided = |function: &str, invariant: &str| {
        let (text, vertex) = (draws(function), vertex(invariant));
        let scene = from_texts([
            ("a.toml", text.as_str()),
            ("a.vert", vertex.as_str()),
            ("dark.frag", dark),
            ("lit.frag", lit),
        ]);
        let picture = reference(&scene, Precision::Envelope);
        picture.undecided.iter().filter(|undecided| **undecided).count()
    };
    for function in ["equal", "lequal", "gequal"] {
        assert_eq!(undecided(function, "invariant gl_Position;"), 0, "{function}");
    }
    assert!(undecided("equal", "") > 400, "another program may compute other positions");
}
