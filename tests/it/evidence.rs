//! How much `verify` judges, end to end: classes that add up, edges, verdicts that are inconclusive, modules of other
//! translators. These tests need a Vulkan software adapter.

use crate::cli::{Folder, code, err, out};
use crate::drawing::{gpu, strict};
use crate::scenes;
use crate::support::compiler;
use glisten::scene::{DiskFiles, load};
use glisten::verify::Conclusion;
use glisten_gpu::Via;
use glisten_verify::verify::Expected;
use serde_json::Value;
use std::fs;

const VERTEX: &str = "#version 150\nin vec2 p;\nout vec2 q;\nvoid main() {\n    q = p * 0.5 + 0.5;\n    gl_Position = \
                      vec4(p, 0.0, 1.0);\n}\n";
const GRADIENT: &str = "#version 150\nin vec2 q;\nout vec4 c;\nvoid main() { c = vec4(q, 0.5 * q.x, 1.0); }\n";

/// A quad of `squares` by `squares` squares over a window of 64 by 64 pixels. With 64 squares, each pixel's center is on a
/// diagonal.
fn quad(squares: usize, fragment: &str) -> Folder {
    let line = |i: usize| -1.0 + 2.0 * i as f64 / squares as f64;
    let points: Vec<String> =
        (0..=squares).flat_map(|y| (0..=squares).map(move |x| format!("{}, {}", line(x), line(y)))).collect();
    let squares_of = |y: usize| (0..squares).map(move |x| y * (squares + 1) + x);
    let corners = |a: usize| [a, a + 1, a + squares + 1, a + 1, a + squares + 2, a + squares + 1];
    let indices: Vec<usize> = (0..squares).flat_map(squares_of).flat_map(corners).collect();
    let text = format!(
        "[framebuffer]\nwidth = 64\nheight = 64\n[[draw]]\nvertex = \"a.vert\"\nfragment = \"a.frag\"\nprimitive = \
         \"triangles\"\nindices = {indices:?}\nvertex_count = {}\n[draw.attributes]\np = {{ size = 2, values = [{}] }}\n",
        (squares + 1) * (squares + 1),
        points.join(", ")
    );
    Folder::new(&[("a.vert", VERTEX.as_bytes()), ("a.frag", fragment.as_bytes()), ("a.toml", text.as_bytes())])
}

#[track_caller]
fn verify(folder: &Folder, arguments: &[&str]) -> (i32, Value) {
    let output = folder.run(&[&["verify", "a.toml", "--format", "json"], arguments].concat());
    (code(&output), serde_json::from_str(&out(&output)).unwrap_or_else(|error| panic!("{error}: {}", err(&output))))
}

fn count(json: &Value, class: &str) -> u64 {
    json["evidence"][class].as_u64().unwrap_or_else(|| panic!("{json}"))
}

/// The translations of the gradient that glisten emits.
fn compiled(folder: &Folder) {
    assert_eq!(code(&folder.run(&["compile", "a.vert", "a.frag", "-o", "out", "-q"])), 0);
}

/// "If bits is zero, the result will be zero" (GLSL 4.00 §8.8), and with 32 bits the result is the value.
#[test]
fn fields_without_bits_and_whole_ones_are_defined() {
    for bits in ["n", "n + 32"] {
        let fragment = format!(
            "#version 400\nin vec2 q;\nuniform int n;\nout vec4 c;\nvoid main() {{\n    int f = bitfieldExtract(-5, 0, {bits});\n    \
             c = vec4(f == -5 ? 1.0 : f == 0 ? 0.5 : 0.0, bitfieldInsert(3, 1, 0, {bits}) == 3 ? 1.0 : 0.25, q.x, 1.0);\n}}\n"
        );
        let (code, json) = verify(&quad(1, &fragment), &[]);
        assert_eq!((code, count(&json, "undefined")), (0, 0), "{bits}: {json:#}");
        assert!(count(&json, "judged") > 0, "{json:#}");
    }
}

#[test]
fn a_pixel_on_an_inner_edge_is_judged_by_its_owners() {
    let folder = quad(64, GRADIENT);
    let (exit, json) = verify(&folder, &[]);
    assert_eq!((exit, &json["verdict"], count(&json, "edge")), (0, &"holds".into(), 4096), "{json}");
    compiled(&folder);
    let right = fs::read_to_string(folder.path("out/a.frag.wgsl")).expect("compiled");
    for (name, wrong) in [
        ("darker", "return 0.9 * vec4"),
        ("another hue", "return vec4(1.0, 1.0, 0.5, 2.0) - vec4"),
        ("a bit", "return 1e-4 + vec4"),
    ] {
        let text = right.replace("return vec4", wrong);
        assert_ne!(text, right, "{name}");
        fs::write(folder.path("w.wgsl"), text).expect("written");
        let (exit, json) = verify(&folder, &["--with", "fragment=w.wgsl"]);
        assert_eq!((exit, &json["verdict"]), (1, &"fails".into()), "{name}: {json}");
        assert!(json["outside"].as_u64().is_some_and(|outside| outside > 4000), "{name}: {json}");
        assert_eq!(json["coverage_mismatch"], 0, "{name}");
    }
}

