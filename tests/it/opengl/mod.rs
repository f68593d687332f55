//! The reference draws the same pictures as an OpenGL driver from the original sources: every scene of the fixtures
//! is drawn on Mesa's llvmpipe and judged as `verify` judges the GPU's picture, except that lines follow OpenGL's own
//! rule.
//!
//! On a machine without OpenGL, the tests say so; if `CI` is set, they fail. `cargo test --all-features --test it --
//! opengl --nocapture` prints figures. `OPENGL_SCENES=DIR` judges the scenes and `.shader_test`s of your own folder
//! instead of the fixtures.

#![expect(clippy::print_stdout, reason = "what was judged, and what was excused, is told")]

#[cfg(feature = "gpu")]
mod coverage;
mod emitted;
#[cfg(feature = "gpu")]
mod order;

use crate::drawing::{from_disk, from_texts};
use crate::emit::missing;
use crate::support::{compiler, files_with, root};
use glisten::scene::Scene;
use glisten_front::hir::{ArraySize, Stage, Type};
use glisten_gl::{Error, Gl};
use glisten_reference::LineRule;
use glisten_scene::compare::{self, Criterion, Verdict};
use glisten_scene::picture::Picture;
use glisten_verify::shader_test;
use glisten_verify::shader_test::{TestBackend, TestResult};
use glisten_verify::verify;
use std::path::{Path, PathBuf};

/// Larger scenes are scaled down.
const MOST_PIXELS_A_SIDE: u32 = 64;