/// A window of integers that a loop of `rounds` makes.
fn looping(rounds: u32) -> Folder {
    let text = format!(
        "[framebuffer]\nwidth = 4\nheight = 4\nformat = \"rgba32sint\"\n[[draw]]\nvertex = \"a.vert\"\nfragment = \"a.frag\"\nprimitive = \
         \"triangles\"\n[draw.attributes]\np = {{ size = 2, values = [-1, -1, 3, -1, -1, 3] }}\n[draw.uniforms]\nn = {rounds}\n"
    );
    let fragment = "#version 150\nuniform int n;\nout ivec4 c;\nvoid main() {\n    int s = int(gl_FragCoord.x);\n    for (int i = 0; i < n; \
                    ++i) s = s * 1664525 + 1013904223;\n    c = ivec4(s);\n}\n";
    Folder::new(&[("a.vert", VERTEX.as_bytes()), ("a.frag", fragment.as_bytes()), ("a.toml", text.as_bytes())])
}

#[test]
fn loops_that_the_driver_cuts_are_excused_and_the_verdict_says_that_nothing_was_checked() {
    let (exit, json) = verify(&looping(65_000), &[]);
    assert_eq!((exit, &json["verdict"], count(&json, "excused")), (0, &"holds".into(), 0), "{json}");
    let folder = looping(70_000);
    let (exit, json) = verify(&folder, &[]);
    assert_eq!((exit, &json["verdict"], count(&json, "excused")), (0, &"holds".into(), 16), "{json}");
    assert_eq!(json["known_faults"], serde_json::json!([{ "fault": "cut_loops", "pixels": 16 }]));
    let told = out(&folder.run(&["verify", "a.toml"]));
    let first =
        "nothing was checked: known faults of the driver excuse 16 of 16 covered pixels (cut_loops); --no-known-faults";
    assert!(told.starts_with(first), "{told}");
    assert!(
        told.contains("16 of 16 covered pixels judged or excused") && told.contains("no pixel was compared"),
        "{told}"
    );
    assert!(!told.contains("largest error"), "{told}");
    let (exit, json) = verify(&folder, &["--no-known-faults"]);
    assert_eq!((exit, &json["verdict"], &json["outside"]), (1, &"fails".into(), &16.into()), "{json}");
}

#[test]
fn noise_is_inconclusive_with_the_line_that_makes_it_so() {
    let noise = "#version 150\nin vec2 q;\nout vec4 c;\nvoid main() {\n    float x = 40.0 * q.x + 90.0 * q.y;\n    float n = \
                 fract(sin(x) * 43758.5);\n    c = vec4(n, n, n, 1.0);\n}\n";
    for squares in [1, 64] {
        let folder = quad(squares, noise);
        let (exit, json) = verify(&folder, &["--no-likely"]);
        assert_eq!((exit, &json["verdict"]), (1, &"inconclusive".into()), "{json}");
        let causes = json["weakness"]["contributions"].as_array().expect("they are named");
        // Several expressions of the line suffice alone; it depends on the pixel which of them is named.
        assert!(causes.iter().any(|one| one["line"] == 6), "{json}");
        let told = out(&folder.run(&["verify", "a.toml", "--no-likely"]));
        assert!(told.contains("inconclusive: only ") && told.contains("a.frag:6:"), "{told}");
        let (exit, json) = verify(&folder, &["--no-likely", "--allow-inconclusive"]);
        assert_eq!((exit, &json["verdict"]), (0, &"inconclusive".into()));
        let (exit, _) = verify(&folder, &["--no-likely", "--evidence-share", "0"]);
        assert_eq!(exit, 0, "who asks for no evidence gets a verdict without");
    }
}

/// GLSL 1.50 §5.9 and §5.4.1: what the language leaves undefined is anything, so no GPU is wrong, and the operation is named.
#[test]
fn what_the_language_leaves_undefined_of_integers_is_anything() {
    let cases = [
        ("x / (x - x)", "/", false),
        ("x % (x - x)", "%", false),
        ("(-2 - x) % 3", "%", false),
        ("x << 32 + x", "<<", false),
        ("x >> -1 - x", ">>", false),
        ("int(uint(x) / uint(x - x))", "/", false),
        ("int(gl_FragCoord.x * 1e20)", "int", false),
        ("int(uint(-1.0 - gl_FragCoord.x))", "uint", false),
        ("x / (x + 1) + x % (x + 1) + (x << 3) + (x >> 31)", "", true),
    ];
    for (expression, operation, is_defined) in cases {
        let fragment = format!(
            "#version 150\nout vec4 color;\nvoid main() {{\n    int x = int(gl_FragCoord.x);\n    int y = {expression};\n    \
             color = vec4(y, 0, 0, 1);\n}}\n"
        );
        let folder = quad(1, &fragment);
        let (code, json) = verify(&folder, &[]);
        let expected = if is_defined { ("holds", 0) } else { ("inconclusive", 1) };
        assert_eq!((json["verdict"].as_str().unwrap_or_default(), code), expected, "{expression}: {json}");
        if !is_defined {
            let first = &json["weakness"]["contributions"][0];
            assert_eq!((&first["operation"], &first["line"]), (&operation.into(), &5.into()), "{expression}: {json}");
        }
    }
}

/// Whatever a GPU makes of what the language leaves undefined (GLSL 1.50 §4.1, §8.2, §8.3, §8.7), no picture is wrong or suspect
/// because of it, and the place is named.
#[test]
fn what_the_language_leaves_undefined_has_a_class_and_a_place() {
    let head = "#version 150\nin vec2 q;\nout vec4 c;\nuniform sampler2D t;\nvoid main() {\n    float e = 0.25 + 0.5 * q.y * 0.0;\n    \
                float never;\n    if (q.x > 2.0) never = 1.0;\n    c = vec4(q, 0.5, 1.0);\n";
    let cases = [
        ("    if (q.x > 0.5) c.x = smoothstep(e, e, q.y);\n", "smoothstep", 2048),
        ("    if (q.x > 0.5) c.x = max(pow(q.x - 2.0, 2.0 + e), 0.0);\n", "pow", 2048),
        // Only the power of the magnitude, which drivers have, gives another color, behind a loop that the envelope gives up.
        (
            "    float p = -4.0 - q.y * 0.0, y = p, z = 0.0; if (q.x > 0.5) { while (abs(y - z) >= 1e-9) \
             { z = y; y -= 0.5 * (y - 16.0 / pow(p, 2.0)); } c.x = y > 0.9 && y < 1.1 ? 1.0 : 0.0; }\n",
            "pow",
            2048,
        ),
        ("    if (q.x > 0.5) c.x = never;\n", "never written", 2048),
        ("    if (q.x > 0.5) c += texelFetch(t, ivec2(q * 64.0), 0);\n", "texelFetch", 2048),
        ("    if (q.x > 0.5) if (inversesqrt(q.x - 1.0) > 3.0) discard;\n", "inversesqrt", 2048),
        (
            "    if (q.x > 0.5) c += textureLod(t, vec2(e * 0.0 * (1.0 / (e - 0.25)), q.y), 0.0);\n",
            "no finite number",
            2048,
        ),
        // Drivers differ in what `!=` says of a NaN, and none in an infinity.
        ("    float i = 1.0 / (e - 0.25); if (q.x > 0.5) if (i - i != e) c.x = q.y;\n", "comparison with NaN", 2016),
        ("    float i = 1.0 / (e - 0.25); if (q.x > 0.5) if (i != e) c.x = q.y;\n", "", 0),
        // Drivers fold a product with 0.0, and `isnan` with it.
        ("    float i = 1.0 / (e - 0.25); if (q.x > 0.5) if (isnan(i * 0.0)) c.x = q.y;\n", "`isnan` of a NaN", 2016),
        // The neighbor is gone, or does not choose the operand (GLSL 1.50 §5.9, §6.4, §8.7).
        (
            "    if (q.x > 0.5) { if (fract(gl_FragCoord.x * 0.5) < 0.5) discard; c.x = dFdx(q.x * q.y); }\n",
            "a derivative that only a part of the quad runs",
            1024,
        ),
        (
            "    if (q.x > 0.5) c.x = fract(gl_FragCoord.x * 0.5) < 0.5 ? 0.25 : dFdx(q.x * q.y);\n",
            "a derivative that only a part of the quad runs",
            1024,
        ),
        (
            "    if (q.x > 0.5) if (fract(gl_FragCoord.x * 0.5) < 0.5 && dFdx(q.x * q.y) * 64.0 > 0.3) c.x = 0.0;\n",
            "a derivative that only a part of the quad runs",
            1024,
        ),
        // All of the quad chooses it.
        ("    if (q.x > 0.5) c.x = q.y > 2.0 ? 0.25 : dFdx(q.x * q.y);\n", "", 0),
        // What is undefined here reaches no pixel.
        ("    float d = smoothstep(e, e, q.y) * 0.0; if (q.x > 0.5) c.x = q.y;\n", "", 0),
        // An infinity of a division by zero is one on every GPU.
        ("    c.x = min(1.0 / (e - 0.25), q.x);\n", "", 0),
    ];
    for (line, what, pixels) in cases {
        let folder = quad(1, &format!("{head}{line}}}\n"));
        let text = fs::read_to_string(folder.path("a.toml")).expect("written");
        let texture = "[draw.textures]\nt = { width = 2, height = 2, values = [1,0,0,1, 0,1,0,1, 0,0,1,1, 1,1,1,1] }\n";
        fs::write(folder.path("a.toml"), text + texture).expect("written");
        let (exit, json) = verify(&folder, &[]);
        let expected = if pixels == 0 { (0, "holds") } else { (1, "inconclusive") };
        assert_eq!((exit, json["verdict"].as_str().unwrap_or_default()), expected, "{line}{json}");
        let found = count(&json, "undefined");
        let undecided = json["undecided"].as_u64().unwrap_or_default();
        assert!((pixels..=pixels + 40).contains(&(found + undecided)), "{line}{json}");
        assert_eq!((&json["suspect"], &json["outside_likely"]), (&0.into(), &0.into()), "{line}{json}");
        let sum: u64 = json["evidence"].as_object().into_iter().flatten().filter_map(|(_, count)| count.as_u64()).sum();
        assert_eq!(Some(sum), json["covered"].as_u64(), "{json}");
        if pixels > 0 {
            let place = &json["undefined"][0];
            assert!(place["what"].as_str().is_some_and(|text| text.contains(what)), "{line}{json}");
            let line = if what == "never written" { 7 } else { 10 };
            assert_eq!(place["line"], line, "{json}");
            let told = out(&folder.run(&["verify", "a.toml"]));
            assert!(told.lines().next().is_some_and(|first| first.contains("GLSL leaves undefined")), "{told}");
        }
    }
}