/// The expectation for a scene on which the driver and the reference disagree.
enum Expected {
    /// The driver's compiler rejects the sources, with this in its log.
    Refused(&'static str),
    /// This channel of the only attachment is not judged; all others are.
    Open(usize),
    /// All channels are judged with this tolerance.
    Within(f64),
    /// The driver does not get the program.
    Withheld,
}

/// A scene, the expectation, and the reason.
type Exception = (&'static str, Expected, &'static str);

static EXCEPTIONS: &[Exception] = &[
    (
        "core/lower_expressions",
        Expected::Open(0),
        "`counter + next() + counter`: GLSL does not say in which order operands are evaluated, and Mesa reads `counter` last",
    ),
    ("core/lower_chosen", Expected::Withheld, "llvmpipe (Mesa 22.3) crashes where a varying chooses a `samplerCube`"),
    (
        "core/lower_chosen_chains",
        Expected::Withheld,
        "`choice - 1` is outside of arrays in half of the picture, which is undefined (GLSL 4.00, section 4.1.9); glisten clamps it",
    ),
    (
        "core/lower_parameters",
        Expected::Refused("formal parameter lacks a name"),
        "the grammar of GLSL 1.50 (section 9) allows a parameter without a name in a definition, Mesa does not",
    ),
    (
        "core/texture_levels",
        Expected::Within(0.1),
        "OpenGL 3.2 (section 3.8.11) leaves the scale factor between bounds, and llvmpipe approximates its logarithm",
    ),
    (
        "geometry/short_lines",
        // As for core/smooth_line_strip: at most 0.354 pixels along lines of a pixel and more, whose ends differ by 0.5.
        Expected::Within(0.354 * 0.5),
        "llvmpipe interpolates along the major axis of a line, and not by the projection of (3.5)",
    ),
    (
        "core/lower_statements",
        Expected::Open(1),
        "a function ends without a `return`: its value is undefined (GLSL 1.50, section 6.1)",
    ),
    (
        "core/smooth_line_strip",
        // The fragment's center is up to half a pixel off the line, and the projection moves that by the line's
        // slope: at most 0.354 pixels along a line of length 33 or more.
        Expected::Within(0.354 / 33.0),
        "llvmpipe interpolates along the major axis of a line, and not by the projection of (3.5)",
    ),
];

/// Scenes whose fragments all fail a test.
static EMPTY: &[&str] = &[
    "core/cull_back_ccw",
    "core/cull_front_cw",
    "core/depth_equal",
    "core/depth_gequal",
    "core/depth_greater",
    "core/depth_never",
    "core/lower_always_discard",
];

fn gl() -> Option<Gl> {
    match Gl::new() {
        Ok(gl) => Some(gl),
        Err(error) => {
            missing("OpenGL", &error.to_string());
            None
        }
    }
}

/// The variable that names your own folder.
const ASKED: &str = "OPENGL_SCENES";

fn asked_or(fixtures: &str) -> PathBuf {
    std::env::var_os(ASKED).map_or_else(|| root().join(fixtures), PathBuf::from)
}

/// All files with an extension in a folder, with names relative to it.
fn named_files(folder: &Path, wanted: &str) -> Vec<(String, PathBuf)> {
    let named = files_with(folder, wanted).into_iter().map(|path| {
        let name = path.strip_prefix(folder).expect("inside the folder").with_extension("");
        (name.to_string_lossy().replace('\\', "/"), path)
    });
    let mut files: Vec<(String, PathBuf)> = named.collect();
    assert!(!files.is_empty(), "nothing is in {}", folder.display());
    files.sort();
    files
}

/// The scene, at most [`MOST_PIXELS_A_SIDE`] pixels wide and high.
fn small(mut scene: Scene) -> Scene {
    let shrink = scene.framebuffer.width.max(scene.framebuffer.height).div_ceil(MOST_PIXELS_A_SIDE);
    scene.framebuffer.width /= shrink;
    scene.framebuffer.height /= shrink;
    scene
}

/// A scene from texts: `vertex`, `fragment`, and what follows the first keys of its only draw.
fn written(vertex: &str, fragment: &str, rest: &str) -> Scene {
    let text = format!(
        "[framebuffer]\nwidth = 16\nheight = 16\n[[draw]]\nvertex = \"a.vert\"\nfragment = \"a.frag\"\n{rest}\n"
    );
    small(from_texts([("a.toml", text.as_str()), ("a.vert", vertex), ("a.frag", fragment)]))
}

/// Judges a picture as `verify` does, with lines by OpenGL's rule. The pictures of a failure are left in a folder, which
/// the complaint names.
fn judged(name: &str, scene: &Scene, mut picture: Picture, exception: Option<&Exception>) -> Verdict {
    let criterion = match exception {
        Some((_, Expected::Within(tolerance), _)) => Criterion::Tolerance(*tolerance),
        _ => Criterion::Envelope,
    };
    // The population has the lines and the rounding of Vulkan's GPUs.
    let demands = verify::Demands { likely: false, ..Default::default() };
    let options = verify::Options { criterion, lines: LineRule::OpenGl, demands, ..verify::Options::default() };
    let mut expected = verify::Expected::new(scene, &options).expect("the reference draws every scene of the fixtures");
    close(scene, &mut picture, expected.picture());
    if let Some((_, Expected::Open(channel), _)) = exception {
        take_over(&mut picture, expected.picture(), 0, *channel);
    }
    let verdict = expected.compare(&picture).expect("the reference draws every scene of the fixtures");
    if verdict.fails() {
        let shares = compare::shares(&picture, expected.picture(), criterion);
        let difference = verify::difference(expected.picture(), &shares);
        let pictures = [("gl", &picture), ("cpu", expected.picture()), ("difference", &difference)];
        verify::write_pictures(&failures(name), &pictures).expect("the pictures of a failure can be written");
    }
    verdict
}

/// The folder for the pictures of a scene on which the two sides differ.
fn failures(name: &str) -> PathBuf {
    root().join("target/failures/opengl").join(name)
}

/// The message for a scene with differences.
fn told(name: &str, verdict: &Verdict) -> String {
    format!("{name}: {verdict:#?}\npictures: {}", failures(name).display())
}

/// Replaces components that an output does not have, which are undefined (OpenGL 3.2, section 3.9.2), by the
/// reference's.
fn close(scene: &Scene, picture: &mut Picture, reference: &Picture) {
    for program in scene.draws.iter().map(|draw| &draw.program) {
        for output in &program.interface.outputs {
            let (element, elements) = match program.types.get(output.ty) {
                Type::Array(element, ArraySize::Sized(size)) => (element, size),
                _ => (output.ty, 1),
            };
            let components = match program.types.get(element) {
                Type::Vector(_, size) => usize::from(size),
                _ => 1,
            };
            for number in output.location..output.location + elements {
                (components..4).for_each(|channel| take_over(picture, reference, number as usize, channel));
            }
        }
    }
}

fn take_over(picture: &mut Picture, reference: &Picture, attachment: usize, channel: usize) {
    // `gl_FragData` may have more elements than there are attachments.
    let attachments = picture.attachments.get_mut(attachment).zip(reference.attachments.get(attachment));
    for (ours, theirs) in attachments.into_iter().flat_map(|(ours, theirs)| ours.iter_mut().zip(theirs)) {
        ours[channel] = theirs[channel];
    }
}

/// A complaint about a scene; `None` if everything is as expected.
fn complaint(gl: &Gl, name: &str, scene: &Scene, excused: &mut u64) -> Option<String> {
    let exception = EXCEPTIONS.iter().find(|(known, ..)| *known == name);
    if matches!(exception, Some((_, Expected::Withheld, _))) {
        return None;
    }
    let picture = match (gl.render(scene), exception) {
        (Ok(_), Some((_, Expected::Refused(_), _))) => return None,
        (Ok(picture), _) => picture,
        (Err(Error::Compile { log, .. }), Some((_, Expected::Refused(part), _))) if log.contains(part) => return None,
        (Err(error), _) => return Some(format!("{name}: {error}")),
    };
    let verdict = judged(name, scene, picture, exception);
    for known in &verdict.known_faults {
        println!("  {name}: {} pixels by the known fault {}", known.pixels, known.fault);
        *excused += known.pixels;
    }
    if verdict.covered == 0 && !EMPTY.contains(&name) {
        return Some(format!("{name}: nothing is drawn"));
    }
    verdict.fails().then(|| told(name, &verdict))
}

#[test]
fn the_reference_draws_what_opengl_draws() {
    let Some(gl) = gl() else { return };
    println!("OpenGL by {}", gl.renderer());
    let (mut wrong, mut excused) = (Vec::new(), 0);
    let asked = std::env::var_os(ASKED);
    let folder = asked_or("fixtures/scenes");
    let files = named_files(&folder, "toml");
    for (name, path) in &files {
        wrong.extend(complaint(&gl, name, &small(from_disk(path)), &mut excused));
    }
    println!(
        "{} scenes, {} wrong, {excused} pixels by known faults of the driver; exceptions:",
        files.len(),
        wrong.len()
    );
    for (name, _, reason) in EXCEPTIONS {
        println!("  {name}: {reason}");
        assert!(asked.is_some() || files.iter().any(|(known, _)| known == name), "there is no scene {name}");
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Draws the pictures of `.shader_test`s and judges each.
struct Judged<'a> {
    gl: &'a Gl,
    pictures: usize,
    wrong: Vec<String>,
}

impl TestBackend for Judged<'_> {
    fn draw(&mut self, scene: &Scene) -> Result<Picture, TestResult> {
        let picture = self.gl.render(scene).map_err(|error| match error {
            Error::Unsupported(what) => TestResult::Skip(what),
            error => TestResult::Fail(error.to_string()),
        })?;
        self.pictures += 1;
        let name = format!("shader_test_{}", self.pictures);
        let verdict = judged(&name, scene, picture.clone(), None);
        if verdict.fails() {
            self.wrong.push(told(&name, &verdict));
        }
        Ok(picture)
    }
}

#[test]
fn shader_tests_are_drawn_as_opengl_draws_them() {
    let Some(gl) = gl() else { return };
    let (mut backend, mut wrong) = (Judged { gl: &gl, pictures: 0, wrong: Vec::new() }, Vec::new());
    let files = named_files(&asked_or("fixtures/shader_tests"), "shader_test");
    let mut skipped = 0;
    for (name, path) in &files {
        let text = std::fs::read_to_string(path).expect("a readable test");
        match shader_test::run(name, &text, &compiler(), &mut backend) {
            TestResult::Pass => {}
            TestResult::Fail(reason) => wrong.push(format!("{name}: {reason}")),
            TestResult::Skip(_) => skipped += 1,
        }
        wrong.extend(backend.wrong.drain(..).map(|what| format!("{name}: {what}")));
    }
    println!("{} tests, {skipped} of them skipped, {} pictures judged", files.len(), backend.pictures);
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Random programs that the driver gets wrong, by seed.
#[cfg(feature = "gpu")]
static MISTAKEN: &[(u64, &str)] = &[(
    4,
    "Mesa goes on behind the inner of two switches after its `continue`, and evaluates the condition of `do` once more",
)];

#[cfg(feature = "gpu")]
#[test]
fn random_programs_are_drawn_as_opengl_draws_them() {
    let Some(gl) = gl() else { return };
    let (mut wrong, mut all, mut open, mut differing) = (Vec::new(), 0, 0, 0);
    for seed in crate::random::seeds() {
        let (fragment, scene) = crate::random::program(seed);
        let picture = gl.render(&scene).unwrap_or_else(|error| panic!("seed {seed}: {error}\n{fragment}"));
        let name = format!("random_{seed}");
        let verdict = judged(&name, &scene, picture, None);
        let is_open = scene.draws[0].program.stages.iter().any(order::is_open);
        (all, open) = (all + 1, open + u32::from(is_open));
        match (!verdict.fails(), is_open) {
            (true, _) => {}
            (false, true) => differing += 1,
            (false, false) if MISTAKEN.iter().any(|(known, _)| *known == seed) => {}
            (false, false) => wrong.push(format!("{}\n{fragment}", told(&name, &verdict))),
        }
    }
    println!("{all} random programs; {open} depend on the order of operands, of these {differing} are drawn otherwise");
    MISTAKEN.iter().for_each(|(seed, reason)| println!("  seed {seed}: {reason}"));
    assert!(open * 4 < all * 3, "{open} of {all} random programs say nothing");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

const PLACE: &str = "#version 150\nin vec2 place;\nvoid main() { gl_Position = vec4(place, 0.0, 1.0); }\n";
const SQUARE: &str =
    "primitive = \"triangle_strip\"\n[draw.attributes]\nplace = { size = 2, values = [-1, -1, 1, -1, -1, 1, 1, 1] }";

/// Draws a scene and judges it.
#[track_caller]
fn holds(gl: &Gl, scene: &Scene) -> Picture {
    let picture = gl.render(scene).unwrap_or_else(|error| panic!("{error}"));
    let verdict = judged("holds", scene, picture.clone(), None);
    assert!(verdict.covered > 0 && verdict.holds(false), "{}", told("holds", &verdict));
    picture
}

#[test]
fn uniforms_of_every_kind_reach_the_driver() {
    let Some(gl) = gl() else { return };
    let fragment = "#version 150\n\
        struct Pair { vec3 a; float b[2]; };\n\
        uniform mat2x3 m; uniform mat4x2 n[2]; uniform Pair p[2]; uniform ivec3 i; uniform uvec2 u; uniform bvec2 b;\n\
        uniform bool whole[3]; uniform float given = 0.125;\n\
        layout(std140) uniform Standard { float s0; vec3 s1; mat3 s2; layout(row_major) mat2x3 s3[2]; Pair s4[2]; bool s5; };\n\
        layout(shared, row_major) uniform Shared { mat4x3 t0; float t1[3]; } shared_block;\n\
        layout(packed) uniform Packed { uvec2 q0; int q1[2]; } packed_block[2];\n\
        out vec4 color;\n\
        void main() {\n\
            vec3 x = m * vec2(1.0, 2.0) + vec3(n[1] * vec4(1.0, 2.0, 3.0, 4.0), n[0][3].y) + p[1].a * p[0].b[1] + vec3(i);\n\
            float y = float(u.y) + float(b.x) * 2.0 + float(b.y) + float(whole[2]) * 4.0 + given;\n\
            vec3 z = s0 * s1 + s2 * vec3(1.0, 2.0, 3.0) + s3[1] * vec2(0.5, 0.25) + s4[1].a * s4[1].b[1] + vec3(s5);\n\
            vec3 w = shared_block.t0 * vec4(1.0, 0.5, 0.25, 2.0) * shared_block.t1[2];\n\
            color = vec4(x + z, y) + vec4(w, float(packed_block[0].q0.y + uint(packed_block[1].q1[1])));\n\
        }\n";
    let numbers = |count: usize, first: f64| -> String {
        let list: Vec<String> = (0..count).map(|k| format!("{}", first + 0.25 * k as f64)).collect();
        format!("[{}]", list.join(", "))
    };
    let uniforms = [
        ("m", numbers(6, 0.5)),
        ("n", numbers(16, -1.0)),
        ("p[0].a", numbers(3, 1.0)),
        ("p[0].b", numbers(2, 2.0)),
        ("p[1].a", numbers(3, 3.0)),
        ("p[1].b", numbers(2, 4.0)),
        ("i", "[1, -2, 3]".into()),
        ("u", "[4, 5]".into()),
        ("b", "[true, false]".into()),
        ("whole", "[false, false, true]".into()),
        ("s0", "1.5".into()),
        ("s1", numbers(3, 0.0)),
        ("s2", numbers(9, -2.0)),
        ("s3", numbers(12, 5.0)),
        ("s4[0].a", numbers(3, 1.0)),
        ("s4[0].b", numbers(2, 2.0)),
        ("s4[1].a", numbers(3, 6.0)),
        ("s4[1].b", numbers(2, 7.0)),
        ("s5", "true".into()),
        ("Shared.t0", numbers(12, -3.0)),
        ("Shared.t1", numbers(3, 1.0)),
        ("Packed[0].q0", "[6, 7]".into()),
        ("Packed[0].q1", "[8, 9]".into()),
        ("Packed[1].q0", "[10, 11]".into()),
        ("Packed[1].q1", "[12, 13]".into()),
    ];
    let list: String = uniforms.iter().map(|(name, value)| format!("\"{name}\" = {value}\n")).collect();
    let scene = written(PLACE, fragment, &format!("{SQUARE}\n[draw.uniforms]\n{list}"));
    holds(&gl, &scene);
}

#[test]
fn attributes_of_every_kind_reach_the_driver() {
    let Some(gl) = gl() else { return };
    let vertex = "#version 150\n\
        in vec2 place; in mat2x3 m; in vec4 part; in ivec2 i; in uint u; in vec2 shift;\n\
        flat out vec4 a; out vec4 b;\n\
        void main() {\n\
            a = vec4(m[0] + m[1], float(i.x * i.y) + float(u)); b = part;\n\
            gl_Position = vec4(place + shift, 0.0, 1.0);\n\
        }\n";
    let fragment = "#version 150\nflat in vec4 a; in vec4 b; out vec4 color;\nvoid main() { color = a + b; }\n";
    let rest = "instances = 4\nindices = [0, 1, 2, 2, 1, 3]\nprovoking = \"first\"\n[draw.attributes]\n\
        place = { size = 2, values = [-1, -1, -0.25, -1, -1, -0.25, -0.25, -0.25] }\n\
        m = { size = 6, values = [1,2,3,4,5,6, 7,8,9,10,11,12, 13,14,15,16,17,18, 19,20,21,22,23,24] }\n\
        part = { size = 2, values = [0.5, 1, 2, 3, 4, 5, 6, 7] }\n\
        i = { size = 2, values = [1, -2, 3, 4, -5, 6, 7, 8] }\n\
        u = { size = 1, values = [9, 8, 4000000000, 6] }\n\
        shift = { size = 2, divisor = 2, values = [0, 0, 1, 1] }\n\
        [draw.attribute_locations]\nm = 3\nplace = 1\n";
    let picture = holds(&gl, &written(vertex, fragment, rest));
    let row = |y: usize| y * 16;
    assert!(picture.covered[row(15)] && picture.covered[row(7) + 8], "both rows of the divisor are drawn");
    assert!(!picture.covered[row(7)], "and nothing next to them");
}

#[test]
fn what_the_driver_refuses_is_an_error() {
    let Some(gl) = gl() else { return };
    let nameless =
        "#version 150\nout vec4 color;\nfloat one(float) { return 1.0; }\nvoid main() { color = vec4(one(0.0)); }\n";
    match gl.render(&written(PLACE, nameless, SQUARE)) {
        Err(Error::Compile { stage: Stage::Fragment, log, .. }) => assert!(log.contains("lacks a name"), "{log}"),
        // Another driver may accept it.
        other => assert!(other.is_ok(), "{other:?}"),
    }
    let mut scene = written(PLACE, "#version 150\nout vec4 color;\nvoid main() { color = vec4(1.0); }\n", SQUARE);
    holds(&gl, &scene);
    scene.draws[0].vertex_count = 5;
    assert!(matches!(gl.render(&scene), Err(Error::Refused(_))), "a draw past the end of its data");
    scene.draws[0].vertex_count = 4;
    scene.framebuffer.width = 1 << 20;
    let error = gl.render(&scene).expect_err("no driver has so large a framebuffer");
    assert!(!error.is_environment() && error.to_string().contains("1048576 x 16"), "{error}");
}

#[cfg(feature = "cli")]
mod command {
    use super::{gl, root};
    use std::process::{Command, Output};

    fn render(scene: &str, output: &std::path::Path, environment: &[(&str, &str)]) -> Output {
        let mut command = Command::new(env!("CARGO_BIN_EXE_glisten"));
        command.args(["render", "--backend", "gl", "-o"]).arg(output).arg(root().join(scene));
        command.envs(environment.iter().copied()).output().expect("the program runs")
    }

    #[test]
    fn the_command_draws_by_opengl() {
        if gl().is_none() {
            return;
        }
        let folder = tempfile::tempdir().expect("a temporary folder");
        let file = folder.path().join("out.npy");
        let run = render("fixtures/scenes/triangle.toml", &file, &[]);
        assert_eq!(run.status.code(), Some(0), "{}", String::from_utf8_lossy(&run.stderr));
        assert!(file.exists());
        let refused = folder.path().join("refused.npy");
        let run = render("fixtures/scenes/core/lower_parameters.toml", &refused, &[]);
        let told = String::from_utf8_lossy(&run.stderr).into_owned();
        assert_eq!(run.status.code(), Some(1), "{told}");
        assert!(told.contains("the OpenGL driver refuses the fragment stage of `parameters`"), "{told}");
        assert!(!refused.exists());
    }

    #[test]
    fn a_machine_without_a_driver_is_told_what_to_install() {
        if gl().is_none() {
            return;
        }
        let folder = tempfile::tempdir().expect("a temporary folder");
        let file = folder.path().join("out.npy");
        // With this variable, libglvnd finds no vendor.
        let none = [("__EGL_VENDOR_LIBRARY_FILENAMES", "/nonexistent.json")];
        let run = render("fixtures/scenes/triangle.toml", &file, &none);
        let told = String::from_utf8_lossy(&run.stderr).into_owned();
        assert_eq!(run.status.code(), Some(3), "{told}");
        assert!(told.contains("apt-get install libegl1 libgl1-mesa-dri"), "{told}");
        assert!(!file.exists());
    }
}