/// On a path that does not write `gl_FragDepth`, the depth is undefined if any path writes it (GLSL 1.50 §7.2).
#[test]
fn a_depth_that_one_path_writes_is_undefined_on_the_others() {
    let body = "#version 150\nin vec2 q;\nout vec4 c;\nvoid main() {\n    c = vec4(1.0);\n";
    for (line, pixels) in [
        ("    if (q.x > 0.5) gl_FragDepth = 0.25;\n", 2048),
        ("    gl_FragDepth = 0.25;\n", 0),
        ("    gl_FragDepth = gl_FragCoord.z; if (q.x > 0.5) gl_FragDepth = 0.25;\n", 0),
    ] {
        let folder = quad(1, &format!("{body}{line}}}\n"));
        let text = fs::read_to_string(folder.path("a.toml")).expect("written");
        let text = text.replace("[[draw]]", "[[draw]]\ndepth_test = true\n");
        fs::write(folder.path("a.toml"), text).expect("written");
        let (exit, json) = verify(&folder, &[]);
        assert_eq!((exit, count(&json, "undefined")), (i32::from(pixels > 0), pixels), "{line}{json}");
        if pixels > 0 {
            assert_eq!(json["undefined"][0]["line"], 6, "{json}");
        }
    }
}

/// A function that ends without `return` has an undefined result (GLSL 1.50 §6.1).
#[test]
fn a_result_that_no_return_gives_is_undefined() {
    let texts = [
        ("float f(float x) {\n    if (x > 0.5) return 0.25;\n}\n", 2048),
        ("float f(float x) {\n    if (x > 0.5) return 0.25; else { return 0.5; }\n}\n", 0),
        ("float f(float x) {\n    for (;;) { if (x > 0.5) return 0.25; x += 0.75; }\n}\n", 0),
    ];
    for (function, pixels) in texts {
        let main = "void main() { c = vec4(f(q.x), q, 1.0); }\n";
        let folder = quad(1, &format!("#version 150\nin vec2 q;\nout vec4 c;\n{function}{main}"));
        let (exit, json) = verify(&folder, &[]);
        let expected = if pixels == 0 { (0, "holds") } else { (1, "inconclusive") };
        assert_eq!((exit, json["verdict"].as_str().unwrap_or_default()), expected, "{function}{json}");
        assert!((pixels..=pixels + 40).contains(&count(&json, "undefined")), "{function}{json}");
        if pixels > 0 {
            assert_eq!(json["undefined"][0]["line"], 4, "{json}");
        }
    }
}

/// The first simulated GPUs agree on one side of a comparison of equal numbers, and further ones are on the other: that is no evidence.
#[test]
fn a_fault_at_a_jump_never_holds() {
    let text = "#version 150\nin vec2 q;\nout vec4 c;\nvoid main() {\n    c = vec4(length(floor(q * 5.0)) <= 5.0 ? 1.0 : 0.0);\n}\n";
    let folder = quad(1, text);
    let (exit, json) = verify(&folder, &["--via", "wgsl"]);
    assert_ne!(json["verdict"], "fails", "{json}");
    assert!(exit == 0 || count(&json, "likely") == 0, "{json}");
    assert!(folder.run(&["compile", "a.frag", "--target", "wgsl", "-o", "out"]).status.success());
    let wgsl = fs::read_to_string(folder.path("out/a.frag.wgsl")).expect("written");
    assert!(wgsl.contains("<= 5.0"), "{wgsl}");
    fs::write(folder.path("fault.wgsl"), wgsl.replace("<= 5.0", "< 5.0")).expect("written");
    let (exit, json) = verify(&folder, &["--via", "wgsl", "--with", "fragment=fault.wgsl"]);
    assert_eq!(exit, 1, "{json}");
    assert_ne!(json["verdict"], "holds", "{json}");
}

/// Envelopes of derivatives are wide; simulated GPUs agree on what they draw.
#[test]
fn what_simulated_gpus_agree_on_is_likely() {
    let bump = "#version 150\nin vec2 q;\nout vec4 c;\nvoid main() {\n    float h = 0.2 * sin(q.x * 20.0) * cos(q.y * 17.0);\n    \
                vec3 n = normalize(vec3(-64.0 * dFdx(h), -64.0 * dFdy(h), 1.0));\n    c = vec4(n * 0.5 + 0.5, 1.0);\n}\n";
    let folder = quad(1, bump);
    let (exit, json) = verify(&folder, &[]);
    assert_eq!((exit, &json["verdict"], &json["outside_likely"]), (0, &"holds".into(), &0.into()), "{json}");
    assert!(count(&json, "likely") > 3000, "{json}");
    let (exit, json) = verify(&folder, &["--no-likely"]);
    assert_eq!((exit, &json["verdict"], count(&json, "likely")), (1, &"inconclusive".into(), 0), "{json}");
    let (exit, json) = verify(&folder, &["--likely-margin", "1e9"]);
    assert_eq!((exit, count(&json, "likely")), (1, 0), "so wide a hull judges nothing: {json}");
    // A fault of 1.5 % in a factor.
    assert_eq!(code(&folder.run(&["compile", "a.vert", "a.frag", "-o", "out", "-q"])), 0);
    let right = fs::read_to_string(folder.path("out/a.frag.wgsl")).expect("compiled");
    let wrong = right.replace("64", "65");
    assert_ne!(right, wrong);
    fs::write(folder.path("wrong.wgsl"), wrong).expect("written");
    let (exit, json) = verify(&folder, &["--with", "fragment=wrong.wgsl"]);
    assert_eq!((exit, &json["verdict"]), (1, &"fails".into()), "{json}");
    let told = out(&folder.run(&["verify", "a.toml", "--with", "fragment=wrong.wgsl"]));
    assert!(told.starts_with("does not hold: ") && told.contains("--difference"), "{told}");
}

/// Noise of a hash differs between GPUs, and no specification says what it is. What this device computes is known.
#[test]
fn a_hash_is_judged_by_what_is_known_of_the_device() {
    let noise = "#version 150\nin vec2 q;\nout vec4 c;\nfloat hash(vec2 p) {\n    \
                 return fract(sin(dot(p, vec2(12.9898, 78.233))) * 43758.5453);\n}\nvoid main() {\n    vec2 p = q * 7.0, i = floor(p), f = \
                 fract(p);\n    float a = mix(hash(i), hash(i + vec2(1, 0)), f.x), b = mix(hash(i + vec2(0, 1)), hash(i + 1.0), f.x);\n    \
                 c = vec4(vec3(mix(a, b, f.y)), 1.0);\n}\n";
    let folder = quad(1, noise);
    let (exit, json) = verify(&folder, &["--as-device"]);
    assert_eq!((exit, &json["verdict"]), (0, &"holds".into()), "{json}");
    let as_device = json["as_device"].as_u64().expect("a number");
    assert!(as_device > 3000 && as_device <= count(&json, "likely"), "{json}");
    // Without the flag the specification judges, and nothing is known of a device that may be any.
    for flags in [&[][..], &["--as-device", "--no-likely"], &["--as-device", "--profile", "vulkan"]] {
        let (exit, json) = verify(&folder, flags);
        assert_eq!((exit, &json["verdict"], &json["as_device"]), (1, &"inconclusive".into(), &0.into()), "{json}");
    }
    // Faults are no more what the device computes: in the hash, in what is done with it, and small ones.
    assert_eq!(code(&folder.run(&["compile", "a.vert", "a.frag", "-o", "out", "-q"])), 0);
    let right = fs::read_to_string(folder.path("out/a.frag.wgsl")).expect("compiled");
    for (from, to) in [("43758.547", "43759.547"), ("78.233", "78.234"), ("7.0", "7.1"), ("floor(", "ceil(")] {
        let wrong = right.replace(from, to);
        assert_ne!(right, wrong, "{right}");
        fs::write(folder.path("wrong.wgsl"), wrong).expect("written");
        let (exit, json) = verify(&folder, &["--as-device", "--with", "fragment=wrong.wgsl"]);
        assert!(exit == 1 && json["verdict"] != "holds" && json["as_device"] == 0, "{from}: {json}");
    }
}

/// Positions, sizes of points and clip distances that the last bits of a sine decide: no specification says what is covered.
#[test]
fn what_a_hash_moves_is_open_and_no_fault() {
    let cases = [
        ("gl_Position = vec4(p + 0.1 * hash(p), 0.0, 1.0);", "triangles", ""),
        ("gl_Position = vec4(p + 0.2 * hash(p), 0.0, 1.0);", "points", ""),
        (
            "gl_Position = vec4(p, 0.0, 1.0); gl_PointSize = 1.0 + 6.0 * hash(p);",
            "points",
            "program_point_size = true\n",
        ),
        ("gl_Position = vec4(p, 0.0, 1.0); gl_ClipDistance[0] = hash(p) - 0.5;", "triangles", "clip_distances = 1\n"),
    ];
    for (body, primitive, more) in cases {
        let folder = quad(
            8,
            "#version 150\nout vec4 c;\nvoid main() { c = vec4(fract(float(gl_PrimitiveID) * 0.37), 0.5, 0.0, 1.0); }\n",
        );
        let vertex = format!(
            "#version 150\nin vec2 p;\nfloat hash(vec2 p) {{ return fract(sin(dot(p, vec2(12.9898, 78.233))) * 43758.5453); }}\n\
             void main() {{ {body} }}\n"
        );
        let text = fs::read_to_string(folder.path("a.toml")).expect("written");
        let text = text.replace("\"triangles\"\n", &format!("\"{primitive}\"\n{more}"));
        fs::write(folder.path("a.vert"), vertex).expect("written");
        fs::write(folder.path("a.toml"), text).expect("written");
        let (exit, json) = verify(&folder, &[]);
        assert_eq!((exit, &json["verdict"]), (1, &"inconclusive".into()), "{body}: {json}");
        for key in ["coverage_mismatch", "suspect", "outside_likely", "outside"] {
            assert_eq!(json[key], 0, "{body}: {json}");
        }
    }
}

/// One vertex at a threshold leaves all of a mesh undecided, and not where its outline is.
#[test]
fn an_outline_is_judged_where_one_vertex_is_open() {
    let folder = quad(8, "#version 150\nout vec4 c;\nvoid main() { c = vec4(1.0); }\n");
    let vertex = |moved: &str| {
        let position = format!("gl_Position = vec4(p * 0.8{moved}, 0.0, 1.0);");
        format!(
            "#version 150\nin vec2 p;\nvoid main() {{ {position} if (length(p * 4.0) >= 4.0) gl_Position = vec4(2.0); }}\n"
        )
    };
    fs::write(folder.path("a.vert"), vertex("")).expect("written");
    fs::write(folder.path("b.vert"), vertex(" + 0.03125")).expect("written");
    let (_, json) = verify(&folder, &[]);
    assert_ne!(json["verdict"], "fails", "{json}");
    assert_eq!(code(&folder.run(&["compile", "--program", "b.vert,a.frag", "-o", "out", "-q"])), 0);
    let (exit, json) = verify(&folder, &["--with", "vertex=out/b.vert.wgsl"]);
    assert_eq!((exit, &json["verdict"]), (1, &"fails".into()), "{json}");
}

/// `compile` leaves out a varying that the fragment stage declares and never reads.
#[test]
fn a_module_may_leave_out_what_nobody_reads() {
    let folder =
        quad(1, "#version 150\nin vec2 q;\nin vec3 spare;\nin vec2 r;\nout vec4 c;\nvoid main() { c = vec4(q, r); }\n");
    let vertex = VERTEX.replace("out vec2 q;", "out vec2 q;\nout vec3 spare;\nout vec2 r;");
    let vertex = vertex.replace("q = p * 0.5 + 0.5;", "q = p * 0.5 + 0.5;\n    spare = vec3(p, 1.0);\n    r = q.yx;");
    fs::write(folder.path("a.vert"), vertex).expect("written");
    for flags in [&[][..], &["-O"], &["-O0"], &["-g"], &["-O", "-g"]] {
        let compile = [&["compile", "a.vert", "a.frag", "-o", "out", "-q"], flags].concat();
        assert_eq!(code(&folder.run(&compile)), 0);
        for form in ["spv", "wgsl"] {
            let [vertex, fragment] = ["vertex=out/a.vert", "fragment=out/a.frag"].map(|part| format!("{part}.{form}"));
            for modules in [&[&vertex][..], &[&fragment], &[&vertex, &fragment]] {
                let arguments: Vec<&str> = modules.iter().flat_map(|module| ["--with", module.as_str()]).collect();
                let (exit, json) = verify(&folder, &arguments);
                assert_eq!((exit, &json["verdict"]), (0, &"holds".into()), "{flags:?} {arguments:?}: {json}");
            }
        }
    }
    // What the fragment stage reads has to be there.
    let text = fs::read_to_string(folder.path("out/a.vert.wgsl")).expect("compiled");
    fs::write(folder.path("less.wgsl"), text.replace("@location(1)", "@location(9)")).expect("written");
    let output = folder.run(&["verify", "a.toml", "--with", "vertex=less.wgsl"]);
    assert!(code(&output) == 1 && err(&output).contains("varying at location"), "{}", err(&output));
}

#[test]
fn a_folder_has_a_line_for_each_scene_and_a_summary() {
    let folder = quad(1, GRADIENT);
    let scene = fs::read_to_string(folder.path("a.toml")).expect("written");
    fs::create_dir(folder.path("all")).expect("created");
    let noise = GRADIENT.replace("vec4(q, ", "vec4(fract(sin(q.x * 900.0) * 43758.5), q.y, ");
    fs::write(folder.path("b.frag"), noise).expect("written");
    let beside = scene.replace("\"a.vert\"", "\"../a.vert\"").replace("\"a.frag\"", "\"../a.frag\"");
    fs::write(folder.path("all/good.toml"), &beside).expect("written");
    fs::write(folder.path("all/noisy.toml"), beside.replace("a.frag", "b.frag")).expect("written");
    fs::write(folder.path("all/broken.toml"), beside.replace("primitive", "primitif")).expect("written");
    let output = folder.run(&["verify", "all"]);
    let told = out(&output);
    assert_eq!(code(&output), 1, "{told}{}", err(&output));
    assert!(told.contains("all/good.toml: holds, 4096 of 4096 pixels judged\n"), "{told}");
    assert!(told.ends_with("3 scenes: 1 hold, 1 inconclusive, 1 not drawn\n"), "{told}");
    assert!(told.contains("--allow-inconclusive") && told.contains("--tolerance"), "{told}");
    let annotations = out(&folder.run(&["verify", "all", "--format", "github"]));
    assert_eq!(annotations.lines().filter(|line| line.starts_with("::error file=")).count(), 2, "{annotations}");
    assert!(annotations.contains("b.frag,line=4,col="), "{annotations}");
    let xml = out(&folder.run(&["verify", "all", "--format", "junit"]));
    assert!(xml.contains("tests=\"3\" failures=\"1\" errors=\"1\""), "{xml}");
    let json: Value = serde_json::from_str(&out(&folder.run(&["verify", "all", "--format", "json"]))).expect("JSON");
    let verdicts: Vec<_> = json.as_array().into_iter().flatten().map(|one| one["verdict"].as_str()).collect();
    assert_eq!(verdicts, [None, Some("holds"), Some("inconclusive")], "{json}");
    let output = folder.run(&["verify", "all", "--format", "github", "--tolerance", "2"]);
    assert_eq!(out(&output).lines().count(), 1, "{}", out(&output));
}

#[test]
fn three_lines_are_enough_where_all_is_well() {
    let folder = quad(1, GRADIENT);
    let output = folder.run(&["verify", "a.toml", "--evidence", "e.png"]);
    assert_eq!(code(&output), 0, "{}", out(&output));
    assert_eq!(out(&output).lines().count(), 3, "{}", out(&output));
    assert!(out(&output).contains("holds: 4096 of 4096 covered pixels judged (100.0 %)"), "{}", out(&output));
    assert!(err(&output).contains("green: judged"), "{}", err(&output));
    assert!(fs::read(folder.path("e.png")).expect("written").starts_with(b"\x89PNG"));
}

#[test]
fn a_width_of_the_users_is_the_goal() {
    let folder = quad(1, GRADIENT);
    let (exit, json) = verify(&folder, &["--width", "0"]);
    assert_eq!((exit, &json["verdict"]), (1, &"inconclusive".into()), "{json}");
    assert!(count(&json, "weak") > 3900, "{json}");
    let (_, json) = verify(&folder, &["--width", "1"]);
    assert_eq!((json["width"].as_f64(), count(&json, "weak")), (Some(1.0), 0));
}

#[test]
fn modules_of_others_are_judged_or_refused() {
    let folder = quad(1, GRADIENT);
    compiled(&folder);
    let text = fs::read_to_string(folder.path("out/a.frag.wgsl")).expect("compiled");
    fs::write(folder.path("l.wgsl"), text.replace("@location(0) q", "@location(2) q")).expect("written");
    fs::write(folder.path("g.spv"), b"no module at all, but some text").expect("written");
    fs::write(folder.path("g.wgsl"), b"\xff\x00").expect("written");
    let right: [(&[&str], &[&str]); 3] = [
        (&["fragment=out/a.frag.wgsl"], &["wgsl"]),
        (&["0:fragment=out/a.frag.spv", "vertex=out/a.vert.spv"], &["spirv"]),
        (&["fragment=out/a.frag.spv", "vertex=out/a.vert.wgsl"], &["spirv", "wgsl"]),
    ];
    for (modules, forms) in right {
        let arguments: Vec<&str> = modules.iter().flat_map(|module| ["--with", *module]).collect();
        let (exit, json) = verify(&folder, &arguments);
        let runs: Vec<&str> =
            json["runs"].as_array().into_iter().flatten().filter_map(|run| run["via"].as_str()).collect();
        assert_eq!((exit, &runs[..]), (0, forms), "{json}");
    }
    let refused = [
        ("fragment=l.wgsl", 1, "varying at location 2: vec2<f32>, where the program has nothing"),
        ("fragment=g.spv", 1, "`g.spv`: it is no SPIR-V"),
        ("fragment=g.wgsl", 1, "`g.wgsl`: it is no WGSL"),
        ("fragment=out/a.vert.spv", 1, "no entry point for the fragment stage"),
        ("fragment=missing.spv", 2, "missing.spv"),
        ("1:fragment=out/a.frag.spv", 2, "there is no draw 1"),
        ("fragment=a.frag", 2, "must end in .wgsl or .spv"),
        ("fragmen=out/a.frag.spv", 2, "did you mean `fragment`?"),
    ];
    for (module, exit, part) in refused {
        for command in [&["verify", "a.toml"][..], &["render", "a.toml", "-o", "a.npy"]] {
            let output = folder.run(&[command, &["--with", module]].concat());
            assert_eq!(code(&output), exit, "{module}: {}", err(&output));
            assert!(err(&output).contains(part), "{module}: {}", err(&output));
        }
    }
    let render = ["render", "a.toml", "-o", "a.npy", "--with", "fragment=out/a.frag.wgsl"];
    assert_eq!(code(&folder.run(&render)), 0);
    // Of two modules for one stage only one would be drawn.
    for (other, exit) in [
        ("fragment=out/a.frag.wgsl", 2),
        ("fragment=out/a.frag.spv", 2),
        ("0:fragment=out/a.frag.wgsl", 0),
        ("vertex=out/a.vert.wgsl", 0),
    ] {
        let output = folder.run(&[&render[..], &["--with", other]].concat());
        assert_eq!(code(&output), exit, "{other}: {}", err(&output));
    }
}

/// Scenes of which too little can be judged, each with the reason.
const INCONCLUSIVE: &[(&str, &str)] = &[
    ("cull_back_ccw", NOTHING),
    ("cull_front_cw", NOTHING),
    ("depth_equal", NOTHING),
    ("depth_gequal", NOTHING),
    ("depth_greater", NOTHING),
    ("depth_never", NOTHING),
    ("lower_always_discard", NOTHING),
    ("lower_builtins", "it calls functions where they are undefined or not precise"),
    ("lower_chosen", "an index is outside of its array"),
    ("lower_constants", "it divides by numbers beyond those for which Vulkan has a rule"),
    ("lower_parameters", "it reads a global that was never written"),
    ("lower_statements", "a function ends without `return`"),
    ("lower_varyings", "an index is outside of its array"),
    ("root_of_negative", "GLSL leaves the root and the power of a negative number undefined"),
];

/// The scene tests that nothing is drawn.
const NOTHING: &str = "nothing is covered";

#[test]
fn the_classes_of_every_scene_add_up() {
    let gpu = gpu();
    let mut inconclusive = Vec::new();
    for path in scenes::paths() {
        let loaded = load(&path, &DiskFiles, &compiler());
        let mut scene = loaded.scene.expect("another test loads it");
        scene.framebuffer.width = scene.framebuffer.width.min(64);
        scene.framebuffer.height = scene.framebuffer.height.min(64);
        let options = strict();
        let mut expected = Expected::new(&scene, &options).expect("the reference draws it");
        let picture = gpu.render(&scene, Via::Spirv).expect("it draws").picture;
        let verdict = expected.compare(&picture).expect("the reference draws it");
        assert_eq!(verdict.evidence.total(), verdict.covered, "{path}");
        assert_eq!(verdict.widths.iter().map(|row| row.pixels).sum::<u64>(), verdict.covered, "{path}");
        if verdict.conclusion(&options.demands) == Conclusion::Inconclusive {
            let name = path.rsplit('/').next().unwrap_or_default().trim_end_matches(".toml").to_owned();
            inconclusive.push(name);
        }
    }
    inconclusive.sort_unstable();
    let known: Vec<&str> = INCONCLUSIVE.iter().map(|(name, _)| *name).collect();
    assert_eq!(inconclusive, known);
}
